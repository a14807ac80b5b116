//! One device for all tests of a file.

use std::sync::LazyLock;

/// The environment variable with which CI says that there is an adapter: without one, tests fail then.
const REQUIRE: &str = "RELIEVO_REQUIRE_ADAPTER";

pub struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub name: String,
    /// Whether depth textures can be read back, which GL cannot.
    pub reads_depth: bool,
    /// Whether textures of floats can be drawn into, which GL ES 3 leaves open.
    pub draws_floats: bool,
}

static GPU: LazyLock<Option<Gpu>> = LazyLock::new(|| match pollster::block_on(open(wgpu::Limits::default(), None)) {
    Ok(gpu) => {
        eprintln!("adapter: {}", gpu.name);
        Some(gpu)
    }
    Err(error) => {
        assert!(std::env::var_os(REQUIRE).is_none(), "{REQUIRE} is set, but: {error}");
        None
    }
});

/// The device, or a word about the test that is skipped.
pub fn gpu() -> Option<&'static Gpu> {
    let gpu = GPU.as_ref();
    if gpu.is_none() {
        eprintln!("skipped: no adapter (for one in software: install Mesa's Vulkan drivers)");
    }
    gpu
}

/// A device with these limits, but textures as large as the adapter can have, or of at most `side`.
pub async fn open(limits: wgpu::Limits, side: Option<u32>) -> Result<Gpu, String> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapter =
        instance.request_adapter(&wgpu::RequestAdapterOptions::default()).await.map_err(|error| error.to_string())?;
    let info = adapter.get_info();
    let mut limits = limits.using_resolution(adapter.limits());
    limits.max_texture_dimension_2d = side.unwrap_or(limits.max_texture_dimension_2d);
    let descriptor = wgpu::DeviceDescriptor { required_limits: limits, ..wgpu::DeviceDescriptor::default() };
    let (device, queue) = adapter.request_device(&descriptor).await.map_err(|error| error.to_string())?;
    let name = format!("{} ({:?}, {} {})", info.name, info.backend, info.driver, info.driver_info);
    let flags = adapter.get_downlevel_capabilities().flags;
    let reads_depth = flags.contains(wgpu::DownlevelFlags::DEPTH_TEXTURE_AND_BUFFER_COPIES);
    let floats = adapter.get_texture_format_features(wgpu::TextureFormat::Rgba32Float);
    let draws_floats = floats.allowed_usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT);
    Ok(Gpu { device, queue, name, reads_depth, draws_floats })
}
