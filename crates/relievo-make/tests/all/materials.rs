//! Properties of every built-in material, and the features of each.

use rayon::ThreadPoolBuilder;
use relievo_make::shapes::hemisphere_height;
use relievo_make::{BRICK_WALL_HEIGHT_SCALE, MAX_SIZE, MakeError, TOY_BOX_HEIGHT_SCALE, height_scale, make, names};
use relievo_map::{ColorEncoding, Grid, MapSet};

fn height(maps: &MapSet) -> &Grid<f32> {
    maps.height.as_ref().unwrap().grid()
}

fn channel(maps: &MapSet, k: usize) -> Grid<f32> {
    maps.base_color.as_ref().unwrap().grid.map(|c| c[k])
}

/// The step between column `x − 1` and column `x` (wrapping), mean over the rows.
fn column_step(grid: &Grid<f32>, x: u32) -> f32 {
    let (w, h) = (grid.width(), grid.height());
    let step = |y| (grid.get((x + w - 1) % w, y) - grid.get(x % w, y)).abs();
    (0..h).map(step).sum::<f32>() / h as f32
}

/// The step across the seam relative to the mean step of the 12 columns around it: near 1 where a map tiles.
fn seam(grid: &Grid<f32>) -> f32 {
    let w = grid.width();
    let around: f32 = (1..=6).map(|k| column_step(grid, k) + column_step(grid, w - k)).sum();
    column_step(grid, 0) / (around / 12.0)
}

fn transposed(grid: &Grid<f32>) -> Grid<f32> {
    Grid::from_fn(grid.height(), grid.width(), |x, y| *grid.get(y, x))
}

fn cropped(grid: &Grid<f32>, size: u32) -> Grid<f32> {
    Grid::from_fn(size, size, |x, y| *grid.get(x, y))
}

const SEAM_LIMIT: f32 = 1.5;

#[test]
fn the_wall_tiles_in_every_map_and_both_directions() {
    let maps = make("brick-wall", 512).unwrap();
    let ao = maps.ao.as_ref().unwrap().grid();
    let roughness = maps.roughness.as_ref().unwrap().grid();
    for (name, grid) in [
        ("height", height(&maps)),
        ("red", &channel(&maps, 0)),
        ("blue", &channel(&maps, 2)),
        ("roughness", roughness),
        ("ao", ao),
    ] {
        assert!(seam(grid) < SEAM_LIMIT, "{name}, left to right: {}", seam(grid));
        let grid = transposed(grid);
        assert!(seam(&grid) < SEAM_LIMIT, "{name}, top to bottom: {}", seam(&grid));
    }
}

#[test]
fn the_seam_measure_finds_a_map_that_does_not_tile() {
    let maps = make("brick-wall", 512).unwrap();
    let crop = cropped(height(&maps), 400);
    assert!(seam(&crop) > 2.0 * SEAM_LIMIT, "{}", seam(&crop));
    assert!(seam(&transposed(&crop)) > 2.0 * SEAM_LIMIT);
}

#[test]
fn the_rim_of_the_toy_box_is_equally_high_all_round() {
    let maps = make("toy-box", 256).unwrap();
    let grid = height(&maps);
    let border: Vec<f32> =
        (0..256).flat_map(|k| [(k, 0), (k, 255), (0, k), (255, k)]).map(|(x, y)| *grid.get(x, y)).collect();
    let (low, high) = border.iter().fold((1.0f32, 0.0f32), |(l, h), &x| (l.min(x), h.max(x)));
    assert!(low > 0.9 && high - low < 0.005, "{low} to {high}");
}

#[test]
fn the_same_bytes_come_from_one_thread_and_from_many() {
    for name in names() {
        let on = |threads| {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| make(name, 200).unwrap())
        };
        assert_eq!(on(1), on(7), "{name}");
    }
}

#[test]
fn normals_are_the_slopes_of_the_heights_at_the_recommended_scale() {
    let size = 256;
    for name in names() {
        let maps = make(name, size).unwrap();
        let scale = f64::from(height_scale(name).unwrap());
        let h = |x: u32, y: u32| f64::from(*height(&maps).get(x % size, y % size));
        for y in 0..size {
            for x in 0..size {
                let du = (h(x + 1, y) - h(x + size - 1, y)) * scale * f64::from(size) / 2.0;
                let dv = (h(x, y + 1) - h(x, y + size - 1)) * scale * f64::from(size) / 2.0;
                let length = (du * du + dv * dv + 1.0).sqrt();
                // Rows run down, the normal's y runs up.
                let expected = [-du / length, dv / length, 1.0 / length];
                let n = maps.normal.as_ref().unwrap().grid().get(x, y);
                for k in 0..3 {
                    assert!((f64::from(n[k]) - expected[k]).abs() < 1e-4, "{name} ({x}, {y}): {n:?} for {expected:?}");
                }
            }
        }
    }
}

#[test]
fn the_ball_leans_up_above_and_right_on_its_right() {
    let maps = make("toy-box", 200).unwrap();
    let normal = |u: f64, v: f64| *maps.normal.as_ref().unwrap().grid().get((u * 200.0) as u32, (v * 200.0) as u32);
    assert!(normal(0.305, 0.205)[1] > 0.5);
    assert!(normal(0.305, 0.405)[1] < -0.5);
    assert!(normal(0.405, 0.305)[0] > 0.5);
    assert!(normal(0.205, 0.305)[0] < -0.5);
}

#[test]
fn the_ball_is_a_true_hemisphere_at_the_recommended_scale() {
    let maps = make("toy-box", 512).unwrap();
    let scale = f64::from(TOY_BOX_HEIGHT_SCALE);
    for k in 0..100 {
        let (angle, r) = (f64::from(k) * 2.4, 0.13 * f64::from(k) / 100.0);
        let (x, y) = (((0.305 + r * angle.cos()) * 512.0) as u32, ((0.305 + r * angle.sin()) * 512.0) as u32);
        let (u, v) = ((f64::from(x) + 0.5) / 512.0, (f64::from(y) + 0.5) / 512.0);
        let expected = 0.05 * scale + 0.145 * hemisphere_height(u, v, [0.305, 0.305], 0.145);
        let got = f64::from(*height(&maps).get(x, y)) * scale;
        assert!((got - expected).abs() < 0.003, "at ({u}, {v}): {got} for {expected}");
    }
}

#[test]
fn heights_use_their_range_without_being_cut_off() {
    for (name, low, high) in [("brick-wall", 0.25, 0.92), ("toy-box", 0.02, 0.97)] {
        let maps = make(name, 512).unwrap();
        let texels = height(&maps).texels();
        let (min, max) = texels.iter().fold((1.0f32, 0.0f32), |(l, h), &x| (l.min(x), h.max(x)));
        assert!(min < low && max > high, "{name}: {min} to {max}");
        let cut = texels.iter().filter(|&&h| h == 0.0 || h == 1.0).count();
        assert!(cut * 1000 < texels.len(), "{name}: {cut} texels at the ends");
    }
}

#[test]
fn a_map_of_half_the_size_is_the_larger_one_averaged() {
    for name in names() {
        for (small, mean_limit) in [(100, 1e-4), (512, 0.012)] {
            let large = make(name, 2 * small).unwrap();
            let small = make(name, small).unwrap();
            for (what, a, b) in [
                ("height", height(&small).clone(), height(&large).halved()),
                ("green", channel(&small, 1), channel(&large, 1).halved()),
            ] {
                let error: f32 = a.texels().iter().zip(b.texels()).map(|(a, b)| (a - b).abs()).sum();
                let mean = error / a.texels().len() as f32;
                // Colours are averaged as light here, as display values there.
                let limit = if what == "green" { mean_limit + 0.008 } else { mean_limit };
                assert!(mean < limit, "{name} {what} at {}: {mean}", a.width());
            }
        }
    }
}

#[test]
fn joints_lie_deeper_rougher_and_darker_than_the_faces_of_bricks() {
    let maps = make("brick-wall", 512).unwrap();
    let mean = |grid: &Grid<f32>, rows: std::ops::Range<u32>| {
        let count = (rows.len() * 512) as f32;
        rows.map(|y| (0..512).map(|x| grid.get(x, y)).sum::<f32>()).sum::<f32>() / count
    };
    // A joint runs along v = 0.25, the middle of a course along v = 0.3125.
    let (joint, face) = (126..130, 152..168);
    for (what, grid, sign) in [("height", height(&maps), 0.35), ("ao", maps.ao.as_ref().unwrap().grid(), 0.15)] {
        let drop = mean(grid, face.clone()) - mean(grid, joint.clone());
        assert!(drop > sign, "{what}: {drop}");
    }
    let roughness = maps.roughness.as_ref().unwrap().grid();
    assert!(mean(roughness, joint) > mean(roughness, face));
}

#[test]
fn no_two_bricks_of_the_wall_look_alike() {
    let maps = make("brick-wall", 240).unwrap();
    let grid = &maps.base_color.as_ref().unwrap().grid;
    let mut faces = Vec::new();
    for course in 0..8u32 {
        for place in 0..3u32 {
            let (x0, y0) = (place * 80 + if course % 2 == 1 { 0 } else { 40 }, course * 30 + 15);
            let mut sum = [0.0f32; 3];
            for (dx, dy) in (0..40).flat_map(|dx| (0..12).map(move |dy| (dx, dy))) {
                let c = grid.get((x0 + 220 + dx) % 240, y0 - 6 + dy);
                for k in 0..3 {
                    sum[k] += c[k] / 480.0;
                }
            }
            faces.push(sum);
        }
    }
    for (i, a) in faces.iter().enumerate() {
        for b in &faces[..i] {
            let apart: f32 = (0..3).map(|k| (a[k] - b[k]).abs()).sum();
            assert!(apart > 0.002, "{a:?} and {b:?}");
        }
    }
    let light: Vec<f32> = faces.iter().map(|c| c.iter().sum::<f32>() / 3.0).collect();
    let (low, high) = light.iter().fold((1.0f32, 0.0f32), |(l, h), &x| (l.min(x), h.max(x)));
    assert!(high - low > 0.12, "{low} to {high}");
}

#[test]
fn all_maps_but_metallic_are_there_at_any_size() {
    for name in names() {
        for size in [1, 2, 3, 7, 33, 515] {
            let maps = make(name, size).unwrap();
            let color = maps.base_color.as_ref().unwrap();
            assert_eq!(color.encoding, ColorEncoding::Srgb);
            let out = color.grid.texels().iter().flatten().find(|c| !(0.0..=1.0).contains(*c));
            assert!(out.is_none(), "{name} at {size}: {out:?}");
            assert!(color.grid.texels().iter().all(|c| c[3] == 1.0));
            assert!(maps.metallic.is_none());
            let sizes = [
                (color.grid.width(), color.grid.height()),
                (height(&maps).width(), height(&maps).height()),
                (maps.normal.as_ref().unwrap().grid().width(), maps.normal.as_ref().unwrap().grid().height()),
                (maps.roughness.as_ref().unwrap().grid().width(), maps.roughness.as_ref().unwrap().grid().height()),
                (maps.ao.as_ref().unwrap().grid().width(), maps.ao.as_ref().unwrap().grid().height()),
            ];
            assert_eq!(sizes, [(size, size); 5], "{name}");
        }
    }
}

#[test]
fn impossible_sizes_are_refused_with_the_limits() {
    for name in names() {
        for size in [0, MAX_SIZE + 1, 65536, u32::MAX] {
            assert_eq!(make(name, size), Err(MakeError::Size { size }));
        }
    }
    let message = make("toy-box", 0).unwrap_err().to_string();
    assert_eq!(message, "a generated material of 0×0 texels cannot be made: the size must be 1 to 16384");
}

#[test]
fn an_unknown_name_is_answered_with_the_nearest_and_all_names() {
    let all = names().join(", ");
    assert_eq!(
        make("brik-wal", 8).unwrap_err().to_string(),
        format!("no generated material is called \"brik-wal\" (did you mean \"brick-wall\"?). There are: {all}")
    );
    assert_eq!(
        make("zzz", 8).unwrap_err().to_string(),
        format!("no generated material is called \"zzz\". There are: {all}")
    );
    assert_eq!(height_scale("brick-wall"), Ok(BRICK_WALL_HEIGHT_SCALE));
    assert!(height_scale("Toybox").is_err());
}
