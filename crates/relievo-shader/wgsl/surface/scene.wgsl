//! Settings of a whole picture: camera, lights, shading.
//!
//! Gives relievo_view (camera and shading), relievo_lights, RelievoViewRay, relievo_view_ray, relievo_clip_position,
//! relievo_depth_at;
//! declares their bindings, group 0.
//! #import light

const RELIEVO_MAX_LIGHTS: u32 = 64u;

struct RelievoCameraView {
    eye: vec3f,
    near: f32,
    // The camera's axes. Right and up are divided by half the picture's width and height at distance 1.
    right: vec3f,
    light_count: u32,
    up: vec3f,
    ambient: f32,
    forward: vec3f,
    specular: f32,
    // From one pixel to the next, to the right and down, at distance 1.
    pixel_right: vec3f,
    shininess: f32,
    pixel_down: vec3f,
    // Added to the angle that spreads a penumbra's samples: differs from sample to sample.
    rotation: f32,
    // How far the picture is moved, in halves of it, so that the sample lies in the pixel's middle.
    jitter: vec2f,
    // Not 0: all rays run along `forward`, as those of a directional light or an orthographic camera do; right, up and the
    // pixels' sides are those at any distance, and `far` is where the rays end.
    parallel: u32,
    far: f32,
    // A pixel's width and height in halves of the picture.
    pixel: vec2f,
    // The empty way between an orthographic camera and `eye`, where its rays begin.
    skipped: f32,
}

@group(0) @binding(0) var<uniform> relievo_view: RelievoCameraView;
@group(0) @binding(1) var<uniform> relievo_lights: array<RelievoLight, RELIEVO_MAX_LIGHTS>;

// How a point is seen.
struct RelievoViewRay {
    // Where rays begin, and the unit vector back to there.
    origin: vec3f,
    to_eye: vec3f,
    // From the origin to the point.
    distance: f32,
}

fn relievo_view_ray(point: vec3f) -> RelievoViewRay {
    let offset = point - relievo_view.eye;
    if relievo_view.parallel != 0u {
        let distance = dot(offset, relievo_view.forward);
        return RelievoViewRay(point - relievo_view.forward * distance, -relievo_view.forward, distance);
    }
    let distance = length(offset);
    return RelievoViewRay(relievo_view.eye, -offset / distance, distance);
}

// Where a point of the scene lies in the picture.
fn relievo_clip_position(point: vec3f) -> vec4f {
    let offset = point - relievo_view.eye;
    let view_depth = dot(offset, relievo_view.forward);
    let side = vec2f(dot(offset, relievo_view.right), dot(offset, relievo_view.up));
    if relievo_view.parallel != 0u {
        return vec4f(side + relievo_view.jitter, 1.0 - view_depth / relievo_view.far, 1.0);
    }
    // Depth runs from 1 at the near plane to 0 at infinity.
    return vec4f(side + relievo_view.jitter * view_depth, relievo_view.near, view_depth);
}

// The depth, 1 = on the near plane, of what lies this far along the axis.
fn relievo_depth_at(view_depth: f32) -> f32 {
    return clamp(
        select(relievo_view.near / view_depth, 1.0 - view_depth / relievo_view.far, relievo_view.parallel != 0u), 0.0, 1.0);
}
