use relievo_map::{Grid, HeightMap, MipMap, Wrap};

use super::height_field::HeightField;
use crate::grid_line::TEXEL_CENTER;
use crate::{ConeField, ConeMap, Cones, MaxPyramid, PyramidField, TexelRect};

/// A height map prepared for marching: its mip levels, the range of each, pyramids and cones.
#[derive(Clone, Debug)]
pub struct ReliefMap {
    mips: MipMap<f32>,
    ranges: Vec<[f32; 2]>,
    pyramids: Vec<MaxPyramid>,
    /// The cones of every mip level, for each kind that was asked for.
    cones: Vec<Vec<ConeMap>>,
    step: f32,
    filtered_in_8_bits: bool,
    nearest: bool,
}

impl ReliefMap {
    /// Prepares level 0 alone: every `lod` samples the full-size map.
    #[must_use]
    pub fn new(map: &HeightMap) -> Self {
        Self::from_mips(MipMap::single(map.grid().clone()), map.is_8_bit())
    }

    /// Prepares all mip levels, for trilinear filtering and level of detail.
    #[must_use]
    pub fn with_mips(map: &HeightMap) -> Self {
        Self::from_mips(MipMap::build(map.grid().clone()), map.is_8_bit())
    }

    /// Prepares level 0 alone, every texel as a column with a flat top (nearest filtering): for pixel art. The exact march
    /// finds tops and walls, cell by cell; there are no pyramids and cones.
    #[must_use]
    pub fn nearest(map: &HeightMap) -> Self {
        Self::columns(map, map.is_8_bit())
    }

    /// Prepares heights that change from one moment to the next, with mip levels or without: they are of no file, and never
    /// taken for those of an 8-bit one.
    #[must_use]
    pub fn of_changing(map: &HeightMap, with_mips: bool) -> Self {
        let grid = map.grid().clone();
        Self::from_mips(if with_mips { MipMap::build(grid) } else { MipMap::single(grid) }, false)
    }

    /// Prepares heights that change, every texel as a column: see [`ReliefMap::nearest`] and [`ReliefMap::of_changing`].
    #[must_use]
    pub fn nearest_of_changing(map: &HeightMap) -> Self {
        Self::columns(map, false)
    }

    fn columns(map: &HeightMap, is_8_bit: bool) -> Self {
        Self { nearest: true, ..Self::with_pyramids(MipMap::single(map.grid().clone()), is_8_bit, Vec::new()) }
    }

    fn from_mips(mips: MipMap<f32>, is_8_bit: bool) -> Self {
        let pyramid = MaxPyramid::build(mips.base(), is_8_bit);
        Self::with_pyramid(mips, is_8_bit, pyramid)
    }

    fn with_pyramid(mips: MipMap<f32>, is_8_bit: bool, pyramid: MaxPyramid) -> Self {
        let smaller = mips.levels()[1..].iter().map(|level| MaxPyramid::build(level, false));
        let pyramids = std::iter::once(pyramid).chain(smaller).collect();
        Self::with_pyramids(mips, is_8_bit, pyramids)
    }

    fn with_pyramids(mips: MipMap<f32>, is_8_bit: bool, pyramids: Vec<MaxPyramid>) -> Self {
        let range = |texels: &[f32]| texels.iter().fold([1.0f32, 0.0f32], |[low, high], &h| [low.min(h), high.max(h)]);
        let ranges = mips.levels().iter().map(|level| range(level.texels())).collect();
        let step = if is_8_bit { 1.0 / 255.0 } else { 0.0 };
        Self { mips, ranges, pyramids, cones: Vec::new(), step, filtered_in_8_bits: false, nearest: false }
    }

    /// Builds cones of this kind for every mip level, for [`crate::Technique::Cone`]. For a map of 1024² texels they take a
    /// second or more, so nothing else builds them. A map of columns has none.
    #[must_use]
    pub fn with_cones(mut self, cones: Cones) -> Self {
        if !self.nearest && self.cones(cones).is_none() {
            let levels = self.mips.levels().iter().zip(&self.pyramids);
            self.cones.push(levels.map(|(map, pyramid)| ConeMap::build(map, pyramid, cones)).collect());
        }
        self
    }

    /// Takes over a map of which only the texels in `dirty` have changed: for painting and animation. The pyramid of the
    /// full-size map is updated in part; the mip levels' pyramids and cones, where there are any, are built anew.
    ///
    /// # Panics
    /// If the map has another size, or `dirty` is not inside it.
    pub fn update(&mut self, map: &HeightMap, dirty: TexelRect) {
        let is_8_bit = map.is_8_bit();
        let grid = map.grid().clone();
        let mips = if self.mips.levels().len() > 1 { MipMap::build(grid) } else { MipMap::single(grid) };
        let mut updated = if self.nearest {
            Self::nearest(map)
        } else {
            let mut pyramid = self.pyramids.swap_remove(0);
            pyramid.update(map.grid(), dirty, is_8_bit);
            Self::with_pyramid(mips, is_8_bit, pyramid)
        };
        updated.filtered_in_8_bits = self.filtered_in_8_bits;
        for levels in &self.cones {
            updated = updated.with_cones(levels[0].cones());
        }
        *self = updated;
    }

    /// Filters the full-size map in 8-bit arithmetic: every interpolation is rounded to a multiple of 1/255.
    ///
    /// Software OpenGL filters 8-bit textures so, and the tutorials' pictures were drawn with it: half a step of height is
    /// visible at grazing angles. Only [`HeightField::sample`] changes; the cells of the exact march stay exact.
    #[must_use]
    pub fn filtered_in_8_bits(self) -> Self {
        Self { filtered_in_8_bits: true, ..self }
    }

    /// Returns true if texels are columns: see [`ReliefMap::nearest`].
    #[must_use]
    pub fn is_sampled_nearest(&self) -> bool {
        self.nearest
    }

    /// Returns the field at mip level `lod` (0 = full size). Filtered samples interpolate the two levels around it; cells are
    /// those of the nearest one.
    #[must_use]
    pub fn field(&self, lod: f32, wrap: Wrap) -> HeightFieldView<'_> {
        let last = self.ranges.len() - 1;
        // `max` first: it also turns NaN into 0.
        let lod = lod.max(0.0).min(last as f32);
        let level = lod.round() as usize;
        HeightFieldView {
            heights: self,
            lod,
            level,
            range: self.ranges[level],
            wrap,
            cells: &self.mips.levels()[level],
        }
    }

    /// Returns the mip levels, the full-size map first: for marches elsewhere, such as on a GPU.
    #[must_use]
    pub fn levels(&self) -> &[Grid<f32>] {
        self.mips.levels()
    }

    /// Returns heights that no texel of any mip level falls below and none rises above.
    #[must_use]
    pub fn range(&self) -> [f32; 2] {
        self.ranges[0]
    }

    /// Returns the max pyramid of every mip level: none of a map of columns.
    #[must_use]
    pub fn pyramids(&self) -> &[MaxPyramid] {
        &self.pyramids
    }

    /// Returns the cones of every mip level, if [`ReliefMap::with_cones`] asked for them.
    #[must_use]
    pub fn cones(&self, cones: Cones) -> Option<&[ConeMap]> {
        self.cones.iter().find(|levels| levels[0].cones() == cones).map(Vec::as_slice)
    }

    /// Returns true if samples are filtered in 8-bit arithmetic: see [`ReliefMap::filtered_in_8_bits`].
    #[must_use]
    pub fn is_filtered_in_8_bits(&self) -> bool {
        self.filtered_in_8_bits
    }

    /// Returns the smallest difference in height that the map resolves: 1/255 for 8-bit maps, else 0.
    #[must_use]
    pub fn quantization_step(&self) -> f32 {
        self.step
    }

    /// Returns the texels of the full-size map along u and v.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [self.mips.base().width(), self.mips.base().height()]
    }
}

/// [`ReliefMap`] at one level of detail, with an addressing mode.
#[derive(Clone, Copy, Debug)]
pub struct HeightFieldView<'a> {
    heights: &'a ReliefMap,
    lod: f32,
    /// The level whose cells are marched.
    level: usize,
    cells: &'a Grid<f32>,
    range: [f32; 2],
    wrap: Wrap,
}

impl HeightField for HeightFieldView<'_> {
    #[inline]
    fn size(&self) -> [u32; 2] {
        [self.cells.width(), self.cells.height()]
    }

    #[inline]
    fn corners(&self, i: i32, j: i32) -> [f32; 4] {
        let [w, h] = self.size();
        let texels = self.cells.texels();
        let row = |j: i32| {
            let start = self.wrap.index(j, h) as usize * w as usize;
            &texels[start..start + w as usize]
        };
        if self.heights.nearest {
            return [row(j)[self.wrap.index(i, w) as usize]; 4];
        }
        let (top, bottom) = (row(j), row(j.wrapping_add(1)));
        let (x0, x1) = (self.wrap.index(i, w) as usize, self.wrap.index(i.wrapping_add(1), w) as usize);
        [top[x0], top[x1], bottom[x0], bottom[x1]]
    }

    #[inline]
    fn sample(&self, uv: [f32; 2]) -> f32 {
        if self.heights.nearest {
            let [w, h] = self.size();
            let texel = |x: f32, n: u32| (x * n as f32).floor() as i32;
            return self.corners(texel(uv[0], w), texel(uv[1], h))[0];
        }
        if self.heights.filtered_in_8_bits && self.lod == 0.0 {
            let lerp = |a: f32, b: f32, t: f32| ((a + (b - a) * t) * 255.0).round() / 255.0;
            return self.heights.mips.base().sample_with(uv, self.wrap, lerp);
        }
        self.heights.mips.sample(uv, self.lod, self.wrap)
    }

    #[inline]
    fn range(&self) -> [f32; 2] {
        self.range
    }

    #[inline]
    fn quantization_step(&self) -> f32 {
        self.heights.step
    }

    #[inline]
    fn texel_offset(&self) -> f32 {
        if self.heights.nearest { 0.0 } else { TEXEL_CENTER }
    }

    #[inline]
    fn pyramid(&self) -> Option<PyramidField<'_>> {
        let pyramid = self.heights.pyramids.get(self.level)?;
        Some(PyramidField { cells: self.cells, pyramid, wrap: self.wrap })
    }

    #[inline]
    fn cones(&self, cones: Cones) -> Option<ConeField<'_>> {
        Some(ConeField::new(&self.heights.cones(cones)?[self.level], self.wrap))
    }
}
