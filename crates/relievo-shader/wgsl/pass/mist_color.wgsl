//! The colour pass of mist, over what has been drawn: the light it scatters, and how much it lets through from behind as alpha.
//!
//! Gives the entry point `relievo_fragment`.
//! Needs nothing else.
//! #import mist_vertex
//! #import mist

@fragment
fn relievo_fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let ray = relievo_mist_ray(position.xy);
    let span = relievo_mist_span(ray.origin, ray.direction, ray.near, ray.end);
    if !span.is_open {
        return vec4f(0.0, 0.0, 0.0, 1.0);
    }
    let field = relievo_surface_level(0.0);
    let medium = relievo_mist_medium();
    let through = relievo_transmittance(relievo_optical_depth(field, span.line, span.length, medium));
    if through >= 1.0 {
        return vec4f(0.0, 0.0, 0.0, 1.0);
    }
    // The angle that turns a penumbra's points from pixel to pixel moves the points along a ray too.
    let rotation = relievo_pixel_rotation(floor(position.xy)) + relievo_view.rotation;
    let count = clamp(relievo_mist.steps, 1u, RELIEVO_MAX_SCATTER_POINTS);
    let plan = RelievoScatterPlan(count, fract(rotation / 6.2831853), 1.0 - through);
    relievo_find_scatter_distances(field, span.line, span.length, medium, plan);
    var sum = vec3f(0.0);
    for (var i = 0u; i < count; i++) {
        let point = ray.origin + ray.direction * (span.start + relievo_scatter_distance[i]);
        sum += relievo_mist_scattered(point, ray.direction);
    }
    return vec4f(relievo_mist.albedo * sum * ((1.0 - through) / f32(count)), through);
}
