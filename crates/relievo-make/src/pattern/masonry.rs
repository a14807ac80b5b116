//! Masonry: bricks, tiles and boards laid in a bond.

use super::sdf;
use crate::noise::{HashRng, wrap_unit};

/// A pattern in which bricks are laid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Bond {
    /// Stretchers; every second course half a brick further.
    #[default]
    Running,
    /// Stretchers; each course a third of a brick further.
    Third,
    /// Stretchers straight above each other.
    Stack,
    /// Courses of stretchers and courses of headers (half as long) in turn.
    English,
    /// Stretcher and header in turn in each course, the headers above the middles of the stretchers.
    Flemish,
    /// Bricks of two squares, lying and standing in a zigzag.
    Herringbone,
    /// Pairs of bricks of two squares, lying and standing in turn.
    Basket,
    /// Boards of random length, each course at a random offset.
    Random,
}

impl Bond {
    /// All bonds and their names in recipes.
    pub const ALL: [(&'static str, Self); 8] = [
        ("running", Self::Running),
        ("third", Self::Third),
        ("stack", Self::Stack),
        ("english", Self::English),
        ("flemish", Self::Flemish),
        ("herringbone", Self::Herringbone),
        ("basket", Self::Basket),
        ("random", Self::Random),
    ];

    /// Returns the numbers that `columns` and `rows` must be multiples of, so that the pattern closes.
    #[must_use]
    pub fn period(self) -> [u32; 2] {
        match self {
            Self::Running | Self::English | Self::Flemish => [1, 2],
            Self::Third => [1, 3],
            Self::Stack | Self::Random => [1, 1],
            Self::Herringbone | Self::Basket => [4, 4],
        }
    }
}

/// Bricks laid in a bond, with joints between them. Lengths in uv.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Masonry {
    /// The pattern.
    pub bond: Bond,
    /// Stretchers per course (Flemish: pairs of stretcher and header; herringbone and basket: squares). A multiple of
    /// [`Bond::period`].
    pub columns: u32,
    /// Courses. A multiple of [`Bond::period`].
    pub rows: u32,
    /// Width of the joints.
    pub joint: f32,
    /// Radius of the bricks' corners.
    pub corner: f32,
    /// Greatest random offset of a brick, in uv.
    pub position_jitter: f32,
    /// Greatest random change of half a side, in uv.
    pub size_jitter: f32,
    /// Greatest random rotation, in radians (small).
    pub rotation_jitter: f32,
    /// Seed of the jitter.
    pub seed: u32,
}

/// A point located in masonry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BrickPoint {
    /// Index of the brick, or of the one that the joint here belongs to.
    pub brick: u32,
    /// Distance from the brick's outline, positive inside, in uv.
    pub edge: f32,
    /// Position along the brick's length, -1..1 from end to end.
    pub along: f32,
    /// Position across the brick, -1..1 from side to side.
    pub across: f32,
    /// Offset from the brick's middle, along and across, in uv.
    pub from_middle: [f32; 2],
    /// True if the brick stands upright: its length runs along v.
    pub is_upright: bool,
}

/// A brick's cell in the bond: the offset of its middle, half its sides, and its direction.
struct BrickCell {
    id: u32,
    from_middle: [f32; 2],
    half: [f32; 2],
    is_upright: bool,
}

impl Masonry {
    /// Locates (u, v). Repeats after 1 in both.
    #[must_use]
    pub fn at(&self, u: f32, v: f32) -> BrickPoint {
        let cell = self.cell(wrap_unit(u), wrap_unit(v));
        let mut rng = HashRng::new(cell.id, self.seed ^ 0xb0d5);
        let [mut x, mut y] = cell.from_middle;
        x -= self.position_jitter * rng.signed();
        y -= self.position_jitter * rng.signed();
        let angle = self.rotation_jitter * rng.signed();
        (x, y) = (x + angle * y, y - angle * x);
        let gap = 0.5 * self.joint;
        let half = cell.half.map(|h| (h - gap + self.size_jitter * rng.signed()).max(1e-6));
        let corner = self.corner.min(0.99 * half[0].min(half[1]));
        let edge = -sdf::rounded(sdf::rectangle([x, y], half.map(|h| h - corner)), corner);
        let (from_middle, half) = if cell.is_upright { ([y, x], [half[1], half[0]]) } else { ([x, y], half) };
        let [along, across] = [0, 1].map(|k| from_middle[k] / half[k]);
        BrickPoint { brick: cell.id, edge, along, across, from_middle, is_upright: cell.is_upright }
    }

    fn cell(&self, u: f32, v: f32) -> BrickCell {
        let (columns, rows) = (self.columns.max(1), self.rows.max(1));
        let y = v * rows as f32;
        let row = (y as u32).min(rows - 1);
        let across = (y - row as f32 - 0.5) / rows as f32;
        let half_v = 0.5 / rows as f32;
        // Courses of equal bricks, `offset` bricks further.
        let course = |columns: u32, offset: f32| {
            let x = wrap_unit(u - offset / columns as f32) * columns as f32;
            let i = (x as u32).min(columns - 1);
            let along = (x - i as f32 - 0.5) / columns as f32;
            // A standing format has its length across the course.
            let half = [0.5 / columns as f32, half_v];
            BrickCell { id: row * 1024 + i, from_middle: [along, across], half, is_upright: half[0] < half[1] }
        };
        match self.bond {
            Bond::Stack => course(columns, 0.0),
            Bond::Running => course(columns, 0.5 * (row % 2) as f32),
            Bond::Third => course(columns, (row % 3) as f32 / 3.0),
            Bond::English if row.is_multiple_of(2) => course(columns, 0.0),
            Bond::English => BrickCell { is_upright: false, ..course(2 * columns, 0.5) },
            Bond::Flemish => {
                // A third of the pair is the header.
                let x = wrap_unit(u - 0.5 * (row % 2) as f32 / columns as f32) * columns as f32;
                let pair = (x as u32).min(columns - 1);
                let x = 3.0 * (x - pair as f32);
                let (middle, half, header) = if x < 2.0 { (1.0, 1.0, 0) } else { (2.5, 0.5, 1) };
                let unit = 1.0 / (3.0 * columns as f32);
                let from_middle = [(x - middle) * unit, across];
                let id = row * 1024 + 2 * pair + header;
                BrickCell { id, from_middle, half: [half * unit, half_v], is_upright: false }
            }
            Bond::Herringbone | Bond::Basket => self.squares(u, v),
            Bond::Random => self.boards(u, row, across),
        }
    }

    /// Bricks of two squares.
    fn squares(&self, u: f32, v: f32) -> BrickCell {
        let (columns, rows) = (self.columns.max(1), self.rows.max(1));
        let (x, y) = (u * columns as f32, v * rows as f32);
        let (i, j) = ((x as u32).min(columns - 1), (y as u32).min(rows - 1));
        // The square's place in its brick: along u if it lies, along v if it stands, first or second.
        let (is_upright, second) = if self.bond == Bond::Herringbone {
            match (i + 4 * rows - j) % 4 {
                0 => (false, false),
                1 => (false, true),
                // Further down the remainder is one less.
                3 => (true, false),
                _ => (true, true),
            }
        } else {
            let is_upright = !(i / 2 + j / 2).is_multiple_of(2);
            (is_upright, if is_upright { j % 2 == 1 } else { i % 2 == 1 })
        };
        let (fx, fy) = (x - i as f32 - 0.5, y - j as f32 - 0.5);
        let to_middle = if second { 0.5 } else { -0.5 };
        let (fx, fy) = if is_upright { (fx, fy + to_middle) } else { (fx + to_middle, fy) };
        let (i, j) = match (second, is_upright) {
            (false, _) => (i, j),
            (true, false) => ((i + columns - 1) % columns, j),
            (true, true) => (i, (j + rows - 1) % rows),
        };
        let (c, r) = (1.0 / columns as f32, 1.0 / rows as f32);
        let half = if is_upright { [0.5 * c, r] } else { [c, 0.5 * r] };
        BrickCell { id: j * 1024 + i, from_middle: [fx * c, fy * r], half, is_upright }
    }

    /// Boards of different lengths, a course of them as a whole shifted.
    fn boards(&self, u: f32, row: u32, across: f32) -> BrickCell {
        let columns = self.columns.max(1);
        let mut rng = HashRng::new(row, self.seed ^ 0xb0a2);
        let u = wrap_unit(u - rng.unit());
        // Ends of the boards: those of equal boards, each moved by up to a third of one.
        let end = |i: u32| {
            if i == 0 || i == columns {
                return (i / columns) as f32;
            }
            let moved = HashRng::new(row * 1024 + i, self.seed ^ 0xe2d5).signed() / 3.0;
            (i as f32 + moved) / columns as f32
        };
        let mut i = ((u * columns as f32) as u32).min(columns - 1);
        if u < end(i) && i > 0 {
            i -= 1;
        } else if u >= end(i + 1) && i + 1 < columns {
            i += 1;
        }
        let (start, stop) = (end(i), end(i + 1));
        let from_middle = [u - 0.5 * (start + stop), across];
        BrickCell {
            id: row * 1024 + i,
            from_middle,
            half: [0.5 * (stop - start), 0.5 / self.rows.max(1) as f32],
            is_upright: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    fn laid(bond: Bond) -> Masonry {
        Masonry {
            bond,
            columns: 4,
            rows: 12,
            joint: 0.02,
            corner: 0.004,
            position_jitter: 0.0,
            size_jitter: 0.0,
            rotation_jitter: 0.0,
            seed: 1,
        }
    }

    #[test]
    fn every_bond_closes_at_the_seams() {
        for (name, bond) in Bond::ALL {
            let wall = Masonry { position_jitter: 0.002, size_jitter: 0.002, rotation_jitter: 0.01, ..laid(bond) };
            for k in 0..256 {
                let t = k as f32 / 256.0;
                assert_eq!(wall.at(0.0, t), wall.at(1.0, t), "{name}");
                assert_eq!(wall.at(t, 0.0), wall.at(t, -2.0), "{name}");
            }
        }
    }

    /// Every brick is one rectangle of the size that its points tell: found by counting samples.
    #[test]
    fn the_bricks_of_every_bond_have_the_area_of_their_sides() {
        for (name, bond) in Bond::ALL {
            let wall = Masonry { joint: 0.0, corner: 0.0, ..laid(bond) };
            let n = 720;
            let mut bricks: BTreeMap<u32, (u32, f32, f32)> = BTreeMap::new();
            for k in 0..n * n {
                let p = wall.at(((k % n) as f32 + 0.5) / n as f32, ((k / n) as f32 + 0.5) / n as f32);
                assert!(p.along.abs() <= 1.001 && p.across.abs() <= 1.001 && p.edge >= -1e-4, "{name} {p:?}");
                let brick = bricks.entry(p.brick).or_insert((0, 0.0, 0.0));
                *brick = (brick.0 + 1, brick.1.max(p.from_middle[0]), brick.2.max(p.from_middle[1]));
            }
            for (id, (count, half_length, half_width)) in bricks {
                let (area, sides) = (count as f32 / (n * n) as f32, 4.0 * half_length * half_width);
                assert!((area / sides - 1.0).abs() < 0.05, "{name} {id}: {area} for {sides}");
            }
        }
    }

    #[test]
    fn flemish_headers_stand_above_the_middles_of_stretchers() {
        let wall = laid(Bond::Flemish);
        // Middle of a stretcher in course 0, and what lies in course 1 below it.
        let u = 1.0 / 12.0;
        assert!(wall.at(u, 0.5 / 12.0).along.abs() < 1e-3);
        let below = wall.at(u, 1.5 / 12.0);
        assert!(below.along.abs() < 1e-3 && below.brick % 2 == 1, "{below:?}");
    }

    #[test]
    fn joints_are_as_wide_as_asked() {
        let wall = laid(Bond::Stack);
        let open = (0..10_000).filter(|&k| wall.at(k as f32 / 10_000.0, 0.5 / 12.0).edge < 0.0).count();
        assert!((open as f32 / 10_000.0 - 4.0 * 0.02).abs() < 0.002, "{open}");
    }
}
