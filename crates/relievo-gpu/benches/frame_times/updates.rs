//! What it costs to keep the pyramid of a changing height map up to date, beside the frame that marches through it.

use std::time::Instant;

use relievo_gpu::{Gpu, LiveHeights, Offscreen, Quantization, Renderer, RendererOptions};
use relievo_march::{MaxPyramid, ReliefMap, TexelRect};

use crate::stage::{Result, SIZE, Stage, median};

/// Texels of the field, and of the rectangle.
const SIDE: u32 = 1024;
const DIRTY: u32 = 64;

pub(crate) fn report(gpu: &Gpu, stage: &Stage, rounds: usize) -> Result<()> {
    let (device, queue) = (&gpu.device, &gpu.queue);
    let map = relievo_make::make("brick-wall", SIDE)?.height.ok_or("the wall has heights")?;
    let heights = ReliefMap::new(&map);
    let whole = TexelRect { min: [0; 2], size: [SIDE; 2] };
    let dirty = TexelRect { min: [SIDE / 2 - DIRTY / 2 + 5; 2], size: [DIRTY; 2] };
    let unit = LiveHeights::new(device, queue, &heights, Quantization::Range([0.0, 1.0]))?;
    let own = LiveHeights::new(device, queue, &heights, Quantization::Own)?;
    let mips = LiveHeights::new(device, queue, &ReliefMap::with_mips(&map), Quantization::Range([0.0, 1.0]))?;
    let rows = [
        ("whole", &unit, whole),
        ("whole, range found by the device", &own, whole),
        ("whole, with all mip levels and their pyramids", &mips, whole),
        ("64×64", &unit, dirty),
        ("64×64, with all mip levels and their pyramids", &mips, dirty),
    ];
    let scene = stage.scene(60.0, &["technique=exact"])?;
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let mut renderer = Renderer::new(device, queue, &scene, format, &RendererOptions::default())?;
    renderer.set_heights(&scene, 0, unit.heights())?;
    let target = Offscreen::new(device, queue, SIZE, format)?;
    let mut pyramid = MaxPyramid::build(map.grid(), true);
    let mut rounds_taken = Vec::new();
    for round in 0..=rounds {
        // By the program's clock: software adapters put no timestamps around what a compute pass does.
        let mut taken = vec![target.time(&mut renderer)?.wall.as_secs_f64() * 1e3];
        for (_, live, part) in &rows {
            let start = Instant::now();
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            live.update(&mut encoder, *part)?;
            queue.submit([encoder.finish()]);
            device.poll(wgpu::PollType::wait_indefinitely())?;
            taken.push(start.elapsed().as_secs_f64() * 1e3);
        }
        let start = Instant::now();
        pyramid = MaxPyramid::build(map.grid(), true);
        taken.push(start.elapsed().as_secs_f64() * 1e3);
        let start = Instant::now();
        pyramid.update(map.grid(), dirty, true);
        taken.push(start.elapsed().as_secs_f64() * 1e3);
        if round > 0 {
            rounds_taken.push(taken);
        }
    }
    std::hint::black_box(pyramid);
    println!("Bringing the max pyramid of a {SIDE}² height map up to date, and the `exact` frame at 60° through it:\n");
    println!("| | time | share of the frame |\n|---|---|---|");
    let names =
        ["the frame"].into_iter().chain(rows.iter().map(|row| row.0)).chain(["whole, on the CPU", "64×64, on the CPU"]);
    for (k, name) in names.enumerate() {
        let time = median(rounds_taken.iter().map(|round| round[k]).collect());
        let share = median(rounds_taken.iter().map(|round| round[k] / round[0]).collect());
        println!("| {name} | {time:.2} ms | {:.2} % |", share * 100.0);
    }
    println!();
    Ok(())
}
