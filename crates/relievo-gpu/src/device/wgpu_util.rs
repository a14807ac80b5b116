//! Layout, texture and pipeline helpers that all parts share.

use std::num::NonZeroU64;

use relievo_shader::TextureFormat;

use super::error::GpuError;

/// Refuses a texture that the device cannot have.
pub(crate) fn check_size(device: &wgpu::Device, what: &str, width: u32, height: u32) -> Result<(), GpuError> {
    let max = device.limits().max_texture_dimension_2d;
    if width.max(height) > max {
        return Err(GpuError::TextureTooLarge { what: what.to_owned(), width, height, max });
    }
    Ok(())
}

/// Size of one layer.
pub(crate) fn extent([width, height]: [u32; 2]) -> wgpu::Extent3d {
    wgpu::Extent3d { width, height, depth_or_array_layers: 1 }
}

/// Descriptor of a 2D texture with one layer, one mip level and one sample.
pub(crate) fn texture_descriptor(
    label: &str,
    size: [u32; 2],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::TextureDescriptor<'_> {
    wgpu::TextureDescriptor {
        label: Some(label),
        size: extent(size),
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    }
}

/// View of all of a texture.
pub(crate) fn whole_view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// Format of relievo-shader's textures.
pub(crate) fn texture_format(format: TextureFormat) -> Result<wgpu::TextureFormat, GpuError> {
    match format {
        TextureFormat::R32Float => Ok(wgpu::TextureFormat::R32Float),
        TextureFormat::Rgba32Uint => Ok(wgpu::TextureFormat::Rgba32Uint),
        TextureFormat::Rg8Uint => Ok(wgpu::TextureFormat::Rg8Uint),
        other => Err(GpuError::InvalidArgument(format!("textures of format {} are not known here", other.name()))),
    }
}

/// Fills one mip level of a texture, rows without gaps.
pub(crate) fn write_level(queue: &wgpu::Queue, texture: &wgpu::Texture, level: u32, size: [u32; 2], bytes: &[u8]) {
    let target = wgpu::TexelCopyTextureInfo { mip_level: level, ..texture.as_image_copy() };
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some((bytes.len() / size[1] as usize) as u32),
        rows_per_image: None,
    };
    queue.write_texture(target, bytes, layout, extent(size));
}

/// Type of a texture binding, not multisampled.
pub(crate) fn texture_type(
    sample_type: wgpu::TextureSampleType,
    view_dimension: wgpu::TextureViewDimension,
) -> wgpu::BindingType {
    wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false }
}

/// Type of a 2D texture that is read by `textureLoad` alone.
pub(crate) fn loaded_texture_type() -> wgpu::BindingType {
    texture_type(wgpu::TextureSampleType::Float { filterable: false }, wgpu::TextureViewDimension::D2)
}

/// Type of a uniform buffer.
pub(crate) fn uniform_type(has_dynamic_offset: bool) -> wgpu::BindingType {
    let ty = wgpu::BufferBindingType::Uniform;
    wgpu::BindingType::Buffer { ty, has_dynamic_offset, min_binding_size: None }
}

/// Type of a storage buffer.
pub(crate) fn storage_type(read_only: bool) -> wgpu::BindingType {
    let ty = wgpu::BufferBindingType::Storage { read_only };
    wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None }
}

/// Layout entries of bindings that are all seen by the same stages.
pub(crate) fn layout_entries(
    visibility: wgpu::ShaderStages,
    bindings: &[(u32, wgpu::BindingType)],
) -> Vec<wgpu::BindGroupLayoutEntry> {
    let entry = |&(binding, ty)| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
    bindings.iter().map(entry).collect()
}

/// Layout of a bind group.
pub(crate) fn bind_group_layout(
    device: &wgpu::Device,
    label: &str,
    entries: &[wgpu::BindGroupLayoutEntry],
) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
}

/// Layout of a pipeline with these bind groups.
pub(crate) fn pipeline_layout(
    device: &wgpu::Device,
    label: &str,
    groups: &[&wgpu::BindGroupLayout],
) -> wgpu::PipelineLayout {
    let groups: Vec<_> = groups.iter().copied().map(Some).collect();
    device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: &groups,
        immediate_size: 0,
    })
}

/// Bind group of these resources, each with its binding.
pub(crate) fn bind_group(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    resources: Vec<(u32, wgpu::BindingResource<'_>)>,
) -> wgpu::BindGroup {
    let entries: Vec<_> =
        resources.into_iter().map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries })
}

/// One structure of a buffer of many, at a dynamic offset.
pub(crate) fn one_of(buffer: &wgpu::Buffer, size: usize) -> wgpu::BindingResource<'_> {
    wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size: NonZeroU64::new(size as u64) })
}

/// Texture view as a resource.
pub(crate) fn view(view: &wgpu::TextureView) -> wgpu::BindingResource<'_> {
    wgpu::BindingResource::TextureView(view)
}

/// Shader module from WGSL.
pub(crate) fn shader_module(device: &wgpu::Device, label: &str, wgsl: String) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(wgsl.into()),
    })
}

/// Compute pipeline of one entry point.
pub(crate) fn compute_pipeline(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    wgsl: String,
    entry_point: &str,
) -> wgpu::ComputePipeline {
    let shader = shader_module(device, entry_point, wgsl);
    let layout = pipeline_layout(device, entry_point, &[layout]);
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry_point),
        layout: Some(&layout),
        module: &shader,
        entry_point: Some(entry_point),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    })
}
