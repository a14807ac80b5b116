use relievo_march::{Cones, MarchOptions};

/// Settings of the marches as a uniform buffer: `RelievoMarchOptions` of the shaders, field by field.
///
/// The technique is not among them: it is chosen when a shader is composed, see [`crate::Permutation`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarchUniforms {
    /// Layers when looking along the normal; 1 to 4096.
    pub min_layers: f32,
    /// Layers when looking along the surface; 1 to 4096. Also the most steps of relaxed cones.
    pub max_layers: f32,
    /// Bisections of `relief` and `binary`, and the most of relaxed cones; at most 64.
    pub refine_steps: u32,
    /// Height that lies on the polygon, in [0, 1]: with 1 the relief lies wholly below it.
    pub midlevel: f32,
    /// Lower corner, then upper corner of the uv outside of which there is no surface; used if `bounded` is not 0.
    pub bounds: [f32; 4],
    /// Not 0: the surface ends at `bounds`.
    pub bounded: u32,
    /// Not 0: layered techniques and their shadows drop the division by the cosine.
    pub offset_limiting: u32,
    /// 0: the cones are relaxed; else conservative.
    pub cones: u32,
}

impl MarchUniforms {
    /// Bytes in a uniform buffer.
    pub const SIZE: usize = 48;

    /// Bytes as they lie in a uniform buffer, little-endian.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; Self::SIZE] {
        let [u0, v0, u1, v1] = self.bounds.map(f32::to_bits);
        let words = [
            self.min_layers.to_bits(),
            self.max_layers.to_bits(),
            self.refine_steps,
            self.midlevel.to_bits(),
            u0,
            v0,
            u1,
            v1,
            self.bounded,
            self.offset_limiting,
            self.cones,
            0,
        ];
        let mut bytes = [0; Self::SIZE];
        for (bytes, word) in bytes.chunks_exact_mut(4).zip(words) {
            bytes.copy_from_slice(&word.to_le_bytes());
        }
        bytes
    }
}

impl Default for MarchUniforms {
    /// The defaults of [`MarchOptions`], and of `relievo_default_options` in the shaders.
    fn default() -> Self {
        Self::from(&MarchOptions::default())
    }
}

impl From<&MarchOptions> for MarchUniforms {
    fn from(options: &MarchOptions) -> Self {
        Self {
            min_layers: options.min_layers,
            max_layers: options.max_layers,
            refine_steps: options.refine_steps,
            midlevel: options.midlevel,
            bounds: options.bounds.map_or([0.0; 4], |b| [b.min[0], b.min[1], b.max[0], b.max[1]]),
            bounded: options.bounds.is_some().into(),
            offset_limiting: options.offset_limiting.into(),
            cones: u32::from(options.cones != Cones::Relaxed),
        }
    }
}
