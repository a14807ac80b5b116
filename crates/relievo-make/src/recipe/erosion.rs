//! Hydraulic erosion: rain that carves valleys.

use crate::noise::{HashRng, wrap_unit};

/// Cells per side of the grid on which water runs, whatever the size of the map: a larger map shows the same valleys.
pub(crate) const GRID: usize = 512;

/// Hydraulic erosion by single drops of water (after Beyer, "Implementation of a method for hydraulic erosion", 2015) on
/// ground that repeats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Erosion {
    /// Number of drops.
    pub(crate) drops: u32,
    /// The full range of heights as a fraction of one repeat: how steep the ground is.
    pub(crate) relief: f32,
    /// Fraction of its free capacity that a drop takes at each step, 0..1.
    pub(crate) strength: f32,
    pub(crate) seed: u32,
}

/// Weight of a drop's direction before the step.
const INERTIA: f32 = 0.1;
const CAPACITY: f32 = 6.0;
const MIN_SLOPE: f32 = 0.01;
const DEPOSITION: f32 = 0.25;
const EVAPORATION: f32 = 0.02;
const GRAVITY: f32 = 4.0;
/// Steps of a drop.
const LIFE: usize = 64;
/// Radius that a drop carves, in cells.
const BRUSH: i32 = 3;

/// Change of the ground, and the water that ran over it.
pub(crate) struct Eroded {
    /// Change of height, negative where the ground sank, in the units of its heights, `GRID × GRID`.
    pub(crate) change: Vec<f32>,
    /// 0 dry, towards 1 a river, `GRID × GRID`.
    pub(crate) flow: Vec<f32>,
}

impl Erosion {
    /// Erodes `ground`, `GRID × GRID` heights in 0..1. One drop after the other, as the order shapes the valleys.
    pub(crate) fn run(&self, ground: &[f32]) -> Eroded {
        // In cells, so that slopes are slopes.
        let unit = self.relief * GRID as f32;
        let mut height: Vec<f32> = ground.iter().map(|h| h * unit).collect();
        let mut flow = vec![0.0f32; height.len()];
        let brush = brush();
        for drop in 0..self.drops {
            let mut rng = HashRng::new(drop, self.seed);
            let at = [rng.unit() * GRID as f32, rng.unit() * GRID as f32];
            self.fall(&mut height, &mut flow, at, &brush);
        }
        let change = height.iter().zip(ground).map(|(h, g)| h / unit - g).collect();
        // Rivers carry thousands of drops, brooks a few: their logarithm.
        let most = (1.0 + flow.iter().copied().fold(0.0f32, f32::max)).ln().max(1e-6);
        let flow = flow.iter().map(|f| (1.0 + f).ln() / most).collect();
        Eroded { change, flow }
    }

    fn fall(&self, height: &mut [f32], flow: &mut [f32], mut at: [f32; 2], brush: &[(i32, i32, f32)]) {
        let mut direction = [0.0f32; 2];
        let (mut speed, mut water, mut load) = (1.0f32, 1.0f32, 0.0f32);
        for _ in 0..LIFE {
            let here = BilinearPoint::new(at);
            let (level, slope) = here.ground(height);
            direction = [0, 1].map(|k| direction[k] * INERTIA - slope[k] * (1.0 - INERTIA));
            let length = direction[0].hypot(direction[1]);
            if length < 1e-6 {
                break;
            }
            direction = direction.map(|w| w / length);
            at = [0, 1].map(|k| wrap_unit((at[k] + direction[k]) / GRID as f32) * GRID as f32);
            let downhill = BilinearPoint::new(at);
            let fall = level - downhill.ground(height).0;
            flow[here.index(0, 0)] += water;
            let capacity = fall.max(MIN_SLOPE) * speed * water * CAPACITY;
            if fall < 0.0 || load > capacity {
                // Up a slope: fill the hollow behind, but no higher than the slope.
                let drop = if fall < 0.0 { load.min(-fall) } else { (load - capacity) * DEPOSITION };
                load -= drop;
                here.add(height, drop);
            } else {
                let take = ((capacity - load) * self.strength).min(fall);
                for &(dx, dy, weight) in brush {
                    height[here.index(dx, dy)] -= take * weight;
                }
                load += take;
            }
            speed = (speed * speed + fall * GRAVITY).max(0.0).sqrt().min(20.0);
            water *= 1.0 - EVAPORATION;
        }
        BilinearPoint::new(at).add(height, load);
    }
}

/// A point between four cells, for bilinear weights.
struct BilinearPoint {
    cell: [i32; 2],
    part: [f32; 2],
}

impl BilinearPoint {
    fn new(at: [f32; 2]) -> Self {
        let cell = at.map(|x| x as i32);
        Self { cell, part: [at[0] - cell[0] as f32, at[1] - cell[1] as f32] }
    }

    fn index(&self, dx: i32, dy: i32) -> usize {
        let wrap = |x: i32| (x.rem_euclid(GRID as i32)) as usize;
        wrap(self.cell[1] + dy) * GRID + wrap(self.cell[0] + dx)
    }

    /// Returns height and slope.
    fn ground(&self, height: &[f32]) -> (f32, [f32; 2]) {
        let [a, b, c, d] = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| height[self.index(x, y)]);
        let [x, y] = self.part;
        let slope = [(b - a) * (1.0 - y) + (d - c) * y, (c - a) * (1.0 - x) + (d - b) * x];
        let level = (a * (1.0 - x) + b * x) * (1.0 - y) + (c * (1.0 - x) + d * x) * y;
        (level, slope)
    }

    fn add(&self, height: &mut [f32], amount: f32) {
        let [x, y] = self.part;
        for (dx, dy, weight) in
            [(0, 0, (1.0 - x) * (1.0 - y)), (1, 0, x * (1.0 - y)), (0, 1, (1.0 - x) * y), (1, 1, x * y)]
        {
            height[self.index(dx, dy)] += amount * weight;
        }
    }
}

fn brush() -> Vec<(i32, i32, f32)> {
    let weight = |x: i32, y: i32| ((BRUSH as f32) - (x as f32).hypot(y as f32)).max(0.0);
    let all = (-BRUSH..=BRUSH).flat_map(|y| (-BRUSH..=BRUSH).map(move |x| (x, y)));
    let sum: f32 = all.clone().map(|(x, y)| weight(x, y)).sum();
    all.map(|(x, y)| (x, y, weight(x, y) / sum)).filter(|b| b.2 > 0.0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rain_moves_ground_downhill_and_loses_little() {
        let hill: Vec<f32> = (0..GRID * GRID)
            .map(|k| {
                let (x, y) = ((k % GRID) as f32 / GRID as f32 - 0.5, (k / GRID) as f32 / GRID as f32 - 0.5);
                (0.9 - 1.6 * x.hypot(y)).max(0.1)
            })
            .collect();
        let eroded = Erosion { drops: 5000, relief: 0.3, strength: 0.3, seed: 1 }.run(&hill);
        let sum: f32 = eroded.change.iter().sum();
        let moved: f32 = eroded.change.iter().map(|c| c.abs()).sum();
        assert!(moved > 1.0 && sum.abs() < 0.05 * moved, "{moved} moved, {sum} lost");
        let flank = |low: f32, high: f32| -> f32 {
            (0..GRID * GRID).filter(|&k| (low..high).contains(&hill[k])).map(|k| eroded.change[k]).sum()
        };
        assert!(flank(0.4, 0.85) < 0.0 && flank(0.0, 0.15) > 0.0);
        assert!(eroded.flow.iter().all(|f| (0.0..=1.0).contains(f)));
    }
}
