use std::time::Instant;

use relievo_cpu::{Frame, Precision, RenderOptions, Renderer};
use relievo_map::Grid;
use relievo_march::Technique;
use relievo_scene::{Scene, SurfaceTechnique};

use super::comparison::{Comparison, ComparisonEntry};
use super::options::{CompareError, CompareOptions};
use crate::metric::{DEFAULT_PIXELS_PER_DEGREE, PixelHits, flip, pixel_difference};
use crate::technique::TechniqueSpec;

/// Largest number of triangles of the truth unless the caller asks for a grid: about 3 seconds of building.
const TRUTH_TRIANGLES: f64 = 4.2e6;

/// Draws a scene with every technique in its reliefs, and judges each.
///
/// There are two truths: the picture of the same scene with displaced geometry (for FLIP and PSNR), and the first
/// intersection by the f64 oracle (for hits). Every technique is lit at its hit (`write_depth`), so that pictures differ
/// by the march alone. A relief shows only where its polygons do; where displaced geometry reaches beyond them in the
/// picture, the truth shows the background, and no technique is judged.
///
/// # Errors
/// If there is no relief in the scene, a technique cannot be drawn (`exact:cells`), or rendering fails.
pub fn compare(scene: &Scene, options: &CompareOptions<'_>) -> Result<Comparison, CompareError> {
    let uses_relief = |object: &relievo_scene::Object| scene.materials[object.material].maps.height.is_some();
    if !scene.objects.iter().any(uses_relief) {
        return Err(CompareError::NoRelief);
    }
    if options.techniques.iter().any(|technique| technique.cell_by_cell) {
        return Err(CompareError::CellByCell);
    }
    let renders = ComparisonRenders { scene, options, pictures: options.techniques.len() + 3 };
    let marched = TechniqueSpec::marched;

    let polygons = renders.draw("polygons", 0, marched(Technique::None), Precision::Single)?.frame;
    let oracle = renders.draw("oracle", 1, marched(Technique::Exact), Precision::Oracle)?.frame;
    let truth = renders.draw_truth(2)?;
    let truth_picture = through_polygons(&truth.frame.pixels, &polygons);

    let mut entries = Vec::new();
    for (i, &technique) in options.techniques.iter().enumerate() {
        let render = renders.draw(&technique.to_string(), i + 3, technique, Precision::Single)?;
        let picture = if technique.technique == SurfaceTechnique::Displacement {
            through_polygons(&render.frame.pixels, &polygons)
        } else {
            render.frame.pixels.clone()
        };
        entries.push(entry(scene, technique, picture, render, &truth_picture, &oracle)?);
    }
    Ok(Comparison {
        truth: truth_picture,
        truth_grids: renders.truth_grids(),
        truth_triangles: truth.triangles,
        truth_frame_ms: truth.frame_ms,
        truth_build_ms: truth.build_ms,
        entries,
    })
}

/// A rendered frame with its cost.
struct TimedRender {
    frame: Frame,
    frame_ms: f64,
    build_ms: f64,
    triangles: usize,
}

/// The renders of one comparison.
struct ComparisonRenders<'a> {
    scene: &'a Scene,
    options: &'a CompareOptions<'a>,
    pictures: usize,
}

impl ComparisonRenders<'_> {
    fn draw(
        &self,
        name: &str,
        done: usize,
        technique: TechniqueSpec,
        precision: Precision,
    ) -> Result<TimedRender, CompareError> {
        let mut scene = self.scene.clone();
        for material in scene.materials.iter_mut().filter(|material| material.maps.height.is_some()) {
            technique.apply(&mut material.relief);
            material.relief.write_depth = Some(true);
        }
        self.draw_scene(name, done, &scene, precision)
    }

    fn draw_truth(&self, done: usize) -> Result<TimedRender, CompareError> {
        let mut scene = self.scene.clone();
        let mut grids = self.truth_grids().into_iter();
        for material in scene.materials.iter_mut().filter(|material| material.maps.height.is_some()) {
            material.relief.technique = SurfaceTechnique::Displacement;
            material.relief.grid = grids.next().unwrap_or(material.relief.grid);
        }
        self.draw_scene("displaced truth", done, &scene, Precision::Single)
    }

    fn draw_scene(
        &self,
        name: &str,
        done: usize,
        scene: &Scene,
        precision: Precision,
    ) -> Result<TimedRender, CompareError> {
        if let Some(progress) = self.options.progress {
            progress(name, done, self.pictures);
        }
        let start = Instant::now();
        let renderer = Renderer::new(scene)?;
        let build_ms = start.elapsed().as_secs_f64() * 1e3;
        let start = Instant::now();
        let frame = renderer.render(&RenderOptions { threads: self.options.threads, precision, progress: None })?;
        let frame_ms = start.elapsed().as_secs_f64() * 1e3;
        Ok(TimedRender { frame, frame_ms, build_ms, triangles: renderer.triangles() })
    }

    /// Vertices per side for each material with a relief: two per texel, so that one stands on every texel's centre; fewer
    /// where that would be too many triangles.
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

/// Replaces the pixels of displaced geometry beyond the polygons by the background.
fn through_polygons(picture: &Grid<[u8; 3]>, polygons: &Frame) -> Grid<[u8; 3]> {
    Grid::from_fn(picture.width(), picture.height(), |x, y| {
        if *polygons.aovs.hit.get(x, y) > 0.0 { *picture.get(x, y) } else { *polygons.pixels.get(x, y) }
    })
}

fn entry(
    scene: &Scene,
    technique: TechniqueSpec,
    picture: Grid<[u8; 3]>,
    render: TimedRender,
    truth: &Grid<[u8; 3]>,
    oracle: &Frame,
) -> Result<ComparisonEntry, CompareError> {
    let flip = flip(truth, &picture, DEFAULT_PIXELS_PER_DEGREE)?;
    let psnr = pixel_difference(truth, &picture, 0).map_or(0.0, |difference| difference.psnr);
    let hits = PixelHits::new(scene, &render.frame, oracle);
    let aovs = render.frame.aovs;
    Ok(ComparisonEntry {
        technique,
        flip,
        psnr,
        hits: hits.errors,
        fetches: hits.over_relief(&aovs.fetches),
        iterations: hits.over_relief(&aovs.iterations),
        fetch_map: aovs.fetches,
        hit_error_map: hits.error_map,
        picture,
        frame_ms: render.frame_ms,
        build_ms: render.build_ms,
        triangles: render.triangles,
    })
}
