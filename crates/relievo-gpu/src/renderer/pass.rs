//! One pass over all objects.

use super::geometry::{ObjectGeometry, Part};
use super::layout::ShellInstance;
use super::material::MaterialResources;
use super::pass_descriptor::PassDescriptor;
use super::permutation::{DrawnGeometry, Pass};
use super::scene_renderer::Renderer;

impl Renderer {
    pub(super) fn pass(&self, encoder: &mut wgpu::CommandEncoder, to: &PassDescriptor<'_>) {
        let load = if to.keeps_depth { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(0.0) };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("relievo"),
            color_attachments: to.colors,
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: to.depth,
                depth_ops: Some(wgpu::Operations { load, store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            timestamp_writes: to.timestamps.clone(),
            occlusion_query_set: None,
            multiview_mask: None,
        });
        let stride = self.buffers.stride;
        pass.set_bind_group(0, to.bindings, &[to.view * stride]);
        if let (Some(sky), Pass::Color) = (&self.sky, to.kind) {
            pass.set_pipeline(sky);
            pass.draw(0..3, 0..1);
        }
        pass.set_index_buffer(self.geometry.indices.slice(..), wgpu::IndexFormat::Uint32);
        let mut draw = |number: usize, object: &ObjectGeometry, material: Option<&MaterialResources>| {
            let Some(material) = material else { return };
            if material.is_mist() {
                return;
            }
            let geometry = object.drawn_geometry(to.kind);
            let permutation = material.permutation.drawn_by(geometry);
            let Some(pipeline) = self.pipelines.get(&permutation, to.kind) else { return };
            pass.set_pipeline(pipeline);
            pass.set_bind_group(1, &material.bindings, &[]);
            pass.set_bind_group(2, &self.buffers.object_bindings, &[number as u32 * stride]);
            if let Some(bindings) = self.mists.past_mist().filter(|_| permutation.looks_up_mist(to.kind)) {
                pass.set_bind_group(3, bindings, &[]);
            }
            match &object.part {
                Part::Polygons(range) => {
                    pass.set_vertex_buffer(0, self.geometry.vertices.slice(..));
                    pass.draw_indexed(range.clone(), 0, 0..1);
                }
                Part::Shells(shells) => {
                    pass.set_vertex_buffer(0, self.geometry.shells.slice(..));
                    let vertices = match geometry {
                        DrawnGeometry::Hulls => ShellInstance::HULL,
                        _ if shells.has_borders => ShellInstance::LID_AND_WALLS,
                        _ => ShellInstance::LID,
                    };
                    pass.draw(vertices, shells.range.clone());
                }
            }
        };
        for (number, object) in self.geometry.objects.iter().enumerate() {
            draw(number, object, self.materials.get(self.object_materials[number]));
        }
        // The front of a relief hides a light from either side.
        if to.kind != Pass::Caster {
            for (number, object) in &self.geometry.backs {
                draw(*number, object, self.backs[self.object_materials[*number]].as_ref());
            }
        }
    }
}
