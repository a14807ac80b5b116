use fearless_simd::prelude::*;

use super::lanes::{Floats, Ints, Mask};

/// The state of a packet's rays during the march.
pub(super) struct PacketWalk<S: Simd> {
    /// The depth down to which each ray is free, or of its end.
    pub(super) s: Floats<S>,
    /// The rays still on their way.
    pub(super) active: Mask<S>,
    /// The rays that met the surface, or the floor.
    pub(super) hit: Mask<S>,
    /// The number of maxima and patches looked at.
    pub(super) cost: Ints<S>,
}
