//! The exact march in WGSL against the f64 oracle: the rays, the reliefs and the judge of relievo-march's own test.

use relievo_gpu::{ComputeField, ComputeMarch, HeightTexture, LiveHeights, Quantization};
use relievo_map::{HeightMap, Wrap};
use relievo_march::{MarchOptions, ReliefMap};
use relievo_testkit::{Tally, WRAPS, corpus, many_rays, share};

use crate::common::device::gpu;

fn no_ray_is_wrong(rays: u64) {
    let Some(gpu) = gpu() else { return };
    let mut kernels = ComputeMarch::new(&gpu.device, &gpu.queue).unwrap();
    let mut total = Tally::default();
    let corpus = corpus();
    let share = share(rays, &corpus);
    for relief in &corpus {
        let texture = HeightTexture::new(&gpu.device, &gpu.queue, &relief.heights).unwrap();
        for wrap in WRAPS {
            let field = ComputeField { heights: &texture, lod: 0.0, wrap };
            let [tally] = relief
                .march_and_judge(wrap, share, |rays| [kernels.march(field, rays, &MarchOptions::default()).unwrap()]);
            println!("{:22} {wrap:?}: {tally:?}", relief.name);
            total = total + tally;
        }
    }
    println!("{}: {total:?}", gpu.name);
    total.assert_right(&gpu.name);
}

#[test]
fn no_hit_is_wrong_from_straight_down_to_half_a_degree_in_reliefs_of_1_to_100_texels() {
    no_ray_is_wrong(60_000);
}

/// `cargo test --release -p relievo-gpu --test all truth -- --ignored --nocapture`; `RAYS` says how many.
#[test]
#[ignore = "takes minutes to hours"]
fn no_hit_is_wrong_among_many_rays() {
    no_ray_is_wrong(many_rays());
}

#[test]
fn a_pyramid_rounded_down_gives_wrong_hits() {
    let Some(gpu) = gpu() else { return };
    let relief = corpus().swap_remove(1);
    let map = &relief.heights.levels()[0];
    let low = ReliefMap::new(&HeightMap::new(map.map(|h| h - 1.0 / 255.0)));
    let live = |heights| LiveHeights::new(&gpu.device, &gpu.queue, heights, Quantization::Range([0.0, 1.0])).unwrap();
    let (right, low) = (live(&relief.heights), live(&low));
    // The heights as they are, over the pyramid of the lower ones.
    let size = wgpu::Extent3d { width: map.width(), height: map.height(), depth_or_array_layers: 1 };
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * map.width()), rows_per_image: None };
    let bytes: Vec<u8> = map.texels().iter().flat_map(|h| h.to_le_bytes()).collect();
    gpu.queue.write_texture(low.texture().as_image_copy(), &bytes, layout, size);
    let mut kernels = ComputeMarch::new(&gpu.device, &gpu.queue).unwrap();
    let [right, low] = relief.march_and_judge(Wrap::Repeat, 5_000, |rays| {
        [&right, &low].map(|live| {
            let field = ComputeField { heights: live.heights(), lod: 0.0, wrap: Wrap::Repeat };
            kernels.march(field, rays, &MarchOptions::default()).unwrap()
        })
    });
    right.assert_right("the pyramid as it is, built on the device");
    assert!(low.wrong > 50, "{low:?}");
}
