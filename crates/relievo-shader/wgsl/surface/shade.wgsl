//! The colour of a point that is seen.
//!
//! Gives RelievoShaded, relievo_shade, relievo_shading_normal.
//! Needs nothing else.
//! #import chosen_geometry
//! #import column_wall
//! #import shadow
//! #import cast_shadow
//! #import environment
//! #import chosen_normal
//! #import chosen_reflection
//! #import chosen_mist
//! #import chosen_output

struct RelievoShaded {
    color: vec3f,
    // The mean shadow factor over the lights.
    unshadowed: f32,
}

// Asks all points of a footprint.
const RELIEVO_ALL_POINTS: i32 = -1;

// The way to a light in full depths. Where depth is not written lights are seen from the polygon.
fn relievo_light_reach(point: RelievoVisiblePoint, path: RelievoLightPath) -> f32 {
    // Bounded, so that nothing becomes infinite: far lights, and those of reliefs without depth, are above all of it.
    let reach = min(path.distance / max(point.at.full_depth, 1e-6), RELIEVO_FAR_LIGHT);
    let cos = relievo_tangent_ray(point.at, point.record.uv, path.direction).cos;
    if RELIEVO_WRITES_DEPTH || cos <= 0.0 {
        return reach;
    }
    return min(reach + (point.record.depth - relievo_lid_offset(point.options)) / cos, RELIEVO_FAR_LIGHT);
}

// The wall of a column that the point lies on, where columns are what is seen.
fn relievo_wall_at(point: RelievoVisiblePoint) -> RelievoColumnWall {
    if !RELIEVO_TECHNIQUE_MARCHES {
        return RelievoColumnWall(vec2f(0.0), point.record.uv);
    }
    return relievo_column_wall(point.field, point.record.uv, point.record.depth);
}

// How much of a light in a direction gets past the relief itself. With level of detail, to what a pixel covers: shadows do
// not fade, they become their mean. `only`: ask one point, as one of many rays to a wide light does.
fn relievo_self_shadow(point: RelievoVisiblePoint, path: RelievoLightPath, only: i32) -> f32 {
    if !RELIEVO_SHADOW_IS_CAST {
        return 1.0;
    }
    let record = point.record;
    let reach = relievo_light_reach(point, path);
    if !RELIEVO_LOD {
        let ray = relievo_tangent_ray(point.at, relievo_wall_at(point).beside, path.direction);
        return relievo_shadow_up_to(point.field, ray, record.depth, reach, point.options).factor;
    }
    var whole = point.at;
    whole.depth = whole.full_depth;
    let count = relievo_footprint_points(point.footprint, vec2f(textureDimensions(relievo_heights)));
    let as_hit = count == 1u && !relievo_is_faded(point.at);
    let first = select(u32(max(only, 0)) % count, 0u, as_hit);
    let end = select(first + 1u, count, only == RELIEVO_ALL_POINTS);
    var sum = 0.0;
    for (var i = first; i < end; i++) {
        let uv = relievo_footprint_point(point.footprint, record.uv, i);
        var depth = record.depth;
        if !as_hit {
            depth = 1.0 - relievo_height_sample(point.field, uv);
        }
        let ray = relievo_tangent_ray(whole, uv, path.direction);
        sum += relievo_shadow_up_to(point.field, ray, depth, reach, point.options).factor;
    }
    return sum / f32(end - first);
}

// How much of a light gets past the relief itself and everything else.
fn relievo_light_factor(
    point: RelievoVisiblePoint, receiver: RelievoShadowReceiver, light: RelievoLight, incoming: RelievoIncomingLight, rotation: f32,
) -> f32 {
    if !RELIEVO_SHADOW_SOFTENS || light.radius <= 0.0 {
        let path = RelievoLightPath(incoming.direction, incoming.distance);
        let own = relievo_self_shadow(point, path, RELIEVO_ALL_POINTS);
        if own == 0.0 || RELIEVO_CASTERS == RELIEVO_CASTERS_NONE {
            return own;
        }
        return own * relievo_cast_shadow(light, receiver, receiver.position);
    }
    var sum = 0.0;
    for (var i = 0u; i < RELIEVO_PENUMBRA_SAMPLES; i++) {
        let factor = relievo_self_shadow(point, relievo_light_path(light, incoming, i, rotation), i32(i));
        if factor > 0.0
            && !(RELIEVO_CASTERS != RELIEVO_CASTERS_NONE
                && relievo_is_cast_soft_shadow(light, receiver, relievo_light_offset(light, incoming, i, rotation))) {
            sum += factor;
        }
    }
    return sum / f32(RELIEVO_PENUMBRA_SAMPLES);
}

fn relievo_shading_normal(point: RelievoVisiblePoint, front: bool) -> RelievoMeanNormal {
    var normal = relievo_normal_at(point.at, point.field, point.record.uv, point.footprint);
    if RELIEVO_NEAREST {
        let outward = relievo_wall_at(point).outward;
        if any(outward != vec2f(0.0)) {
            let along = relievo_normalized_or(point.at.frame * vec3f(outward * point.at.to_uv, 0.0), point.at.frame[2]);
            normal = RelievoMeanNormal(along, 1.0);
        }
    }
    // Thin surfaces are lit on the side that is seen.
    return RelievoMeanNormal(select(-normal.direction, normal.direction, front), normal.length);
}

fn relievo_shade(in: RelievoVertexOut, point: RelievoVisiblePoint, front: bool) -> RelievoShaded {
    let normal = relievo_shading_normal(point, front);
    var material = relievo_surface_sample_material(point.record.uv, point.footprint);
    material.roughness = relievo_mean_normal_roughness(material.roughness, normal.length);
    let receiver = relievo_receiver_at(point, front);
    let rotation = relievo_pixel_rotation(floor(in.clip.xy)) + relievo_view.rotation;
    var color = material.base_color * (relievo_view.ambient * material.ao);
    if RELIEVO_ENVIRONMENT_IS_SEEN {
        color += relievo_environment_reflection(material, normal.direction, point.to_eye);
    }
    let count = min(relievo_view.light_count, RELIEVO_MAX_LIGHTS);
    var unshadowed = 0.0;
    for (var i = 0u; i < count; i++) {
        let incoming = relievo_light_incoming(relievo_lights[i], point.position);
        if all(incoming.direction == vec3f(0.0)) || all(incoming.color == vec3f(0.0)) {
            unshadowed += 1.0;
            continue;
        }
        let past_mist = relievo_light_past_mist(in.clip.xy, i);
        let factor = past_mist * relievo_light_factor(point, receiver, relievo_lights[i], incoming, rotation);
        unshadowed += factor;
        if factor > 0.0 {
            let reflected =
                relievo_reflection(material, normal, point.to_eye, incoming.direction, relievo_view.specular, relievo_view.shininess);
            color += reflected * incoming.color * factor;
        }
    }
    return RelievoShaded(color, select(unshadowed / f32(count), 1.0, count == 0u));
}
