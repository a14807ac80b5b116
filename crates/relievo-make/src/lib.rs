//! Makes maps from nothing and from pictures: procedural materials, recipes, heights from photographs, painted strokes,
//! image editing, and the analytic height fields that tests need.
//!
//! ```text
//!  name ──make──▶ surface (height, colour, roughness at u, v) ──▶ rows of texels ──▶ height ──▶ normal, ambient occlusion
//!    └──▶ recipe (TOML: steps) ──▶ step by step ─────────────────────────┘           └────────────┴──▶ MapSet
//! ```
//!
//! # Features
//! * [`make`]: a built-in material by its name, as a complete [`MapSet`](relievo_map::MapSet).
//! * [`recipe`]: a material as a graph of steps in a TOML file; most built-in materials are such files. [`Noise`],
//!   [`Fractal`], [`Voronoi`], [`Masonry`] and [`sdf`] are the patterns of its steps.
//! * [`photo`]: height, normal, occlusion and roughness from one photograph.
//! * [`paint`]: strokes of an SVG drawing or a stroke file, carved into a height map.
//! * [`edit`]: image processing that keeps a tiling map tiling; [`edit::Step`] reads steps such as `blur=0.002`.
//! * [`shapes`]: height fields in closed form.
//!
//! # State and limits
//! Materials are designed in uv space: a larger map shows the same wall in more detail, a smaller one is its average. They
//! tile exactly, need no files, and come out the same, byte for byte, on any number of threads. The largest is [`MAX_SIZE`]
//! texels per side. The crate reads and writes no files, and knows no meshes and no scenes.
//!
//! ```
//! let wall = relievo_make::make("brick-wall", 64)?;
//! assert_eq!(wall.height.unwrap().grid().width(), 64);
//! # Ok::<(), relievo_make::MakeError>(())
//! ```

mod blur;
mod builtin;
mod curve;
pub mod edit;
mod error;
mod layers;
mod noise;
pub mod paint;
mod pattern;
pub mod photo;
pub mod recipe;
pub mod shapes;
mod surface;

pub use builtin::{
    BRICK_WALL_HEIGHT_SCALE, TOY_BOX_HEIGHT_SCALE, brick_wall, built_in, height_scale, make, names, recipe_text,
    toy_box,
};
pub use error::{MAX_SIZE, MakeError};
pub use layers::{HeightLayer, HeightLayers, LayerBlend};
pub use noise::{Basis, Fractal, FractalKind, Noise};
pub use pattern::{Bond, BrickPoint, CellPoint, Masonry, Voronoi, sdf};
pub use photo::{ColorPick, PhotoEdge, PhotoError, PhotoMaps, PhotoOptions, PhotoPreset, SideLight, from_photo};
pub use recipe::{HeightProgram, HeightRecipe, OctaveEntry, Recipe, RecipeError};
