//! Every march ends for every input, and its result is in range.

use relievo_map::{Grid, HeightMap, Wrap};
use relievo_march::{
    Bounds, Cones, MAX_CELLS, MarchOptions, OracleRay, Ray, ReliefMap, Shadow, Technique, march, oracle, shadow,
};
use relievo_testkit::{Random, WRAPS};

/// Returns mostly ordinary numbers, now and then the worst there are.
fn number(random: &mut Random, scale: f32) -> f32 {
    const ODD: [f32; 14] = [
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::MAX,
        f32::MIN,
        f32::MIN_POSITIVE,
        f32::EPSILON,
        1e-45,
        0.0,
        -0.0,
        1.0,
        -1.0,
        1e30,
        3e9,
    ];
    match random.next_u64() % 32 {
        0 => ODD[(random.next_u64() % ODD.len() as u64) as usize],
        _ => random.signed(scale),
    }
}

fn odd_ray(random: &mut Random) -> Ray {
    let cos = match random.next_u64() % 8 {
        0 => number(random, 1.0),
        1 => random.unit() * 1e-3,
        _ => random.unit(),
    };
    let uv = [number(random, 2.0), number(random, 2.0)];
    Ray { uv, uv_delta: [number(random, 0.2), number(random, 0.2)], cos }
}

fn maps() -> Vec<ReliefMap> {
    let noise = |x: u32, y: u32| {
        let mut random = Random(u64::from(x) << 32 | u64::from(y));
        random.unit()
    };
    [
        HeightMap::new(Grid::from_fn(1, 1, |_, _| 0.4)),
        HeightMap::new(Grid::from_fn(1, 7, noise)),
        HeightMap::new(Grid::from_fn(64, 64, noise)),
        HeightMap::new(Grid::from_fn(33, 20, |x, y| if x == 5 && y == 5 { 1.0 } else { 0.0 })),
        HeightMap::new(Grid::from_fn(16, 16, |_, _| 0.0)),
        HeightMap::new(Grid::from_fn(16, 16, |_, _| 1.0)),
        HeightMap::new(Grid::from_fn(4, 4, |x, _| if x == 2 { f32::NAN } else { 0.5 })),
    ]
    .iter()
    .map(|map| ReliefMap::with_mips(map).with_cones(Cones::Relaxed).with_cones(Cones::Conservative))
    .collect()
}

#[test]
fn ten_million_random_rays_end_and_stay_in_range() {
    let maps = maps();
    let mut random = Random(7);
    let kinds = [Shadow::Hard, Shadow::Soft, Shadow::Exact];
    let mut hits = 0u64;
    for i in 0..10_000_000u32 {
        let ray = odd_ray(&mut random);
        let options = MarchOptions {
            technique: Technique::ALL[i as usize % Technique::ALL.len()],
            offset_limiting: random.next_u64().is_multiple_of(4),
            min_layers: if i % 64 == 0 { number(&mut random, 1e9) } else { 4.0 },
            max_layers: if i % 64 == 1 { number(&mut random, 1e9) } else { 16.0 },
            refine_steps: if i % 64 == 2 { u32::MAX } else { 5 },
            cones: Cones::ALL[(i / 16 % 2) as usize],
            midlevel: if i % 4 == 0 { number(&mut random, 1.0) } else { 1.0 },
            bounds: (i % 3 == 0).then_some(Bounds { min: [0.0; 2], max: [1.0; 2] }),
        };
        let wrap = WRAPS[(random.next_u64() % 3) as usize];
        let field = maps[(random.next_u64() % maps.len() as u64) as usize].field(number(&mut random, 4.0), wrap);
        let record = march(&field, &ray, &options);
        assert!((0.0..=1.0).contains(&record.depth), "{ray:?} {options:?}: {record:?}");
        // A cell through cones costs a cone, and perhaps its corners.
        let most = if options.technique == Technique::Cone { 2 * MAX_CELLS } else { MAX_CELLS };
        assert!(record.fetches <= most + 1 && record.iterations <= MAX_CELLS + 1, "{options:?}: {record:?}");
        if record.hit {
            hits += 1;
            assert!(record.uv.iter().all(|x| x.is_finite()), "{ray:?} {options:?}: {record:?}");
            assert!(options.bounds.is_none_or(|bounds| bounds.contains(record.uv)), "{ray:?} {options:?}: {record:?}");
        }
        if i % 4 == 0 {
            let light = Ray { uv: record.uv, ..odd_ray(&mut random) };
            let depth = if i % 8 == 0 { number(&mut random, 1.0) } else { record.depth };
            let shadow = shadow(&field, kinds[i as usize / 4 % 3], &light, depth, &options);
            assert!((0.0..=1.0).contains(&shadow.factor), "{light:?} {depth} {options:?}: {shadow:?}");
        }
    }
    // The test would be worth nothing if most rays were turned away at the door.
    assert!(hits > 4_000_000, "only {hits} hits");
}

#[test]
fn the_oracle_ends_for_every_input_too() {
    let maps = maps();
    let mut random = Random(11);
    let mut hits = 0;
    for _ in 0..60_000 {
        let ray = OracleRay::from(&odd_ray(&mut random));
        let map = &maps[(random.next_u64() % maps.len() as u64) as usize];
        if let Some(hit) = oracle(&map.field(0.0, Wrap::Repeat), &ray, None) {
            hits += 1;
            assert!((0.0..=1.0).contains(&hit.depth) && hit.uv.iter().all(|x| x.is_finite()), "{ray:?}: {hit:?}");
        }
    }
    assert!(hits > 30_000, "only {hits} hits");
}
