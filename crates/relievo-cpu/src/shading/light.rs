use glam::{Vec2, Vec3};
use relievo_scene::{Light, ShadingModel};

/// Number of shadow rays to a light with a radius.
const PENUMBRA_SAMPLES: u32 = 16;

/// The light that arrives at a point.
pub(crate) struct Incoming {
    /// Unit vector to the light.
    pub(crate) direction: Vec3,
    /// Scene units; infinite for a directional light.
    pub(crate) distance: f32,
    /// Linear RGB on a surface facing the light.
    pub(crate) color: Vec3,
}

/// Returns the light that arrives at `point`, unshadowed; `None` if there is none.
pub(crate) fn incoming(light: &Light, point: Vec3, model: ShadingModel) -> Option<Incoming> {
    let color = Vec3::from(light.color) * light.intensity;
    let punctual = |position: Vec3| {
        let path = position - point;
        let distance = path.length();
        // Punctual lights of glTF fall off with the squared distance; the tutorials' do not fall off.
        let falloff = if model.is_physical() { 1.0 / (distance * distance).max(1e-8) } else { 1.0 };
        Incoming { direction: path.normalize_or_zero(), distance, color: color * falloff }
    };
    let mut incoming = match (light.kind.position(), light.kind.direction()) {
        (Some(position), _) => punctual(position),
        (None, Some(direction)) => Incoming { direction: -direction, distance: f32::INFINITY, color },
        // A light from nowhere lights nothing.
        (None, None) => return None,
    };
    if let (Some(direction), Some(angles)) = (light.kind.direction(), light.kind.cone_angles()) {
        let [inner, outer] = angles.map(|angle| angle.to_radians().cos());
        let cos = -incoming.direction.dot(direction);
        let x = ((cos - outer) / (inner - outer)).clamp(0.0, 1.0);
        incoming.color *= x * x * (3.0 - 2.0 * x);
    }
    (incoming.direction != Vec3::ZERO && incoming.color != Vec3::ZERO).then_some(incoming)
}

/// Returns directions and distances to points spread over the light: one for a light without a radius.
pub(crate) fn light_points(
    light: &Light,
    incoming: &Incoming,
    rotation: f32,
) -> impl Iterator<Item = (Vec3, f32)> + use<> {
    let (direction, distance) = (incoming.direction, incoming.distance);
    let radius = light.radius;
    let (side, up) = direction.any_orthonormal_pair();
    let count = if radius > 0.0 { PENUMBRA_SAMPLES } else { 1 };
    let directional = light.kind.position().is_none();
    (0..count).map(move |i| {
        if radius <= 0.0 {
            return (direction, distance);
        }
        // Vogel's spiral (1979) covers a disc evenly with any number of points.
        let r = ((i as f32 + 0.5) / count as f32).sqrt() * radius;
        let angle = i as f32 * 2.399_963_2 + rotation;
        let disc = Vec2::from_angle(angle) * r;
        let offset = side * disc.x + up * disc.y;
        if directional {
            ((direction + offset).normalize(), f32::INFINITY)
        } else {
            let path = direction * distance + offset;
            (path.normalize_or_zero(), path.length())
        }
    })
}

/// Returns an angle that differs from pixel to pixel, so that a penumbra's few samples show as fine grain instead of bands
/// (interleaved gradient noise, Jimenez 2014). Radians.
pub(crate) fn pixel_rotation(x: u32, y: u32) -> f32 {
    let inner = (0.067_110_56 * x as f32 + 0.005_837_15 * y as f32).fract();
    (52.982_918 * inner).fract() * std::f32::consts::TAU
}
