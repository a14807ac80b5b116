//! The main tables, for the page and for Markdown.

use super::findings::Findings;
use super::format::{percent, short};
use crate::technique::{BEVY, EXACT, EXACT_CELLS, TUTORIALS};

/// A table: title, explanation, head and rows of cells.
pub(super) struct Table {
    pub(super) title: String,
    pub(super) text: String,
    pub(super) head: Vec<String>,
    pub(super) rows: Vec<Vec<Cell>>,
}

/// A cell of a table.
pub(super) struct Cell {
    pub(super) text: String,
    /// Heat of the background, 0 to 1; `None`: no background.
    pub(super) heat: Option<f64>,
}

impl Cell {
    fn plain(text: impl Into<String>) -> Self {
        Self { text: text.into(), heat: None }
    }
}

/// Makes all tables for which there are figures.
pub(super) fn all(findings: &Findings<'_>) -> Vec<Table> {
    [techniques, good_angles, cells, fastest].map(|make| make(findings)).into_iter().flatten().collect()
}

fn angles(findings: &Findings<'_>, first: &str) -> Vec<String> {
    std::iter::once(first.to_owned()).chain(findings.angles.iter().map(|angle| format!("{angle}°"))).collect()
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
    (count > 0).then(|| sum / f64::from(count))
}

/// Wrong hits, fetches and time of every technique over all materials.
fn techniques(findings: &Findings<'_>) -> Option<Table> {
    let depth = findings.depth;
    let row = |technique: &&str| {
        let cell = |&angle: &f32| {
            let rows =
                || findings.materials().filter_map(move |material| findings.row(material, depth, angle, technique));
            let exact = |material: &str| findings.row(material, depth, angle, EXACT).map(|row| row.ns_per_ray);
            let Some(wrong) = mean(rows().map(|row| row.hits.wrong)) else { return Cell::plain("") };
            let fetches = mean(rows().map(|row| row.hits.fetches.mean)).unwrap_or_default();
            let time = mean(rows().filter_map(|row| Some((row.ns_per_ray / exact(&row.material)?).ln())));
            let time = time.map_or_else(String::new, |ratio| format!(" ×{}", short(ratio.exp())));
            Cell { text: format!("{} % · {}{time}", percent(wrong), short(fetches)), heat: Some(wrong) }
        };
        let name = Cell::plain(format!("`{technique}`"));
        std::iter::once(name).chain(findings.angles.iter().map(cell)).collect()
    };
    Some(Table {
        title: format!("All techniques, reliefs {depth} texels deep"),
        text: format!(
            "Over all materials, on the {}: hits off by more than a texel · mean fetches of a ray, and its time as a multiple \
             of `exact`'s (geometric mean).",
            findings.backend
        ),
        head: angles(findings, "technique"),
        rows: findings.techniques.iter().map(row).collect(),
    })
}

/// The largest angle up to which the tutorials' and Bevy's rules are good enough.
fn good_angles(findings: &Findings<'_>) -> Option<Table> {
    const RULES: [(&str, &str); 2] = [(TUTORIALS, "tutorials"), (BEVY, "Bevy")];
    let rules: Vec<_> = RULES.iter().filter(|(rule, _)| findings.techniques.contains(rule)).collect();
    if rules.is_empty() {
        return None;
    }
    let columns: Vec<_> =
        rules.iter().flat_map(|rule| findings.depths.iter().map(move |depth| (*rule, *depth))).collect();
    let row = |material: &str| {
        let cell = |((rule, _), depth): &(&(&str, &str), f32)| match findings.good_up_to(material, *depth, rule) {
            Some(angle) => Cell { text: format!("{angle}°"), heat: Some(1.0 - f64::from(angle) / 90.0) },
            None => Cell { text: "never".to_owned(), heat: Some(1.0) },
        };
        std::iter::once(Cell::plain(material)).chain(columns.iter().map(cell)).collect()
    };
    let head = columns.iter().map(|((_, name), depth)| format!("{name}, {depth} texels"));
    Some(Table {
        title: "When POM is good enough".to_owned(),
        text: "The largest angle from the normal up to which 99 % of the hits lie within a texel of the truth, by the \
               tutorials' rule (8 to 32 layers) and by Bevy's (1 to 16), in reliefs of these depths."
            .to_owned(),
        head: std::iter::once("material".to_owned()).chain(head).collect(),
        rows: findings.materials().map(row).collect(),
    })
}

/// The pyramid against the walk over every cell.
fn cells(findings: &Findings<'_>) -> Option<Table> {
    if ![EXACT, EXACT_CELLS].iter().all(|technique| findings.techniques.contains(technique)) {
        return None;
    }
    let row = |material: &str| {
        let cell = |&angle: &f32| {
            let of = |technique: &str| findings.row(material, findings.depth, angle, technique);
            let (Some(exact), Some(cells)) = (of(EXACT), of(EXACT_CELLS)) else { return Cell::plain("") };
            let ratio = exact.ns_per_ray / cells.ns_per_ray;
            let fetches = [exact, cells].map(|row| short(row.hits.fetches.mean));
            Cell {
                text: format!("{} / {}, ×{}", fetches[0], fetches[1], short(ratio)),
                heat: Some(if ratio > 1.0 { 0.4 + 0.4 * (ratio - 1.0).min(1.0) } else { 0.0 }),
            }
        };
        std::iter::once(Cell::plain(material)).chain(findings.angles.iter().map(cell)).collect()
    };
    Some(Table {
        title: "Where exact loses: the pyramid against the plain walk".to_owned(),
        text: format!(
            "Mean fetches of `exact` / of `exact:cells`, and the time of `exact` as a multiple of the other's: above 1 the \
             pyramid loses. Reliefs {} texels deep.",
            findings.depth
        ),
        head: angles(findings, "material"),
        rows: findings.materials().map(row).collect(),
    })
}

/// The fastest technique that is good enough.
fn fastest(findings: &Findings<'_>) -> Option<Table> {
    let row = |material: &str| {
        let cell = |&angle: &f32| {
            let Some(best) = findings.fastest_good(material, findings.depth, angle) else { return Cell::plain("none") };
            let exact = findings.row(material, findings.depth, angle, EXACT);
            let ratio = exact.map_or(1.0, |exact| best.ns_per_ray / exact.ns_per_ray);
            let text = match best.technique.as_str() {
                name @ EXACT => format!("`{name}`"),
                name => format!("`{name}` ×{}", short(ratio)),
            };
            Cell { text, heat: Some(if best.technique == EXACT { 0.0 } else { 0.6 * (1.0 - ratio).max(0.0) }) }
        };
        std::iter::once(Cell::plain(material)).chain(findings.angles.iter().map(cell)).collect()
    };
    Some(Table {
        title: "The fastest that is good enough".to_owned(),
        text: format!(
            "Of all techniques with 99 % of their hits within a texel the fastest on the {}, and its time as a multiple of \
             `exact`'s. Reliefs {} texels deep.",
            findings.backend, findings.depth
        ),
        head: angles(findings, "material"),
        rows: findings.materials().map(row).collect(),
    })
}
