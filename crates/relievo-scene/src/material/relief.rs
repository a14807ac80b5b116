use glam::Vec2;
use relievo_map::Wrap;
use relievo_march::{Bounds, Cones, MarchOptions, ObjectField, ReliefMap, Shadow, Technique};

use super::technique::SurfaceTechnique;

/// Settings of a relief: the `[materials.NAME.relief]` table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relief {
    /// Technique that finds the surface.
    pub technique: SurfaceTechnique,
    /// True to drop the division by V.z in `steep`, `relief`, `occlusion`, `contact` and in the `hard` and `soft` shadows.
    pub offset_limiting: bool,
    /// Layers when seen along the normal, at least 1.
    pub min_layers: f32,
    /// Layers at grazing angles, at least 1; the most steps of `cone` with relaxed cones.
    pub max_layers: f32,
    /// Bisections of `relief` (default 5), `binary` and `cone` with relaxed cones (default 8).
    pub refine_steps: Option<u32>,
    /// Cones that `cone` steps through.
    pub cones: Cones,
    /// Shadows on the surface: `hard` and `soft` are cast by the relief on itself alone, as in the tutorials; `exact` ones by
    /// the relief and by every other object.
    pub shadow: Shadow,
    /// Treatment of displaced uvs outside the object's texture range.
    pub edge: Edge,
    /// `displacement`: vertices along one side of the mesh's uv range 0..1 (of the quad: along its side).
    pub grid: u32,
    /// `displacement` with `grid = "texel"`: vertices along a texel of the height map, at least, in place of `grid`. The surface
    /// is traced without being kept, on the CPU alone.
    pub vertices_per_texel: Option<u32>,
    /// Level of detail by the pixel's footprint: maps and march use the mip level that fits, the relief fades to its polygon
    /// where its march spans less than a pixel, and highlights widen as the normals that a pixel covers scatter.
    pub lod: bool,
    /// True if the hit, not the polygon, gives the depth and the point that is lit. Default: true for `cone` and `exact`,
    /// false for the techniques that the tutorials light at the polygon.
    pub write_depth: Option<bool>,
}

impl Default for Relief {
    fn default() -> Self {
        Self {
            technique: SurfaceTechnique::default(),
            offset_limiting: false,
            min_layers: 8.0,
            max_layers: 32.0,
            refine_steps: None,
            cones: Cones::default(),
            shadow: Shadow::None,
            edge: Edge::Wrap,
            grid: 100,
            vertices_per_texel: None,
            lod: false,
            write_depth: None,
        }
    }
}

impl Relief {
    /// Most vertices along a texel that [`Relief::vertices_per_texel`] may ask for.
    pub const MAX_VERTICES_PER_TEXEL: u32 = 64;

    /// Returns the march options on an object whose texture range ends at `repeat`, with this height on the polygon.
    /// Displaced geometry is flat to a march.
    #[must_use]
    pub fn march(&self, midlevel: f32, repeat: Vec2) -> MarchOptions {
        let technique = match self.technique {
            SurfaceTechnique::Marched(technique) => technique,
            SurfaceTechnique::Displacement => Technique::None,
        };
        let default_steps = if matches!(technique, Technique::Binary | Technique::Cone) { 8 } else { 5 };
        MarchOptions {
            technique,
            offset_limiting: self.offset_limiting,
            min_layers: self.min_layers,
            max_layers: self.max_layers,
            refine_steps: self.refine_steps.unwrap_or(default_steps),
            cones: self.cones,
            midlevel,
            bounds: (self.edge == Edge::Clip).then(|| Bounds { min: [0.0; 2], max: repeat.into() }),
        }
    }

    /// Returns the addressing mode of maps with this wrap mode on an object whose texture range ends at `repeat`, and for
    /// `edge = "clamp"` on several tiles the range beyond which their border stretches.
    #[must_use]
    pub fn addressing(&self, wrap: Wrap, repeat: Vec2) -> (Wrap, Option<[f32; 2]>) {
        match self.edge {
            Edge::Clamp if repeat == Vec2::ONE => (Wrap::Clamp, None),
            Edge::Clamp => (wrap, Some(repeat.into())),
            Edge::Clip | Edge::Wrap => (wrap, None),
        }
    }

    /// Returns the height field of an object whose texture range ends at `repeat`: `heights` at level of detail `lod`,
    /// addressed as `wrap` and `edge` say.
    #[must_use]
    pub fn field<'a>(&self, heights: &'a ReliefMap, lod: f32, wrap: Wrap, repeat: Vec2) -> ObjectField<'a> {
        let (wrap, stretched) = self.addressing(wrap, repeat);
        ObjectField::new(heights.field(lod, wrap), stretched)
    }

    /// Returns true if the hit, not the polygon, gives depth and lit point: as set, else for `cone` and `exact` alone.
    #[must_use]
    pub fn writes_depth(&self) -> bool {
        let on_surface = [Technique::Cone, Technique::Exact].map(SurfaceTechnique::Marched);
        self.write_depth.unwrap_or(on_surface.contains(&self.technique))
    }

    /// Returns the cones that have to be built for the technique, if any.
    #[must_use]
    pub fn needed_cones(&self) -> Option<Cones> {
        (self.technique == SurfaceTechnique::Marched(Technique::Cone)).then_some(self.cones)
    }
}

/// Treatments of displaced uvs outside the object's texture range (0 to `uv_repeat`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Edge {
    /// The ray misses and goes on to what lies behind: a wall that ends.
    Clip,
    /// The relief repeats beyond the range.
    #[default]
    Wrap,
    /// Height and colour of the border stretch outwards.
    Clamp,
}

impl Edge {
    /// All edge modes.
    pub const ALL: [Self; 3] = [Self::Clip, Self::Wrap, Self::Clamp];

    /// Returns the name in scene files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Clip => "clip",
            Self::Wrap => "wrap",
            Self::Clamp => "clamp",
        }
    }

    /// Returns the edge mode with this name, if there is one.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|edge| edge.name() == name)
    }
}
