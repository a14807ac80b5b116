//! Moving a light with the mouse: point and spot lights move in the picture's plane, directional ones rotate.

use glam::{DQuat, DVec3, Vec3};
use relievo_scene::{Camera, LightKind};

use crate::control::camera::{CameraBasis, pixel_size};

/// Rotation per pixel of dragging, radians.
const ROTATION_PER_PIXEL: f64 = std::f64::consts::PI / 700.0;

/// One line of the wheel moves a light by this part of its distance from the eye.
const PUSH_PER_LINE: f64 = 0.1;

/// Largest coordinate of a light, scene units.
const MAX_COORDINATE: f64 = 1e6;

/// Moves a light that has a position with the mouse, in the plane of the picture; rotates a directional one so that the side it
/// comes from follows the mouse. `pixels` to the right and down in a picture of this height.
pub(crate) fn drag(light: &mut LightKind, camera: &Camera, pixels: [f32; 2], height: u32) {
    match light {
        LightKind::Point { position } | LightKind::Spot { position, .. } => {
            let basis = CameraBasis::of(camera);
            let away = (position.as_dvec3() - camera.position.as_dvec3()).dot(basis.forward);
            // Behind the eye, or beside it, the mouse has no hold of it: as far away as the target will do.
            let away =
                if away > f64::from(camera.near) { away } else { f64::from(camera.position.distance(camera.target)) };
            let size = pixel_size(camera, height, away);
            let [right, down] = pixels.map(f64::from);
            move_to(position, position.as_dvec3() + (basis.right * right - basis.up * down) * size);
        }
        _ => rotate(light, camera, pixels),
    }
}

/// Rotates a light that has a direction; the side it comes from follows the mouse.
pub(crate) fn rotate(light: &mut LightKind, camera: &Camera, pixels: [f32; 2]) {
    let (LightKind::Directional { direction } | LightKind::Spot { direction, .. }) = light else { return };
    let basis = CameraBasis::of(camera);
    let [right, down] = pixels.map(|x| f64::from(x) * ROTATION_PER_PIXEL);
    let rotation = DQuat::from_axis_angle(basis.up, right) * DQuat::from_axis_angle(basis.right, down);
    let rotated = (rotation * direction.as_dvec3()).as_vec3().normalize_or_zero();
    if rotated.is_finite() && rotated != Vec3::ZERO {
        *direction = rotated;
    }
}

/// Moves a light that has a position away from the eye (`lines` of the wheel above 0) or towards it.
pub(crate) fn push(light: &mut LightKind, camera: &Camera, lines: f32) {
    let (LightKind::Point { position } | LightKind::Spot { position, .. }) = light else { return };
    let basis = CameraBasis::of(camera);
    let eye = camera.position.as_dvec3();
    let away = (position.as_dvec3() - eye).length().max(f64::from(camera.near));
    let distance = f64::from(lines).clamp(-100.0, 100.0) * PUSH_PER_LINE * away;
    move_to(position, position.as_dvec3() + basis.forward * distance);
}

fn move_to(position: &mut Vec3, place: DVec3) {
    if place.is_finite() {
        *position = place.clamp(DVec3::splat(-MAX_COORDINATE), DVec3::splat(MAX_COORDINATE)).as_vec3();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn direction(light: &LightKind) -> Vec3 {
        match light {
            LightKind::Directional { direction } | LightKind::Spot { direction, .. } => *direction,
            _ => panic!(),
        }
    }

    fn position(light: &LightKind) -> Vec3 {
        match light {
            LightKind::Point { position } | LightKind::Spot { position, .. } => *position,
            _ => panic!(),
        }
    }

    #[test]
    fn a_directional_light_comes_from_where_the_mouse_goes_and_goes_back() {
        let camera = Camera::default();
        let mut light = LightKind::Directional { direction: Vec3::NEG_Z };
        drag(&mut light, &camera, [100.0, 0.0], 600);
        // It comes from the right, so it travels to the left.
        assert!(direction(&light).x < -0.3 && (direction(&light).length() - 1.0).abs() < 1e-6);
        drag(&mut light, &camera, [-100.0, 0.0], 600);
        drag(&mut light, &camera, [0.0, 100.0], 600);
        // From below, so upwards.
        assert!(direction(&light).y > 0.3 && direction(&light).x.abs() < 1e-6, "{light:?}");
    }

    #[test]
    fn a_light_with_a_place_stays_under_the_mouse() {
        let camera = Camera::default();
        let mut light = LightKind::Point { position: Vec3::new(0.0, 0.0, 1.0) };
        drag(&mut light, &camera, [0.0, 300.0], 600);
        // From the middle to the lower border at distance 2.
        let expected = Vec3::new(0.0, -2.0 * 22.5f32.to_radians().tan(), 1.0);
        assert!(position(&light).distance(expected) < 1e-5, "{light:?}");
        push(&mut light, &camera, -1.0);
        assert!(position(&light).z > 1.1);
    }

    #[test]
    fn a_spot_moves_and_turns() {
        let camera = Camera::default();
        let (place, axis) = (Vec3::new(0.0, 0.0, 1.0), Vec3::NEG_Z);
        let mut light = LightKind::Spot { position: place, direction: axis, inner_angle: 10.0, outer_angle: 20.0 };
        rotate(&mut light, &camera, [50.0, 0.0]);
        assert!(position(&light) == place && direction(&light).x < -0.1);
        drag(&mut light, &camera, [50.0, 0.0], 600);
        assert!(position(&light).x > 0.1);
    }

    #[test]
    fn nothing_makes_a_light_lose_its_place_or_direction() {
        let camera = Camera::default();
        for kind in [
            LightKind::Point { position: camera.position },
            LightKind::Directional { direction: Vec3::X },
            LightKind::Spot { position: Vec3::ONE, direction: Vec3::Y, inner_angle: 1.0, outer_angle: 2.0 },
        ] {
            let mut light = kind;
            for pixels in [[f32::NAN, 1.0], [f32::MAX, f32::MAX], [1.0, f32::INFINITY], [-1e9, 1e9]] {
                drag(&mut light, &camera, pixels, 0);
                rotate(&mut light, &camera, pixels);
                push(&mut light, &camera, pixels[0]);
                let finite = match light {
                    LightKind::Point { position } => position.is_finite(),
                    LightKind::Directional { direction } => (direction.length() - 1.0).abs() < 1e-5,
                    LightKind::Spot { position, direction, .. } => {
                        position.is_finite() && (direction.length() - 1.0).abs() < 1e-5
                    }
                    _ => panic!(),
                };
                assert!(finite, "{light:?} after {pixels:?}");
            }
        }
    }
}
