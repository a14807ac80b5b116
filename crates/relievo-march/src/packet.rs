//! Eight rays at once: the exact march of many rays, with the hits of the scalar one.
//!
//! A tile of 32 rays looks ahead once ([`crate::tile`]); each ray then begins in the cell in which the tile stops being
//! free, at the border by which the plain walk enters that cell. From there eight walk together, cell by cell, asking the
//! finest codes of the pyramid, until each of them stands in a cell that must be looked at; those patches are then solved
//! together. A ray that has far to go after all goes on alone.

use fearless_simd::{Level, dispatch, f32x8, i32x8, mask32x8, prelude::*};
use relievo_map::Wrap;

use crate::descent::{CLAMP, MIRROR, PyramidField, REPEAT};
use crate::pyramid::{BITS, SLACK};
use crate::tile::Beam;
use crate::{HeightField, March, Ray, Record, Technique, march, march_from};

/// Rays that go together.
const LANES: usize = 8;

/// Rays that look ahead together.
const TILE: usize = 4 * LANES;

/// After so many turns, those that are still on their way go alone: through all levels of the pyramid.
const MAX_TURNS_TOGETHER: u32 = 32;

/// Rays that reach farther than this (texels from the origin) go alone: below it, f32 counts cells without a gap.
const MAX_REACH: f32 = (1 << 22) as f32;

/// [`march`] for many rays: the same hits to the last bit, in less time.
///
/// [`Technique::Exact`] on a field with a pyramid marches eight rays at a time with what the processor has (SSE, AVX2,
/// AVX-512, NEON, WASM SIMD); every 32 that follow each other in `rays` look ahead together, so neighbours should
/// follow each other (tiles of 8×4 pixels). Everything else is marched ray by ray. `fetches` and `iterations` are what each ray
/// cost here; nodes that a tile loaded for all are left out.
///
/// # Panics
/// If `records` has not the length of `rays`.
pub fn march_all<F: HeightField>(field: &F, rays: &[Ray], how: &March, records: &mut [Record]) {
    assert_eq!(rays.len(), records.len(), "there is a record for each ray");
    match field.pyramid() {
        Some(map) if how.technique == Technique::Exact => {
            dispatch!(Level::new(), simd => match map.wrap {
                Wrap::Repeat => Marcher::<_, _, REPEAT>::new(simd, field, map, how).tiles(rays, records),
                Wrap::Clamp => Marcher::<_, _, CLAMP>::new(simd, field, map, how).tiles(rays, records),
                Wrap::Mirror => Marcher::<_, _, MIRROR>::new(simd, field, map, how).tiles(rays, records),
            });
        }
        _ => {
            for (record, ray) in records.iter_mut().zip(rays) {
                *record = march(field, ray, how);
            }
        }
    }
}

/// What is the same for all rays.
struct Marcher<'a, S: Simd, F, const WRAP: u8> {
    simd: S,
    field: &'a F,
    map: PyramidField<'a>,
    how: &'a March,
    /// Columns and rows of the map.
    size: [i32; 2],
    texels: &'a [f32],
    /// The codes of all cells, node by node.
    codes: &'a [u8],
    /// Nodes in a row.
    nodes: i32,
    /// The depths of the highest and the lowest texel.
    lid: f32,
    floor: f32,
    /// A ray's height in codes: at the lid of the map, and per unit of depth.
    code: f32,
    code_rise: f32,
}

/// Eight rays, ready to go.
struct Packet<S: Simd> {
    /// On the lid.
    uv: [f32x8<S>; 2],
    slope: [f32x8<S>; 2],
    /// Texels per unit of depth.
    d: [f32x8<S>; 2],
    /// The cell in which the line stands at the lid, and where in it.
    base: [i32x8<S>; 2],
    local: [f32x8<S>; 2],
    /// Where the walk ends, at the latest.
    end: f32x8<S>,
    /// Those that can go together.
    together: mask32x8<S>,
}

/// How eight rays ended.
struct Walked<S: Simd> {
    /// Where each of them is.
    depth: f32x8<S>,
    /// Those still on their way.
    unfinished: mask32x8<S>,
    /// Those that met the surface, or the floor.
    hit: mask32x8<S>,
    fetches: i32x8<S>,
    turns: i32x8<S>,
}

/// Along one axis: where eight rays are, and how they go on.
struct Axis<S: Simd, const WRAP: u8> {
    simd: S,
    n: i32,
    d: f32x8<S>,
    local: f32x8<S>,
    /// Depth per texel, and whether there is none.
    pace: f32x8<S>,
    flat: mask32x8<S>,
    step: i32x8<S>,
    stride: f32x8<S>,
    /// 1 where the border ahead is the cell's upper one, else 0.
    ahead: f32x8<S>,
    /// The border ahead, in cells from that of the line's start.
    edge: f32x8<S>,
    /// The depth at which it is crossed.
    next: f32x8<S>,
    /// The cell in the map, continued as far as the map repeats itself.
    index: i32x8<S>,
    /// Whether this border was the last to be crossed.
    entered: mask32x8<S>,
}

impl<'a, S: Simd, F: HeightField, const WRAP: u8> Marcher<'a, S, F, WRAP> {
    #[inline(always)]
    fn new(simd: S, field: &'a F, map: PyramidField<'a>, how: &'a March) -> Self {
        let [low, code_step] = map.pyramid.coding();
        let per_step = 1.0 / code_step;
        let slack = SLACK + 4.0 * f32::EPSILON * per_step;
        let [lowest, highest] = field.range();
        let finest = &map.pyramid.levels()[0];
        Self {
            simd,
            field,
            how,
            size: map.pyramid.size().map(|n| n as i32),
            texels: map.cells.texels(),
            codes: finest.nodes().as_flattened(),
            nodes: finest.size()[0] as i32,
            lid: 1.0 - highest,
            floor: 1.0 - lowest,
            code: (1.0 - low) * per_step - slack,
            code_rise: -per_step,
            map,
        }
    }

    #[inline(always)]
    fn tiles(&self, rays: &[Ray], records: &mut [Record]) {
        for (rays, records) in rays.chunks(TILE).zip(records.chunks_mut(TILE)) {
            // The last packet is filled up with its last ray.
            let last = rays[rays.len() - 1];
            let packets: [_; TILE / LANES] = std::array::from_fn(|p| {
                let packet = std::array::from_fn(|lane| rays.get(p * LANES + lane).copied().unwrap_or(last));
                self.packet(&packet)
            });
            let entry = self.entry(&packets);
            for ((packet, rays), records) in packets.iter().zip(rays.chunks(LANES)).zip(records.chunks_mut(LANES)) {
                self.march(packet, entry, rays, records);
            }
        }
    }

    #[inline(always)]
    fn packet(&self, rays: &[Ray; LANES]) -> Packet<S> {
        let simd = self.simd;
        let gather = |get: fn(&Ray) -> f32| f32x8::from_fn(simd, |lane| get(&rays[lane]));
        let cos = gather(|ray| ray.cos);
        let mut uv = [gather(|ray| ray.uv[0]), gather(|ray| ray.uv[1])];
        let slope = [gather(|ray| ray.sweep[0]) / cos, gather(|ray| ray.sweep[1]) / cos];
        let size = self.size.map(|n| n as f32);
        let reach = |k: usize| (uv[k].abs() + slope[k].abs() * 2.0) * size[k];
        // False for what is not a number.
        let mut together = cos.simd_gt(0.0) & reach(0).simd_lt(MAX_REACH) & reach(1).simd_lt(MAX_REACH);
        let rise = 1.0 - self.how.midlevel.max(0.0).min(1.0);
        if rise != 0.0 {
            uv = [uv[0] - slope[0] * rise, uv[1] - slope[1] * rise];
        }
        let mut end = f32x8::splat(simd, self.floor);
        if let Some(bounds) = self.how.bounds {
            for k in 0..2 {
                let (min, max) = (f32x8::splat(simd, bounds.min[k]), f32x8::splat(simd, bounds.max[k]));
                // Those that come in from the side go alone.
                together &= uv[k].simd_ge(min) & uv[k].simd_le(max);
                let exit = (slope[k].simd_gt(0.0).select(max, min) - uv[k]) / slope[k];
                end = slope[k].simd_eq(0.0).select(end, exit.min(end));
            }
            together &= end.simd_ge(self.lid);
        }
        let (mut base, mut local) = ([i32x8::splat(simd, 0); 2], uv);
        for k in 0..2 {
            let origin = uv[k] * size[k] - 0.5;
            base[k] = floor(origin);
            local[k] = origin - base[k].to_float::<f32x8<S>>();
        }
        Packet { uv, slope, d: [slope[0] * size[0], slope[1] * size[1]], base, local, end, together }
    }

    /// How deep all of them are free.
    #[inline(always)]
    fn entry(&self, packets: &[Packet<S>; TILE / LANES]) -> f32 {
        let mut beam = Beam::EMPTY;
        for k in 0..2 {
            let extremes = |of: fn(&Packet<S>, usize, f32) -> f32x8<S>| {
                let n = self.size[k] as f32;
                let (mut low, mut high) =
                    (f32x8::splat(self.simd, f32::INFINITY), f32x8::splat(self.simd, f32::NEG_INFINITY));
                for packet in packets {
                    let value = of(packet, k, n);
                    low = packet.together.select(low.min(value), low);
                    high = packet.together.select(high.max(value), high);
                }
                (low.reduce_min(), high.reduce_max())
            };
            (beam.low[k], beam.high[k]) = extremes(|packet, k, n| packet.uv[k] * n - 0.5);
            (beam.slowest[k], beam.fastest[k]) = extremes(|packet, k, _| packet.d[k]);
        }
        if beam.low[0] > beam.high[0] { 0.0 } else { beam.descend(self.field, &self.map).depth }
    }

    #[inline(always)]
    fn march(&self, packet: &Packet<S>, entry: f32, rays: &[Ray], records: &mut [Record]) {
        let walked = self.walk(packet, entry);
        let uv = [0, 1].map(|k| (packet.uv[k] + packet.slope[k] * walked.depth).to_array());
        let depth = walked.depth.to_array();
        let (fetches, turns) = (walked.fetches.to_array(), walked.turns.to_array());
        let hit = walked.hit.to_bitmask();
        let unfinished = walked.unfinished.to_bitmask();
        let alone = unfinished | (!packet.together).to_bitmask();
        for (lane, (ray, record)) in rays.iter().zip(records).enumerate() {
            let (uv, cost) = ([uv[0][lane], uv[1][lane]], [fetches[lane] as u32, turns[lane] as u32]);
            *record = if (alone >> lane) & 1 != 0 {
                // A cell and a half earlier, so that the cell of the hit is entered by its border.
                let way = packet.d.map(|d| d.to_array()[lane].abs());
                let entry = if (unfinished >> lane) & 1 != 0 { depth[lane] - 1.5 / way[0].max(way[1]) } else { 0.0 };
                self.march_alone(ray, entry, cost)
            } else if (hit >> lane) & 1 != 0 && self.how.bounds.is_none_or(|bounds| bounds.contains(uv)) {
                Record { uv, depth: depth[lane], hit: true, fetches: cost[0], iterations: cost[1] }
            } else {
                Record::miss(ray, cost[0], cost[1])
            };
        }
    }

    /// The scalar march of one ray that is free down to `entry`, and what it has cost until there.
    #[cold]
    #[inline(never)]
    fn march_alone(&self, ray: &Ray, entry: f32, cost: [u32; 2]) -> Record {
        let record = march_from(self.field, ray, self.how, entry);
        Record { fetches: record.fetches + cost[0], iterations: record.iterations + cost[1], ..record }
    }

    #[inline(always)]
    fn walk(&self, packet: &Packet<S>, entry: f32) -> Walked<S> {
        let simd = self.simd;
        let nobody = mask32x8::splat(simd, false);
        let start = f32x8::splat(simd, self.lid);
        let end = packet.end;
        let [mut x, mut y] = [0, 1].map(|k| Axis::<S, WRAP>::new(simd, self.size[k], packet, k, start));
        let mut s = start;
        if entry > self.lid {
            let entry = f32x8::splat(simd, entry).min(end);
            let (to_x, to_y) = (x.jump(packet.base[0], entry, start), y.jump(packet.base[1], entry, start));
            s = to_x.max(to_y);
            // On a tie the plain walk crosses columns first.
            let y_last = y.entered & (to_y.simd_ge(to_x) | !x.entered);
            (x.entered, y.entered) = (x.entered & !y_last, y_last);
        }
        let mut walking = packet.together;
        // Standing in a cell that must be looked at.
        let mut waiting = nobody;
        let mut hit = nobody;
        let (mut fetches, mut turns) = (i32x8::splat(simd, 0), i32x8::splat(simd, 0));
        let one = |mask: mask32x8<S>| mask.select(i32x8::splat(simd, 1), i32x8::splat(simd, 0));
        for _ in 0..MAX_TURNS_TOGETHER {
            let along_v = y.next.simd_lt(x.next);
            let leave = along_v.select(y.next, x.next).max(s).min(end);
            let highest = self.highest(x.looked_up(), y.looked_up());
            let near = (leave * self.code_rise + self.code).simd_le(highest) & walking;
            let counted = one(walking);
            (fetches, turns) = (fetches + counted, turns + counted);
            waiting |= near;
            walking &= !near;
            if walking.all_false() {
                fetches += one(waiting);
                let (met, at) = self.solve(&x, &y, s, leave, waiting);
                s = met.select(at, s);
                hit |= met;
                walking = waiting & !met;
                waiting = nobody;
            }
            // The floor is met where nothing else was; a border of the bounds is not.
            let ended = walking & leave.simd_ge(end);
            s = walking.select(leave, s);
            hit |= ended & leave.simd_eq(self.floor);
            walking &= !ended;
            if (walking | waiting).all_false() {
                break;
            }
            x.cross(walking & !along_v, walking);
            y.cross(walking & along_v, walking);
        }
        Walked { depth: s, unfinished: walking | waiting, hit, fetches, turns }
    }

    /// The codes of eight cells.
    #[inline(always)]
    fn highest(&self, x: i32x8<S>, y: i32x8<S>) -> f32x8<S> {
        let node = (y >> BITS) * self.nodes + (x >> BITS);
        let index = ((node << (2 * BITS)) | ((y & 3) << BITS) | (x & 3)).to_array();
        i32x8::from_fn(self.simd, |lane| i32::from(self.codes[index[lane] as usize])).to_float()
    }

    /// Which of the waiting meet the patches they are in, between `s` and `leave`, and where: see
    /// [`crate::exact::patch_crossing`], step by step.
    #[inline(always)]
    fn solve(
        &self,
        x: &Axis<S, WRAP>,
        y: &Axis<S, WRAP>,
        s: f32x8<S>,
        leave: f32x8<S>,
        waiting: mask32x8<S>,
    ) -> (mask32x8<S>, f32x8<S>) {
        let simd = self.simd;
        let ([x0, x1], [y0, y1]) = (x.texels(), y.texels());
        let (top, bottom) = (y0 * self.size[0], y1 * self.size[0]);
        let height = |at: i32x8<S>| {
            let at = at.to_array();
            f32x8::from_fn(simd, |lane| self.texels[at[lane] as usize])
        };
        let [h00, h10, h01, h11] = [height(top + x0), height(top + x1), height(bottom + x0), height(bottom + x1)];
        let near = waiting & (-leave + 1.0).simd_le(h00.max(h10).max(h01.max(h11)));
        let (a, b) = (x.inside(s), y.inside(s));
        let (beta, gamma, kappa) = (h10 - h00, h01 - h00, h00 - h10 - h01 + h11);
        let c0 = (-s + 1.0) - (h00 + beta * a + gamma * b + kappa * a * b);
        let c1 = -(beta * x.d + gamma * y.d + kappa * (a * y.d + b * x.d)) - 1.0;
        let c2 = -kappa * x.d * y.d;
        let discriminant = c1 * c1 - c2 * 4.0 * c0;
        let q = (c1 + discriminant.sqrt().copysign(c1)) * -0.5;
        let length = leave - s;
        let infinity = f32x8::splat(simd, f32::INFINITY);
        // Comparisons with what is not a number are false: a negative discriminant has no root.
        let inside = |x: f32x8<S>| (x.simd_gt(0.0) & x.simd_le(length)).select(x, infinity);
        let root = inside(q / c2).min(inside(c0 / q));
        let below = c0.simd_le(0.0);
        let met = near & (below | root.simd_lt(infinity));
        (met, below.select(s, s + root))
    }
}

impl<S: Simd, const WRAP: u8> Axis<S, WRAP> {
    /// Where the rays are at the depth `start`.
    #[inline(always)]
    fn new(simd: S, n: i32, packet: &Packet<S>, k: usize, start: f32x8<S>) -> Self {
        let (d, local) = (packet.d[k], packet.local[k]);
        let up = d.simd_gt(0.0);
        let flat = d.simd_eq(0.0);
        let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
        let ahead = up.select(one, zero);
        let cell = floor(local + d * start);
        let mut axis = Self {
            simd,
            n,
            d,
            local,
            pace: one / d,
            flat,
            step: up.select(i32x8::splat(simd, 1), i32x8::splat(simd, -1)),
            stride: up.select(one, -one),
            ahead,
            edge: cell.to_float::<f32x8<S>>() + ahead,
            next: zero,
            index: Self::reduced(simd, n, packet.base[k] + cell),
            entered: mask32x8::splat(simd, false),
        };
        axis.next = axis.crossing(axis.edge);
        axis
    }

    /// The depth at which this border is crossed.
    #[inline(always)]
    fn crossing(&self, edge: f32x8<S>) -> f32x8<S> {
        self.flat.select(f32x8::splat(self.simd, f32::INFINITY), (edge - self.local) * self.pace)
    }

    /// On to the cell of the depth `entry`: the one between the borders that are crossed until then. Gives the depth at which
    /// the last of them is crossed, `start` if there is none.
    #[inline(always)]
    fn jump(&mut self, base: i32x8<S>, entry: f32x8<S>, start: f32x8<S>) -> f32x8<S> {
        let zero = f32x8::splat(self.simd, 0.0);
        let guess = (self.local + self.d * entry).floor() + self.ahead;
        // The position is rounded; the borders tell.
        let too_far = self.crossing(guess - self.stride).simd_gt(entry);
        let edge = guess - too_far.select(self.stride, zero);
        let not_yet = self.crossing(edge).simd_le(entry);
        let edge = edge + not_yet.select(self.stride, zero);
        self.entered = ((edge - self.edge) * self.stride).simd_gt(0.0) & !self.flat & entry.simd_gt(start);
        self.edge = self.entered.select(edge, self.edge);
        self.next = self.crossing(self.edge);
        self.index = Self::reduced(self.simd, self.n, base + (self.edge - self.ahead).to_int::<i32x8<S>>());
        self.entered.select(self.crossing(self.edge - self.stride).max(start), start)
    }

    /// A cell of the endless row, in the map as far as that repeats itself.
    #[inline(always)]
    fn reduced(simd: S, n: i32, cell: i32x8<S>) -> i32x8<S> {
        let period = match WRAP {
            REPEAT => n,
            CLAMP => return cell,
            _ => 2 * n,
        };
        if (cell.simd_lt(0) | cell.simd_ge(period)).all_false() {
            return cell;
        }
        let cells = cell.to_array();
        i32x8::from_fn(simd, |lane| cells[lane].rem_euclid(period))
    }

    /// The texel that stands for number `i` of the row, which is at most one beyond its period.
    #[inline(always)]
    fn texel(&self, i: i32x8<S>) -> i32x8<S> {
        let n = self.n;
        let zero = i32x8::splat(self.simd, 0);
        match WRAP {
            REPEAT => i.simd_eq(n).select(zero, i),
            CLAMP => i.max(zero).min(i32x8::splat(self.simd, n - 1)),
            _ => {
                let i = i.simd_eq(2 * n).select(zero, i);
                i.min(-i + (2 * n - 1))
            }
        }
    }

    /// The texels on both sides of the cells.
    #[inline(always)]
    fn texels(&self) -> [i32x8<S>; 2] {
        [self.texel(self.index), self.texel(self.index + 1)]
    }

    /// The cells whose maxima stand for these.
    #[inline(always)]
    fn looked_up(&self) -> i32x8<S> {
        match WRAP {
            REPEAT => self.index,
            CLAMP => self.texel(self.index),
            _ => self.texel(self.index).min(self.texel(self.index + 1)),
        }
    }

    /// How far inside its cell each ray is that came to it at the depth `s`.
    #[inline(always)]
    fn inside(&self, s: f32x8<S>) -> f32x8<S> {
        let (zero, one) = (f32x8::splat(self.simd, 0.0), f32x8::splat(self.simd, 1.0));
        let position = (self.local + self.d * s) - (self.edge - self.ahead);
        // By a border: exactly there.
        self.entered.select(one - self.ahead, position.max(zero).min(one))
    }

    /// Takes `crossing` into their next cells; of the `moved`, the others have crossed the other axis.
    #[inline(always)]
    fn cross(&mut self, crossing: mask32x8<S>, moved: mask32x8<S>) {
        let zero = f32x8::splat(self.simd, 0.0);
        self.edge += crossing.select(self.stride, zero);
        self.next = crossing.select(self.crossing(self.edge), self.next);
        self.entered = (self.entered & !moved) | crossing;
        let index = self.index + crossing.select(self.step, i32x8::splat(self.simd, 0));
        let period = match WRAP {
            REPEAT => self.n,
            CLAMP => {
                self.index = index;
                return;
            }
            _ => 2 * self.n,
        };
        let index = index.simd_ge(period).select(i32x8::splat(self.simd, 0), index);
        self.index = index.simd_lt(0).select(i32x8::splat(self.simd, period - 1), index);
    }
}

/// The largest integers not above.
#[inline(always)]
fn floor<S: Simd>(x: f32x8<S>) -> i32x8<S> {
    x.floor().to_int()
}
