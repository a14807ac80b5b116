//! The marches as compute kernels.

mod layout;
mod march;
mod tiles;

pub use march::{ComputeField, ComputeMarch};
