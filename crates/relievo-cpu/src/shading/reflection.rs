use std::f32::consts::PI;

use glam::Vec3;
use relievo_scene::Shading;

use super::material_sample::MaterialSample;
use super::mean_normal::MeanNormal;

/// Returns the reflected light per unit of light from `light`. Vectors are of unit length, away from the surface; the
/// sample's roughness includes the scatter of the normals.
pub(crate) fn reflected(
    shading: &Shading,
    sample: &MaterialSample,
    normal: MeanNormal,
    view: Vec3,
    light: Vec3,
) -> Vec3 {
    if shading.model.is_physical() {
        metallic_roughness(sample, normal, view, light)
    } else {
        blinn_phong(shading, sample, normal, view, light)
    }
}

/// Blinn 1977, as the tutorials write it: the highlight is not tied to the diffuse term. Scattered normals widen it and take
/// of its height what they add to its width (Toksvig 2005); the diffuse term takes the mean normal as it is.
fn blinn_phong(shading: &Shading, sample: &MaterialSample, normal: MeanNormal, view: Vec3, light: Vec3) -> Vec3 {
    let diffuse = light.dot(normal.direction).max(0.0) * normal.length;
    let half = (light + view).normalize_or_zero();
    let shininess = shading.shininess / (1.0 + shading.shininess * MeanNormal::variance(normal.length));
    let height = (1.0 + shininess) / (1.0 + shading.shininess);
    let highlight = normal.direction.dot(half).max(0.0).powf(shininess) * height;
    Vec3::from(sample.base_color) * diffuse + Vec3::splat(shading.specular * highlight)
}

/// glTF 2.0's metallic-roughness model (appendix B): GGX (Walter et al. 2007), height-correlated Smith visibility (Heitz
/// 2014), Schlick's Fresnel (1994).
fn metallic_roughness(
    sample: &MaterialSample,
    MeanNormal { direction: normal, length }: MeanNormal,
    view: Vec3,
    light: Vec3,
) -> Vec3 {
    let n_l = normal.dot(light);
    if n_l <= 0.0 {
        return Vec3::ZERO;
    }
    // A normal map may turn away from the eye; the model is not defined there.
    let n_v = normal.dot(view).max(1e-4);
    let half = (light + view).normalize_or_zero();
    let n_h = normal.dot(half).clamp(0.0, 1.0);
    let v_h = view.dot(half).clamp(0.0, 1.0);
    let base = Vec3::from(sample.base_color);
    let alpha = sample.alpha();
    let a2 = alpha * alpha;
    let d = n_h * n_h * (a2 - 1.0) + 1.0;
    let distribution = a2 / (PI * d * d);
    let smith = n_l * (n_v * n_v * (1.0 - a2) + a2).sqrt() + n_v * (n_l * n_l * (1.0 - a2) + a2).sqrt();
    let visibility = 0.5 / smith;
    let f0 = sample.base_reflectance();
    let fresnel = f0 + (Vec3::ONE - f0) * (1.0 - v_h).powi(5);
    let diffuse = (Vec3::ONE - fresnel) * (1.0 - sample.metallic) * base / PI;
    (diffuse * length + fresnel * (distribution * visibility)) * n_l
}

#[cfg(test)]
mod tests {
    use relievo_map::Grid;

    use super::*;

    const UP: MeanNormal = MeanNormal { direction: Vec3::Z, length: 1.0 };

    fn sample(roughness: f32, metallic: f32) -> MaterialSample {
        MaterialSample { base_color: [1.0; 3], roughness, metallic, ao: 1.0 }
    }

    #[test]
    fn the_tutorials_formula_holds() {
        let shading = Shading::default();
        let half = Vec3::new(0.6, 0.0, 0.8);
        let reflected = blinn_phong(&shading, &sample(1.0, 0.0), UP, half, half);
        assert!((reflected.x - (0.8 + 0.2 * 0.8f32.powi(32))).abs() < 1e-6);
        assert_eq!(blinn_phong(&shading, &sample(1.0, 0.0), UP, Vec3::Z, Vec3::NEG_Z), Vec3::ZERO);
    }

    #[test]
    fn a_white_metal_sends_back_no_more_light_than_arrives_and_a_dielectric_hardly_more() {
        // The reflection integrated over all light directions, for several materials and views. glTF mixes the two layers of
        // a dielectric by the half vector's Fresnel term, which gives a white one up to its mirrored share at a slant.
        let directions = Grid::from_fn(256, 64, |x, y| {
            let (phi, cos) = ((x as f32 + 0.5) / 256.0 * 2.0 * PI, (y as f32 + 0.5) / 64.0);
            let sin = (1.0 - cos * cos).sqrt();
            Vec3::new(sin * phi.cos(), sin * phi.sin(), cos)
        });
        for roughness in [0.2, 0.5, 1.0] {
            for metallic in [0.0, 1.0] {
                for tilt in [0.0f32, 0.7, 1.3] {
                    let view = Vec3::new(tilt.sin(), 0.0, tilt.cos());
                    let sum: f32 = directions
                        .texels()
                        .iter()
                        .map(|&light| metallic_roughness(&sample(roughness, metallic), UP, view, light).x)
                        .sum();
                    let albedo = sum * 2.0 * PI / directions.texels().len() as f32;
                    let most = if metallic == 1.0 { 1.02 } else { 1.03 + 0.96 * (1.0 - tilt.cos()).powi(5) };
                    assert!(albedo > 0.3 && albedo < most, "{roughness} {metallic} {tilt}: {albedo}");
                }
            }
        }
    }
}
