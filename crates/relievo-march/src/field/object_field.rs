use super::height_field::HeightField;
use super::relief_map::HeightFieldView;
use crate::{Bounds, ConeField, Cones, PyramidField};

/// A height map on a chart with a texture range of its own.
#[derive(Clone, Copy, Debug)]
pub enum ObjectField<'a> {
    /// Addressed everywhere by the map's wrap mode.
    Tiled(HeightFieldView<'a>),
    /// Addressed by the map's wrap mode inside the chart's texture range; beyond it the border stretches (`edge = "clamp"`).
    Stretched {
        /// The field inside the range.
        field: HeightFieldView<'a>,
        /// The first and the last texel of the range along u and v.
        texels: [[i32; 2]; 2],
    },
}

impl<'a> ObjectField<'a> {
    /// Wraps the field as it is, or stretched beyond the range `stretched`.
    #[must_use]
    pub fn new(field: HeightFieldView<'a>, stretched: Option<Bounds>) -> Self {
        stretched.map_or(Self::Tiled(field), |range| Self::stretched(field, range))
    }

    fn stretched(field: HeightFieldView<'a>, range: Bounds) -> Self {
        Self::Stretched { field, texels: range.texels(field.size()) }
    }
}

impl HeightField for ObjectField<'_> {
    #[inline]
    fn size(&self) -> [u32; 2] {
        match self {
            Self::Tiled(field) | Self::Stretched { field, .. } => field.size(),
        }
    }

    #[inline]
    fn corners(&self, i: i32, j: i32) -> [f32; 4] {
        match self {
            Self::Tiled(field) => field.corners(i, j),
            Self::Stretched { field, texels: [columns, rows] } => {
                let inside = |i: i32, [first, last]: [i32; 2]| i.max(first).min(last);
                let [h00, mut h10, mut h01, mut h11] = field.corners(inside(i, *columns), inside(j, *rows));
                // Columns have the texel's height all over; on and beyond the border both corners are the border's.
                if field.texel_offset() == 0.0 {
                    return [h00; 4];
                }
                if i < columns[0] || i >= columns[1] {
                    (h10, h11) = (h00, h01);
                }
                if j < rows[0] || j >= rows[1] {
                    (h01, h11) = (h00, h10);
                }
                [h00, h10, h01, h11]
            }
        }
    }

    #[inline]
    fn sample(&self, uv: [f32; 2]) -> f32 {
        match self {
            Self::Tiled(field) => field.sample(uv),
            Self::Stretched { field, texels } => {
                let size = field.size().map(|n| n as f32);
                let at = |k: usize| {
                    let [first, last] = texels[k];
                    inset(uv[k], 0.5 / size[k], [first as f32 / size[k], (last + 1) as f32 / size[k]])
                };
                field.sample([at(0), at(1)])
            }
        }
    }

    #[inline]
    fn range(&self) -> [f32; 2] {
        match self {
            Self::Tiled(field) | Self::Stretched { field, .. } => field.range(),
        }
    }

    #[inline]
    fn quantization_step(&self) -> f32 {
        match self {
            Self::Tiled(field) | Self::Stretched { field, .. } => field.quantization_step(),
        }
    }

    #[inline]
    fn texel_offset(&self) -> f32 {
        match self {
            Self::Tiled(field) | Self::Stretched { field, .. } => field.texel_offset(),
        }
    }

    #[inline]
    fn pyramid(&self) -> Option<PyramidField<'_>> {
        match self {
            Self::Tiled(field) => field.pyramid(),
            // Its border is not the map's.
            Self::Stretched { .. } => None,
        }
    }

    #[inline]
    fn cones(&self, cones: Cones) -> Option<ConeField<'_>> {
        match self {
            Self::Tiled(field) => field.cones(cones),
            Self::Stretched { .. } => None,
        }
    }
}

/// Returns the nearest coordinate in a range that keeps this distance from both ends (the middle, where that is too much).
///
/// Kept inside by half a texel, a filtered sample takes nothing of the neighbour tile.
#[inline]
#[must_use]
pub fn inset(x: f32, distance: f32, [start, end]: [f32; 2]) -> f32 {
    let distance = distance.min(0.5 * (end - start));
    x.max(start + distance).min(end - distance)
}

#[cfg(test)]
mod tests {
    use relievo_map::{Grid, HeightMap, Wrap};

    use super::*;
    use crate::ReliefMap;

    #[test]
    fn a_stretched_field_is_tiled_inside_and_constant_beyond_and_its_cells_agree_with_its_samples() {
        let heights = ReliefMap::new(&HeightMap::new(Grid::from_fn(4, 2, |x, y| (x * 3 + y * 5) as f32 / 20.0)));
        let tiled = heights.field(0.0, Wrap::Repeat);
        let field = ObjectField::stretched(tiled, Bounds { min: [0.0; 2], max: [2.5, 1.5] });
        for j in -3..7 {
            for i in -4..15 {
                for (a, b) in [(0.2f32, 0.7f32), (0.9, 0.4)] {
                    let [h00, h10, h01, h11] = field.corners(i, j);
                    let interpolated = (h00 * (1.0 - a) + h10 * a) * (1.0 - b) + (h01 * (1.0 - a) + h11 * a) * b;
                    let uv = [(i as f32 + 0.5 + a) / 4.0, (j as f32 + 0.5 + b) / 2.0];
                    assert!((field.sample(uv) - interpolated).abs() < 1e-5, "cell {i}, {j}");
                    if (0..9).contains(&i) && (0..2).contains(&j) {
                        assert_eq!(field.corners(i, j), tiled.corners(i, j));
                    }
                }
            }
        }
        assert_eq!(field.sample([9.0, 9.0]), field.sample([2.4, 1.3]));
        assert_eq!(field.sample([-9.0, -9.0]), field.sample([0.1, 0.1]));
    }

    #[test]
    fn an_inset_wider_than_the_range_gives_its_middle() {
        let unit = [0.0, 1.0];
        assert_eq!([inset(-1.0, 0.1, unit), inset(0.4, 0.1, unit), inset(0.2, 3.0, unit)], [0.1, 0.4, 0.5]);
        assert_eq!([inset(0.0, 0.25, [2.0, 3.0]), inset(9.0, 0.25, [2.0, 3.0])], [2.25, 2.75]);
    }
}
