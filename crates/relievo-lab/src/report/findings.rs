//! What the figures say: the questions that a reader has, answered from the rows.

use std::collections::BTreeMap;

use crate::{Candidate, HitRow, Results};

/// An error that is good enough, 99 % of hits, in texels.
pub(super) const GOOD_TEXELS: f64 = 1.0;

/// The results, indexed.
pub(super) struct Findings<'a> {
    pub(super) results: &'a Results,
    /// Where there are several, the first one measured: tables are of this one.
    pub(super) backend: &'a str,
    /// Sorted.
    pub(super) angles: Vec<f32>,
    /// Sorted.
    pub(super) depths: Vec<f32>,
    /// The depth that tables and curves are of.
    pub(super) depth: f32,
    /// In the order of the techniques.
    pub(super) techniques: Vec<&'a str>,
    rows: BTreeMap<(&'a str, u32, u32, &'a str), &'a HitRow>,
}

/// The depth of the tables, if it was measured.
const USUAL_DEPTH: f32 = 25.0;

impl<'a> Findings<'a> {
    pub(super) fn new(results: &'a Results) -> Self {
        let backend = results.hits.first().map_or("cpu", |row| row.backend.as_str());
        Self::of_backend(results, backend)
    }

    pub(super) fn of_backend(results: &'a Results, backend: &'a str) -> Self {
        let rows = || results.hits.iter().filter(move |row| row.backend == backend && row.minification == 1);
        let sorted = |value: fn(&HitRow) -> f32| {
            let mut values: Vec<f32> = rows().map(value).collect();
            values.sort_by(f32::total_cmp);
            values.dedup();
            values
        };
        let depths = sorted(|row| row.depth_texels);
        let mut techniques: Vec<&str> = Vec::new();
        for row in rows() {
            if !techniques.contains(&row.technique.as_str()) {
                techniques.push(&row.technique);
            }
        }
        let usual = depths.iter().copied().find(|&depth| depth == USUAL_DEPTH);
        Self {
            results,
            backend,
            angles: sorted(|row| row.angle),
            depth: usual.or_else(|| depths.get(depths.len() / 2).copied()).unwrap_or_default(),
            depths,
            techniques,
            rows: rows().map(|row| (key(&row.material, row.depth_texels, row.angle, &row.technique), row)).collect(),
        }
    }

    /// The figures of one technique in one case at no minification.
    pub(super) fn row(&self, material: &str, depth: f32, angle: f32, technique: &str) -> Option<&'a HitRow> {
        self.rows.get(&key(material, depth, angle, technique)).copied()
    }

    /// All figures of a technique at no minification.
    pub(super) fn of_technique(&self, technique: &str) -> impl Iterator<Item = &'a HitRow> {
        self.rows.values().copied().filter(move |row| row.technique == technique)
    }

    /// The materials' names.
    pub(super) fn materials(&self) -> impl Iterator<Item = &'a str> {
        self.results.materials.iter().map(|material| material.name.as_str())
    }

    /// The largest angle up to which a technique is good enough under every angle that was measured.
    pub(super) fn good_up_to(&self, material: &str, depth: f32, technique: &str) -> Option<f32> {
        let good = |angle: f32| self.row(material, depth, angle, technique).is_some_and(is_good);
        self.angles.iter().copied().take_while(|&angle| good(angle)).last()
    }

    /// The fastest technique of those that are good enough in a case.
    pub(super) fn fastest_good(&self, material: &str, depth: f32, angle: f32) -> Option<&'a HitRow> {
        let rows = self.techniques.iter().filter_map(|technique| self.row(material, depth, angle, technique));
        rows.filter(|row| is_good(row)).min_by(|a, b| a.ns_per_ray.total_cmp(&b.ns_per_ray))
    }

    /// Plain sentences.
    pub(super) fn sentences(&self) -> Vec<String> {
        let mut out = Vec::new();
        let exact: Vec<&HitRow> = self.of_technique("exact").collect();
        if !exact.is_empty() {
            let rays: u64 = exact.iter().map(|row| row.hits.rays).sum();
            let wrong: f64 = exact.iter().map(|row| row.hits.wrong * row.hits.rays as f64).sum();
            let grazing: u64 = exact.iter().map(|row| row.hits.grazing).sum();
            let worst = exact.iter().map(|row| row.hits.texels.p99).fold(0.0, f64::max);
            out.push(format!(
                "`exact` was wrong on {} of {rays} rays ({grazing} more touch a crest so closely that rounding decides); 99 % \
                 of its hits lie within {} texels of the oracle's in every case.",
                wrong.round(),
                short(worst)
            ));
        }
        for technique in ["occlusion:8..32", "occlusion:1..16", "relief:8..32+5"] {
            out.extend(self.sentence_on(technique));
        }
        out.extend(self.sentence_on_cells());
        let pictures = |technique: &str| {
            let rows = self.results.pictures.iter().filter(|row| row.minification == 1 && row.technique == technique);
            let flips: Vec<f64> = rows.map(|row| row.flip).collect();
            (!flips.is_empty()).then(|| flips.iter().sum::<f64>() / flips.len() as f64)
        };
        if let (Some(exact), Some(pom)) = (pictures("exact"), pictures("occlusion:8..32")) {
            out.push(format!(
                "In pictures against displaced geometry, mean FLIP is {} for `exact` and {} for the tutorials' rule.",
                short(exact),
                short(pom)
            ));
        }
        out
    }

    fn sentence_on(&self, technique: &str) -> Option<String> {
        let rows: Vec<&HitRow> = self.of_technique(technique).collect();
        let good = rows.iter().filter(|row| is_good(row)).count();
        let note = technique.parse::<Candidate>().ok()?.note();
        let name = note.map_or_else(|| format!("`{technique}`"), |note| format!("`{technique}` ({note})"));
        // Where everybody else could stop: the largest angle that is good on every material, in each depth.
        let limits = self.depths.iter().map(|&depth| {
            let mut each = self.materials().map(|material| self.good_up_to(material, depth, technique));
            let worst = each.try_fold(90.0f32, |worst, next| Some(worst.min(next?)));
            match worst {
                Some(angle) if angle < 90.0 => format!("{depth} texels up to {angle}°"),
                _ => format!("{depth} texels at no angle"),
            }
        });
        let faster = rows.iter().filter(|row| {
            let exact = self.row(&row.material, row.depth_texels, row.angle, "exact");
            is_good(row) && exact.is_some_and(|exact| row.ns_per_ray < exact.ns_per_ray)
        });
        (!rows.is_empty()).then(|| {
            format!(
                "{name} keeps 99 % of its hits within a texel in {good} of {} cases, and is faster than `exact` in {} of \
                 those. It does so on every material in reliefs of {}.",
                rows.len(),
                faster.count(),
                limits.collect::<Vec<_>>().join(", ")
            )
        })
    }

    fn sentence_on_cells(&self) -> Option<String> {
        let mut cases = 0;
        let (mut time, mut fetches) = (BTreeMap::<u32, u32>::new(), 0);
        for cells in self.of_technique("exact:cells") {
            let exact = self.row(&cells.material, cells.depth_texels, cells.angle, "exact")?;
            cases += 1;
            fetches += u32::from(cells.hits.fetches.mean < exact.hits.fetches.mean);
            if cells.ns_per_ray < exact.ns_per_ray {
                *time.entry(cells.angle.to_bits()).or_default() += 1;
            }
        }
        let slower: u32 = time.values().sum();
        let by_angle: Vec<String> =
            time.iter().map(|(angle, count)| format!("{count} at {}°", f32::from_bits(*angle))).collect();
        (cases > 0).then(|| {
            format!(
                "The pyramid loses to the plain walk over every cell in {slower} of {cases} cases by time{}, and in {fetches} \
                 by fetches: where the first cells decide, it is loads more.",
                if by_angle.is_empty() { String::new() } else { format!(" ({})", by_angle.join(", ")) }
            )
        })
    }
}

/// Whether 99 % of the hits are good enough.
pub(super) fn is_good(row: &HitRow) -> bool {
    row.hits.misses <= 0.01 && row.hits.texels.p99 <= GOOD_TEXELS
}

fn key<'a>(material: &'a str, depth: f32, angle: f32, technique: &'a str) -> (&'a str, u32, u32, &'a str) {
    // Of positive numbers the bits are in the order of the numbers.
    (material, depth.to_bits(), angle.to_bits(), technique)
}

/// A number with three digits that count.
pub(super) fn short(x: f64) -> String {
    match x.abs() {
        a if !a.is_finite() => "–".to_owned(),
        0.0 => "0".to_owned(),
        a if a >= 100.0 => format!("{x:.0}"),
        a if a >= 10.0 => format!("{x:.1}"),
        a if a >= 1.0 => format!("{x:.2}"),
        a if a >= 0.001 => format!("{x:.3}"),
        _ => format!("{x:.0e}"),
    }
}

/// A share in per cent.
pub(super) fn percent(x: f64) -> String {
    match x * 100.0 {
        0.0 => "0".to_owned(),
        p if p < 0.1 => "<0.1".to_owned(),
        p if p < 10.0 => format!("{p:.1}"),
        p => format!("{p:.0}"),
    }
}
