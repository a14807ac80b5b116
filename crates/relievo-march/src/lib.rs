//! The height field as a surface: one march, one record.
//!
//! Every technique takes the same [`Ray`] and the same [`HeightField`] and returns the same [`Record`]: the displaced uv, the
//! depth, hit or miss, and the cost.
//!
//! - [`march()`] marches one ray, [`march_all`] many; [`shadow()`] marches from a point of the relief to a light,
//!   [`shadow_up_to`] to one that hangs among the relief.
//! - [`Ray::from_surface`] builds a ray from uv, the direction to the eye and the mesh's uv axes.
//! - [`ReliefMap`] prepares a height map: mip levels, a [`MaxPyramid`] for [`Technique::Exact`], and, on request, a [`ConeMap`] for
//!   [`Technique::Cone`].
//! - [`optical_depth`] takes the relief as a medium: it integrates along a ray over every stretch below the surface.
//! - [`oracle()`] is the f64 reference that every technique is judged by.
//!
//! State and limits: heights are in [0, 1] and sampled bilinearly, without overhangs; the API may change until 1.0.
//!
//! ```text
//!            lid (the polygon, depth t = 0)
//!  ──────────●──────────────────────────────   uv(0) = ray.uv
//!             ╲            ▁▁▁▁
//!              ╲         ▕▔    ▔▏              uv(t) = ray.uv + slope·t,   ray depth = t
//!               ╲   ▁▁▁▁▁▏      ▏
//!  ▁▁▁▁▁▁▁▁▁▁▁▁▁▁●▔▔                           hit: the smallest t with t ≥ D(uv(t))
//!  ─────────────────────────────────────────   floor (t = 1)
//! ```
//!
//! `D = 1 − height`. The crate knows no files, scenes or colours: lengths, tangent frames and texture repeats are folded
//! into the ray by the caller, or by [`Ray::from_surface`].
//!
//! ```
//! use relievo_map::{Grid, HeightMap, Wrap};
//! use relievo_march::{MarchOptions, Ray, ReliefMap, Technique, march};
//!
//! // A step: low on the left, high on the right.
//! let map = HeightMap::new(Grid::from_fn(64, 64, |x, _| if x < 32 { 0.0 } else { 1.0 }));
//! let heights = ReliefMap::new(&map);
//! let field = heights.field(0.0, Wrap::Clamp);
//! // Entering at u = 0.3, seen under 60° from the left, the full depth being a fifth of the texture.
//! let ray = Ray::from_view([0.3, 0.5], [-(3.0f32.sqrt()) / 2.0, 0.0, 0.5], [0.2, -0.2]);
//! let exact = march(&field, &ray, &MarchOptions { technique: Technique::Exact, ..MarchOptions::default() });
//! assert!(exact.hit && (exact.uv[0] - 0.5).abs() < 1.0 / 64.0); // the step's flank
//! ```

mod bounds;
mod cone;
mod cost;
mod exact;
mod field;
mod footprint;
mod grid_line;
mod layered;
mod march;
mod medium;
mod options;
mod packet;
mod patch;
mod pyramid;
mod ray;
mod real;
mod shadow;
mod shell;
mod surface_axes;
mod technique;
mod tile;
mod wrapped_axis;

pub use bounds::Bounds;
pub use cone::{ConeField, ConeMap, Cones};
pub use cost::MAX_CELLS;
pub use exact::{OracleHit, OracleRay, oracle, oracle_from};
pub use field::{ColumnWall, HeightField, HeightFieldView, ObjectField, Raised, ReliefMap, WithoutPyramid, inset};
pub use footprint::{Footprint, Probes};
pub use march::{ExactLoads, exact_loads, march, march_from};
pub use medium::{
    MAX_OPTICAL_DEPTH, Medium, MediumRay, OpticalDepth, henyey_greenstein, optical_depth, scatter_distances,
};
pub use options::{MAX_LAYERS, MAX_REFINE_STEPS, MarchOptions};
pub use packet::march_all;
pub use pyramid::{MaxPyramid, Node, PyramidField, PyramidLevel, TexelRect};
pub use ray::{Ray, Record};
pub use shadow::{ShadowRecord, shadow, shadow_up_to};
pub use shell::{
    Corner, Prism, ShellHit, ShellOutcome, ShellRay, Sides, march_shell, march_shell_from_above, oracle_shell,
};
pub use surface_axes::SurfaceAxes;
pub use technique::{Shadow, Technique};
pub use tile::{TileEntry, tile_entry};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
