//! Voronoi cells on the torus, with Lloyd relaxation.

use crate::noise::{HashRng, hash3, unit_float, wrap_unit};

/// Sites in the unit square, which repeats, and the Voronoi cells around them.
#[derive(Clone, Debug)]
pub struct Voronoi {
    sites: Vec<[f32; 2]>,
    /// Buckets per side.
    side: usize,
    /// Index in `order` of each bucket's first site.
    starts: Vec<u32>,
    /// Indices of sites, bucket by bucket.
    order: Vec<u32>,
}

/// A point located in its [`Voronoi`] cell. Lengths in uv.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellPoint {
    /// Index of the cell.
    pub cell: u32,
    /// Offset from the cell's site to the point.
    pub from_site: [f32; 2],
    /// Distance to the nearest border of the cell.
    pub edge: f32,
    /// Index of the cell beyond that border.
    pub neighbor: u32,
}

impl Voronoi {
    /// The most sites; more than any recipe needs.
    pub const MAX_SITES: u32 = 1 << 16;

    /// Builds the cells around `sites`, of which the first [`Voronoi::MAX_SITES`] are used; none count as one in the middle.
    /// Coordinates are wrapped into [0, 1).
    #[must_use]
    pub fn new(mut sites: Vec<[f32; 2]>) -> Self {
        sites.truncate(Self::MAX_SITES as usize);
        if sites.is_empty() {
            sites.push([0.5; 2]);
        }
        for site in &mut sites {
            *site = site.map(wrap_unit);
        }
        let side = (sites.len() as f32).sqrt().ceil().max(1.0) as usize;
        let bucket = |site: &[f32; 2]| {
            let [i, j] = site.map(|x| ((x * side as f32) as usize).min(side - 1));
            j * side + i
        };
        let mut starts = vec![0u32; side * side + 1];
        for site in &sites {
            starts[bucket(site) + 1] += 1;
        }
        for k in 0..side * side {
            starts[k + 1] += starts[k];
        }
        let mut order = vec![0u32; sites.len()];
        let mut cursor = starts.clone();
        for (k, site) in (0u32..).zip(&sites) {
            let slot = &mut cursor[bucket(site)];
            order[*slot as usize] = k;
            *slot += 1;
        }
        Self { sites, side, starts, order }
    }

    /// Builds the cells of `count` random sites after `relax` steps of Lloyd's algorithm (Lloyd 1982) on the torus: 0 keeps
    /// them random, 3 gives cobbles, 20 nearly hexagons.
    ///
    /// Centroids are means over 16 samples per cell, so that the result depends on nothing but the arguments.
    #[must_use]
    pub fn relaxed(count: u32, relax: u32, seed: u32) -> Self {
        let count = count.clamp(1, Self::MAX_SITES);
        let sites = (0..count)
            .map(|id| {
                // Not the numbers that the cell itself will have: else those would tell where it lies.
                let mut rng = HashRng::new(id, seed ^ 0x517e_5eed);
                [rng.unit(), rng.unit()]
            })
            .collect();
        let mut cells = Self::new(sites);
        let samples = (4.0 * (count as f32).sqrt()).ceil().max(16.0) as usize;
        for _ in 0..relax {
            let mut sums = vec![[0.0f32; 3]; cells.sites.len()];
            for k in 0..samples * samples {
                let at = [k % samples, k / samples].map(|i| (i as f32 + 0.5) / samples as f32);
                let (cell, from) = cells.nearest(at);
                let sum = &mut sums[cell as usize];
                *sum = [sum[0] + from[0], sum[1] + from[1], sum[2] + 1.0];
            }
            let moved = cells.sites.iter().zip(&sums).map(|(site, sum)| {
                let n = sum[2].max(1.0);
                [site[0] + sum[0] / n, site[1] + sum[1] / n]
            });
            cells = Self::new(moved.collect());
        }
        cells
    }

    /// Builds hexagons in `columns × rows` (rows rounded up to an even number), every second row offset by half a cell.
    /// Regular where rows = 1.1547 columns.
    #[must_use]
    pub fn hexagons(columns: u32, rows: u32) -> Self {
        let (columns, rows) = (columns.clamp(1, 256), rows.clamp(2, 256).next_multiple_of(2));
        let site = |i: u32, j: u32| {
            [(i as f32 + 0.25 + 0.5 * (j % 2) as f32) / columns as f32, (j as f32 + 0.5) / rows as f32]
        };
        Self::new((0..rows).flat_map(|j| (0..columns).map(move |i| site(i, j))).collect())
    }

    /// Returns the sites, each in [0, 1)².
    #[must_use]
    pub fn sites(&self) -> &[[f32; 2]] {
        &self.sites
    }

    /// Locates (u, v) in its cell.
    #[must_use]
    pub fn at(&self, u: f32, v: f32) -> CellPoint {
        let at = [u, v].map(wrap_unit);
        let (cell, from_site) = self.nearest(at);
        let near = from_site[0].hypot(from_site[1]);
        let (mut edge, mut neighbor) = (f32::MAX, cell);
        for ring in 0..=self.rings() {
            // The border with another site is at least half the difference of the distances away.
            if self.reach(at, ring) > near + 2.0 * edge {
                break;
            }
            self.ring(at, ring, |site, to| {
                // Twice the offset to the middle between both sites, and the offset from one to the other.
                let middle = [to[0] - from_site[0], to[1] - from_site[1]];
                let offset = [to[0] + from_site[0], to[1] + from_site[1]];
                let length = offset[0].hypot(offset[1]);
                if length > 1e-6 {
                    let d = 0.5 * (middle[0] * offset[0] + middle[1] * offset[1]) / length;
                    if d < edge {
                        (edge, neighbor) = (d, site);
                    }
                }
            });
        }
        CellPoint { cell, from_site, edge: edge.max(0.0), neighbor }
    }

    /// Returns the nearest site and the offset from it to `at`.
    fn nearest(&self, at: [f32; 2]) -> (u32, [f32; 2]) {
        let (mut best, mut found) = (f32::MAX, (0, [0.0; 2]));
        for ring in 0..=self.rings() {
            if self.reach(at, ring).powi(2) > best {
                break;
            }
            self.ring(at, ring, |site, to| {
                let d = to[0] * to[0] + to[1] * to[1];
                if d < best {
                    (best, found) = (d, (site, [-to[0], -to[1]]));
                }
            });
        }
        found
    }

    /// Returns the number of rings of buckets after which every search has ended: three times around the torus.
    fn rings(&self) -> i32 {
        3 * self.side as i32 + 3
    }

    /// Returns the least distance from `at` to a bucket `ring` buckets away.
    fn reach(&self, at: [f32; 2], ring: i32) -> f32 {
        let [x, y] = at.map(|x| (x * self.side as f32).fract());
        let margin = x.min(1.0 - x).min(y.min(1.0 - y));
        ((ring - 1) as f32 + margin).max(0.0) / self.side as f32
    }

    /// Visits the sites in the buckets exactly `ring` buckets away from that of `at`: their indices and offsets, across the
    /// seam where necessary.
    fn ring(&self, at: [f32; 2], ring: i32, mut visit: impl FnMut(u32, [f32; 2])) {
        let side = self.side as i32;
        let [i, j] = at.map(|x| ((x * self.side as f32) as i32).min(side - 1));
        for dj in -ring..=ring {
            let step = if dj.abs() == ring { 1 } else { 2 * ring };
            let mut di = -ring;
            while di <= ring {
                let (x, y) = (i + di, j + dj);
                let (column, row) = (x.rem_euclid(side), y.rem_euclid(side));
                let wrap_offset = [x.div_euclid(side) as f32 - at[0], y.div_euclid(side) as f32 - at[1]];
                let bucket = (row * side + column) as usize;
                for &site in &self.order[self.starts[bucket] as usize..self.starts[bucket + 1] as usize] {
                    let [sx, sy] = self.sites[site as usize];
                    visit(site, [sx + wrap_offset[0], sy + wrap_offset[1]]);
                }
                di += step.max(1);
            }
        }
    }
}

/// Returns a random number in [0, 1) for the border between two cells, the same from both sides.
#[must_use]
pub(crate) fn border_random(a: u32, b: u32, seed: u32) -> f32 {
    unit_float(hash3(a.min(b), a.max(b), seed)[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same by searching every image of every site.
    fn brute(cells: &Voronoi, at: [f32; 2]) -> (u32, f32) {
        let images: Vec<(u32, [f32; 2])> = (0u32..)
            .zip(cells.sites())
            .flat_map(|(k, s)| {
                (-2..=2)
                    .flat_map(move |j| (-2..=2).map(move |i| (k, [s[0] + i as f32 - at[0], s[1] + j as f32 - at[1]])))
            })
            .collect();
        let length = |p: [f32; 2]| p[0].hypot(p[1]);
        let nearest = images.iter().min_by(|a, b| length(a.1).total_cmp(&length(b.1))).unwrap();
        let edge = images
            .iter()
            .filter(|p| length([p.1[0] - nearest.1[0], p.1[1] - nearest.1[1]]) > 1e-6)
            .map(|p| {
                let offset = [p.1[0] - nearest.1[0], p.1[1] - nearest.1[1]];
                0.5 * ((p.1[0] + nearest.1[0]) * offset[0] + (p.1[1] + nearest.1[1]) * offset[1]) / length(offset)
            })
            .fold(f32::MAX, f32::min);
        (nearest.0, edge)
    }

    #[test]
    fn cells_and_borders_are_those_found_by_brute_force() {
        for (count, relax) in [(1, 0), (2, 0), (5, 1), (40, 0), (40, 4)] {
            let cells = Voronoi::relaxed(count, relax, 9);
            for k in 0..300 {
                let at = [(k as f32 * 0.618_034).fract(), (k as f32 * 0.414_214).fract()];
                let (got, (cell, edge)) = (cells.at(at[0], at[1]), brute(&cells, at));
                assert_eq!(got.cell, cell, "{count} sites at {at:?}");
                assert!((got.edge - edge).abs() < 1e-5, "{count} sites at {at:?}: {} for {edge}", got.edge);
            }
        }
    }

    #[test]
    fn relaxing_makes_cells_of_equal_size() {
        let spread = |relax| {
            let cells = Voronoi::relaxed(60, relax, 4);
            let mut areas = vec![0.0f32; 60];
            for k in 0..40_000 {
                areas[cells.at((k % 200) as f32 / 200.0, (k / 200) as f32 / 200.0).cell as usize] += 60.0 / 40_000.0;
            }
            (areas.iter().map(|a| (a - 1.0).powi(2)).sum::<f32>() / 60.0).sqrt()
        };
        let (wild, tame) = (spread(0), spread(12));
        assert!(wild > 0.4 && tame < 0.18, "{wild}, {tame}");
    }

    #[test]
    fn cells_go_on_across_the_seam() {
        let cells = Voronoi::relaxed(30, 2, 1);
        for k in 0..64 {
            let v = k as f32 / 64.0;
            assert_eq!(cells.at(0.0, v), cells.at(1.0, v));
            assert_eq!(cells.at(v, 0.25), cells.at(v, 3.25));
        }
    }

    #[test]
    fn hexagons_have_their_borders_half_a_pitch_away() {
        let cells = Voronoi::hexagons(7, 7);
        assert_eq!(cells.sites().len(), 56);
        let [u, v] = cells.sites()[13];
        let middle = cells.at(u, v);
        assert!((middle.edge - 0.5 / 7.0).abs() < 0.002, "{}", middle.edge);
    }

    #[test]
    fn no_sites_and_sites_on_one_spot_end() {
        let one = Voronoi::new(Vec::new()).at(0.1, 0.9);
        assert_eq!(one.cell, 0);
        let same = Voronoi::new(vec![[0.5, 0.5]; 9]);
        assert!(same.at(0.2, 0.2).edge.is_finite());
    }
}
