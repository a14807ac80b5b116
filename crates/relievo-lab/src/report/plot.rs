//! Curves as SVG. Colours come from the page's style, by class.

use maud::{Markup, html};

use super::format::short;

const WIDTH: f64 = 340.0;
const HEIGHT: f64 = 250.0;
const LEFT: f64 = 46.0;
const RIGHT: f64 = 10.0;
const TOP: f64 = 26.0;
const BOTTOM: f64 = 38.0;

/// The scale of an axis.
pub(super) enum Scale {
    /// From 0 to `max`, with these ticks.
    Linear { max: f64, ticks: Vec<f64> },
    /// Logarithmic, in decades; values are clamped to the range.
    Log { min: f64, max: f64 },
}

impl Scale {
    /// Creates a logarithmic scale around the values above `floor`.
    pub(super) fn log_around(values: impl Iterator<Item = f64>, floor: f64) -> Self {
        let (mut min, mut max) = (f64::INFINITY, floor);
        for value in values.filter(|value| value.is_finite()) {
            (min, max) = (min.min(value), max.max(value));
        }
        let min = 10f64.powf(min.max(floor).min(max).log10().floor());
        let max = 10f64.powf(max.log10().ceil()).max(min * 10.0);
        Self::Log { min, max }
    }

    /// The position of a value between the ends, 0 to 1.
    fn fraction(&self, value: f64) -> f64 {
        let fraction = match self {
            Self::Linear { max, .. } => value / max,
            Self::Log { min, max } => (value.max(*min) / min).ln() / (max / min).ln(),
        };
        if fraction.is_nan() { 0.0 } else { fraction.clamp(0.0, 1.0) }
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

/// A point of a curve.
pub(super) struct Point {
    pub(super) x: f64,
    pub(super) y: f64,
    /// The tooltip.
    pub(super) title: String,
}

/// Points of one technique, joined by a line.
pub(super) struct Series {
    /// The CSS class of the colour.
    pub(super) class: String,
    /// True for larger points, to stand out.
    pub(super) strong: bool,
    pub(super) points: Vec<Point>,
}

/// A diagram.
pub(super) struct Plot {
    pub(super) title: String,
    /// Label and scale of the axis.
    pub(super) x: (String, Scale),
    pub(super) y: (String, Scale),
    pub(super) series: Vec<Series>,
    /// A horizontal line at a value of y, with its tooltip.
    pub(super) mark: Option<(f64, String)>,
}

impl Plot {
    /// Renders the plot as SVG.
    pub(super) fn svg(&self) -> Markup {
        let (right, bottom) = (WIDTH - RIGHT, HEIGHT - BOTTOM);
        html! {
            svg.plot viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } role="img" {
                title { (self.title) }
                text x=(LEFT) y="15" class="head" { (self.title) }
                (self.grid())
                text x=(right) y=(HEIGHT - 8.0) class="end" { (self.x.0) }
                text transform={ "translate(11 " (bottom) ") rotate(-90)" } { (self.y.0) }
                @if let Some((value, meaning)) = &self.mark {
                    path.mark d={ "M" (LEFT) " " (one_digit(self.y_at(*value))) "H" (right) } { title { (meaning) } }
                }
                @for series in &self.series { (self.curve(series)) }
            }
        }
    }

    /// Position of a value along x, in pixels.
    fn x_at(&self, value: f64) -> f64 {
        LEFT + self.x.1.fraction(value) * (WIDTH - RIGHT - LEFT)
    }

    /// Position of a value along y, in pixels.
    fn y_at(&self, value: f64) -> f64 {
        HEIGHT - BOTTOM - self.y.1.fraction(value) * (HEIGHT - BOTTOM - TOP)
    }

    /// Grid lines with the labels of their ticks.
    fn grid(&self) -> Markup {
        let (right, bottom) = (WIDTH - RIGHT, HEIGHT - BOTTOM);
        // Labels that would touch are left out.
        let mut last = f64::NEG_INFINITY;
        let columns = self.x.1.ticks().into_iter().map(|tick| {
            let at = self.x_at(tick);
            let labelled = at - last >= 20.0;
            last = if labelled { at } else { last };
            (tick, at, labelled)
        });
        html! {
            @for (tick, at, labelled) in columns {
                path.grid d={ "M" (one_digit(at)) " " (TOP) "V" (bottom) } {}
                @if labelled { text x=(one_digit(at)) y=(bottom + 13.0) class="mid" { (label(tick)) } }
            }
            @for tick in self.y.1.ticks() {
                @let at = self.y_at(tick);
                path.grid d={ "M" (LEFT) " " (one_digit(at)) "H" (right) } {}
                text x=(LEFT - 4.0) y=(one_digit(at + 3.5)) class="end" { (label(tick)) }
            }
        }
    }

    /// The line and the points of a series.
    fn curve(&self, series: &Series) -> Markup {
        let at = |point: &Point| [self.x_at(point.x), self.y_at(point.y)].map(one_digit);
        let line = series.points.iter().map(|point| at(point).join(" ")).collect::<Vec<_>>().join("L");
        let radius: f64 = if series.strong { 4.5 } else { 2.7 };
        html! {
            g class=(series.class) {
                @if series.points.len() > 1 { path d={ "M" (line) } {} }
                @for point in &series.points {
                    @let [x, y] = at(point);
                    circle cx=(x) cy=(y) r=(radius) { title { (point.title) } }
                }
            }
        }
    }
}

/// A coordinate with one digit after the point.
fn one_digit(x: f64) -> String {
    format!("{x:.1}")
}

/// The label of a tick.
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
            assert!((0.0..=1.0).contains(&scale.fraction(value)), "{value}");
        }
        assert!((scale.fraction(1.0) - 0.5).abs() < 1e-9);
        assert!(Scale::log_around(std::iter::empty(), 1e-3).ticks().len() >= 2);
    }

    #[test]
    fn a_diagram_is_well_formed() {
        let point = Point { x: 3.0, y: f64::NAN, title: "a < b & c".to_owned() };
        let plot = Plot {
            title: "<T>".to_owned(),
            x: ("x".to_owned(), Scale::Linear { max: 90.0, ticks: vec![0.0, 45.0] }),
            y: ("y".to_owned(), Scale::Log { min: 0.1, max: 10.0 }),
            series: vec![Series { class: "c2".to_owned(), strong: true, points: vec![point] }],
            mark: Some((1.0, "m".to_owned())),
        };
        let svg = plot.svg().into_string();
        let document = roxmltree::Document::parse(&svg).unwrap();
        assert_eq!(document.descendants().filter(|node| node.has_tag_name("circle")).count(), 1);
        assert!(!svg.contains("NaN"));
    }
}
