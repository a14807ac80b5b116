//! Relief mapping: flat polygons with real depth, by every technique of the field behind one march.
//!
//! A march takes a [`Ray`] in texture space and a [`HeightField`] and returns a [`Record`]: the uv where the ray meets the
//! relief, its depth, hit or miss, and the cost. [`Technique::Exact`] finds the first intersection with the bilinear height
//! field, without misses; the others are parallax mapping and its successors.
//!
//! ```
//! use relievo::{Grid, HeightMap, MarchOptions, Ray, ReliefMap, Technique, Wrap, march};
//!
//! // A groove along v, a tenth of a repeat deep, seen under 60° from the left.
//! let map = HeightMap::new(Grid::from_fn(64, 64, |x, _| if (24..40).contains(&x) { 0.0 } else { 1.0 }));
//! let relief = ReliefMap::new(&map);
//! let field = relief.field(0.0, Wrap::Repeat);
//! let ray = Ray::from_view([0.40, 0.5], [-(3.0f32.sqrt()) / 2.0, 0.0, 0.5], [0.1, -0.1]);
//! let record = march(&field, &ray, &MarchOptions { technique: Technique::Exact, ..MarchOptions::default() });
//! assert!(record.hit && record.depth > 0.9 && record.uv[0] > 0.55);
//! ```
//!
//! # Doors
//!
//! The default is the march and the types of maps: eleven crates in all, no files, no GPU. Features open the rest:
//!
//! | feature | module | for |
//! |---|---|---|
//! | – | this page | techniques, shadows, max pyramid, cones, the f64 oracle; maps in memory |
//! | `io` | [`map`] | PNG, JPEG, TIFF, EXR, HDR, TGA, BMP, WebP in; PNG, EXR out; folders of maps by their names |
//! | `convert` | [`map`] | heights ↔ normals, ambient occlusion, bent normals, curvature |
//! | `make` | `make` | procedural materials, heights from photographs, edits, strokes |
//! | `shader` | `shader` | the marches as WGSL, textures as bytes: for any wgpu, Bevy, a browser |
//! | `translate` | `shader` | the same in GLSL, GLSL ES, HLSL, MSL, SPIR-V |
//! | `scene` | `scene` | scene files, glTF, OBJ, cameras, lights, materials |
//! | `cpu` | `cpu` | pictures of scenes on all cores |
//! | `gpu` | `gpu` | height fields and marches on a wgpu device (`wgpu` is re-exported) |
//! | `renderer` | `gpu` | pictures of scenes with wgpu |
//! | `lab` | `lab` | FLIP, hit errors, sweeps, reports, tuning |
//!
//! `scene` and what is above it re-export `glam`.

pub use relievo_march::*;

pub use relievo_map as map;
pub use relievo_map::{ColorMap, Grid, HeightMap, MapSet, NormalMap, ScalarMap, Wrap};

#[cfg(feature = "cpu")]
pub use relievo_cpu as cpu;
#[cfg(feature = "gpu")]
pub use relievo_gpu as gpu;
#[cfg(feature = "lab")]
pub use relievo_lab as lab;
#[cfg(feature = "make")]
pub use relievo_make as make;
#[cfg(feature = "scene")]
pub use relievo_scene as scene;
#[cfg(feature = "shader")]
pub use relievo_shader as shader;

#[cfg(feature = "scene")]
pub use glam;
#[cfg(feature = "gpu")]
pub use wgpu;
