use relievo_cpu::{RenderError, Renderer, VisibleOptions, VisiblePoint};
use relievo_map::Grid;
use relievo_scene::Scene;
use serde::Serialize;

use super::hit_error::{HitErrorSummary, WRONG_TEXELS};
use super::judged_pixels::JudgedPixels;
use super::percentiles::Percentiles;
use super::scene_charts::{Foot, SceneCharts};

/// Distance in texels by which the truth is raised and lowered to find the pixels in which it hangs by a thread.
const GRAZING_TEXELS: f64 = 0.05;

/// Hit errors of a picture against the true surface in scene space, over the pixels in which technique or truth shows relief.
///
/// The error of a pixel is the distance on the mesh between the points below (or above) what the technique shows and what is
/// there, in texels of the surface at the true point. A pixel is grazing if it is wrong, but right for a surface that is a
/// twentieth of a texel higher or lower: it is judged by that.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PixelHitErrors {
    /// Distances over the pixels where both hit, in texels of the height map.
    pub texels: Percentiles,
    /// Fraction of pixels that are off by more than a texel, or where only one of technique and truth hits.
    pub wrong: f64,
    /// Fraction of pixels where only one of technique and truth hits; with `edge = "wrap"` and `"clamp"` a relief goes on
    /// where displaced geometry ends, and is not judged there.
    pub only_one_hits: f64,
    /// Fraction of the pixels where both hit that are off by more than a texel.
    pub off: f64,
    /// Fraction of pixels that are right for a surface slightly higher or lower alone.
    pub grazing: f64,
    /// Pixels in which both show relief, over those in which either does: 1 where the outlines are the same. Where the flat
    /// polygons show; a relief with an outline of its own counts wherever it or the truth shows.
    pub outline_iou: f64,
}

/// The points that the true surface shows, and those that it would show if it were slightly higher or lower.
pub(crate) struct TruePixels<'a> {
    charts: SceneCharts,
    renderer: &'a Renderer,
    threads: Option<usize>,
    judged: JudgedPixels,
    /// What the true surface shows.
    points: Grid<Option<VisiblePoint>>,
    feet: Grid<Option<Foot>>,
    /// Where they were asked for: raised and lowered.
    near: Grid<Option<[Option<Foot>; 2]>>,
}

impl<'a> TruePixels<'a> {
    /// Traces the truth, a scene of displaced surfaces with as fine a grid as is wanted.
    pub(crate) fn new(
        scene: &Scene,
        renderer: &'a Renderer,
        threads: Option<usize>,
        judged: JudgedPixels,
    ) -> Result<Self, RenderError> {
        let charts = SceneCharts::new(scene);
        let points = renderer.visible_points(&VisibleOptions { threads, ..VisibleOptions::default() })?;
        let feet = feet(&charts, &points);
        let [width, height] = judged.size();
        let near = Grid::filled(width, height, None);
        Ok(Self { charts, renderer, threads, judged, points, feet, near })
    }

    pub(crate) fn judged(&self) -> &JudgedPixels {
        &self.judged
    }

    /// Traces the raised and the lowered surface in these pixels.
    fn look_near(&mut self, pixels: &Grid<bool>) -> Result<(), RenderError> {
        let only =
            Grid::from_fn(pixels.width(), pixels.height(), |x, y| *pixels.get(x, y) && self.near.get(x, y).is_none());
        if !only.texels().contains(&true) {
            return Ok(());
        }
        let moved = |raise: f64| -> Result<Grid<Option<Foot>>, RenderError> {
            let options =
                VisibleOptions { threads: self.threads, raise, only: Some(&only), ..VisibleOptions::default() };
            Ok(feet(&self.charts, &self.renderer.visible_points(&options)?))
        };
        let (raised, lowered) = (moved(GRAZING_TEXELS)?, moved(-GRAZING_TEXELS)?);
        for ((near, &only), feet) in
            self.near.texels_mut().iter_mut().zip(only.texels()).zip(raised.texels().iter().zip(lowered.texels()))
        {
            if only {
                *near = Some([*feet.0, *feet.1]);
            }
        }
        Ok(())
    }
}

/// The feet of all points that show relief.
fn feet(charts: &SceneCharts, points: &Grid<Option<VisiblePoint>>) -> Grid<Option<Foot>> {
    points.map(|point| charts.foot(point.as_ref()?))
}

/// The hits of a technique, compared with those of the truth.
pub(crate) struct PixelHits {
    /// Hit error per pixel, texels; NaN where only one of the two hits, 0 where neither does.
    pub(crate) error_map: Grid<f32>,
    pub(crate) errors: PixelHitErrors,
    /// Pixels in which either shows relief.
    relief: Vec<(u32, u32)>,
}

/// State of a pixel.
#[derive(Clone, Copy, PartialEq)]
enum PixelState {
    /// Neither shows relief, or the pixel is not judged.
    Nothing,
    /// The relief goes on where displaced geometry has ended.
    Beyond,
    /// Off by this number of texels.
    Off(f64),
    /// Only one of technique and truth shows relief.
    OnlyOne,
}

impl PixelState {
    fn new(shown: Option<&Foot>, truth: Option<&Foot>) -> Self {
        match (shown, truth) {
            (None, None) => Self::Nothing,
            (Some(shown), None) if shown.goes_on => Self::Beyond,
            (Some(shown), Some(truth)) => Self::Off(truth.texels_to(shown)),
            _ => Self::OnlyOne,
        }
    }

    fn is_wrong(self) -> bool {
        match self {
            Self::Nothing | Self::Beyond => false,
            // Written so that NaN is wrong.
            Self::Off(texels) => !(texels <= WRONG_TEXELS),
            Self::OnlyOne => true,
        }
    }
}

impl PixelHits {
    /// Compares the points that a technique shows with the truth.
    pub(crate) fn new(points: &Grid<Option<VisiblePoint>>, truth: &mut TruePixels<'_>) -> Result<Self, RenderError> {
        let (width, height) = (points.width(), points.height());
        let shown = feet(&truth.charts, points);
        let states = Grid::from_fn(width, height, |x, y| {
            let is_judged = |point: &Option<VisiblePoint>| truth.judged.contains(x, y, point.as_ref());
            if is_judged(points.get(x, y)) || is_judged(truth.points.get(x, y)) {
                PixelState::new(shown.get(x, y).as_ref(), truth.feet.get(x, y).as_ref())
            } else {
                PixelState::Nothing
            }
        });
        truth.look_near(&states.map(|state| state.is_wrong()))?;
        let mended = Grid::from_fn(width, height, |x, y| {
            let state = *states.get(x, y);
            let near = truth.near.get(x, y).filter(|_| state.is_wrong());
            let near = near.iter().flatten().map(|foot| PixelState::new(shown.get(x, y).as_ref(), foot.as_ref()));
            let (mended, is_grazing) =
                near.filter(|near| !near.is_wrong()).map(|near| (near, true)).next().unwrap_or((state, false));
            // Where neither shows relief any more, nothing is off.
            if is_grazing && matches!(mended, PixelState::Nothing | PixelState::Beyond) {
                (PixelState::Off(0.0), true)
            } else {
                (mended, is_grazing)
            }
        });
        let error_map = mended.map(|(state, _)| match state {
            PixelState::Nothing | PixelState::Beyond => 0.0,
            PixelState::Off(texels) => *texels as f32,
            PixelState::OnlyOne => f32::NAN,
        });
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let relief: Vec<(u32, u32)> = pixels.filter(|&(x, y)| *states.get(x, y) != PixelState::Nothing).collect();
        let errors = Self::summed_up(&relief, &mended, &states);
        Ok(Self { error_map, errors, relief })
    }

    fn summed_up(
        relief: &[(u32, u32)],
        mended: &Grid<(PixelState, bool)>,
        states: &Grid<PixelState>,
    ) -> PixelHitErrors {
        let judged = |&&(x, y): &&(u32, u32)| *states.get(x, y) != PixelState::Beyond;
        let judged: Vec<&(PixelState, bool)> = relief.iter().filter(judged).map(|&(x, y)| mended.get(x, y)).collect();
        let summary = HitErrorSummary::new(judged.iter().map(|(state, _)| match state {
            PixelState::Off(texels) => Some(*texels),
            _ => None,
        }));
        let share = |count: usize, all: usize| count as f64 / all.max(1) as f64;
        let both = judged.iter().filter(|(state, _)| matches!(state, PixelState::Off(_)));
        let off = both.clone().filter(|(state, _)| state.is_wrong()).count();
        let alike = relief.iter().filter(|&&(x, y)| matches!(states.get(x, y), PixelState::Off(_))).count();
        PixelHitErrors {
            texels: summary.texels,
            wrong: summary.wrong,
            only_one_hits: summary.only_one_hits,
            off: share(off, both.count()),
            grazing: share(judged.iter().filter(|(_, is_grazing)| *is_grazing).count(), judged.len()),
            outline_iou: if relief.is_empty() { 1.0 } else { share(alike, relief.len()) },
        }
    }

    /// Percentiles of a map over the pixels that show relief.
    pub(crate) fn over_relief(&self, map: &Grid<f32>) -> Percentiles {
        Percentiles::of(self.relief.iter().map(|&(x, y)| *map.get(x, y)))
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use relievo_cpu::Precision;
    use relievo_map::HeightMap;
    use relievo_march::Technique;
    use relievo_scene::{Edge, Filter, LoadOptions, SurfaceTechnique};

    use super::*;
    use crate::corpus;

    const SCENE: &str = "
[image]
width = 96
height = 72
[camera]
position = [0.7, -1.5, 1.2]
[materials.m]
height_scale = 0.06
[[objects]]
mesh = \"quad\"
material = \"m\"
";

    fn scene(map: HeightMap) -> Scene {
        let mut scene = Scene::parse(SCENE, "test", Path::new(""), &LoadOptions::default()).unwrap();
        scene.materials[0].maps.height = Some(map);
        scene
    }

    fn points(scene: &Scene) -> Grid<Option<VisiblePoint>> {
        let options = VisibleOptions { precision: Precision::Oracle, ..VisibleOptions::default() };
        Renderer::new(scene).unwrap().visible_points(&options).unwrap()
    }

    /// Judges what a technique shows by the true surface of `scene`.
    fn judged(scene: &Scene, shown: &Grid<Option<VisiblePoint>>) -> PixelHitErrors {
        let mut truth = scene.clone();
        truth.materials[0].relief.technique = SurfaceTechnique::Displacement;
        truth.materials[0].relief.vertices_per_texel = Some(16);
        let renderer = Renderer::new(&truth).unwrap();
        let polygons = with_technique(scene, Technique::None);
        let judged = JudgedPixels::new(scene, points(&polygons).map(Option::is_some));
        let mut truth = TruePixels::new(scene, &renderer, None, judged).unwrap();
        PixelHits::new(shown, &mut truth).unwrap().errors
    }

    fn with_technique(scene: &Scene, technique: Technique) -> Scene {
        let mut scene = scene.clone();
        scene.materials[0].relief.technique = SurfaceTechnique::Marched(technique);
        scene
    }

    #[test]
    fn the_oracle_of_a_plane_is_right_and_other_surfaces_and_frames_are_wrong() {
        let map = corpus("noise", 64).unwrap();
        let scene = scene(map.clone());
        let right = points(&scene);
        let errors = judged(&scene, &right);
        assert!(errors.wrong == 0.0 && errors.texels.p99 < 0.05 && errors.outline_iou > 0.8, "{errors:?}");

        // The heights of the next texel.
        let shifted = Grid::from_fn(64, 64, |x, y| *map.grid().get((x + 1) % 64, y));
        let errors = judged(&scene, &points(&self::scene(HeightMap::new(shifted))));
        assert!(errors.wrong > 0.02 && errors.texels.p50 > 0.1, "{errors:?}");

        // A frame that is a third too long, as that of a mean over neighbours.
        let polygons = points(&with_technique(&scene, Technique::None));
        let long = Grid::from_fn(96, 72, |x, y| {
            let (mut point, polygon) = ((*right.get(x, y))?, (*polygons.get(x, y))?);
            point.uv = [0, 1].map(|k| polygon.uv[k] + (point.uv[k] - polygon.uv[k]) * 4.0 / 3.0);
            Some(point)
        });
        let errors = judged(&scene, &long);
        assert!(errors.wrong > 0.1, "{errors:?}");

        // Holes.
        let holes = Grid::from_fn(96, 72, |x, y| right.get(x, y).filter(|_| (x + y) % 2 == 0));
        let errors = judged(&scene, &holes);
        assert!(errors.only_one_hits > 0.4 && errors.wrong == errors.only_one_hits, "{errors:?}");
        assert!(errors.outline_iou < 0.6 && errors.off == 0.0, "{errors:?}");
    }
    #[test]
    fn an_outline_beyond_the_polygons_counts_where_there_is_one() {
        let text = SCENE.replace("quad", "sphere").replace("height_scale = 0.06", "depth = 0.15\nmidlevel = 0.0");
        let mut scene = Scene::parse(&text, "test", Path::new(""), &LoadOptions::default()).unwrap();
        scene.materials[0].maps.height = corpus("noise", 64);
        let mut plane = scene.clone();
        scene.materials[0].relief.edge = Edge::Silhouette;
        let errors = judged(&scene, &points(&scene));
        assert!(errors.wrong < 0.003 && errors.outline_iou >= 0.995, "{errors:?}");
        // A picture without the outline.
        plane.materials[0].relief.edge = Edge::Wrap;
        let errors = judged(&scene, &points(&plane));
        assert!(errors.only_one_hits > 0.02 && errors.outline_iou < 0.98, "{errors:?}");
        // Where there is none by definition it is not missed.
        let errors = judged(&plane, &points(&plane));
        assert!(errors.only_one_hits < 0.003 && errors.outline_iou >= 0.98, "{errors:?}");
    }

    #[test]
    fn nearest_maps_and_parts_of_an_atlas_are_judged_by_a_truth_of_their_own() {
        let mut scene = scene(corpus("noise", 16).unwrap());
        let linear = points(&scene);
        scene.materials[0].filter = Filter::Nearest;
        let errors = judged(&scene, &points(&scene));
        assert!(errors.off < 0.003 && errors.texels.p95 < 0.1, "{errors:?}");
        let errors = judged(&scene, &linear);
        assert!(errors.texels.p95 > 0.3, "ramps: {errors:?}");

        let mut part = self::scene(corpus("noise", 64).unwrap());
        let whole = points(&part);
        (part.materials[0].relief.edge, part.materials[0].uv_rect) = (Edge::Clip, Some([0.25, 0.25, 0.75, 0.75]));
        let errors = judged(&part, &points(&part));
        assert!(errors.only_one_hits < 0.02 && errors.off < 0.003, "{errors:?}");
        let errors = judged(&part, &whole);
        assert!(errors.only_one_hits > 0.3, "not clipped: {errors:?}");
    }
}
