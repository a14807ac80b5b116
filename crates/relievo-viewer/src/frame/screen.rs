//! The window's surface: configured to its size, and made anew if it is lost.

use std::sync::Arc;

use relievo_gpu::{GpuError, adapters};
use winit::window::Window;

use crate::error::ViewerError;
use crate::frame::picture::FORMATS;
use crate::frame::stage::Stage;

pub(crate) struct Screen {
    pub(crate) window: Arc<Window>,
    instance: wgpu::Instance,
    pub(crate) surface: wgpu::Surface<'static>,
    config: Option<wgpu::SurfaceConfiguration>,
    vsync: bool,
}

/// A texture to draw the next frame into, if there is one now.
pub(crate) enum NextTexture {
    Ready(wgpu::SurfaceTexture),
    /// The window is hidden, or busy: later.
    Later,
}

impl Screen {
    /// Makes the surface of a window. `vsync`: frames wait for the screen.
    pub(crate) fn new(window: Arc<Window>, instance: wgpu::Instance, vsync: bool) -> Result<Self, ViewerError> {
        let surface = surface(&instance, &window)?;
        Ok(Self { window, instance, surface, config: None, vsync })
    }

    pub(crate) fn instance(&self) -> &wgpu::Instance {
        &self.instance
    }

    /// The best format that the surface has on this adapter.
    pub(crate) fn format(&self, adapter: &wgpu::Adapter) -> Result<wgpu::TextureFormat, GpuError> {
        let formats = self.surface.get_capabilities(adapter).formats;
        FORMATS.into_iter().find(|format| formats.contains(format)).ok_or_else(|| {
            GpuError::Device(format!("the window has no format with 8 bits per channel, but {formats:?}"))
        })
    }

    /// Width and height in pixels; either is 0 while the window is minimised.
    pub(crate) fn size(&self) -> [u32; 2] {
        let size = self.window.inner_size();
        [size.width, size.height]
    }

    /// Makes the surface anew, for another device.
    pub(crate) fn renew(&mut self) -> Result<(), ViewerError> {
        self.surface = surface(&self.instance, &self.window)?;
        self.config = None;
        Ok(())
    }

    /// Acquires the next texture, of this size, which is not 0.
    pub(crate) fn acquire(&mut self, stage: &Stage, size: [u32; 2]) -> Result<NextTexture, ViewerError> {
        let device = &stage.gpu().device;
        let mut refused = None;
        for _ in 0..3 {
            let errors = device.push_error_scope(wgpu::ErrorFilter::Validation);
            self.configure(device, stage.format(), size);
            // wgpu panics if the first surface of a device that is lost by now is asked for a texture.
            stage.check()?;
            let texture = self.surface.get_current_texture();
            refused = pollster::block_on(errors.pop());
            match texture {
                wgpu::CurrentSurfaceTexture::Success(texture) => return Ok(NextTexture::Ready(texture)),
                wgpu::CurrentSurfaceTexture::Suboptimal(texture) => {
                    // Good for this frame.
                    self.config = None;
                    return Ok(NextTexture::Ready(texture));
                }
                wgpu::CurrentSurfaceTexture::Timeout | wgpu::CurrentSurfaceTexture::Occluded => {
                    return Ok(NextTexture::Later);
                }
                wgpu::CurrentSurfaceTexture::Outdated | wgpu::CurrentSurfaceTexture::Validation => self.config = None,
                wgpu::CurrentSurfaceTexture::Lost => self.renew()?,
            }
        }
        match refused {
            Some(error) => Err(ViewerError::Window(error.to_string())),
            // A window that is being resized may have yet another size by now.
            None => Ok(NextTexture::Later),
        }
    }

    fn configure(&mut self, device: &wgpu::Device, format: wgpu::TextureFormat, [width, height]: [u32; 2]) {
        if self.config.as_ref().is_some_and(|config| [config.width, config.height] == [width, height]) {
            return;
        }
        let present_mode = if self.vsync { wgpu::PresentMode::AutoVsync } else { wgpu::PresentMode::AutoNoVsync };
        let config = wgpu::SurfaceConfiguration {
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            format,
            color_space: wgpu::SurfaceColorSpace::Auto,
            width,
            height,
            present_mode,
            desired_maximum_frame_latency: 2,
            alpha_mode: wgpu::CompositeAlphaMode::Auto,
            view_formats: Vec::new(),
        };
        self.surface.configure(device, &config);
        self.config = Some(config);
    }
}

fn surface(instance: &wgpu::Instance, window: &Arc<Window>) -> Result<wgpu::Surface<'static>, ViewerError> {
    instance.create_surface(Arc::clone(window)).map_err(|error| {
        // Without a driver there is nothing that could make one.
        match pollster::block_on(adapters(instance)).is_empty() {
            true => ViewerError::Gpu(GpuError::NoAdapter),
            false => ViewerError::Window(error.to_string()),
        }
    })
}
