//! The figures of a sweep, indexed by material, depth, angle and technique.

use std::collections::BTreeMap;

use crate::sweep::{HitRow, Results};

/// Largest 99th percentile of hit errors that is good enough, in texels.
pub(super) const GOOD_TEXELS: f64 = 1.0;

/// The results, indexed.
pub(super) struct Findings<'a> {
    pub(super) results: &'a Results,
    /// The backend of the figures.
    pub(super) backend: &'a str,
    /// All angles, sorted.
    pub(super) angles: Vec<f32>,
    /// All depths, sorted.
    pub(super) depths: Vec<f32>,
    /// The depth of tables and curves.
    pub(super) depth: f32,
    /// All techniques, in the order of the sweep.
    pub(super) techniques: Vec<&'a str>,
    rows: BTreeMap<(&'a str, u32, u32, &'a str), &'a HitRow>,
}

/// The depth of the tables, if it was measured.
const USUAL_DEPTH: f32 = 25.0;

impl<'a> Findings<'a> {
    /// Indexes the figures of the backend that was measured first.
    pub(super) fn new(results: &'a Results) -> Self {
        let backend = results.hits.first().map_or("cpu", |row| row.backend.as_str());
        Self::of_backend(results, backend)
    }

    /// Indexes the figures of a backend.
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

    /// The figures of one technique in one case, without minification.
    pub(super) fn row(&self, material: &str, depth: f32, angle: f32, technique: &str) -> Option<&'a HitRow> {
        self.rows.get(&key(material, depth, angle, technique)).copied()
    }

    /// All figures of a technique, without minification.
    pub(super) fn of_technique(&self, technique: &str) -> impl Iterator<Item = &'a HitRow> {
        self.rows.values().copied().filter(move |row| row.technique == technique)
    }

    /// The materials' names.
    pub(super) fn materials(&self) -> impl Iterator<Item = &'a str> {
        self.results.materials.iter().map(|material| material.name.as_str())
    }

    /// The largest angle up to which a technique is good enough at every angle.
    pub(super) fn good_up_to(&self, material: &str, depth: f32, technique: &str) -> Option<f32> {
        let good = |angle: f32| self.row(material, depth, angle, technique).is_some_and(is_good);
        self.angles.iter().copied().take_while(|&angle| good(angle)).last()
    }

    /// The fastest technique that is good enough in a case.
    pub(super) fn fastest_good(&self, material: &str, depth: f32, angle: f32) -> Option<&'a HitRow> {
        let rows = self.techniques.iter().filter_map(|technique| self.row(material, depth, angle, technique));
        rows.filter(|row| is_good(row)).min_by(|a, b| a.ns_per_ray.total_cmp(&b.ns_per_ray))
    }
}

/// Returns true if 99 % of the hits are good enough.
pub(super) fn is_good(row: &HitRow) -> bool {
    row.hits.misses <= 0.01 && row.hits.texels.p99 <= GOOD_TEXELS
}

fn key<'a>(material: &'a str, depth: f32, angle: f32, technique: &'a str) -> (&'a str, u32, u32, &'a str) {
    // Of positive numbers the bits are in the order of the numbers.
    (material, depth.to_bits(), angle.to_bits(), technique)
}
