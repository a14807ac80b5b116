//! The bases of noise.

use super::lattice::GradientNoise;
use super::periodic::{floor_i32, next_cell, wrap_cell, wrap_unit};
use super::random::{hash3, unit_float};
use super::slices::Slices;
use crate::curve::fade;

/// The pattern of one octave of [`Noise`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Basis {
    /// Gradients on a lattice (Perlin, "Improving noise", SIGGRAPH 2002): about -1..1, mean 0, smooth.
    #[default]
    Perlin,
    /// Numbers on a lattice with the same quintic between them: -1..1, mean 0, blotchy.
    Value,
    /// Distance to the nearest of one random point per cell (Worley, "A cellular texture basis function", SIGGRAPH
    /// 1996), in cells: 0 to about 1.
    WorleyF1,
    /// Distance to the second nearest, in cells: 0 to about 1.5.
    WorleyF2,
    /// F2 − F1: 0 on the borders of the points' cells, up to about 1.
    WorleyEdge,
}

impl Basis {
    /// All bases and their names in recipes.
    pub const ALL: [(&'static str, Self); 5] = [
        ("perlin", Self::Perlin),
        ("value", Self::Value),
        ("worley-f1", Self::WorleyF1),
        ("worley-f2", Self::WorleyF2),
        ("worley-edge", Self::WorleyEdge),
    ];

    /// Returns the mean over the plane, which replaces an octave too fine to be shown.
    pub(crate) fn mean(self) -> f32 {
        match self {
            Self::Perlin | Self::Value => 0.0,
            // Measured over 4·10⁵ points.
            Self::WorleyF1 => 0.429,
            Self::WorleyF2 => 0.698,
            Self::WorleyEdge => 0.269,
        }
    }
}

/// One octave of noise that repeats exactly after 1 in u and v, whatever the size of the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Noise {
    /// The pattern.
    pub basis: Basis,
    /// Cells along u per repeat, at least 1.
    pub columns: u32,
    /// Cells along v per repeat, at least 1.
    pub rows: u32,
    /// Seed of the lattice's hashes.
    pub seed: u32,
    /// Cells along time in a loop; 0 = it stands still. The loop closes exactly, and the noise begins as the still one.
    pub time_cells: u32,
}

impl Noise {
    /// Samples the noise at (u, v) at the beginning of its loop, in the range of its [`Basis`]. Coordinates outside of [0, 1)
    /// repeat; NaN counts as 0.
    #[must_use]
    pub fn at(&self, u: f32, v: f32) -> f32 {
        self.at_phase(u, v, 0.0)
    }

    /// Samples the noise at (u, v) at a phase of its loop: 0 is the beginning, 1 the same again.
    #[must_use]
    pub fn at_phase(&self, u: f32, v: f32, phase: f64) -> f32 {
        Octave::new(self, phase).at(u, v)
    }
}

/// A [`Noise`] at a moment of its loop.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Octave {
    pub(crate) basis: Basis,
    pub(crate) columns: u32,
    pub(crate) rows: u32,
    pub(crate) seed: u32,
    pub(crate) slices: Option<Slices>,
}

impl Octave {
    pub(crate) fn new(noise: &Noise, phase: f64) -> Self {
        let &Noise { basis, columns, rows, seed, time_cells } = noise;
        Self { basis, columns, rows, seed, slices: Slices::around(seed, time_cells, phase) }
    }

    pub(crate) fn gradients(&self) -> GradientNoise {
        GradientNoise { columns: self.columns, rows: self.rows, seed: self.seed, slices: self.slices }
    }

    pub(crate) fn at(&self, u: f32, v: f32) -> f32 {
        let (u, v) = (wrap_unit(u), wrap_unit(v));
        match self.basis {
            Basis::Perlin => self.gradients().at(u, v),
            Basis::Value => self.value(u, v),
            Basis::WorleyF1 => self.worley(u, v)[0],
            Basis::WorleyF2 => self.worley(u, v)[1],
            Basis::WorleyEdge => {
                let [first, second] = self.worley(u, v);
                second - first
            }
        }
    }

    /// Returns two random numbers in [0, 1) of a cell, which go from those of a slice to those of the next.
    fn random(&self, i: u32, j: u32) -> [f32; 2] {
        let unit = |seed: u32| {
            let word = hash3(i, j, seed);
            [unit_float(word[0]), unit_float(word[1])]
        };
        let Some(Slices { seeds, weight, .. }) = self.slices else { return unit(self.seed) };
        let (before, after) = (unit(seeds[0]), unit(seeds[1]));
        std::array::from_fn(|k| before[k] + (after[k] - before[k]) * weight)
    }

    fn value(&self, u: f32, v: f32) -> f32 {
        let (x, y) = (u * self.columns as f32, v * self.rows as f32);
        let (i, j) = (floor_i32(x), floor_i32(y));
        let (fx, fy) = (fade(x - i as f32), fade(y - j as f32));
        let (left, top) = (wrap_cell(i, self.columns), wrap_cell(j, self.rows));
        let (right, bottom) = (next_cell(left, self.columns), next_cell(top, self.rows));
        let corner = |i, j| 2.0 * self.random(i, j)[0] - 1.0;
        let above = corner(left, top) + (corner(right, top) - corner(left, top)) * fx;
        let below = corner(left, bottom) + (corner(right, bottom) - corner(left, bottom)) * fx;
        above + (below - above) * fy
    }

    /// Returns the distances to the nearest and the second nearest point, in cells.
    fn worley(&self, u: f32, v: f32) -> [f32; 2] {
        let (x, y) = (u * self.columns as f32, v * self.rows as f32);
        let (i, j) = (floor_i32(x), floor_i32(y));
        let (fx, fy) = (x - i as f32, y - j as f32);
        let mut nearest = [f32::MAX; 2];
        // F1 is at most √2 and F2 at most √5, but beyond two cells a point is farther than 1, and the second nearest
        // of the 25 is nearly never farther: the ring beyond is looked at only then.
        for ring in 0..=3i32 {
            if ring >= 2 && nearest[1] <= ((ring - 1) * (ring - 1)) as f32 {
                break;
            }
            for dj in -ring..=ring {
                let row = wrap_cell(j.wrapping_add(dj), self.rows);
                let step = if dj.abs() == ring { 1 } else { (2 * ring).max(1) };
                let mut di = -ring;
                while di <= ring {
                    let [x, y] = self.random(wrap_cell(i.wrapping_add(di), self.columns), row);
                    let (dx, dy) = (di as f32 + x - fx, dj as f32 + y - fy);
                    let d = dx * dx + dy * dy;
                    if d < nearest[0] {
                        nearest = [d, nearest[0]];
                    } else if d < nearest[1] {
                        nearest[1] = d;
                    }
                    di += step;
                }
            }
        }
        nearest.map(f32::sqrt)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> impl Iterator<Item = Noise> {
        Basis::ALL.into_iter().map(|(_, basis)| Noise { basis, columns: 5, rows: 3, seed: 7, time_cells: 3 })
    }

    #[test]
    fn every_basis_repeats_after_one() {
        for noise in all() {
            for k in 0..100 {
                // Multiples of 2⁻⁶, which f32 holds exactly with any whole number added.
                let (u, v) = ((k % 64) as f32 / 64.0, (k * 37 % 64) as f32 / 64.0);
                assert_eq!(noise.at(u, v), noise.at(u + 3.0, v - 2.0), "{noise:?}");
                let phase = f64::from(k) / 100.0;
                assert_eq!(noise.at_phase(u, v, phase), noise.at_phase(u - 1.0, v + 1.0, phase), "{noise:?}");
                assert_eq!(noise.at_phase(u, v, 1.0), Noise { time_cells: 0, ..noise }.at(u, v), "{noise:?}");
            }
        }
    }

    #[test]
    fn worley_distances_are_those_to_the_points_found_one_by_one() {
        let noise = |basis| Noise { basis, columns: 4, rows: 4, seed: 3, time_cells: 0 };
        let points: Vec<[f32; 2]> = (-8..12)
            .flat_map(|j: i32| (-8..12).map(move |i: i32| (i, j)))
            .map(|(i, j)| {
                let word = hash3(i.rem_euclid(4) as u32, j.rem_euclid(4) as u32, 3);
                [i as f32 + unit_float(word[0]), j as f32 + unit_float(word[1])]
            })
            .collect();
        for k in 0..500 {
            let (u, v) = ((k as f32 * 0.618_034).fract(), (k as f32 * 0.414_214).fract());
            let mut distances: Vec<f32> = points.iter().map(|p| (p[0] - 4.0 * u).hypot(p[1] - 4.0 * v)).collect();
            distances.sort_by(f32::total_cmp);
            assert!((noise(Basis::WorleyF1).at(u, v) - distances[0]).abs() < 1e-5);
            assert!((noise(Basis::WorleyF2).at(u, v) - distances[1]).abs() < 1e-5);
            assert!((noise(Basis::WorleyEdge).at(u, v) - (distances[1] - distances[0])).abs() < 1e-5);
        }
    }

    #[test]
    fn the_means_are_as_told() {
        for (_, basis) in Basis::ALL {
            let noise = Noise { basis, columns: 64, rows: 64, seed: 1, time_cells: 0 };
            let sum: f64 =
                (0..90_000).map(|k| f64::from(noise.at((k % 300) as f32 / 300.0, (k / 300) as f32 / 300.0))).sum();
            assert!((sum / 90_000.0 - f64::from(basis.mean())).abs() < 0.02, "{basis:?}: {}", sum / 90_000.0);
        }
    }

    #[test]
    fn odd_coordinates_give_finite_numbers() {
        for noise in all() {
            for u in [f32::NAN, f32::INFINITY, -1e30, 1e30, -1e-30] {
                assert!(noise.at(u, 0.5).is_finite() && noise.at(0.5, u).is_finite());
            }
        }
    }
}
