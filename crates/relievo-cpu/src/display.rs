use glam::Vec3;
use relievo_map::srgb_to_linear;
use relievo_scene::ColorSpace;

/// Number of buckets of the table: fine enough that at most two steps of display value begin in one.
const BUCKETS: usize = 4096;

/// Conversion of shaded colours to the 8 bits of a display, by table: the sRGB curve costs more than the rest of a plain
/// pixel.
pub(crate) struct Display {
    /// Smallest number that is shown as each step.
    starts: [f32; 256],
    /// Step that the smallest number of each bucket is shown as.
    buckets: Box<[u8; BUCKETS + 1]>,
    space: ColorSpace,
}

impl Display {
    pub(crate) fn new(space: ColorSpace) -> Self {
        let starts = std::array::from_fn(|step| {
            // Rounded to the nearest step: each begins half a step below itself.
            let value = (step as f32 - 0.5) / 255.0;
            match space {
                ColorSpace::Linear => srgb_to_linear(value),
                ColorSpace::Display => value,
            }
        });
        let step_of = |x: f32| (starts.partition_point(|&start: &f32| start <= x) - 1) as u8;
        let mut buckets = Box::new([0; BUCKETS + 1]);
        for (i, bucket) in buckets.iter_mut().enumerate() {
            *bucket = step_of(i as f32 / BUCKETS as f32);
        }
        Self { starts, buckets, space }
    }

    /// Encodes a shaded colour, clamped to what a display can show; NaN becomes black.
    #[inline]
    pub(crate) fn encode(&self, color: Vec3) -> [u8; 3] {
        color.to_array().map(|x| {
            // `max` first: it also turns NaN into 0.
            let x = x.max(0.0).min(1.0);
            let mut step = self.buckets[(x * BUCKETS as f32) as usize];
            while step < 255 && x >= self.starts[step as usize + 1] {
                step += 1;
            }
            step
        })
    }

    /// Decodes a display colour for shading.
    pub(crate) fn decode(&self, rgb: [f32; 3]) -> Vec3 {
        match self.space {
            ColorSpace::Display => rgb.into(),
            ColorSpace::Linear => rgb.map(srgb_to_linear).into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use relievo_map::linear_to_srgb;

    use super::*;

    #[test]
    fn the_table_rounds_as_the_curve_does() {
        for space in [ColorSpace::Linear, ColorSpace::Display] {
            let display = Display::new(space);
            for i in 0..=1_000_000 {
                let x = i as f32 / 1e6;
                let curve = if space == ColorSpace::Linear { linear_to_srgb(x) } else { x };
                let off = f32::from(display.encode(Vec3::splat(x))[0]) - curve * 255.0;
                assert!(off.abs() < 0.501, "{x} is shown as {off} off");
            }
            assert_eq!(display.encode(Vec3::new(f32::NAN, -1.0, f32::INFINITY)), [0, 0, 255]);
        }
    }

    #[test]
    fn display_colours_come_back_as_they_went_in() {
        for space in [ColorSpace::Linear, ColorSpace::Display] {
            let display = Display::new(space);
            for step in 0..=255u8 {
                assert_eq!(display.encode(display.decode([f32::from(step) / 255.0; 3])), [step; 3]);
            }
        }
    }
}
