use fearless_simd::prelude::*;

use super::context::PacketContext;
use super::lanes::{Floats, LANES, Mask};
use crate::Ray;
use crate::grid_line::{TEXEL_CENTER, texel_coordinate};

/// The least speed along an axis (texels per unit of depth) of rays in packets, or exactly zero: the inverse of a smaller one
/// would overflow.
const MIN_SPEED: f32 = 1e-30;

/// The farthest reach of rays in packets (texels from the origin): below it, f32 counts cells without a gap.
const MAX_REACH: f32 = (1 << 22) as f32;

/// Sixteen rays over the grid of cells.
#[derive(Clone, Copy)]
pub(super) struct RayPacket<S: Simd> {
    /// The points where the rays cross the lid.
    pub(super) uv: [Floats<S>; 2],
    pub(super) slope: [Floats<S>; 2],
    /// Texels per unit of depth, and depth per texel.
    pub(super) d: [Floats<S>; 2],
    pub(super) inv_d: [Floats<S>; 2],
    /// The position at the lid, in texel-centre coordinates, and inside its cell.
    pub(super) origin: [Floats<S>; 2],
    pub(super) local: [Floats<S>; 2],
    /// The depth at which the march ends, at the latest.
    pub(super) end: Floats<S>,
    /// The rays that can be marched in packets.
    pub(super) usable: Mask<S>,
}

impl<S: Simd> RayPacket<S> {
    /// Prepares rays.
    #[inline(always)]
    pub(super) fn new(context: &PacketContext<'_, S>, rays: &[Ray; LANES]) -> Self {
        let simd = context.simd;
        let mut lanes = [[0.0; LANES]; 5];
        for (lane, ray) in rays.iter().enumerate() {
            lanes[0][lane] = ray.uv[0];
            lanes[1][lane] = ray.uv[1];
            lanes[2][lane] = ray.uv_delta[0];
            lanes[3][lane] = ray.uv_delta[1];
            lanes[4][lane] = ray.cos;
        }
        let cos = Floats::load_array(simd, lanes[4]);
        let mut uv = [Floats::load_array(simd, lanes[0]), Floats::load_array(simd, lanes[1])];
        let slope = [Floats::load_array(simd, lanes[2]) / cos, Floats::load_array(simd, lanes[3]) / cos];
        let size = context.size.map(|n| n as f32);
        let reach = [(uv[0].abs() + slope[0].abs() * 2.0) * size[0], (uv[1].abs() + slope[1].abs() * 2.0) * size[1]];
        // False for what is not a number.
        let mut usable = cos.simd_gt(0.0) & reach[0].simd_lt(MAX_REACH) & reach[1].simd_lt(MAX_REACH);
        let lid_offset = context.options.lid_offset();
        if lid_offset != 0.0 {
            uv = [uv[0] - slope[0] * lid_offset, uv[1] - slope[1] * lid_offset];
        }
        let mut end = Floats::splat(simd, context.floor);
        if let Some(bounds) = context.options.bounds {
            for k in 0..2 {
                let (min, max) = (Floats::splat(simd, bounds.min[k]), Floats::splat(simd, bounds.max[k]));
                // Rays that come in from the side are marched by themselves.
                usable &= uv[k].simd_ge(min) & uv[k].simd_le(max);
                let exit = (slope[k].simd_gt(0.0).select(max, min) - uv[k]) / slope[k];
                end = slope[k].simd_eq(0.0).select(end, exit.min(end));
            }
            usable &= end.simd_ge(context.lid);
        }
        let origin = [0, 1].map(|k| texel_coordinate(uv[k], size[k], TEXEL_CENTER));
        let local = [origin[0] - origin[0].floor(), origin[1] - origin[1].floor()];
        let d = [slope[0] * size[0], slope[1] * size[1]];
        // Rays that hardly move along an axis, but do, have no finite inverse.
        usable &= d[0].simd_eq(0.0) | d[0].abs().simd_ge(MIN_SPEED);
        usable &= d[1].simd_eq(0.0) | d[1].abs().simd_ge(MIN_SPEED);
        // Minus zero too is infinity.
        let inv_d = [context.splat(1.0) / (d[0] + 0.0), context.splat(1.0) / (d[1] + 0.0)];
        Self { uv, slope, d, inv_d, origin, local, end, usable }
    }
}
