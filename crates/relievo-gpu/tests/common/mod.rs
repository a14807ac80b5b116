//! What the tests share.

#![allow(dead_code, unreachable_pub)]

pub mod device;
pub mod random;
pub mod tolerances;
