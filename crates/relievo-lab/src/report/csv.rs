//! Figures as comma-separated values (RFC 4180), one line per technique and case.

use crate::metric::Percentiles;
use crate::sweep::{HitRow, PictureRow};

/// Quotes a field if necessary.
fn text(field: &str) -> String {
    if field.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}

fn lines(rows: impl Iterator<Item = Vec<(&'static str, String)>>) -> String {
    let mut out = String::new();
    for (i, row) in rows.enumerate() {
        if i == 0 {
            out += &row.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(",");
            out.push('\n');
        }
        out += &row.into_iter().map(|(_, value)| value).collect::<Vec<_>>().join(",");
        out.push('\n');
    }
    out
}

pub(super) fn hits(rows: &[HitRow]) -> String {
    lines(rows.iter().map(|row| {
        let hits = &row.hits;
        let mut fields = vec![
            ("material", text(&row.material)),
            ("backend", text(&row.backend)),
            ("technique", text(&row.technique)),
            ("depth_texels", row.depth_texels.to_string()),
            ("minification", row.minification.to_string()),
            ("angle", row.angle.to_string()),
            ("rays", hits.rays.to_string()),
            ("wrong", hits.wrong.to_string()),
            ("false_skips", hits.false_skips.to_string()),
            ("false_stops", hits.false_stops.to_string()),
            ("misses", hits.misses.to_string()),
            ("grazing", hits.grazing.to_string()),
        ];
        let mut error = |names: [&'static str; 3], percentiles: &Percentiles| {
            fields.extend(
                names.into_iter().zip([percentiles.p50, percentiles.p99, percentiles.max].map(|x| x.to_string())),
            );
        };
        error(["texels_p50", "texels_p99", "texels_max"], &hits.texels);
        error(["pixels_p50", "pixels_p99", "pixels_max"], &hits.pixels);
        error(["depth_p50", "depth_p99", "depth_max"], &hits.depth);
        error(["normal_p50", "normal_p99", "normal_max"], &hits.normal);
        let mut cost = |names: [&'static str; 4], percentiles: &Percentiles| {
            let values = [percentiles.mean, percentiles.p95, percentiles.p99, percentiles.max].map(|x| x.to_string());
            fields.extend(names.into_iter().zip(values));
        };
        cost(["fetches_mean", "fetches_p95", "fetches_p99", "fetches_max"], &hits.fetches);
        cost(["iterations_mean", "iterations_p95", "iterations_p99", "iterations_max"], &hits.iterations);
        fields.extend([
            ("samples_mean", row.samples.to_string()),
            ("gathers_mean", row.gathers.to_string()),
            ("nodes_mean", row.nodes.to_string()),
            ("divergence", hits.divergence.to_string()),
            ("divergence_max", hits.divergence_max.to_string()),
            ("ns_per_ray", row.ns_per_ray.to_string()),
            ("build_ms", row.build_ms.to_string()),
            ("bytes", row.bytes.to_string()),
        ]);
        fields
    }))
}

pub(super) fn pictures(rows: &[PictureRow]) -> String {
    lines(rows.iter().map(|row| {
        vec![
            ("material", text(&row.material)),
            ("technique", text(&row.technique)),
            ("depth_texels", row.depth_texels.to_string()),
            ("minification", row.minification.to_string()),
            ("angle", row.angle.to_string()),
            ("lod", row.lod.to_string()),
            ("flip", row.flip.to_string()),
            ("psnr_db", row.psnr_db.map_or_else(String::new, |psnr| psnr.to_string())),
            ("picture", text(&row.picture)),
            ("truth", text(&row.truth)),
            ("truth_is", text(&row.truth_is)),
            ("samples", row.samples.to_string()),
            ("truth_samples", row.truth_samples.to_string()),
        ]
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_with_a_comma_stays_one_field() {
        let row = HitRow { material: "stone, \"old\"".to_owned(), ..HitRow::default() };
        let csv = hits(&[row.clone(), row]);
        let lines: Vec<&str> = csv.lines().collect();
        assert!(lines.len() == 3 && lines[1].starts_with("\"stone, \"\"old\"\"\",,"), "{csv}");
        assert_eq!(lines[0].split(',').count(), lines[1].split(',').count() - 1);
        assert_eq!(pictures(&[]), "");
    }
}
