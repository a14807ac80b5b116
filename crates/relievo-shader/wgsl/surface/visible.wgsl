//! The point of a relief that is seen through a fragment.
//!
//! Gives RelievoVisiblePoint, RelievoCoverage, relievo_pixel_footprint, relievo_is_faded, relievo_faded.
//! Needs nothing else.
//! #import scene
//! #import surface
//! #import tangent
//! #import march
//! #import chosen_drawing

struct RelievoVisiblePoint {
    at: RelievoTangentFrame,
    footprint: RelievoFootprint,
    field: RelievoHeightField,
    options: RelievoMarchOptions,
    record: RelievoRecord,
    // Unit vector to the eye; a normal of the polygon, of any length and side; and where lights are seen from.
    to_eye: vec3f,
    polygon: vec3f,
    position: vec3f,
    // Distance along the camera's axis.
    view_depth: f32,
    // 1 at the near plane, 0 at infinity.
    depth: f32,
    // Not so where the relief ends: what lies behind is seen.
    seen: bool,
}

struct RelievoCoverage {
    point: RelievoVisiblePoint,
    // Of the samples that lie on the polygon, those that see the relief.
    share: f32,
}

// The footprint of the pixel on the polygon; `normal` is the polygon's, of any length.
fn relievo_pixel_footprint(at: RelievoTangentFrame, point: vec3f, normal: vec3f) -> RelievoFootprint {
    if relievo_view.parallel != 0u {
        let per_step = relievo_view.forward / dot(relievo_view.forward, normal);
        let dx = relievo_view.pixel_right - per_step * dot(relievo_view.pixel_right, normal);
        let dy = relievo_view.pixel_down - per_step * dot(relievo_view.pixel_down, normal);
        return relievo_footprint_on_polygon(at, dx, dy);
    }
    let offset = point - relievo_view.eye;
    let ray = offset / dot(offset, relievo_view.forward);
    let right = ray + relievo_view.pixel_right;
    let down = ray + relievo_view.pixel_down;
    let distance = dot(offset, normal);
    let dx = right * (distance / dot(right, normal)) - offset;
    let dy = down * (distance / dot(down, normal)) - offset;
    return relievo_footprint_on_polygon(at, dx, dy);
}

// From steps in scene space to those in texture space.
fn relievo_footprint_on_polygon(at: RelievoTangentFrame, dx: vec3f, dy: vec3f) -> RelievoFootprint {
    return RelievoFootprint(
        relievo_finite_or_zero(at.to_uv * (dx * at.frame).xy), relievo_finite_or_zero(at.to_uv * (dy * at.frame).xy));
}

fn relievo_finite_or_zero(v: vec2f) -> vec2f {
    if abs(v.x) < RELIEVO_HUGE && abs(v.y) < RELIEVO_HUGE {
        return v;
    }
    return vec2f(0.0);
}

// Whether nothing is left of the relief's depth.
fn relievo_is_faded(at: RelievoTangentFrame) -> bool {
    return RELIEVO_LOD && at.depth == 0.0;
}

struct RelievoFadedRelief {
    at: RelievoTangentFrame,
    footprint: RelievoFootprint,
}

// With level of detail, what of the depth cannot be seen is taken away.
fn relievo_faded(at: RelievoTangentFrame, footprint: RelievoFootprint) -> RelievoFadedRelief {
    var faded = RelievoFadedRelief(at, footprint);
    if RELIEVO_LOD && RELIEVO_TECHNIQUE_MARCHES {
        let size = vec2f(textureDimensions(relievo_heights));
        let fade = relievo_footprint_fade(footprint, size, at.to_uv[0] * at.depth);
        faded.at.depth *= fade;
        faded.footprint = relievo_footprint_on_relief(footprint, size, fade);
    }
    return faded;
}
