//! Techniques side by side, each judged against the truth: really displaced geometry for the picture, the f64 oracle for
//! every single hit.

use std::time::Instant;

use relievo_cpu::{Frame, Precision, RenderError, RenderOptions, Renderer};
use relievo_map::Grid;
use relievo_march::Technique;
use relievo_scene::{Scene, SurfaceTechnique};
use serde::Serialize;
use thiserror::Error;

use crate::{Contender, DEFAULT_PIXELS_PER_DEGREE, Flip, FlipError, Percentiles, flip, pixel_difference};

/// Triangles the truth may have unless the caller asks for a grid: about 3 seconds of building.
const TRUTH_TRIANGLES: f64 = 4.2e6;

/// A hit this far from the truth is wrong, in texels.
const WRONG_TEXELS: f32 = 1.0;

/// Told what is drawn next, how many pictures are done, and how many there are.
pub type CompareProgress<'a> = dyn Fn(&str, usize, usize) + Sync + 'a;

/// What to compare, and how.
#[derive(Clone)]
pub struct CompareOptions<'a> {
    /// In the order of the sheet.
    pub contenders: Vec<Contender>,
    /// Vertices per side of the displaced truth; `None`: two per texel if that is not too many.
    pub grid: Option<u32>,
    /// Threads to use; `None`: all cores.
    pub threads: Option<usize>,
    /// Called before each picture.
    pub progress: Option<&'a CompareProgress<'a>>,
}

impl Default for CompareOptions<'_> {
    fn default() -> Self {
        Self { contenders: Contender::all(), grid: None, threads: None, progress: None }
    }
}

/// Why scenes could not be compared.
#[derive(Debug, Error)]
pub enum CompareError {
    /// Nothing in the scene has a height map.
    #[error(
        "no object has a material with a height map, so there is no relief to compare; give a material height = \"FILE\", \
         or from = a folder with a height map"
    )]
    NoRelief,
    /// A picture could not be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// Pictures could not be judged.
    #[error(transparent)]
    Flip(#[from] FlipError),
}

/// How far the hits lie from the oracle's, in texels of the height map, over the pixels where both hit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HitErrors {
    /// Distance in uv, texels.
    pub texels: Percentiles,
    /// Fraction of the relief's pixels that are off by more than a texel, or hit where the oracle misses or the reverse.
    pub wrong: f64,
    /// Fraction of the relief's pixels where only one of the two hits.
    pub only_one_hits: f64,
}

/// One technique, judged.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Which.
    pub contender: Contender,
    /// Its picture.
    pub picture: Grid<[u8; 3]>,
    /// Against the picture of displaced geometry.
    pub flip: Flip,
    /// Against the same, dB; infinite where equal.
    pub psnr: f64,
    /// Against the oracle.
    pub hits: HitErrors,
    /// Distance of each pixel's hit from the oracle's, texels; NaN where only one of the two hits, 0 where neither does.
    pub hit_error_map: Grid<f32>,
    /// Height look-ups of each pixel.
    pub fetch_map: Grid<f32>,
    /// Height look-ups over the relief's pixels.
    pub fetches: Percentiles,
    /// Loop turns over the relief's pixels.
    pub iterations: Percentiles,
    /// Drawing, milliseconds.
    pub frame_ms: f64,
    /// Making the scene ready (mip levels, displaced grid, tree), milliseconds.
    pub build_ms: f64,
    /// In the scene.
    pub triangles: usize,
}

/// Techniques side by side.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The picture of displaced geometry, as seen through the polygons (see [`compare`]).
    pub truth: Grid<[u8; 3]>,
    /// Vertices per side of the truth's grids, one per material with a relief.
    pub truth_grids: Vec<u32>,
    /// Triangles of the truth.
    pub truth_triangles: usize,
    /// Drawing the truth, milliseconds.
    pub truth_frame_ms: f64,
    /// Building the truth, milliseconds.
    pub truth_build_ms: f64,
    /// In the order asked for.
    pub entries: Vec<Entry>,
}

/// Draws a scene with every contender in place of its reliefs' technique, and judges each.
///
/// Two truths: the picture of the same scene with really displaced geometry (for FLIP and PSNR), and the first
/// intersection by the f64 oracle (for hits). Every contender is lit at its hit (`write_depth`), so that pictures differ
/// by the march alone. A relief shows only where its polygons do; where displaced geometry reaches beyond them in the
/// picture, the truth shows what lies behind, and nobody is judged there.
///
/// # Errors
/// If there is no relief in the scene, or it cannot be drawn.
pub fn compare(scene: &Scene, options: &CompareOptions<'_>) -> Result<Comparison, CompareError> {
    let uses_relief = |object: &relievo_scene::Object| scene.materials[object.material].maps.height.is_some();
    if !scene.objects.iter().any(uses_relief) {
        return Err(CompareError::NoRelief);
    }
    let stage = Stage { scene, options, pictures: options.contenders.len() + 3 };
    let flat = |technique| Contender::of(SurfaceTechnique::Marched(technique));

    let polygons = stage.draw("polygons", 0, flat(Technique::None), Precision::Single)?.frame;
    let oracle = stage.draw("oracle", 1, flat(Technique::Exact), Precision::Oracle)?.frame;
    let truth = stage.draw_truth(2)?;
    let truth_picture = through_polygons(&truth.frame.pixels, &polygons);

    let mut entries = Vec::new();
    for (i, &contender) in options.contenders.iter().enumerate() {
        let drawn = stage.draw(&contender.to_string(), i + 3, contender, Precision::Single)?;
        let picture = if contender.technique == SurfaceTechnique::Displacement {
            through_polygons(&drawn.frame.pixels, &polygons)
        } else {
            drawn.frame.pixels.clone()
        };
        entries.push(judge(scene, contender, picture, &drawn, &truth_picture, &oracle)?);
    }
    Ok(Comparison {
        truth: truth_picture,
        truth_grids: stage.truth_grids(),
        truth_triangles: truth.triangles,
        truth_frame_ms: truth.frame_ms,
        truth_build_ms: truth.build_ms,
        entries,
    })
}

/// A picture with what it took.
struct Drawn {
    frame: Frame,
    frame_ms: f64,
    build_ms: f64,
    triangles: usize,
}

struct Stage<'a> {
    scene: &'a Scene,
    options: &'a CompareOptions<'a>,
    pictures: usize,
}

impl Stage<'_> {
    fn draw(&self, what: &str, done: usize, contender: Contender, precision: Precision) -> Result<Drawn, CompareError> {
        let mut scene = self.scene.clone();
        for material in scene.materials.iter_mut().filter(|material| material.maps.height.is_some()) {
            contender.apply(&mut material.relief);
            material.relief.write_depth = Some(true);
        }
        self.draw_scene(what, done, &scene, precision)
    }

    fn draw_truth(&self, done: usize) -> Result<Drawn, CompareError> {
        let mut scene = self.scene.clone();
        let mut grids = self.truth_grids().into_iter();
        for material in scene.materials.iter_mut().filter(|material| material.maps.height.is_some()) {
            material.relief.technique = SurfaceTechnique::Displacement;
            material.relief.grid = grids.next().unwrap_or(material.relief.grid);
        }
        self.draw_scene("displaced truth", done, &scene, Precision::Single)
    }

    fn draw_scene(&self, what: &str, done: usize, scene: &Scene, precision: Precision) -> Result<Drawn, CompareError> {
        if let Some(progress) = self.options.progress {
            progress(what, done, self.pictures);
        }
        let start = Instant::now();
        let renderer = Renderer::new(scene)?;
        let build_ms = start.elapsed().as_secs_f64() * 1e3;
        let start = Instant::now();
        let frame = renderer.render(&RenderOptions { threads: self.options.threads, precision, progress: None })?;
        let frame_ms = start.elapsed().as_secs_f64() * 1e3;
        Ok(Drawn { frame, frame_ms, build_ms, triangles: renderer.triangles() })
    }

    /// For each material with a relief: two vertices per texel, so that one stands on every texel's centre; fewer where
    /// that would be too many triangles.
    fn truth_grids(&self) -> Vec<u32> {
        let scene = self.scene;
        let reliefs =
            scene.materials.iter().enumerate().filter_map(|(i, material)| Some((i, material.maps.height.as_ref()?)));
        let share = TRUTH_TRIANGLES / reliefs.clone().count().max(1) as f64;
        reliefs
            .map(|(i, height)| {
                let texels = scene
                    .objects
                    .iter()
                    .filter(|object| object.material == i)
                    .map(|object| {
                        let (w, h) = (height.grid().width() as f32, height.grid().height() as f32);
                        (object.uv_repeat.x * w).max(object.uv_repeat.y * h)
                    })
                    .fold(1.0, f32::max);
                // A quad cut into m² cells has 2·m² triangles.
                let most = (share / 2.0).sqrt();
                let cells = [2.0, 1.0].map(|per_texel| f64::from(texels) * per_texel).into_iter().find(|&n| n <= most);
                self.options.grid.unwrap_or(cells.unwrap_or(most) as u32 + 1)
            })
            .collect()
    }
}

/// A picture of displaced geometry with what reaches beyond the polygons taken away.
fn through_polygons(picture: &Grid<[u8; 3]>, polygons: &Frame) -> Grid<[u8; 3]> {
    Grid::from_fn(picture.width(), picture.height(), |x, y| {
        if *polygons.aovs.hit.get(x, y) > 0.0 { *picture.get(x, y) } else { *polygons.pixels.get(x, y) }
    })
}

fn judge(
    scene: &Scene,
    contender: Contender,
    picture: Grid<[u8; 3]>,
    drawn: &Drawn,
    truth: &Grid<[u8; 3]>,
    oracle: &Frame,
) -> Result<Entry, CompareError> {
    let flip = flip(truth, &picture, DEFAULT_PIXELS_PER_DEGREE)?;
    let psnr = pixel_difference(truth, &picture, 0).map_or(0.0, |difference| difference.psnr);
    // The size of the height map that a pixel shows; `None` where it shows no relief.
    let size = |frame: &Frame, x, y| {
        let material = (*frame.aovs.material.get(x, y))?;
        let height = scene.materials[material as usize].maps.height.as_ref()?;
        Some([height.grid().width() as f32, height.grid().height() as f32])
    };
    let (ours, theirs) = (&drawn.frame, oracle);
    let hit_error_map =
        Grid::from_fn(picture.width(), picture.height(), |x, y| match (size(ours, x, y), size(theirs, x, y)) {
            (None, None) => 0.0,
            (Some(_), Some([w, h])) => {
                let ([u, v], [tu, tv]) = (*ours.aovs.uv.get(x, y), *theirs.aovs.uv.get(x, y));
                ((u - tu) * w).hypot((v - tv) * h)
            }
            _ => f32::NAN,
        });
    let shows_relief = |x: u32, y: u32| size(ours, x, y).is_some() || size(theirs, x, y).is_some();
    let pixels = || (0..picture.height()).flat_map(|y| (0..picture.width()).map(move |x| (x, y)));
    let judged: Vec<(u32, u32)> = pixels().filter(|&(x, y)| shows_relief(x, y)).collect();
    let errors = || judged.iter().map(|&(x, y)| *hit_error_map.get(x, y));
    let fraction = |count: usize| if judged.is_empty() { 0.0 } else { count as f64 / judged.len() as f64 };
    let over = |map: &Grid<f32>| Percentiles::of(judged.iter().map(|&(x, y)| *map.get(x, y)));
    let hits = HitErrors {
        texels: Percentiles::of(errors().filter(|error| !error.is_nan())),
        wrong: fraction(errors().filter(|&error| !(error <= WRONG_TEXELS)).count()),
        only_one_hits: fraction(errors().filter(|error| error.is_nan()).count()),
    };
    Ok(Entry {
        contender,
        flip,
        psnr,
        hits,
        fetches: over(&drawn.frame.aovs.fetches),
        iterations: over(&drawn.frame.aovs.iterations),
        fetch_map: drawn.frame.aovs.fetches.clone(),
        hit_error_map,
        picture,
        frame_ms: drawn.frame_ms,
        build_ms: drawn.build_ms,
        triangles: drawn.triangles,
    })
}
