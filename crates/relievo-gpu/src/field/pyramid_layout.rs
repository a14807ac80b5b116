//! Positions of the nodes of a map's pyramids in their texture, and of those that must be computed anew when texels change.

use relievo_march::{MaxPyramid, ReliefMap, TexelRect};

/// Nodes along an axis that belong to one above: 2 bits of an index.
const BITS: u32 = 2;

/// The nodes of all mip levels' pyramids below one another in one texture, after a row of headers: what descent.wgsl reads.
#[derive(Debug)]
pub(crate) struct PyramidLayout {
    /// Texels of the texture.
    pub(crate) size: [u32; 2],
    pub(crate) mips: Vec<MipNodes>,
}

/// Position of the pyramid of one mip level.
#[derive(Debug)]
pub(crate) struct MipNodes {
    /// Texels of the mip level.
    pub(crate) texels: [u32; 2],
    /// The first row, and nodes along u and v, of each level of the pyramid: none in a map of columns.
    pub(crate) levels: Vec<(u32, [u32; 2])>,
}

/// A rectangle: its lower corner, and the upper one, exclusive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TexelSpan {
    pub(crate) min: [u32; 2],
    pub(crate) max: [u32; 2],
}

impl TexelSpan {
    pub(crate) fn size(self) -> [u32; 2] {
        [self.max[0] - self.min[0], self.max[1] - self.min[1]]
    }

    /// All of a map.
    pub(crate) fn all(size: [u32; 2]) -> Self {
        Self { min: [0; 2], max: size }
    }

    /// The nodes that hold these blocks.
    pub(crate) fn nodes(self) -> Self {
        Self { min: self.min.map(|i| i >> BITS), max: self.max.map(|i| ((i - 1) >> BITS) + 1) }
    }

    /// The texels of the next mip level, of this size, that cover any of these.
    pub(crate) fn halved(self, size: [u32; 2]) -> Self {
        // Texel x covers 2x to 2x + 2 at most.
        let axis = |k: usize| (self.min[k].saturating_sub(1) / 2, (self.max[k] - 1) / 2);
        let (x, y) = (axis(0), axis(1));
        let last = size.map(|n| n - 1);
        Self { min: [x.0.min(last[0]), y.0.min(last[1])], max: [x.1.min(last[0]) + 1, y.1.min(last[1]) + 1] }
    }

    /// The cells that have one of these texels as a corner, of a map of this size: those to the left of a texel and above it
    /// too, and of the first one the last.
    pub(crate) fn cells(self, size: [u32; 2]) -> impl Iterator<Item = Self> {
        let spans = [0, 1].map(|k: usize| match self.min[k] {
            0 => [Some((0, self.max[k])), (self.max[k] < size[k]).then_some((size[k] - 1, size[k]))],
            first => [Some((first - 1, self.max[k])), None],
        });
        let columns = spans[0].into_iter().flatten();
        columns
            .flat_map(move |x| spans[1].into_iter().flatten().map(move |y| Self { min: [x.0, y.0], max: [x.1, y.1] }))
    }
}

impl From<TexelRect> for TexelSpan {
    fn from(texels: TexelRect) -> Self {
        Self { min: texels.min, max: [0, 1].map(|k: usize| texels.min[k] + texels.size[k]) }
    }
}

impl PyramidLayout {
    pub(crate) fn new(heights: &ReliefMap) -> Self {
        let pyramids = heights.pyramids();
        let widest = pyramids.first().map_or(1, |finest| finest.level(1).size()[0]);
        let mut row = 1;
        let mips = heights.levels().iter().enumerate().map(|(number, mip)| {
            let levels = pyramids.get(number).into_iter().flat_map(MaxPyramid::levels).map(|level| {
                let size = level.size();
                row += size[1];
                (row - size[1], size)
            });
            MipNodes { texels: [mip.width(), mip.height()], levels: levels.collect() }
        });
        let mips: Vec<_> = mips.collect();
        Self { size: [widest.max(mips.len() as u32), row], mips }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_texel_changes_the_four_cells_around_it_wherever_it_lies() {
        let size = [9, 5];
        for y in 0..size[1] {
            for x in 0..size[0] {
                let part = TexelSpan { min: [x, y], max: [x + 1, y + 1] };
                let mut cells: Vec<_> = part
                    .cells(size)
                    .flat_map(|c| (c.min[1]..c.max[1]).flat_map(move |y| (c.min[0]..c.max[0]).map(move |x| (x, y))))
                    .collect();
                cells.sort_unstable();
                let (left, up) = ((x + 8) % 9, (y + 4) % 5);
                let mut expected = [(left, up), (x, up), (left, y), (x, y)];
                expected.sort_unstable();
                assert_eq!(cells, expected);
            }
        }
        // All of it once.
        assert_eq!(TexelSpan::all(size).cells(size).collect::<Vec<_>>(), [TexelSpan::all(size)]);
        assert_eq!(TexelSpan::all([1, 1]).cells([1, 1]).collect::<Vec<_>>(), [TexelSpan::all([1, 1])]);
    }

    #[test]
    fn halves_cover_what_changed() {
        for n in 2..12u32 {
            let half = n / 2;
            for i in 0..n {
                let part = TexelSpan { min: [i, 0], max: [i + 1, 1] }.halved([half, 1]);
                for x in 0..half {
                    let covers = x * n < (i + 1) * half && i * half < (x + 1) * n;
                    assert!(!covers || (part.min[0]..part.max[0]).contains(&x), "{n}: {i} is in {x}, not in {part:?}");
                }
            }
        }
    }
}
