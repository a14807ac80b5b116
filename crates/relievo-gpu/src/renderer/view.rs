//! Camera, shading and lights as the shaders take them.

use glam::Vec3;
use relievo_scene::{Camera, Light, Shading, sample_offset};

use super::layout::{CameraViewLayout, LightLayout, MAX_LIGHTS};
use super::shells::NearPlane;
use crate::GpuError;

/// One of several samples of a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    pub(crate) index: u32,
    pub(crate) count: u32,
}

/// The camera of a picture of this size; `bounds` are the scene's corners.
pub(crate) fn view(
    camera: &Camera,
    bounds: [Vec3; 2],
    shading: &Shading,
    lights: usize,
    [width, height]: [u32; 2],
    sample: Sample,
) -> CameraViewLayout {
    let [right, up, forward] = camera.axes();
    let half = camera.half_height();
    let range = camera.parallel_range(bounds);
    let aspect = width as f32 / height as f32;
    // A pixel's samples share it: each needs the detail of its part only.
    let spacing = 1.0 / (sample.count as f32).sqrt();
    let pixel = [2.0 / width as f32, 2.0 / height as f32];
    // From the pixel's centre.
    let offset = sample_offset(sample.index).map(|x| (x - 0.5) as f32);
    CameraViewLayout {
        eye: camera.eye_after(range.skipped).into(),
        near: camera.near - range.skipped,
        right: (right / (half * aspect)).into(),
        light_count: lights as u32,
        up: (up / half).into(),
        ambient: shading.ambient,
        forward: forward.into(),
        specular: shading.specular,
        pixel_right: (right * (half * aspect * pixel[0] * spacing)).into(),
        shininess: shading.shininess,
        pixel_down: (up * (-half * pixel[1] * spacing)).into(),
        rotation: sample.index as f32,
        // The picture moves against the sample; pixels are counted downwards.
        jitter: [-offset[0] * pixel[0], offset[1] * pixel[1]],
        parallel: camera.is_orthographic().into(),
        far: range.far,
        pixel,
        skipped: range.skipped,
        pad: 0,
    }
}

/// Returns the place that the rays of a camera begin at, for a picture of this size.
pub(crate) fn eye(camera: &Camera, bounds: [Vec3; 2], [width, height]: [u32; 2]) -> NearPlane {
    let skipped = camera.parallel_range(bounds).skipped;
    let near = camera.near - skipped;
    let half = camera.half_height();
    // A pixel more, for samples off its middle.
    let aspect = (width + 1) as f32 / height as f32;
    let corner = (half * aspect).hypot(half * (1.0 + 1.0 / height as f32));
    NearPlane {
        position: camera.eye_after(skipped),
        forward: (camera.target - camera.position).normalize(),
        near,
        reach: if camera.is_orthographic() { near.hypot(corner) } else { near * 1.0f32.hypot(corner) },
    }
}

/// All lights, unused entries dark.
pub(crate) fn lights(lights: &[Light]) -> Result<[LightLayout; MAX_LIGHTS], GpuError> {
    if lights.len() > MAX_LIGHTS {
        let count = lights.len();
        return Err(GpuError::Scene(format!("{count} lights are more than the {MAX_LIGHTS} there is room for")));
    }
    let mut layouts = [bytemuck::Zeroable::zeroed(); MAX_LIGHTS];
    for (layout, light) in layouts.iter_mut().zip(lights) {
        *layout = layout_of(light);
    }
    Ok(layouts)
}

fn layout_of(light: &Light) -> LightLayout {
    let (position, direction) = (light.kind.position(), light.kind.direction());
    let kind = match (position, direction) {
        (Some(_), None) => 0,
        (None, _) => 1,
        (Some(_), Some(_)) => 2,
    };
    let (position, direction) = (position.unwrap_or_default(), direction.unwrap_or_default());
    let angles = light.kind.cone_angles().unwrap_or_default();
    let [cos_inner, cos_outer] = angles.map(|angle| angle.to_radians().cos());
    LightLayout {
        position: position.into(),
        kind,
        direction: direction.into(),
        radius: light.radius,
        color: (Vec3::from(light.color) * light.intensity).into(),
        cos_inner,
        cos_outer,
        pad: 0,
        map_window_offset: [0.0; 2],
        map_eye: [0.0; 3],
        map_near: 0.0,
        map_right: [0.0; 3],
        map_far: 0.0,
        map_up: [0.0; 3],
        // None, unless it is given one.
        map_layer: -1,
    }
}
