//! The native window, and the scene file behind it.

pub(crate) mod display;
pub(crate) mod event_loop;
pub(crate) mod watch;
