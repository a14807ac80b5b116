//! All colours of the lab: the heat ramp, contact sheets, and the report.

use relievo_map::{Grid, linear_to_srgb};

/// The colours of contact sheets.
pub(crate) mod sheet {
    pub(crate) const BACKGROUND: [u8; 3] = [19, 21, 26];
    pub(crate) const CARD: [u8; 3] = [31, 34, 42];
    /// Background of pictures smaller than their neighbours.
    pub(crate) const MAT: [u8; 3] = [13, 14, 18];
    pub(crate) const ACCENT: [u8; 3] = [240, 150, 84];
    pub(crate) const BRIGHT: [u8; 3] = [240, 242, 247];
    pub(crate) const PLAIN: [u8; 3] = [178, 186, 201];
    pub(crate) const DIM: [u8; 3] = [140, 148, 165];
}

/// The colours of the report, as CSS.
pub(crate) mod report {
    use std::fmt::Write;

    use crate::colors::heat_color;

    /// A CSS variable with its values for light and dark colour schemes.
    struct Variable {
        name: &'static str,
        light: &'static str,
        dark: &'static str,
    }

    const fn variable(name: &'static str, light: &'static str, dark: &'static str) -> Variable {
        Variable { name, light, dark }
    }

    const PAGE: [Variable; 8] = [
        variable("ink", "#1c1d21", "#e8e6e1"),
        variable("paper", "#fbfaf7", "#17181b"),
        variable("faint", "#d9d6cf", "#3a3b41"),
        variable("soft", "#6a6a72", "#a2a2ab"),
        variable("box", "#f1efe9", "#212227"),
        variable("lens", "rgba(12, 12, 14, .93)", "rgba(12, 12, 14, .93)"),
        variable("lens-bar", "rgba(0, 0, 0, .55)", "rgba(0, 0, 0, .55)"),
        variable("lens-ink", "#eee", "#eee"),
    ];

    /// Series colours by family of techniques; the position is the number of the class.
    const SERIES: [Variable; 12] = [
        variable("exact:cells", "#8a7a5c", "#c9b78c"),
        variable("normal", "#9a9aa2", "#8a8a93"),
        variable("basic", "#6fa8c9", "#8cc4e6"),
        variable("offset-limiting", "#4f86ad", "#64a3cf"),
        variable("unity-offset", "#37648a", "#4f86b5"),
        variable("steep", "#c08a2e", "#e8ae45"),
        variable("binary", "#8d9a3a", "#b5c455"),
        variable("relief", "#2f8f6b", "#4fc296"),
        variable("occlusion", "#cc4f39", "#f27a62"),
        variable("contact", "#9b5fb0", "#c48ad9"),
        variable("cone", "#1a4fd6", "#7fa2ff"),
        variable("exact", "#d0308f", "#ff7cc4"),
    ];

    /// The class of techniques without a colour of their own.
    const OTHER: Variable = variable("other", "#444", "#ccc");

    /// The CSS class of a series, by the family of its technique.
    pub(crate) fn series_class(family: &str) -> String {
        format!("c{}", SERIES.iter().position(|series| series.name == family).unwrap_or(SERIES.len()))
    }

    /// The CSS variables for both colour schemes, and the classes of the series.
    pub(crate) fn style() -> String {
        let series = || SERIES.iter().chain([&OTHER]);
        let variables = |value: fn(&Variable) -> &'static str| {
            let page = PAGE.iter().map(|variable| format!("--{}: {};", variable.name, value(variable)));
            let series = series().enumerate().map(|(i, series)| format!("--c{i}: {};", value(series)));
            page.chain(series).collect::<Vec<_>>().join(" ")
        };
        let mut css = format!(
            "\n:root {{ color-scheme: light dark; {} }}\n@media (prefers-color-scheme: dark) {{ :root {{ {} }} }}\n",
            variables(|variable| variable.light),
            variables(|variable| variable.dark)
        );
        for i in 0..series().count() {
            let _ = writeln!(css, ".c{i} {{ --c: var(--c{i}); }}");
        }
        css
    }

    /// The background of a table's cell, for a value from 0 to 1; `None` where it would not be seen.
    pub(crate) fn cell_background(heat: f64) -> Option<String> {
        let t = heat.clamp(0.0, 1.0);
        let [r, g, b] = heat_color(0.45 + 0.3 * t as f32);
        (heat > 0.005).then(|| format!("background:rgba({r},{g},{b},{:.2})", 0.15 + 0.45 * t))
    }

    #[cfg(test)]
    mod tests {
        use relievo_march::Technique;

        use super::*;

        #[test]
        fn every_technique_has_a_colour_of_its_own() {
            let mut classes: Vec<String> = Technique::ALL[1..].iter().map(|t| series_class(t.name())).collect();
            classes.push(series_class("exact:cells"));
            classes.sort();
            classes.dedup();
            assert!(
                classes.len() == Technique::ALL.len() && !classes.contains(&series_class("unknown")),
                "{classes:?}"
            );
        }
    }
}

/// The colour of NaN: a green that is nowhere on the ramp, so that it stands out.
pub const NOT_A_NUMBER: [u8; 3] = [0, 255, 128];

/// Shades of the ramp.
const SHADES: usize = 1024;

/// Hues of the ramp as Oklab (a, b), evenly spaced from the darkest to the lightest; between them runs a smooth curve.
///
/// Chosen by eye: ink blue, violet, crimson, orange, cream. Lightness is no choice: it climbs in equal steps, so that
/// equal differences look equal, also in print and to the colour-blind.
const HUES: [[f32; 2]; 7] = [
    [0.000, -0.020],
    [0.035, -0.105],
    [0.115, -0.110],
    [0.165, -0.015],
    [0.140, 0.085],
    [0.050, 0.125],
    [-0.010, 0.055],
];
const DARKEST: f32 = 0.12;
const LIGHTEST: f32 = 0.975;

/// Returns the colour of `t` on the heat ramp: from near black at 0 through violet, red and orange to cream at 1, evenly lighter all
/// the way (linear in Oklab lightness).
///
/// Values outside 0..1 take the nearest end; NaN is drawn as [`NOT_A_NUMBER`].
#[must_use]
pub fn heat_color(t: f32) -> [u8; 3] {
    if t.is_nan() {
        return NOT_A_NUMBER;
    }
    let t = t.clamp(0.0, 1.0);
    let [a, b] = hue(t);
    oklab_to_srgb([DARKEST + (LIGHTEST - DARKEST) * t, a, b]).map(|c| (c * 255.0).round() as u8)
}

/// Draws a map of values on the heat ramp: 0 is dark, `max` and more is light.
///
/// With a `max` that is not above 0, everything above 0 takes the light end.
#[must_use]
pub fn heat(map: &Grid<f32>, max: f32) -> Grid<[u8; 3]> {
    let shades: Vec<[u8; 3]> = (0..SHADES).map(|i| heat_color(i as f32 / (SHADES - 1) as f32)).collect();
    map.map(|&value| {
        if value.is_nan() {
            return NOT_A_NUMBER;
        }
        let t = if max > 0.0 { (value / max).clamp(0.0, 1.0) } else { f32::from(u8::from(value > 0.0)) };
        shades[(t * (SHADES - 1) as f32).round() as usize]
    })
}

/// Evaluates a Catmull-Rom curve through [`HUES`].
fn hue(t: f32) -> [f32; 2] {
    let last = HUES.len() - 1;
    let at = t * last as f32;
    let i = (at as usize).min(last - 1);
    let f = at - i as f32;
    let [p, q, r, s] = [HUES[i.saturating_sub(1)], HUES[i], HUES[i + 1], HUES[(i + 2).min(last)]];
    std::array::from_fn(|k| {
        let (slope_q, slope_r) = (0.5 * (r[k] - p[k]), 0.5 * (s[k] - q[k]));
        let (c2, c3) = (3.0 * (r[k] - q[k]) - 2.0 * slope_q - slope_r, 2.0 * (q[k] - r[k]) + slope_q + slope_r);
        q[k] + f * (slope_q + f * (c2 + f * c3))
    })
}

/// Converts Oklab (Björn Ottosson, 2020) to sRGB display values, clamped to the gamut.
fn oklab_to_srgb([l, a, b]: [f32; 3]) -> [f32; 3] {
    let [l, m, s] = [
        l + 0.396_337_78 * a + 0.215_803_76 * b,
        l - 0.105_561_346 * a - 0.063_854_17 * b,
        l - 0.089_484_18 * a - 1.291_485_5 * b,
    ]
    .map(|c| c * c * c);
    [
        4.076_741_7 * l - 3.307_711_6 * m + 0.230_969_94 * s,
        -1.268_438 * l + 2.609_757_4 * m - 0.341_319_4 * s,
        -0.004_196_086 * l - 0.703_418_6 * m + 1.707_614_7 * s,
    ]
    .map(|c| linear_to_srgb(c.clamp(0.0, 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use relievo_map::srgb_to_linear;

    fn oklab_lightness(rgb: [u8; 3]) -> f32 {
        let [r, g, b] = rgb.map(|c| srgb_to_linear(f32::from(c) / 255.0));
        let l = 0.412_221_46 * r + 0.536_332_55 * g + 0.051_445_995 * b;
        let m = 0.211_903_5 * r + 0.680_699_5 * g + 0.107_396_96 * b;
        let s = 0.088_302_46 * r + 0.281_718_85 * g + 0.629_978_7 * b;
        0.210_454_26 * l.cbrt() + 0.793_617_8 * m.cbrt() - 0.004_072_047 * s.cbrt()
    }

    #[test]
    fn the_ramp_grows_lighter_in_even_steps() {
        let mut before = 0.0;
        for i in 0..=32 {
            let t = i as f32 / 32.0;
            let lightness = oklab_lightness(heat_color(t));
            assert!(lightness > before, "at {t}: {lightness} after {before}");
            // Off the line only by the 8 bits and where a hue had to be clamped.
            let even = DARKEST + (LIGHTEST - DARKEST) * t;
            assert!((lightness - even).abs() < 0.012, "at {t}: {lightness} instead of {even}");
            before = lightness;
        }
    }

    #[test]
    fn neighbouring_shades_never_jump() {
        for i in 0..255 {
            let (p, q) = (heat_color(i as f32 / 255.0), heat_color((i + 1) as f32 / 255.0));
            for k in 0..3 {
                assert!(p[k].abs_diff(q[k]) <= 6, "{i}: {p:?} {q:?}");
            }
        }
    }

    #[test]
    fn values_beyond_the_ends_take_the_ends() {
        let map = Grid::new(6, 1, vec![-1.0, 0.0, 2.0, 4.0, 9.0, f32::INFINITY]).unwrap();
        let picture = heat(&map, 4.0);
        let (dark, middle, light) = (heat_color(0.0), heat_color(0.5), heat_color(1.0));
        let expected = [dark, dark, middle, light, light, light];
        for (got, want) in picture.texels().iter().zip(expected) {
            assert!((0..3).all(|k| got[k].abs_diff(want[k]) <= 1), "{got:?} {want:?}");
        }
        assert_ne!(dark, light);
    }

    #[test]
    fn nan_is_drawn_in_a_colour_of_its_own() {
        let map = Grid::new(2, 1, vec![f32::NAN, 0.3]).unwrap();
        assert_eq!(heat(&map, 1.0).texels()[0], NOT_A_NUMBER);
        for i in 0..=100 {
            let c = heat_color(i as f32 / 100.0);
            let apart: u32 = (0..3).map(|k| u32::from(c[k].abs_diff(NOT_A_NUMBER[k]))).sum();
            assert!(apart > 150, "{c:?}");
        }
    }

    #[test]
    fn a_maximum_that_is_none_still_tells_zero_from_more() {
        let map = Grid::new(3, 1, vec![0.0, 1e-6, 5.0]).unwrap();
        for max in [0.0, -1.0, f32::NAN] {
            let picture = heat(&map, max);
            assert_eq!(picture.texels(), [heat_color(0.0), heat_color(1.0), heat_color(1.0)]);
        }
    }
}
