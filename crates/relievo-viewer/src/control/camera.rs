//! Orbit, pan, zoom and walk. The camera stays valid whatever is asked: finite, never in its target, never looking along its
//! own up.

use glam::{DQuat, DVec3, Vec3};
use relievo_scene::{Camera, CameraKind};

/// Rotation per pixel of dragging, radians: half a turn over 700 pixels.
const ORBIT_PER_PIXEL: f64 = std::f64::consts::PI / 700.0;

/// One line of the wheel changes the distance by this factor.
const ZOOM_PER_LINE: f64 = 1.15;

/// Least angle to the poles of `up`, radians.
const POLE: f64 = 0.01;

/// Distances from the target, scene units; the lower bound is also a few times the near plane's.
const DISTANCES: [f64; 2] = [1e-3, 1e5];

/// Largest coordinate of a target, scene units.
const MAX_COORDINATE: f64 = 1e6;

/// Orbits around the target as if the scene were held by the mouse: `pixels` to the right and down. The distance stays.
pub fn orbit(camera: &mut Camera, pixels: [f32; 2]) {
    let Some([right, down]) = finite(pixels) else { return };
    let basis = CameraBasis::of(camera);
    let offset = -basis.forward;
    let rotated = DQuat::from_axis_angle(basis.pole, -right * ORBIT_PER_PIXEL) * offset;
    let polar = rotated.angle_between(basis.pole);
    let wanted = (polar - down * ORBIT_PER_PIXEL).clamp(POLE, std::f64::consts::PI - POLE);
    let side = basis.pole.cross(rotated).try_normalize().unwrap_or(basis.right);
    let offset = DQuat::from_axis_angle(side, wanted - polar) * rotated;
    set_around(camera, camera.target.as_dvec3(), offset * basis.distance);
}

/// Moves eye and target in the picture's plane, so that what lies in the target's distance follows the mouse: `pixels` to
/// the right and down in a picture of this height in pixels.
pub fn pan(camera: &mut Camera, pixels: [f32; 2], height: u32) {
    let Some([right, down]) = finite(pixels) else { return };
    let basis = CameraBasis::of(camera);
    let size = pixel_size(camera, height, basis.distance);
    let target = camera.target.as_dvec3() + (basis.up * down - basis.right * right) * size;
    set_around(camera, target, basis.forward * -basis.distance);
}

/// Comes nearer to the target (`lines` of the wheel above 0) or goes away from it, within bounds. An orthographic camera
/// stays where it is and sees less or more.
pub fn zoom(camera: &mut Camera, lines: f32) {
    let Some([lines, _]) = finite([lines, 0.0]) else { return };
    if camera.is_orthographic() {
        set_size(camera, ZOOM_PER_LINE.powf(-lines));
        return;
    }
    let basis = CameraBasis::of(camera);
    set_around(camera, camera.target.as_dvec3(), basis.forward * -(basis.distance * ZOOM_PER_LINE.powf(-lines)));
}

/// Moves eye and target along the camera's right, up and forward, by `offset` times the distance between the two. An
/// orthographic camera moves by `offset` times its size, and sees less as it goes forward.
pub fn walk(camera: &mut Camera, offset: Vec3) {
    if !offset.is_finite() || offset == Vec3::ZERO {
        return;
    }
    let basis = CameraBasis::of(camera);
    let [right, up, forward] = offset.as_dvec3().to_array();
    if camera.is_orthographic() {
        let offset = (basis.right * right + basis.up * up) * f64::from(camera.size);
        set_size(camera, (-forward).exp());
        set_around(camera, camera.target.as_dvec3() + offset, basis.forward * -basis.distance);
        return;
    }
    let offset = (basis.right * right + basis.up * up + basis.forward * forward) * basis.distance;
    set_around(camera, camera.target.as_dvec3() + offset, basis.forward * -basis.distance);
}

/// The side of a pixel at this distance along the camera's axis.
pub(crate) fn pixel_size(camera: &Camera, height: u32, distance: f64) -> f64 {
    let seen = match camera.kind {
        CameraKind::Perspective => 2.0 * (f64::from(camera.vertical_fov).to_radians() * 0.5).tan() * distance,
        CameraKind::Orthographic => f64::from(camera.size),
    };
    seen / f64::from(height.max(1))
}

/// Changes what an orthographic camera sees by a factor, within bounds.
fn set_size(camera: &mut Camera, factor: f64) {
    camera.size = (f64::from(camera.size) * factor).clamp(DISTANCES[0], DISTANCES[1]) as f32;
}

/// Right, up and forward of the picture, unit length.
pub(crate) struct CameraBasis {
    pub(crate) right: DVec3,
    pub(crate) up: DVec3,
    pub(crate) forward: DVec3,
    pole: DVec3,
    distance: f64,
}

impl CameraBasis {
    pub(crate) fn of(camera: &Camera) -> Self {
        let to_target = camera.target.as_dvec3() - camera.position.as_dvec3();
        let forward = to_target.try_normalize().unwrap_or(DVec3::NEG_Z);
        let pole = camera.up.as_dvec3().try_normalize().unwrap_or(DVec3::Y);
        let right = forward.cross(pole).try_normalize().unwrap_or_else(|| forward.any_orthonormal_vector());
        Self { right, up: right.cross(forward), forward, pole, distance: to_target.length() }
    }
}

/// Puts the camera at `offset` from a target, both within bounds.
fn set_around(camera: &mut Camera, target: DVec3, offset: DVec3) {
    let target = target.clamp(DVec3::splat(-MAX_COORDINATE), DVec3::splat(MAX_COORDINATE));
    // Far from the origin f32 has no small steps.
    let least = DISTANCES[0].max(2.0 * f64::from(camera.near)).max(target.abs().max_element() * 1e-5);
    let Some(direction) = offset.try_normalize() else { return };
    let distance = offset.length().clamp(least.min(DISTANCES[1]), DISTANCES[1]);
    camera.target = target.as_vec3();
    camera.position = (target + direction * distance).as_vec3();
}

/// Numbers that can be calculated with: a mouse that jumps does not throw the camera out of its scene.
fn finite(numbers: [f32; 2]) -> Option<[f64; 2]> {
    numbers.iter().all(|x| x.is_finite()).then(|| numbers.map(|x| f64::from(x).clamp(-1e4, 1e4)))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn camera() -> Camera {
        Camera { position: Vec3::new(-0.95, -0.6, 1.3), target: Vec3::new(-0.08, -0.02, 0.0), ..Camera::default() }
    }

    fn distance(camera: &Camera) -> f32 {
        camera.position.distance(camera.target)
    }

    fn sees(camera: &Camera) -> bool {
        let forward = (camera.target - camera.position).normalize_or_zero();
        camera.position.is_finite() && camera.target.is_finite() && forward.cross(camera.up).length() > 1e-4
    }

    #[test]
    fn orbiting_keeps_distance_and_target_and_follows_the_mouse() {
        let start = Camera::default();
        let mut orbited = start;
        orbit(&mut orbited, [35.0, 0.0]);
        assert!((distance(&orbited) - 3.0).abs() < 1e-5);
        assert_eq!(orbited.target, start.target);
        // The scene turns to the right with the mouse: the eye goes to the left.
        assert!(orbited.position.x < -0.1 && orbited.position.y.abs() < 1e-6, "{orbited:?}");
        orbit(&mut orbited, [-35.0, 0.0]);
        assert!(orbited.position.distance(start.position) < 1e-5);
        // The scene's front goes down: the eye sees it from above.
        orbit(&mut orbited, [0.0, 35.0]);
        assert!(orbited.position.y > 0.1 && orbited.position.x.abs() < 1e-5, "{orbited:?}");
    }

    #[test]
    fn nothing_is_asked_and_nothing_moves() {
        let mut still = camera();
        walk(&mut still, Vec3::ZERO);
        assert_eq!(still, camera());
    }

    #[test]
    fn the_poles_are_never_reached() {
        for down in [1e4, -1e4] {
            let mut camera = camera();
            for _ in 0..50 {
                orbit(&mut camera, [3.0, down]);
                assert!(sees(&camera), "{camera:?}");
            }
            // And there is a way back.
            orbit(&mut camera, [0.0, -down.signum() * 350.0]);
            let forward = (camera.target - camera.position).normalize();
            assert!(forward.y.abs() < 0.05, "{forward}");
        }
    }

    #[test]
    fn panning_stays_in_the_pictures_plane_and_follows_the_mouse() {
        let start = camera();
        let mut moved = start;
        pan(&mut moved, [50.0, -20.0], 600);
        let offset = moved.position - start.position;
        assert!(offset.distance(moved.target - start.target) < 1e-6);
        assert!(offset.dot((start.target - start.position).normalize()).abs() < 1e-6);
        // 600 pixels are the whole height at the target: 2 · 3 · tan(22.5°).
        let mut straight = Camera::default();
        pan(&mut straight, [0.0, 600.0], 600);
        assert!((straight.target.y - 6.0 * 22.5f32.to_radians().tan()).abs() < 1e-5, "{straight:?}");
    }

    #[test]
    fn zooming_is_bounded_on_both_sides() {
        for lines in [1.0, -1.0, 1e9, -1e9] {
            let mut camera = camera();
            for _ in 0..500 {
                zoom(&mut camera, lines);
            }
            let bounds = 0.019..=1.001e5;
            assert!(bounds.contains(&distance(&camera)) && sees(&camera), "{lines}: {}", distance(&camera));
        }
        let (mut there, start) = (camera(), camera());
        zoom(&mut there, 3.0);
        assert!(distance(&there) < 0.7 * distance(&start));
        zoom(&mut there, -3.0);
        assert!(there.position.distance(start.position) < 1e-5);
    }

    #[test]
    fn an_orthographic_camera_zooms_by_its_size_and_pans_by_it() {
        let start = Camera { kind: CameraKind::Orthographic, size: 4.0, ..camera() };
        let mut zoomed = start;
        zoom(&mut zoomed, 3.0);
        assert_eq!(Camera { size: start.size, ..zoomed }, start);
        assert!(zoomed.size < 0.7 * start.size);
        for (lines, bound) in [(1e9, 1e-3), (-1e9, 1e5)] {
            zoom(&mut zoomed, lines);
            assert_eq!(zoomed.size, bound);
        }
        let mut moved = start;
        pan(&mut moved, [0.0, 600.0], 600);
        assert!((moved.target.distance(start.target) - 4.0).abs() < 1e-5, "600 pixels are its whole height");
        let mut walked = start;
        walk(&mut walked, Vec3::Z);
        assert!(walked.size < start.size && walked.target == start.target);
    }

    #[test]
    fn walking_forward_takes_the_target_along() {
        let mut camera = Camera::default();
        walk(&mut camera, Vec3::new(0.0, 0.0, 0.5));
        assert_eq!((camera.position, camera.target), (Vec3::new(0.0, 0.0, 1.5), Vec3::new(0.0, 0.0, -1.5)));
        walk(&mut camera, Vec3::new(1.0, 0.0, 0.0));
        assert_eq!(camera.position, Vec3::new(3.0, 0.0, 1.5));
    }

    proptest! {
        #[test]
        fn any_way_of_moving_leaves_a_camera_that_sees(
            moves in proptest::collection::vec((0..4, any::<f32>(), any::<f32>(), -300.0f32..300.0), 1..60),
            up in proptest::array::uniform3(-1.0f32..1.0),
        ) {
            let mut camera = camera();
            if Vec3::from(up).length() > 0.1 && Vec3::from(up).cross(camera.target - camera.position).length() > 0.1 {
                camera.up = Vec3::from(up);
            }
            for (kind, a, b, c) in moves {
                match kind {
                    0 => orbit(&mut camera, [a, c]),
                    1 => pan(&mut camera, [b, c], 1),
                    2 => zoom(&mut camera, c),
                    _ => walk(&mut camera, Vec3::new(a, b, c)),
                }
                prop_assert!(sees(&camera), "{:?}", camera);
            }
        }
    }
}
