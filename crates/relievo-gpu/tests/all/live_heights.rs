//! Max pyramids that the device builds are those that the host builds, node by node.

use relievo_gpu::{
    ComputeField, ComputeMarch, GpuError, HeightTexture, LiveHeights, Quantization, Renderer, RendererOptions,
};
use relievo_lab::pixel_difference;
use relievo_map::{Grid, HeightMap, MipMap, Wrap};
use relievo_march::{MarchOptions, MaxPyramid, Node, Ray, ReliefMap, Shadow, TexelRect, march};
use relievo_scene::Scene;
use relievo_testkit::{Random, in_8_bits, noise};

use crate::common::device::{Gpu, gpu, open};
use crate::common::picture::{draw, draw_with};
use crate::common::scene::parse;
use crate::common::tolerances::PICTURE_THRESHOLD;

/// The texels of a mip level, `N` bytes each.
fn texels<const N: usize>(gpu: &Gpu, texture: &wgpu::Texture, level: u32) -> Vec<[u8; N]> {
    let size = [texture.width(), texture.height()].map(|n| (n >> level).max(1));
    let row = (size[0] * N as u32).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(row * size[1]),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
    encoder.copy_texture_to_buffer(
        wgpu::TexelCopyTextureInfo { mip_level: level, ..texture.as_image_copy() },
        wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
        wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
    );
    gpu.queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |result| result.unwrap());
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let bytes = buffer.get_mapped_range(..).unwrap();
    let rows = bytes.chunks_exact(row as usize);
    rows.flat_map(|row| row[..size[0] as usize * N].chunks_exact(N).map(|texel| texel.try_into().unwrap())).collect()
}

/// A pyramid as it lies on the device.
#[derive(Debug, PartialEq)]
struct Built {
    quantization: [f32; 2],
    clearance: f32,
    levels: Vec<Vec<Node>>,
}

impl Built {
    fn on_the_host(pyramid: &MaxPyramid) -> Self {
        let levels = pyramid.levels().map(|level| level.nodes().to_vec()).collect();
        Self { quantization: pyramid.quantization(), clearance: pyramid.clearance(), levels }
    }

    /// All pyramids of a texture, of maps of these sizes.
    fn on_the_device(gpu: &Gpu, heights: &HeightTexture, sizes: &[[u32; 2]]) -> Vec<Self> {
        let texture = heights.pyramid().texture();
        let width = texture.width() as usize;
        let all: Vec<Node> = texels(gpu, texture, 0);
        let built = sizes.iter().zip(&all).map(|(size, header)| {
            let [place, low, step, clearance] =
                [0, 1, 2, 3].map(|k| u32::from_le_bytes(header[4 * k..4 * k + 4].try_into().unwrap()));
            let mut row = (place & 0xff_ffff) as usize;
            let mut size = size.map(|n| n as usize);
            let levels = (0..place >> 24).map(|_| {
                size = size.map(|n| n.div_ceil(4));
                let rows = all[row * width..].chunks(width).take(size[1]);
                row += size[1];
                rows.flat_map(|row| row[..size[0]].to_vec()).collect()
            });
            let levels: Vec<_> = levels.collect();
            assert_eq!(size, [1, 1]);
            Self { quantization: [low, step].map(f32::from_bits), clearance: f32::from_bits(clearance), levels }
        });
        built.collect()
    }
}

const SIZES: [[u32; 2]; 9] = [[64, 64], [37, 22], [300, 5], [2, 130], [1, 1], [1, 7], [5, 1], [257, 255], [16, 4]];

/// What differs, of all mip levels, from what the host builds of the map.
fn differences(gpu: &Gpu, live: &LiveHeights, map: &Grid<f32>, mips: bool, quantization: Quantization) -> usize {
    let mips = if mips { MipMap::build(map.clone()) } else { MipMap::single(map.clone()) };
    let sizes: Vec<_> = mips.levels().iter().map(|level| [level.width(), level.height()]).collect();
    let built = Built::on_the_device(gpu, live.heights(), &sizes);
    let mut different = 0;
    for (k, (level, built)) in mips.levels().iter().zip(&built).enumerate() {
        let bytes: Vec<[u8; 4]> = texels(gpu, live.texture(), k as u32);
        different += usize::from(!bytes.iter().map(|b| f32::from_le_bytes(*b)).eq(level.texels().iter().copied()));
        different +=
            usize::from(*built != Built::on_the_host(&MaxPyramid::build(level, quantization != Quantization::Own)));
    }
    different
}

const UNIT: Quantization = Quantization::Range([0.0, 1.0]);

#[test]
fn every_node_of_every_mip_level_is_that_of_the_host() {
    let Some(gpu) = gpu() else { return };
    for (k, size) in SIZES.into_iter().enumerate() {
        let narrow = noise(size, k as u64).map(|h| 0.3 + 0.2 * h);
        for (map, quantization) in
            [(in_8_bits(&narrow), UNIT), (narrow.clone(), UNIT), (narrow.clone(), Quantization::Own)]
        {
            for mips in [false, true] {
                let height = HeightMap::new(map.clone());
                let heights = if mips { ReliefMap::with_mips(&height) } else { ReliefMap::new(&height) };
                let live = LiveHeights::new(&gpu.device, &gpu.queue, &heights, quantization).unwrap();
                assert_eq!(
                    differences(gpu, &live, &map, mips, quantization),
                    0,
                    "{size:?} {quantization:?}, mips: {mips}"
                );
                // The other quantization, or another map, is told from this one; a single height has no range of its own.
                let other = if quantization == UNIT { Quantization::Own } else { UNIT };
                let same = differences(gpu, &live, &map, mips, other) == 0;
                assert_eq!(same, size == [1, 1], "{size:?} {quantization:?}, mips: {mips}");
                let mut other = map.clone();
                *other.texels_mut().last_mut().unwrap() = 0.9;
                assert_ne!(differences(gpu, &live, &other, mips, quantization), 0, "{size:?} {quantization:?}");
            }
        }
    }
    // The range that a map has, given by the caller.
    let map = noise([70, 90], 5).map(|h| 0.25 + 0.5 * h);
    let range = map.texels().iter().fold([1.0f32, 0.0], |[low, high], &h| [low.min(h), high.max(h)]);
    let heights = ReliefMap::new(&HeightMap::new(map.clone()));
    let live = LiveHeights::new(&gpu.device, &gpu.queue, &heights, Quantization::Range(range)).unwrap();
    let built = Built::on_the_device(gpu, live.heights(), &[[70, 90]]);
    assert_eq!(built, [Built::on_the_host(&MaxPyramid::build(&map, false))]);
}

#[test]
fn a_changed_rectangle_gives_what_building_anew_gives() {
    let Some(gpu) = gpu() else { return };
    let mut random = Random(21);
    for size in [[64, 64], [37, 22], [5, 3], [1, 1]] {
        for quantization in [UNIT, Quantization::Own] {
            let mut map = noise(size, 3);
            let heights = ReliefMap::with_mips(&HeightMap::new(map.clone()));
            let live = LiveHeights::new(&gpu.device, &gpu.queue, &heights, quantization).unwrap();
            for i in 0..40 {
                let min = size.map(|n| random.next_u64() as u32 % n);
                let extent = [0, 1].map(|k| random.next_u64() as u32 % (size[k] - min[k] + 1));
                for y in min[1]..min[1] + extent[1] {
                    for x in min[0]..min[0] + extent[0] {
                        map.texels_mut()[(y * size[0] + x) as usize] = random.unit();
                    }
                }
                live.write(&gpu.queue, &HeightMap::new(map.clone()), TexelRect { min, size: extent }).unwrap();
                let different = differences(gpu, &live, &map, true, quantization);
                assert_eq!(different, 0, "{size:?} {quantization:?}, update {i}: {min:?} {extent:?}");
            }
        }
    }
}

#[test]
fn a_change_that_is_not_told_leaves_the_old_nodes() {
    let Some(gpu) = gpu() else { return };
    let mut map = noise([40, 40], 3);
    let live = LiveHeights::new(&gpu.device, &gpu.queue, &ReliefMap::new(&HeightMap::new(map.clone())), UNIT).unwrap();
    for i in [3 * 40 + 20, 30 * 40 + 2] {
        map.texels_mut()[i] = 1.0;
    }
    // Of the two changed texels only the first is in the rectangle.
    live.write(&gpu.queue, &HeightMap::new(map.clone()), TexelRect { min: [20, 3], size: [1, 1] }).unwrap();
    assert_ne!(differences(gpu, &live, &map, false, UNIT), 0);
    live.write(&gpu.queue, &HeightMap::new(map.clone()), TexelRect { min: [2, 30], size: [1, 1] }).unwrap();
    assert_eq!(differences(gpu, &live, &map, false, UNIT), 0);
}

#[test]
fn several_updates_in_one_submission_all_count() {
    let Some(gpu) = gpu() else { return };
    let before = noise([64, 64], 1);
    let after = noise([64, 64], 2);
    let quantization = UNIT;
    let live =
        LiveHeights::new(&gpu.device, &gpu.queue, &ReliefMap::new(&HeightMap::new(before)), quantization).unwrap();
    // The device changes its heights by itself, half by half.
    let bytes = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 64 * 64 * 4,
        usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let texels: Vec<u8> = after.texels().iter().flat_map(|h| h.to_le_bytes()).collect();
    gpu.queue.write_buffer(&bytes, 0, &texels);
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    for half in [0, 32] {
        let layout = wgpu::TexelCopyBufferLayout {
            offset: u64::from(half) * 256,
            bytes_per_row: Some(256),
            rows_per_image: None,
        };
        let origin = wgpu::Origin3d { x: 0, y: half, z: 0 };
        encoder.copy_buffer_to_texture(
            wgpu::TexelCopyBufferInfo { buffer: &bytes, layout },
            wgpu::TexelCopyTextureInfo { origin, ..live.texture().as_image_copy() },
            wgpu::Extent3d { width: 64, height: 32, depth_or_array_layers: 1 },
        );
        live.update(&mut encoder, TexelRect { min: [0, half], size: [64, 32] }).unwrap();
    }
    gpu.queue.submit([encoder.finish()]);
    assert_eq!(differences(gpu, &live, &after, false, quantization), 0);
}

#[test]
fn marches_through_changed_heights_are_those_of_the_host() {
    let Some(gpu) = gpu() else { return };
    let mut kernels = ComputeMarch::new(&gpu.device, &gpu.queue).unwrap();
    let mut random = Random(8);
    let mut map = in_8_bits(&noise([90, 60], 4).map(|h| 0.6 * h));
    // The range stays, and with it where marches begin.
    map.texels_mut()[0] = 0.0;
    map.texels_mut()[1] = 1.0;
    let before = HeightMap::new(map.clone());
    for y in 20..40 {
        for x in 50..80 {
            map.texels_mut()[y * 90 + x] = 0.8;
        }
    }
    let changed = HeightMap::new(in_8_bits(&map));
    let rays: Vec<Ray> = (0..4000)
        .map(|_| {
            let (sin, cos) = (0.2 + 1.35 * random.unit()).sin_cos();
            let (y, x) = random.signed(std::f32::consts::PI).sin_cos();
            Ray { uv: [random.unit(), random.unit()], uv_delta: [0.2 * sin * x, 0.2 * sin * y], cos }
        })
        .collect();
    for prepared in [ReliefMap::new, ReliefMap::nearest] {
        let live = LiveHeights::new(&gpu.device, &gpu.queue, &prepared(&before), UNIT).unwrap();
        let heights = prepared(&changed);
        let mut different = |live: &LiveHeights| {
            let field = ComputeField { heights: live.heights(), lod: 0.0, wrap: Wrap::Repeat };
            let found = kernels.march(field, &rays, &MarchOptions::default()).unwrap();
            let field = heights.field(0.0, Wrap::Repeat);
            let pairs = found.iter().zip(&rays);
            pairs
                .filter(|(found, ray)| (found.depth - march(&field, ray, &MarchOptions::default()).depth).abs() > 1e-4)
                .count()
        };
        assert!(different(&live) > 400, "the change is not seen by these rays");
        live.write(&gpu.queue, &changed, TexelRect { min: [50, 20], size: [30, 20] }).unwrap();
        assert!(different(&live) <= 8, "{} of 4000 rays", different(&live));
    }
}

#[test]
fn what_cannot_be_is_refused_and_nothing_changes() {
    let Some(gpu) = gpu() else { return };
    let map = noise([20, 20], 3).map(|h| 0.25 + 0.5 * h);
    let heights = ReliefMap::new(&HeightMap::new(map.clone()));
    let new = |quantization| LiveHeights::new(&gpu.device, &gpu.queue, &heights, quantization);
    let text = |error: GpuError| error.to_string();
    for range in [[0.5, 0.5], [0.9, 0.1], [-1.0, 1.0], [0.0, 1.5], [f32::NAN, 1.0]] {
        assert!(text(new(Quantization::Range(range)).unwrap_err()).contains("is no range of heights"), "{range:?}");
    }
    assert!(text(new(Quantization::Range([0.0, 0.5])).unwrap_err()).contains("outside of the changing map's range"));
    let quantization = Quantization::Range([0.2, 0.8]);
    let live = new(quantization).unwrap();
    let written = |map: &Grid<f32>, min, size| {
        text(live.write(&gpu.queue, &HeightMap::new(map.clone()), TexelRect { min, size }).unwrap_err())
    };
    let mut high = map.clone();
    high.texels_mut()[21] = 0.9;
    assert!(written(&high, [0, 0], [20, 20]).contains("the height 0.9 is outside"));
    assert!(written(&map, [10, 0], [11, 1]).contains("11×1 texels from (10, 0) on are not inside 20×20"));
    assert!(written(&map, [u32::MAX, 0], [2, 1]).contains("not inside"));
    assert!(written(&noise([20, 21], 1), [0, 0], [1, 1]).contains("20×21"));
    live.write(&gpu.queue, &HeightMap::new(map.clone()), TexelRect { min: [20, 20], size: [0, 0] }).unwrap();
    let built = Built::on_the_device(gpu, live.heights(), &[[20, 20]]);
    let again = Built::on_the_device(gpu, new(quantization).unwrap().heights(), &[[20, 20]]);
    assert_eq!(built, again);
    let least = pollster::block_on(open(wgpu::Limits::downlevel_webgl2_defaults(), None)).unwrap();
    let refused = LiveHeights::new(&least.device, &least.queue, &heights, quantization).unwrap_err();
    assert_eq!(refused, GpuError::NoCompute);
}

#[test]
fn a_renderer_draws_what_was_changed_as_if_it_had_been_made_so() {
    let Some(gpu) = gpu() else { return };
    let text = r#"
        image = { width = 120, height = 90 }
        camera = { position = [0.6, -1.3, 1.6] }
        lights = [{ kind = "point", position = [1.0, 1.0, 1.5] }]
        [materials.wall]
        from = "make:brick-wall"
        relief = { edge = "clip", shadow = "exact" }
        [[objects]]
        mesh = "quad"
        material = "wall"
    "#;
    let mut scene = parse(text, &[], 128);
    scene.materials[0].maps.normal = None;
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let new =
        |scene: &Scene| Renderer::new(&gpu.device, &gpu.queue, scene, format, &RendererOptions::default()).unwrap();
    let before = scene.materials[0].maps.height.clone().unwrap();
    let live = LiveHeights::new(&gpu.device, &gpu.queue, &ReliefMap::new(&before), UNIT).unwrap();
    let mut renderer = new(&scene);
    renderer.set_heights(&scene, 0, live.heights()).unwrap();
    let mut grid = before.into_grid();
    for y in 40..80 {
        for x in 50..90 {
            grid.texels_mut()[y * 128 + x] = if (x / 8 + y / 8) % 2 == 0 { 1.0 } else { 0.2 };
        }
    }
    let after = HeightMap::new(grid);
    let mut changed = scene.clone();
    changed.materials[0].maps.height = Some(after.clone());
    let expected = draw(gpu, &changed, format);
    let different = |renderer: &mut Renderer| {
        let got = draw_with(gpu, renderer, [120, 90], format);
        pixel_difference(&expected, &got, PICTURE_THRESHOLD).unwrap()
    };
    assert!(different(&mut renderer).over > 0.02, "the change is not seen");
    live.write(&gpu.queue, &after, TexelRect { min: [50, 40], size: [40, 40] }).unwrap();
    renderer.heights_changed();
    let difference = different(&mut renderer);
    println!("{difference:?}");
    assert!(difference.over <= 1e-3 && difference.mean < 0.05, "{difference:?}");
    // The heights stay when the relief is drawn differently.
    scene.materials[0].relief.shadow = Shadow::None;
    renderer.set_reliefs(&scene).unwrap();
    scene.materials[0].relief.shadow = Shadow::Exact;
    renderer.set_reliefs(&scene).unwrap();
    assert!(different(&mut renderer).over <= 1e-3);
    let refused = renderer.set_heights(&scene, 1, live.heights()).unwrap_err();
    assert!(refused.to_string().contains("no material 1 among 1"), "{refused}");
    // The back of heights that change is not drawn: it would stay as it was.
    scene.camera.position.z *= -1.0;
    scene.materials[0].two_sided = Some(true);
    let mut renderer = new(&scene);
    let plain = |picture: Grid<[u8; 3]>| picture.texels().iter().all(|pixel| *pixel == picture.texels()[0]);
    assert!(!plain(draw_with(gpu, &mut renderer, [120, 90], format)), "its own heights have two sides");
    renderer.set_heights(&scene, 0, live.heights()).unwrap();
    assert!(plain(draw_with(gpu, &mut renderer, [120, 90], format)));
}
