//! The march in the shell of a relief over a curved mesh: exact on any triangle, with the relief's silhouette. The same
//! curve and the same pieces of it as relievo-march/src/shell.
//!
//! Gives RelievoPrism, RelievoShellHit, relievo_shell_curve, relievo_shell_exit, relievo_march_part: one shell after the other;
//! relievo_march_shell: one alone.
//! Needs what descent.wgsl needs, and a permutation with `in_shells`.
//! #import record
//! #import height
//! #import walk
//! #import descent

// The most pieces of a part of the curve: a power of two.
const RELIEVO_MOST_PIECES: u32 = 1024u;
// How much larger the denominator may be at one end of a piece than at the other.
const RELIEVO_MOST_SLANT: f32 = 4.0;
// The cosine between a ray and the normal of a triangle below which it counts as running along it.
const RELIEVO_ALONG: f32 = 2e-5;
// The shortest interpolated normal that is reckoned with.
const RELIEVO_SHORTEST_NORMAL: f32 = 0.05;
// The part by which a piece of the curve is continued beyond the walls, so that rounding opens no gap between neighbours.
const RELIEVO_PART_OVERLAP: f32 = 2e-5;
const RELIEVO_MOST_PARTS: u32 = 7u;
// The part of a piece by which a ray that has come out of the surface goes on at least: there it is on it.
const RELIEVO_LEAST_CLEARANCE: f32 = 1e-3;

// The shell over a triangle with corners a, b, c, in scene space. Normals are those along which the relief rises; of unit
// length, or as interpolated. (No arrays: software adapters keep those in memory.)
struct RelievoPrism {
    position_a: vec3f,
    position_b: vec3f,
    position_c: vec3f,
    normal_a: vec3f,
    normal_b: vec3f,
    normal_c: vec3f,
    uv_a: vec2f,
    uv_b: vec2f,
    uv_c: vec2f,
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
    let middle = (prism.position_a + prism.position_b + prism.position_c) / 3.0;
    let anchor_t = dot(middle - origin, along);
    let anchor = origin + along * anchor_t;
    let e1 = prism.position_b - prism.position_a;
    let e2 = prism.position_c - prism.position_a;
    let across = cross(e1, e2);
    let area = max(length(across), 1e-30);
    var direction = along;
    let cos = dot(direction, across);
    if abs(cos) < RELIEVO_ALONG * area {
        direction += across * (select(-2.0, 2.0, cos >= 0.0) * RELIEVO_ALONG / area);
    }
    // Two directions at right angles to the ray (Duff et al. 2017).
    let s = select(-1.0, 1.0, direction.z >= 0.0);
    let q = -1.0 / (s + direction.z);
    let r = direction.x * direction.y * q;
    let right = vec3f(1.0 + s * direction.x * direction.x * q, s * r, -s * direction.x);
    let up = vec3f(r, s + direction.y * direction.y * q, -direction.y);
    let to_a = prism.position_a - anchor;
    let to_b = prism.position_b - anchor;
    let to_c = prism.position_c - anchor;
    let pa = vec2f(dot(to_a, right), dot(to_a, up));
    let pb = vec2f(dot(to_b, right), dot(to_b, up));
    let pc = vec2f(dot(to_c, right), dot(to_c, up));
    let na = vec2f(dot(prism.normal_a, right), dot(prism.normal_a, up));
    let nb = vec2f(dot(prism.normal_b, right), dot(prism.normal_b, up));
    let nc = vec2f(dot(prism.normal_c, right), dot(prism.normal_c, up));
    let w0 = vec3f(relievo_perp(pb, pc), relievo_perp(pc, pa), relievo_perp(pa, pb));
    let w1 = vec3f(
        relievo_perp(pb, nc) + relievo_perp(nb, pc), relievo_perp(pc, na) + relievo_perp(nc, pa),
        relievo_perp(pa, nb) + relievo_perp(na, pb));
    let w2 = vec3f(relievo_perp(nb, nc), relievo_perp(nc, na), relievo_perp(na, nb));
    // The gradients of u and v on the triangle.
    let g1 = cross(e2, across);
    let g2 = cross(across, e1);
    let d1 = prism.uv_b - prism.uv_a;
    let d2 = prism.uv_c - prism.uv_a;
    let gradient = vec2f(length(g1 * d1.x + g2 * d2.x), length(g1 * d1.y + g2 * d2.y)) / (area * area) * size;
    return RelievoShellCurve(
        w0, w1, w2, anchor, anchor_t, direction, relievo_shortest_normal(prism), max(gradient.x, gradient.y));
}

// A lower bound of the length of the interpolated normal: |Σ λN|² = Σ λ|N|² − Σ λiλj·|Ni − Nj|², and Σ λiλj ≤ 1/3.
fn relievo_shortest_normal(prism: RelievoPrism) -> f32 {
    let a = prism.normal_a;
    let b = prism.normal_b;
    let c = prism.normal_c;
    let shortest = min(min(dot(a, a), dot(b, b)), dot(c, c));
    let farthest = max(max(dot(a - b, a - b), dot(b - c, b - c)), dot(c - a, c - a));
    return max(sqrt(max(shortest - farthest / 3.0, 0.0)), RELIEVO_SHORTEST_NORMAL);
}

// The offsets between which the surface lies.
fn relievo_shell_offsets(prism: RelievoPrism, range: vec2f, shortest: f32) -> vec2f {
    let longest = max(
        max(max(length(prism.normal_a), length(prism.normal_b)), length(prism.normal_c)), RELIEVO_SHORTEST_NORMAL);
    let d = (range - prism.midlevel) * prism.depth;
    // A little room, so that heights at the ends of the range lie inside.
    let room = 1e-4 * prism.depth;
    return vec2f(
        d.x / select(longest, shortest, d.x < 0.0) - room, d.y / select(longest, shortest, d.y > 0.0) + room);
}

fn relievo_curve_point(curve: RelievoShellCurve, prism: RelievoPrism, offset: f32) -> RelievoCurvePoint {
    let w = curve.w0 + (curve.w1 + curve.w2 * offset) * offset;
    let weights = w / (w.x + w.y + w.z);
    let normal = prism.normal_a * weights.x + prism.normal_b * weights.y + prism.normal_c * weights.z;
    // Relative to the anchor: the numbers stay small.
    let corners = (prism.position_a - curve.anchor) * weights.x + (prism.position_b - curve.anchor) * weights.y
        + (prism.position_c - curve.anchor) * weights.z;
    return RelievoCurvePoint(
        offset,
        weights,
        prism.uv_a * weights.x + prism.uv_b * weights.y + prism.uv_c * weights.z,
        prism.midlevel + offset * length(normal) / prism.depth,
        curve.anchor_t + dot(corners + normal * offset, curve.direction),
        normal,
    );
}

// A piece of the curve over the grid of cells, between two offsets.
struct RelievoShellPiece {
    path: RelievoPath,
    // What of it lies below the highest height, in s.
    below_lid: vec2f,
    // Not so where u or v turn back in it, or it is too slanted.
    is_usable: bool,
}

fn relievo_shell_piece(
    curve: RelievoShellCurve, prism: RelievoPrism, ends: vec2f, size: vec2f, top: f32, code: vec2f,
) -> RelievoShellPiece {
    let length_e = ends.y - ends.x;
    // Weights in Bernstein form; the sum at the beginning is 1.
    let start = curve.w0 + (curve.w1 + curve.w2 * ends.x) * ends.x;
    let unit = 1.0 / (start.x + start.y + start.z);
    let w0 = start * unit;
    let w1 = w0 + (curve.w1 + curve.w2 * (2.0 * ends.x)) * (0.5 * length_e * unit);
    let w2 = (curve.w0 + (curve.w1 + curve.w2 * ends.y) * ends.y) * unit;
    let s = vec3f(1.0, w1.x + w1.y + w1.z, w2.x + w2.y + w2.z);
    let least = min(min(s.x, s.y), s.z);
    let most = max(max(s.x, s.y), s.z);
    // Positions from the cell that it begins in.
    let offset = select(0.5, 0.0, RELIEVO_NEAREST);
    let first = (prism.uv_a * w0.x + prism.uv_b * w0.y + prism.uv_c * w0.z) * size - offset;
    let base = floor(first);
    let at_a = prism.uv_a * size - offset - base;
    let at_b = prism.uv_b * size - offset - base;
    let at_c = prism.uv_c * size - offset - base;
    let p0 = at_a * w0.x + at_b * w0.y + at_c * w0.z;
    let p1 = at_a * w1.x + at_b * w1.y + at_c * w1.z;
    let p2 = at_a * w2.x + at_b * w2.y + at_c * w2.z;
    // The derivative's numerator in Bernstein form: where it keeps its sign, u and v do not turn back.
    let g0 = 2.0 * (p1 * s.x - p0 * s.y);
    let g1 = p2 * s.x - p0 * s.z;
    let g2 = 2.0 * (p2 * s.y - p1 * s.z);
    let falls = max(max(g0, g1), g2) <= vec2f(0.0);
    let keeps = (min(min(g0, g1), g2) >= vec2f(0.0)) | falls;
    let forward = !falls;
    let d = p2 / s.z - p0;
    let grid = RelievoGridLine(
        vec2i(base), p0, d, vec2f(1.0), d == vec2f(0.0), select(vec2i(-1), vec2i(1), forward),
        select(vec2i(0), vec2i(1), forward));
    // The squared length of the normal: from Bernstein form, of degree 4, to powers.
    let n0 = prism.normal_a * w0.x + prism.normal_b * w0.y + prism.normal_c * w0.z;
    let n1 = 2.0 * (prism.normal_a * (w1.x - w0.x) + prism.normal_b * (w1.y - w0.y) + prism.normal_c * (w1.z - w0.z));
    let n2 = prism.normal_a * (w2.x - 2.0 * w1.x + w0.x) + prism.normal_b * (w2.y - 2.0 * w1.y + w0.y)
        + prism.normal_c * (w2.z - 2.0 * w1.z + w0.z);
    let n = vec4f(dot(n0, n0), 2.0 * dot(n0, n1), dot(n1, n1) + 2.0 * dot(n0, n2), 2.0 * dot(n1, n2));
    let per_depth = 1.0 / prism.depth;
    let bends = relievo_piece_bends(curve, prism, w0, w1, w2, ends);
    // Of a chord of normals between these two nothing is shorter, and the curve of them is near it.
    let n_end = (n0 + n1 + n2) / s.z;
    let turned = n_end - n0;
    let shortest = sqrt(max(min(n.x, dot(n_end, n_end)) - 0.25 * dot(turned, turned), 0.0)) - bends.y;
    let lid = (top - prism.midlevel) * prism.depth / max(shortest, 1e-3 * curve.shortest_normal);
    let at_lid = clamp((lid - ends.x) / length_e, 0.0, 1.0);
    // A lid below the polygon is farthest from it where normals are longest: all of the piece is marched.
    let below_lid = select(
        vec2f(0.0, 1.0), select(vec2f(0.0, at_lid), vec2f(at_lid, 1.0), length_e < 0.0), top > prism.midlevel && shortest > 0.0);
    let path = RelievoPath(
        grid, p0, 2.0 * (p1 - p0), p2 - 2.0 * p1 + p0, vec3f(1.0, 2.0 * (s.y - 1.0), s.z - 2.0 * s.y + 1.0), n, dot(n2, n2),
        vec2f(ends.x, length_e) * per_depth, prism.midlevel, bends.x * per_depth,
        prism.depth * curve.texels_per_unit, code);
    return RelievoShellPiece(path, below_lid, all(keeps) && least > 0.0 && most <= RELIEVO_MOST_SLANT * least);
}

// By how much the distance along unit normals may be below a chord of the whole piece, and the normal beside its chord: an eighth of
// the second derivatives of e·|N| and N at most, from those of the weights.
fn relievo_piece_bends(
    curve: RelievoShellCurve, prism: RelievoPrism, w0: vec3f, w1: vec3f, w2: vec3f, ends: vec2f,
) -> vec2f {
    let s = vec3f(w0.x + w0.y + w0.z, w1.x + w1.y + w1.z, w2.x + w2.y + w2.z);
    let least = max(min(min(s.x, s.y), s.z), 1e-6);
    let most = max(max(s.x, s.y), s.z);
    let g0 = 2.0 * (w1 * s.x - w0 * s.y);
    let g1 = w2 * s.x - w0 * s.z;
    let g2 = 2.0 * (w2 * s.y - w1 * s.z);
    let g = max(max(abs(g0), abs(g1)), abs(g2));
    let dg = 2.0 * max(abs(g1 - g0), abs(g2 - g1));
    let ds = 2.0 * max(abs(s.y - s.x), abs(s.z - s.y));
    let first = g / (least * least);
    let second = (dg * most + 2.0 * g * ds) / (least * least * least);
    let turn_b = length(prism.normal_b - prism.normal_a);
    let turn_c = length(prism.normal_c - prism.normal_a);
    let dn = turn_b * first.y + turn_c * first.z;
    let ddn = turn_b * second.y + turn_c * second.z;
    let ddl = ddn + dn * dn / curve.shortest_normal;
    return 0.125 * vec2f(2.0 * abs(ends.y - ends.x) * dn + max(abs(ends.x), abs(ends.y)) * ddl, ddn);
}

// The roots of c + b·x + a·x², HUGE where there are none.
fn relievo_quadratic_roots(a: f32, b: f32, c: f32) -> vec2f {
    let discriminant = b * b - 4.0 * a * c;
    let q = -0.5 * (b + select(-1.0, 1.0, b >= 0.0) * sqrt(max(discriminant, 0.0)));
    let roots = vec2f(select(RELIEVO_HUGE, q / a, a != 0.0), select(RELIEVO_HUGE, c / q, q != 0.0));
    return select(vec2f(RELIEVO_HUGE), roots, discriminant >= 0.0);
}

// The least of some numbers that is above another.
fn relievo_next_above(x: f32, roots: vec2f) -> f32 {
    return min(select(RELIEVO_HUGE, roots.x, roots.x > x), select(RELIEVO_HUGE, roots.y, roots.y > x));
}

// How a ray leaves a shell.
struct RelievoShellExit {
    offset: f32,
    // The corner opposite to the edge that it crosses; 3: none, it leaves through the lid or the floor.
    edge: u32,
}

// Where a ray that is over the triangle at `offset` leaves the shell between two offsets. The weight of the edge's opposite
// corner falls below 0 there: of its two roots the one where it falls, so that the edge the ray came by is not taken again.
fn relievo_shell_exit(curve: RelievoShellCurve, offset: f32, limits: vec2f) -> RelievoShellExit {
    let w = curve.w0 + (curve.w1 + curve.w2 * offset) * offset;
    // Seen from above offsets fall along the ray, and the weights are negative.
    let side = select(-1.0, 1.0, w.x + w.y + w.z >= 0.0);
    let c = curve.w0 * side;
    let b = curve.w1 * side;
    let a = curve.w2 * side;
    let discriminant = b * b - 4.0 * a * c;
    let fall = sqrt(max(discriminant, vec3f(0.0))) * side;
    let along = select(b + fall, b - fall, b * side < vec3f(0.0));
    let same = b * side >= vec3f(0.0);
    // (−b − fall)/2a, without cancellation.
    let numerator = select(-2.0 * c, -along, same);
    let denominator = select(along, 2.0 * a, same);
    let falls = (discriminant > vec3f(0.0)) & (denominator != vec3f(0.0));
    let root = numerator / select(vec3f(1.0), denominator, falls);
    let to_root = (root - offset) * side;
    // Beside the triangle by rounding, and moving away: it leaves here.
    let slope = (b + 2.0 * a * offset) * side;
    let gone = (w * side < vec3f(0.0)) & (slope < vec3f(0.0));
    let to_exit = select(select(vec3f(RELIEVO_HUGE), to_root, falls & (to_root > vec3f(0.0))), vec3f(0.0), gone);
    let end = select(limits.x, limits.y, side > 0.0);
    let nearest = min(min(to_exit.x, to_exit.y), to_exit.z);
    if !(nearest < (end - offset) * side) {
        return RelievoShellExit(end, 3u);
    }
    return RelievoShellExit(offset + nearest * side, select(select(2u, 1u, to_exit.y == nearest), 0u, to_exit.x == nearest));
}

// The offset at which a ray comes over the triangle through the wall opposite to a corner, near a distance.
fn relievo_shell_wall_offset(curve: RelievoShellCurve, prism: RelievoPrism, corner: u32, t: f32) -> f32 {
    let roots = relievo_quadratic_roots(curve.w2[corner], curve.w1[corner], curve.w0[corner]);
    let first = abs(relievo_curve_point(curve, prism, roots.x).t - t);
    let second = abs(relievo_curve_point(curve, prism, roots.y).t - t);
    // A root that is none is far away, or not a number.
    return select(roots.y, roots.x, first <= second || !(second < RELIEVO_HUGE));
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

// Marches one part of the curve, piece by piece, between two offsets in the order in which the ray comes to them.
fn relievo_march_part(
    field: RelievoHeightField, prism: RelievoPrism, curve: RelievoShellCurve, start: f32, end: f32,
) -> RelievoShellHit {
    let size = vec2f(field.size);
    let room = RELIEVO_PART_OVERLAP * (end - start);
    let first = start - room;
    let length_e = end + room - first;
    // The height by which a ray may be below the surface and still count as on it.
    let slack = 4.0 * RELIEVO_CHORD_ERROR / (prism.depth * max(curve.texels_per_unit, 1e-30)) + 1e-4;
    let header = textureLoad(relievo_pyramid, vec2i(field.level, 0), 0);
    let code = relievo_path_code(header);
    var result = RelievoShellHit(0.0, vec3f(0.0), RelievoRecord(vec2f(0.0), 0.0, false, 0u, 0u));
    var below = true;
    var step = RELIEVO_MOST_PIECES;
    var position = 0u;
    for (var iteration = 0u; iteration < 2u * RELIEVO_MOST_PIECES && position < RELIEVO_MOST_PIECES; iteration++) {
        let x = vec2f(vec2u(position, position + step)) / f32(RELIEVO_MOST_PIECES);
        let ends = vec2f(first) + length_e * x;
        let piece = relievo_shell_piece(curve, prism, ends, size, field.range.y, code);
        if !piece.is_usable && step > 1u {
            step /= 2u;
            continue;
        }
        var s = piece.below_lid.x;
        // Through an open wall, at a seam of uv or from behind a ray may come over the triangle below the surface. What it meets
        // after it has come out is seen.
        if below {
            let out = relievo_path_walk(field, piece.path, 0.0, 1.0, -1.0, slack);
            result.record.fetches += out.fetches;
            result.record.iterations += select(out.iterations, 0u, out.s == 0.0);
            below = !out.hit;
            s = select(min(out.s + RELIEVO_LEAST_CLEARANCE, 1.0), s, out.s == 0.0);
        }
        var walk = RelievoCellWalk(1.0, false, 0u, 0u, true);
        if !below && s <= piece.below_lid.y {
            if RELIEVO_WITHOUT_PYRAMID {
                walk = relievo_path_walk(field, piece.path, s, piece.below_lid.y, 1.0, 0.0);
            } else {
                walk = relievo_descend(field, piece.path, s, piece.below_lid.y, header);
            }
        }
        result.record.fetches += walk.fetches;
        result.record.iterations += walk.iterations;
        if walk.hit || !walk.finished {
            let point = relievo_curve_point(curve, prism, mix(ends.x, ends.y, walk.s));
            result.t = point.t;
            result.weights = point.weights;
            result.record.uv = point.uv;
            result.record.depth = clamp(1.0 - point.height, 0.0, 1.0);
            result.record.hit = true;
            break;
        }
        position += step;
        // Steps stay powers of two that the position is a multiple of.
        if position % (2u * step) == 0u && step < RELIEVO_MOST_PIECES {
            step *= 2u;
        }
    }
    return result;
}

// Marches what of a part, whose offsets rise, lies between two distances.
fn relievo_march_part_between(
    field: RelievoHeightField, prism: RelievoPrism, curve: RelievoShellCurve, part: vec2f, near: f32, far: f32,
) -> RelievoShellHit {
    let low = relievo_curve_point(curve, prism, part.x).t;
    let high = relievo_curve_point(curve, prism, part.y).t;
    if !(max(low, high) >= near && min(low, high) <= far) {
        return RelievoShellHit();
    }
    var start = select(part.y, part.x, low <= high);
    let end = select(part.x, part.y, low <= high);
    if min(low, high) < near {
        start = relievo_offset_at(curve, prism, near, start, end);
    }
    return relievo_march_part(field, prism, curve, start, end);
}

// The first point of the relief over a triangle that a ray meets from above, with a distance in [near, far]. Ends for every
// input.
fn relievo_march_shell(
    field: RelievoHeightField, prism: RelievoPrism, origin: vec3f, direction: vec3f, near: f32, far: f32,
) -> RelievoShellHit {
    let curve = relievo_shell_curve(prism, origin, direction, vec2f(field.size));
    let ends = relievo_shell_offsets(prism, field.range, curve.shortest_normal);
    var best = RelievoShellHit(far, vec3f(0.0), RelievoRecord(vec2f(0.0), 0.0, false, 0u, 0u));
    // The least and the greatest of each weight: of its Bernstein coefficients.
    let w_low = curve.w0 + (curve.w1 + curve.w2 * ends.x) * ends.x;
    let w_high = curve.w0 + (curve.w1 + curve.w2 * ends.y) * ends.y;
    let w_middle = w_low + (curve.w1 + curve.w2 * (2.0 * ends.x)) * (0.5 * (ends.y - ends.x));
    if any(min(min(w_low, w_high), w_middle) > vec3f(0.0)) && any(max(max(w_low, w_high), w_middle) < vec3f(0.0)) {
        return best;
    }
    let roots_a = relievo_quadratic_roots(curve.w2.x, curve.w1.x, curve.w0.x);
    let roots_b = relievo_quadratic_roots(curve.w2.y, curve.w1.y, curve.w0.y);
    let roots_c = relievo_quadratic_roots(curve.w2.z, curve.w1.z, curve.w0.z);
    // From one border of the triangle to the next; a part begins where the ray comes over the triangle.
    var start = ends.x;
    var part_start = ends.x;
    var inside = false;
    for (var i = 0u; i <= RELIEVO_MOST_PARTS; i++) {
        var end = min(
            min(relievo_next_above(start, roots_a), relievo_next_above(start, roots_b)), relievo_next_above(start, roots_c));
        end = min(end, ends.y);
        let middle = 0.5 * (start + end);
        let w = curve.w0 + (curve.w1 + curve.w2 * middle) * middle;
        let comes_in = start < end && (all(w >= vec3f(0.0)) || all(w <= vec3f(0.0)));
        if comes_in && !inside {
            part_start = start;
        }
        if (inside && !comes_in) || (comes_in && !(end < ends.y)) {
            let part_end = select(start, end, comes_in);
            let hit = relievo_march_part_between(field, prism, curve, vec2f(part_start, part_end), near, best.t);
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
        inside = comes_in;
        start = end;
        if !(end < ends.y) {
            break;
        }
    }
    return best;
}
