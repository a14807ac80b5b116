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
    /// The end of the relief.
    pub edge: Edge,
    /// The directions along which it rises at hard edges.
    pub offset: Offset,
    /// `displacement`: vertices along one side of the mesh's uv range 0..1 (of the quad: along its side).
    pub grid: u32,
    /// `displacement` with `grid = "texel"`: vertices along a texel of the height map, at least, in place of `grid`. The
    /// surface is traced without being kept, on the CPU alone.
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
            offset: Offset::Own,
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

    /// Returns the march options on a chart with this texture range, with this height on the polygon. Displaced geometry is
    /// flat to a march.
    #[must_use]
    pub fn march(&self, midlevel: f32, range: Bounds) -> MarchOptions {
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
            bounds: self.ends_at(range),
        }
    }

    /// Returns the texture range beyond which there is no relief, on a chart with this one.
    #[must_use]
    pub fn ends_at(&self, range: Bounds) -> Option<Bounds> {
        (self.edge == Edge::Clip).then_some(range)
    }

    /// Returns the addressing mode of maps with this wrap mode on a chart with this texture range, and for `edge = "clamp"` on
    /// another range than one tile the range beyond which its border stretches.
    #[must_use]
    pub fn addressing(&self, wrap: Wrap, range: Bounds) -> (Wrap, Option<Bounds>) {
        match self.edge {
            Edge::Clamp if range == Bounds::TILE => (Wrap::Clamp, None),
            Edge::Clamp => (wrap, Some(range)),
            _ => (wrap, None),
        }
    }

    /// Returns the height field of a chart with this texture range: `heights` at level of detail `lod`, addressed as `wrap`
    /// and `edge` say.
    #[must_use]
    pub fn field<'a>(&self, heights: &'a ReliefMap, lod: f32, wrap: Wrap, range: Bounds) -> ObjectField<'a> {
        let (wrap, stretched) = self.addressing(wrap, range);
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

/// Directions along which a relief rises where a mesh has split normals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Offset {
    /// Each side along its own normals: with a midlevel below 1 they part.
    #[default]
    Own,
    /// All vertices at a position along the mean of their normals, so that no gap opens. Shading normals stay split.
    Shared,
}

impl Offset {
    /// All kinds.
    pub const ALL: [Self; 2] = [Self::Own, Self::Shared];

    /// Returns the name in scene files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Own => "own",
            Self::Shared => "shared",
        }
    }

    /// Returns the kind with this name, if there is one.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|offset| offset.name() == name)
    }
}

/// Ends of a relief.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Edge {
    /// The relief ends where the mesh does: a ray that leaves it misses and goes on to what lies behind.
    Clip,
    /// The relief repeats beyond the chart.
    #[default]
    Wrap,
    /// Height and colour of the border stretch outwards.
    Clamp,
    /// The relief has its true outline, as displaced geometry has. For `exact`; others march as with [`Edge::Wrap`].
    Silhouette,
}

impl Edge {
    /// All edge modes.
    pub const ALL: [Self; 4] = [Self::Clip, Self::Wrap, Self::Clamp, Self::Silhouette];

    /// Returns the name in scene files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Clip => "clip",
            Self::Wrap => "wrap",
            Self::Clamp => "clamp",
            Self::Silhouette => "silhouette",
        }
    }

    /// Returns true if the relief ends, or begins to stretch, where its chart's texture range does.
    #[must_use]
    pub fn ends_at_charts(self) -> bool {
        matches!(self, Self::Clip | Self::Clamp)
    }

    /// Returns the edge mode with this name, if there is one.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|edge| edge.name() == name)
    }
}
