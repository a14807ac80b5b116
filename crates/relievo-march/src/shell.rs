//! Marches in the shell of a relief over a curved mesh: exact on any triangle, with the relief's silhouette.
//!
//! Over a triangle with corners P, normals N and texture coordinates uv the surface is
//! `S = P(λ) + (h(uv(λ)) − midlevel)·depth·N(λ)/|N(λ)|`, λ the barycentric weights. The points `P(λ) + e·N(λ)` of one offset e
//! form a triangle, so a straight ray meets each offset once: along e its weights are quotients of quadratics (Ogaki 2023,
//! "Nonlinear Ray Tracing for Displacement and Shell Mapping"), and the height is `midlevel + e·|N(λ)|/depth`. Over the map
//! these quotients are followed from cell to cell through the max pyramid: borders are crossed in closed form, and inside a cell
//! chords keep within 1/1000 of a texel of the curve, by a bound in closed form.

mod curve;
mod march;
mod path;
mod prism;
mod vector;

pub use march::{ShellHit, ShellOutcome, Sides, march_shell, march_shell_from_above, oracle_shell};
pub use prism::{Corner, Prism, ShellRay};
