//! The main findings, in sentences.

use std::collections::BTreeMap;

use super::findings::{Findings, is_good};
use super::format::short;
use crate::sweep::HitRow;
use crate::technique::{BEVY, EXACT, EXACT_CELLS, ResolvedTechnique, TUTORIALS};

/// Relief mapping with the default settings.
const RELIEF: &str = "relief:8..32+5";

/// The main findings as sentences.
pub(super) fn sentences(findings: &Findings<'_>) -> Vec<String> {
    let mut out = Vec::new();
    let exact: Vec<&HitRow> = findings.of_technique(EXACT).collect();
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
    for technique in [TUTORIALS, BEVY, RELIEF] {
        out.extend(technique_sentence(findings, technique));
    }
    out.extend(pyramid_sentence(findings));
    let pictures = |technique: &str| {
        let rows = findings.results.pictures.iter().filter(|row| row.minification == 1 && row.technique == technique);
        let flips: Vec<f64> = rows.map(|row| row.flip).collect();
        (!flips.is_empty()).then(|| flips.iter().sum::<f64>() / flips.len() as f64)
    };
    if let (Some(exact), Some(pom)) = (pictures(EXACT), pictures(TUTORIALS)) {
        out.push(format!(
            "In pictures against displaced geometry, mean FLIP is {} for `exact` and {} for the tutorials' rule.",
            short(exact),
            short(pom)
        ));
    }
    out
}

/// The sentence on a technique against `exact`.
fn technique_sentence(findings: &Findings<'_>, technique: &str) -> Option<String> {
    let rows: Vec<&HitRow> = findings.of_technique(technique).collect();
    let good = rows.iter().filter(|row| is_good(row)).count();
    let note = technique.parse::<ResolvedTechnique>().ok()?.note();
    let name = note.map_or_else(|| format!("`{technique}`"), |note| format!("`{technique}` ({note})"));
    // The largest angle that is good on every material, at each depth.
    let limits = findings.depths.iter().map(|&depth| {
        let mut each = findings.materials().map(|material| findings.good_up_to(material, depth, technique));
        let worst = each.try_fold(90.0f32, |worst, angle| Some(worst.min(angle?)));
        match worst {
            Some(angle) if angle < 90.0 => format!("{depth} texels up to {angle}°"),
            _ => format!("{depth} texels at no angle"),
        }
    });
    let faster = rows.iter().filter(|row| {
        let exact = findings.row(&row.material, row.depth_texels, row.angle, EXACT);
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

/// The sentence on the pyramid against the walk over every cell.
fn pyramid_sentence(findings: &Findings<'_>) -> Option<String> {
    let mut cases = 0;
    let (mut time, mut fetches) = (BTreeMap::<u32, u32>::new(), 0);
    for cells in findings.of_technique(EXACT_CELLS) {
        let exact = findings.row(&cells.material, cells.depth_texels, cells.angle, EXACT)?;
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
