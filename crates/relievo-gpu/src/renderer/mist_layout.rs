use bytemuck::{Pod, Zeroable};
use relievo_march::Shadow;
use relievo_scene::{Material, Mist, MistVolume};

/// `RelievoMist` of mist.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct MistLayout {
    origin: [f32; 3],
    height: f32,
    uv: [f32; 2],
    plane_count: u32,
    steps: u32,
    u_gradient: [f32; 3],
    density: f32,
    v_gradient: [f32; 3],
    softness: f32,
    height_gradient: [f32; 3],
    anisotropy: f32,
    albedo: [f32; 3],
    is_shadowed: u32,
    light: u32,
    pad: [u32; 3],
    planes: [[f32; 4]; MistVolume::MAX_PLANES],
}

impl MistLayout {
    pub(crate) fn new(volume: &MistVolume, material: &Material, mist: &Mist) -> Self {
        let [u_gradient, v_gradient, height_gradient] = volume.gradients.map(<[f32; 3]>::from);
        let mut planes = [[0.0; 4]; MistVolume::MAX_PLANES];
        for (slot, plane) in planes.iter_mut().zip(&volume.planes) {
            *slot = plane.to_array();
        }
        Self {
            origin: volume.origin.into(),
            height: volume.height,
            uv: volume.uv.into(),
            plane_count: volume.planes.len().min(MistVolume::MAX_PLANES) as u32,
            steps: mist.steps,
            u_gradient,
            density: mist.density,
            v_gradient,
            softness: mist.softness,
            height_gradient,
            anisotropy: mist.anisotropy,
            albedo: material.base_color,
            is_shadowed: (material.relief.shadow != Shadow::None).into(),
            light: 0,
            pad: [0; 3],
            planes,
        }
    }

    /// Returns the same for the shadow that it throws in the light of this number.
    pub(crate) fn for_light(&self, light: usize) -> Self {
        Self { light: light as u32, ..*self }
    }
}
