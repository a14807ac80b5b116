//! The exact march in WGSL against the f64 oracle: the rays, the reliefs and the judge of relievo-march's own test.

// A test reports its figures.
#![allow(clippy::print_stdout)]

mod common;
#[path = "../../relievo-march/tests/corpus/mod.rs"]
mod corpus;

use common::device::gpu;
use corpus::{Tally, WRAPS, corpus, many_rays, share};
use relievo_gpu::{ComputeField, ComputeMarch, HeightTexture, module_source};
use relievo_map::Wrap;
use relievo_march::March;

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
            let [tally] =
                relief.sweep(wrap, share, |rays| [kernels.march(field, rays, &March::default()).unwrap()]);
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

/// `cargo test --release -p relievo-gpu --test truth -- --ignored --nocapture`; `RAYS` says how many.
#[test]
#[ignore = "takes minutes to hours"]
fn no_hit_is_wrong_among_many_rays() {
    no_ray_is_wrong(many_rays());
}

#[test]
fn a_pyramid_one_code_too_low_gives_wrong_hits() {
    let Some(gpu) = gpu() else { return };
    let relief = corpus().swap_remove(1);
    let texture = HeightTexture::new(&gpu.device, &gpu.queue, &relief.heights).unwrap();
    let field = ComputeField { heights: &texture, lod: 0.0, wrap: Wrap::Repeat };
    let mut right = ComputeMarch::new(&gpu.device, &gpu.queue).unwrap();
    let mut low = ComputeMarch::new(&gpu.device, &gpu.queue).unwrap();
    let source = module_source("descent").unwrap();
    assert!(source.contains("<= f32(highest)"), "descent.wgsl has changed: spoil it elsewhere");
    low.set_module("descent", source.replace("<= f32(highest)", "<= f32(highest) - 1.0"));
    let how = March::default();
    let [right, low] = relief.sweep(Wrap::Repeat, 5_000, |rays| {
        [&mut right, &mut low].map(|kernels| kernels.march(field, rays, &how).unwrap())
    });
    right.assert_right("the pyramid as it is");
    assert!(low.wrong > 50, "{low:?}");
}
