use relievo_map::{Grid, Wrap};

use crate::MaxPyramid;
use crate::cone_build;
use crate::pyramid::BITS;

/// Which cones [`crate::Technique::Cone`] steps through.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Cones {
    /// A ray that leaves the cone's cell meets the surface at most once inside the cone (Policarpo and Oliveira 2007): it
    /// may step through the surface, and bisections find the place.
    #[default]
    Relaxed,
    /// Nothing of the surface is inside the cone (Dummer 2006): no step passes a hit.
    Conservative,
}

impl Cones {
    /// Both kinds.
    pub const ALL: [Self; 2] = [Self::Relaxed, Self::Conservative];

    /// The name in scene files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Relaxed => "relaxed",
            Self::Conservative => "conservative",
        }
    }

    /// The kind with this name, if there is one.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|cones| cones.name() == name)
    }
}

/// A slope's code is a small float, 4 bits of exponent before 4 of mantissa: shifted so far it is the middle of an f32.
const CODE_SHIFT: u32 = 19;

/// What is added to a code so shifted: code 240 is 2⁸ codes of height per texel, more than any cell rises above its
/// neighbour.
const CODE_BIAS: u32 = 120 << 23;

/// The cones of one height map, one to a cell.
///
/// A cone stands on the highest corner of its cell, at the height `top`, and its side rises by `slope` per texel. Of a point
/// x of the surface, in a cell that lies a gap of g texels away, it says that x is not higher than `top + slope·(g + 1)`: of
/// every point for [`Cones::Conservative`] cones; for [`Cones::Relaxed`] ones of those that fall on the way outwards, which
/// is where a ray from the cone's cell could leave the surface again. (The generator of GPU Gems 3 looks where rays from the
/// lid leave it, and misses those that set out lower.) So a ray at the height z over any point of the cell, which goes d
/// texels per unit of height, may step down by `(z − top − slope) / (1 + d·slope)`.
///
/// Slopes are heights per texel: the depth of the relief, and the shape of texels, are the ray's, and one map serves all.
/// Both numbers are codes of 8 bits, rounded so that cones get narrower: `top` as in the [`MaxPyramid`], `slope` in steps of
/// 3 to 6 %. Distances are those on the tiling map; `clamp` and `mirror` bring no two places nearer to each other, and serve
/// from the same map.
#[derive(Clone, Debug, PartialEq)]
pub struct ConeMap {
    cones: Cones,
    size: [u32; 2],
    low: f32,
    step: f32,
    texels: Vec<[u8; 2]>,
}

impl ConeMap {
    /// Builds the cones of a height map from its pyramid, on all cores; the result does not depend on their number. In N² log N for
    /// N² texels.
    ///
    /// # Panics
    /// If the pyramid is that of a map of another size.
    #[must_use]
    pub fn build(map: &Grid<f32>, pyramid: &MaxPyramid, cones: Cones) -> Self {
        assert_eq!(pyramid.size(), [map.width(), map.height()], "the pyramid is that of the map");
        let texels = cone_build::build(map, pyramid, cones);
        let [low, step] = pyramid.coding();
        Self { cones, size: pyramid.size(), low, step, texels }
    }

    /// Which cones these are.
    #[must_use]
    pub fn cones(&self) -> Cones {
        self.cones
    }

    /// Cells (and texels) along u and v.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The codes of top and slope of every cell, row by row.
    #[must_use]
    pub fn texels(&self) -> &[[u8; 2]] {
        &self.texels
    }

    /// The height that a cone stands on.
    #[inline]
    #[must_use]
    pub fn top(&self, texel: [u8; 2]) -> f32 {
        self.low + f32::from(texel[0]) * self.step
    }

    /// How much the side of a cone rises, heights per texel.
    #[inline]
    #[must_use]
    pub fn slope(&self, texel: [u8; 2]) -> f32 {
        slope(texel[1]) * self.step
    }

    /// The difference in height between two codes.
    #[inline]
    #[must_use]
    pub fn quantization_step(&self) -> f32 {
        self.step
    }

    /// Bytes of all cones.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(self.texels.as_slice())
    }

    /// Spoils the map: for tests that must notice.
    #[cfg(test)]
    pub(crate) fn map_texels(&mut self, change: impl Fn([u8; 2]) -> [u8; 2]) {
        self.texels.iter_mut().for_each(|texel| *texel = change(*texel));
    }
}

/// The slope that a code stands for, in codes of height per texel.
#[inline]
pub(crate) fn slope(code: u8) -> f32 {
    if code == 0 { 0.0 } else { f32::from_bits(CODE_BIAS + (u32::from(code) << CODE_SHIFT)) }
}

/// The smallest code of a slope that is not below this one, in codes of height per texel, at most 2⁸.
pub(crate) fn slope_code(rise: f64) -> u8 {
    if rise <= 0.0 {
        return 0;
    }
    let code = (rise as f32).to_bits().saturating_sub(CODE_BIAS) >> CODE_SHIFT;
    // One more where something was cut off.
    let code = code.min(254) as u8;
    if code > 0 && f64::from(slope(code)) >= rise { code } else { code + 1 }
}

/// A map's cones, as rays see them.
#[derive(Clone, Copy, Debug)]
pub struct ConeField<'a> {
    pub(crate) map: &'a ConeMap,
    wrap: Wrap,
}

/// Cells until a stretch ends that goes on for ever.
pub(crate) const ENDLESS: i32 = 1 << 30;

impl<'a> ConeField<'a> {
    /// The cones of a map with what lies beyond its borders: what [`crate::HeightField::cones`] gives.
    #[must_use]
    pub fn new(map: &'a ConeMap, wrap: Wrap) -> Self {
        Self { map, wrap }
    }

    /// The cone of a cell, any of the endless rows and columns.
    #[inline]
    pub(crate) fn at(&self, cell: [i32; 2]) -> [u8; 2] {
        let [x, y] = [0, 1].map(|k| {
            let index = |i: i32| self.wrap.index(i, self.map.size[k]);
            match self.wrap {
                Wrap::Repeat => index(cell[k]),
                // A cell lies between two texels; where the map is mirrored, they come in the other order.
                Wrap::Clamp | Wrap::Mirror => index(cell[k]).min(index(cell[k].wrapping_add(1))),
            }
        });
        self.map.texels[y as usize * self.map.size[0] as usize + x as usize]
    }

    /// How many cells a ray that goes by `step` (±1) along an axis enters from cell `i` until it is where the relaxed cone of
    /// that cell tells nothing: a tile away, or beyond the border where what lies behind is another map's neighbourhood.
    #[inline]
    pub(crate) fn reach(&self, i: i32, step: i32, axis: usize) -> i32 {
        let n = self.map.size[axis] as i32;
        // The cells on a border that is not the tiling map's are a stretch of their own.
        let [up, down] = match self.wrap {
            Wrap::Repeat => [n, n],
            Wrap::Clamp => match i {
                i if i < 0 => [i.saturating_neg(), ENDLESS],
                i if i < n - 1 => [n - 1 - i, i + 1],
                i => [ENDLESS, i - n + 2],
            },
            Wrap::Mirror => match i.wrapping_add(1).rem_euclid(2 * n) {
                r if r % n == 0 => [1, 1],
                r if r < n => [n - r, r],
                r => [2 * n - r, r - n],
            },
        };
        if step > 0 { up } else { down }
    }
}

/// What cones are built from: the codes of a pyramid's blocks. Level 0 are cells, one of level l spans 4^l of them.
pub(crate) fn block_code(pyramid: &MaxPyramid, level: u32, [x, y]: [u32; 2]) -> u8 {
    if level == pyramid.top() {
        return pyramid.level(level).nodes()[0].into_iter().fold(0, u8::max);
    }
    let nodes = pyramid.level(level + 1);
    let node = &nodes.nodes()[((y >> BITS) * nodes.size()[0] + (x >> BITS)) as usize];
    node[((y & 3) * 4 + (x & 3)) as usize]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_rounded_up_and_by_less_than_a_sixteenth() {
        assert_eq!((slope_code(0.0), slope(0)), (0, 0.0));
        assert!(slope(240) == 256.0 && slope(248) == 384.0);
        for i in 0..20_000 {
            let rise = 256.0 * (-f64::from(i) * 6e-4).exp();
            let rounded = f64::from(slope(slope_code(rise)));
            assert!(rounded >= rise && (rounded < rise * 1.0626 || slope_code(rise) == 1), "{rise}: {rounded}");
        }
        assert!((0..=255).all(|code| slope_code(slope(code).into()) == code));
    }

    #[test]
    fn cells_beyond_the_border_have_the_cones_of_those_whose_texels_they_show() {
        let map = Grid::from_fn(3, 1, |x, _| x as f32 / 2.0);
        let mut cones = ConeMap::build(&map, &MaxPyramid::build(&map, false), Cones::Relaxed);
        cones.texels = vec![[0, 0], [1, 0], [2, 0]];
        let seen =
            |wrap| (-5..8).map(|i| ConeField::new(&cones, wrap).at([i, 0])[0]).map(i32::from).collect::<Vec<_>>();
        assert_eq!(seen(Wrap::Repeat), [1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1]);
        assert_eq!(seen(Wrap::Clamp), [0, 0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2, 2]);
        // Texels 1 2 2 1 0 0 1 2 2 1 0 0 1 2 from −5 on.
        assert_eq!(seen(Wrap::Mirror), [1, 2, 1, 0, 0, 0, 1, 2, 1, 0, 0, 0, 1]);
        let ends = |wrap, step| (-5..8).map(|i| ConeField::new(&cones, wrap).reach(i, step, 0)).collect::<Vec<_>>();
        let never = ENDLESS;
        assert_eq!(ends(Wrap::Repeat, 1), [3; 13]);
        assert_eq!(ends(Wrap::Clamp, 1)[..7], [5, 4, 3, 2, 1, 2, 1]);
        assert_eq!(ends(Wrap::Clamp, 1)[7..], [never; 6]);
        assert_eq!(ends(Wrap::Clamp, -1)[..5], [never; 5]);
        assert_eq!(ends(Wrap::Clamp, -1)[5..], [1, 2, 1, 2, 3, 4, 5, 6]);
        // Cells −4, −1, 2, 5 stand between a texel and its image.
        assert_eq!(ends(Wrap::Mirror, 1), [1, 1, 2, 1, 1, 2, 1, 1, 2, 1, 1, 2, 1]);
        assert_eq!(ends(Wrap::Mirror, -1), [2, 1, 1, 2, 1, 1, 2, 1, 1, 2, 1, 1, 2]);
    }
}
