//! From a fragment of a polygon to the colour and depth of the relief that is seen through it.
//!
//! Gives Shaded, shade.
//! Needs nothing else.
//! #import scene
//! #import surface
//! #import vertex
//! #import march
//! #import shadow
//! #import chosen_normal
//! #import chosen_reflection
//! #import chosen_output

struct Shaded {
    color: vec3f,
    // 1 at the near plane, 0 at infinity.
    depth: f32,
    // Not so where the relief ends: what lies behind is seen.
    seen: bool,
}

// The footprint of the pixel on the polygon; `normal` is the polygon's, of any length.
fn pixel_footprint(at: Tangent, point: vec3f, normal: vec3f) -> Footprint {
    let way = point - view.eye;
    let ray = way / dot(way, view.forward);
    let right = ray + view.pixel_right;
    let down = ray + view.pixel_down;
    let distance = dot(way, normal);
    let dx = right * (distance / dot(right, normal)) - way;
    let dy = down * (distance / dot(down, normal)) - way;
    return Footprint(finite_or_zero(at.to_uv * (dx * at.frame).xy), finite_or_zero(at.to_uv * (dy * at.frame).xy));
}

fn finite_or_zero(v: vec2f) -> vec2f {
    if abs(v.x) < HUGE && abs(v.y) < HUGE {
        return v;
    }
    return vec2f(0.0);
}

// How much of a light gets past the relief itself.
fn light_factor(
    at: Tangent, field: Field, how: March, record: Record, light: Light, incoming: Incoming, turn: f32,
) -> f32 {
    if !SHADOW_IS_CAST {
        return 1.0;
    }
    if !SHADOW_IS_EXACT || light.radius <= 0.0 {
        return relief_shadow(field, tangent_ray(at, record.uv, incoming.direction), record.depth, how).factor;
    }
    var sum = 0.0;
    for (var i = 0u; i < PENUMBRA_SAMPLES; i++) {
        let direction = light_sample(light, incoming, i, turn);
        sum += relief_shadow(field, tangent_ray(at, record.uv, direction), record.depth, how).factor;
    }
    return sum / f32(PENUMBRA_SAMPLES);
}

fn shade(in: VertexOut, front: bool) -> Shaded {
    // Derivatives come first, where control flow is still uniform.
    let polygon = cross(dpdx(in.position), dpdy(in.position));
    let way = in.position - view.eye;
    let distance = length(way);
    let toward = -way / distance;
    let at = tangent_frame(in.normal, in.tangent, in.jacobian, surface_depth(in.normal, in.jacobian));
    var footprint = Footprint(vec2f(0.0), vec2f(0.0));
    if surface.levels != 0u {
        footprint = pixel_footprint(at, in.position, polygon);
    }
    let field = surface_field(footprint);
    let how = surface_march();

    var record = Record(in.uv, march_rise(how), true, 0u, 0u);
    var t = distance;
    var position = in.position;
    if TECHNIQUE_MARCHES {
        let ray = tangent_ray(at, in.uv, toward);
        // Interpolated normals lean away from the eye at the rim of a curved mesh: there is nothing to march.
        if ray.cos > 0.0 {
            record = relief_march(field, ray, how);
            if WRITES_DEPTH {
                t += (record.depth - march_rise(how)) * at.depth / ray.cos;
                position = view.eye - toward * t;
            }
        }
    }

    var normal = normal_at(at, field, record.uv, footprint);
    // Thin surfaces are lit on the side that is seen.
    normal = select(-normal, normal, front);
    let texels = surface_texels(record.uv, footprint);
    let turn = pixel_turn(floor(in.clip.xy)) + view.turn;
    var color = texels.base_color * (view.ambient * texels.ao);
    for (var i = 0u; i < min(view.light_count, MAX_LIGHTS); i++) {
        let incoming = light_incoming(lights[i], position);
        if all(incoming.direction == vec3f(0.0)) || all(incoming.color == vec3f(0.0)) {
            continue;
        }
        let factor = light_factor(at, field, how, record, lights[i], incoming, turn);
        if factor > 0.0 {
            let reflected = reflection(texels, normal, toward, incoming.direction, view.specular, view.shininess);
            color += reflected * incoming.color * factor;
        }
    }
    let along_axis = t * -dot(toward, view.forward);
    let depth = clamp(view.near / along_axis, 0.0, 1.0);
    return Shaded(output_color(color), depth, record.hit && along_axis >= view.near);
}
