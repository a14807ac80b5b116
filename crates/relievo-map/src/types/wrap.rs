/// What lies beyond the border of a map (texture addressing).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The map tiles.
    #[default]
    Repeat,
    /// The border texels stretch outwards.
    Clamp,
    /// The map tiles, every second time mirrored.
    Mirror,
}

impl Wrap {
    /// Whether the map stands mirrored at coordinate `u`: what points along an axis points the other way there.
    #[inline]
    #[must_use]
    pub fn is_mirrored(self, u: f32) -> bool {
        // The cast saturates, and NaN is 0.
        self == Self::Mirror && (u.floor() as i64).rem_euclid(2) == 1
    }

    /// The texel index in `0..size` that stands for `i`, which may be any integer. `size` must not be 0.
    #[inline]
    #[must_use]
    pub fn index(self, i: i32, size: u32) -> u32 {
        let n = size as i32;
        // Most look-ups are inside, and a division costs more than the comparison.
        if (i as u32) < size {
            return i as u32;
        }
        match self {
            Self::Repeat => i.rem_euclid(n) as u32,
            Self::Clamp => i.clamp(0, n - 1) as u32,
            Self::Mirror => {
                let k = i64::from(i).rem_euclid(2 * i64::from(n));
                let n = i64::from(n);
                (if k < n { k } else { 2 * n - 1 - k }) as u32
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_mode_maps_neighbours_as_the_graphics_apis_do() {
        let at = |wrap: Wrap| (-5..8).map(|i| wrap.index(i, 3)).collect::<Vec<_>>();
        assert_eq!(at(Wrap::Repeat), [1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1]);
        assert_eq!(at(Wrap::Clamp), [0, 0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2, 2]);
        assert_eq!(at(Wrap::Mirror), [1, 2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0, 1]);
    }

    #[test]
    fn every_second_tile_stands_mirrored() {
        let mirrored = [-1.5, -0.5, 0.5, 1.5, 2.0, f32::NAN].map(|u| Wrap::Mirror.is_mirrored(u));
        assert_eq!(mirrored, [false, true, false, true, false, false]);
        assert!(!Wrap::Repeat.is_mirrored(1.5) && !Wrap::Clamp.is_mirrored(1.5));
    }

    #[test]
    fn the_ends_of_i32_are_mapped_too() {
        for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
            for size in [1, 2, 7, 1 << 20] {
                assert!(wrap.index(i32::MIN, size) < size);
                assert!(wrap.index(i32::MAX, size) < size);
            }
        }
    }
}
