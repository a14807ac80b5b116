use fearless_simd::{f32x16, i32x16, mask32x16};

/// Rays of a packet: twice as many as most processors compute at once, which then wait less for their loads.
pub(super) const LANES: usize = 16;

/// A number for each ray of a packet.
pub(super) type Floats<S> = f32x16<S>;
/// An integer for each ray of a packet.
pub(super) type Ints<S> = i32x16<S>;
/// A condition for each ray of a packet.
pub(super) type Mask<S> = mask32x16<S>;
