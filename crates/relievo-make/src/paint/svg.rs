//! Reader of SVG drawings.

use kurbo::{Affine, BezPath, Circle, Ellipse, PathEl, Point, Rect, Shape};
use relievo_toml::shorten;
use roxmltree::{Document, Node, ParsingOptions};

use super::error::PaintError;
use super::stroke::{Brush, Stroke, check_work};

/// The longest drawing, in bytes.
const MAX_BYTES: usize = 1 << 24;
/// The largest number in paths, transforms and the view.
const MAX_NUMBER: f64 = 1e9;
/// The deepest nesting of elements.
const MAX_DEPTH: usize = 64;

/// Reads the lines of an SVG drawing as strokes; `name` stands for it in errors.
///
/// The `viewBox` (or width and height) becomes one repeat. Paths, lines, polylines, polygons, rectangles, circles and
/// ellipses are taken with their transforms; `stroke-width` is the width, `stroke-opacity` (and `opacity`) a factor on the
/// depth, and everything else comes from `brush`. Elements with `stroke="none"`, text, pictures, clips and style sheets are
/// ignored.
///
/// # Errors
/// If it is no SVG, has no size, a path or a transform cannot be read, or nothing in it has a stroke.
pub fn strokes_from_svg(name: &str, text: &str, brush: &Brush) -> Result<Vec<Stroke>, PaintError> {
    let failed = |message: String| PaintError::Svg { file: name.to_owned(), message };
    if text.len() > MAX_BYTES {
        return Err(failed(format!("the drawing has over {} MiB; simplify it", MAX_BYTES >> 20)));
    }
    // Entities could expand without end; drawings need none.
    let options =
        ParsingOptions { allow_dtd: !text.contains("<!ENTITY"), nodes_limit: 1 << 20, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options)
        .map_err(|error| failed(format!("this is not an SVG drawing: {}", shorten(&error.to_string()))))?;
    let root = document.root_element();
    if root.tag_name().name() != "svg" {
        return Err(failed(format!(
            "this is not an SVG drawing: it begins with <{}>",
            shorten(root.tag_name().name())
        )));
    }
    let [x, y, w, h] = view(&root).ok_or_else(|| {
        failed("the drawing has no size; give <svg> a viewBox, as in viewBox=\"0 0 100 100\"".to_owned())
    })?;
    let mut reader = Reader { strokes: Vec::new(), points: 0, aspect: h / w };
    let to_uv = Affine::scale_non_uniform(1.0 / w, 1.0 / h) * Affine::translate((-x, -y));
    let style = Style { stroke: false, width: 1.0, depth: f64::from(brush.depth) };
    reader.element(root, to_uv, style, brush, 0).map_err(failed)?;
    if reader.strokes.is_empty() {
        return Err(failed(
            "nothing in the drawing has a stroke; give lines a stroke, as in stroke=\"black\"".to_owned(),
        ));
    }
    check_work(&reader.strokes).map_err(failed)?;
    Ok(reader.strokes)
}

/// Returns the view box: x, y, width and height.
fn view(root: &Node<'_, '_>) -> Option<[f64; 4]> {
    let number = |text: &str| text.trim().trim_end_matches("px").parse::<f64>().ok().filter(|n| n.abs() < MAX_NUMBER);
    let view = match root.attribute("viewBox") {
        Some(text) => {
            let numbers: Vec<f64> = text
                .split([' ', ',', '\n', '\t'])
                .filter(|part| !part.is_empty())
                .map(number)
                .collect::<Option<_>>()?;
            <[f64; 4]>::try_from(numbers).ok()?
        }
        None => [0.0, 0.0, number(root.attribute("width")?)?, number(root.attribute("height")?)?],
    };
    (view[2] > 1e-6 && view[3] > 1e-6).then_some(view)
}

/// Inherited style of an element.
#[derive(Clone, Copy)]
struct Style {
    stroke: bool,
    width: f64,
    depth: f64,
}

struct Reader {
    strokes: Vec<Stroke>,
    points: usize,
    /// Height of the drawing by its width.
    aspect: f64,
}

impl Reader {
    fn element(
        &mut self,
        node: Node<'_, '_>,
        to_uv: Affine,
        style: Style,
        brush: &Brush,
        depth: usize,
    ) -> Result<(), String> {
        if depth > MAX_DEPTH {
            return Err(format!("elements are nested over {MAX_DEPTH} deep; flatten the groups"));
        }
        let tag = node.tag_name().name();
        // What is only used elsewhere, or is no drawing.
        if ["defs", "clipPath", "mask", "marker", "pattern", "symbol", "style", "metadata"].contains(&tag) {
            return Ok(());
        }
        let to_uv = match node.attribute("transform") {
            None => to_uv,
            Some(text) => {
                to_uv
                    * transform(text)
                        .ok_or_else(|| format!("the transform \"{}\" of <{tag}> cannot be read", shorten(text)))?
            }
        };
        let style = inherited(node, style);
        if let Some(path) = outline(node, tag)?
            && style.stroke
        {
            // By the mean stretch of the transform, as a fraction of the drawing's width.
            let width = (style.width * (to_uv.determinant().abs() * self.aspect).sqrt()) as f32;
            if !width.is_finite() || width <= 0.0 || width > 1.0 {
                return Err(format!(
                    "<{tag}> has a stroke-width of {} units, which is none or wider than the drawing",
                    style.width
                ));
            }
            let brush = Brush { width, depth: (style.depth as f32).clamp(-1.0, 1.0), ..*brush };
            self.add(&(to_uv * path), &brush, tag)?;
        }
        for child in node.children().filter(Node::is_element) {
            self.element(child, to_uv, style, brush, depth + 1)?;
        }
        Ok(())
    }

    fn add(&mut self, path: &BezPath, brush: &Brush, tag: &str) -> Result<(), String> {
        let far = f64::from(Stroke::MAX_DISTANCE);
        // Before curves are cut into lines: what is far away would be cut into very many.
        let near = |p: &Point| p.x.abs() <= far && p.y.abs() <= far;
        let all_near = path.elements().iter().all(|el| match el {
            PathEl::MoveTo(p) | PathEl::LineTo(p) => near(p),
            PathEl::QuadTo(a, b) => near(a) && near(b),
            PathEl::CurveTo(a, b, c) => near(a) && near(b) && near(c),
            PathEl::ClosePath => true,
        });
        if !all_near {
            return Err(format!("<{tag}> reaches over {far} times the drawing's size beyond it"));
        }
        let mut points: Vec<[f32; 2]> = Vec::new();
        let mut lines = Vec::new();
        kurbo::flatten(path, 2e-4, |el| match el {
            PathEl::MoveTo(p) => lines.push(std::mem::replace(&mut points, vec![[p.x as f32, p.y as f32]])),
            PathEl::LineTo(p) => points.push([p.x as f32, p.y as f32]),
            PathEl::ClosePath => points.extend(points.first().copied()),
            _ => {}
        });
        lines.push(points);
        for points in lines.into_iter().filter(|points| !points.is_empty()) {
            self.points += points.len();
            if self.points > Stroke::MAX_POINTS {
                return Err(format!("the drawing has over {} points; simplify it", Stroke::MAX_POINTS));
            }
            self.strokes.push(Stroke { points, brush: *brush });
        }
        Ok(())
    }
}

/// Returns a property from the style attribute or the attribute of its name.
fn property<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    let style = node.attribute("style").unwrap_or_default();
    let styled = style.split(';').filter_map(|pair| pair.split_once(':')).find(|(key, _)| key.trim() == name);
    styled.map(|(_, value)| value.trim()).or_else(|| node.attribute(name))
}

fn inherited(node: Node<'_, '_>, above: Style) -> Style {
    let number =
        |name: &str| property(node, name)?.trim_end_matches("px").parse::<f64>().ok().filter(|n| n.is_finite());
    let share = |name: &str| number(name).unwrap_or(1.0).clamp(0.0, 1.0);
    Style {
        stroke: property(node, "stroke").map_or(above.stroke, |paint| paint != "none"),
        width: number("stroke-width").unwrap_or(above.width),
        depth: above.depth * share("opacity") * share("stroke-opacity"),
    }
}

/// Returns the outline of an element; `None` for those that have none.
fn outline(node: Node<'_, '_>, tag: &str) -> Result<Option<BezPath>, String> {
    let number = |name: &str| {
        node.attribute(name)
            .and_then(|text| text.trim_end_matches("px").parse::<f64>().ok())
            .filter(|n| n.is_finite())
            .unwrap_or(0.0)
    };
    Ok(Some(match tag {
        "path" => {
            let text = node.attribute("d").unwrap_or_default();
            check_numbers(text).map_err(|error| format!("the path \"{}\" {error}", shorten(text)))?;
            BezPath::from_svg(text)
                .map_err(|error| format!("the path \"{}\" cannot be read: {error}", shorten(text)))?
        }
        "line" => {
            let mut path = BezPath::new();
            path.move_to((number("x1"), number("y1")));
            path.line_to((number("x2"), number("y2")));
            path
        }
        "polyline" | "polygon" => {
            let text = node.attribute("points").unwrap_or_default();
            let numbers: Option<Vec<f64>> = text
                .split([' ', ',', '\n', '\t', '\r'])
                .filter(|part| !part.is_empty())
                .map(|part| part.parse().ok().filter(|n: &f64| n.is_finite()))
                .collect();
            let numbers =
                numbers.ok_or_else(|| format!("the points \"{}\" of <{tag}> cannot be read", shorten(text)))?;
            let mut path = BezPath::new();
            for (k, pair) in numbers.chunks_exact(2).enumerate() {
                if k == 0 { path.move_to((pair[0], pair[1])) } else { path.line_to((pair[0], pair[1])) }
            }
            if tag == "polygon" && !path.elements().is_empty() {
                path.close_path();
            }
            path
        }
        "rect" => {
            let (x, y) = (number("x"), number("y"));
            Rect::new(x, y, x + number("width"), y + number("height")).to_path(0.01)
        }
        "circle" => {
            Circle::new((number("cx"), number("cy")), number("r").abs()).to_path(1e-3 * number("r").abs().max(1e-6))
        }
        "ellipse" => {
            let radii = (number("rx").abs(), number("ry").abs());
            Ellipse::new((number("cx"), number("cy")), radii, 0.0).to_path(1e-3 * radii.0.max(radii.1).max(1e-6))
        }
        _ => return Ok(None),
    }))
}

/// Refuses a path with huge numbers: an arc between points that far apart would be cut into more curves than fit memory.
fn check_numbers(path: &str) -> Result<(), String> {
    use svgtypes::PathSegment as Segment;
    for segment in svgtypes::PathParser::from(path) {
        let numbers = match segment.map_err(|error| format!("cannot be read: {error}"))? {
            Segment::MoveTo { x, y, .. } | Segment::LineTo { x, y, .. } | Segment::SmoothQuadratic { x, y, .. } => {
                [x, y, 0.0, 0.0, 0.0, 0.0]
            }
            Segment::HorizontalLineTo { x: n, .. } | Segment::VerticalLineTo { y: n, .. } => {
                [n, 0.0, 0.0, 0.0, 0.0, 0.0]
            }
            Segment::CurveTo { x1, y1, x2, y2, x, y, .. } => [x1, y1, x2, y2, x, y],
            Segment::SmoothCurveTo { x2: x1, y2: y1, x, y, .. } | Segment::Quadratic { x1, y1, x, y, .. } => {
                [x1, y1, x, y, 0.0, 0.0]
            }
            Segment::EllipticalArc { rx, ry, x, y, .. } => [rx, ry, x, y, 0.0, 0.0],
            Segment::ClosePath { .. } => continue,
        };
        if let Some(n) = numbers.into_iter().find(|n| !(n.abs() < MAX_NUMBER)) {
            return Err(format!("has the number {n:e}; {MAX_NUMBER:e} is the largest"));
        }
    }
    Ok(())
}

/// Parses a list of transforms, as their product.
fn transform(text: &str) -> Option<Affine> {
    let t: svgtypes::Transform = text.parse().ok()?;
    let all = [t.a, t.b, t.c, t.d, t.e, t.f];
    all.iter().all(|n| n.abs() < MAX_NUMBER).then(|| Affine::new(all))
}
