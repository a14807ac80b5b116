//! Time and image error together: how much slower the classic techniques are once they are as accurate as `exact`.
//!
//! Times are those of the device. Pictures are drawn by the CPU renderer, truth and contenders alike, so that they differ by
//! the march alone: filters and rounding in hardware would be seen as errors of every technique. The marches of both
//! backends are the same, ray by ray, as the tests show.

use relievo_cpu::{Precision, RenderOptions};
use relievo_gpu::{Gpu, Offscreen, Renderer, RendererOptions};
use relievo_lab::{DEFAULT_PIXELS_PER_DEGREE, flip};
use relievo_map::Grid;

use crate::stage::{DEGREES, Result, SIZE, Stage, median, milliseconds};

/// `occlusion` and `relief` with ever more layers, a quarter of them when looking along the normal.
const TECHNIQUES: [(&str, &[u32]); 2] = [("occlusion", &[]), ("relief", &[5, 10])];

/// An error this much above that of `exact` counts as the same.
const SAME: f64 = 1.1;

struct Setting {
    name: String,
    changes: Vec<String>,
}

impl Setting {
    fn new(technique: &str, layers: u32, refine_steps: Option<u32>) -> Self {
        let fewest = layers / 4;
        let mut changes = vec![
            format!("technique={technique}"),
            format!("min_layers={fewest}"),
            format!("max_layers={layers}"),
            // All are lit at their hit: pictures differ by the march alone.
            "write_depth=true".to_owned(),
        ];
        changes.extend(refine_steps.map(|steps| format!("refine_steps={steps}")));
        let refined = refine_steps.map_or(String::new(), |steps| format!(" + {steps}"));
        Self { name: format!("`{technique}` {fewest}..{layers}{refined}"), changes }
    }

    fn changes<'a>(&'a self, more: &[&'a str]) -> Vec<&'a str> {
        self.changes.iter().map(String::as_str).chain(more.iter().copied()).collect()
    }
}

struct HitEvaluator<'a> {
    gpu: &'a Gpu,
    stage: &'a Stage,
    degrees: f32,
    samples: String,
    truth: Grid<[u8; 3]>,
    rounds: usize,
    /// The times of `exact` are taken in turn with those of each setting.
    exact: Renderer,
    target: Offscreen,
}

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

impl<'a> HitEvaluator<'a> {
    fn new(gpu: &'a Gpu, stage: &'a Stage, degrees: f32, samples: u32, rounds: usize) -> Result<Self> {
        let samples = format!("image.samples={samples}");
        let scene = stage.scene(degrees, &["technique=exact", &samples])?;
        let options = RenderOptions { precision: Precision::Oracle, ..RenderOptions::default() };
        let truth = relievo_cpu::Renderer::new(&scene)?.render(&options)?.pixels;
        let scene = stage.scene(degrees, &["technique=exact"])?;
        let exact = Renderer::new(&gpu.device, &gpu.queue, &scene, FORMAT, &RendererOptions::default())?;
        let target = Offscreen::new(&gpu.device, &gpu.queue, SIZE, FORMAT)?;
        Ok(Self { gpu, stage, degrees, samples, truth, rounds, exact, target })
    }

    /// The mean of FLIP.
    fn error(&self, setting: &Setting) -> Result<f64> {
        let scene = self.stage.scene(self.degrees, &setting.changes(&[&self.samples]))?;
        let picture = relievo_cpu::Renderer::new(&scene)?.render(&RenderOptions::default())?.pixels;
        Ok(flip(&self.truth, &picture, DEFAULT_PIXELS_PER_DEGREE)?.mean)
    }

    /// The median frame time in milliseconds, and that of its ratio to `exact`.
    fn time(&mut self, setting: &Setting) -> Result<(f64, f64)> {
        let scene = self.stage.scene(self.degrees, &setting.changes(&[]))?;
        let (device, queue) = (&self.gpu.device, &self.gpu.queue);
        let mut renderer = Renderer::new(device, queue, &scene, FORMAT, &RendererOptions::default())?;
        let (mut times, mut ratios) = (Vec::new(), Vec::new());
        for round in 0..=self.rounds {
            let exact = milliseconds(self.target.time(&mut self.exact)?);
            let other = milliseconds(self.target.time(&mut renderer)?);
            // The first round is not counted.
            if round > 0 {
                times.push(other);
                ratios.push(other / exact);
            }
        }
        Ok((median(times), median(ratios)))
    }
}

/// Prints, for each angle, the error and the time of `exact` and of the ladder of classic settings up to `most` layers.
pub(crate) fn report(gpu: &Gpu, stage: &Stage, rounds: usize, samples: u32, most: u32) -> Result<()> {
    println!(
        "Mean FLIP against the picture of the f64 oracle, all pictures drawn on the CPU with {samples} samples per pixel; \
         frame times with one sample, as ratios to `exact` in the same round.\n"
    );
    for degrees in DEGREES {
        let mut judge = HitEvaluator::new(gpu, stage, degrees, samples, rounds)?;
        let exact = Setting { name: "`exact`".to_owned(), changes: vec!["technique=exact".to_owned()] };
        let (time, _) = judge.time(&exact)?;
        let error = judge.error(&exact)?;
        println!("| {degrees}° | FLIP | frame | ÷ `exact` |\n|---|---|---|---|");
        println!("| {} | {error:.2e} | {time:.1} ms | 1 |", exact.name);
        // The cheapest setting that is as accurate, and the error and time of the first.
        let mut cheapest: Option<(String, f64)> = None;
        let mut first: Option<(f64, f64)> = None;
        for (technique, refinements) in TECHNIQUES {
            let refinements: Vec<_> =
                if refinements.is_empty() { vec![None] } else { refinements.iter().map(|&n| Some(n)).collect() };
            for refine_steps in refinements {
                let mut layers = 32;
                while layers <= most {
                    let setting = Setting::new(technique, layers, refine_steps);
                    let (time, ratio) = judge.time(&setting)?;
                    // What is dearer than what is known to be as accurate need not be looked at.
                    if cheapest.as_ref().is_some_and(|(_, known)| ratio > *known) {
                        break;
                    }
                    let other = judge.error(&setting)?;
                    println!("| {} | {other:.2e} | {time:.1} ms | {ratio:.2} |", setting.name);
                    first.get_or_insert((other, ratio));
                    if other <= error * SAME {
                        cheapest = Some((setting.name, ratio));
                        break;
                    }
                    layers *= 2;
                }
            }
        }
        let (occlusion, ratio) = first.ok_or("no layers were asked for")?;
        println!("\nAt {degrees}° `exact` takes {:.2} of the time of `occlusion` 8..32,", 1.0 / ratio);
        println!("its error is {:.4} of that one's;", error / occlusion);
        match cheapest {
            Some((name, ratio)) => println!("as accurate is {name}, in {ratio:.1} times the time.\n"),
            None => println!("none up to {most} layers is as accurate.\n"),
        }
    }
    Ok(())
}
