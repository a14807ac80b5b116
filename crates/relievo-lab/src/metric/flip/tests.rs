use super::*;

/// Two pictures by formula, and what NVIDIA's package (flip-evaluator 1.7 from PyPI, LDR) finds between them: the mean of
/// its error map, and that map at the first, the middle and the last pixel.
struct Known {
    name: &'static str,
    size: (u32, u32),
    pixels_per_degree: f32,
    reference: fn(u32, u32) -> [u32; 3],
    test: fn(u32, u32) -> [u32; 3],
    mean: f64,
    pixels: [f32; 3],
}

const FAR: f32 = DEFAULT_PIXELS_PER_DEGREE;

#[rustfmt::skip]
const KNOWN: [Known; 11] = [
    Known { name: "two noises", size: (64, 48), pixels_per_degree: FAR, reference: |x, y| noise(x, y, 1), test: |x, y| noise(x, y, 2), mean: 0.300716, pixels: [0.27576, 0.26591, 0.25384] },
    Known { name: "faint change", size: (64, 48), pixels_per_degree: FAR, reference: |x, y| noise(x, y, 1), test: |x, y| noise(x, y, 1).map(|v| v + (x + y) % 4), mean: 0.043713, pixels: [0.03753, 0.04286, 0.05841] },
    Known { name: "banded ramp", size: (64, 48), pixels_per_degree: FAR, reference: ramp, test: |x, y| ramp(x, y).map(|v| v / 32 * 32), mean: 0.292691, pixels: [0.37877, 0.30140, 0.39805] },
    Known { name: "shifted tiles", size: (70, 50), pixels_per_degree: FAR, reference: |x, y| tiles(x, y, 0), test: |x, y| tiles(x, y, 1), mean: 0.229274, pixels: [0.02396, 0.00000, 0.05752] },
    Known { name: "shifted tiles, near", size: (70, 50), pixels_per_degree: 25.0, reference: |x, y| tiles(x, y, 0), test: |x, y| tiles(x, y, 1), mean: 0.292104, pixels: [0.00000, 0.00001, 0.00000] },
    Known { name: "shifted tiles, far", size: (70, 50), pixels_per_degree: 150.0, reference: |x, y| tiles(x, y, 0), test: |x, y| tiles(x, y, 1), mean: 0.118824, pixels: [0.10390, 0.00000, 0.08772] },
    Known { name: "ramp and grey", size: (64, 48), pixels_per_degree: FAR, reference: ramp, test: |_, _| [128; 3], mean: 0.814110, pixels: [0.95695, 0.44937, 0.97690] },
    Known { name: "one pixel", size: (1, 1), pixels_per_degree: FAR, reference: |_, _| [200, 30, 60], test: |_, _| [20, 200, 90], mean: 0.968549, pixels: [0.96855; 3] },
    Known { name: "smaller than the filters", size: (3, 5), pixels_per_degree: FAR, reference: |x, y| noise(x, y, 3), test: |x, y| noise(x, y, 4), mean: 0.229582, pixels: [0.24469, 0.22590, 0.23236] },
    Known { name: "wide", size: (257, 4), pixels_per_degree: FAR, reference: |x, y| noise(x, y, 5), test: |x, y| tiles(x, y, 3), mean: 0.873570, pixels: [0.96544, 0.86475, 0.96581] },
    Known { name: "green and blue", size: (9, 9), pixels_per_degree: FAR, reference: |_, _| [0, 255, 0], test: |_, _| [0, 0, 255], mean: 1.0, pixels: [1.0; 3] },
];

const MEAN_TOLERANCE: f64 = 2e-5;
const PIXEL_TOLERANCE: f32 = 2e-4;

fn noise(x: u32, y: u32, seed: u32) -> [u32; 3] {
    [0, 1, 2].map(|c| (x * x * 31 + y * y * 57 + x * y * 17 + c * 91 + seed * 13) % 251)
}

fn ramp(x: u32, y: u32) -> [u32; 3] {
    [x * 4, y * 5, 255 - x * 3]
}

fn tiles(x: u32, y: u32, offset: u32) -> [u32; 3] {
    if ((x + offset) / 8 + y / 6) % 2 == 1 { [230, 180, 40] } else { [20, 40, 120] }
}

impl Known {
    fn pictures(&self) -> [Grid<[u8; 3]>; 2] {
        [self.reference, self.test].map(|f| Grid::from_fn(self.size.0, self.size.1, |x, y| f(x, y).map(|v| v as u8)))
    }

    fn found_by(&self, method: &Method) -> Flip {
        let [a, b] = self.pictures();
        flip_with(method, &a, &b, self.pixels_per_degree).unwrap()
    }

    fn mean_agrees(&self, found: &Flip) -> bool {
        (found.mean - self.mean).abs() <= MEAN_TOLERANCE
    }
}

#[test]
fn agrees_with_nvidias_package() {
    for known in &KNOWN {
        let found = known.found_by(&Method::PUBLISHED);
        assert!(known.mean_agrees(&found), "{}: mean {} instead of {}", known.name, found.mean, known.mean);
        let (w, h) = known.size;
        for ((x, y), want) in [(0, 0), (w / 2, h / 2), (w - 1, h - 1)].into_iter().zip(known.pixels) {
            let got = *found.map.get(x, y);
            assert!((got - want).abs() <= PIXEL_TOLERANCE, "{}: pixel {x},{y} is {got} instead of {want}", known.name);
        }
    }
}

/// The negative control: the tolerances above are worth something only if a slip in a constant breaks them.
#[test]
fn a_slip_of_one_percent_in_any_constant_would_be_seen() {
    let m = || Method::PUBLISHED;
    let slips = [
        (
            "sensitivity to lightness",
            Method { sensitivity: [&[(1.0, 0.004747)], m().sensitivity[1], m().sensitivity[2]], ..m() },
        ),
        (
            "sensitivity to red-green",
            Method { sensitivity: [m().sensitivity[0], &[(1.0, 0.005353)], m().sensitivity[2]], ..m() },
        ),
        (
            "wide blue-yellow",
            Method { sensitivity: [m().sensitivity[0], m().sensitivity[1], &[(34.1, 0.0404), (13.5, 0.025)]], ..m() },
        ),
        (
            "narrow blue-yellow",
            Method { sensitivity: [m().sensitivity[0], m().sensitivity[1], &[(34.1, 0.04), (13.5, 0.02525)]], ..m() },
        ),
        (
            "blue-yellow balance",
            Method { sensitivity: [m().sensitivity[0], m().sensitivity[1], &[(34.1, 0.04), (13.635, 0.025)]], ..m() },
        ),
        ("colour exponent", Method { color_exponent: m().color_exponent * 1.01, ..m() }),
        ("bend", Method { bend: m().bend * 1.01, ..m() }),
        ("result at the bend", Method { bend_result: m().bend_result * 1.01, ..m() }),
        ("feature exponent", Method { feature_exponent: m().feature_exponent * 1.01, ..m() }),
        ("feature width", Method { feature_width: m().feature_width * 1.01, ..m() }),
    ];
    for (constant, method) in slips {
        assert!(KNOWN.iter().any(|known| !known.mean_agrees(&known.found_by(&method))), "{constant}");
    }
    assert!(KNOWN.iter().all(|known| known.mean_agrees(&known.found_by(&Method::PUBLISHED))));
}

#[test]
fn equal_pictures_give_zero_everywhere() {
    for known in &KNOWN {
        let [a, _] = known.pictures();
        let found = flip(&a, &a, known.pixels_per_degree).unwrap();
        assert_eq!(found.mean, 0.0);
        assert!(found.map.texels().iter().all(|&e| e == 0.0));
    }
}

#[test]
fn the_order_of_the_pictures_does_not_matter() {
    for known in &KNOWN {
        let [a, b] = known.pictures();
        assert_eq!(flip(&a, &b, FAR).unwrap(), flip(&b, &a, FAR).unwrap(), "{}", known.name);
    }
}

#[test]
fn errors_stay_within_0_and_1_at_every_viewing_distance() {
    for pixels_per_degree in [1.0, 3.0, 300.0, 1000.0] {
        for known in &KNOWN {
            let [a, b] = known.pictures();
            let found = flip(&a, &b, pixels_per_degree).unwrap();
            assert!(
                found.map.texels().iter().all(|e| (0.0..=1.0).contains(e)),
                "{} at {pixels_per_degree}",
                known.name
            );
            assert!(found.mean > 0.0);
        }
    }
}

#[test]
fn the_number_of_threads_does_not_change_a_bit() {
    let [a, b] = KNOWN[0].pictures();
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| flip(&a, &b, FAR).unwrap())
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn different_sizes_and_senseless_viewing_distances_are_refused() {
    let [a, b] = [Grid::from_fn(4, 3, |_, _| [0; 3]), Grid::from_fn(3, 4, |_, _| [0; 3])];
    assert_eq!(flip(&a, &b, FAR), Err(FlipError::Size(SizeMismatch { a: (4, 3), b: (3, 4) })));
    for bad in [0.0, -67.0, 1e9, f32::INFINITY] {
        assert_eq!(flip(&a, &a, bad), Err(FlipError::PixelsPerDegree(bad)));
    }
    assert!(matches!(flip(&a, &a, f32::NAN), Err(FlipError::PixelsPerDegree(x)) if x.is_nan()));
}

#[test]
fn the_papers_viewing_conditions_are_the_default() {
    assert!((pixels_per_degree(0.7, 0.7, 3840.0) - DEFAULT_PIXELS_PER_DEGREE).abs() < 1e-4);
    assert!((DEFAULT_PIXELS_PER_DEGREE - 67.0206).abs() < 1e-4);
}
