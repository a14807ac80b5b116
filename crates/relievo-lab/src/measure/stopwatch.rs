/// The best time of each part of some rays: an interruption spoils one part of one round.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stopwatch {
    /// Rays and seconds.
    parts: Vec<(usize, f64)>,
}

impl Stopwatch {
    /// Adds a round of one part.
    pub(super) fn add(&mut self, part: usize, rays: usize, seconds: f64) {
        match self.parts.get_mut(part) {
            Some(best) => best.1 = best.1.min(seconds),
            None => self.parts.push((rays, seconds)),
        }
    }

    /// Nanoseconds per ray over all parts.
    pub(crate) fn ns_per_ray(&self) -> f64 {
        let (rays, seconds) = self.parts.iter().fold((0, 0.0), |sum, part| (sum.0 + part.0, sum.1 + part.1));
        seconds * 1e9 / rays.max(1) as f64
    }
}
