use relievo_map::Wrap;

/// The texels of a map along one axis, continued for ever as an object addresses them.
#[derive(Clone, Copy)]
pub(super) struct Axis {
    /// Texels in the map.
    n: i64,
    wrap: Wrap,
    /// The first and the last texel of the object's range, where its border stretches beyond.
    stretched: Option<[i64; 2]>,
}

/// Intervals of texels, first and last: the second is a copy of the first where one is all.
pub(super) type Intervals = [[usize; 2]; 2];

impl Axis {
    /// Makes an axis of `n` texels; `stretched` are the first and the last texel beyond which the border goes on.
    pub(super) fn new(n: u32, wrap: Wrap, stretched: Option<[i32; 2]>) -> Self {
        Self { n: i64::from(n), wrap, stretched: stretched.map(|texels| texels.map(i64::from)) }
    }

    /// Returns the texel of the map that stands at this place.
    #[inline]
    pub(super) fn texel(self, i: i64) -> usize {
        let i = self.on_object(i);
        let n = self.n;
        let texel = match self.wrap {
            _ if (0..n).contains(&i) => i,
            Wrap::Repeat => i.rem_euclid(n),
            Wrap::Clamp => i.clamp(0, n - 1),
            Wrap::Mirror => {
                let k = i.rem_euclid(2 * n);
                if k < n { k } else { 2 * n - 1 - k }
            }
        };
        texel as usize
    }

    fn on_object(self, i: i64) -> i64 {
        self.stretched.map_or(i, |[first, last]| i.max(first).min(last))
    }

    /// Returns intervals of the map that hold every texel shown from place `first` to place `last`.
    #[inline]
    pub(super) fn intervals(self, first: i64, last: i64) -> Intervals {
        let (first, last) = (self.on_object(first), self.on_object(last));
        let n = self.n;
        if self.wrap == Wrap::Clamp {
            return [[self.texel(first), self.texel(last)]; 2];
        }
        if first >= 0 && last < n {
            return [[first as usize, last as usize]; 2];
        }
        let (tile, last_tile) = (first.div_euclid(n), last.div_euclid(n));
        let inside = |a: i64, b: i64| {
            let (a, b) = (self.texel(a), self.texel(b));
            [a.min(b), a.max(b)]
        };
        match last_tile - tile {
            0 => [inside(first, last); 2],
            1 => [inside(first, last_tile * n - 1), inside(last_tile * n, last)],
            _ => [[0, n as usize - 1]; 2],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_hold_the_texels_that_are_shown_and_a_place_is_addressed_as_in_the_map() {
        for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
            for stretched in [None, Some([0, 11]), Some([-3, 5])] {
                let axis = Axis::new(5, wrap, stretched);
                for first in -17..17 {
                    for last in first..first + 14 {
                        let intervals = axis.intervals(first, last);
                        let shown: Vec<usize> = (first..=last).map(|i| axis.texel(i)).collect();
                        assert!(shown.iter().all(|t| intervals.iter().any(|[a, b]| (a..=b).contains(&t))));
                        // No wider than needed.
                        let ends = intervals.iter().flatten();
                        assert!(ends.clone().all(|end| shown.contains(end)), "{wrap:?} {first} {last}");
                    }
                    if stretched.is_none() {
                        assert_eq!(axis.texel(first), wrap.index(first as i32, 5) as usize);
                    }
                }
            }
        }
    }
}
