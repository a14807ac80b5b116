//! Materials whose heights the device makes anew for every moment.

use relievo_march::TexelRect;
use relievo_scene::{ChangingHeights, ColorSpace, Material, Scene, SurfaceTechnique};

use super::height_kernel::HeightKernel;
use crate::device::guarded;
use crate::{GpuError, LiveHeights, Quantization, Tier};

/// The changing heights of all materials of a scene.
#[derive(Default)]
pub(crate) struct LiveMaterials {
    /// Of each material its heights, if the device makes them.
    materials: Vec<Option<LiveMaterial>>,
    /// Names of materials whose heights the CPU makes, and why.
    pub(crate) on_cpu: Vec<(String, String)>,
}

/// The heights of a material.
pub(crate) struct LiveMaterial {
    made_of: ChangingHeights,
    heights: LiveHeights,
    kernel: HeightKernel,
}

impl LiveMaterials {
    /// The heights of a material, if the device makes them.
    pub(crate) fn heights(&self, material: usize) -> Option<&LiveHeights> {
        self.materials.get(material)?.as_ref().map(|live| &live.heights)
    }

    /// Brings the heights of all materials to the moment of the scene.
    pub(crate) fn update(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, scene: &Scene) -> Result<(), GpuError> {
        self.on_cpu.clear();
        self.materials.resize_with(scene.materials.len(), || None);
        for (slot, material) in self.materials.iter_mut().zip(&scene.materials) {
            let Some(changing) = &material.changing_heights else {
                *slot = None;
                continue;
            };
            if let Some(why) = unfit(device, material) {
                *slot = None;
                self.on_cpu.push((material.name.clone(), why));
                continue;
            }
            if slot.as_ref().is_none_or(|live| !live.made_of.is_same_source(changing)) {
                match LiveMaterial::new(device, queue, material, changing, scene.shading.color_space)? {
                    Ok(live) => *slot = Some(live),
                    Err(why) => {
                        *slot = None;
                        self.on_cpu.push((material.name.clone(), why));
                        continue;
                    }
                }
            } else if slot.as_ref().is_some_and(|live| live.made_of == *changing) {
                continue;
            }
            if let Some(live) = slot {
                live.made_of = changing.clone();
                live.make(device, queue)?;
            }
        }
        Ok(())
    }
}

impl LiveMaterial {
    fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        material: &Material,
        changing: &ChangingHeights,
        space: ColorSpace,
    ) -> Result<Result<Self, String>, GpuError> {
        let Some(first) = material.heights(space) else { return Ok(Err("it has no height map".to_owned())) };
        // Made heights are clamped to this.
        let heights = LiveHeights::new(device, queue, &first, Quantization::Range([0.0, 1.0]))?;
        let kernel = HeightKernel::new(device, changing, &heights)?;
        Ok(kernel.map(|kernel| Self { made_of: changing.clone(), heights, kernel }))
    }

    fn make(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<(), GpuError> {
        guarded(device, || {
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            self.kernel.record(queue, &mut encoder, &self.made_of);
            let texture = self.heights.texture();
            let whole = TexelRect { min: [0; 2], size: [texture.width(), texture.height()] };
            self.heights.update(&mut encoder, whole)?;
            queue.submit([encoder.finish()]);
            Ok(())
        })
    }
}

/// The reason why the device cannot keep a material's heights up to date, in words.
fn unfit(device: &wgpu::Device, material: &Material) -> Option<String> {
    let relief = &material.relief;
    if !Tier::of(device).computes() {
        return Some("this device has no compute shaders".to_owned());
    }
    if relief.lod {
        return Some("lod wants the scatter of their slopes".to_owned());
    }
    if relief.needed_cones().is_some() {
        return Some("cones take long to build".to_owned());
    }
    if relief.technique == SurfaceTechnique::Displacement {
        return Some("displaced vertices move with them".to_owned());
    }
    material.has_marched_back().then(|| "its relief has two sides".to_owned())
}
