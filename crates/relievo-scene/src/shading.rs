/// The `[shading]` table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shading {
    /// The reflection model.
    pub model: ShadingModel,
    /// Decoding of colour maps and encoding of the picture.
    pub color_space: ColorSpace,
    /// Ambient factor on the base colour; ambient occlusion darkens it.
    pub ambient: f32,
    /// Blinn-Phong: strength of the highlight.
    pub specular: f32,
    /// Blinn-Phong: exponent of the highlight.
    pub shininess: f32,
}

impl Default for Shading {
    fn default() -> Self {
        Self {
            model: ShadingModel::BlinnPhong,
            color_space: ColorSpace::Linear,
            ambient: 0.1,
            specular: 0.2,
            shininess: 32.0,
        }
    }
}

/// Reflection models.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ShadingModel {
    /// `ambient·c + max(L·n, 0)·c + specular·max(n·H, 0)^shininess` (Blinn 1977), as in the tutorials.
    BlinnPhong,
    /// Metallic-roughness: GGX distribution, Smith visibility, Schlick Fresnel, as glTF 2.0 defines it.
    Pbr,
}

impl ShadingModel {
    /// Returns true for physically based models: light falls off with the squared distance, and materials have roughness
    /// and metallic.
    #[must_use]
    pub fn is_physical(self) -> bool {
        match self {
            Self::BlinnPhong => false,
            Self::Pbr => true,
        }
    }
}

/// Decoding of colour maps and encoding of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorSpace {
    /// sRGB maps are decoded, shading is linear, the picture is encoded again.
    Linear,
    /// Numbers are used as they are, in and out, as in the tutorials. Heights of 8-bit files are filtered in 8 bits, as
    /// the software OpenGL did that drew the tutorials' pictures.
    Display,
}
