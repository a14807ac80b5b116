//! Compares three techniques with the truth on the built-in wall: FLIP, hits off by over a texel, fetches.
//!
//! ```sh
//! cargo run --release -p relievo --features lab --example judge_techniques
//! ```

#![allow(clippy::print_stdout)]
