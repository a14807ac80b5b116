use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use clap::{Args, ValueEnum};
use relievo_lab::{
    MarchBackend, ResolvedTechnique, SweepOptions, TechniqueSpecError, TestMaterial, sweep, write_report,
};
use relievo_map::Limits;

use crate::backend::gpu;
use crate::console::{Console, WrongUsage};
use crate::memory::check_room;
use crate::outputs::check_folder;
use crate::scene_args::{MACHINE, OUTPUT, number, parse_size, whole_number};

/// Memory for a texel in bytes: its maps with mip levels and pyramids, and once more while they are judged (measured: 140).
const BYTES_PER_TEXEL: u64 = 160;

/// The page's size unless told otherwise.
const PAGE_KIB: u32 = 1400;

/// Measure techniques on materials against the truth, and write a report
///
/// Sweeps angles, depths, techniques with settings, backends and distances. Hits are judged ray by ray against an oracle in
/// double precision, pictures against supersampled displaced geometry. What is finished stays finished: the same command
/// again goes on where it was.
#[derive(Args)]
#[command(after_help = "Examples:
  relievo lab make:brick-wall -o report
  relievo lab textures/bricks102 corpus -o report --angles 0,60,82 --depths 10,50
  relievo lab spikes -o report --techniques exact,exact:cells,tutorials,bevy,relief:16..64 --quick
  relievo lab make:all corpus -o report --backend both

The folder gets report.html (all in one file), results.json, hits.csv, pictures.csv, summary.md and the pictures. A fetch is one look-up: a filtered sample, a gather of four corners, or a node of the pyramid.")]
pub(crate) struct Arguments {
    /// Folders of maps, height maps, make:NAME, solid, airy, noise or spikes (the lab's own); make:all and corpus: all of these
    #[arg(required = true, value_name = "MATERIAL")]
    materials: Vec<String>,
    /// The folder for the report; it is made if need be
    #[arg(long, short, value_name = "FOLDER", help_heading = OUTPUT)]
    output: PathBuf,
    /// Fewer rays, angles and pictures: a first look
    #[arg(long, conflicts_with = "full", help_heading = SWEEP)]
    quick: bool,
    /// More of everything: for an evening
    #[arg(long, help_heading = SWEEP)]
    full: bool,
    /// Degrees from the normal, 0 to 89.9, separated by commas
    #[arg(long, value_name = "A,B,…", value_delimiter = ',', value_parser = number(0.0, 89.9), allow_negative_numbers = true, help_heading = SWEEP)]
    angles: Vec<f32>,
    /// Full depths of the reliefs in texels, separated by commas
    #[arg(long, value_name = "A,B,…", value_delimiter = ',', value_parser = number(0.01, 1000.0), allow_negative_numbers = true, help_heading = SWEEP)]
    depths: Vec<f32>,
    /// Texels per pixel, powers of two separated by commas: the mip level that is marched
    #[arg(long, value_name = "A,B,…", value_delimiter = ',', value_parser = power_of_two, allow_negative_numbers = true, help_heading = SWEEP)]
    minify: Vec<u32>,
    /// Techniques, separated by commas, with settings as in occlusion:8..32 (layers) and relief:8..32+5 (and bisections); exact:cells
    /// goes without the pyramid; tutorials, bevy and bevy-relief are those rules
    #[arg(long, value_name = "A,B,…", value_delimiter = ',', value_parser = technique, help_heading = SWEEP)]
    techniques: Vec<ResolvedTechnique>,
    /// Rays per angle and depth
    #[arg(long, value_name = "N", value_parser = whole_number(1, 1 << 22), allow_negative_numbers = true, help_heading = SWEEP)]
    rays: Option<u32>,
    /// Texels per side of generated materials
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = whole_number(1, 8192), allow_negative_numbers = true, help_heading = SWEEP)]
    size: u32,
    /// Draw no pictures
    #[arg(long, help_heading = PICTURES)]
    no_pictures: bool,
    /// Size of the pictures in pixels
    #[arg(long, value_name = "WxH", value_parser = parse_size, allow_hyphen_values = true, help_heading = PICTURES)]
    picture_size: Option<(u32, u32)>,
    /// Degrees from the normal of the pictures, 0 to 85, separated by commas
    #[arg(long, value_name = "A,B,…", value_delimiter = ',', value_parser = number(0.0, 85.0), allow_negative_numbers = true, help_heading = PICTURES)]
    picture_angles: Vec<f32>,
    /// Texels per pixel of the pictures, powers of two separated by commas
    #[arg(long, value_name = "A,B,…", value_delimiter = ',', value_parser = power_of_two, allow_negative_numbers = true, help_heading = PICTURES)]
    picture_minify: Vec<u32>,
    /// Largest size of report.html, in KiB; pictures that do not fit stay beside it
    #[arg(long, value_name = "KIB", default_value_t = PAGE_KIB, value_parser = whole_number(1, 1 << 20), allow_negative_numbers = true, help_heading = OUTPUT)]
    page_size: u32,
    /// Backends that march: auto adds a GPU to the CPU if there is a real one
    #[arg(long, value_enum, default_value_t = Backends::Auto, help_heading = MACHINE)]
    backend: Backends,
    /// The GPU to measure, by a part of its name as `relievo devices` lists it
    #[arg(long, value_name = "NAME", help_heading = MACHINE)]
    adapter: Option<String>,
}

const SWEEP: &str = "What is swept";
const PICTURES: &str = "Pictures";

/// The backends that are measured.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Backends {
    Auto,
    Cpu,
    Gpu,
    Both,
}

pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<()> {
    let options = arguments.options();
    options.check()?;
    check_folder(&arguments.output)?;
    let materials = load(&arguments.materials, arguments.size, console)?;
    let mut benches = benches(arguments.backend, arguments.adapter.as_deref(), console)?;

    let bar = console.progress(1);
    let progress = |what: &str, done: usize, all: usize| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
        bar.set_message(what.to_owned());
    };
    let swept = sweep(&materials, &options, &mut benches, &arguments.output, Some(&progress))?;
    bar.set_message("report");
    write_report(&arguments.output, &swept.results, arguments.page_size as usize * 1024)?;
    bar.finish_and_clear();
    swept.notes.iter().for_each(|note| console.note(note));
    if swept.skipped > 0 {
        console.note(&format!("{} cases were done before, as the manifest in the folder says", swept.skipped));
    }
    console.note(&format!("wrote {}", arguments.output.join("report.html").display()));
    Ok(())
}

impl Arguments {
    fn options(&self) -> SweepOptions {
        let mut options = match (self.quick, self.full) {
            (true, _) => SweepOptions::quick(),
            (_, true) => SweepOptions::full(),
            _ => SweepOptions::default(),
        };
        let replace = |list: &mut Vec<f32>, asked: &[f32]| {
            if !asked.is_empty() {
                *list = asked.to_vec();
            }
        };
        replace(&mut options.angles, &self.angles);
        replace(&mut options.depths, &self.depths);
        if !self.minify.is_empty() {
            options.minifications.clone_from(&self.minify);
        }
        options.rays = self.rays.unwrap_or(options.rays);
        if let Some(pictures) = &mut options.pictures {
            replace(&mut pictures.angles, &self.picture_angles);
            if !self.depths.is_empty() && !pictures.depths.iter().all(|depth| self.depths.contains(depth)) {
                pictures.depths = vec![self.depths[self.depths.len() / 2]];
            }
            if !self.picture_minify.is_empty() {
                pictures.minifications.clone_from(&self.picture_minify);
            }
            pictures.size = self.picture_size.map_or(pictures.size, |(width, height)| [width, height]);
        }
        if !self.techniques.is_empty() {
            options.techniques.clone_from(&self.techniques);
            if let Some(pictures) = &mut options.pictures {
                // It draws what exact draws.
                let drawn = self.techniques.iter().filter(|technique| !technique.is_cell_by_cell());
                pictures.techniques = drawn.copied().collect();
            }
        }
        options.pictures = options.pictures.filter(|pictures| !self.no_pictures && !pictures.techniques.is_empty());
        options
    }
}

/// Opens the backends that are measured; notes where a GPU is not there.
pub(crate) fn benches(backends: Backends, adapter: Option<&str>, console: &Console) -> Result<Vec<MarchBackend>> {
    if backends == Backends::Cpu {
        if adapter.is_some() {
            let text = "--adapter names a GPU, but --backend cpu measures none; leave one of the two out";
            bail!(WrongUsage(text.to_owned()));
        }
        return Ok(vec![MarchBackend::Cpu]);
    }
    let opened = match (backends, adapter) {
        (Backends::Auto, None) => gpu::open_real().map_err(anyhow::Error::msg),
        _ => gpu::open(adapter),
    };
    let alone = backends == Backends::Gpu;
    match opened.and_then(|gpu| gpu::bench(&gpu)) {
        Ok(bench) if alone => Ok(vec![bench]),
        Ok(bench) => Ok(vec![MarchBackend::Cpu, bench]),
        Err(error) if alone || adapter.is_some() => Err(error),
        Err(error) => {
            console.note(&format!("measuring the CPU alone: {error}"));
            Ok(vec![MarchBackend::Cpu])
        }
    }
}

/// Loads materials by name and prints their notes.
pub(crate) fn load(materials: &[String], size: u32, console: &Console) -> Result<Vec<TestMaterial>> {
    let names = TestMaterial::expand(materials);
    let made = names.iter().filter(|name| !Path::new(name).exists()).count() as u64;
    check_room(
        made * u64::from(size).pow(2) * BYTES_PER_TEXEL,
        &format!("{made} generated materials of {size}×{size} texels"),
        "a smaller --size or fewer materials",
    )?;
    let mut materials = Vec::new();
    for name in &names {
        let material = TestMaterial::load(name, size, &Limits::default())?;
        material.notes.iter().for_each(|note| console.note(note));
        materials.push(material);
    }
    Ok(materials)
}

fn technique(text: &str) -> Result<ResolvedTechnique, String> {
    text.parse().map_err(|error| match error {
        TechniqueSpecError::Unknown { .. } => format!("{}; or exact:cells", TechniqueSpecError::expected()),
        error => error.to_string(),
    })
}

fn power_of_two(text: &str) -> Result<u32, String> {
    let number = text.trim().parse().ok().filter(|n: &u32| n.is_power_of_two() && *n <= 1024);
    number.ok_or_else(|| "expected a power of two from 1 to 1024".to_owned())
}
