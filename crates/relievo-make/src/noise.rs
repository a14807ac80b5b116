//! Periodic lattice noise, a point or a whole row at a time.
//!
//! `basis` has the other bases, `fractal` the sums of their octaves.
//!
//! Gradient noise after Perlin ("Improving noise", SIGGRAPH 2002) with its quintic fade, on a lattice that closes after a
//! whole number of cells, so that every map made of it tiles exactly. The lattice is hashed with pcg3d (Jarzynski and
//! Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020): integers only, the same on every machine and thread.

/// Three well-mixed words from three words.
pub(crate) fn hash3(x: u32, y: u32, seed: u32) -> [u32; 3] {
    let step = |v: u32| v.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    let (mut x, mut y, mut z) = (step(x), step(y), step(seed));
    let stir = |x: &mut u32, y: &mut u32, z: &mut u32| {
        *x = x.wrapping_add(y.wrapping_mul(*z));
        *y = y.wrapping_add(z.wrapping_mul(*x));
        *z = z.wrapping_add(x.wrapping_mul(*y));
    };
    stir(&mut x, &mut y, &mut z);
    (x, y, z) = (x ^ (x >> 16), y ^ (y >> 16), z ^ (z >> 16));
    stir(&mut x, &mut y, &mut z);
    [x, y, z]
}

/// A number in [0, 1) from a hashed word.
pub(crate) fn unit(word: u32) -> f32 {
    // The 24 highest bits: all that an f32 holds.
    (word >> 8) as f32 / 16_777_216.0
}

/// A stream of random numbers for one thing (a brick, a plank): the same thing always gets the same numbers.
pub(crate) struct Dice {
    id: u32,
    seed: u32,
    thrown: u32,
}

impl Dice {
    pub(crate) fn new(id: u32, seed: u32) -> Self {
        Self { id, seed, thrown: 0 }
    }

    /// The next number, in [0, 1).
    pub(crate) fn unit(&mut self) -> f32 {
        self.thrown += 1;
        unit(hash3(self.id, self.thrown, self.seed)[0])
    }

    /// The next number, in [-1, 1).
    pub(crate) fn signed(&mut self) -> f32 {
        2.0 * self.unit() - 1.0
    }
}

/// Scales the raw noise so that its standard deviation is near 1/3: nearly all values lie in [-1, 1].
const GAIN: f32 = 1.75;

/// Gradient noise with `columns × rows` cells per repeat. Values are near [-1, 1], mean 0.
#[derive(Clone, Copy)]
pub(crate) struct Lattice {
    pub(crate) columns: u32,
    pub(crate) rows: u32,
    pub(crate) seed: u32,
}

impl Lattice {
    /// `columns` cells along u and `rows` along v per repeat, both at least 1.
    pub(crate) fn new(columns: u32, rows: u32, seed: u32) -> Self {
        Self { columns, rows, seed }
    }

    /// The noise at (u, v); period 1 in both.
    pub(crate) fn at(&self, u: f32, v: f32) -> f32 {
        let (x, y) = (u * self.columns as f32, v * self.rows as f32);
        let (i, j) = (floor(x), floor(y));
        let (left, fy) = (wrapped(i, self.columns), y - j as f32);
        let lines = self.lines(j);
        GAIN * span([self.edge(left, lines, fy), self.edge(next(left, self.columns), lines, fy)], x - i as f32)
    }

    /// Adds `amplitude ×` the noise along the row at `v` to `out`, whose texel x lies at u = (x + 0.5) / length.
    ///
    /// The same as [`Lattice::at`] for each texel, but hashes each cell once.
    pub(crate) fn add_row(&self, v: f32, amplitude: f32, out: &mut [f32]) {
        let n = out.len();
        let y = v * self.rows as f32;
        let j = floor(y);
        let (lines, fy) = (self.lines(j), y - j as f32);
        let (per_texel, per_cell) = (self.columns as f32 / n as f32, n as f32 / self.columns as f32);
        let amplitude = amplitude * GAIN;
        let first = self.edge(0, lines, fy);
        let mut left = first;
        let mut start = 0;
        for i in 0..self.columns {
            let last = i + 1 == self.columns;
            let right = if last { first } else { self.edge(i + 1, lines, fy) };
            // The first texel whose centre lies in the next cell. Where rounding takes one too many, it lies on the
            // border of the two cells, and both give the same.
            let end = if last { n } else { (((i + 1) as f32 * per_cell + 0.5) as usize).clamp(start, n) };
            let first_fx = (start as f32 + 0.5) * per_texel - i as f32;
            // Counted in i32, which processors turn into floats four at a time.
            for (k, o) in (0i32..).zip(&mut out[start..end]) {
                *o += amplitude * span([left, right], first_fx + k as f32 * per_texel);
            }
            start = end;
            left = right;
        }
    }

    /// The lattice's rows above and below cell row `j`.
    fn lines(&self, j: i32) -> [u32; 2] {
        let above = wrapped(j, self.rows);
        [above, next(above, self.rows)]
    }

    /// The plane `slope·fx + level` that the lattice points of column `i` on two `lines` make, `fy` between them.
    fn edge(&self, i: u32, lines: [u32; 2], fy: f32) -> [f32; 2] {
        let [top, bottom] = lines.map(|j| {
            let word = hash3(i, j, self.seed);
            [2.0 * unit(word[0]) - 1.0, 2.0 * unit(word[1]) - 1.0]
        });
        let t = fade(fy);
        let (a, b) = (top[1] * fy, bottom[1] * (fy - 1.0));
        [top[0] + (bottom[0] - top[0]) * t, a + (b - a) * t]
    }
}

/// The cell `i` of `cells` that repeat, which is mostly in range: divisions are slow.
#[inline]
pub(crate) fn wrapped(i: i32, cells: u32) -> u32 {
    if (i as u32) < cells { i as u32 } else { i.rem_euclid(cells as i32) as u32 }
}

/// `x` rounded down: on processors that are not told to be new, faster than the library's.
#[inline]
pub(crate) fn floor(x: f32) -> i32 {
    let i = x as i32;
    i - i32::from(i as f32 > x)
}

#[inline]
pub(crate) fn next(i: u32, cells: u32) -> u32 {
    if i + 1 == cells { 0 } else { i + 1 }
}

#[inline]
fn span([left, right]: [[f32; 2]; 2], fx: f32) -> f32 {
    let a = left[0] * fx + left[1];
    let b = right[0] * (fx - 1.0) + right[1];
    a + (b - a) * fade(fx)
}

#[inline]
pub(crate) fn fade(t: f32) -> f32 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// Octaves of gradient noise, each twice as fine as the one before, none finer than the texels can show.
#[derive(Clone, Copy)]
pub(crate) struct Fbm {
    base: Lattice,
    octaves: u32,
    gain: f32,
}

impl Fbm {
    /// `octaves` of noise that begin with `base`; each has `gain` times the amplitude of the one before. The sum is
    /// scaled to keep the standard deviation of a single octave.
    pub(crate) fn new(base: Lattice, octaves: u32, gain: f32) -> Self {
        Self { base, octaves, gain }
    }

    /// Every octave that a map with texels of `texel` (in uv) can show, with its amplitude.
    ///
    /// Scaled by the energy of *all* octaves: a smaller map loses detail and keeps the rest as it is.
    fn layers(&self, texel: f32) -> impl Iterator<Item = (Lattice, f32)> {
        let Self { base, octaves, gain } = *self;
        let energy: f32 = (0..octaves).map(|k| gain.powi(2 * k as i32)).sum();
        (0..octaves)
            .map(move |k| {
                let layer = Lattice::new(base.columns << k, base.rows << k, base.seed.wrapping_add(k * 0x9e37));
                let shown = visible(layer.columns.max(layer.rows), texel);
                (layer, shown * gain.powi(k as i32) / energy.sqrt())
            })
            .take_while(|&(_, amplitude)| amplitude > 0.0)
    }

    /// The noise of the whole row at `v`, in place of what `out` held.
    pub(crate) fn row(&self, v: f32, out: &mut [f32]) {
        out.fill(0.0);
        let texel = 1.0 / out.len() as f32;
        for (layer, amplitude) in self.layers(texel) {
            layer.add_row(v, amplitude, out);
        }
    }
}

/// How much of a noise with `cells` per repeat a map with texels of `texel` shows: all where a cell has three texels or
/// more, nothing below one and a half, where it would alias.
pub(crate) fn visible(cells: u32, texel: f32) -> f32 {
    let texels_per_cell = 1.0 / (cells as f32 * texel);
    ((texels_per_cell - 1.5) / 1.5).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_repeats_after_one_in_both_directions() {
        let noise = Lattice::new(5, 7, 3);
        for k in 0..200 {
            let (u, v) = (k as f32 / 64.0, (k * 37 % 101) as f32 / 64.0);
            assert!((noise.at(u, v) - noise.at(u + 1.0, v)).abs() < 1e-4);
            assert!((noise.at(u, v) - noise.at(u, v - 1.0)).abs() < 1e-4);
        }
    }

    #[test]
    fn a_row_equals_its_points_whatever_the_ratio_of_cells_to_texels() {
        for (columns, n) in [(4, 64), (7, 100), (96, 257), (3, 1), (8, 5)] {
            let noise = Lattice::new(columns, 5, 11);
            let mut row = vec![0.0; n];
            noise.add_row(0.37, 0.5, &mut row);
            for (x, value) in row.iter().enumerate() {
                let expected = 0.5 * noise.at((x as f32 + 0.5) / n as f32, 0.37);
                assert!((value - expected).abs() < 1e-4, "{columns} cells, {n} texels, texel {x}");
            }
        }
    }

    #[test]
    fn noise_has_mean_zero_and_a_standard_deviation_of_a_third() {
        let noise = Fbm::new(Lattice::new(16, 16, 1), 3, 0.5);
        let mut values = Vec::new();
        let mut row = vec![0.0; 512];
        for y in 0..512 {
            noise.row((y as f32 + 0.5) / 512.0, &mut row);
            values.extend_from_slice(&row);
        }
        let mean = values.iter().sum::<f32>() / values.len() as f32;
        let deviation = (values.iter().map(|v| (v - mean).powi(2)).sum::<f32>() / values.len() as f32).sqrt();
        assert!(mean.abs() < 0.03, "{mean}");
        assert!((0.28..0.38).contains(&deviation), "{deviation}");
    }

    #[test]
    fn octaves_finer_than_the_texels_are_left_out() {
        let texel = 1.0 / 64.0;
        let coarse = Fbm::new(Lattice::new(8, 8, 5), 1, 0.5);
        let all = Fbm::new(Lattice::new(8, 8, 5), 8, 0.5);
        assert_eq!(coarse.layers(texel).count(), 1);
        // 8, 16 and 32 cells; 64 would have one texel per cell.
        assert_eq!(all.layers(texel).count(), 3);
    }

    #[test]
    fn dice_are_the_same_for_the_same_thing_and_differ_between_things() {
        let throw = |id| Dice::new(id, 9).unit();
        assert_eq!(throw(4), throw(4));
        let throws: Vec<_> = (0..64).map(throw).collect();
        assert!(throws.iter().all(|x| (0.0..1.0).contains(x)));
        let mean = throws.iter().sum::<f32>() / 64.0;
        assert!((0.35..0.65).contains(&mean), "{mean}");
    }
}
