//! The lab's own height maps, each hard in one way. They tile; a larger map shows more of the same.

use std::f32::consts::TAU;

use relievo_map::{Grid, HeightMap};

/// A map of the corpus: its name, its description, and its height function.
struct CorpusMap {
    name: &'static str,
    description: &'static str,
    height: fn(&Plot, u32, u32) -> f32,
}

const MAPS: [CorpusMap; 4] = [
    CorpusMap {
        name: "solid",
        description: "flat stones with narrow joints: most rays hit the first cell",
        height: solid,
    },
    CorpusMap { name: "airy", description: "thin pillars on a deep floor: rays go far before they hit", height: airy },
    CorpusMap { name: "noise", description: "every texel at random: no block is free", height: noise },
    CorpusMap {
        name: "spikes",
        description: "needles one texel wide on a deep floor: whoever steps misses them",
        height: spikes,
    },
];

/// The names of the lab's own height maps, as [`corpus`] takes them.
#[must_use]
pub fn corpus_names() -> Vec<&'static str> {
    MAPS.iter().map(|map| map.name).collect()
}

/// A short description of a map of the corpus; `None` if there is none of that name.
#[must_use]
pub fn corpus_description(name: &str) -> Option<&'static str> {
    MAPS.iter().find(|map| map.name == name).map(|map| map.description)
}

/// Generates the map of the corpus called `name`, `size` × `size` texels; `None` if there is none of that name.
///
/// # Panics
/// If `size` is 0 or over [`Grid::MAX_SIDE`].
#[must_use]
pub fn corpus(name: &str, size: u32) -> Option<HeightMap> {
    let map = MAPS.iter().find(|map| map.name == name)?;
    let plot = Plot::new(size);
    Some(HeightMap::new(Grid::from_fn(size, size, |x, y| (map.height)(&plot, x, y))))
}

/// The map cut into square plots of about 32 texels, each with random numbers of its own.
struct Plot {
    plots: u32,
    side: f32,
}

impl Plot {
    fn new(size: u32) -> Self {
        let plots = (size / 32).max(1);
        Self { plots, side: size as f32 / plots as f32 }
    }

    /// The index of the plot along one axis, and the distance into it in texels.
    fn at(&self, x: f32) -> (u32, f32) {
        let plot = (x / self.side).floor();
        ((plot as i64).rem_euclid(i64::from(self.plots)) as u32, x - plot * self.side)
    }
}

/// SplitMix64 (Steele et al. 2014) of a position: in [0, 1).
fn random(x: u32, y: u32, which: u64) -> f32 {
    let position = u64::from(x) << 32 | u64::from(y);
    let mut z =
        position.wrapping_mul(0xd134_2543_de82_ef95).wrapping_add(0x9e37_79b9_7f4a_7c15u64.wrapping_mul(which + 1));
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 40) as f32 / (1u64 << 24) as f32
}

fn solid(plot: &Plot, x: u32, y: u32) -> f32 {
    // Two courses to a plot, the second shifted by half a stone where the map is large enough.
    let (row, into) = plot.at(y as f32);
    let course = row * 2 + u32::from(into >= 0.5 * plot.side);
    let offset = if course % 2 == 1 { 0.5 * plot.side } else { 0.0 };
    let (stone, across) = plot.at(x as f32 + offset);
    let down = into % (0.5 * plot.side);
    let joint = across.min(down);
    // A joint of two texels, an edge of one.
    if joint < 2.0 { 0.0 } else { (0.94 + 0.06 * random(stone, course, 1)) * (joint - 1.0).min(1.0) }
}

fn airy(plot: &Plot, x: u32, y: u32) -> f32 {
    let ((column, across), (row, down)) = (plot.at(x as f32), plot.at(y as f32));
    let floor = 0.05 + 0.05 * (TAU * 3.0 * x as f32 / (plot.side * plot.plots as f32)).sin();
    if random(column, row, 2) < 0.4 {
        return floor;
    }
    let radius = plot.side * (0.04 + 0.06 * random(column, row, 3));
    let centre = |which| plot.side * (0.2 + 0.6 * random(column, row, which));
    let distance = (across - centre(4)).hypot(down - centre(5));
    if distance < radius { 0.5 + 0.5 * random(column, row, 6) } else { floor }
}

fn noise(_: &Plot, x: u32, y: u32) -> f32 {
    random(x, y, 7)
}

fn spikes(_: &Plot, x: u32, y: u32) -> f32 {
    if random(x, y, 8) < 1.0 / 128.0 { 0.6 + 0.4 * random(x, y, 9) } else { 0.04 * random(x, y, 10) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_map_is_what_it_is_called() {
        let mean = |name| {
            let map = corpus(name, 256).unwrap();
            map.grid().texels().iter().sum::<f32>() / 65536.0
        };
        assert!(mean("solid") > 0.7, "{}", mean("solid"));
        assert!((0.05..0.2).contains(&mean("airy")), "{}", mean("airy"));
        assert!((0.48..0.52).contains(&mean("noise")), "{}", mean("noise"));
        let spikes = corpus("spikes", 256).unwrap();
        let high = spikes.grid().texels().iter().filter(|&&h| h > 0.5).count();
        assert!((300..800).contains(&high), "{high}");
        assert!(corpus("spiky", 8).is_none() && corpus_names().iter().all(|name| corpus_description(name).is_some()));
    }

    #[test]
    fn every_size_is_possible() {
        for name in corpus_names() {
            for size in [1, 7, 33, 100] {
                let map = corpus(name, size).unwrap();
                assert_eq!((map.grid().width(), map.grid().height()), (size, size));
                assert!(map.grid().texels().iter().all(|h| h.is_finite()));
            }
        }
    }
}
