//! Heights from photographs: of our own materials, lit, so that the true heights are known.

use std::path::Path;

use rayon::ThreadPoolBuilder;
use relievo_make::edit::{Combine, blur, combine};
use relievo_make::{ColorPick, PhotoEdge, PhotoError, PhotoOptions, PhotoPreset, SideLight, from_photo, make};
use relievo_map::{
    ColorEncoding, ColorMap, Grid, Limits, MapSet, ScalarMap, White, Wrap, linear_to_srgb, read_color, read_height,
};

const SIZE: u32 = 512;

/// A material as a camera sees it: sky light kept out of the joints, a sun from the upper left, and a lamp that is brighter
/// at one side.
fn photograph(maps: &MapSet) -> ColorMap {
    let color = maps.base_color.as_ref().unwrap().to_linear();
    let (normal, ao) = (maps.normal.as_ref().unwrap().grid(), maps.ao.as_ref().unwrap().grid());
    let sun = [-0.4f32, 0.4, 0.82];
    let grid = Grid::from_fn(SIZE, SIZE, |x, y| {
        let n = normal.get(x, y);
        let sun: f32 = (0..3).map(|k| n[k] * sun[k]).sum::<f32>().max(0.0);
        let lamp = 0.6 + 0.8 * x as f32 / SIZE as f32;
        let light = lamp * (0.5 * ao.get(x, y) + 0.6 * sun);
        let [r, g, b, _] = *color.get(x, y);
        let stored = [r, g, b].map(|c| (linear_to_srgb((c * light).min(1.0)) * 255.0).round() / 255.0);
        [stored[0], stored[1], stored[2], 1.0]
    });
    ColorMap { grid, encoding: ColorEncoding::Srgb }
}

fn correlation(a: &Grid<f32>, b: &Grid<f32>) -> f64 {
    let n = a.texels().len() as f64;
    let mean = |g: &Grid<f32>| g.texels().iter().map(|&x| f64::from(x)).sum::<f64>() / n;
    let (ma, mb) = (mean(a), mean(b));
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for (a, b) in a.texels().iter().zip(b.texels()) {
        let (a, b) = (f64::from(*a) - ma, f64::from(*b) - mb);
        (ab, aa, bb) = (ab + a * b, aa + a * a, bb + b * b);
    }
    ab / (aa * bb).sqrt()
}

fn luminance(photo: &ColorMap) -> Grid<f32> {
    photo.to_linear().map(|[r, g, b, _]| 0.2126 * r + 0.7152 * g + 0.0722 * b)
}

fn made(photo: &ColorMap, options: &PhotoOptions) -> Grid<f32> {
    from_photo(photo.clone(), options).unwrap().height.into_grid()
}

/// A photograph and the true heights.
fn shot(name: &str) -> (ColorMap, Grid<f32>) {
    let maps = make(name, SIZE).unwrap();
    (photograph(&maps), maps.height.unwrap().into_grid())
}

#[test]
fn heights_are_nearer_to_the_true_ones_than_luminance_is() {
    for (name, preset, at_least) in [
        ("brick-wall", PhotoPreset::Brick, 0.6),
        ("bricks-flemish", PhotoPreset::Brick, 0.6),
        ("cobbles", PhotoPreset::Stone, 0.5),
        ("cracked-earth", PhotoPreset::Cracks, 0.6),
        ("weave", PhotoPreset::Fabric, 0.5),
    ] {
        let (photo, truth) = shot(name);
        let (plain, ours) =
            (correlation(&luminance(&photo), &truth), correlation(&made(&photo, &preset.options()), &truth));
        assert!(ours > plain && ours > at_least, "{name}: {ours:.3}, luminance {plain:.3}");
    }
}

#[test]
fn a_colour_pick_lowers_what_has_that_colour() {
    let (photo, truth) = shot("bricks-stack");
    let mut options = PhotoOptions { saturation: [0.0; 7], ..PhotoPreset::Brick.options() };
    let before = correlation(&made(&photo, &options), &truth);
    // The mortar, as it is on the photograph.
    let color = [0.6, 0.56, 0.5];
    options.picks = vec![ColorPick { color, offset: -0.8, tolerance: 14.0 }];
    let after = correlation(&made(&photo, &options), &truth);
    assert!(after > before + 0.2 && after > 0.5, "{before:.3} to {after:.3}");
}

#[test]
fn a_light_from_one_side_tells_slopes() {
    // A plain grey bump under a light from the right.
    let bump = |x: u32, y: u32| {
        let (u, v) = ((x as f32 - 256.0) / 100.0, (y as f32 - 256.0) / 100.0);
        (-(u * u + v * v)).exp()
    };
    let truth = Grid::from_fn(SIZE, SIZE, bump);
    let slope = |x: u32, y: u32| bump((x + 1).min(511), y) - bump(x.saturating_sub(1), y);
    let photo = ColorMap {
        grid: Grid::from_fn(SIZE, SIZE, |x, y| {
            let c = 0.4 - 6.0 * slope(x, y);
            [c, c, c, 1.0]
        }),
        encoding: ColorEncoding::Linear,
    };
    let mut options = PhotoOptions { light: [0.0; 7], flatten: 0.0, ..PhotoPreset::Stone.options() };
    options.side_light = Some(SideLight { angle: 0.0, weight: 1.0 });
    let right = correlation(&made(&photo, &options), &truth);
    options.side_light = Some(SideLight { angle: 180.0, weight: 1.0 });
    let left = correlation(&made(&photo, &options), &truth);
    assert!(right > 0.75 && left < -0.5, "{right:.3} {left:.3}");
}

#[test]
fn uneven_light_is_taken_out() {
    let (photo, _) = shot("cobbles");
    let heights = made(&photo, &PhotoPreset::Stone.options());
    let half = |from: u32| {
        (0..SIZE).flat_map(|y| (from..from + 256).map(move |x| (x, y))).map(|(x, y)| heights.get(x, y)).sum::<f32>()
            / 131_072.0
    };
    let dark = luminance(&photo);
    let light = |from: u32| {
        (0..SIZE).flat_map(|y| (from..from + 256).map(move |x| (x, y))).map(|(x, y)| dark.get(x, y)).sum::<f32>()
            / 131_072.0
    };
    assert!(light(256) / light(0) > 1.2 && (half(256) - half(0)).abs() < 0.05);
}

#[test]
fn made_to_tile_the_seam_is_like_the_inside() {
    let (photo, _) = shot("cobbles");
    // A crop does not tile.
    let crop = ColorMap { grid: Grid::from_fn(390, 350, |x, y| *photo.grid.get(x + 30, y + 50)), ..photo };
    let steps = |grid: &Grid<f32>| -> Vec<f32> {
        let w = grid.width();
        (0..w)
            .map(|x| (0..350).map(|y| (grid.get(x, y) - grid.get((x + 1) % w, y)).abs()).sum::<f32>() / 350.0)
            .collect()
    };
    let ratio = |edge| {
        let options = PhotoOptions { edge, ..PhotoPreset::Stone.options() };
        let steps = steps(&made(&crop, &options));
        steps[389] / (steps[..389].iter().sum::<f32>() / 389.0)
    };
    let (open, tiled) = (ratio(PhotoEdge::Open), ratio(PhotoEdge::MakeTile));
    assert!(open > 3.0 && tiled < 1.7, "{open} {tiled}");
}

#[test]
fn masks_leave_the_rest_plain_and_must_fit() {
    let (photo, _) = shot("cobbles");
    let mask = |w, h, f: fn(u32) -> f32| Some(ScalarMap::new(Grid::from_fn(w, h, |x, _| f(x))));
    let options = |mask| PhotoOptions { mask, ..PhotoPreset::Stone.options() };
    let heights = made(&photo, &options(mask(SIZE, SIZE, |x| if x < 256 { 1.0 } else { 0.0 })));
    let plain = *heights.get(300, 10);
    assert!((256..SIZE).all(|x| *heights.get(x, 77) == plain) && (0..256).any(|x| *heights.get(x, 77) != plain));
    assert_eq!(
        from_photo(photo.clone(), &options(mask(9, 9, |_| 1.0))),
        Err(PhotoError::MaskSize { mask: [9, 9], photo: [SIZE, SIZE] })
    );
    assert_eq!(from_photo(photo.clone(), &options(mask(SIZE, SIZE, |_| 0.0))), Err(PhotoError::EmptyMask));
}

#[test]
fn pictures_without_hints_give_flat_maps_and_odd_sizes_work() {
    for (_, preset) in PhotoPreset::ALL {
        for (w, h) in [(1, 1), (2, 7), (33, 5)] {
            for edge in [PhotoEdge::Open, PhotoEdge::Tiles, PhotoEdge::MakeTile] {
                let photo = ColorMap { grid: Grid::filled(w, h, [0.3, 0.2, 0.1, 1.0]), encoding: ColorEncoding::Srgb };
                let options = PhotoOptions { edge, ..preset.options() };
                let maps = from_photo(photo, &options).unwrap().into_maps(&options);
                let heights = maps.height.unwrap().into_grid();
                assert!(heights.texels().iter().all(|h| (h - heights.texels()[0]).abs() < 1e-3), "{w}×{h} {edge:?}");
                assert!(maps.roughness.is_some() && maps.ao.is_some() && maps.normal.is_some());
            }
        }
    }
}

#[test]
fn threads_do_not_change_a_bit() {
    let (photo, _) = shot("brick-wall");
    let mut options = PhotoPreset::Brick.options();
    options.side_light = Some(SideLight { angle: 30.0, weight: 0.5 });
    let on = |threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| from_photo(photo.clone(), &options).unwrap().into_maps(&options))
    };
    assert_eq!(on(1), on(5));
}

/// A picture with alpha, none where the first column of squares is.
fn with_hole(photo: &ColorMap, color: [f32; 3]) -> ColorMap {
    let mut photo = photo.clone();
    for (k, texel) in photo.grid.texels_mut().iter_mut().enumerate() {
        if k % SIZE as usize <= 127 {
            *texel = [color[0], color[1], color[2], 0.0];
        }
    }
    photo
}

#[test]
fn what_is_transparent_is_plain_whatever_its_colour() {
    let (photo, _) = shot("cobbles");
    let options = PhotoPreset::Stone.options();
    let [black, white] = [[0.0; 3], [1.0; 3]].map(|color| made(&with_hole(&photo, color), &options));
    assert_eq!(black, white);
    assert!((0..SIZE).all(|y| *black.get(40, y) == *black.get(0, 0)) && black.get(300, 9) != black.get(0, 0));
    let nothing = ColorMap { grid: photo.grid.map(|_| [0.3, 0.1, 0.2, 0.0]), ..photo };
    assert!(made(&nothing, &options).texels().windows(2).all(|pair| pair[0] == pair[1]));
}

/// The photograph with `factor` times the light, as 8-bit sRGB.
fn exposed(photo: &ColorMap, factor: f32) -> ColorMap {
    let stored = |c: f32| (linear_to_srgb((c * factor).min(1.0)) * 255.0).round() / 255.0;
    let grid = photo.to_linear().map(|&[r, g, b, a]| [stored(r), stored(g), stored(b), a]);
    ColorMap { grid, encoding: ColorEncoding::Srgb }
}

#[test]
fn dark_and_bright_exposures_tell_nearly_the_same() {
    for (name, preset, at_least) in [("cobbles", PhotoPreset::Stone, 0.45), ("brick-wall", PhotoPreset::Brick, 0.5)] {
        let (photo, truth) = shot(name);
        for factor in [0.05, 2.5] {
            let got = correlation(&made(&exposed(&photo, factor), &preset.options()), &truth);
            assert!(got > at_least, "{name} with {factor} of the light: {got:.3}");
        }
    }
}

#[test]
fn a_grey_photograph_tells_by_its_light_what_colours_would_have_told() {
    let (photo, truth) = shot("cobbles");
    // Two of the three channels differ a little, as those of a camera do.
    let grey = photo.grid.map(|&[r, g, b, a]| {
        let y = 0.3 * r + 0.6 * g + 0.1 * b;
        [y, y * 0.995, y, a]
    });
    let grey = ColorMap { grid: grey, ..photo };
    let got = correlation(&made(&grey, &PhotoPreset::Brick.options()), &truth);
    assert!(got > 0.45, "{got:.3}");
}

#[test]
fn pixels_that_are_no_numbers_count_as_black() {
    let (mut photo, _) = shot("cobbles");
    for (k, odd) in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e38].into_iter().enumerate() {
        photo.grid.texels_mut()[1000 * k] = [odd, 0.2, odd, odd];
    }
    for encoding in [ColorEncoding::Srgb, ColorEncoding::Linear] {
        let photo = ColorMap { grid: photo.grid.clone(), encoding };
        let options =
            PhotoOptions { side_light: Some(SideLight { angle: 9.0, weight: 1.0 }), ..PhotoPreset::Brick.options() };
        let maps = from_photo(photo, &options).unwrap().into_maps(&options);
        assert!(maps.normal.unwrap().grid().texels().iter().flatten().all(|c| c.is_finite()));
        let heights = maps.height.unwrap().into_grid();
        assert!(heights.texels().iter().any(|&h| h > 0.9) && heights.texels().iter().any(|&h| h < 0.1));
    }
}

/// Seven bands of the luminance and what is left, each with the same energy, all with the same sign: what one does who
/// knows neither flattening nor signs.
fn plain_mix(photo: &ColorMap, wrap: Wrap) -> Grid<f32> {
    let scaled = |band: &Grid<f32>| {
        let n = band.texels().len() as f32;
        let mean = band.texels().iter().sum::<f32>() / n;
        let energy = band.texels().iter().map(|v| (v - mean).powi(2)).sum::<f32>() / n;
        band.map(|v| (v - mean) / energy.sqrt().max(1e-6))
    };
    let mut finer = luminance(photo);
    let mut sum = finer.map(|_| 0.0);
    for k in 0..7 {
        let sigma = |k: i32| f32::powi(2.0, k) * finer.width() as f32 / 1024.0;
        let step = if k == 0 { sigma(0) } else { (sigma(k).powi(2) - sigma(k - 1).powi(2)).sqrt() };
        let coarser = blur(&finer, step, wrap);
        let band = combine(&finer, &coarser, Combine::Add(-1.0)).unwrap();
        sum = combine(&sum, &scaled(&band), Combine::Add(1.0)).unwrap();
        finer = coarser;
    }
    combine(&sum, &scaled(&finer), Combine::Add(1.0)).unwrap()
}

/// Prints the table in docs/from-photo.md: `cargo test -p relievo-make --test all photos::real -- --nocapture`.
#[test]
fn real_photographs_correlate_with_their_heights_better_than_luminance_and_a_plain_mix() {
    let textures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/textures");
    if !textures.is_dir() {
        eprintln!("skipped: there is no {}", textures.display());
        return;
    }
    for (name, preset, at_least) in
        [("bricks102/Bricks102", PhotoPreset::Brick, 0.5), ("ground054/Ground054", PhotoPreset::Stone, 0.4)]
    {
        let file = |map: &str| textures.join(format!("{name}_1K-JPG_{map}.jpg"));
        let photo = read_color(&file("Color"), &Limits::default()).unwrap().map;
        let truth = read_height(&file("Displacement"), White::High, &Limits::default()).unwrap().map.into_grid();
        let options = PhotoOptions { edge: PhotoEdge::Tiles, ..preset.options() };
        let [light, mix, ours] = [luminance(&photo), plain_mix(&photo, Wrap::Repeat), made(&photo, &options)]
            .map(|heights| correlation(&heights, &truth));
        eprintln!("{name}: luminance {light:.3}, plain mix {mix:.3}, from-photo {ours:.3}");
        assert!(ours > light + 0.05 && ours > mix + 0.05 && ours > at_least, "{name}: {ours:.3}, {light:.3}, {mix:.3}");
    }
}
