//! Eight rays at once: the exact march of many rays, with the hits of the scalar one.
//!
//! A tile of 32 rays looks ahead once ([`crate::tile`]); each ray then begins in the cell in which the tile stops being
//! free, at the border by which the plain walk enters that cell. From there eight walk together, cell by cell, asking the
//! finest codes of the pyramid, until each of them stands in a cell that must be looked at; those patches are then solved
//! together. Those that have farther to go gather in new packets and look ahead again.

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

/// After so many turns those that are still on their way look ahead again.
const TURNS: u32 = 12;

/// After looking ahead so often, they go alone.
const LOOKS: u32 = 24;

/// Rays that reach farther than this (texels from the origin) go alone: below it, f32 counts cells without a gap.
const MAX_REACH: f32 = (1 << 22) as f32;

/// [`march`] for many rays: the same hits to the last bit, in less time.
///
/// [`Technique::Exact`] on a field with a pyramid marches eight rays at a time with what the processor has (SSE, AVX2,
/// AVX-512, NEON, WASM SIMD); every 32 that follow each other in `rays` look ahead together, so neighbours should
/// follow each other (tiles of 8×4 pixels, in 4×2). Everything else is marched ray by ray. `fetches` and `iterations` are what each ray
/// cost here; nodes that a tile loaded for all are left out.
///
/// # Panics
/// If `records` has not the length of `rays`.
pub fn march_all(field: &impl HeightField, rays: &[Ray], how: &March, records: &mut [Record]) {
    assert_eq!(rays.len(), records.len(), "there is a record for each ray");
    match field.pyramid() {
        Some(map) if how.technique == Technique::Exact => {
            let mut alone = Vec::new();
            march_together(map, field.range(), rays, how, records, &mut alone);
            for Alone { index, free } in alone {
                let cost = records[index];
                let record = march_from(field, &rays[index], how, free);
                let (fetches, iterations) = (record.fetches + cost.fetches, record.iterations + cost.iterations);
                records[index] = Record { fetches, iterations, ..record };
            }
        }
        _ => {
            for (record, ray) in records.iter_mut().zip(rays) {
                *record = march(field, ray, how);
            }
        }
    }
}

/// A ray that is to be marched by itself: free down to a depth.
struct Alone {
    index: usize,
    free: f32,
}

/// Not generic, so that it is compiled once for every kind of processor and no more. `range` is that of the field.
fn march_together(
    map: PyramidField<'_>,
    range: [f32; 2],
    rays: &[Ray],
    how: &March,
    records: &mut [Record],
    alone: &mut Vec<Alone>,
) {
    dispatch!(Level::new(), simd => Marcher::new(simd, map, range, how).tiles(rays, records, alone));
}

/// What is the same for all rays.
struct Marcher<'a, S: Simd> {
    simd: S,
    map: PyramidField<'a>,
    how: &'a March,
    /// Heights that no texel falls below and none rises above, and their depths.
    range: [f32; 2],
    lid: f32,
    floor: f32,
    /// Columns and rows of the map.
    size: [i32; 2],
    texels: &'a [f32],
    /// The codes of all cells, node by node.
    codes: &'a [u8],
    /// Nodes in a row.
    nodes: i32,
    /// A ray's height in codes: at the lid of the map, and per unit of depth.
    code: f32,
    code_rise: f32,
}

/// Eight rays, ready to go.
#[derive(Clone, Copy)]
struct Packet<S: Simd> {
    /// On the lid.
    uv: [f32x8<S>; 2],
    slope: [f32x8<S>; 2],
    /// Texels per unit of depth.
    d: [f32x8<S>; 2],
    /// Where the line stands at the lid, in texel-centre coordinates: its cell, and where in it.
    origin: [f32x8<S>; 2],
    base: [i32x8<S>; 2],
    local: [f32x8<S>; 2],
    /// Where the walk ends, at the latest.
    end: f32x8<S>,
    /// Those that can go together.
    together: mask32x8<S>,
}

/// Which rays of a tile are to go on, and from where.
struct Queue {
    /// Numbers in the tile; of the last one again, up to a whole packet.
    index: [u8; TILE],
    depth: [f32; TILE],
    count: usize,
}

/// Eight of them.
struct Lanes {
    index: [u8; LANES],
    depth: [f32; LANES],
    count: usize,
}

impl Queue {
    const EMPTY: Self = Self { index: [0; TILE], depth: [0.0; TILE], count: 0 };

    /// The first `count` of a tile.
    #[inline(always)]
    fn all(count: usize, depth: f32) -> Self {
        Self { index: std::array::from_fn(|k| k.min(count - 1) as u8), depth: [depth; TILE], count }
    }

    #[inline(always)]
    fn push(&mut self, index: u8, depth: f32) {
        let end = (self.count / LANES + 1) * LANES;
        self.index[self.count..end].fill(index);
        self.depth[self.count..end].fill(depth);
        self.count += 1;
    }

    #[inline(always)]
    fn packet(&self, p: usize) -> Lanes {
        let at = |lane: usize| p * LANES + lane;
        Lanes {
            index: std::array::from_fn(|lane| self.index[at(lane)]),
            depth: std::array::from_fn(|lane| self.depth[at(lane)]),
            count: (self.count - p * LANES).min(LANES),
        }
    }
}

/// Eight rays on their way.
struct Walk<S: Simd> {
    x: Axis<S>,
    y: Axis<S>,
    /// Where each of them is, in depth: where it came into its cell, or where it ended.
    s: f32x8<S>,
    /// Those on their way.
    walking: mask32x8<S>,
    /// Those that stand in a cell that must be looked at.
    waiting: mask32x8<S>,
    /// Those that met the surface, or the floor.
    hit: mask32x8<S>,
    /// Cells that were looked at in the pyramid, and such whose patch was solved.
    turns: i32x8<S>,
    solved: i32x8<S>,
}

/// Along one axis: where eight rays are, and how they go on.
struct Axis<S: Simd> {
    d: f32x8<S>,
    local: f32x8<S>,
    /// Depth per texel.
    pace: f32x8<S>,
    step: i32x8<S>,
    stride: f32x8<S>,
    /// 1 where the border ahead is the cell's upper one, 0 where it is the lower one, 2 where none is ever reached.
    ahead: f32x8<S>,
    /// The border ahead, in cells from that of the line's start.
    edge: f32x8<S>,
    /// The first one.
    first: f32x8<S>,
    /// The depth at which it is crossed.
    next: f32x8<S>,
    /// The cell in the map, continued as far as the map repeats itself.
    index: i32x8<S>,
    /// Whether this border was the last to be crossed.
    entered: mask32x8<S>,
}

/// Beside the wrap modes: no border of the map is near.
const INSIDE: u8 = 3;

impl<'a, S: Simd> Marcher<'a, S> {
    #[inline(always)]
    fn new(simd: S, map: PyramidField<'a>, range: [f32; 2], how: &'a March) -> Self {
        let [low, code_step] = map.pyramid.coding();
        let per_step = 1.0 / code_step;
        let slack = SLACK + 4.0 * f32::EPSILON * per_step;
        let finest = &map.pyramid.levels()[0];
        Self {
            simd,
            how,
            range,
            lid: 1.0 - range[1],
            floor: 1.0 - range[0],
            size: map.pyramid.size().map(|n| n as i32),
            texels: map.cells.texels(),
            codes: finest.nodes().as_flattened(),
            nodes: finest.size()[0] as i32,
            code: (1.0 - low) * per_step - slack,
            code_rise: -per_step,
            map,
        }
    }

    #[inline(always)]
    fn tiles(&self, rays: &[Ray], records: &mut [Record], alone: &mut Vec<Alone>) {
        for (number, (rays, records)) in rays.chunks(TILE).zip(records.chunks_mut(TILE)).enumerate() {
            let first = number * TILE;
            records.fill(Record::default());
            let mut queue = Queue::all(rays.len(), self.lid);
            let packets: [_; TILE / LANES] = [
                self.packet(rays, &queue, 0),
                self.packet(rays, &queue, 1),
                self.packet(rays, &queue, 2),
                self.packet(rays, &queue, 3),
            ];
            let entry = self.look_ahead(&packets, self.lid, 1);
            for look in 0..LOOKS {
                let left = std::mem::replace(&mut queue, Queue::EMPTY);
                for p in 0..left.count.div_ceil(LANES) {
                    let lanes = left.packet(p);
                    let at = f32x8::load_array(self.simd, lanes.depth);
                    // Those that have farther to go have gathered in new packets, and look ahead again.
                    let (packet, free) = if look == 0 {
                        (packets[p], entry)
                    } else {
                        let packet = self.packet(rays, &left, p);
                        (packet, self.look_ahead(std::slice::from_ref(&packet), at.reduce_min(), 2))
                    };
                    let not_together = self.march(&packet, at.max(free), &lanes, rays, records, &mut queue);
                    for lane in (0..lanes.count).filter(|lane| not_together >> lane & 1 != 0) {
                        alone.push(Alone { index: first + usize::from(lanes.index[lane]), free: 0.0 });
                    }
                }
                if queue.count == 0 {
                    break;
                }
            }
            for k in 0..queue.count {
                let index = usize::from(queue.index[k]);
                // A cell and a half earlier, so that the cell of the hit is entered by its border.
                let slope = rays[index].slope();
                let way = (0..2).map(|k| (slope[k] * self.size[k] as f32).abs()).fold(0.0, f32::max);
                alone.push(Alone { index: first + index, free: queue.depth[k] - 1.5 / way });
            }
        }
    }

    /// Packet number `p` of those in the queue.
    #[inline(always)]
    fn packet(&self, tile: &[Ray], queue: &Queue, p: usize) -> Packet<S> {
        let simd = self.simd;
        let mut numbers = [[0.0; LANES]; 5];
        for lane in 0..LANES {
            let ray = &tile[usize::from(queue.index[p * LANES + lane])];
            numbers[0][lane] = ray.uv[0];
            numbers[1][lane] = ray.uv[1];
            numbers[2][lane] = ray.sweep[0];
            numbers[3][lane] = ray.sweep[1];
            numbers[4][lane] = ray.cos;
        }
        let cos = f32x8::load_array(simd, numbers[4]);
        let mut uv = [f32x8::load_array(simd, numbers[0]), f32x8::load_array(simd, numbers[1])];
        let slope = [f32x8::load_array(simd, numbers[2]) / cos, f32x8::load_array(simd, numbers[3]) / cos];
        let size = self.size.map(|n| n as f32);
        let reach = [(uv[0].abs() + slope[0].abs() * 2.0) * size[0], (uv[1].abs() + slope[1].abs() * 2.0) * size[1]];
        // False for what is not a number.
        let mut together = cos.simd_gt(0.0) & reach[0].simd_lt(MAX_REACH) & reach[1].simd_lt(MAX_REACH);
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
        let origin = [uv[0] * size[0] - 0.5, uv[1] * size[1] - 0.5];
        let base = [floor(origin[0]), floor(origin[1])];
        let local = [origin[0] - base[0].to_float::<f32x8<S>>(), origin[1] - base[1].to_float::<f32x8<S>>()];
        Packet { uv, slope, d: [slope[0] * size[0], slope[1] * size[1]], origin, base, local, end, together }
    }

    /// The depth down to which all rays of these packets are free, when they are so down to `from`, as far as the `finest`
    /// level tells.
    #[inline(always)]
    fn look_ahead(&self, packets: &[Packet<S>], from: f32, finest: u32) -> f32 {
        let infinity = f32x8::splat(self.simd, f32::INFINITY);
        let mut beam = Beam::EMPTY;
        for k in 0..2 {
            let (mut low, mut high, mut slowest, mut fastest) = (infinity, -infinity, infinity, -infinity);
            for packet in packets {
                let (origin, d, who) = (packet.origin[k], packet.d[k], packet.together);
                low = who.select(low.min(origin), low);
                high = who.select(high.max(origin), high);
                slowest = who.select(slowest.min(d), slowest);
                fastest = who.select(fastest.max(d), fastest);
            }
            (beam.low[k], beam.high[k]) = (low.reduce_min(), high.reduce_max());
            (beam.slowest[k], beam.fastest[k]) = (slowest.reduce_min(), fastest.reduce_max());
        }
        if beam.low[0] > beam.high[0] { from } else { beam.descend(self.range, &self.map, from, finest).depth }
    }

    /// Marches eight rays on, which are free down to the depths `from`. Those that do not arrive are queued; gives a bit for each that
    /// cannot go together with others.
    #[inline(always)]
    fn march(
        &self,
        packet: &Packet<S>,
        from: f32x8<S>,
        lanes: &Lanes,
        rays: &[Ray],
        records: &mut [Record],
        queue: &mut Queue,
    ) -> u64 {
        let walk = self.walk(packet, from);
        let u = (packet.uv[0] + packet.slope[0] * walk.s).to_array();
        let v = (packet.uv[1] + packet.slope[1] * walk.s).to_array();
        let depth = walk.s.to_array();
        let (turns, fetches) = (walk.turns.to_array(), (walk.turns + walk.solved).to_array());
        let hit = walk.hit.to_bitmask();
        let unfinished = (walk.walking | walk.waiting).to_bitmask();
        for lane in 0..lanes.count {
            let index = lanes.index[lane];
            let (ray, record) = (&rays[usize::from(index)], &mut records[usize::from(index)]);
            let is = |mask: u64| (mask >> lane) & 1 != 0;
            let uv = [u[lane], v[lane]];
            let (fetches, iterations) = (record.fetches + fetches[lane] as u32, record.iterations + turns[lane] as u32);
            *record = if is(hit) && self.how.bounds.is_none_or(|bounds| bounds.contains(uv)) {
                Record { uv, depth: depth[lane], hit: true, fetches, iterations }
            } else {
                Record::miss(ray, fetches, iterations)
            };
            if is(unfinished) {
                queue.push(index, depth[lane]);
            }
        }
        (!packet.together).to_bitmask()
    }

    #[inline(always)]
    fn walk(&self, packet: &Packet<S>, from: f32x8<S>) -> Walk<S> {
        let simd = self.simd;
        let nobody = mask32x8::splat(simd, false);
        let none = i32x8::splat(simd, 0);
        let start = f32x8::splat(simd, self.lid);
        let mut walk = Walk {
            x: Axis::new(simd, packet, 0, start),
            y: Axis::new(simd, packet, 1, start),
            s: start,
            walking: packet.together,
            waiting: nobody,
            hit: nobody,
            turns: none,
            solved: none,
        };
        if walk.walking.all_false() {
            return walk;
        }
        let to = from.min(packet.end);
        let to_x = walk.x.jump(simd, to, start);
        let to_y = walk.y.jump(simd, to, start);
        walk.s = to_x.max(to_y);
        // On a tie the plain walk crosses columns first.
        let y_last = walk.y.entered & (to_y.simd_ge(to_x) | !walk.x.entered);
        walk.x.entered &= !y_last;
        walk.y.entered = y_last;
        // Where those are that do not go together, nobody knows.
        let together = walk.walking.to_vector();
        walk.x.index = self.reduced((packet.base[0] + walk.x.cell()) & together, 0);
        walk.y.index = self.reduced((packet.base[1] + walk.y.cell()) & together, 1);
        if (self.is_inside(walk.x.index, 0) & self.is_inside(walk.y.index, 1) | !walk.walking).all_true() {
            self.go::<INSIDE>(&mut walk, packet.end);
        } else {
            match self.map.wrap {
                Wrap::Repeat => self.go::<REPEAT>(&mut walk, packet.end),
                Wrap::Clamp => self.go::<CLAMP>(&mut walk, packet.end),
                Wrap::Mirror => self.go::<MIRROR>(&mut walk, packet.end),
            }
        }
        walk
    }

    /// Some turns on.
    #[inline(always)]
    fn go<const MODE: u8>(&self, walk: &mut Walk<S>, end: f32x8<S>) {
        let Walk { x, y, s, walking, waiting, hit, turns, solved } = walk;
        for _ in 0..TURNS {
            let along_v = y.next.simd_lt(x.next);
            let leave = along_v.select(y.next, x.next).max(*s).min(end);
            let highest = self.highest(x.looked_up::<MODE>(self.size[0]), y.looked_up::<MODE>(self.size[1]));
            let near = (leave * self.code_rise + self.code).simd_le(highest) & *walking;
            // True is −1.
            *turns -= walking.to_vector();
            *waiting |= near;
            *walking &= !near;
            if walking.all_false() {
                *solved -= waiting.to_vector();
                let (met, at) = self.solve::<MODE>(x, y, *s, leave, *waiting);
                *s = met.select(at, *s);
                *hit |= met;
                *walking = *waiting & !met;
                *waiting = mask32x8::splat(self.simd, false);
            }
            // The floor is met where nothing else was; a border of the bounds is not.
            let ended = *walking & leave.simd_ge(end);
            *s = walking.select(leave, *s);
            *hit |= ended & leave.simd_eq(self.floor);
            *walking &= !ended;
            if (*walking | *waiting).all_false() {
                return;
            }
            x.cross::<MODE>(self.simd, self.size[0], *walking & !along_v, *walking);
            y.cross::<MODE>(self.simd, self.size[1], *walking & along_v, *walking);
        }
    }

    /// Cells of the endless row, in the map as far as that repeats itself.
    #[inline(always)]
    fn reduced(&self, cell: i32x8<S>, k: usize) -> i32x8<S> {
        let period = match self.map.wrap {
            Wrap::Repeat => self.size[k],
            Wrap::Clamp => return cell,
            Wrap::Mirror => 2 * self.size[k],
        };
        if (cell.simd_lt(0) | cell.simd_ge(period)).all_false() {
            return cell;
        }
        let cells = cell.to_array();
        i32x8::load_array(self.simd, std::array::from_fn(|lane| cells[lane].rem_euclid(period)))
    }

    /// Whether these cells, and those of the next turns, are inside the map.
    #[inline(always)]
    fn is_inside(&self, index: i32x8<S>, k: usize) -> mask32x8<S> {
        index.simd_gt(TURNS as i32) & index.simd_lt(self.size[k] - 2 - TURNS as i32)
    }

    /// The codes of eight cells.
    #[inline(always)]
    fn highest(&self, x: i32x8<S>, y: i32x8<S>) -> f32x8<S> {
        let node = (y >> BITS) * self.nodes + (x >> BITS);
        let index = ((node << (2 * BITS)) | ((y & 3) << BITS) | (x & 3)).to_array();
        let mut codes = [0; LANES];
        for lane in 0..LANES {
            codes[lane] = i32::from(self.codes[index[lane] as usize]);
        }
        i32x8::load_array(self.simd, codes).to_float()
    }

    /// The heights at the corners of eight cells: h00, h10, h01, h11.
    #[inline(always)]
    fn corners<const MODE: u8>(&self, x: &Axis<S>, y: &Axis<S>) -> [f32x8<S>; 4] {
        let ([x0, x1], [y0, y1]) = (x.texels::<MODE>(self.size[0]), y.texels::<MODE>(self.size[1]));
        let (top, bottom) = (y0 * self.size[0], y1 * self.size[0]);
        if MODE == INSIDE {
            let ((h00, h10), (h01, h11)) = (self.pairs(top + x0), self.pairs(bottom + x0));
            return [h00, h10, h01, h11];
        }
        [self.heights(top + x0), self.heights(top + x1), self.heights(bottom + x0), self.heights(bottom + x1)]
    }

    /// The heights of eight texels.
    #[inline(always)]
    fn heights(&self, at: i32x8<S>) -> f32x8<S> {
        let at = at.to_array();
        let mut heights = [0.0; LANES];
        for lane in 0..LANES {
            heights[lane] = self.texels[at[lane] as usize];
        }
        f32x8::load_array(self.simd, heights)
    }

    /// The heights of eight texels and of those to the right of them, each two by one look.
    #[inline(always)]
    fn pairs(&self, at: i32x8<S>) -> (f32x8<S>, f32x8<S>) {
        let at = at.to_array();
        let mut pairs = [[0.0; 2]; LANES];
        for lane in 0..LANES {
            pairs[lane].copy_from_slice(&self.texels[at[lane] as usize..][..2]);
        }
        let (low, high) = pairs.as_flattened().split_at(LANES);
        f32x8::from_slice(self.simd, low).deinterleave(f32x8::from_slice(self.simd, high))
    }

    /// Which of the waiting meet the patches they are in, between `s` and `leave`, and where: see
    /// [`crate::exact::patch_crossing`], step by step.
    #[inline(always)]
    fn solve<const MODE: u8>(
        &self,
        x: &Axis<S>,
        y: &Axis<S>,
        s: f32x8<S>,
        leave: f32x8<S>,
        waiting: mask32x8<S>,
    ) -> (mask32x8<S>, f32x8<S>) {
        let simd = self.simd;
        let [h00, h10, h01, h11] = self.corners::<MODE>(x, y);
        let near = waiting & (-leave + 1.0).simd_le(h00.max(h10).max(h01.max(h11)));
        let (a, b) = (x.inside(simd, s), y.inside(simd, s));
        let (beta, gamma, kappa) = (h10 - h00, h01 - h00, h00 - h10 - h01 + h11);
        let c0 = (-s + 1.0) - (h00 + beta * a + gamma * b + kappa * a * b);
        let c1 = -(beta * x.d + gamma * y.d + kappa * (a * y.d + b * x.d)) - 1.0;
        let c2 = -kappa * x.d * y.d;
        let discriminant = c1 * c1 - c2 * 4.0 * c0;
        let q = (c1 + discriminant.sqrt().copysign(c1)) * -0.5;
        let length = leave - s;
        let infinity = f32x8::splat(simd, f32::INFINITY);
        let (first, second) = (q / c2, c0 / q);
        // Comparisons with what is not a number are false: a negative discriminant has no root.
        let first = (first.simd_gt(0.0) & first.simd_le(length)).select(first, infinity);
        let second = (second.simd_gt(0.0) & second.simd_le(length)).select(second, infinity);
        let root = first.min(second);
        let below = c0.simd_le(0.0);
        let met = near & (below | root.simd_lt(infinity));
        (met, below.select(s, s + root))
    }
}

impl<S: Simd> Axis<S> {
    /// Where the rays are at the depth `start`; `index` is still to be told.
    #[inline(always)]
    fn new(simd: S, packet: &Packet<S>, k: usize, start: f32x8<S>) -> Self {
        let (d, local) = (packet.d[k], packet.local[k]);
        let up = d.simd_gt(0.0);
        let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
        // Beyond a border two cells on, the division by zero gives infinity.
        let ahead = up.select(one, d.simd_eq(0.0).select(one + one, zero));
        let edge = (local + d * start).floor() + ahead;
        // Minus zero too.
        let pace = one / (d + 0.0);
        Self {
            d,
            local,
            pace,
            step: up.select(i32x8::splat(simd, 1), i32x8::splat(simd, -1)),
            stride: up.select(one, -one),
            ahead,
            edge,
            first: edge,
            next: (edge - local) * pace,
            index: i32x8::splat(simd, 0),
            entered: mask32x8::splat(simd, false),
        }
    }

    /// The cells, counted from those of the line's start.
    #[inline(always)]
    fn cell(&self) -> i32x8<S> {
        (self.edge - self.ahead).to_int()
    }

    /// The depth at which this border is crossed.
    #[inline(always)]
    fn crossing(&self, edge: f32x8<S>) -> f32x8<S> {
        (edge - self.local) * self.pace
    }

    /// On to the cell of the depth `to`: the one between the borders that are crossed until then. Gives the depth at which the
    /// last of them is crossed, `start` if there is none.
    #[inline(always)]
    fn jump(&mut self, simd: S, to: f32x8<S>, start: f32x8<S>) -> f32x8<S> {
        let zero = f32x8::splat(simd, 0.0);
        let guess = (self.local + self.d * to).floor() + self.ahead;
        // The position is rounded; the borders tell.
        let too_far = self.crossing(guess - self.stride).simd_gt(to);
        let edge = guess - too_far.select(self.stride, zero);
        let not_yet = self.crossing(edge).simd_le(to);
        let edge = edge + not_yet.select(self.stride, zero);
        self.entered = ((edge - self.first) * self.stride).simd_gt(0.0) & self.d.simd_ne(0.0) & to.simd_gt(start);
        self.edge = self.entered.select(edge, self.first);
        self.next = self.crossing(self.edge);
        self.entered.select(self.crossing(self.edge - self.stride).max(start), start)
    }

    /// The texels that stand for numbers of the row of `n`, which are at most one beyond its period.
    #[inline(always)]
    fn texel<const MODE: u8>(i: i32x8<S>, n: i32) -> i32x8<S> {
        match MODE {
            INSIDE => i,
            // Beyond the end is the start: the difference is 0 or −1.
            REPEAT => i & i.simd_lt(n).to_vector(),
            CLAMP => i.max(0).min(n - 1),
            _ => {
                let i = i & i.simd_lt(2 * n).to_vector();
                i.min(-i + (2 * n - 1))
            }
        }
    }

    /// The texels on both sides of the cells.
    #[inline(always)]
    fn texels<const MODE: u8>(&self, n: i32) -> [i32x8<S>; 2] {
        [Self::texel::<MODE>(self.index, n), Self::texel::<MODE>(self.index + 1, n)]
    }

    /// The cells whose maxima stand for these.
    #[inline(always)]
    fn looked_up<const MODE: u8>(&self, n: i32) -> i32x8<S> {
        match MODE {
            INSIDE | REPEAT => self.index,
            CLAMP => Self::texel::<MODE>(self.index, n),
            _ => Self::texel::<MODE>(self.index, n).min(Self::texel::<MODE>(self.index + 1, n)),
        }
    }

    /// How far inside its cell each ray is that came to it at the depth `s`.
    #[inline(always)]
    fn inside(&self, simd: S, s: f32x8<S>) -> f32x8<S> {
        let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
        let position = (self.local + self.d * s) - (self.edge - self.ahead);
        // By a border: exactly there.
        self.entered.select(one - self.ahead, position.max(zero).min(one))
    }

    /// Takes `crossing` into their next cells; of the `moved`, the others have crossed the other axis.
    #[inline(always)]
    fn cross<const MODE: u8>(&mut self, simd: S, n: i32, crossing: mask32x8<S>, moved: mask32x8<S>) {
        self.edge += crossing.select(self.stride, f32x8::splat(simd, 0.0));
        self.next = crossing.select(self.crossing(self.edge), self.next);
        self.entered = (self.entered & !moved) | crossing;
        let index = self.index + (self.step & crossing.to_vector());
        let period = match MODE {
            INSIDE | CLAMP => {
                self.index = index;
                return;
            }
            REPEAT => n,
            _ => 2 * n,
        };
        let index = index & index.simd_lt(period).to_vector();
        self.index = index.simd_lt(0).select(i32x8::splat(simd, period - 1), index);
    }
}

/// The largest integers not above.
#[inline(always)]
fn floor<S: Simd>(x: f32x8<S>) -> i32x8<S> {
    x.floor().to_int()
}
