use relievo_shader::ComposeError;
use thiserror::Error;

/// An error of the GPU's part.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum GpuError {
    /// The machine has no adapter.
    #[error(
        "no GPU adapter was found: install a driver (on Debian and Ubuntu `apt-get install mesa-vulkan-drivers libvulkan1` \
         gives an adapter in software), or draw on the CPU"
    )]
    NoAdapter,
    /// No adapter has the name that was asked for.
    #[error("no GPU adapter's name contains \"{wanted}\"; there are: {}", known.join("; "))]
    NoSuchAdapter {
        /// Part of a name that was asked for.
        wanted: String,
        /// Names of those there are.
        known: Vec<String>,
    },
    /// A map is larger than the device's textures can be.
    #[error(
        "{what} has {width}×{height} texels, but this device's textures have at most {max} on a side: \
         make the map smaller, or request the device with `Limits::using_resolution(adapter.limits())`"
    )]
    TextureTooLarge {
        /// Name of the map.
        what: String,
        /// Texels per row.
        width: u32,
        /// Rows.
        height: u32,
        /// The device's limit.
        max: u32,
    },
    /// A buffer is larger than the device's buffers can be.
    #[error(
        "{what} take {bytes} bytes, but this device's buffers have at most {max}: draw fewer or coarser meshes, or smaller maps"
    )]
    BufferTooLarge {
        /// Name of the contents.
        what: String,
        /// Its size.
        bytes: u64,
        /// The device's limit.
        max: u64,
    },
    /// The device cannot compute.
    #[error("this device has no compute shaders (WebGL2-class): march on the CPU, or request another adapter")]
    NoCompute,
    /// The memory of the device is full.
    #[error("the device is out of memory ({0}): use smaller maps or a smaller picture")]
    OutOfMemory(String),
    /// The device is lost, or refused what it was asked.
    #[error("the device failed: {0}")]
    Device(String),
    /// An argument is not one that can be used.
    #[error("this is not possible: {0}")]
    InvalidArgument(String),
    /// The scene breaks a promise of `relievo-scene`.
    #[cfg(feature = "renderer")]
    #[error("the scene cannot be drawn: {0}")]
    InvalidScene(#[from] relievo_scene::InvalidScene),
    /// The scene asks for more than the renderer can do.
    #[cfg(feature = "renderer")]
    #[error("the scene cannot be drawn: {0}")]
    Scene(String),
    /// Shader modules do not fit together.
    #[error(transparent)]
    Compose(#[from] ComposeError),
}
