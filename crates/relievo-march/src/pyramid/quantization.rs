use rayon::prelude::*;
use relievo_map::Grid;

/// Steps from the lowest height of a map to the highest, among which the quantized heights are chosen.
const STEPS: u32 = 1 << 14;

/// A quantization to 8 bits with uneven steps, which are narrow where the map has many cells.
#[derive(Clone, Debug)]
pub(super) struct Quantization {
    /// The lowest height, and steps per unit of height.
    low: f32,
    per_height: f32,
    /// The quantized height of each step.
    of_steps: Vec<u8>,
    /// The height of each quantized height.
    heights: Box<[f32; 256]>,
}

impl Quantization {
    /// Fits the steps to the cells of this map, which lie between two different heights, now and after updates.
    pub(super) fn new(map: &Grid<f32>, [low, high]: [f32; 2]) -> Self {
        let per_height = STEPS as f32 / (high - low);
        let mut quantization =
            Self { low, per_height, of_steps: vec![0; STEPS as usize + 1], heights: Box::new([high; 256]) };
        let none = || vec![0u32; quantization.of_steps.len()];
        let size = [map.width() as usize, map.height() as usize];
        // Texels serve as well as cells, and a quarter of the rows is enough.
        let counts = (0..size[1]).into_par_iter().step_by(4).fold(none, |mut counts, y| {
            map.texels()[y * size[0]..(y + 1) * size[0]].iter().for_each(|&h| counts[quantization.step(h)] += 1);
            counts
        });
        let counts = counts.reduce(none, |mut a, b| {
            a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
            a
        });
        // A fifth of the quantized heights are spread evenly, for heights that are rare.
        let total: u64 = counts.iter().map(|&count| u64::from(count)).sum();
        let weight = |count: u32| 4 * u64::from(count) * u64::from(STEPS) + total;
        let mut rest: u64 = counts.iter().map(|&count| weight(count)).sum();
        let (mut quantized, mut taken) = (0u8, 0);
        for (step, &count) in counts.iter().enumerate() {
            quantization.of_steps[step] = quantized;
            quantization.heights[usize::from(quantized)] = low + step as f32 / per_height;
            taken += weight(count);
            // Its share of the rest, when it began.
            if quantized < u8::MAX && taken * (256 - u64::from(quantized)) >= rest {
                (rest, taken, quantized) = (rest - taken, 0, quantized + 1);
            }
        }
        // Quantized heights without a step are as high as the highest.
        quantization.heights[usize::from(quantization.of_steps[STEPS as usize])..].fill(high);
        quantization
    }

    /// Returns the first step that is not below this height, but for the rounding of f32: [`super::node::SLACK`] is more.
    #[inline]
    fn step(&self, h: f32) -> usize {
        // Not `ceil`, which is a call on processors that are not known to have it.
        (((h - self.low) * self.per_height + (1.0 - 1e-3)) as u32).min(STEPS) as usize
    }

    /// Returns the smallest quantized height that is not below this one.
    #[inline]
    pub(super) fn quantized(&self, h: f32) -> u8 {
        self.of_steps[self.step(h)]
    }

    /// Returns the height of each quantized height.
    pub(super) fn heights(&self) -> &[f32; 256] {
        &self.heights
    }

    pub(super) fn bytes(&self) -> usize {
        self.of_steps.len() + size_of_val(self.heights.as_slice())
    }
}
