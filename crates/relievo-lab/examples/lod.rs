//! Level of detail against the truth: every technique with and without, at a distance and on a grazing floor.
//!
//! ```sh
//! cargo run --release -p relievo-lab --example lod -- [DIR [NAME]]
//! ```
//!
//! prints the tables of docs/lod.md; with DIR, pictures go there too; with NAME (`wall-16`, `floor-1`, …) there is one table.

#![allow(clippy::print_stdout)]

#[path = "../tests/all/distant/mod.rs"]
mod distant;

use std::path::Path;

use distant::{
    Picture, Sampling, Subject, change, floor, frames, from_afar, image_error, subject, technique_frames, truth,
};
use relievo_map::{Grid, write_png8};
use relievo_march::Technique;

/// Number of frames, and number of truths.
const FRAMES: u32 = 4;
const TRUTHS: usize = 2;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let directory = std::env::args().nth(1);
    let wanted = std::env::args().nth(2);
    let subjects = [
        (subject("wall", "wall.toml", 512), &[4.0, 16.0, 64.0][..]),
        (subject("cobbles", "cobbles.toml", 512), &[4.0, 16.0, 64.0][..]),
        (floor(64), &[1.0, 4.0][..]),
    ];
    for (subject, distances) in &subjects {
        for &times in *distances {
            if wanted.as_ref().is_none_or(|wanted| *wanted == format!("{}-{times}", subject.name)) {
                table(subject, times, directory.as_deref())?;
            }
        }
    }
    Ok(())
}

fn table(subject: &Subject, times: f32, directory: Option<&str>) -> Result<(), Box<dyn std::error::Error>> {
    let frames = frames(&from_afar(&subject.scene, times), FRAMES);
    let truth = truth(&frames[..TRUTHS], subject.grid);
    let save = |name: &str, picture: &Picture| match directory {
        Some(directory) => {
            let file = format!("{}-{times}-{name}.png", subject.name);
            write_png8(&Path::new(directory).join(file), &enlarged(picture))
        }
        None => Ok(()),
    };
    save("truth", &truth[0])?;
    println!(
        "\n{} at {times}×, {}×{} pixels; the truth changes by {:.2}/255 from frame to frame\n",
        subject.name,
        truth[0].width(),
        truth[0].height(),
        change(&truth)
    );
    println!("| technique | sampling | FLIP | PSNR | change | fetches |");
    println!("|---|---|---|---|---|---|");
    for technique in Technique::ALL {
        for (sampling, name) in
            [(Sampling::Linear, "linear"), (Sampling::Trilinear, "trilinear"), (Sampling::Lod, "lod")]
        {
            let drawn = technique_frames(&frames, technique, sampling);
            let error = image_error(&truth, &drawn);
            println!(
                "| {} | {} | {:.4} | {:.2} | {:.2} | {:.1} |",
                technique.name(),
                name,
                error.flip,
                error.psnr,
                error.change,
                error.fetches
            );
            save(&format!("{}-{}", technique.name(), name), &drawn.0[0])?;
        }
    }
    Ok(())
}

/// Enlarges a small picture, each pixel to a square.
fn enlarged(picture: &Picture) -> Grid<[f32; 3]> {
    let times = (320 / picture.width()).max(1);
    Grid::from_fn(picture.width() * times, picture.height() * times, |x, y| {
        picture.get(x / times, y / times).map(|c| f32::from(c) / 255.0)
    })
}
