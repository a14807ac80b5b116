use glam::Vec3;
use relievo_scene::{EnvironmentMap, ShadingModel};

use crate::material::MaterialSample;
use crate::reflection::base_reflectance;

/// What a surface sends of its surroundings towards `view`.
pub(crate) fn reflected(
    surroundings: &EnvironmentMap,
    model: ShadingModel,
    texels: &MaterialSample,
    normal: Vec3,
    view: Vec3,
) -> Vec3 {
    let base = Vec3::from(texels.base_color);
    let received = surroundings.irradiance(normal);
    if model == ShadingModel::BlinnPhong {
        return base * received * texels.ao;
    }
    let f0 = base_reflectance(texels);
    let n_v = normal.dot(view).clamp(0.0, 1.0);
    let mirror = normal * (2.0 * normal.dot(view)) - view;
    let mirrors = environment_reflectance(f0, texels.roughness, n_v);
    let specular = surroundings.prefiltered(mirror, texels.roughness) * mirrors;
    // What is mirrored does not reach the matt layer below.
    (base * received * (1.0 - texels.metallic) * (Vec3::ONE - mirrors).max(Vec3::ZERO) + specular) * texels.ao
}

/// An analytic fit of the split-sum's second factor (Karis 2014, after Lazarov 2013).
fn environment_reflectance(f0: Vec3, roughness: f32, n_v: f32) -> Vec3 {
    let r = [1.0 - roughness, 0.0425 - 0.0275 * roughness, 1.04 - 0.572 * roughness, 0.022 * roughness - 0.04];
    let a = (r[0] * r[0]).min((-9.28 * n_v).exp2()) * r[0] + r[1];
    (f0 * (-1.04 * a + r[2]) + Vec3::splat(1.04 * a + r[3])).max(Vec3::ZERO)
}
