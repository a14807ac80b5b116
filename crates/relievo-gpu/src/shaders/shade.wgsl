//! From a fragment of a polygon to the colour and depth of the relief that is seen through it.
//!
//! Gives Shaded, shade.
//! Needs nothing else.
//! #import visible
//! #import shadow
//! #import chosen_normal
//! #import chosen_reflection
//! #import chosen_output

// The colour of a Visible.
struct Shaded {
    color: vec3f,
    depth: f32,
    seen: bool,
}

// How much of a light gets past the relief itself.
fn light_factor(point: Visible, light: Light, incoming: Incoming, turn: f32) -> f32 {
    if !SHADOW_IS_CAST {
        return 1.0;
    }
    if !SHADOW_IS_EXACT || light.radius <= 0.0 {
        let ray = tangent_ray(point.at, point.record.uv, incoming.direction);
        return relief_shadow(point.field, ray, point.record.depth, point.how).factor;
    }
    var sum = 0.0;
    for (var i = 0u; i < PENUMBRA_SAMPLES; i++) {
        let ray = tangent_ray(point.at, point.record.uv, light_sample(light, incoming, i, turn));
        sum += relief_shadow(point.field, ray, point.record.depth, point.how).factor;
    }
    return sum / f32(PENUMBRA_SAMPLES);
}

fn shade(in: VertexOut, front: bool) -> Shaded {
    let point = visible(in);
    var normal = normal_at(point.at, point.field, point.record.uv, point.footprint);
    // Thin surfaces are lit on the side that is seen.
    normal = select(-normal, normal, front);
    let texels = surface_texels(point.record.uv, point.footprint);
    let turn = pixel_turn(floor(in.clip.xy)) + view.turn;
    var color = texels.base_color * (view.ambient * texels.ao);
    for (var i = 0u; i < min(view.light_count, MAX_LIGHTS); i++) {
        let incoming = light_incoming(lights[i], point.position);
        if all(incoming.direction == vec3f(0.0)) || all(incoming.color == vec3f(0.0)) {
            continue;
        }
        let factor = light_factor(point, lights[i], incoming, turn);
        if factor > 0.0 {
            let reflected =
                reflection(texels, normal, point.toward, incoming.direction, view.specular, view.shininess);
            color += reflected * incoming.color * factor;
        }
    }
    return Shaded(output_color(color), point.depth, point.seen);
}
