//! `relievo render --animate`: the frames of a scene over time.

use std::io;
use std::path::Path;
use std::sync::Mutex;
use std::sync::PoisonError;

use anyhow::{Error, Result, bail};
use indicatif::ProgressBar;
use relievo_journal::{Input, Journal, Work};
use relievo_map::{FilmFormat, FilmShape, Grid, write_film, write_picture};
use relievo_scene::{Scene, SceneTime, SurfaceTechnique};
use serde::Serialize;

use super::arguments::{Arguments, BYTES_PER_PIXEL};
use super::frame_files::FrameFiles;
use super::time_range::TimeRange;
use crate::backend::{Device, Film, FilmJob};
use crate::console::{Console, WrongUsage};
use crate::memory::check_room;
use crate::outputs::{check_outputs, make_folder};
use crate::scene_args::refused;

/// The kind of the journal's entries.
const KIND: &str = "frames";

/// The most frames of an animation.
const MAX_FRAMES: u64 = 1_000_000;

/// What the pixels of a frame depend on, beside the files that are read.
#[derive(Serialize)]
struct FrameWork<'a> {
    arguments: Vec<String>,
    technique: Option<&'a str>,
    backend: &'a str,
    seconds: f64,
}

pub(super) fn run(arguments: &Arguments, range: TimeRange, console: &Console) -> Result<()> {
    let files = FrameFiles::parse(&arguments.output)
        .map_err(|fault| WrongUsage(format!("{}: {fault}", arguments.output.display())))?;
    let count = range.start.frames_before(range.end, arguments.fps);
    if count == 0 || count > MAX_FRAMES {
        bail!(WrongUsage(format!(
            "--animate with --fps {} has {count} frames; 1 to {MAX_FRAMES} are drawn",
            arguments.fps
        )));
    }
    let times: Vec<SceneTime> = (0..count as u32).map(|k| range.start.after_frames(k, arguments.fps)).collect();
    if let FrameFiles::Film(_, path) = &files {
        check_outputs(&[path.as_path()], arguments.scene.path())?;
    }
    let device = Device::choose(arguments.backend, arguments.adapter.as_deref())?;
    let film = arguments.scene.open()?;
    let prepare = |scene: &mut Scene| arguments.prepare(scene);
    let mut first = film.at(times[0]).map_err(refused)?;
    prepare(&mut first);
    for note in first.notes.iter().chain(&first.notes_on_unseen_reliefs()) {
        console.note(note);
    }
    if !film.is_animated() {
        console.note("nothing in the scene changes with time: all frames are the same");
    }
    let (width, height) = (first.image.width, first.image.height);
    let threads = arguments.scene.thread_count().min(times.len());
    check_room(
        u64::from(width) * u64::from(height) * BYTES_PER_PIXEL * threads as u64,
        &format!("{threads} pictures of {width}×{height} pixels at a time"),
        "a smaller --size, or fewer --threads",
    )?;
    let job = FilmJob {
        film: &film,
        first: &first,
        prepare: &prepare,
        times: &times,
        name: arguments.scene.name(),
        threads: arguments.scene.thread_count(),
    };
    match files {
        FrameFiles::Film(format, ref path) => {
            let shape = FilmShape { size: [width, height], frames: times.len() as u32, per_second: arguments.fps };
            draw_film(&mut device.film(&job, console)?, format, path, shape, console)
        }
        FrameFiles::Numbered { .. } => draw_frames(arguments, &files, &job, &device, console),
    }
}

/// Draws all frames that the journal of their folder does not know as finished.
fn draw_frames(
    arguments: &Arguments,
    files: &FrameFiles,
    job: &FilmJob<'_>,
    device: &Device,
    console: &Console,
) -> Result<()> {
    let folder = files.folder();
    make_folder(&folder)?;
    let path = files.path(0);
    check_outputs(&[&path], arguments.scene.path())?;
    let mut journal = Journal::open(&folder, KIND)?;
    if let Some(note) = journal.note() {
        console.note(&note);
    }
    let mut inputs = Vec::new();
    for path in job.film.files() {
        inputs.push(Input::of_file(&path)?);
    }
    let work = |number: usize| -> Result<Work> {
        let work = Work::new(
            env!("CARGO_PKG_VERSION"),
            &FrameWork {
                arguments: arguments.scene.words(),
                technique: arguments.technique.map(SurfaceTechnique::name),
                backend: &device.name(),
                seconds: job.times[number].seconds(),
            },
        )?;
        Ok(inputs.iter().fold(work, |work, input| work.reading(input.clone())))
    };
    let mut left = Vec::new();
    for number in 0..job.times.len() {
        let name = entry_name(files, number);
        if journal.finished(&name, &work(number)?).is_none() {
            journal.begin(&name)?;
            left.push(number);
        }
    }
    let skipped = job.times.len() - left.len();
    if skipped > 0 {
        console.note(&format!("{skipped} frames were drawn before, as {} says", journal.path().display()));
    }
    if left.is_empty() {
        return Ok(());
    }
    let bar = progress(console, left.len());
    let journal = Mutex::new(journal);
    let emit = |number: usize, pixels: Grid<[u8; 3]>| -> Result<()> {
        write_picture(&files.path(number as u32), &pixels)?;
        let name = entry_name(files, number);
        let mut journal = journal.lock().unwrap_or_else(PoisonError::into_inner);
        journal.finish(&name, work(number)?, vec![name.clone()])?;
        bar.inc(1);
        Ok(())
    };
    let drawn = device.film(job, console)?.draw(&left, &emit);
    bar.finish_and_clear();
    drawn
}

fn entry_name(files: &FrameFiles, number: usize) -> String {
    let path = files.path(number as u32);
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Draws all frames into one file, some at a time.
fn draw_film(film: &mut Film<'_>, format: FilmFormat, path: &Path, shape: FilmShape, console: &Console) -> Result<()> {
    let bar = progress(console, shape.frames as usize);
    let (mut waiting, mut begun) = (std::collections::VecDeque::new(), 0);
    let mut failure: Option<Error> = None;
    let mut next = || {
        if waiting.is_empty() {
            let batch: Vec<usize> = (begun..shape.frames as usize).take(film.frames_at_a_time()).collect();
            begun += batch.len();
            let drawn = Mutex::new(Vec::new());
            let emit = |number: usize, pixels: Grid<[u8; 3]>| {
                drawn.lock().unwrap_or_else(PoisonError::into_inner).push((number, pixels));
                Ok(())
            };
            if let Err(error) = film.draw(&batch, &emit) {
                failure = Some(error);
            }
            let mut drawn = drawn.into_inner().unwrap_or_else(PoisonError::into_inner);
            drawn.sort_by_key(|(number, _)| *number);
            waiting.extend(drawn.into_iter().map(|(_, pixels)| pixels));
        }
        bar.inc(1);
        match waiting.pop_front() {
            Some(pixels) if failure.is_none() => Ok(pixels),
            _ => Err(io::Error::other("a frame could not be drawn")),
        }
    };
    let written = write_film(path, format, shape, &mut next);
    bar.finish_and_clear();
    // The frame's own error says more.
    match failure {
        Some(error) => Err(error),
        None => Ok(written?),
    }
}

fn progress(console: &Console, frames: usize) -> ProgressBar {
    let bar = console.progress(frames as u64);
    bar.set_message("drawing frames");
    bar
}
