use std::path::PathBuf;

use clap::Args;
use relievo_map::FilmShape;
use relievo_scene::{Scene, SurfaceTechnique};

use super::time_range::TimeRange;
use crate::aov::AovFile;
use crate::backend::Backend;
use crate::outputs::film_parser;
use crate::scene_args::{MACHINE, OUTPUT, SCENE, SceneArguments, technique_parser, whole_number};

/// Memory for a pixel while it is drawn, with all that is kept for AOVs, in bytes (measured: 110).
pub(super) const BYTES_PER_PIXEL: u64 = 128;

/// Draw a scene into a PNG, or its course over time into many, or into one film
#[derive(Args)]
#[command(after_help = "Examples:
  relievo render -o wall.png
  relievo render scenes/sphere.toml -o sphere.png --technique occlusion --size 1280x720
  relievo render -o wall.png --aov depth=depth.exr --aov fetches=cost.png --stats stats.json
  relievo render -o wall.png --set lights.0.direction='[0.7, -0.5, -0.5]' --shadow soft
  relievo render scenes/drifting-clouds.toml --time 2.5 -o clouds.png
  relievo render scenes/drifting-clouds.toml --animate 0..8 --fps 24 -o frames/%04d.png
  relievo render scenes/drifting-clouds.toml --animate 0..8 --fps 24 -o clouds.webp")]
pub(crate) struct Arguments {
    /// The picture (PNG); with --animate a name with %d in it for each frame's number, or a film: .apng or .webp
    #[arg(long, short, value_name = "OUT.png", value_parser = film_parser(), help_heading = OUTPUT)]
    pub(super) output: PathBuf,
    /// More than colours: depth, normal, uv, fetches, shadow or hit, as .exr (the numbers) or .png (to look at); may be
    /// repeated
    #[arg(long = "aov", value_name = "KIND=FILE", help_heading = OUTPUT)]
    pub(super) aovs: Vec<AovFile>,
    /// Timings and costs as JSON; - for stdout
    #[arg(long, value_name = "FILE.json", help_heading = OUTPUT)]
    pub(super) stats: Option<PathBuf>,
    #[command(flatten)]
    pub(super) scene: SceneArguments,
    /// Draw every frame from time A to before time B, seconds; frames that an earlier run has drawn are left alone
    #[arg(long, value_name = "A..B", allow_hyphen_values = true, conflicts_with_all = ["time", "aovs", "stats", "frames"], help_heading = SCENE)]
    pub(super) animate: Option<TimeRange>,
    /// Frames per second of --animate
    #[arg(long, value_name = "N", default_value_t = 30.0, value_parser = parse_rate, allow_negative_numbers = true, requires = "animate", help_heading = SCENE)]
    pub(super) fps: f64,
    /// Technique of every material's relief but mist's [default: the scene's]
    #[arg(long, value_name = "TECHNIQUE", value_parser = technique_parser(), help_heading = SCENE)]
    pub(super) technique: Option<SurfaceTechnique>,
    /// Backend that draws: auto takes a GPU if there is a real one, else the CPU
    #[arg(long, value_enum, default_value_t = Backend::Auto, help_heading = MACHINE)]
    pub(super) backend: Backend,
    /// The GPU to draw on, by a part of its name as `relievo devices` lists it
    #[arg(long, value_name = "NAME", help_heading = MACHINE)]
    pub(super) adapter: Option<String>,
    /// Draw this many times, for the timings (on a GPU after some frames that are not counted)
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = whole_number(1, 1_000_000), allow_negative_numbers = true, help_heading = MACHINE)]
    pub(super) frames: u32,
}

impl Arguments {
    /// Makes the changes that the command line asks for.
    pub(super) fn prepare(&self, scene: &mut Scene) {
        self.scene.prepare(scene);
        if let Some(technique) = self.technique {
            for material in scene.materials.iter_mut().filter(|material| !material.is_mist()) {
                material.relief.technique = technique;
            }
        }
    }
}

fn parse_rate(text: &str) -> Result<f64, String> {
    let rate = text.trim().parse().ok().filter(|rate: &f64| *rate > 0.0 && *rate <= FilmShape::MAX_RATE);
    rate.ok_or_else(|| format!("expected frames per second, above 0 and at most {}, as in 30", FilmShape::MAX_RATE))
}
