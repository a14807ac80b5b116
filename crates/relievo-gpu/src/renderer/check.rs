//! The checks of scenes and pictures that drawing relies on.

use relievo_scene::Scene;

use crate::GpuError;
use crate::device::wgpu_util::check_size;

/// Refuses a scene that is not a variant of the one with these materials of objects.
pub(crate) fn check_variant(scene: &Scene, materials: usize, object_materials: &[usize]) -> Result<(), GpuError> {
    scene.validate()?;
    let known = object_materials.iter().copied();
    if scene.materials.len() != materials || !scene.objects.iter().map(|object| object.material).eq(known) {
        let text = "it has other materials or objects than the one that the renderer was made from";
        return Err(GpuError::Scene(text.to_owned()));
    }
    Ok(())
}

/// Refuses a picture that the device cannot draw.
pub(crate) fn check_picture(device: &wgpu::Device, [width, height]: [u32; 2]) -> Result<(), GpuError> {
    if width == 0 || height == 0 {
        return Err(GpuError::InvalidArgument(format!("a picture of {width}×{height} pixels is not possible")));
    }
    check_size(device, "the picture", width, height)
}
