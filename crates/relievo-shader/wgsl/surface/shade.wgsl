//! The colour of a point that is seen.
//!
//! Gives Shaded, shade, shading_normal.
//! Needs nothing else.
//! #import visible
//! #import shadow
//! #import cast_shadow
//! #import environment
//! #import chosen_normal
//! #import chosen_reflection
//! #import chosen_output

struct Shaded {
    color: vec3f,
    // The mean shadow factor over the lights.
    unshadowed: f32,
}

// Asks all points of a footprint.
const ALL_POINTS: i32 = -1;

// How much of a light in a direction gets past the relief itself. With level of detail, to what a pixel covers: shadows do
// not fade, they become their mean. `only`: ask one point, as one of many rays to a wide light does.
fn self_shadow(point: Visible, direction: vec3f, only: i32) -> f32 {
    if !SHADOW_IS_CAST {
        return 1.0;
    }
    let record = point.record;
    if !LOD {
        return relief_shadow(point.field, tangent_ray(point.at, record.uv, direction), record.depth, point.how).factor;
    }
    var whole = point.at;
    whole.depth = whole.full_depth;
    let count = footprint_points(point.footprint, vec2f(textureDimensions(relief_heights)));
    let as_hit = count == 1u && !is_faded(point.at);
    let first = select(u32(max(only, 0)) % count, 0u, as_hit);
    let end = select(first + 1u, count, only == ALL_POINTS);
    var sum = 0.0;
    for (var i = first; i < end; i++) {
        let uv = footprint_point(point.footprint, record.uv, i);
        var depth = record.depth;
        if !as_hit {
            depth = 1.0 - height_sample(point.field, uv);
        }
        sum += relief_shadow(point.field, tangent_ray(whole, uv, direction), depth, point.how).factor;
    }
    return sum / f32(end - first);
}

// How much of a light gets past the relief itself and everything else.
fn light_factor(point: Visible, receiver: Receiver, light: Light, incoming: Incoming, turn: f32) -> f32 {
    if !SHADOW_SOFTENS || light.radius <= 0.0 {
        let own = self_shadow(point, incoming.direction, ALL_POINTS);
        if own == 0.0 || CASTERS == CASTERS_NONE {
            return own;
        }
        return own * cast_shadow(light, receiver, receiver.position);
    }
    var sum = 0.0;
    for (var i = 0u; i < PENUMBRA_SAMPLES; i++) {
        let factor = self_shadow(point, light_sample(light, incoming, i, turn), i32(i));
        if factor > 0.0
            && !(CASTERS != CASTERS_NONE && is_cast_soft_shadow(light, receiver, light_offset(light, incoming, i, turn))) {
            sum += factor;
        }
    }
    return sum / f32(PENUMBRA_SAMPLES);
}

fn shading_normal(point: Visible, front: bool) -> MeanNormal {
    let normal = normal_at(point.at, point.field, point.record.uv, point.footprint);
    // Thin surfaces are lit on the side that is seen.
    return MeanNormal(select(-normal.direction, normal.direction, front), normal.length);
}

fn shade(in: VertexOut, point: Visible, front: bool) -> Shaded {
    let normal = shading_normal(point, front);
    var texels = surface_texels(point.record.uv, point.footprint);
    texels.roughness = mean_normal_roughness(texels.roughness, normal.length);
    let receiver = receiver_at(point, front);
    let turn = pixel_turn(floor(in.clip.xy)) + view.turn;
    var color = texels.base_color * (view.ambient * texels.ao);
    if ENVIRONMENT_IS_SEEN {
        color += environment_reflection(texels, normal.direction, point.toward);
    }
    let count = min(view.light_count, MAX_LIGHTS);
    var unshadowed = 0.0;
    for (var i = 0u; i < count; i++) {
        let incoming = light_incoming(lights[i], point.position);
        if all(incoming.direction == vec3f(0.0)) || all(incoming.color == vec3f(0.0)) {
            unshadowed += 1.0;
            continue;
        }
        let factor = light_factor(point, receiver, lights[i], incoming, turn);
        unshadowed += factor;
        if factor > 0.0 {
            let reflected =
                reflection(texels, normal, point.toward, incoming.direction, view.specular, view.shininess);
            color += reflected * incoming.color * factor;
        }
    }
    return Shaded(color, select(unshadowed / f32(count), 1.0, count == 0u));
}
