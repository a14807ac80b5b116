use image::DynamicImage;

use super::error::MapError;
use crate::types::{dequantize8, dequantize16};

/// A decoded image, before its texels get a meaning.
pub(crate) struct Raster {
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// Number of channels: 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA.
    pub(crate) channels: usize,
    /// Row by row from the top left, the channels of a texel together.
    pub(crate) samples: Samples,
    /// Bits per sample in the file: a 2-bit PNG is decoded to 8.
    pub(crate) bits: u32,
    /// Whole sentences on what the decoder changed.
    pub(crate) notes: Vec<String>,
}

/// The samples of a [`Raster`].
pub(crate) enum Samples {
    /// Integers 0..=255.
    U8(Vec<u8>),
    /// Integers 0..=65535.
    U16(Vec<u16>),
    /// Floats, any number.
    F32(Vec<f32>),
}

impl Raster {
    /// Takes over an image of the `image` crate without a copy; `None` for kinds of images that are unknown here.
    pub(crate) fn from_image(image: DynamicImage) -> Option<Self> {
        let (width, height) = (image.width(), image.height());
        let (channels, samples) = match image {
            DynamicImage::ImageLuma8(i) => (1, Samples::U8(i.into_raw())),
            DynamicImage::ImageLumaA8(i) => (2, Samples::U8(i.into_raw())),
            DynamicImage::ImageRgb8(i) => (3, Samples::U8(i.into_raw())),
            DynamicImage::ImageRgba8(i) => (4, Samples::U8(i.into_raw())),
            DynamicImage::ImageLuma16(i) => (1, Samples::U16(i.into_raw())),
            DynamicImage::ImageLumaA16(i) => (2, Samples::U16(i.into_raw())),
            DynamicImage::ImageRgb16(i) => (3, Samples::U16(i.into_raw())),
            DynamicImage::ImageRgba16(i) => (4, Samples::U16(i.into_raw())),
            DynamicImage::ImageRgb32F(i) => (3, Samples::F32(i.into_raw())),
            DynamicImage::ImageRgba32F(i) => (4, Samples::F32(i.into_raw())),
            _ => return None,
        };
        let bits = match samples {
            Samples::U8(_) => 8,
            Samples::U16(_) => 16,
            Samples::F32(_) => 32,
        };
        Some(Self { width, height, channels, samples, bits, notes: Vec::new() })
    }

    /// True if the samples are floats: any number may occur.
    pub(crate) fn is_float(&self) -> bool {
        matches!(self.samples, Samples::F32(_))
    }

    /// True if there is an alpha channel.
    pub(crate) fn has_alpha(&self) -> bool {
        self.channels == 2 || self.channels == 4
    }

    /// Describes the channels.
    pub(crate) fn channels_in_words(&self) -> &'static str {
        match self.channels {
            1 => "only grey",
            2 => "grey and alpha",
            3 => "red, green and blue",
            _ => "red, green, blue and alpha",
        }
    }

    /// Applies `f` to every texel as RGBA (integers become [0, 1]; grey is repeated; a missing alpha is 1), row by row.
    pub(crate) fn texels<T>(&self, name: &str, f: impl FnMut([f32; 4]) -> T) -> Result<Vec<T>, MapError> {
        let mut texels = Vec::new();
        texels.try_reserve_exact(self.width as usize * self.height as usize).map_err(|_| MapError::Memory {
            name: name.to_owned(),
            width: self.width,
            height: self.height,
        })?;
        match &self.samples {
            Samples::U8(samples) => push_texels(samples, self.channels, dequantize8, f, &mut texels),
            Samples::U16(samples) => push_texels(samples, self.channels, dequantize16, f, &mut texels),
            Samples::F32(samples) => push_texels(samples, self.channels, |x| x, f, &mut texels),
        }
        Ok(texels)
    }
}

/// The loop of [`Raster::texels`] for one type of sample.
fn push_texels<S: Copy, T>(
    samples: &[S],
    channels: usize,
    to_f32: impl Fn(S) -> f32,
    mut f: impl FnMut([f32; 4]) -> T,
    out: &mut Vec<T>,
) {
    match channels {
        1 => out.extend(samples.iter().map(|&v| to_f32(v)).map(|v| f([v, v, v, 1.0]))),
        2 => {
            out.extend(
                samples.as_chunks().0.iter().map(|&[v, a]| (to_f32(v), to_f32(a))).map(|(v, a)| f([v, v, v, a])),
            );
        }
        3 => out.extend(samples.as_chunks().0.iter().map(|&[r, g, b]| f([to_f32(r), to_f32(g), to_f32(b), 1.0]))),
        _ => out
            .extend(samples.as_chunks().0.iter().map(|&[r, g, b, a]| f([to_f32(r), to_f32(g), to_f32(b), to_f32(a)]))),
    }
}
