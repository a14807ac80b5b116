//! Analytic height fields, for tests and measurements: the hits of a march can be compared with a closed form.
//!
//! Each `…_height` function is a height in [0, 1] at (u, v), lengths in uv; nothing repeats by itself. Each map samples
//! its function at the texel centres, ((x + 0.5) / width, (y + 0.5) / height), and rounds to f32.
//!
//! # Panics
//! The functions that make maps panic if a side is 0 or over [`Grid::MAX_SIDE`], as [`Grid::from_fn`] does. Degenerate
//! shapes (a radius of 0 or less, a direction of no length) are flat.

use relievo_map::{Grid, HeightMap};

/// Samples any height function of (u, v) to a map of `width × height` texels.
#[must_use]
pub fn sampled(width: u32, height: u32, f: impl Fn(f64, f64) -> f64) -> HeightMap {
    let (w, h) = (f64::from(width), f64::from(height));
    HeightMap::new(Grid::from_fn(width, height, |x, y| f((f64::from(x) + 0.5) / w, (f64::from(y) + 0.5) / h) as f32))
}

/// The height `level` everywhere.
#[must_use]
pub fn plane(width: u32, height: u32, level: f32) -> HeightMap {
    HeightMap::new(Grid::from_fn(width, height, |_, _| level))
}

/// A ramp that rises along `direction` (du, dv) from 0 at one end of the square to 1 at the other:
/// `½ + ((u − ½)·du + (v − ½)·dv) / (|du| + |dv|)`, so `u` for \[1, 0\] and `1 − v` for \[0, −1\].
#[must_use]
pub fn ramp_height(u: f64, v: f64, direction: [f64; 2]) -> f64 {
    let [du, dv] = direction;
    let length = du.abs() + dv.abs();
    if length > 0.0 { 0.5 + ((u - 0.5) * du + (v - 0.5) * dv) / length } else { 0.5 }
}

/// A map of [`ramp_height`].
#[must_use]
pub fn ramp(width: u32, height: u32, direction: [f64; 2]) -> HeightMap {
    sampled(width, height, |u, v| ramp_height(u, v, direction))
}

/// Waves: `½ + ½ · cos(2π·cycles_u·u) · cos(2π·cycles_v·v)`. With 0 cycles along one side, a plain wave along the other.
/// Periodic, highest at (0, 0).
#[must_use]
pub fn sine_height(u: f64, v: f64, cycles_u: u32, cycles_v: u32) -> f64 {
    let wave = |x: f64, cycles: u32| (std::f64::consts::TAU * f64::from(cycles) * x).cos();
    0.5 + 0.5 * wave(u, cycles_u) * wave(v, cycles_v)
}

/// A map of [`sine_height`].
#[must_use]
pub fn sine(width: u32, height: u32, cycles_u: u32, cycles_v: u32) -> HeightMap {
    sampled(width, height, |u, v| sine_height(u, v, cycles_u, cycles_v))
}

/// A hemisphere on a floor of 0: `√(1 − r²/radius²)` within `radius` of `center`. A true sphere where the height scale
/// equals `radius`, else an ellipsoid.
#[must_use]
pub fn hemisphere_height(u: f64, v: f64, center: [f64; 2], radius: f64) -> f64 {
    let r = distance(u, v, center);
    if r < radius { (1.0 - (r / radius).powi(2)).sqrt() } else { 0.0 }
}

/// A map of [`hemisphere_height`].
#[must_use]
pub fn hemisphere(width: u32, height: u32, center: [f64; 2], radius: f64) -> HeightMap {
    sampled(width, height, |u, v| hemisphere_height(u, v, center, radius))
}

/// A wedge lying on a floor of 0, its ridge along v at u = `center`: `1 − |u − center| / half_width`, not below 0.
#[must_use]
pub fn wedge_height(u: f64, center: f64, half_width: f64) -> f64 {
    let x = (u - center).abs();
    if x < half_width { 1.0 - x / half_width } else { 0.0 }
}

/// A map of [`wedge_height`].
#[must_use]
pub fn wedge(width: u32, height: u32, center: f64, half_width: f64) -> HeightMap {
    sampled(width, height, |u, _| wedge_height(u, center, half_width))
}

/// A square pyramid on a floor of 0, its sides along u and v: `1 − max(|du|, |dv|) / half_side`, not below 0.
#[must_use]
pub fn pyramid_height(u: f64, v: f64, center: [f64; 2], half_side: f64) -> f64 {
    let d = (u - center[0]).abs().max((v - center[1]).abs());
    if d < half_side { 1.0 - d / half_side } else { 0.0 }
}

/// A cone without its tip on a floor of 0: 1 within `top` of `center`, 0 beyond `bottom`, straight between.
#[must_use]
pub fn frustum_height(u: f64, v: f64, center: [f64; 2], bottom: f64, top: f64) -> f64 {
    let r = distance(u, v, center);
    if r <= top {
        1.0
    } else if r < bottom {
        (bottom - r) / (bottom - top)
    } else {
        0.0
    }
}

/// The upper half of a torus on a floor of 0: `√(1 − ((r − major)/minor)²)` where that is real. A true torus where the
/// height scale equals `minor`.
#[must_use]
pub fn torus_height(u: f64, v: f64, center: [f64; 2], major: f64, minor: f64) -> f64 {
    let t = (distance(u, v, center) - major).abs();
    if t < minor { (1.0 - (t / minor).powi(2)).sqrt() } else { 0.0 }
}

/// A floor of 0 with a spike of 1, exactly one texel wide, in the middle of every block of `every × every` texels:
/// where x and y both leave the remainder `every / 2` (rounded down). An `every` of 0 counts as 1.
///
/// The narrowest thing a map can hold: what a march with too few steps misses.
#[must_use]
pub fn spikes(width: u32, height: u32, every: u32) -> HeightMap {
    let every = every.max(1);
    let on = |k: u32| k % every == every / 2;
    HeightMap::new(Grid::from_fn(width, height, |x, y| if on(x) && on(y) { 1.0 } else { 0.0 }))
}

fn distance(u: f64, v: f64, center: [f64; 2]) -> f64 {
    (u - center[0]).hypot(v - center[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn at(map: &HeightMap, x: u32, y: u32) -> f64 {
        f64::from(*map.grid().get(x, y))
    }

    fn agrees(map: &HeightMap, f: impl Fn(f64, f64) -> f64) {
        let (w, h) = (map.grid().width(), map.grid().height());
        for y in 0..h {
            for x in 0..w {
                let expected = f((f64::from(x) + 0.5) / f64::from(w), (f64::from(y) + 0.5) / f64::from(h));
                assert!((at(map, x, y) - expected).abs() < 1e-6, "({x}, {y}): {} for {expected}", at(map, x, y));
            }
        }
    }

    #[test]
    fn maps_hold_their_closed_form_at_texel_centres_also_when_not_square() {
        agrees(&plane(5, 3, 0.25), |_, _| 0.25);
        agrees(&ramp(33, 7, [1.0, 0.0]), |u, _| u);
        agrees(&ramp(33, 7, [0.0, -2.0]), |_, v| 1.0 - v);
        agrees(&ramp(9, 9, [3.0, 1.0]), |u, v| 0.75 * u + 0.25 * v);
        agrees(&sine(40, 24, 3, 0), |u, _| 0.5 + 0.5 * (6.0 * std::f64::consts::PI * u).cos());
        agrees(&hemisphere(41, 23, [0.4, 0.6], 0.3), |u, v| {
            (1.0 - ((u - 0.4).powi(2) + (v - 0.6).powi(2)) / 0.09).max(0.0).sqrt()
        });
        agrees(&wedge(30, 4, 0.5, 0.25), |u, _| (1.0 - 4.0 * (u - 0.5).abs()).max(0.0));
    }

    #[test]
    fn solids_have_their_height_at_the_known_places() {
        let c = [0.5, 0.5];
        assert_eq!(hemisphere_height(0.5, 0.5, c, 0.2), 1.0);
        assert!((hemisphere_height(0.62, 0.5, c, 0.2) - 0.8).abs() < 1e-12);
        assert!((pyramid_height(0.55, 0.4, c, 0.2) - 0.5).abs() < 1e-12);
        assert!((frustum_height(0.5, 0.65, c, 0.2, 0.1) - 0.5).abs() < 1e-12);
        assert_eq!(frustum_height(0.55, 0.5, c, 0.2, 0.1), 1.0);
        assert!((torus_height(0.5, 0.8, c, 0.3, 0.1) - 1.0).abs() < 1e-12);
        assert!((torus_height(0.5, 0.86, c, 0.3, 0.1) - 0.8).abs() < 1e-9);
        assert_eq!(torus_height(0.5, 0.5, c, 0.3, 0.1), 0.0);
    }

    #[test]
    fn a_spike_is_exactly_one_texel() {
        let map = spikes(20, 10, 5);
        let high: Vec<(u32, u32)> =
            (0..10).flat_map(|y| (0..20).map(move |x| (x, y))).filter(|&(x, y)| at(&map, x, y) > 0.0).collect();
        let expected = [2, 7].into_iter().flat_map(|y| [2, 7, 12, 17].map(|x| (x, y))).collect::<Vec<_>>();
        assert_eq!(high, expected);
        assert!(high.iter().all(|&(x, y)| at(&map, x, y) == 1.0));
    }

    proptest! {
        #[test]
        fn no_shape_leaves_the_range_whatever_its_measures(
            (u, v) in (0.0..=1.0f64, 0.0..=1.0f64),
            center in [-1.0..2.0f64, -1.0..2.0f64],
            (a, b) in (-0.5..2.0f64, -0.5..2.0f64),
            (m, n) in (0u32..50, 0u32..50),
        ) {
            for h in [
                ramp_height(u, v, [a, b]),
                sine_height(u, v, m, n),
                hemisphere_height(u, v, center, a),
                wedge_height(u, center[0], a),
                pyramid_height(u, v, center, a),
                frustum_height(u, v, center, a, b),
                torus_height(u, v, center, a, b),
            ] {
                prop_assert!((-1e-12..=1.0 + 1e-12).contains(&h), "{h}");
            }
        }
    }

    #[test]
    fn degenerate_shapes_are_flat() {
        for map in [
            ramp(3, 3, [0.0, 0.0]),
            hemisphere(3, 3, [0.5, 0.5], 0.0),
            wedge(3, 3, 0.5, -1.0),
            spikes(3, 3, 0),
            plane(1, 1, f32::NAN),
        ] {
            let first = at(&map, 0, 0);
            assert!(map.grid().texels().iter().all(|&h| f64::from(h) == first));
        }
    }
}
