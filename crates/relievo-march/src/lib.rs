//! The height field as a surface: one march, one record.
//!
//! Every technique of the field takes the same [`Ray`] and the same [`HeightField`] and returns the same [`Record`]: where
//! the ray meets the relief, how deep, whether at all, and what it cost to find out.
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
//! into the ray by the caller.
//!
//! ```
//! use relievo_map::{Grid, HeightMap, Wrap};
//! use relievo_march::{ReliefMap, MarchOptions, Ray, Technique, march};
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

mod cone;
mod cone_build;
mod cone_map;
mod descent;
mod exact;
mod field;
mod footprint;
mod march;
mod object_field;
mod packet;
mod pyramid;
mod ray;
mod search;
mod shadow;
mod technique;
mod tile;

pub use cone_map::{ConeField, ConeMap, Cones};
pub use descent::PyramidField;
pub use exact::{MAX_CELLS, OracleHit, OracleRay, oracle};
pub use field::{HeightField, HeightFieldView, ReliefMap};
pub use footprint::{Footprint, Probes};
pub use march::{Bounds, ExactLoads, MAX_LAYERS, MAX_REFINE_STEPS, MarchOptions, exact_loads, march, march_from};
pub use object_field::{ObjectField, inset};
pub use packet::march_all;
pub use pyramid::{MaxPyramid, Node, PyramidLevel, TexelRect};
pub use ray::{Ray, Record};
pub use shadow::{ShadowRecord, shadow};
pub use technique::{Shadow, Technique};
pub use tile::{TileEntry, tile_entry};
