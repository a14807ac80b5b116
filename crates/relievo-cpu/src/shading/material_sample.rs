use glam::Vec3;

use super::mean_normal::MeanNormal;

/// The material at a point: its maps as sampled, times its factors.
#[derive(Clone, Copy)]
pub(crate) struct MaterialSample {
    pub(crate) base_color: [f32; 3],
    pub(crate) roughness: f32,
    pub(crate) metallic: f32,
    pub(crate) ao: f32,
}

impl MaterialSample {
    /// Returns the sample with the roughness of the microfacets and of the normals that a pixel covers together: both widen
    /// the highlight, their variances add up (Olano and Baker 2010; for GGX, Kaplanyan et al. 2016).
    pub(crate) fn widened(self, normal: MeanNormal) -> Self {
        if normal.length >= 1.0 {
            return self;
        }
        // The variance of a slope along an axis is half of α².
        let alpha = self.alpha();
        let widened = (alpha * alpha + 2.0 * MeanNormal::variance(normal.length)).min(1.0);
        Self { roughness: widened.sqrt().sqrt(), ..self }
    }

    /// Returns GGX's α. Perfect mirrors would have a highlight that no sampling finds.
    pub(super) fn alpha(&self) -> f32 {
        let roughness = self.roughness.clamp(0.045, 1.0);
        roughness * roughness
    }

    /// Returns the reflectance when seen along the normal: 4 % for dielectrics, the base colour for metals.
    pub(super) fn base_reflectance(&self) -> Vec3 {
        Vec3::splat(0.04).lerp(Vec3::from(self.base_color), self.metallic)
    }
}
