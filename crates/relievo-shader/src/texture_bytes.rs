//! Height, pyramid and cone textures as plain bytes.

use relievo_map::Grid;
use relievo_march::{ConeMap, Cones, MaxPyramid, ReliefMap};

/// A texture ready to be uploaded: a 2D texture of one layer that is read by `textureLoad` alone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextureBytes {
    /// Format of a texel.
    pub format: TextureFormat,
    /// Mip levels, the full size first; at least one.
    pub mips: Vec<MipBytes>,
}

/// One mip level of a texture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MipBytes {
    /// Texels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Bytes from a row to the next; rows have no gaps.
    pub bytes_per_row: u32,
    /// Rows from the top, little-endian.
    pub bytes: Vec<u8>,
}

/// Texel formats of the textures, none of which needs to be filterable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum TextureFormat {
    /// One 32-bit float: heights.
    R32Float,
    /// Four 32-bit unsigned integers: pyramids.
    Rgba32Uint,
    /// Two 8-bit unsigned integers: cones.
    Rg8Uint,
}

impl TextureFormat {
    /// Bytes of a texel.
    #[must_use]
    pub fn bytes_per_texel(self) -> u32 {
        match self {
            Self::R32Float => 4,
            Self::Rgba32Uint => 16,
            Self::Rg8Uint => 2,
        }
    }

    /// Name of the format in WebGPU, which Vulkan's and Direct3D's resemble.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::R32Float => "r32float",
            Self::Rgba32Uint => "rgba32uint",
            Self::Rg8Uint => "rg8uint",
        }
    }
}

impl TextureBytes {
    /// Lays out `relievo_heights`: every mip level that the map has, 1 = highest.
    #[must_use]
    pub fn heights(heights: &ReliefMap) -> Self {
        let mip = |grid: &Grid<f32>| {
            let mut bytes = Vec::with_capacity(grid.texels().len() * 4);
            for height in grid.texels() {
                bytes.extend_from_slice(&height.to_le_bytes());
            }
            MipBytes::new(TextureFormat::R32Float, [grid.width(), grid.height()], bytes)
        };
        Self { format: TextureFormat::R32Float, mips: heights.levels().iter().map(mip).collect() }
    }

    /// Lays out `relievo_pyramid`: the max pyramids of all mip levels below one another, after a row of headers.
    ///
    /// The header of mip level l is texel (l, 0): the row where its nodes begin and, from bit 24 on, the number of pyramid
    /// levels; then as `f32` bits the height of code 0, the height of one code more, and the clearance. A node is a texel: the
    /// highest codes of 4×4 blocks, a row of four to a channel, the first in the lowest byte. The rows of each pyramid level
    /// follow those of the one below. A map of columns, whose shaders do not read it, has one texel.
    #[must_use]
    pub fn pyramid(heights: &ReliefMap) -> Self {
        let pyramids = heights.pyramids();
        let widest = pyramids.first().map_or(1, |finest| finest.level(1).size()[0] as usize);
        let width = widest.max(pyramids.len());
        let mut texels = vec![[0u32; 4]; width];
        for (k, pyramid) in pyramids.iter().enumerate() {
            texels[k] = header(pyramid, (texels.len() / width) as u32);
            for level in pyramid.levels() {
                for nodes in level.nodes().chunks(level.size()[0] as usize) {
                    let row = texels.len();
                    texels.extend(nodes.iter().map(|node| {
                        std::array::from_fn(|k| u32::from_le_bytes([0, 1, 2, 3].map(|byte| node[4 * k + byte])))
                    }));
                    texels.resize(row + width, [0; 4]);
                }
            }
        }
        let size = [width as u32, (texels.len() / width) as u32];
        let mut bytes = Vec::with_capacity(texels.len() * 16);
        for channel in texels.iter().flatten() {
            bytes.extend_from_slice(&channel.to_le_bytes());
        }
        let format = TextureFormat::Rgba32Uint;
        Self { format, mips: vec![MipBytes::new(format, size, bytes)] }
    }

    /// Lays out `relievo_cones`: top and slope of each cell's cone, for each mip level of the heights. Where the map has no
    /// cones of this kind it is one texel, by whose size the shader knows that it has to walk cell by cell.
    #[must_use]
    pub fn cones(heights: &ReliefMap, cones: Cones) -> Self {
        let format = TextureFormat::Rg8Uint;
        let Some(maps) = heights.cones(cones) else { return Self::no_cones() };
        let mip = |map: &ConeMap| MipBytes::new(format, map.size(), map.texels().as_flattened().to_vec());
        Self { format, mips: maps.iter().map(mip).collect() }
    }

    /// Lays out `relievo_cones` for a map without cones: one texel that frees nothing.
    #[must_use]
    pub fn no_cones() -> Self {
        let format = TextureFormat::Rg8Uint;
        Self { format, mips: vec![MipBytes::new(format, [1; 2], vec![u8::MAX; 2])] }
    }

    /// Width and height of the full size, in texels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.mips.first().map_or([0; 2], |mip| [mip.width, mip.height])
    }
}

impl MipBytes {
    fn new(format: TextureFormat, [width, height]: [u32; 2], bytes: Vec<u8>) -> Self {
        Self { width, height, bytes_per_row: width * format.bytes_per_texel(), bytes }
    }
}

/// The header of a pyramid whose nodes begin at `row`.
fn header(pyramid: &MaxPyramid, row: u32) -> [u32; 4] {
    let [low, step] = pyramid.quantization();
    [row | pyramid.top() << 24, low.to_bits(), step.to_bits(), pyramid.clearance().to_bits()]
}

#[cfg(test)]
mod tests {
    use relievo_map::HeightMap;

    use super::*;

    #[test]
    fn textures_have_the_bytes_that_their_sizes_say() {
        let map = HeightMap::new(Grid::from_fn(20, 12, |x, y| (x * y) as f32 / 240.0));
        let heights = ReliefMap::with_mips(&map).with_cones(Cones::Relaxed);
        let textures = [
            TextureBytes::heights(&heights),
            TextureBytes::pyramid(&heights),
            TextureBytes::cones(&heights, Cones::Relaxed),
        ];
        for texture in &textures {
            for mip in &texture.mips {
                assert_eq!(mip.bytes_per_row, mip.width * texture.format.bytes_per_texel());
                assert_eq!(mip.bytes.len() as u32, mip.bytes_per_row * mip.height);
            }
        }
        assert_eq!((textures[0].size(), textures[0].mips.len()), ([20, 12], heights.levels().len()));
        assert_eq!((textures[2].size(), textures[2].mips.len()), ([20, 12], heights.levels().len()));
        assert_eq!(textures[0].mips[0].bytes[..4], 0.0f32.to_le_bytes());
        // Row 1 is the first of the nodes; level 1 of 20×12 cells has 5×3 of them.
        let header: Vec<u32> = textures[1].mips[0].bytes.chunks_exact(4).take(4).map(word).collect();
        assert_eq!((header[0] & 0xff_ffff, textures[1].mips[0].width), (1, 5));
        assert_eq!(header[0] >> 24, heights.pyramids()[0].top());
    }

    fn word(bytes: &[u8]) -> u32 {
        u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])
    }

    #[test]
    fn a_map_without_cones_has_one_texel_that_frees_nothing() {
        let heights = ReliefMap::new(&HeightMap::new(Grid::filled(4, 4, 0.5)));
        let cones = TextureBytes::cones(&heights, Cones::Conservative);
        assert_eq!((cones.size(), &cones.mips[0].bytes[..]), ([1, 1], &[255, 255][..]));
    }
}
