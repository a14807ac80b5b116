//! What a coarse pass for tiles of 8×4 rays saves, as compute kernels.

use relievo_gpu::{ComputeField, ComputeMarch, Gpu, HeightTexture};
use relievo_map::Wrap;
use relievo_march::MarchOptions;

use crate::stage::{DEGREES, Result, Stage, WHOLE, by_tiles, median, rays};

pub(crate) fn report(gpu: &Gpu, stage: &Stage, rounds: usize) -> Result<()> {
    let texture = HeightTexture::new(&gpu.device, &gpu.queue, &stage.heights()?)?;
    let field = ComputeField { heights: &texture, lod: 0.0, wrap: Wrap::Repeat };
    let options = MarchOptions { bounds: Some(WHOLE), ..MarchOptions::default() };
    let mut kernels = ComputeMarch::new(&gpu.device, &gpu.queue)?;
    println!("`exact` as a compute kernel, rays in tiles of 8×4, alone and with the coarse pass:\n");
    println!(
        "| | alone | with tiles | ratio | fetches alone | with tiles | of which the tiles' |\n|---|---|---|---|---|---|---|"
    );
    for degrees in DEGREES {
        let rays = rays(degrees, by_tiles());
        let (mut alone, mut tiled) = (Vec::new(), Vec::new());
        for _ in 0..rounds {
            // Software adapters put no timestamps around what a compute pass does.
            alone.push(kernels.time(field, &rays, &options, 1)?[0].wall.as_secs_f64() * 1e3);
            tiled.push(kernels.time_tiles(field, &rays, &options, 1)?[0].wall.as_secs_f64() * 1e3);
        }
        let ratio = median(alone.iter().zip(&tiled).map(|(alone, tiled)| tiled / alone).collect());
        let mean = |fetches: f64| fetches / rays.len() as f64;
        let without = mean(kernels.march(field, &rays, &options)?.iter().map(|record| f64::from(record.fetches)).sum());
        let (records, entries) = kernels.march_tiles(field, &rays, &options)?;
        let before = mean(entries.iter().map(|entry| f64::from(entry.fetches)).sum());
        let with = before + mean(records.iter().map(|record| f64::from(record.fetches)).sum());
        let (alone, tiled) = (median(alone), median(tiled));
        println!(
            "| {degrees}° | {alone:.1} ms | {tiled:.1} ms | ×{ratio:.2} | {without:.2} | {with:.2} | {before:.2} |"
        );
    }
    println!();
    Ok(())
}
