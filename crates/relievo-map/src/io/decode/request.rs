use crate::io::limits::Limits;

/// What the decoded texels are for.
#[derive(Clone, Copy)]
pub(crate) struct DecodeRequest<'a> {
    pub(crate) limits: &'a Limits,
    /// Bytes of the map that will be made of each texel: they count towards the limit.
    pub(crate) map_bytes: u64,
    /// Whether a turned photograph may be turned upright. Not so normals, whose vectors would have to turn too.
    pub(crate) upright: bool,
}
