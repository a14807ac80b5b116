use crate::GpuError;
use crate::device::Timestamps;

/// Settings of drawing, beside what the scene says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RendererOptions {
    /// Samples along a stretched footprint, for materials with `filter = "trilinear"`: 1 (as the CPU draws) to 16.
    pub anisotropy: u16,
    /// Samples that the hardware takes of each pixel's polygons, 1 or 4 (multisampling). With 4 the borders of polygons are
    /// smooth, and those of clipped reliefs: where one ends inside a pixel it is marched once for each sample, and shaded
    /// once. The scene's own `samples` smooth everything, and cost as much as that many pictures.
    pub msaa: u32,
    /// Texels per side of a shadow map, 256 to 4096; `None`: as suits the picture. Less if all maps together would take
    /// more than 256 MiB.
    pub shadow_resolution: Option<u32>,
    /// Draw depth before colours, so that hidden surfaces are not shaded. Not with `msaa`.
    pub depth_prepass: bool,
}

impl Default for RendererOptions {
    fn default() -> Self {
        Self { anisotropy: 1, msaa: 1, shadow_resolution: None, depth_prepass: false }
    }
}

impl RendererOptions {
    /// Refuses what no device can do.
    pub(crate) fn validate(&self) -> Result<(), GpuError> {
        match self.msaa {
            1 | 4 => Ok(()),
            msaa => Err(GpuError::InvalidArgument(format!("msaa is {msaa}; every device can do 1 and 4 alone"))),
        }
    }

    /// True if colours are drawn after a pass of depth alone.
    pub(crate) fn draws_depth_first(&self) -> bool {
        self.depth_prepass && self.msaa == 1
    }
}

/// Textures that a picture is drawn into.
#[derive(Clone, Copy, Debug)]
pub struct Target<'a> {
    /// In the format given to [`crate::Renderer::new`], with usage RENDER_ATTACHMENT. All of it is drawn over.
    pub color: &'a wgpu::TextureView,
    /// For what else the caller draws: in [`crate::Renderer::DEPTH_FORMAT`], with usage RENDER_ATTACHMENT, and with as many
    /// samples as [`RendererOptions::msaa`] says. 1 = on the camera's near plane, 0 = at infinity: near divided by the
    /// distance along the camera's axis; of an orthographic camera linear in that distance, 0 behind the scene. Without, the
    /// renderer has its own. With several samples per pixel by the scene it ends up with the last one's.
    pub depth: Option<&'a wgpu::TextureView>,
    /// Width and height of the views in pixels.
    pub size: [u32; 2],
    /// Timestamps of how long it took.
    pub timestamps: Option<Timestamps<'a>>,
}

impl<'a> Target<'a> {
    /// Colours alone, in a view of this size.
    #[must_use]
    pub fn new(color: &'a wgpu::TextureView, size: [u32; 2]) -> Self {
        Self { color, depth: None, size, timestamps: None }
    }
}
