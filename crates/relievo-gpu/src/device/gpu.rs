//! Finding an adapter and opening a device on it: for programs that have none of their own.

use super::error::GpuError;
use super::tier::Tier;

/// An adapter with a device opened on it.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// The adapter that the device runs on.
    pub adapter: wgpu::Adapter,
    /// Device with as much as the adapter has of what this crate can use, timestamps among it.
    pub device: wgpu::Device,
    /// The device's queue.
    pub queue: wgpu::Queue,
}

/// Choice of an adapter.
#[derive(Clone, Copy, Debug, Default)]
pub struct AdapterChoice<'a> {
    /// A part of the name as [`adapter_name`] gives it, in any case; `None`: the one most likely to be fast.
    pub name: Option<&'a str>,
    /// A surface that it must be able to draw to.
    pub surface: Option<&'a wgpu::Surface<'a>>,
}

/// Lists all adapters of the machine, real ones before those in software, in the order that wgpu knows them in.
pub async fn adapters(instance: &wgpu::Instance) -> Vec<wgpu::Adapter> {
    let mut adapters = instance.enumerate_adapters(wgpu::Backends::all()).await;
    adapters.sort_by_key(|adapter| {
        let info = adapter.get_info();
        let speed = match info.device_type {
            wgpu::DeviceType::DiscreteGpu => 0,
            wgpu::DeviceType::IntegratedGpu => 1,
            wgpu::DeviceType::VirtualGpu => 2,
            wgpu::DeviceType::Other => 3,
            wgpu::DeviceType::Cpu => 4,
        };
        (speed, info.backend == wgpu::Backend::Gl)
    });
    adapters
}

/// Name, interface and driver of an adapter, as in "llvmpipe (LLVM 15.0.6, 256 bits), Vulkan, Mesa 22.3.6".
#[must_use]
pub fn adapter_name(info: &wgpu::AdapterInfo) -> String {
    let driver = if info.driver_info.is_empty() { &info.driver } else { &info.driver_info };
    [info.name.clone(), interface_name(info.backend), driver.clone()]
        .into_iter()
        .filter(|part| !part.is_empty())
        .collect::<Vec<_>>()
        .join(", ")
}

/// Name of the interface that an adapter is reached by.
#[must_use]
pub fn interface_name(backend: wgpu::Backend) -> String {
    match backend {
        wgpu::Backend::Gl => "OpenGL".to_owned(),
        wgpu::Backend::Dx12 => "Direct3D 12".to_owned(),
        backend => format!("{backend:?}"),
    }
}

/// Returns true if an adapter is a device of its own, not the CPU in disguise.
#[must_use]
pub fn is_real(info: &wgpu::AdapterInfo) -> bool {
    info.device_type != wgpu::DeviceType::Cpu
}

impl Gpu {
    /// Opens a device on the adapter that is wanted.
    ///
    /// # Errors
    /// If there is no such adapter, or it gives no device.
    pub async fn open(instance: &wgpu::Instance, choice: &AdapterChoice<'_>) -> Result<Self, GpuError> {
        let mut known = adapters(instance).await;
        known.retain(|adapter| choice.surface.is_none_or(|surface| adapter.is_surface_supported(surface)));
        let names: Vec<String> = known.iter().map(|adapter| adapter_name(&adapter.get_info())).collect();
        let wanted = choice.name.map(str::to_lowercase);
        let fits = |name: &String| wanted.as_ref().is_none_or(|wanted| name.to_lowercase().contains(wanted));
        match names.iter().position(fits) {
            Some(index) => Self::on(known.swap_remove(index)).await,
            None if names.is_empty() => Err(GpuError::NoAdapter),
            None => Err(GpuError::NoSuchAdapter { wanted: choice.name.unwrap_or_default().to_owned(), known: names }),
        }
    }

    /// Opens a device on this adapter.
    ///
    /// # Errors
    /// If it gives none.
    pub async fn on(adapter: wgpu::Adapter) -> Result<Self, GpuError> {
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("relievo"),
            required_limits: adapter.limits(),
            required_features: adapter.features() & wgpu::Features::TIMESTAMP_QUERY,
            ..wgpu::DeviceDescriptor::default()
        };
        let opened = adapter.request_device(&descriptor).await;
        let (device, queue) = opened.map_err(|error| GpuError::Device(error.to_string()))?;
        Ok(Self { adapter, device, queue })
    }

    /// The adapter's name; see [`adapter_name`].
    #[must_use]
    pub fn name(&self) -> String {
        adapter_name(&self.adapter.get_info())
    }

    /// Class of the device.
    #[must_use]
    pub fn tier(&self) -> Tier {
        Tier::of(&self.device)
    }
}
