use super::height_field::HeightField;

/// The largest distance of a hit from the wall that it counts as lying on, in texels.
const REACH: f32 = 1.0 / 16.0;

/// The distance in height from a column's top within which a hit lies on the top, as a fraction of the full depth: hits are
/// known to about 1e-6.
const TOP: f32 = 1e-4;

/// The way down along a wall that the march may go on beyond a hit, as a fraction of the full depth.
const DEEPER: f32 = 2e-3;

/// The distance from a wall at which rays leave it, in texels: more than the march goes into the wall's column.
const BESIDE: f32 = 1.0 / 256.0;

/// A wall between two columns of a nearest-filtered map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColumnWall {
    /// Direction across the wall from the higher column to the lower one: 1 or −1 along u or along v.
    pub outward: [f32; 2],
    /// A uv a hair beyond the wall, over the lower column: rays that leave the wall start there.
    pub beside: [f32; 2],
}

impl ColumnWall {
    /// Returns the wall that a hit of a march lies on; `None` on the top of a column, and where the field is filtered otherwise.
    #[must_use]
    pub fn at(field: &impl HeightField, uv: [f32; 2], depth: f32) -> Option<Self> {
        if field.texel_offset() != 0.0 || !uv.iter().all(|x| x.is_finite()) {
            return None;
        }
        let size = field.size().map(|n| n as f32);
        let x = [0, 1].map(|k| uv[k] * size[k]);
        let cell = x.map(|x| x.floor() as i32);
        let height = 1.0 - depth;
        let mut nearest = REACH;
        let mut wall = None;
        for k in 0..2 {
            let edge = x[k].round();
            let distance = (x[k] - edge).abs();
            if distance > nearest {
                continue;
            }
            let top = |i: i32| {
                let [i, j] = if k == 0 { [i, cell[1]] } else { [cell[0], i] };
                field.corners(i, j)[0]
            };
            let [before, after] = [edge as i32 - 1, edge as i32].map(top);
            let inside_higher = (x[k] < edge) == (before > after);
            // The march goes a hair into a wall, maybe deeper than its foot.
            let foot = before.min(after) + if inside_higher { -DEEPER } else { TOP };
            if !(height > foot && height < before.max(after) - TOP) {
                continue;
            }
            nearest = distance;
            let sign = if before > after { 1.0 } else { -1.0 };
            let (mut outward, mut beside) = ([0.0; 2], uv);
            outward[k] = sign;
            beside[k] = (edge + sign * BESIDE.max(edge.abs() * 4.0 * f32::EPSILON)) / size[k];
            wall = Some(Self { outward, beside });
        }
        wall
    }
}

#[cfg(test)]
mod tests {
    use relievo_map::{Grid, HeightMap, Wrap};

    use super::*;
    use crate::{MarchOptions, Ray, ReliefMap, SurfaceAxes, Technique, march};

    #[test]
    fn hits_between_two_tops_lie_on_the_wall_that_the_ray_came_through() {
        let map = HeightMap::new(Grid::from_fn(4, 4, |x, y| ((x * 7 + y * 5) % 11) as f32 / 10.0));
        let heights = ReliefMap::nearest(&map);
        let field = heights.field(0.0, Wrap::Repeat);
        let axes = SurfaceAxes { dp_du: [1.0, 0.0, 0.0], dp_dv: [0.0, -1.0, 0.0], normal: [0.0, 0.0, 1.0] };
        let options = MarchOptions { technique: Technique::Exact, ..MarchOptions::default() };
        let (mut walls, mut tops) = (0, 0);
        for i in 1..4000u32 {
            let angle = i as f32 * 2.399_963;
            let to_eye = [0.7 * angle.cos(), 0.7 * angle.sin(), 0.714_142_8];
            let uv = [(i as f32 * 0.754_877_7).fract() + 12.0, (i as f32 * 0.569_840_3).fract() - 7.0];
            let record = march(&field, &Ray::from_surface(uv, to_eye, &axes, 0.3), &options);
            assert!(record.hit);
            let top = field.sample(record.uv);
            let from_border = |k: usize| (record.uv[k] * 4.0 - (record.uv[k] * 4.0).round()).abs();
            if from_border(0).max(from_border(1)) < 2e-3 {
                // An edge between two walls belongs to either.
                continue;
            }
            match ColumnWall::at(&field, record.uv, record.depth) {
                None => {
                    assert!((1.0 - record.depth - top).abs() < 2e-4, "{record:?} lies below the top {top}");
                    tops += 1;
                }
                Some(wall) => {
                    // Towards the eye, v running down; and the lower column is beside it.
                    let towards_eye = wall.outward[0] * to_eye[0] - wall.outward[1] * to_eye[1];
                    assert!(towards_eye > 0.0, "{record:?} {wall:?}");
                    assert!(field.sample(wall.beside) < 1.0 - record.depth + DEEPER, "{record:?} {wall:?}");
                    walls += 1;
                }
            }
        }
        assert!(walls > 500 && tops > 500, "{walls} walls, {tops} tops");
        let linear = ReliefMap::new(&map);
        assert_eq!(ColumnWall::at(&linear.field(0.0, Wrap::Repeat), [0.5, 0.5], 0.5), None);
        assert_eq!(ColumnWall::at(&field, [f32::NAN, 0.5], 0.5), None);
    }
}
