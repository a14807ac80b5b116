use std::path::PathBuf;

use anyhow::Result;
use clap::Args;

use crate::console::Console;

/// List the GPUs that can draw, with what they can do
#[derive(Args)]
#[command(after_help = "Examples:
  relievo devices
  relievo devices --json -

A part of a name is what `relievo render --adapter NAME` takes.")]
pub(crate) struct Arguments {
    /// The list as JSON instead; - for stdout
    #[arg(long, value_name = "FILE.json")]
    json: Option<PathBuf>,
}

#[cfg(not(feature = "gpu"))]
pub(crate) fn run(arguments: &Arguments, _: &Console) -> Result<()> {
    let _ = &arguments.json;
    crate::backend::gpu::open(None).map(|gpu| match gpu {})
}

#[cfg(feature = "gpu")]
pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<()> {
    use crate::console::print;
    use crate::outputs::{check_outputs, write_json};

    if let Some(path) = &arguments.json {
        check_outputs(&[path], None)?;
    }
    let devices: Vec<listed::Device> = crate::backend::gpu::adapters()?.iter().map(listed::Device::new).collect();
    if devices.is_empty() {
        // Nothing to list is no failure: everything can be drawn on the CPU.
        console.note(&relievo_gpu::GpuError::NoAdapter.to_string());
    }
    match &arguments.json {
        Some(path) => write_json(path, &devices),
        None => print(devices.iter().map(ToString::to_string).collect::<String>().as_bytes()),
    }
}

#[cfg(feature = "gpu")]
mod listed {
    use std::fmt;

    use relievo_gpu::{Tier, adapter_name, interface_name};
    use serde::Serialize;

    /// Properties of an adapter.
    #[derive(Serialize)]
    pub(super) struct Device {
        /// Name, interface and driver: what `--adapter` is looked for in.
        adapter: String,
        name: String,
        #[serde(rename = "type")]
        kind: &'static str,
        interface: String,
        driver: String,
        tier: &'static str,
        compute: bool,
        timestamps: bool,
        max_texture_side: u32,
        max_buffer_bytes: u64,
    }

    impl Device {
        pub(super) fn new(adapter: &wgpu::Adapter) -> Self {
            let (info, limits, tier) = (adapter.get_info(), adapter.limits(), Tier::of_adapter(adapter));
            let kind = match info.device_type {
                wgpu::DeviceType::DiscreteGpu => "discrete GPU",
                wgpu::DeviceType::IntegratedGpu => "integrated GPU",
                wgpu::DeviceType::VirtualGpu => "virtual GPU",
                wgpu::DeviceType::Cpu => "software",
                wgpu::DeviceType::Other => "unknown",
            };
            let driver: Vec<&str> =
                [info.driver.as_str(), &info.driver_info].into_iter().filter(|part| !part.is_empty()).collect();
            Self {
                adapter: adapter_name(&info),
                kind,
                interface: interface_name(info.backend),
                driver: driver.join(" "),
                tier: tier.name(),
                compute: tier.computes(),
                timestamps: tier == Tier::Full,
                max_texture_side: limits.max_texture_dimension_2d,
                max_buffer_bytes: limits.max_buffer_size,
                name: info.name,
            }
        }
    }

    impl fmt::Display for Device {
        fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            let with = |has: bool, what: &str| format!("{} {what}", if has { "with" } else { "without" });
            writeln!(f, "{}", self.adapter)?;
            writeln!(f, "  type       {}", self.kind)?;
            writeln!(f, "  interface  {}", self.interface)?;
            writeln!(f, "  driver     {}", self.driver)?;
            let abilities = [with(self.compute, "compute shaders"), with(self.timestamps, "timestamps")].join(", ");
            writeln!(f, "  tier       {}: {abilities}", self.tier)?;
            let side = self.max_texture_side;
            writeln!(f, "  textures   up to {side}×{side} texels")?;
            writeln!(f, "  buffers    up to {} MiB", self.max_buffer_bytes >> 20)
        }
    }
}
