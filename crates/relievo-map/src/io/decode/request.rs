use crate::io::limits::Limits;

/// Options of a decoder.
#[derive(Clone, Copy)]
pub(crate) struct DecodeRequest<'a> {
    pub(crate) limits: &'a Limits,
    /// Bytes of the map that will be made of each texel: they count towards the limit.
    pub(crate) map_bytes: u64,
    /// True to apply the file's orientation tag. False for normals, whose vectors would have to turn too.
    pub(crate) upright: bool,
}
