//! What is the same for a whole picture.
//!
//! Gives view (camera and shading), lights, Sight, sight, depth_ahead; declares their bindings, group 0.
//! #import light

const MAX_LIGHTS: u32 = 64u;

struct View {
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
    turn: f32,
    // How far the picture is moved, in halves of it, so that the sample lies in the pixel's middle.
    shift: vec2f,
    // Not 0: all rays run along `forward`, as those of a directional light do; `far` is where they end.
    parallel: u32,
    far: f32,
    // A pixel's width and height in halves of the picture.
    pixel: vec2f,
}

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var<uniform> lights: array<Light, MAX_LIGHTS>;

// How a point is seen.
struct Sight {
    // Where rays begin, and the unit vector back to there.
    origin: vec3f,
    toward: vec3f,
    // From the origin to the point.
    distance: f32,
}

fn sight(point: vec3f) -> Sight {
    let way = point - view.eye;
    if view.parallel != 0u {
        let distance = dot(way, view.forward);
        return Sight(point - view.forward * distance, -view.forward, distance);
    }
    let distance = length(way);
    return Sight(view.eye, -way / distance, distance);
}

// The depth, 1 = on the near plane, of what lies this far along the axis.
fn depth_ahead(ahead: f32) -> f32 {
    return clamp(select(view.near / ahead, 1.0 - ahead / view.far, view.parallel != 0u), 0.0, 1.0);
}
