//! The rays of packets that have met nothing yet, and the result of a packet.

use super::lanes::LANES;
use crate::{Ray, Record};

/// The most compactions that a ray takes part in before it is marched by itself.
const MAX_COMPACTIONS: u32 = 64;

/// A ray that is to be marched by itself, from its beginning: from elsewhere its first clearance would be rounded otherwise.
pub(super) struct ScalarRay {
    pub(super) index: usize,
    /// Its cost until now.
    pub(super) cost: u32,
}

/// A ray that has met nothing yet, and waits to go on in a new packet.
#[derive(Clone, Copy)]
pub(super) struct PendingRay {
    pub(super) index: usize,
    /// The depth down to which it is free.
    pub(super) depth: f32,
    /// Its cost until now.
    pub(super) cost: i32,
    /// The number of compactions it has been in.
    pub(super) compactions: u32,
}

/// All rays that are not done yet.
pub(super) struct PendingRays<'a> {
    pub(super) pending: Vec<PendingRay>,
    pub(super) scalar: &'a mut Vec<ScalarRay>,
}

impl PendingRays<'_> {
    /// Takes in a ray that has hit nothing, after so many compactions.
    #[inline(always)]
    pub(super) fn take(
        &mut self,
        index: usize,
        compactions: u32,
        lane: usize,
        result: &PacketResult,
        ray: &Ray,
        record: &mut Record,
    ) {
        let (depth, cost) = (result.depth[lane], result.cost[lane]);
        if result.scalar >> lane & 1 != 0 || compactions >= MAX_COMPACTIONS {
            self.scalar.push(ScalarRay { index, cost: cost as u32 });
        } else if result.active >> lane & 1 != 0 {
            self.pending.push(PendingRay { index, depth, cost, compactions: compactions + 1 });
        } else {
            *record = Record::miss(ray, cost as u32, cost as u32);
        }
    }
}

/// The result of marching a packet.
pub(super) struct PacketResult {
    pub(super) uv: [[f32; LANES]; 2],
    pub(super) depth: [f32; LANES],
    pub(super) cost: [i32; LANES],
    /// One bit per ray: it met the surface, is still active, or cannot be marched in packets.
    pub(super) hit: u64,
    pub(super) active: u64,
    pub(super) scalar: u64,
}

impl PacketResult {
    /// Returns the record of a ray that hit.
    #[inline(always)]
    pub(super) fn record(&self, lane: usize) -> Record {
        let cost = self.cost[lane] as u32;
        let uv = [self.uv[0][lane], self.uv[1][lane]];
        Record { uv, depth: self.depth[lane], hit: true, fetches: cost, iterations: cost }
    }
}
