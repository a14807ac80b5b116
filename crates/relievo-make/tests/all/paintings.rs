//! Stroke files and SVG drawings, right ones and wrong ones.

use proptest::prelude::*;
use relievo_make::paint::{Brush, Profile, paint, strokes_from_file, strokes_from_svg};
use relievo_map::Grid;

const FILE: &str = r#"
width = 0.02
depth = -0.4
profile = "sharp"
taper = true
[[strokes]]
points = [[0.1, 0.2], [0.5, 0.4]]
[[strokes]]
points = [[0.9, 0.9], [1.2, 0.8]]
width = 0.05
jitter = 0.01
"#;

const SVG: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 100">
  <g stroke="black" stroke-width="4" transform="translate(10 0)">
    <path d="M10,10 C40,10 60,40 90,50 z"/>
    <line x1="0" y1="0" x2="100" y2="50" style="stroke-width:2;stroke-opacity:0.5"/>
    <polyline points="0,0 10,10 20,0" stroke="none"/>
    <g transform="scale(2)"><circle cx="20" cy="20" r="10"/></g>
  </g>
  <rect x="1" y="1" width="10" height="10"/>
  <text>words</text>
</svg>"#;

#[test]
fn a_stroke_file_gives_its_strokes() {
    let strokes = strokes_from_file("s.toml", FILE, &Brush::default()).unwrap();
    assert_eq!(strokes.len(), 2);
    assert_eq!(strokes[0].points, [[0.1, 0.2], [0.5, 0.4]]);
    let brush = strokes[0].brush;
    assert_eq!((brush.width, brush.depth, brush.profile, brush.taper), (0.02, -0.4, Profile::Sharp, true));
    assert_eq!((strokes[1].brush.width, strokes[1].brush.jitter), (0.05, 0.01));
}

#[test]
fn a_drawing_gives_what_has_a_stroke() {
    let strokes = strokes_from_svg("d.svg", SVG, &Brush { depth: -0.6, ..Brush::default() }).unwrap();
    // A path, a line and a circle; not the polyline, nor the rectangle.
    assert_eq!(strokes.len(), 3);
    let close = |a: [f32; 2], b: [f32; 2]| (a[0] - b[0]).abs() < 1e-4 && (a[1] - b[1]).abs() < 1e-4;
    assert!(close(strokes[0].points[0], [0.1, 0.1]) && close(*strokes[0].points.last().unwrap(), [0.1, 0.1]));
    assert!(strokes[0].points.len() > 8, "a curve is many lines");
    assert!(close(strokes[1].points[1], [0.55, 0.5]));
    assert!((strokes[1].brush.depth + 0.3).abs() < 1e-6);
    // 4 of 200 units; and scaled by two.
    assert!((strokes[0].brush.width - 0.02).abs() < 1e-6);
    assert!((strokes[2].brush.width / strokes[0].brush.width - 2.0).abs() < 1e-4);
    let right = strokes[2].points.iter().map(|p| p[0]).fold(0.0, f32::max);
    assert!((right - (10.0 + 2.0 * 30.0) / 200.0).abs() < 1e-3, "{right}");
}

#[test]
fn mistakes_are_named() {
    let file = |text: &str| strokes_from_file("s.toml", text, &Brush::default()).unwrap_err().to_string();
    for (text, says) in [
        ("", "the stroke file needs strokes"),
        ("strokes = 3", "s.toml:1: strokes must be tables"),
        ("strokes = []", "s.toml:1: there are no strokes"),
        ("[[strokes]]\n", "s.toml:1: [[strokes]] needs points"),
        ("[[strokes]]\npoints = []", "s.toml:2: points must be pairs"),
        ("[[strokes]]\npoints = [[1]]", "s.toml:2: points must be pairs"),
        ("[[strokes]]\npoints = [[nan, 0]]", "s.toml:2: points must be pairs"),
        ("[[strokes]]\npoints = [[1e9, 0]]", "s.toml:2: points must be pairs"),
        ("width = 7\n[[strokes]]\npoints = [[0, 0]]", "s.toml:1: width in the stroke file must be a number from"),
        ("widht = 0.1\n[[strokes]]\npoints = [[0, 0]]", "did you mean \"width\"?"),
        ("taper = 3\n[[strokes]]\npoints = [[0, 0]]", "s.toml:1: taper"),
    ] {
        assert!(file(text).contains(says), "{text}\n  {}\n  {says}", file(text));
    }
    let svg = |text: &str| strokes_from_svg("d.svg", text, &Brush::default()).unwrap_err().to_string();
    let inside = |text: &str| svg(&format!("<svg viewBox='0 0 9 9' stroke='red'>{text}</svg>"));
    for (said, says) in [
        (svg(""), "d.svg: this is not an SVG drawing"),
        (svg("<html/>"), "it begins with <html>"),
        (svg("<svg/>"), "no size"),
        (svg("<svg viewBox='0 0 0 9'/>"), "no size"),
        (svg("<svg viewBox='0 0 9 9'><path d='M0 0L1 1'/></svg>"), "nothing in the drawing has a stroke"),
        (inside(""), "nothing in the drawing has a stroke"),
        (inside("<path d='M0 0 L hello'/>"), "cannot be read"),
        (inside("<path d='M0 0 L1 1' transform='twist(3)'/>"), "the transform \"twist(3)\""),
        (inside("<polyline points='1,2,x'/>"), "the points \"1,2,x\""),
        (inside("<path d='M0 0 L1e8 1'/>"), "reaches over"),
        (inside("<path d='M0 0 L1 1' stroke-width='100'/>"), "stroke-width"),
        // Found by fuzzing: an arc of that size was cut into more curves than memory holds.
        (inside("<path d='M1 1h8e70v5A5 3 10 0 1 4 4z'/>"), "has the number 8e70"),
        (svg(&format!("<svg viewBox='0 0 9 9'>{}{}</svg>", "<g>".repeat(200), "</g>".repeat(200))), "nested over 64"),
        (svg("<!DOCTYPE a [<!ENTITY a 'b'>]><svg viewBox='0 0 9 9'>&a;</svg>"), "not an SVG drawing"),
    ] {
        assert!(said.contains(says), "{said}\n  {says}");
    }
}

#[test]
fn strokes_that_would_take_hours_or_all_memory_are_refused() {
    // Across a hundred repeats and back, a hundred times.
    let pairs = "[-99, -99], [99, 99], ".repeat(100);
    let file = |text: &str| strokes_from_file("s.toml", text, &Brush::default());
    let long = format!("jitter = 0.01\n[[strokes]]\npoints = [{pairs}]\n");
    let said = file(&long).unwrap_err().to_string();
    assert!(said.starts_with("s.toml:2: the strokes are 557") && said.contains("times as long as the map"), "{said}");
    let dots = "[0.5, 0.5], ".repeat(2000);
    let said = file(&format!("[[strokes]]\nwidth = 1\npoints = [{dots}]\n")).unwrap_err().to_string();
    assert!(said.contains("the strokes cover the map 2000 times over"), "{said}");
    // What is long but not too long is painted, on few repeats at a time.
    let strokes = file("[[strokes]]\npoints = [[-99, -99], [99, 99]]\n").unwrap();
    let painted = paint(&Grid::filled(64, 64, 0.5), &strokes, true, 0);
    // Thinner than a texel.
    assert!(*painted.get(20, 20) < 0.45 && *painted.get(40, 8) == 0.5, "{}", painted.get(20, 20));
    let drawing = format!(
        "<svg viewBox='0 0 1 1' stroke='red' stroke-width='0.01'><path d='M0 0{}'/></svg>",
        "H90H-90".repeat(100)
    );
    let said = strokes_from_svg("d.svg", &drawing, &Brush::default()).unwrap_err().to_string();
    assert!(said.contains("times as long as the map"), "{said}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn mutated_files_and_drawings_are_refused_or_read(
        drawing in any::<bool>(),
        at in 0.0..1.0f64,
        length in 0..30usize,
        by in "[-MLCAQTHVZmz0-9e., <>/=\"'\\[\\]a-zé]{0,14}",
    ) {
        let text = if drawing { SVG } else { FILE };
        let start = (at * text.len() as f64) as usize;
        let end = (start + length).min(text.len());
        let mutated = format!("{}{by}{}", &text[..start], &text[end..]);
        let strokes = if drawing {
            strokes_from_svg("d.svg", &mutated, &Brush::default())
        } else {
            strokes_from_file("s.toml", &mutated, &Brush::default())
        };
        if let Ok(strokes) = strokes {
            let painted = paint(&Grid::filled(8, 6, 0.5), &strokes, at < 0.5, 1);
            prop_assert!(painted.texels().iter().all(|h| h.is_finite()));
        }
    }

    #[test]
    fn any_path_is_refused_or_read(d in "[MLCSQTAHVZmlcsqtahvz0-9e+., -]{0,80}") {
        let _ = strokes_from_svg("d.svg", &format!("<svg viewBox='0 0 9 9' stroke='red'><path d='{d}'/></svg>"), &Brush::default());
    }
}
