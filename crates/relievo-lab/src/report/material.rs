//! One material's curves and table.

use maud::{Markup, html};

use super::findings::{Findings, GOOD_TEXELS};
use super::format::{percent, short};
use super::markup::family;
use super::plot::{Plot, Point, Scale, Series};
use crate::colors::report::series_class;
use crate::sweep::HitRow;
use crate::technique::{EXACT, ResolvedTechnique};

/// Angles of the curves: the nearest that were measured are drawn.
const CURVES: [f32; 3] = [60.0, 82.0, 88.5];

/// Smallest error of the axis; smaller ones are drawn at it.
const LEAST_TEXELS: f64 = 1e-3;

/// Plots the equal-error curves: hit error against cost.
pub(super) fn curves(findings: &Findings<'_>, material: &str) -> Vec<Markup> {
    let mut angles: Vec<f32> = Vec::new();
    for wanted in CURVES {
        let nearest = findings.angles.iter().min_by(|a, b| (*a - wanted).abs().total_cmp(&(*b - wanted).abs()));
        angles.extend(nearest.filter(|angle| !angles.contains(angle)));
    }
    let mut plots: Vec<Markup> =
        angles.iter().map(|&angle| curve(findings, material, angle, "fetches", |row| row.hits.fetches.mean)).collect();
    if let Some(&angle) = angles.get(1).or(angles.first()) {
        plots.push(curve(findings, material, angle, "nanoseconds", |row| row.ns_per_ray));
    }
    plots
}

fn curve(findings: &Findings<'_>, material: &str, angle: f32, unit: &str, cost: fn(&HitRow) -> f64) -> Markup {
    let rows: Vec<&HitRow> = (findings.techniques.iter())
        .filter_map(|technique| findings.row(material, findings.depth, angle, technique))
        .collect();
    let mut series: Vec<(&str, Series)> = Vec::new();
    for row in &rows {
        let point = Point {
            x: cost(row),
            y: row.hits.texels.p99,
            title: format!(
                "{}: {} texels, {} % wrong, {} fetches, {} ns",
                row.technique,
                short(row.hits.texels.p99),
                percent(row.hits.wrong),
                short(row.hits.fetches.mean),
                short(row.ns_per_ray)
            ),
        };
        let name = family(&row.technique);
        match series.iter_mut().find(|(known, _)| *known == name) {
            Some((_, known)) => known.points.push(point),
            None => {
                series.push((name, Series { class: series_class(name), strong: name == EXACT, points: vec![point] }));
            }
        }
    }
    for (_, series) in &mut series {
        series.points.sort_by(|a, b| a.x.total_cmp(&b.x));
    }
    Plot {
        title: format!("{angle}° from the normal"),
        x: (format!("{unit} per ray"), Scale::log_around(rows.iter().map(|row| cost(row)), 1.0)),
        y: (
            "texels off, 99 % of hits".to_owned(),
            Scale::log_around(rows.iter().map(|row| row.hits.texels.p99), LEAST_TEXELS),
        ),
        series: series.into_iter().map(|(_, series)| series).collect(),
        mark: Some((GOOD_TEXELS, "one texel: good enough".to_owned())),
    }
    .svg()
}

/// Heads of the table's columns.
const COLUMNS: [&str; 21] = [
    "technique",
    "wrong %",
    "skips %",
    "stops %",
    "texels p50",
    "p99",
    "max",
    "pixels p99",
    "depth p99",
    "normal° p99",
    "samples",
    "gathers",
    "nodes",
    "fetches p95",
    "p99",
    "max",
    "turns",
    "divergence",
    "ns",
    "build ms",
    "KiB",
];

/// A table of every technique at the second of the curves' angles.
pub(super) fn table(findings: &Findings<'_>, material: &str) -> Markup {
    let nearest = findings.angles.iter().min_by(|a, b| (*a - CURVES[1]).abs().total_cmp(&(*b - CURVES[1]).abs()));
    let Some(&angle) = nearest else { return Markup::default() };
    let rows = || findings.techniques.iter().filter_map(|name| findings.row(material, findings.depth, angle, name));
    let note = |name: &str| name.parse::<ResolvedTechnique>().ok().and_then(|technique| technique.note());
    html! {
        p { "Under " (angle) "°, " (findings.depth) " texels deep; all angles and depths are in hits.csv." }
        div.wide {
            table {
                tr { @for head in COLUMNS { th { (head) } } }
                @for row in rows() {
                    tr {
                        td {
                            code { (row.technique) }
                            @if let Some(note) = note(&row.technique) { " " small { (note) } }
                        }
                        @for cell in cells(row) { td { (cell) } }
                    }
                }
            }
        }
    }
}

/// The table's cells after the technique.
fn cells(row: &HitRow) -> [String; COLUMNS.len() - 1] {
    let hits = &row.hits;
    [
        percent(hits.wrong),
        percent(hits.false_skips),
        percent(hits.false_stops),
        short(hits.texels.p50),
        short(hits.texels.p99),
        short(hits.texels.max),
        short(hits.pixels.p99),
        short(hits.depth.p99),
        short(hits.normal.p99),
        short(row.samples),
        short(row.gathers),
        short(row.nodes),
        short(hits.fetches.p95),
        short(hits.fetches.p99),
        short(hits.fetches.max),
        short(hits.iterations.mean),
        short(hits.divergence),
        short(row.ns_per_ray),
        short(row.build_ms),
        format!("{}", row.bytes / 1024),
    ]
}
