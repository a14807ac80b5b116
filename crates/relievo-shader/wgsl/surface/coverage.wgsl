//! How much of a pixel a relief covers that ends inside it: what multisampling does for a polygon's border, for the border
//! that the march finds.
//!
//! Gives relievo_coverage.
//! Needs nothing else.
//! #import visible_plane

// Where the four samples lie, in pixels from the middle.
const RELIEVO_COVERAGE_SAMPLES: u32 = 4u;
fn relievo_sample_offset(i: u32) -> vec2f {
    let x = select(select(-0.375, 0.375, i == 1u), select(-0.125, 0.125, i == 3u), i == 0u || i == 3u);
    let y = select(select(-0.375, 0.375, i == 3u), select(-0.125, 0.125, i == 2u), i == 1u || i == 2u);
    return vec2f(x, y);
}

fn relievo_coverage(in: RelievoVertexOut) -> RelievoCoverage {
    let point = relievo_visible_point(in, 1.0);
    if !RELIEVO_SMOOTHS_EDGES || !RELIEVO_TECHNIQUE_MARCHES || point.options.bounded == 0u {
        return RelievoCoverage(point, select(0.0, 1.0, point.seen));
    }
    let footprint = relievo_pixel_footprint(point.at, in.position, point.polygon);
    let reach = abs(footprint.dx) + abs(footprint.dy);
    let ray = relievo_tangent_ray(point.at, in.uv, point.to_eye);
    let floor = relievo_uv_on_lid(in.uv, relievo_ray_slope(ray), point.options) + relievo_ray_slope(ray);
    let bounds = point.options.bounds;
    // A ray that comes to the floor inside the bounds cannot miss.
    if point.seen && relievo_in_bounds(vec4f(bounds.xy + reach, bounds.zw - reach), floor) {
        return RelievoCoverage(point, 1.0);
    }
    // Where on the picture the polygon's data are: at a border not in the pixel's middle.
    let offset = in.position - relievo_view.eye;
    let side = vec2f(dot(offset, relievo_view.right), dot(offset, relievo_view.up));
    let ndc = side / select(dot(offset, relievo_view.forward), 1.0, relievo_view.parallel != 0u) + relievo_view.jitter;
    let middle = vec2f(in.clip.x * relievo_view.pixel.x - 1.0, 1.0 - in.clip.y * relievo_view.pixel.y);
    let off = (ndc - middle) / vec2f(relievo_view.pixel.x, -relievo_view.pixel.y);
    let eye = relievo_view_ray(in.position);
    var found = point;
    var seen = 0.0;
    var all = 0.0;
    for (var i = 0u; i < RELIEVO_COVERAGE_SAMPLES; i++) {
        let step = relievo_sample_offset(i) - off;
        let uv = in.uv + footprint.dx * step.x + footprint.dy * step.y;
        // Beside the polygon its own samples decide; a relief that rises above it may be seen from there.
        if relievo_lid_offset(point.options) == 0.0 && !relievo_in_bounds(bounds, uv) {
            continue;
        }
        all += 1.0;
        let other = relievo_visible_at(point, eye, uv, 1.0);
        if other.seen {
            seen += 1.0;
            if !found.seen {
                found = other;
            }
        }
    }
    if all == 0.0 {
        return RelievoCoverage(point, select(0.0, 1.0, point.seen));
    }
    return RelievoCoverage(found, seen / all);
}
