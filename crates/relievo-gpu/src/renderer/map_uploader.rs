//! A material's maps as textures that hardware can filter.

use half::f16;
use relievo_map::{ColorEncoding, ColorMap, Grid, MipMap, NormalMap, ScalarMap, Texel, linear_to_srgb};
use relievo_scene::ColorSpace;

use crate::GpuError;
use crate::device::wgpu_util::{check_size, texture_descriptor, whole_view, write_level};

/// Largest distance of a number from a multiple of 1/255 that came from an 8-bit file.
const EIGHT_BIT: f32 = 1e-4;

/// Uploads maps.
pub(crate) struct MapUploader<'a> {
    pub(crate) device: &'a wgpu::Device,
    pub(crate) queue: &'a wgpu::Queue,
    /// True if mip levels are uploaded.
    pub(crate) levels: bool,
    /// For messages.
    pub(crate) material: &'a str,
}

impl MapUploader<'_> {
    /// Uploads base colours as shading computes with them. 8-bit sRGB maps stay 8-bit; others become half floats.
    pub(crate) fn color(&self, map: &ColorMap, space: ColorSpace) -> Result<wgpu::TextureView, GpuError> {
        let texels = match space {
            ColorSpace::Linear => map.to_linear(),
            ColorSpace::Display => map.to_display(),
        };
        let eight_bit = map.encoding == ColorEncoding::Srgb
            && map.grid.texels().iter().all(|t| t[..3].iter().all(|&x| is_eight_bit(x)));
        match (eight_bit, space) {
            (true, ColorSpace::Linear) => {
                let encode = |t: &[f32; 4]| t.map(|x| byte(linear_to_srgb(x)));
                self.upload("base colour", texels, wgpu::TextureFormat::Rgba8UnormSrgb, encode)
            }
            (true, ColorSpace::Display) => {
                self.upload("base colour", texels, wgpu::TextureFormat::Rgba8Unorm, |t| t.map(byte))
            }
            (false, _) => self.upload("base colour", texels, wgpu::TextureFormat::Rgba16Float, |t| t.map(float)),
        }
    }

    /// Uploads normals. For level of detail they are half floats, with the length of the mean in the fourth channel: eight bits
    /// cannot tell how far it is from 1.
    pub(crate) fn normal(&self, map: &NormalMap, lod: bool) -> Result<wgpu::TextureView, GpuError> {
        if lod {
            let half = wgpu::TextureFormat::Rgba16Float;
            return self.upload_mips("normal", &map.toksvig_mips(), half, |t| t.map(float));
        }
        let eight_bit = map.grid().texels().iter().all(|t| t.iter().all(|&x| is_eight_bit_normal(x)));
        let texels = map.grid().clone();
        if eight_bit {
            // The steps of stored normals, whose two zeros are one: a filter mixes them as they are.
            let encode = |&[x, y, z]: &[f32; 3]| [x, y, z, 1.0].map(signed_byte);
            return self.upload("normal", texels, wgpu::TextureFormat::Rgba8Snorm, encode);
        }
        let encode = |&[x, y, z]: &[f32; 3]| [x, y, z, 1.0].map(float);
        self.upload("normal", texels, wgpu::TextureFormat::Rgba16Float, encode)
    }

    /// Uploads the scatter of slopes: variances and covariance.
    pub(crate) fn slope_scatter(&self, mips: &MipMap<[f32; 3]>) -> Result<wgpu::TextureView, GpuError> {
        let encode = |&[xx, yy, xy]: &[f32; 3]| [xx, yy, xy, 0.0].map(float);
        self.upload_mips("height", mips, wgpu::TextureFormat::Rgba16Float, encode)
    }

    /// Uploads roughness, metallic or occlusion.
    pub(crate) fn scalar(&self, what: &str, map: &ScalarMap) -> Result<wgpu::TextureView, GpuError> {
        let texels = map.grid().clone();
        if texels.texels().iter().all(|&x| is_eight_bit(x)) {
            return self.upload(what, texels, wgpu::TextureFormat::R8Unorm, |&x| byte(x));
        }
        self.upload(what, texels, wgpu::TextureFormat::R16Float, |&x| float(x))
    }

    fn upload<T: Texel, U: bytemuck::Pod>(
        &self,
        what: &str,
        base: Grid<T>,
        format: wgpu::TextureFormat,
        encode: impl Fn(&T) -> U,
    ) -> Result<wgpu::TextureView, GpuError> {
        let mips = if self.levels { MipMap::build(base) } else { MipMap::single(base) };
        self.upload_mips(what, &mips, format, encode)
    }

    fn upload_mips<T: Texel, U: bytemuck::Pod>(
        &self,
        what: &str,
        mips: &MipMap<T>,
        format: wgpu::TextureFormat,
        encode: impl Fn(&T) -> U,
    ) -> Result<wgpu::TextureView, GpuError> {
        let (width, height) = (mips.base().width(), mips.base().height());
        check_size(self.device, &format!("the {what} map of material \"{}\"", self.material), width, height)?;
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let descriptor = wgpu::TextureDescriptor {
            mip_level_count: mips.levels().len() as u32,
            ..texture_descriptor(what, [width, height], format, usage)
        };
        let texture = self.device.create_texture(&descriptor);
        for (level, grid) in mips.levels().iter().enumerate() {
            let texels: Vec<U> = grid.texels().iter().map(&encode).collect();
            let bytes = bytemuck::cast_slice(&texels);
            write_level(self.queue, &texture, level as u32, [grid.width(), grid.height()], bytes);
        }
        Ok(whole_view(&texture))
    }
}

fn is_eight_bit(x: f32) -> bool {
    (-EIGHT_BIT..=1.0 + EIGHT_BIT).contains(&x) && ((x * 255.0).round() - x * 255.0).abs() < EIGHT_BIT * 255.0
}

fn is_eight_bit_normal(x: f32) -> bool {
    (NormalMap::decode8(NormalMap::encode8(x)) - x).abs() < EIGHT_BIT
}

/// The multiple of 1/127 nearest to a component in [-1, 1].
fn signed_byte(x: f32) -> i8 {
    (x * 127.0).round() as i8
}

fn byte(x: f32) -> u8 {
    (x * 255.0 + 0.5) as u8
}

/// Bits of a half float. Too large numbers become the largest, not infinity, and NaN 0: both would spread
/// when filtered.
fn float(x: f32) -> u16 {
    let x = if x.is_nan() { 0.0 } else { x };
    f16::from_f32(x.clamp(f16::MIN.to_f32(), f16::MAX.to_f32())).to_bits()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_and_eight_bit_normals_are_known() {
        assert!((0..=255u8).all(|x| is_eight_bit(f32::from(x) / 255.0) && byte(f32::from(x) / 255.0) == x));
        let normal = NormalMap::decode8;
        assert!(
            (0..=255u8)
                .all(|x| is_eight_bit_normal(normal(x)) && f32::from(signed_byte(normal(x))) / 127.0 == normal(x))
        );
        assert!(!is_eight_bit_normal(0.5 / 127.0));
        assert!(!is_eight_bit(0.5) && !is_eight_bit(1.5) && !is_eight_bit(f32::NAN));
    }

    #[test]
    fn half_floats_stay_finite() {
        assert_eq!(f16::from_bits(float(1e9)), f16::MAX);
        assert_eq!(f16::from_bits(float(0.25)).to_f32(), 0.25);
    }
}
