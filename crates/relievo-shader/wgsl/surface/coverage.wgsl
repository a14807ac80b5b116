//! How much of a pixel a relief covers that ends inside it: what multisampling does for a polygon's border, for the border
//! that the march finds.
//!
//! Gives Covered, covered.
//! Needs nothing else.
//! #import visible

struct Covered {
    point: Visible,
    // Of the samples that lie on the polygon, those that see the relief.
    share: f32,
}

// Where the four samples lie, in pixels from the middle.
const SAMPLES: u32 = 4u;
fn sample_place(i: u32) -> vec2f {
    let x = select(select(-0.375, 0.375, i == 1u), select(-0.125, 0.125, i == 3u), i == 0u || i == 3u);
    let y = select(select(-0.375, 0.375, i == 3u), select(-0.125, 0.125, i == 2u), i == 1u || i == 2u);
    return vec2f(x, y);
}

fn covered(in: VertexOut) -> Covered {
    let point = visible(in, 1.0);
    if !SMOOTHS_EDGES || !TECHNIQUE_MARCHES || point.how.bounded == 0u {
        return Covered(point, select(0.0, 1.0, point.seen));
    }
    let footprint = pixel_footprint(point.at, in.position, point.polygon);
    let reach = abs(footprint.dx) + abs(footprint.dy);
    let ray = tangent_ray(point.at, in.uv, point.toward);
    let floor = uv_on_lid(in.uv, ray_slope(ray), point.how) + ray_slope(ray);
    let bounds = point.how.bounds;
    // A ray that comes to the floor inside the bounds cannot miss.
    if point.seen && in_bounds(vec4f(bounds.xy + reach, bounds.zw - reach), floor) {
        return Covered(point, 1.0);
    }
    // Where on the picture the polygon's data are: at a border not in the pixel's middle.
    let way = in.position - view.eye;
    let place = vec2f(dot(way, view.right), dot(way, view.up)) / dot(way, view.forward) + view.shift;
    let middle = vec2f(in.clip.x * view.pixel.x - 1.0, 1.0 - in.clip.y * view.pixel.y);
    let off = (place - middle) / vec2f(view.pixel.x, -view.pixel.y);
    let eye = sight(in.position);
    var found = point;
    var seen = 0.0;
    var all = 0.0;
    for (var i = 0u; i < SAMPLES; i++) {
        let step = sample_place(i) - off;
        let uv = in.uv + footprint.dx * step.x + footprint.dy * step.y;
        // Beside the polygon its own samples decide; a relief that rises above it may be seen from there.
        if march_rise(point.how) == 0.0 && !in_bounds(bounds, uv) {
            continue;
        }
        all += 1.0;
        let other = seen_through(point, eye, uv, 1.0);
        if other.seen {
            seen += 1.0;
            if !found.seen {
                found = other;
            }
        }
    }
    if all == 0.0 {
        return Covered(point, select(0.0, 1.0, point.seen));
    }
    return Covered(found, seen / all);
}
