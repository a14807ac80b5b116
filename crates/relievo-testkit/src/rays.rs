use relievo_march::Ray;

use crate::Random;

/// Returns a ray from straight down to 0.5° above the surface; now and then along an axis or through texel centres, where
/// cell borders coincide.
pub fn ray(random: &mut Random, size: [u32; 2]) -> Ray {
    let cos =
        if random.next_u64().is_multiple_of(4) { 0.01 + 0.1 * random.unit() } else { 0.05 + 0.95 * random.unit() };
    let (sin, mut angle) = ((1.0 - cos * cos).max(0.0).sqrt(), random.unit() * std::f32::consts::TAU);
    if random.next_u64().is_multiple_of(16) {
        angle = (random.next_u64() % 8) as f32 * std::f32::consts::FRAC_PI_4;
    }
    let depth = (1.0 + 60.0 * random.unit()) / size[0].max(size[1]).max(16) as f32;
    let mut uv = [random.unit() * 3.0 - 1.0, random.unit() * 3.0 - 1.0];
    if random.next_u64().is_multiple_of(16) {
        uv = [0, 1].map(|k| ((uv[k] * size[k] as f32).floor() + 0.5) / size[k] as f32);
    }
    let direction = if random.next_u64().is_multiple_of(16) { [1.0, 0.0] } else { [angle.cos(), angle.sin()] };
    Ray { uv, uv_delta: direction.map(|x: f32| x * sin * depth), cos }
}

/// Returns a tile of 8×4 neighbours of a ray, a texel apart, that see the relief in perspective.
pub fn tile(first: Ray, size: [u32; 2]) -> impl Iterator<Item = Ray> {
    (0..32).map(move |k| {
        let at = [(k % 8) as f32, (k / 8) as f32];
        let uv = [0, 1].map(|k| first.uv[k] + at[k] / size[k] as f32);
        let uv_delta = [0, 1].map(|k| first.uv_delta[k] * (1.0 + 0.002 * at[k]));
        Ray { uv, uv_delta, cos: first.cos * (1.0 + 0.001 * at[1]) }
    })
}
