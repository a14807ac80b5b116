//! Pictures of a material against the truth.

use std::path::Path;

use relievo_cpu::{Precision, RenderOptions, Renderer};
use relievo_map::{Grid, write_picture};
use relievo_march::Technique;
use relievo_scene::{Filter, Scene};

use super::figures::PictureRow;
use super::file_name::file_name;
use super::options::PictureOptions;
use crate::colors::heat;
use crate::error::LabError;
use crate::material::MaterialView;
use crate::metric::{DEFAULT_PIXELS_PER_DEGREE, HIT_ERROR_WHITE, flip, pixel_difference};
use crate::technique::{ResolvedTechnique, TechniqueSpec};

/// Largest number of samples per pixel of the truth at a distance; FLIP shows no difference beyond it.
const MAX_TRUTH_SAMPLES: u32 = 64;

/// Draws the truth and every technique, judges them, and writes the pictures to `folder` (which exists) with names that
/// begin with `prefix`.
pub(super) fn judge_pictures(
    view: &MaterialView<'_>,
    options: &PictureOptions,
    folder: &Path,
    prefix: &str,
) -> Result<Vec<PictureRow>, LabError> {
    if view.minification == 1 { near(view, options, folder, prefix) } else { far(view, options, folder, prefix) }
}

/// Compares with displaced geometry at the same number of samples per pixel: pictures differ by the march alone.
fn near(
    view: &MaterialView<'_>,
    options: &PictureOptions,
    folder: &Path,
    prefix: &str,
) -> Result<Vec<PictureRow>, LabError> {
    // A picture does not depend on the pyramid.
    let spec = |technique: &ResolvedTechnique| TechniqueSpec { cell_by_cell: false, ..technique.spec() };
    let comparison = view.compare(options.techniques.iter().map(spec).collect(), options.samples)?;
    let truth = format!("{prefix}truth.png");
    write_picture(&folder.join(&truth), &comparison.truth)?;
    let mut rows = Vec::new();
    for (technique, entry) in options.techniques.iter().zip(&comparison.entries) {
        let name = file_name(&technique.to_string());
        let picture = format!("{prefix}{name}.png");
        write_picture(&folder.join(&picture), &entry.picture)?;
        let hits = format!("{prefix}{name}-hits.png");
        write_picture(&folder.join(&hits), &heat(&entry.hit_error_map, HIT_ERROR_WHITE))?;
        rows.push(PictureRow {
            technique: technique.to_string(),
            flip: entry.flip.mean,
            psnr_db: entry.psnr.is_finite().then_some(entry.psnr),
            picture,
            hits: Some(hits),
            truth: truth.clone(),
            truth_is: "displaced geometry".to_owned(),
            samples: options.samples,
            truth_samples: options.samples,
            ..row(view)
        });
    }
    Ok(rows)
}

/// Compares at a distance, one sample per pixel as in a game, with and without `lod`, with the oracle's hits at many
/// samples: a grid fine enough for displacement would have more triangles than memory holds.
fn far(
    view: &MaterialView<'_>,
    options: &PictureOptions,
    folder: &Path,
    prefix: &str,
) -> Result<Vec<PictureRow>, LabError> {
    let truth_samples = (4 * view.minification * view.minification).min(MAX_TRUTH_SAMPLES);
    let mut scene = view.scene(truth_samples)?;
    for material in &mut scene.materials {
        // Many samples need no filter, and a filter would blur them.
        material.filter = Filter::Linear;
        TechniqueSpec::marched(Technique::Exact).apply(&mut material.relief);
        material.relief.write_depth = Some(true);
    }
    let truth_picture = draw(&scene, Precision::Oracle)?;
    let truth = format!("{prefix}truth.png");
    write_picture(&folder.join(&truth), &truth_picture)?;
    let mut rows = Vec::new();
    for technique in &options.techniques {
        for lod in [false, true] {
            let mut scene = view.scene(1)?;
            for material in &mut scene.materials {
                technique.spec().apply(&mut material.relief);
                (material.relief.write_depth, material.relief.lod) = (Some(true), lod);
            }
            let drawn = draw(&scene, Precision::Single)?;
            let suffix = if lod { "-lod" } else { "" };
            let picture = format!("{prefix}{}{suffix}.png", file_name(&technique.to_string()));
            write_picture(&folder.join(&picture), &drawn)?;
            let psnr = pixel_difference(&truth_picture, &drawn, 0).map_or(0.0, |difference| difference.psnr);
            rows.push(PictureRow {
                technique: technique.to_string(),
                lod,
                flip: flip(&truth_picture, &drawn, DEFAULT_PIXELS_PER_DEGREE)?.mean,
                psnr_db: psnr.is_finite().then_some(psnr),
                picture,
                hits: None,
                truth: truth.clone(),
                truth_is: "the oracle's hits".to_owned(),
                samples: 1,
                truth_samples,
                ..row(view)
            });
        }
    }
    Ok(rows)
}

fn row(view: &MaterialView<'_>) -> PictureRow {
    PictureRow {
        material: view.material.name.clone(),
        depth_texels: view.depth,
        minification: view.minification,
        angle: view.angle,
        ..PictureRow::default()
    }
}

fn draw(scene: &Scene, precision: Precision) -> Result<Grid<[u8; 3]>, LabError> {
    Ok(Renderer::new(scene)?.render(&RenderOptions { precision, ..RenderOptions::default() })?.pixels)
}
