use glam::Vec3;
use relievo_scene::{EnvironmentMap, ShadingModel};

use super::material_sample::MaterialSample;

/// Returns the light of the environment that a surface reflects towards `view`.
pub(crate) fn reflected(
    environment: &EnvironmentMap,
    model: ShadingModel,
    sample: &MaterialSample,
    normal: Vec3,
    view: Vec3,
) -> Vec3 {
    let base = Vec3::from(sample.base_color);
    let irradiance = environment.irradiance(normal);
    if !model.is_physical() {
        return base * irradiance * sample.ao;
    }
    let f0 = sample.base_reflectance();
    let n_v = normal.dot(view).clamp(0.0, 1.0);
    let mirror = normal * (2.0 * normal.dot(view)) - view;
    let reflectance = environment_reflectance(f0, sample.roughness, n_v);
    let specular = environment.prefiltered(mirror, sample.roughness) * reflectance;
    // Mirrored light does not reach the matt layer below.
    (base * irradiance * (1.0 - sample.metallic) * (Vec3::ONE - reflectance).max(Vec3::ZERO) + specular) * sample.ao
}

/// An analytic fit of the split-sum's second factor (Karis 2014, after Lazarov 2013).
fn environment_reflectance(f0: Vec3, roughness: f32, n_v: f32) -> Vec3 {
    let r = [1.0 - roughness, 0.0425 - 0.0275 * roughness, 1.04 - 0.572 * roughness, 0.022 * roughness - 0.04];
    let a = (r[0] * r[0]).min((-9.28 * n_v).exp2()) * r[0] + r[1];
    (f0 * (-1.04 * a + r[2]) + Vec3::splat(1.04 * a + r[3])).max(Vec3::ZERO)
}
