//! The same bytes, however many threads draw.

use std::sync::atomic::{AtomicU32, Ordering};

use glam::Vec3;
use relievo_cpu::{RenderOptions, Renderer};
use relievo_scene::Scene;

use crate::common::*;

/// Everything that could depend on the order of work: several objects, penumbrae, several samples.
fn busy_scene() -> Scene {
    let mut scene = stage(90, 61, Vec3::new(1.5, 1.0, 3.0));
    scene.image.samples = 3;
    scene.lights.push(relievo_scene::Light { radius: 0.3, ..point_light(1.0, 2.0, 2.0) });
    add(&mut scene, shape("torus"), relief(hills(64, 32), 0.05), moved(0.0, 0.0, 0.0));
    add(&mut scene, shape("quad"), relief(stones(64, 64), 0.05), moved(0.0, 0.0, -1.0));
    add(&mut scene, shape("plane"), displaced_material(), moved(0.0, -0.8, 0.0));
    scene
}

fn displaced_material() -> relievo_scene::Material {
    let mut material = relief(stones(32, 32), 0.05);
    material.relief.technique = relievo_scene::SurfaceTechnique::Displacement;
    material.relief.grid = 20;
    material
}

#[test]
fn one_thread_or_many_draw_the_same_bytes_every_time() {
    let renderer = Renderer::new(&busy_scene()).unwrap();
    let draw = |threads| renderer.render(&RenderOptions { threads, ..RenderOptions::default() }).unwrap();
    let one = draw(Some(1));
    assert!(one.aovs.hit.texels().contains(&1.0) && one.aovs.hit.texels().contains(&0.0));
    for threads in [Some(1), Some(2), Some(5), None] {
        assert_eq!(draw(threads), one, "{threads:?} threads");
    }
    // Making the scene ready runs on many threads, too.
    assert_eq!(crate::common::draw(&busy_scene()), one);
}

#[test]
fn every_row_is_reported() {
    let (calls, last) = (AtomicU32::new(0), AtomicU32::new(0));
    let progress = |done: u32, all: u32| {
        assert!(done <= all && all == 61);
        calls.fetch_add(1, Ordering::Relaxed);
        last.fetch_max(done, Ordering::Relaxed);
    };
    let options = RenderOptions { progress: Some(&progress), ..RenderOptions::default() };
    Renderer::new(&busy_scene()).unwrap().render(&options).unwrap();
    assert_eq!((calls.into_inner(), last.into_inner()), (61, 61));
}
