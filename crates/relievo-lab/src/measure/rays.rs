use std::f32::consts::TAU;

use relievo_march::Ray;

/// Size of a tile in rays, along u and v.
pub(crate) const TILE: [u32; 2] = [8, 4];

/// Number of rays in a tile.
pub(crate) const TILE_RAYS: u32 = TILE[0] * TILE[1];

/// Generates at least `count` rays in tiles of 8×4 parallel neighbours a texel apart, from all sides at one angle from the
/// normal.
///
/// `size` is that of the map (or mip level) that is marched. `depth` is the full depth as a fraction of a repeat along u and
/// v. A larger `count` appends tiles: the first ones stay the same.
pub(crate) fn tiles(size: [u32; 2], depth: [f32; 2], degrees: f32, count: u32) -> Vec<Ray> {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let size = size.map(|n| n as f32);
    (0..count.div_ceil(TILE_RAYS))
        .flat_map(|tile| {
            let azimuth = r_sequence(tile, 2) * TAU;
            let view = [sin * azimuth.cos(), sin * azimuth.sin(), cos];
            (0..TILE_RAYS).map(move |k| {
                let at = [k % TILE[0], k / TILE[0]];
                let uv = [0, 1].map(|axis| r_sequence(tile, axis) + at[axis] as f32 / size[axis]);
                Ray::from_view(uv, view, [depth[0], -depth[1]])
            })
        })
        .collect()
}

/// The R sequence (Roberts 2018): fractions that fill the unit cube evenly.
fn r_sequence(i: u32, axis: usize) -> f32 {
    (0.5 + f64::from(i) * [0.819_172_513_4, 0.671_043_606_7, 0.549_700_477_9][axis]).fract() as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_of_a_tile_are_parallel_and_a_texel_apart() {
        let rays = tiles([64, 32], [0.1, 0.2], 60.0, 100);
        assert_eq!(rays.len(), 128);
        for tile in rays.chunks(32) {
            assert!(tile.iter().all(|ray| (ray.uv_delta, ray.cos) == (tile[0].uv_delta, tile[0].cos)));
            assert!((tile[1].uv[0] - tile[0].uv[0] - 1.0 / 64.0).abs() < 1e-6);
            assert!((tile[8].uv[1] - tile[0].uv[1] - 1.0 / 32.0).abs() < 1e-6);
        }
        assert_ne!(rays[0].uv_delta, rays[32].uv_delta);
        assert_eq!(tiles([64, 32], [0.1, 0.2], 60.0, 9999)[..128], rays);
    }
}
