//! Random numbers from integer hashes: the same on every machine and thread.
//!
//! Words are hashed with pcg3d (Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020): integers only.

/// Hashes three words to three words (pcg3d).
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

/// Converts a hashed word to a number in [0, 1).
pub(crate) fn unit_float(word: u32) -> f32 {
    // The 24 highest bits: all that an f32 holds.
    (word >> 8) as f32 / 16_777_216.0
}

/// Stream of random numbers of one thing (a brick, a plank): a pure function of its id and the seed.
pub(crate) struct HashRng {
    id: u32,
    seed: u32,
    drawn: u32,
}

impl HashRng {
    pub(crate) fn new(id: u32, seed: u32) -> Self {
        Self { id, seed, drawn: 0 }
    }

    /// Returns the next number, in [0, 1).
    pub(crate) fn unit(&mut self) -> f32 {
        self.drawn += 1;
        unit_float(hash3(self.id, self.drawn, self.seed)[0])
    }

    /// Returns the next number, in [-1, 1).
    pub(crate) fn signed(&mut self) -> f32 {
        2.0 * self.unit() - 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_the_same_for_the_same_thing_and_differ_between_things() {
        let draw = |id| HashRng::new(id, 9).unit();
        assert_eq!(draw(4), draw(4));
        let draws: Vec<_> = (0..64).map(draw).collect();
        assert!(draws.iter().all(|x| (0.0..1.0).contains(x)));
        let mean = draws.iter().sum::<f32>() / 64.0;
        assert!((0.35..0.65).contains(&mean), "{mean}");
    }
}
