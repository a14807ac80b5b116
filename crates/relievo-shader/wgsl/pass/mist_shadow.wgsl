//! The shadow of mist on surfaces: how much of one light passes it to the surface that is seen through each pixel.
//!
//! Gives the entry point `relievo_fragment`.
//! Needs nothing else.
//! #import mist_vertex
//! #import mist

@fragment
fn relievo_fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let ray = relievo_mist_ray(position.xy);
    if !ray.ends_at_surface {
        return vec4f(1.0);
    }
    let point = ray.origin + ray.direction * ray.end;
    let incoming = relievo_light_incoming(relievo_lights[min(relievo_mist.light, RELIEVO_MAX_LIGHTS - 1u)], point);
    return vec4f(relievo_mist_transmittance(point, incoming.direction, incoming.distance));
}
