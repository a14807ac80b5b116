//! Curves over all materials.

use maud::Markup;

use super::findings::Findings;
use super::format::{percent, short};
use super::markup::family;
use super::plot::{Plot, Point, Scale, Series};
use crate::colors::report::series_class;
use crate::sweep::HitRow;
use crate::technique::{BEVY, EXACT, EXACT_CELLS, TUTORIALS};

/// The techniques of the overview: all settings of one technique would hide each other.
const SHOWN: [&str; 8] =
    [TUTORIALS, BEVY, "relief:8..32+5", "contact:8..32", "steep:8..32", EXACT_CELLS, "cone", EXACT];

/// Plots errors and costs against the angle, as means over all materials.
pub(super) fn plots(findings: &Findings<'_>) -> Vec<Markup> {
    let depth = findings.depth;
    let most = |ticks: f64| ticks.max(0.01);
    let wrong = series(findings, |row| row.hits.wrong);
    let highest = wrong.iter().flat_map(|s| s.points.iter().map(|p| p.y)).fold(0.05, f64::max);
    let angles = || {
        let last = findings.angles.last().copied().map_or(90.0, f64::from);
        Scale::Linear { max: last.max(1.0), ticks: findings.angles.iter().map(|&a| f64::from(a)).collect() }
    };
    let percentages = [0.0, 0.1, 0.25, 0.5, 0.75, 1.0].into_iter().filter(|&tick| tick <= highest).collect();
    let log = |list: &[Series]| {
        let values: Vec<f64> = list.iter().flat_map(|s| s.points.iter().map(|p| p.y)).collect();
        Scale::log_around(values.into_iter(), 0.5)
    };
    let fetches = series(findings, |row| row.hits.fetches.mean);
    let time = series(findings, |row| row.ns_per_ray);
    let divergence = series(findings, |row| row.hits.divergence);
    let widest = divergence.iter().flat_map(|s| s.points.iter().map(|p| p.y)).fold(2.0, f64::max).ceil();
    [
        (
            format!("Wrong hits, {depth} texels deep"),
            "share of rays",
            Scale::Linear { max: most(highest), ticks: percentages },
            wrong,
        ),
        (format!("Fetches of a ray, {depth} texels deep"), "fetches", log(&fetches), fetches),
        (format!("Time of a ray on the {}, {depth} texels deep", findings.backend), "nanoseconds", log(&time), time),
        (
            format!("Divergence of 8×4 tiles, {depth} texels deep"),
            "slowest ray / mean",
            Scale::Linear { max: widest, ticks: (0..=widest as u32).map(f64::from).collect() },
            divergence,
        ),
    ]
    .into_iter()
    .map(|(title, label, scale, series)| {
        let x = ("degrees from the normal".to_owned(), angles());
        Plot { title, x, y: (label.to_owned(), scale), series, mark: None }.svg()
    })
    .collect()
}

fn series(findings: &Findings<'_>, value: fn(&HitRow) -> f64) -> Vec<Series> {
    let shown = SHOWN.iter().filter(|technique| findings.techniques.contains(*technique));
    let one = |technique: &&str| {
        let point = |&angle: &f32| {
            let rows: Vec<&HitRow> = findings
                .materials()
                .filter_map(|material| findings.row(material, findings.depth, angle, technique))
                .collect();
            let mean = |value: fn(&HitRow) -> f64| rows.iter().map(|row| value(row)).sum::<f64>() / rows.len() as f64;
            let title = format!(
                "{technique} at {angle}°: {} % wrong, {} fetches, {} ns, divergence {}",
                percent(mean(|row| row.hits.wrong)),
                short(mean(|row| row.hits.fetches.mean)),
                short(mean(|row| row.ns_per_ray)),
                short(mean(|row| row.hits.divergence))
            );
            (!rows.is_empty()).then(|| Point { x: f64::from(angle), y: mean(value), title })
        };
        Series {
            class: series_class(family(technique)),
            strong: *technique == EXACT,
            points: findings.angles.iter().filter_map(point).collect(),
        }
    };
    shown.map(one).collect()
}
