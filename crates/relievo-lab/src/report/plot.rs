//! Curves as SVG. Colours come from the page's style: `c0`, `c1`, … are classes.

use std::fmt::Write;

use super::findings::short;
use super::html::escape;

const WIDTH: f64 = 340.0;
const HEIGHT: f64 = 250.0;
const LEFT: f64 = 46.0;
const RIGHT: f64 = 10.0;
const TOP: f64 = 26.0;
const BOTTOM: f64 = 38.0;

/// Which way values run along an axis.
pub(super) enum Scale {
    /// From 0 to `max`, with these ticks.
    Linear { max: f64, ticks: Vec<f64> },
    /// In decades; smaller and larger values lie on the border.
    Log { min: f64, max: f64 },
}

impl Scale {
    /// In decades around values (those above `floor`).
    pub(super) fn log_around(values: impl Iterator<Item = f64>, floor: f64) -> Self {
        let (mut min, mut max) = (f64::INFINITY, floor);
        for value in values.filter(|value| value.is_finite()) {
            (min, max) = (min.min(value), max.max(value));
        }
        let min = 10f64.powf(min.max(floor).min(max).log10().floor());
        let max = 10f64.powf(max.log10().ceil()).max(min * 10.0);
        Self::Log { min, max }
    }

    /// Where a value lies between the ends, 0 to 1.
    fn place(&self, value: f64) -> f64 {
        let place = match self {
            Self::Linear { max, .. } => value / max,
            Self::Log { min, max } => (value.max(*min) / min).ln() / (max / min).ln(),
        };
        if place.is_nan() { 0.0 } else { place.clamp(0.0, 1.0) }
    }

    fn ticks(&self) -> Vec<f64> {
        match self {
            Self::Linear { ticks, .. } => ticks.clone(),
            Self::Log { min, max } => {
                let decades = (max / min).log10().round() as i32;
                (0..=decades).map(|k| min * 10f64.powi(k)).collect()
            }
        }
    }
}

/// A mark on a curve.
pub(super) struct Point {
    pub(super) x: f64,
    pub(super) y: f64,
    /// Shown when it is pointed at.
    pub(super) title: String,
}

/// Marks of one technique, joined by a line.
pub(super) struct Series {
    /// The colour's class.
    pub(super) color: usize,
    /// Larger marks: what the eye is to find first.
    pub(super) strong: bool,
    pub(super) points: Vec<Point>,
}

/// A diagram.
pub(super) struct Plot {
    pub(super) title: String,
    pub(super) x: (String, Scale),
    pub(super) y: (String, Scale),
    pub(super) series: Vec<Series>,
    /// A line across, at a value of y, with what it means.
    pub(super) mark: Option<(f64, String)>,
}

impl Plot {
    pub(super) fn svg(&self) -> String {
        let mut out = format!(
            "<svg class=\"plot\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\"><title>{}</title>\
             <text x=\"{LEFT}\" y=\"15\" class=\"head\">{}</text>",
            escape(&self.title),
            escape(&self.title)
        );
        let (right, bottom) = (WIDTH - RIGHT, HEIGHT - BOTTOM);
        let x = |value: f64| LEFT + self.x.1.place(value) * (right - LEFT);
        let y = |value: f64| bottom - self.y.1.place(value) * (bottom - TOP);
        let mut last = f64::NEG_INFINITY;
        for tick in self.x.1.ticks() {
            let at = x(tick);
            let _ = write!(out, "<path class=\"grid\" d=\"M{at:.1} {TOP}V{bottom}\"/>");
            // Names that would touch are left out.
            if at - last >= 20.0 {
                let below = bottom + 13.0;
                let _ = write!(out, "<text x=\"{at:.1}\" y=\"{below}\" class=\"mid\">{}</text>", label(tick));
                last = at;
            }
        }
        for tick in self.y.1.ticks() {
            let at = y(tick);
            let _ = write!(
                out,
                "<path class=\"grid\" d=\"M{LEFT} {at:.1}H{right}\"/><text x=\"{}\" y=\"{:.1}\" class=\"end\">{}</text>",
                LEFT - 4.0,
                at + 3.5,
                label(tick)
            );
        }
        let _ = write!(
            out,
            "<text x=\"{right}\" y=\"{}\" class=\"end\">{}</text>\
             <text transform=\"translate(11 {bottom}) rotate(-90)\">{}</text>",
            HEIGHT - 8.0,
            escape(&self.x.0),
            escape(&self.y.0)
        );
        if let Some((value, meaning)) = &self.mark {
            let at = y(*value);
            let _ = write!(
                out,
                "<path class=\"mark\" d=\"M{LEFT} {at:.1}H{right}\"><title>{}</title></path>",
                escape(meaning)
            );
        }
        for series in &self.series {
            let _ = write!(out, "<g class=\"c{}\">", series.color);
            if series.points.len() > 1 {
                let mut path = String::new();
                for (i, point) in series.points.iter().enumerate() {
                    let _ = write!(path, "{}{:.1} {:.1}", if i == 0 { "M" } else { "L" }, x(point.x), y(point.y));
                }
                let _ = write!(out, "<path d=\"{path}\"/>");
            }
            let radius = if series.strong { 4.5 } else { 2.7 };
            for point in &series.points {
                let _ = write!(
                    out,
                    "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius}\"><title>{}</title></circle>",
                    x(point.x),
                    y(point.y),
                    escape(&point.title)
                );
            }
            out += "</g>";
        }
        out + "</svg>"
    }
}

fn label(tick: f64) -> String {
    if tick >= 1.0 && tick.fract() == 0.0 { format!("{tick:.0}") } else { short(tick).trim_end_matches('0').to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_lies_inside_whatever_it_is() {
        let scale = Scale::log_around([0.02, 35.0, f64::NAN, f64::INFINITY].into_iter(), 1e-3);
        assert_eq!(scale.ticks().len(), 5);
        for value in [0.0, -1.0, 0.02, 1e9, f64::NAN, f64::INFINITY] {
            assert!((0.0..=1.0).contains(&scale.place(value)), "{value}");
        }
        assert!((scale.place(1.0) - 0.5).abs() < 1e-9);
        assert!(Scale::log_around(std::iter::empty(), 1e-3).ticks().len() >= 2);
    }

    #[test]
    fn a_diagram_is_well_formed() {
        let point = Point { x: 3.0, y: f64::NAN, title: "a < b & c".to_owned() };
        let plot = Plot {
            title: "<T>".to_owned(),
            x: ("x".to_owned(), Scale::Linear { max: 90.0, ticks: vec![0.0, 45.0] }),
            y: ("y".to_owned(), Scale::Log { min: 0.1, max: 10.0 }),
            series: vec![Series { color: 2, strong: true, points: vec![point] }],
            mark: Some((1.0, "m".to_owned())),
        };
        let svg = plot.svg();
        let document = roxmltree::Document::parse(&svg).unwrap();
        assert_eq!(document.descendants().filter(|node| node.has_tag_name("circle")).count(), 1);
        assert!(!svg.contains("NaN"));
    }
}
