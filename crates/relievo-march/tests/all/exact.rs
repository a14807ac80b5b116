//! The exact march against closed forms, and against a brute-force search that shares no code with it.

use relievo_map::{Grid, HeightMap, Wrap};
use relievo_march::{
    Bounds, Cones, HeightField, MarchOptions, OracleRay, Ray, Record, ReliefMap, Shadow, Technique, TexelRect,
    WithoutPyramid, march, oracle, shadow, shadow_up_to,
};
use relievo_testkit::{Random, WRAPS};

fn sampled(size: [u32; 2], height: impl Fn(f64, f64) -> f64) -> ReliefMap {
    let at = |i: u32, n: u32| (f64::from(i) + 0.5) / f64::from(n);
    ReliefMap::new(&HeightMap::new(Grid::from_fn(size[0], size[1], |x, y| {
        height(at(x, size[0]), at(y, size[1])) as f32
    })))
}

fn exact() -> MarchOptions {
    MarchOptions { technique: Technique::Exact, ..MarchOptions::default() }
}

/// Rays from many sides under many angles, entering inside [low, high]².
fn rays(low: f32, high: f32) -> impl Iterator<Item = Ray> {
    (0..4000u32).map(move |i| {
        let fraction = |k: f64| (0.5 + f64::from(i) * k).fract() as f32;
        let uv = [0.7548776662, 0.5698402910].map(|k| low + (high - low) * fraction(k));
        let angle = fraction(0.819_172_5) * std::f32::consts::TAU;
        let tilt = fraction(0.671_043_6) * 80f32.to_radians();
        let view = [tilt.sin() * angle.cos(), tilt.sin() * angle.sin(), tilt.cos()];
        Ray::from_view(uv, view, [0.05, -0.05])
    })
}

#[test]
fn planes_and_ramps_are_met_where_algebra_says() {
    // h = c + a·u + b·v is exactly bilinear: 1 − t = c + a·(u + du·t) + b·(v + dv·t).
    for [a, b, c] in [[0.0, 0.0, 0.3], [0.5, 0.0, 0.2], [0.0, -0.4, 0.7], [0.3, 0.25, 0.1]] {
        let heights = sampled([200, 120], |u, v| c + a * u + b * v);
        let field = heights.field(0.0, Wrap::Clamp);
        let mut met = 0;
        for ray in rays(0.2, 0.8) {
            let [u, v] = ray.uv.map(f64::from);
            let [du, dv] = ray.slope().map(f64::from);
            let t = (1.0 - c - a * u - b * v) / (1.0 + a * du + b * dv);
            let expected = [u + du * t, v + dv * t];
            if !expected.iter().all(|x| (0.01..0.99).contains(x)) {
                continue; // The ramp ends at the border.
            }
            met += 1;
            let record = march(&field, &ray, &exact());
            assert!(record.hit);
            let truth = oracle(&field, &OracleRay::from(&ray), None).unwrap();
            for k in 0..2 {
                assert!((f64::from(record.uv[k]) - expected[k]).abs() < 1e-5, "{ray:?}: {record:?} for {expected:?}");
                assert!((truth.uv[k] - expected[k]).abs() < 1e-6, "{ray:?}: {truth:?} for {expected:?}");
            }
            assert!((f64::from(record.depth) - t).abs() < 1e-5);
        }
        assert!(met > 2000, "only {met} rays met the ramp inside");
    }
}

#[test]
fn a_hemisphere_is_met_where_the_sphere_is() {
    // Radius 0.4 of a repeat, as deep as it is wide: height = √(r² − ρ²)/r.
    const RADIUS: f64 = 0.4;
    let heights = sampled([2048, 2048], |u, v| {
        let rho2 = (u - 0.5).powi(2) + (v - 0.5).powi(2);
        ((RADIUS * RADIUS - rho2).max(0.0)).sqrt() / RADIUS
    });
    let field = heights.field(0.0, Wrap::Repeat);
    let mut met = 0;
    for ray in rays(0.35, 0.65) {
        // In units of a repeat, z up: origin on the lid, the relief RADIUS deep.
        let scale = RADIUS as f32 / 0.05;
        let ray = Ray { uv_delta: ray.uv_delta.map(|s| s * scale), ..ray };
        let [u, v] = ray.uv.map(|x| f64::from(x) - 0.5);
        let [du, dv] = ray.slope().map(f64::from);
        // |(u + du·t, v + dv·t, RADIUS·(1 − t))|² = RADIUS²
        let (a, b, c) = (du * du + dv * dv + RADIUS * RADIUS, 2.0 * (u * du + v * dv - RADIUS * RADIUS), u * u + v * v);
        let discriminant = b * b - 4.0 * a * c;
        if discriminant < 0.0 {
            continue;
        }
        let t = (-b - discriminant.sqrt()) / (2.0 * a);
        let rho = (u + du * t).hypot(v + dv * t);
        if !(0.0..0.9).contains(&t) || rho > 0.9 * RADIUS {
            continue; // Near the rim the slope is infinite, and no bilinear surface follows it.
        }
        met += 1;
        let truth = oracle(&field, &OracleRay::from(&ray), None).unwrap();
        let record = march(&field, &ray, &exact());
        assert!((truth.depth - t).abs() < 1e-5, "{ray:?}: {truth:?} for {t}");
        assert!((f64::from(record.depth) - t).abs() < 1e-5, "{ray:?}: {record:?} for {t}");
    }
    assert!(met > 1000, "only {met} rays met the sphere");
}

#[test]
fn a_one_texel_spike_is_never_missed() {
    // Seen flat from the side, a spike one texel wide: layered marches step over it.
    let heights =
        sampled([256, 256], |u, v| if (u * 256.0) as u32 == 128 && (v * 256.0) as u32 == 128 { 1.0 } else { 0.0 });
    let field = heights.field(0.0, Wrap::Repeat);
    let centre = 128.5 / 256.0;
    let mut layered_misses = 0;
    for i in 0..360 {
        let angle = (i as f32).to_radians();
        let tilt = 85f32.to_radians();
        let view = [tilt.sin() * angle.cos(), tilt.sin() * angle.sin(), tilt.cos()];
        let mut ray = Ray::from_view([0.0, 0.0], view, [0.05, -0.05]);
        // Aimed at the spike's axis, at every height that is well inside it.
        let slope = ray.slope();
        let aim = 0.3 + 0.4 * i as f32 / 360.0;
        ray.uv = [centre - slope[0] * aim, centre - slope[1] * aim];
        let record = march(&field, &ray, &exact());
        assert!(record.hit && (record.depth - aim).abs() < 0.1, "{i}°: {record:?}");
        let pom = march(&field, &ray, &MarchOptions { technique: Technique::Occlusion, ..MarchOptions::default() });
        layered_misses += u32::from((pom.depth - aim).abs() >= 0.1);
    }
    assert!(layered_misses > 100, "the spike should be hard to hit, but layers missed it only {layered_misses} times");
}

#[test]
fn nothing_is_hit_before_the_first_hit_and_something_at_it() {
    // Brute force on bumpy ground: sample the clearance densely along the ray; no shared code but the filter.
    let heights =
        sampled([61, 47], |u, v| 0.5 + 0.2 * (u * 25.0).sin() * (v * 31.0).cos() + 0.25 * (u * 90.0 + v * 40.0).sin());
    for wrap in WRAPS {
        let field = heights.field(0.0, wrap);
        for ray in rays(-1.5, 2.5).take(1500) {
            let record = march(&field, &ray, &exact());
            assert!(record.hit);
            let clearance = |t: f32| (1.0 - t) - field.sample(ray.at(t));
            assert!(clearance(record.depth).abs() < 2e-4, "{ray:?}: {} at the hit", clearance(record.depth));
            for k in 0..500 {
                let t = record.depth * k as f32 / 500.0;
                assert!(clearance(t) > -2e-4, "{ray:?}: surface at {t}, hit said {record:?}");
            }
        }
    }
}

#[test]
fn single_and_double_precision_agree() {
    let heights = sampled([256, 256], |u, v| 0.5 + 0.25 * (u * 40.0).sin() + 0.25 * (v * 55.0).cos());
    let field = heights.field(0.0, Wrap::Repeat);
    let (mut worst, mut grazing) = (0.0f64, 0);
    for ray in rays(0.0, 1.0) {
        let record = march(&field, &ray, &exact());
        let truth = oracle(&field, &OracleRay::from(&ray), None).unwrap();
        let error = (0..2).map(|k| (f64::from(record.uv[k]) - truth.uv[k]).abs() * 256.0).fold(0.0, f64::max);
        // Rays that graze a crest may take it or pass it: those are no matter of precision alone.
        if error < 1.0 {
            worst = worst.max(error);
        } else {
            grazing += 1;
        }
    }
    assert!(grazing <= 4, "{grazing} of 4000 rays took another crest");
    assert!(worst < 0.02, "off by {worst} texels");
}

#[test]
fn a_surface_that_ends_is_missed_beyond_its_end() {
    let heights = sampled([8, 8], |_, _| 0.2);
    let field = heights.field(0.0, Wrap::Repeat);
    let options = MarchOptions { bounds: Some(Bounds { min: [0.0; 2], max: [1.0; 2] }), ..exact() };
    let towards_right = Ray { uv: [0.9, 0.5], uv_delta: [0.5, 0.0], cos: 1.0 };
    assert!(!march(&field, &towards_right, &options).hit);
    assert!(oracle(&field, &OracleRay::from(&towards_right), options.bounds).is_none());
    assert!(march(&field, &towards_right, &exact()).hit);
    for technique in Technique::ALL.into_iter().filter(|t| !matches!(t, Technique::None | Technique::Normal)) {
        let record = march(&field, &towards_right, &MarchOptions { technique, ..options });
        let offset = if technique == Technique::UnityOffset { 0.5 * 0.3 / 1.42 } else { 0.4 };
        assert_eq!(record.hit, 0.9 + offset <= 1.0, "{technique:?}: {record:?}");
    }
}

#[test]
fn the_midlevel_lies_on_the_polygon() {
    // A plane at the midlevel is the polygon itself: no technique may move it.
    let heights = sampled([16, 16], |_, _| 0.5);
    let field = heights.field(0.0, Wrap::Repeat);
    for ray in rays(0.0, 1.0).take(200) {
        for technique in Technique::ALL {
            let options = MarchOptions {
                technique,
                midlevel: 0.5,
                min_layers: 512.0,
                max_layers: 1024.0,
                refine_steps: 20,
                ..MarchOptions::default()
            };
            let record = march(&field, &ray, &options);
            // Layered searches add up hundreds of steps in f32.
            let layer = if technique == Technique::Steep { 1.0 / 512.0 } else { 1e-4 };
            let slope = ray.slope();
            for k in 0..2 {
                let off = (record.uv[k] - ray.uv[k]).abs();
                assert!(off <= layer * slope[k].abs() + 5e-5, "{technique:?}: {off} off");
            }
        }
    }
}

#[test]
fn exact_shadows_fall_where_geometry_throws_them() {
    // A wall from u = 0.5 on, one full depth (0.1 of a repeat) high; light under 45° from the right: the shadow on the
    // floor reaches from the wall 0.1 to the left.
    let heights = sampled([1024, 4], |u, _| if u > 0.5 { 1.0 } else { 0.0 });
    let field = heights.field(0.0, Wrap::Clamp);
    let factor = |u: f32| {
        let side = std::f32::consts::FRAC_1_SQRT_2;
        let light = Ray::from_view([u, 0.5], [side, 0.0, side], [0.1, -0.1]);
        shadow(&field, Shadow::Exact, &light, 1.0, &exact()).factor
    };
    assert_eq!((factor(0.45), factor(0.402)), (0.0, 0.0));
    assert_eq!((factor(0.397), factor(0.1)), (1.0, 1.0));
    // On top of the wall nothing is in the way, nor on a flat floor lit at a grazing angle.
    let light = Ray::from_view([0.7, 0.5], [0.999, 0.0, 0.045], [0.1, -0.1]);
    assert_eq!(shadow(&field, Shadow::Exact, &light, 0.0, &exact()).factor, 1.0);
    let behind = Ray::from_view([0.7, 0.5], [0.999, 0.0, -0.045], [0.1, -0.1]);
    assert_eq!(shadow(&field, Shadow::Exact, &behind, 0.0, &exact()).factor, 0.0);
    assert_eq!(shadow(&field, Shadow::Hard, &behind, 0.0, &exact()).factor, 1.0);
}

#[test]
fn a_risen_relief_with_a_border_is_entered_beside_it() {
    // Half high, but for a higher strip at the right border that, tiling, would stand left of the left one.
    let heights = sampled([64, 64], |u, _| if u > 0.9 { 0.7 } else { 0.5 });
    let field = heights.field(0.0, Wrap::Repeat);
    let bounds = Some(Bounds { min: [0.0; 2], max: [1.0; 2] });
    let ray = |u: f32| Ray { uv: [u, 0.5], uv_delta: [0.4, 0.0], cos: 1.0 };
    for technique in [Technique::Exact, Technique::Relief, Technique::Occlusion, Technique::Contact, Technique::Steep] {
        let options = MarchOptions {
            technique,
            midlevel: 0.0,
            bounds,
            max_layers: 64.0,
            min_layers: 64.0,
            ..MarchOptions::default()
        };
        // From −0.15 on the lid, through where the strip would be, to 0.05 half way down.
        let record = march(&field, &ray(0.25), &options);
        assert!(record.hit && (record.uv[0] - 0.05).abs() < 0.01, "{technique:?}: {record:?}");
        assert!((record.depth - 0.5).abs() < 0.02, "{technique:?}: {record:?}");
    }
    // It comes in below the surface: that is seen from behind.
    let options = MarchOptions { midlevel: 0.0, bounds, ..exact() };
    assert!(!march(&field, &ray(0.15), &options).hit);
    let lid = options.on_lid(&ray(0.15));
    assert_eq!(oracle(&field, &OracleRay::from(&lid), bounds), None);
    // And one that runs beside it meets nothing.
    let beside = Ray { uv: [0.5, -0.1], uv_delta: [0.2, 0.0], cos: 1.0 };
    assert!(!march(&field, &beside, &options).hit);
}

#[test]
fn shadows_of_all_kinds_end_at_a_lamp_below_the_lid() {
    // The same wall: the ray from u = 0.42 enters it at depth 0.2.
    let heights = sampled([1024, 4], |u, _| if u > 0.5 { 1.0 } else { 0.0 });
    let field = heights.field(0.0, Wrap::Clamp);
    let side = std::f32::consts::FRAC_1_SQRT_2;
    let light = Ray::from_view([0.42, 0.5], [side, 0.0, side], [0.1, -0.1]);
    for kind in [Shadow::Hard, Shadow::Soft, Shadow::Exact] {
        let factor = |light_depth: f32| {
            shadow_up_to(&field, kind, &light, 1.0, (1.0 - light_depth) / light.cos, &exact()).factor
        };
        assert_eq!((factor(0.25), factor(0.9)), (1.0, 1.0), "{kind:?}: before the wall");
        let whole = shadow(&field, kind, &light, 1.0, &exact()).factor;
        assert!(whole < 1.0 && factor(0.0) == whole && factor(-3.0) == whole, "{kind:?}: beyond it");
        assert!(factor(f32::NAN).is_finite());
    }
    assert_eq!(shadow_up_to(&field, Shadow::Exact, &light, 1.0, 0.85 / side, &exact()).factor, 0.0);
    // Lamps as low as the point, and lower: before the wall, and behind it.
    for cos in [0.0, -0.1] {
        let level = Ray { uv: [0.42, 0.5], uv_delta: [-0.1, 0.0], cos };
        for kind in [Shadow::Hard, Shadow::Soft, Shadow::Exact] {
            let factor = |reach| shadow_up_to(&field, kind, &level, 0.5, reach, &exact()).factor;
            assert!(factor(0.7) == 1.0 && factor(1.5) < 1.0, "{kind:?} {cos}");
        }
    }
}

#[test]
fn the_terraces_of_an_8_bit_slope_throw_no_shadows() {
    // A slope of 26.6° at this depth, lit from its upper side at a flat 30°: every terrace of an 8-bit map is an obstacle
    // that the slope itself is not.
    let slope = |u: f64| 0.1 + 0.8 * u;
    let lit = |heights: &ReliefMap| {
        let field = heights.field(0.0, Wrap::Clamp);
        let light = [30f32.to_radians().cos(), 0.0, 30f32.to_radians().sin()];
        let factor = |i: u32| {
            let u = 0.1 + 0.8 * i as f32 / 999.0;
            let ray = Ray::from_view([u, 0.5], light, [0.625, -0.625]);
            shadow(&field, Shadow::Exact, &ray, 1.0 - field.sample([u, 0.5]), &exact()).factor
        };
        (0..1000).map(factor).sum::<f32>() / 1000.0
    };
    assert_eq!(lit(&sampled([2048, 4], |u, _| slope(u))), 1.0);
    assert_eq!(lit(&sampled([2048, 4], |u, _| (slope(u) * 255.0).round() / 255.0)), 1.0);
    // What is steeper than the light still throws its shadow.
    let wall = sampled([2048, 4], |u, _| if u > 0.95 { 1.0 } else { 0.2 });
    assert!(lit(&wall) < 0.2);
}

#[test]
fn a_ray_over_more_cells_than_may_be_crossed_is_no_hole() {
    // A spike far apart from the next, seen so flat that the walk is cut off: the picture has a surface there all the same.
    let heights = sampled([64, 4096], |_, v| if v < 1.0 / 4096.0 { 1.0 } else { 0.0 });
    let field = heights.field(0.0, Wrap::Clamp);
    let ray = Ray { uv: [0.5, 0.1], uv_delta: [0.0, 0.05], cos: 1e-6 };
    let record = march(&WithoutPyramid(field), &ray, &exact());
    assert!(record.hit && record.iterations == relievo_march::MAX_CELLS, "{record:?}");
    let truth = oracle(&field, &OracleRay::from(&ray), None).unwrap();
    assert!(truth.depth > f64::from(record.depth), "the oracle goes farther: {truth:?}");
    // Through the pyramid it gets to its end: the endless border is a single cell.
    let record = march(&field, &ray, &exact());
    assert!(record.hit && record.iterations < 100 && record.depth > 0.999, "{record:?}");
    // A ray past the spikes of a tiling map is cut off through the pyramid too, and later by far.
    let spikes = sampled([64, 64], |u, v| if u < 1.0 / 64.0 && v < 1.0 / 64.0 { 1.0 } else { 0.0 });
    let ray = Ray { uv: [0.5, 0.1], uv_delta: [0.0, 0.05], cos: 1e-7 };
    let record = march(&spikes.field(0.0, Wrap::Repeat), &ray, &exact());
    assert!(record.hit && record.iterations == relievo_march::MAX_CELLS && record.depth < 1.0, "{record:?}");
}

#[test]
fn no_technique_shows_a_risen_relief_from_behind_at_its_border() {
    // Half of the relief stands above the polygon; rays that come in beside it below its surface see nothing, whatever
    // the phase of their layers.
    let heights = sampled([64, 64], |_, _| 0.9);
    let field = heights.field(0.0, Wrap::Repeat);
    for i in 0..500 {
        let ray = Ray { uv: [0.001 + 0.03 * i as f32 / 500.0, 0.5], uv_delta: [0.1, 0.0], cos: 0.5 };
        // At u = 0 the ray is this deep; the surface is 0.1 deep.
        let depth_at_border = 0.6 - ray.uv[0] / 0.2;
        if (depth_at_border - 0.1).abs() < 1e-3 {
            continue;
        }
        for technique in
            [Technique::Steep, Technique::Relief, Technique::Occlusion, Technique::Contact, Technique::Exact]
        {
            let bounds = Some(Bounds { min: [0.0; 2], max: [1.0; 2] });
            let options = MarchOptions { technique, midlevel: 0.4, bounds, ..MarchOptions::default() };
            assert_eq!(march(&field, &ray, &options).hit, depth_at_border < 0.1, "{technique:?} at {depth_at_border}");
        }
    }
}

#[test]
fn a_nearest_map_is_columns_with_flat_tops() {
    // Against the same map enlarged 256 times without smoothing.
    const SCALE: u32 = 256;
    let small = Grid::from_fn(7, 5, |x, y| ((x * 5 + y * 3) % 8) as f32 / 7.0);
    let large = Grid::from_fn(7 * SCALE, 5 * SCALE, |x, y| *small.get(x / SCALE, y / SCALE));
    let columns = ReliefMap::nearest(&HeightMap::new(small.clone()));
    let enlarged = ReliefMap::new(&HeightMap::new(large));
    let smooth = ReliefMap::new(&HeightMap::new(small));
    let mut random = Random(77);
    let options = MarchOptions { technique: Technique::Exact, ..MarchOptions::default() };
    for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
        let (mut off, mut control, rays) = (0, 0, 20_000);
        for _ in 0..rays {
            let (cos, angle) = (0.1 + 0.9 * random.unit(), random.signed(std::f32::consts::PI));
            let side = (1.0 - cos * cos).sqrt() * 0.3;
            let uv = [random.signed(1.6), random.signed(1.6)];
            let ray = Ray { uv, uv_delta: [angle.cos() * side, angle.sin() * side], cos };
            let hit = |heights: &ReliefMap| march(&heights.field(0.0, wrap), &ray, &options);
            let [truth, nearest, linear] = [&enlarged, &columns, &smooth].map(hit);
            let apart =
                |record: &Record| ((record.uv[0] - truth.uv[0]) * 7.0).hypot((record.uv[1] - truth.uv[1]) * 5.0);
            // Walls of the enlarged map lean a little: near the corners of columns rays see it.
            off += u32::from(apart(&nearest) > 0.1);
            control += u32::from(apart(&linear) > 0.1);
        }
        assert!(off * 200 <= rays && control * 4 > rays, "{wrap:?}: {off}, smooth {control}, of {rays}");
    }
}

#[test]
fn a_nearest_map_has_no_pyramid_and_no_cones_also_when_it_changes() {
    let mut map = Grid::from_fn(9, 6, |x, y| ((x * 5 + y * 3) % 8) as f32 / 7.0);
    let mut heights = ReliefMap::nearest(&HeightMap::new(map.clone())).with_cones(Cones::Relaxed);
    map.texels_mut()[13] = 0.95;
    heights.update(&HeightMap::new(map.clone()), TexelRect { min: [4, 1], size: [1, 1] });
    let field = heights.field(0.0, Wrap::Repeat);
    assert!(heights.is_sampled_nearest() && heights.pyramids().is_empty() && field.pyramid().is_none());
    assert!(heights.cones(Cones::Relaxed).is_none() && field.cones(Cones::Relaxed).is_none());
    assert_eq!(field.corners(4, 1), [0.95; 4]);
    let ray = Ray { uv: [0.1, 0.2], uv_delta: [0.3, 0.1], cos: 0.5 };
    let options = |technique| MarchOptions { technique, ..MarchOptions::default() };
    let [exact, cone] = [Technique::Exact, Technique::Cone].map(|technique| march(&field, &ray, &options(technique)));
    assert!(exact.hit && exact.uv == cone.uv && exact.depth == cone.depth);
}
