use std::time::Instant;

use relievo_cpu::{Frame, RenderOptions, Renderer, VisibleOptions, VisiblePoint};
use relievo_map::Grid;
use relievo_march::Technique;
use relievo_scene::{Scene, SurfaceTechnique};

use super::comparison::{Comparison, ComparisonEntry};
use super::options::{CompareError, CompareOptions};
use super::truth::{self, HITS_PER_TEXEL, PICTURE_PER_TEXEL};
use crate::metric::{DEFAULT_PIXELS_PER_DEGREE, JudgedPixels, PixelHits, TruePixels, flip, pixel_difference};
use crate::technique::TechniqueSpec;

/// Draws a scene with every technique in its reliefs, and judges each.
///
/// The truth is the same scene with displaced geometry, finer than the maps: its picture (for FLIP and PSNR), and the points
/// of the surface that its pixels show (for hits). Every technique is lit at its hit (`write_depth`), so that pictures differ
/// by the march alone. A relief shows only where its polygons do; where displaced geometry reaches beyond them in the
/// picture, the truth shows the background, and no technique is judged. Not so reliefs that the exact march draws with an
/// outline of their own (`edge = "silhouette"`): those are judged wherever the truth or the technique shows them.
///
/// # Errors
/// If there is no relief in the scene, or mist, a technique cannot be drawn (`exact:cells`), or rendering fails.
pub fn compare(scene: &Scene, options: &CompareOptions<'_>) -> Result<Comparison, CompareError> {
    let uses_relief = |object: &relievo_scene::Object| scene.materials[object.material].maps.height.is_some();
    if !scene.objects.iter().any(uses_relief) {
        return Err(CompareError::NoRelief);
    }
    let mut used = scene.objects.iter().map(|object| &scene.materials[object.material]);
    if let Some(mist) = used.find(|material| material.is_mist()) {
        return Err(CompareError::Mist { name: mist.name.clone() });
    }
    if options.techniques.iter().any(|technique| technique.cell_by_cell) {
        return Err(CompareError::CellByCell);
    }
    let renders = ComparisonRenders { scene, options, pictures: options.techniques.len() + 3 };

    let polygons = renders.draw("polygons", 0, TechniqueSpec::marched(Technique::None))?;
    let judged = JudgedPixels::new(scene, polygons.points.map(Option::is_some));
    let polygons = polygons.frame;
    let truth = renders.draw_scene("displaced truth", 1, &truth::displaced(scene, PICTURE_PER_TEXEL, options.grid))?;
    let truth_picture = where_judged(&truth, &judged, &polygons);
    let truth_grids = truth::grids(scene, &truth.renderer, options.grid);
    renders.tell("true hits", 2);
    let surface = Renderer::new(&truth::displaced(scene, HITS_PER_TEXEL, None))?;
    let mut true_pixels = TruePixels::new(scene, &surface, options.threads, judged)?;

    let mut entries = Vec::new();
    for (i, &technique) in options.techniques.iter().enumerate() {
        let render = renders.draw(&technique.to_string(), i + 3, technique)?;
        let picture = if technique.technique == SurfaceTechnique::Displacement {
            where_judged(&render, true_pixels.judged(), &polygons)
        } else {
            render.frame.pixels.clone()
        };
        entries.push(entry(technique, picture, render, &truth_picture, &mut true_pixels)?);
    }
    Ok(Comparison {
        truth: truth_picture,
        truth_grids: truth_grids.iter().map(|grid| grid.vertices).collect(),
        truth_per_texel: truth_grids.iter().map(|grid| grid.per_texel).collect(),
        truth_notes: truth::notes(scene, &truth_grids),
        truth_triangles: truth.triangles(),
        truth_frame_ms: truth.frame_ms,
        truth_build_ms: truth.build_ms,
        entries,
    })
}

/// A rendered frame with its cost.
struct TimedRender {
    renderer: Renderer,
    frame: Frame,
    /// The points that the pixels' centres show.
    points: Grid<Option<VisiblePoint>>,
    frame_ms: f64,
    build_ms: f64,
}

impl TimedRender {
    /// Returns the number of triangles, those that are traced without being kept included.
    fn triangles(&self) -> usize {
        let traced = self.renderer.displaced_surfaces().iter().map(|surface| surface.triangles).sum::<u64>();
        let polygons = if traced > 0 { 0 } else { self.renderer.triangles() };
        polygons + usize::try_from(traced).unwrap_or(usize::MAX)
    }
}

/// The renders of one comparison.
struct ComparisonRenders<'a> {
    scene: &'a Scene,
    options: &'a CompareOptions<'a>,
    pictures: usize,
}

impl ComparisonRenders<'_> {
    fn draw(&self, name: &str, done: usize, technique: TechniqueSpec) -> Result<TimedRender, CompareError> {
        let mut scene = self.scene.clone();
        for material in scene.materials.iter_mut().filter(|material| material.maps.height.is_some()) {
            technique.apply(&mut material.relief);
            material.relief.write_depth = Some(true);
        }
        self.draw_scene(name, done, &scene)
    }

    fn draw_scene(&self, name: &str, done: usize, scene: &Scene) -> Result<TimedRender, CompareError> {
        self.tell(name, done);
        let start = Instant::now();
        let renderer = Renderer::new(scene)?;
        let build_ms = start.elapsed().as_secs_f64() * 1e3;
        let start = Instant::now();
        let frame = renderer.render(&RenderOptions { threads: self.options.threads, ..RenderOptions::default() })?;
        let frame_ms = start.elapsed().as_secs_f64() * 1e3;
        let options = VisibleOptions { threads: self.options.threads, ..VisibleOptions::default() };
        let points = renderer.visible_points(&options)?;
        Ok(TimedRender { renderer, frame, points, frame_ms, build_ms })
    }

    fn tell(&self, name: &str, done: usize) {
        if let Some(progress) = self.options.progress {
            progress(name, done, self.pictures);
        }
    }
}

/// Replaces the pixels of displaced geometry that are not judged by the background.
fn where_judged(displaced: &TimedRender, judged: &JudgedPixels, polygons: &Frame) -> Grid<[u8; 3]> {
    let (picture, points) = (&displaced.frame.pixels, &displaced.points);
    Grid::from_fn(picture.width(), picture.height(), |x, y| {
        let point = points.get(x, y);
        // Samples may show relief where the pixel's centre shows none.
        let beside_outline = point.is_none() && judged.reach_beyond_polygons();
        let is_judged = *polygons.aovs.hit.get(x, y) > 0.0 || beside_outline || judged.contains(x, y, point.as_ref());
        *if is_judged { picture } else { &polygons.pixels }.get(x, y)
    })
}

fn entry(
    technique: TechniqueSpec,
    picture: Grid<[u8; 3]>,
    render: TimedRender,
    truth: &Grid<[u8; 3]>,
    true_pixels: &mut TruePixels<'_>,
) -> Result<ComparisonEntry, CompareError> {
    let flip = flip(truth, &picture, DEFAULT_PIXELS_PER_DEGREE)?;
    let psnr = pixel_difference(truth, &picture, 0).map_or(0.0, |difference| difference.psnr);
    let hits = PixelHits::new(&render.points, true_pixels)?;
    let triangles = render.triangles();
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
        triangles,
    })
}
