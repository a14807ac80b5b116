//! Mip levels with the variance of the normals within a texel, by which highlights widen as a surface is minified.

use super::grid::Grid;
use super::maps::{HeightMap, NormalMap};
use super::mip_map::MipMap;
use super::wrap::Wrap;

impl NormalMap {
    /// Builds mip levels of x, y and z of the mean normal and the length of that mean (Toksvig 2005): 1 where all
    /// normals of a texel are equal, less the more they vary.
    ///
    /// The length is a channel of its own because interpolation between different texels also shortens the vector,
    /// where a surface is magnified and nothing has been averaged. Level 0 is the map itself, with length 1.
    #[must_use]
    pub fn toksvig_mips(&self) -> MipMap<[f32; 4]> {
        let unit = |n: &[f32; 3]| {
            let length = n.iter().map(|x| x * x).sum::<f32>().sqrt();
            if length > 0.0 { n.map(|x| x / length) } else { [0.0, 0.0, 1.0] }
        };
        let grid = self.grid();
        let units = Grid::from_fn(grid.width(), grid.height(), |x, y| unit(grid.get(x, y)));
        let mean = |&[x, y, z]: &[f32; 3]| [x, y, z, (x * x + y * y + z * z).sqrt().min(1.0)];
        let base = Grid::from_fn(grid.width(), grid.height(), |x, y| {
            let [x, y, z] = *grid.get(x, y);
            [x, y, z, 1.0]
        });
        MipMap::build(units).map_levels(|level, texels| if level == 0 { base.clone() } else { texels.map(mean) })
    }
}

impl HeightMap {
    /// Builds mip levels of the covariance of the slopes within a texel: the variances along u and v, and the
    /// covariance.
    ///
    /// Slopes are heights per texel of the full-size map (central differences). Level 0 is 0: a texel has one slope.
    #[must_use]
    pub fn slope_covariance_mips(&self, wrap: Wrap) -> MipMap<[f32; 3]> {
        let grid = self.grid();
        let (w, h) = (grid.width(), grid.height());
        let at = |x: i32, y: i32| *grid.get(wrap.index(x, w), wrap.index(y, h));
        let moments = Grid::from_fn(w, h, |x, y| {
            let (x, y) = (x as i32, y as i32);
            let slope = [at(x + 1, y) - at(x - 1, y), at(x, y + 1) - at(x, y - 1)].map(|d| 0.5 * d);
            [slope[0], slope[1], slope[0] * slope[0], slope[1] * slope[1], slope[0] * slope[1]]
        });
        // Second moments less the square of the first; rounding may leave a hair below 0.
        let scatter = |&[x, y, xx, yy, xy]: &[f32; 5]| [(xx - x * x).max(0.0), (yy - y * y).max(0.0), xy - x * y];
        MipMap::build(moments).map_levels(|level, texels| {
            if level == 0 { Grid::from_fn(w, h, |_, _| [0.0; 3]) } else { texels.map(scatter) }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_normal_is_shorter_the_more_normals_scatter_and_level_0_is_as_it_was() {
        // Two normals 2·φ apart, in columns: their mean has the length cos φ.
        for phi in [0.1f32, 0.4, 1.0] {
            let lean = |x: u32| if x.is_multiple_of(2) { phi.sin() } else { -phi.sin() };
            let map = NormalMap::from_unit(Grid::from_fn(8, 4, |x, _| [lean(x), 0.0, phi.cos()]));
            let mips = map.toksvig_mips();
            assert!(mips.base().texels().iter().zip(map.grid().texels()).all(|(a, b)| a[..3] == b[..] && a[3] == 1.0));
            for level in &mips.levels()[1..] {
                assert!(level.texels().iter().all(|t| (t[3] - phi.cos()).abs() < 1e-6 && t[0].abs() < 1e-6), "{phi}");
            }
        }
        let flat = NormalMap::from_unit(Grid::from_fn(8, 8, |_, _| [0.0, 0.0, 1.0])).toksvig_mips();
        assert!(flat.levels().iter().all(|level| level.texels().iter().all(|&t| t == [0.0, 0.0, 1.0, 1.0])));
    }

    #[test]
    fn slopes_scatter_as_their_moments_say() {
        // A ramp has one slope, but at its seam; a zigzag of period 4 along u has ±1/4.
        let zigzag = [0.0f32, 0.25, 0.5, 0.25];
        let map = HeightMap::new(Grid::from_fn(16, 8, |x, _| zigzag[x as usize % 4]));
        let mips = map.slope_covariance_mips(Wrap::Repeat);
        assert!(mips.base().texels().iter().all(|&t| t == [0.0; 3]));
        // Central differences see 0 at the turns and ±1/4 between: variance 1/32 over a period.
        for level in &mips.levels()[2..] {
            assert!(level.texels().iter().all(|&[xx, yy, xy]| (xx - 0.03125).abs() < 1e-6 && yy == 0.0 && xy == 0.0));
        }
        let ramp = HeightMap::new(Grid::from_fn(16, 16, |x, y| (x + y) as f32 / 32.0));
        let inner = ramp.slope_covariance_mips(Wrap::Clamp);
        assert!(inner.levels()[1].get(3, 3).iter().all(|x| x.abs() < 1e-9));
    }
}
