//! The march in the shell of a relief over a curved mesh: exact on any triangle, with the relief's silhouette. The same
//! curve and the same chords as relievo-march/src/shell.
//!
//! Gives RelievoPrism, RelievoShellHit, relievo_march_shell.
//! Needs what height.wgsl needs; for a field with a pyramid what descent.wgsl needs.
//! #import record
//! #import height
//! #import walk
//! #import descent

// How far a chord may be from the curve, in texels.
const RELIEVO_CHORD_ERROR: f32 = 1e-3;
// The most chords of a part of the curve: a power of two.
const RELIEVO_MOST_CHORDS: u32 = 1024u;
// The cosine between a ray and the normal of a triangle below which it counts as running along it.
const RELIEVO_ALONG: f32 = 2e-5;
// The shortest interpolated normal that is reckoned with.
const RELIEVO_SHORTEST_NORMAL: f32 = 0.05;
// The part by which a piece of the curve is continued beyond the walls, so that rounding opens no gap between neighbours.
const RELIEVO_PART_OVERLAP: f32 = 2e-5;
const RELIEVO_MOST_PARTS: u32 = 7u;

// The shell over a triangle, in scene space. Normals are those along which the relief rises; of unit length, or as interpolated.
struct RelievoPrism {
    position: array<vec3f, 3>,
    normal: array<vec3f, 3>,
    uv: array<vec2f, 3>,
    // Distance between height 0 and 1, scene units.
    depth: f32,
    // The height that lies on the triangle.
    midlevel: f32,
}

struct RelievoShellHit {
    // Distance along the ray.
    t: f32,
    // Barycentric weights of the point of the triangle below.
    weights: vec3f,
    record: RelievoRecord,
}

// A straight ray seen from the shell: at the offset e along the normals its weights are w(e)/(w.x + w.y + w.z), w(e) = w0 + w1·e + w2·e².
struct RelievoShellCurve {
    w0: vec3f,
    w1: vec3f,
    w2: vec3f,
    // Point of the ray near the triangle, and its distance from the origin.
    anchor: vec3f,
    anchor_t: f32,
    direction: vec3f,
    shortest_normal: f32,
    texels_per_unit: f32,
}

struct RelievoCurvePoint {
    offset: f32,
    weights: vec3f,
    uv: vec2f,
    height: f32,
    t: f32,
    normal: vec3f,
}

fn relievo_perp(a: vec2f, b: vec2f) -> f32 {
    return a.x * b.y - a.y * b.x;
}

fn relievo_shell_curve(prism: RelievoPrism, origin: vec3f, along: vec3f, size: vec2f) -> RelievoShellCurve {
    let middle = (prism.position[0] + prism.position[1] + prism.position[2]) / 3.0;
    let anchor_t = dot(middle - origin, along);
    let anchor = origin + along * anchor_t;
    let e1 = prism.position[1] - prism.position[0];
    let e2 = prism.position[2] - prism.position[0];
    let across = cross(e1, e2);
    let area = max(length(across), 1e-30);
    var direction = along;
    let cos = dot(direction, across);
    if abs(cos) < RELIEVO_ALONG * area {
        direction += across * (select(-2.0, 2.0, cos >= 0.0) * RELIEVO_ALONG / area);
    }
    // Two directions at right angles to the ray (Duff et al. 2017).
    let s = select(-1.0, 1.0, direction.z >= 0.0);
    let a = -1.0 / (s + direction.z);
    let b = direction.x * direction.y * a;
    let right = vec3f(1.0 + s * direction.x * direction.x * a, s * b, -s * direction.x);
    let up = vec3f(b, s + direction.y * direction.y * a, -direction.y);
    var p: array<vec2f, 3>;
    var n: array<vec2f, 3>;
    for (var k = 0; k < 3; k++) {
        let corner = prism.position[k] - anchor;
        p[k] = vec2f(dot(corner, right), dot(corner, up));
        n[k] = vec2f(dot(prism.normal[k], right), dot(prism.normal[k], up));
    }
    let w0 = vec3f(relievo_perp(p[1], p[2]), relievo_perp(p[2], p[0]), relievo_perp(p[0], p[1]));
    let w1 = vec3f(
        relievo_perp(p[1], n[2]) + relievo_perp(n[1], p[2]), relievo_perp(p[2], n[0]) + relievo_perp(n[2], p[0]),
        relievo_perp(p[0], n[1]) + relievo_perp(n[0], p[1]));
    let w2 = vec3f(relievo_perp(n[1], n[2]), relievo_perp(n[2], n[0]), relievo_perp(n[0], n[1]));
    // The gradients of u and v on the triangle.
    let g1 = cross(e2, across);
    let g2 = cross(across, e1);
    let d1 = prism.uv[1] - prism.uv[0];
    let d2 = prism.uv[2] - prism.uv[0];
    let gradient = vec2f(length(g1 * d1.x + g2 * d2.x), length(g1 * d1.y + g2 * d2.y)) / (area * area) * size;
    return RelievoShellCurve(
        w0, w1, w2, anchor, anchor_t, direction, relievo_shortest_normal(prism), max(gradient.x, gradient.y));
}

// A lower bound of the length of the interpolated normal: |Σ λN|² = Σ λ|N|² − Σ λiλj·|Ni − Nj|², and Σ λiλj ≤ 1/3.
fn relievo_shortest_normal(prism: RelievoPrism) -> f32 {
    let n = prism.normal;
    let shortest = min(min(dot(n[0], n[0]), dot(n[1], n[1])), dot(n[2], n[2]));
    let d0 = n[0] - n[1];
    let d1 = n[1] - n[2];
    let d2 = n[2] - n[0];
    let farthest = max(max(dot(d0, d0), dot(d1, d1)), dot(d2, d2));
    return max(sqrt(max(shortest - farthest / 3.0, 0.0)), RELIEVO_SHORTEST_NORMAL);
}

// The offsets between which the surface lies.
fn relievo_shell_offsets(prism: RelievoPrism, range: vec2f, shortest: f32) -> vec2f {
    let n = prism.normal;
    let longest = max(max(max(length(n[0]), length(n[1])), length(n[2])), RELIEVO_SHORTEST_NORMAL);
    let d = (range - prism.midlevel) * prism.depth;
    // A little room, so that heights at the ends of the range lie inside.
    let room = 1e-4 * prism.depth;
    return vec2f(
        d.x / select(longest, shortest, d.x < 0.0) - room, d.y / select(longest, shortest, d.y > 0.0) + room);
}

fn relievo_curve_point(curve: RelievoShellCurve, prism: RelievoPrism, offset: f32) -> RelievoCurvePoint {
    let w = curve.w0 + (curve.w1 + curve.w2 * offset) * offset;
    let weights = w / (w.x + w.y + w.z);
    let normal = prism.normal[0] * weights.x + prism.normal[1] * weights.y + prism.normal[2] * weights.z;
    // Relative to the anchor: the numbers stay small.
    let corners = (prism.position[0] - curve.anchor) * weights.x + (prism.position[1] - curve.anchor) * weights.y
        + (prism.position[2] - curve.anchor) * weights.z;
    return RelievoCurvePoint(
        offset,
        weights,
        prism.uv[0] * weights.x + prism.uv[1] * weights.y + prism.uv[2] * weights.z,
        prism.midlevel + offset * length(normal) / prism.depth,
        curve.anchor_t + dot(corners + normal * offset, curve.direction),
        normal,
    );
}

// How far the chord between two points is from the curve at most, in texels: with the quadratics in Bernstein form, W and
// their sum S, the weights differ by x(1 − x)·((1 − x)·A + x·B)/S(x).
fn relievo_chord_error(
    curve: RelievoShellCurve, prism: RelievoPrism, a: RelievoCurvePoint, b: RelievoCurvePoint, size: vec2f,
) -> f32 {
    let length_e = b.offset - a.offset;
    let w0 = curve.w0 + (curve.w1 + curve.w2 * a.offset) * a.offset;
    let w2 = curve.w0 + (curve.w1 + curve.w2 * b.offset) * b.offset;
    let w1 = w0 + (curve.w1 + curve.w2 * (2.0 * a.offset)) * (0.5 * length_e);
    let s = vec3f(w0.x + w0.y + w0.z, w1.x + w1.y + w1.z, w2.x + w2.y + w2.z);
    let sign = select(-1.0, 1.0, s.x >= 0.0);
    let least = min(min(s.x * sign, s.y * sign), s.z * sign);
    if !(least > 0.0) {
        return RELIEVO_HUGE;
    }
    let first = w0 + 2.0 * w1 - s.x * b.weights - 2.0 * s.y * a.weights;
    let second = w2 + 2.0 * w1 - s.z * a.weights - 2.0 * s.y * b.weights;
    let error = max(abs(first), abs(second)) * (0.25 / least);
    let uv = (abs(prism.uv[1] - prism.uv[0]) * error.y + abs(prism.uv[2] - prism.uv[0]) * error.z) * size;
    let bend = length(prism.normal[1] - prism.normal[0]) * error.y + length(prism.normal[2] - prism.normal[0]) * error.z;
    let turned = b.normal - a.normal;
    let normal_error = bend + dot(turned, turned) / (8.0 * curve.shortest_normal);
    let height = max(abs(a.offset), abs(b.offset)) * normal_error
        + 0.25 * abs(length_e * (length(b.normal) - length(a.normal)));
    return max(max(uv.x, uv.y), height * curve.texels_per_unit);
}

// The parts of an interval of offsets in which the ray is over the triangle, in rising order.
struct RelievoShellParts {
    part: array<vec2f, 7>,
    count: u32,
}

fn relievo_shell_parts(curve: RelievoShellCurve, ends: vec2f) -> RelievoShellParts {
    var borders: array<f32, 8>;
    borders[0] = ends.x;
    var count = 1u;
    for (var k = 0; k < 3; k++) {
        let a = curve.w2[k];
        let b = curve.w1[k];
        let c = curve.w0[k];
        let q = -0.5 * (b + select(-1.0, 1.0, b >= 0.0) * sqrt(max(b * b - 4.0 * a * c, 0.0)));
        if b * b - 4.0 * a * c < 0.0 {
            continue;
        }
        let roots = vec2f(select(RELIEVO_HUGE, q / a, a != 0.0), select(RELIEVO_HUGE, c / q, q != 0.0));
        for (var i = 0; i < 2; i++) {
            let root = roots[i];
            if root > ends.x && root < ends.y {
                // Sorted in as they come.
                var place = count;
                while place > 1u && borders[place - 1u] > root {
                    borders[place] = borders[place - 1u];
                    place -= 1u;
                }
                borders[place] = root;
                count += 1u;
            }
        }
    }
    borders[count] = ends.y;
    var parts: RelievoShellParts;
    var open = false;
    for (var i = 0u; i < count; i++) {
        let middle = 0.5 * (borders[i] + borders[i + 1u]);
        let w = curve.w0 + (curve.w1 + curve.w2 * middle) * middle;
        let inside = all(w >= vec3f(0.0)) || all(w <= vec3f(0.0));
        if inside && borders[i] < borders[i + 1u] {
            if open {
                parts.part[parts.count - 1u].y = borders[i + 1u];
            } else if parts.count < RELIEVO_MOST_PARTS {
                parts.part[parts.count] = vec2f(borders[i], borders[i + 1u]);
                parts.count += 1u;
            }
        }
        open = inside;
    }
    return parts;
}

// The first point of the relief over a triangle that a ray meets from above, with a distance in [near, far]. Ends for every
// input.
fn relievo_march_shell(
    field: RelievoHeightField, prism: RelievoPrism, origin: vec3f, direction: vec3f, near: f32, far: f32,
) -> RelievoShellHit {
    let size = vec2f(field.size);
    let curve = relievo_shell_curve(prism, origin, direction, size);
    let parts = relievo_shell_parts(curve, relievo_shell_offsets(prism, field.range, curve.shortest_normal));
    var best = RelievoShellHit(far, vec3f(0.0), RelievoRecord(vec2f(0.0), 0.0, false, 0u, 0u));
    for (var i = 0u; i < parts.count; i++) {
        let part = parts.part[i];
        let room = RELIEVO_PART_OVERLAP * (part.y - part.x);
        let low = relievo_curve_point(curve, prism, part.x - room);
        let high = relievo_curve_point(curve, prism, part.y + room);
        var first_point = low;
        var last_point = high;
        if low.t > high.t {
            first_point = high;
            last_point = low;
        }
        if !(last_point.t >= near && first_point.t <= best.t) {
            continue;
        }
        if first_point.t < near {
            first_point = relievo_curve_point(curve, prism, relievo_offset_at(curve, prism, near, first_point.offset, last_point.offset));
        }
        let hit = relievo_march_part(field, prism, curve, first_point, last_point);
        best.record.fetches += hit.record.fetches;
        best.record.iterations += hit.record.iterations;
        if hit.record.hit && hit.t >= near && hit.t <= best.t {
            best.t = hit.t;
            best.weights = hit.weights;
            best.record.uv = hit.record.uv;
            best.record.depth = hit.record.depth;
            best.record.hit = true;
        }
    }
    return best;
}

// The offset at which the ray is at a distance; the distance grows from `start` to `end`.
fn relievo_offset_at(curve: RelievoShellCurve, prism: RelievoPrism, t: f32, start: f32, end: f32) -> f32 {
    var low = start;
    var high = end;
    for (var i = 0; i < 24; i++) {
        let middle = 0.5 * (low + high);
        if relievo_curve_point(curve, prism, middle).t < t {
            low = middle;
        } else {
            high = middle;
        }
    }
    return 0.5 * (low + high);
}

// Marches one part of the curve, chord by chord.
fn relievo_march_part(
    field: RelievoHeightField, prism: RelievoPrism, curve: RelievoShellCurve, first_point: RelievoCurvePoint, last_point: RelievoCurvePoint,
) -> RelievoShellHit {
    let size = vec2f(field.size);
    let slack = 4.0 * RELIEVO_CHORD_ERROR / (prism.depth * max(curve.texels_per_unit, 1e-30)) + 1e-4;
    var result = RelievoShellHit(0.0, vec3f(0.0), RelievoRecord(first_point.uv, 0.0, false, 1u, 0u));
    // Below the surface it is seen from its underside, where it is not there.
    var below = relievo_height_sample(field, first_point.uv) - first_point.height > slack;
    let whole = relievo_chord_error(curve, prism, first_point, last_point, size);
    var step = RELIEVO_MOST_CHORDS;
    for (var i = 0; i < 10 && f32(RELIEVO_MOST_CHORDS / step) < sqrt(whole / RELIEVO_CHORD_ERROR); i++) {
        step /= 2u;
    }
    var position = 0u;
    var start = first_point;
    for (var turn = 0u; turn < 2u * RELIEVO_MOST_CHORDS && position < RELIEVO_MOST_CHORDS; turn++) {
        let x = f32(position + step) / f32(RELIEVO_MOST_CHORDS);
        let end = relievo_curve_point(curve, prism, first_point.offset + (last_point.offset - first_point.offset) * x);
        let error = relievo_chord_error(curve, prism, start, end, size);
        if !(error <= RELIEVO_CHORD_ERROR) && step > 1u {
            step /= 2u;
            continue;
        }
        if below {
            result.record.fetches += 1u;
            below = relievo_height_sample(field, end.uv) > end.height;
        } else {
            let line = RelievoHeightLine(start.uv, end.uv - start.uv, start.height, end.height - start.height);
            let walk = relievo_first_crossing(field, line, 0.0, 1.0);
            result.record.fetches += walk.fetches;
            result.record.iterations += walk.iterations;
            if walk.hit || !walk.finished {
                let point = relievo_curve_point(curve, prism, mix(start.offset, end.offset, walk.s));
                let height = mix(start.height, end.height, walk.s);
                result.t = point.t;
                result.weights = point.weights;
                result.record.uv = mix(start.uv, end.uv, walk.s);
                result.record.depth = clamp(1.0 - height, 0.0, 1.0);
                result.record.hit = true;
                return result;
            }
        }
        position += step;
        start = end;
        // Steps stay powers of two that the position is a multiple of.
        if error < 0.2 * RELIEVO_CHORD_ERROR && position % (2u * step) == 0u && step < RELIEVO_MOST_CHORDS {
            step *= 2u;
        }
    }
    return result;
}
