//! `relievo render`.

mod animate;
mod arguments;
mod frame_files;
mod time_range;

use std::path::Path;
use std::time::Instant;

use anyhow::{Result, bail};
use relievo_map::write_picture;

use crate::aov::AovFile;
use crate::backend::{Device, DrawJob};
use crate::console::{Console, WrongUsage, milliseconds};
use crate::memory::{check_room, peak_bytes};
use crate::outputs::{check_outputs, extension, write_json};
use crate::stats::{Stats, march_costs};
pub(crate) use arguments::Arguments;
use arguments::BYTES_PER_PIXEL;

pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<()> {
    if let Some(range) = arguments.animate {
        return animate::run(arguments, range, console);
    }
    if extension(&arguments.output) != "png" {
        let name = arguments.output.display();
        bail!(WrongUsage(format!("{name}: a film shows a time; say which with --animate, as in --animate 0..4")));
    }
    let outputs: Vec<&Path> = std::iter::once(arguments.output.as_path())
        .chain(arguments.aovs.iter().map(AovFile::path))
        .chain(arguments.stats.as_deref())
        .collect();
    check_outputs(&outputs, arguments.scene.path())?;
    let device = Device::choose(arguments.backend, arguments.adapter.as_deref())?;

    let start = Instant::now();
    let mut scene = arguments.scene.load(console)?;
    arguments.prepare(&mut scene);
    let load_ms = milliseconds(start);
    for note in scene.notes_on_unseen_reliefs() {
        console.note(&note);
    }
    let (width, height) = (scene.image.width, scene.image.height);
    check_room(
        u64::from(width) * u64::from(height) * BYTES_PER_PIXEL,
        &format!("pictures of {width}×{height} pixels"),
        "a smaller --size",
    )?;

    let job = DrawJob {
        scene: &scene,
        name: arguments.scene.name(),
        threads: (arguments.scene.threads(), arguments.scene.thread_count()),
        frames: arguments.frames,
        timed: arguments.stats.is_some(),
        measured: arguments.stats.is_some() || !arguments.aovs.is_empty(),
    };
    let drawn = device.draw(&job, console)?;

    write_picture(&arguments.output, &drawn.pixels)?;
    let Some(aovs) = &drawn.aovs else { return Ok(()) };
    for aov in &arguments.aovs {
        aov.write(aovs)?;
    }
    if let Some(path) = &arguments.stats {
        let mut techniques: Vec<&str> =
            scene.objects.iter().map(|object| scene.materials[object.material].relief.technique.name()).collect();
        techniques.sort_unstable();
        techniques.dedup();
        let (hit_pixels, fetches, iterations) = march_costs(aovs);
        let stats = Stats {
            backend: drawn.backend,
            adapter: drawn.adapter,
            technique: techniques.join(", "),
            width,
            height,
            samples: scene.image.samples,
            frames: drawn.times.wall.len(),
            times: (&drawn.times).into(),
            hit_pixels,
            fetches,
            iterations,
            triangles: drawn.triangles,
            load_ms,
            build_ms: drawn.build_ms,
            peak_bytes: peak_bytes(),
        };
        write_json(path, &stats)?;
    }
    Ok(())
}
