//! Many rays at once: the exact march of neighbouring rays, with the hits of the scalar one.
//!
//! Sixteen rays are a packet. Sixteen packets look ahead, each as one beam in a lane of its own ([`beam`]). From where its
//! beam stops being free, each ray searches in a lane ([`search`]), from cell to cell and, where that takes long, by windows
//! of 8×8 cells, for the first cell that it does not pass clearly above; what it steps over is free whatever rounding does,
//! so the search need not know the borders exactly. The cell is then entered by the border by which the plain walk enters it
//! ([`axis`]), and its patch is solved as the plain walk solves it. Those that meet nothing there search on; when only few of
//! a packet are left they gather in new packets.

mod axis;
mod beam;
mod search;

use axis::Axis;
use fearless_simd::{Level, dispatch, f32x16, i32x16, mask32x16, prelude::*, u32x16, u64x8};
use relievo_map::Wrap;
use search::Search;

use crate::descent::PyramidField;
use crate::pyramid::Rows;
use crate::{HeightField, MarchOptions, Ray, Record, Technique, march};

/// Rays that go together: twice as many as most processors compute at once, which then wait less for what they look up.
const LANES: usize = 16;
type Floats<S> = f32x16<S>;
type Ints<S> = i32x16<S>;
type Mask<S> = mask32x16<S>;

/// Rays whose packets look ahead together, one to a lane, and whose last ones gather in new packets.
const GROUP: usize = LANES * LANES;

/// So many cells of a packet are solved before those that are left gather.
const ROUNDS: u32 = 8;

/// Maps that are smaller are left to the scalar march: [`ROUNDS`] cells must not be a whole repeat.
const SMALLEST: u32 = 2 * ROUNDS;

/// A packet of no more than these is given up, for its rays to gather with others.
const FEW: u32 = 4;

/// After gathering so often, they go alone.
const GATHERINGS: u32 = 64;

/// Rays that go less than this along an axis (texels per unit of depth), but not nothing, go alone: their pace would overflow.
const FLATTEST: f32 = 1e-30;

/// Rays that reach farther than this (texels from the origin) go alone: below it, f32 counts cells without a gap.
const MAX_REACH: f32 = (1 << 22) as f32;

/// [`march`] for many rays: the same hits to the last bit, in less time.
///
/// [`Technique::Exact`] on a field with a pyramid marches sixteen rays at a time with what the processor has (SSE, AVX2,
/// AVX-512, NEON, WASM SIMD); every 16 that follow each other in `rays` look ahead together, so neighbours should
/// follow each other: tiles of 4×4 pixels, and these in tiles, as Morton order has them. Everything else is marched ray by ray.
/// `fetches` and `iterations` are what each ray cost here; what a packet looked up for all is left out. A ray that [`march`]
/// cuts off may go on here.
///
/// # Panics
/// If `records` has not the length of `rays`.
pub fn march_all(field: &impl HeightField, rays: &[Ray], options: &MarchOptions, records: &mut [Record]) {
    assert_eq!(rays.len(), records.len(), "there is a record for each ray");
    match field.pyramid() {
        Some(map) if options.technique == Technique::Exact && map.pyramid.size().iter().all(|&n| n >= SMALLEST) => {
            let mut alone = Vec::new();
            march_together(map, field.range(), rays, options, records, &mut alone);
            for Alone { index, cost } in alone {
                let record = march(field, &rays[index], options);
                let (fetches, iterations) = (record.fetches + cost, record.iterations + cost);
                records[index] = Record { fetches, iterations, ..record };
            }
        }
        _ => {
            for (record, ray) in records.iter_mut().zip(rays) {
                *record = march(field, ray, options);
            }
        }
    }
}

/// A ray that is to be marched by itself, from its beginning: from elsewhere its first clearance would be rounded otherwise.
struct Alone {
    index: usize,
    /// What it has cost until now.
    cost: u32,
}

/// Not generic, so that it is compiled once for every kind of processor and no more. `range` is that of the field.
fn march_together(
    map: PyramidField<'_>,
    range: [f32; 2],
    rays: &[Ray],
    options: &MarchOptions,
    records: &mut [Record],
    alone: &mut Vec<Alone>,
) {
    dispatch!(Level::new(), simd => Marcher::new(simd, map, range, options).groups(rays, records, alone));
}

/// What is the same for all rays.
struct Marcher<'a, S: Simd> {
    simd: S,
    map: PyramidField<'a>,
    options: &'a MarchOptions,
    /// Depths that no texel rises above and none falls below.
    lid: f32,
    floor: f32,
    /// Columns and rows of the map.
    size: [i32; 2],
    texels: &'a [f32],
    rows: &'a Rows,
    /// The depths down to which rays are above blocks of each code.
    depths: [f32; 256],
    /// The greatest difference between neighbouring texels.
    steepest: f32,
}

/// Rays, ready to go.
#[derive(Clone, Copy)]
struct Packet<S: Simd> {
    /// On the lid.
    uv: [Floats<S>; 2],
    slope: [Floats<S>; 2],
    /// Texels per unit of depth, and depth per texel.
    d: [Floats<S>; 2],
    pace: [Floats<S>; 2],
    /// Where the line stands at the lid, in texel-centre coordinates, and where in its cell.
    origin: [Floats<S>; 2],
    local: [Floats<S>; 2],
    /// Where the walk ends, at the latest.
    end: Floats<S>,
    /// Those that can go together.
    together: Mask<S>,
}

/// A ray that has met nothing yet, and is to go on with others.
#[derive(Clone, Copy)]
struct Waiting {
    index: usize,
    /// Down to which depth it is free.
    depth: f32,
    /// What it has cost until now.
    cost: i32,
    /// How often it has waited.
    times: u32,
}

/// What is not done yet.
struct Left<'a> {
    waiting: Vec<Waiting>,
    alone: &'a mut Vec<Alone>,
}

impl Left<'_> {
    /// Takes in a ray that has hit nothing, and has waited so often.
    #[inline(always)]
    fn take(&mut self, index: usize, times: u32, lane: usize, arrivals: &Arrivals, ray: &Ray, record: &mut Record) {
        let (depth, cost) = (arrivals.depth[lane], arrivals.cost[lane]);
        if arrivals.alone >> lane & 1 != 0 || times >= GATHERINGS {
            self.alone.push(Alone { index, cost: cost as u32 });
        } else if arrivals.walking >> lane & 1 != 0 {
            self.waiting.push(Waiting { index, depth, cost, times: times + 1 });
        } else {
            *record = Record::miss(ray, cost as u32, cost as u32);
        }
    }
}

/// Where the rays of a packet came to.
struct Arrivals {
    uv: [[f32; LANES]; 2],
    depth: [f32; LANES],
    cost: [i32; LANES],
    /// A bit for each that met the surface, that is still on its way, and that cannot go together with others.
    hit: u64,
    walking: u64,
    alone: u64,
}

impl Arrivals {
    /// What a ray met, if it did.
    #[inline(always)]
    fn record(&self, lane: usize) -> Record {
        let cost = self.cost[lane] as u32;
        let uv = [self.uv[0][lane], self.uv[1][lane]];
        Record { uv, depth: self.depth[lane], hit: true, fetches: cost, iterations: cost }
    }
}

impl<'a, S: Simd> Marcher<'a, S> {
    #[inline(always)]
    fn new(simd: S, map: PyramidField<'a>, range: [f32; 2], options: &'a MarchOptions) -> Self {
        let slack = map.pyramid.slack();
        let rows = map.pyramid.rows();
        Self {
            simd,
            options,
            lid: 1.0 - range[1],
            floor: 1.0 - range[0],
            size: map.pyramid.size().map(|n| n as i32),
            texels: map.cells.texels(),
            rows,
            depths: rows.heights().map(|h| 1.0 - h - slack),
            steepest: rows.steepest(),
            map,
        }
    }

    #[inline(always)]
    fn splat(&self, x: f32) -> Floats<S> {
        Floats::splat(self.simd, x)
    }

    #[inline(always)]
    fn groups(&self, rays: &[Ray], records: &mut [Record], alone: &mut Vec<Alone>) {
        let Some(&ray) = rays.first() else { return };
        let mut left = Left { waiting: Vec::with_capacity(GROUP + LANES), alone };
        let mut packets = [self.packet(&[ray; LANES]); LANES];
        for start in (0..rays.len()).step_by(GROUP) {
            let group = &rays[start..rays.len().min(start + GROUP)];
            let (full, rest) = group.as_chunks();
            for (rays, packet) in full.iter().zip(&mut packets) {
                *packet = self.packet(rays);
            }
            if let Some(last) = rest.len().checked_sub(1) {
                // The last one again, where a packet is not full.
                packets[full.len()] = self.packet(&std::array::from_fn(|k| rest[k.min(last)]));
            }
            let packets = &packets[..group.len().div_ceil(LANES)];
            let entries = self.look_ahead(packets);
            for (p, packet) in packets.iter().enumerate() {
                let start = start + p * LANES;
                let arrivals = self.march(packet, self.splat(entries[p]), Ints::splat(self.simd, 0));
                // Most have hit.
                for (lane, record) in records[start..].iter_mut().take(LANES).enumerate() {
                    *record = arrivals.record(lane);
                }
                let mut others = !arrivals.hit & (u64::MAX >> (64 - (rays.len() - start).min(LANES)));
                while others != 0 {
                    let lane = others.trailing_zeros() as usize;
                    let index = start + lane;
                    left.take(index, 0, lane, &arrivals, &rays[index], &mut records[index]);
                    others &= others - 1;
                }
            }
            // Full packets only, until there are no more rays.
            let fewest = if start + GROUP < rays.len() { LANES } else { 1 };
            while left.waiting.len() >= fewest {
                self.gather(rays, records, &mut left);
            }
        }
    }

    /// Marches on the last ones of those that wait, as many as are a packet.
    #[inline(always)]
    fn gather(&self, rays: &[Ray], records: &mut [Record], left: &mut Left<'_>) {
        let count = left.waiting.len();
        let first = count.saturating_sub(LANES);
        let gathered: [Waiting; LANES] = std::array::from_fn(|k| left.waiting[(first + k).min(count - 1)]);
        left.waiting.truncate(first);
        let from = Floats::load_array(self.simd, gathered.map(|ray| ray.depth));
        let cost = Ints::load_array(self.simd, gathered.map(|ray| ray.cost));
        let packet = self.packet(&gathered.map(|ray| rays[ray.index]));
        let arrivals = self.march(&packet, from, cost);
        for (lane, &Waiting { index, times, .. }) in gathered.iter().enumerate().take(count - first) {
            if arrivals.hit >> lane & 1 != 0 {
                records[index] = arrivals.record(lane);
            } else {
                left.take(index, times, lane, &arrivals, &rays[index], &mut records[index]);
            }
        }
    }

    #[inline(always)]
    fn packet(&self, rays: &[Ray; LANES]) -> Packet<S> {
        let simd = self.simd;
        let mut of = [[0.0; LANES]; 5];
        for (lane, ray) in rays.iter().enumerate() {
            of[0][lane] = ray.uv[0];
            of[1][lane] = ray.uv[1];
            of[2][lane] = ray.uv_delta[0];
            of[3][lane] = ray.uv_delta[1];
            of[4][lane] = ray.cos;
        }
        let cos = Floats::load_array(simd, of[4]);
        let mut uv = [Floats::load_array(simd, of[0]), Floats::load_array(simd, of[1])];
        let slope = [Floats::load_array(simd, of[2]) / cos, Floats::load_array(simd, of[3]) / cos];
        let size = self.size.map(|n| n as f32);
        let reach = [(uv[0].abs() + slope[0].abs() * 2.0) * size[0], (uv[1].abs() + slope[1].abs() * 2.0) * size[1]];
        // False for what is not a number.
        let mut together = cos.simd_gt(0.0) & reach[0].simd_lt(MAX_REACH) & reach[1].simd_lt(MAX_REACH);
        let rise = 1.0 - self.options.midlevel.max(0.0).min(1.0);
        if rise != 0.0 {
            uv = [uv[0] - slope[0] * rise, uv[1] - slope[1] * rise];
        }
        let mut end = Floats::splat(simd, self.floor);
        if let Some(bounds) = self.options.bounds {
            for k in 0..2 {
                let (min, max) = (Floats::splat(simd, bounds.min[k]), Floats::splat(simd, bounds.max[k]));
                // Those that come in from the side go alone.
                together &= uv[k].simd_ge(min) & uv[k].simd_le(max);
                let exit = (slope[k].simd_gt(0.0).select(max, min) - uv[k]) / slope[k];
                end = slope[k].simd_eq(0.0).select(end, exit.min(end));
            }
            together &= end.simd_ge(self.lid);
        }
        let origin = [uv[0] * size[0] - 0.5, uv[1] * size[1] - 0.5];
        let local = [origin[0] - origin[0].floor(), origin[1] - origin[1].floor()];
        let d = [slope[0] * size[0], slope[1] * size[1]];
        // What is as good as flat, but is not, has no pace.
        together &= d[0].simd_eq(0.0) | d[0].abs().simd_ge(FLATTEST);
        together &= d[1].simd_eq(0.0) | d[1].abs().simd_ge(FLATTEST);
        // Minus zero too is infinity.
        let pace = [self.splat(1.0) / (d[0] + 0.0), self.splat(1.0) / (d[1] + 0.0)];
        Packet { uv, slope, d, pace, origin, local, end, together }
    }

    /// The depths down to which all rays of each of these packets are free.
    #[inline(always)]
    fn look_ahead(&self, packets: &[Packet<S>]) -> [f32; LANES] {
        self.simd.vectorize(
            #[inline(always)]
            || beam::look_ahead(self, packets),
        )
    }

    /// Marches rays on that are free down to the depths `from` and have cost so much until now.
    #[inline(always)]
    fn march(&self, packet: &Packet<S>, from: Floats<S>, cost: Ints<S>) -> Arrivals {
        // A function of its own, there once for both who call it.
        self.simd.vectorize(
            #[inline(always)]
            || self.marched(packet, from, cost),
        )
    }

    #[inline(always)]
    fn marched(&self, packet: &Packet<S>, from: Floats<S>, cost: Ints<S>) -> Arrivals {
        let walk = self.walk(packet, from);
        let [u, v] = [packet.uv[0] + packet.slope[0] * walk.s, packet.uv[1] + packet.slope[1] * walk.s];
        let mut hit = walk.hit;
        if let Some(bounds) = self.options.bounds {
            hit &= u.simd_ge(bounds.min[0])
                & u.simd_le(bounds.max[0])
                & v.simd_ge(bounds.min[1])
                & v.simd_le(bounds.max[1]);
        }
        Arrivals {
            uv: [u.to_array(), v.to_array()],
            depth: walk.s.to_array(),
            cost: (walk.cost + cost).to_array(),
            hit: hit.to_bitmask(),
            walking: walk.walking.to_bitmask(),
            alone: (!packet.together).to_bitmask(),
        }
    }

    #[inline(always)]
    fn walk(&self, packet: &Packet<S>, from: Floats<S>) -> Walk<S> {
        let simd = self.simd;
        let start = self.splat(self.lid);
        let nobody = Mask::splat(simd, false);
        let mut walk = Walk {
            s: start.max(from.min(packet.end)),
            walking: packet.together,
            hit: nobody,
            cost: Ints::splat(simd, 0),
        };
        let search = Search::new(self, packet, walk.s);
        let (mut x, mut y) = (Axis::new(simd, packet, 0, start), Axis::new(simd, packet, 1, start));
        let mut begun = nobody;
        for _ in 0..ROUNDS {
            let found = search.run(self, &mut walk, packet);
            let to = walk.s;
            let [to_x, next_x] = x.jump(simd, to, start, begun, found);
            let [to_y, next_y] = y.jump(simd, to, start, begun, found);
            let s = to_x.max(to_y);
            // On a tie the plain walk crosses columns first.
            let y_last = y.entered & (to_y.simd_ge(to_x) | !x.entered);
            x.entered &= !y_last;
            y.entered = y_last;
            let leave = next_y.simd_lt(next_x).select(next_y, next_x).max(s).min(packet.end);
            walk.cost -= found.to_vector();
            let inside = (search.direct & to.simd_lt(search.border) | !found).all_true();
            let cell = [(x.cell() + search.base[0]).to_int(), (y.cell() + search.base[1]).to_int()];
            let (met, at) = self.solve(&x, &y, cell, s, leave, found, inside);
            begun |= found;
            // The floor is met where nothing else was; a border of the bounds is not.
            let ended = found & !met & leave.simd_ge(packet.end);
            walk.s = met.select(at, found.select(leave, walk.s));
            walk.hit |= met | (ended & leave.simd_eq(self.floor));
            walk.walking &= !(met | ended);
            if walk.walking.to_bitmask().count_ones() <= FEW {
                break;
            }
        }
        walk
    }

    /// The texel that stands for number `i` of the endless row, which is at most one repeat beside the map.
    #[inline(always)]
    fn texel(&self, i: Ints<S>, k: usize) -> Ints<S> {
        let n = self.size[k];
        let i = match self.map.wrap {
            Wrap::Repeat => {
                let i = i.simd_lt(0).select(i + n, i);
                i.simd_ge(n).select(i - n, i)
            }
            Wrap::Clamp => i,
            Wrap::Mirror => {
                let i = i.simd_lt(0).select(-i - 1, i);
                let i = i.simd_ge(2 * n).select(i - 2 * n, i);
                i.simd_ge(n).select(-i + (2 * n - 1), i)
            }
        };
        i.max(0).min(n - 1)
    }

    /// The heights at the corners of cells: h00, h10, h01, h11. `inside` says that those in question are inside the map.
    #[inline(always)]
    fn corners(&self, x: Ints<S>, y: Ints<S>, who: Mask<S>, inside: bool) -> [Floats<S>; 4] {
        let columns = self.size[0];
        if inside {
            return self.squares((y * columns + x) & who.to_vector());
        }
        // A function of its own, so that nothing of it is computed where it is not needed.
        self.simd.vectorize(
            #[inline(always)]
            || {
                let [x0, x1] = [self.texel(x, 0), self.texel(x + 1, 0)];
                let [top, bottom] = [self.texel(y, 1) * columns, self.texel(y + 1, 1) * columns];
                [self.heights(top + x0), self.heights(top + x1), self.heights(bottom + x0), self.heights(bottom + x1)]
            },
        )
    }

    /// The depths down to which rays are above these blocks of a table.
    #[inline(always)]
    fn look_up(&self, table: &[u8], at: Ints<S>) -> Floats<S> {
        let at = at.bitcast::<u32x16<S>>().to_array();
        let mut depths = [0.0; LANES];
        for lane in 0..LANES {
            depths[lane] = self.depths[usize::from(table[at[lane] as usize])];
        }
        Floats::load_array(self.simd, depths)
    }

    /// The heights of texels.
    #[inline(always)]
    fn heights(&self, at: Ints<S>) -> Floats<S> {
        let at = at.bitcast::<u32x16<S>>().to_array();
        let mut heights = [0.0; LANES];
        for lane in 0..LANES {
            heights[lane] = self.texels[at[lane] as usize];
        }
        Floats::load_array(self.simd, heights)
    }

    /// The heights of texels, of those to the right of them, and of those below both.
    #[inline(always)]
    fn squares(&self, at: Ints<S>) -> [Floats<S>; 4] {
        let at = at.bitcast::<u32x16<S>>().to_array();
        let columns = self.size[0] as u32 as usize;
        let (mut top, mut bottom) = ([0; LANES], [0; LANES]);
        let pair = |heights: &[f32]| u64::from(heights[0].to_bits()) | u64::from(heights[1].to_bits()) << 32;
        for lane in 0..LANES {
            let at = at[lane] as usize;
            let heights = &self.texels[at..at + columns + 2];
            (top[lane], bottom[lane]) = (pair(heights), pair(&heights[columns..]));
        }
        let columns = |pairs: [u64; LANES]| {
            let [low, high] = [0, 1].map(|k| {
                let half = &pairs[k * LANES / 2..][..LANES / 2];
                u64x8::from_slice(self.simd, half).bitcast::<Floats<S>>()
            });
            low.deinterleave(high)
        };
        let ((h00, h10), (h01, h11)) = (columns(top), columns(bottom));
        [h00, h10, h01, h11]
    }

    /// Which of the waiting meet the patches they are in, between `s` and `leave`, and where: see
    /// [`crate::exact::patch_crossing`], step by step.
    #[inline(always)]
    fn solve(
        &self,
        x: &Axis<'_, S>,
        y: &Axis<'_, S>,
        [column, row]: [Ints<S>; 2],
        s: Floats<S>,
        leave: Floats<S>,
        waiting: Mask<S>,
        inside: bool,
    ) -> (Mask<S>, Floats<S>) {
        let simd = self.simd;
        let [h00, h10, h01, h11] = self.corners(column, row, waiting, inside);
        let near = waiting & (-leave + 1.0).simd_le(h00.max(h10).max(h01.max(h11)));
        let (a, b) = (x.inside(simd, s), y.inside(simd, s));
        let (beta, gamma, kappa) = (h10 - h00, h01 - h00, h00 - h10 - h01 + h11);
        let c0 = (-s + 1.0) - (h00 + beta * a + gamma * b + kappa * a * b);
        let c1 = -(beta * *x.d + gamma * *y.d + kappa * (a * *y.d + b * *x.d)) - 1.0;
        let c2 = -kappa * *x.d * *y.d;
        let discriminant = c1 * c1 - c2 * 4.0 * c0;
        let q = (c1 + discriminant.sqrt().copysign(c1)) * -0.5;
        let length = leave - s;
        let infinity = Floats::splat(simd, f32::INFINITY);
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

/// Rays on their way.
struct Walk<S: Simd> {
    /// How far down each is free, or where it ended.
    s: Floats<S>,
    /// Those on their way.
    walking: Mask<S>,
    /// Those that met the surface, or the floor.
    hit: Mask<S>,
    /// Codes and patches that were looked at.
    cost: Ints<S>,
}
