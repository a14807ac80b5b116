/// Classes of devices by what they can do, from the least to the most.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Tier {
    /// WebGL2: draws everything, but has no compute shaders and no storage buffers.
    WebGl2,
    /// WebGPU: computes too.
    WebGpu,
    /// WebGPU with timestamps: also tells how long its work takes.
    Full,
}

impl Tier {
    /// The tier of a device, by the limits and features that it was requested with.
    #[must_use]
    pub fn of(device: &wgpu::Device) -> Self {
        Self::from(&device.limits(), device.features())
    }

    /// The tier of a device that [`crate::Gpu`] opens on this adapter.
    #[must_use]
    pub fn of_adapter(adapter: &wgpu::Adapter) -> Self {
        Self::from(&adapter.limits(), adapter.features())
    }

    fn from(limits: &wgpu::Limits, features: wgpu::Features) -> Self {
        let computes = limits.max_compute_invocations_per_workgroup >= Self::WORKGROUP
            && limits.max_compute_workgroup_size_x >= Self::WORKGROUP
            && limits.max_storage_buffers_per_shader_stage >= 3;
        match (computes, features.contains(wgpu::Features::TIMESTAMP_QUERY)) {
            (false, _) => Self::WebGl2,
            (true, false) => Self::WebGpu,
            (true, true) => Self::Full,
        }
    }

    /// Invocations in a workgroup of the kernels, as in the shaders.
    pub(crate) const WORKGROUP: u32 = 64;

    /// Returns true if there are compute shaders, which [`crate::ComputeMarch`] needs; the renderer needs nothing.
    #[must_use]
    pub fn computes(self) -> bool {
        self >= Self::WebGpu
    }

    /// The name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::WebGl2 => "webgl2",
            Self::WebGpu => "webgpu",
            Self::Full => "full",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_and_features_give_the_tier() {
        let none = wgpu::Features::empty();
        assert_eq!(Tier::from(&wgpu::Limits::downlevel_webgl2_defaults(), none), Tier::WebGl2);
        assert_eq!(Tier::from(&wgpu::Limits::downlevel_defaults(), none), Tier::WebGpu);
        assert_eq!(Tier::from(&wgpu::Limits::default(), none), Tier::WebGpu);
        assert_eq!(Tier::from(&wgpu::Limits::default(), wgpu::Features::TIMESTAMP_QUERY), Tier::Full);
        assert!(!Tier::WebGl2.computes() && Tier::WebGpu.computes() && Tier::Full.computes());
    }
}
