//! One material's curves and table.

use std::fmt::Write;

use super::findings::{Findings, GOOD_TEXELS, percent, short};
use super::html::{code, color, escape};
use super::plot::{Plot, Point, Scale, Series};
use crate::{Candidate, HitRow};

/// The angles that curves are drawn for: of those measured the nearest to these.
const CURVES: [f32; 3] = [60.0, 82.0, 88.5];

/// An error below this is drawn at it: nobody sees it.
const LEAST_TEXELS: f64 = 1e-3;

/// The equal-error curves: what a technique costs against how far its hits are off.
pub(super) fn curves(findings: &Findings<'_>, material: &str) -> Vec<String> {
    let mut angles: Vec<f32> = Vec::new();
    for wanted in CURVES {
        let nearest = findings.angles.iter().min_by(|a, b| (*a - wanted).abs().total_cmp(&(*b - wanted).abs()));
        angles.extend(nearest.filter(|angle| !angles.contains(angle)));
    }
    let mut plots: Vec<String> =
        angles.iter().map(|&angle| curve(findings, material, angle, "fetches", |row| row.hits.fetches.mean)).collect();
    if let Some(&angle) = angles.get(1).or(angles.first()) {
        plots.push(curve(findings, material, angle, "nanoseconds", |row| row.ns_per_ray));
    }
    plots
}

fn curve(findings: &Findings<'_>, material: &str, angle: f32, unit: &str, cost: fn(&HitRow) -> f64) -> String {
    let rows: Vec<&HitRow> = (findings.techniques.iter())
        .filter_map(|technique| findings.row(material, findings.depth, angle, technique))
        .collect();
    let family = |row: &HitRow| row.technique.parse::<Candidate>().map_or("", |candidate| candidate.family());
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
        let name = family(row);
        match series.iter_mut().find(|(known, _)| *known == name) {
            Some((_, known)) => known.points.push(point),
            None => {
                series.push((name, Series { color: color(name), strong: name == "exact", points: vec![point] }));
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

/// Every technique under the angle that tells most.
pub(super) fn table(findings: &Findings<'_>, material: &str) -> String {
    let nearest = findings.angles.iter().min_by(|a, b| (*a - CURVES[1]).abs().total_cmp(&(*b - CURVES[1]).abs()));
    let Some(&angle) = nearest else { return String::new() };
    let mut out = format!(
        "<p>Under {angle}°, {} texels deep; all angles and depths are in hits.csv.</p><div class=\"wide\"><table><tr>",
        findings.depth
    );
    for head in [
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
    ] {
        let _ = write!(out, "<th>{head}</th>");
    }
    out += "</tr>";
    for technique in &findings.techniques {
        let Some(row) = findings.row(material, findings.depth, angle, technique) else { continue };
        let note = technique.parse::<Candidate>().ok().and_then(|candidate| candidate.note());
        let note = note.map_or_else(String::new, |note| format!(" <small>{}</small>", escape(note)));
        let _ = write!(out, "<tr><td>{}{note}</td>", code(technique));
        let hits = &row.hits;
        let cells = [
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
        ];
        for cell in cells {
            let _ = write!(out, "<td>{cell}</td>");
        }
        out += "</tr>";
    }
    out + "</table></div>"
}
