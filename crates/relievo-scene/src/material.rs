use glam::Vec2;
use relievo_map::{MapSet, MipMap, Wrap};
use relievo_march::{Bounds, Cones, MarchOptions, ReliefMap, Shadow, Technique};

use crate::ColorSpace;

/// The look of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Its name in the scene file.
    pub name: String,
    /// The maps; any may be missing.
    pub maps: MapSet,
    /// Factor on the base colour, linear RGB (the colour itself where there is no map).
    pub base_color: [f32; 3],
    /// Factor on the roughness map (the roughness itself where there is no map), 0..1.
    pub roughness: f32,
    /// Factor on the metallic map (the value itself where there is no map), 0..1.
    pub metallic: f32,
    /// How deep the relief is.
    pub height: HeightRange,
    /// The height that lies on the polygon: 1 = the relief lies wholly below it, 0 = wholly above.
    pub midlevel: f32,
    /// How maps are filtered; [`Relief::lod`] filters by level whatever this says.
    pub filter: Filter,
    /// What lies beyond the maps' borders.
    pub wrap: Wrap,
    /// How the relief is drawn.
    pub relief: Relief,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: "default".to_owned(),
            maps: MapSet::default(),
            base_color: [1.0; 3],
            roughness: 1.0,
            metallic: 0.0,
            height: HeightRange::default(),
            midlevel: 1.0,
            filter: Filter::default(),
            wrap: Wrap::default(),
            relief: Relief::default(),
        }
    }
}

impl Material {
    /// Plain grey without maps: for mesh files that bring no material.
    #[must_use]
    pub fn grey() -> Self {
        Self {
            name: "grey".to_owned(),
            base_color: [0.5; 3],
            relief: Relief { technique: SurfaceTechnique::Marched(Technique::Normal), ..Relief::default() },
            ..Self::default()
        }
    }
}

impl Material {
    /// The height map ready for marching, if there is one: with mip levels for `lod`, with cones for `cone`, and filtered as
    /// `space` asks.
    #[must_use]
    pub fn heights(&self, space: ColorSpace) -> Option<ReliefMap> {
        let map = self.maps.height.as_ref()?;
        let heights = if self.relief.lod { ReliefMap::with_mips(map) } else { ReliefMap::new(map) };
        let heights = match self.relief.needed_cones() {
            Some(cones) => heights.with_cones(cones),
            None => heights,
        };
        // `display` is the tutorials' world, down to how their OpenGL filtered 8-bit maps.
        let eight_bit = space == ColorSpace::Display && map.is_8_bit();
        Some(if eight_bit { heights.filtered_in_8_bits() } else { heights })
    }

    /// Whether its maps are sampled by mip level.
    #[must_use]
    pub fn has_levels(&self) -> bool {
        self.filter == Filter::Trilinear || self.relief.lod
    }

    /// For `lod` where normals come from the height map: how far its slopes scatter within a texel of each level.
    #[must_use]
    pub fn slope_scatter(&self) -> Option<MipMap<[f32; 3]>> {
        let heights = self.maps.height.as_ref().filter(|_| self.relief.lod && self.maps.normal.is_none())?;
        Some(heights.slope_covariance_mips(self.wrap))
    }
}

/// The distance between height 0 and height 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HeightRange {
    /// `height_scale`: as a fraction of one texture repeat along u.
    Scale(f32),
    /// `depth`: in object units.
    Depth(f32),
}

impl Default for HeightRange {
    fn default() -> Self {
        Self::Scale(0.1)
    }
}

/// How maps are filtered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Filter {
    /// Bilinear, full size.
    #[default]
    Linear,
    /// Bilinear in two mip levels, blended; the level from the gradients of the base uv.
    Trilinear,
}

/// How a relief is drawn: the `[materials.NAME.relief]` table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relief {
    /// How the surface is found.
    pub technique: SurfaceTechnique,
    /// Drop the division by V.z in `steep`, `relief`, `occlusion`, `contact` and in the `hard` and `soft` shadows.
    pub offset_limiting: bool,
    /// Layers when seen along the normal, at least 1.
    pub min_layers: f32,
    /// Layers at grazing angles, at least 1; the most steps of `cone` with relaxed cones.
    pub max_layers: f32,
    /// Bisections of `relief` (default 5), `binary` and `cone` with relaxed cones (default 8).
    pub refine_steps: Option<u32>,
    /// What `cone` steps through.
    pub cones: Cones,
    /// Which shadows fall on the surface: `hard` and `soft` are thrown by the relief on itself alone, as in the tutorials;
    /// `exact` ones by the relief and by every other object.
    pub shadow: Shadow,
    /// What happens where the displaced uv leaves the surface.
    pub edge: Edge,
    /// `displacement`: vertices along one side of the mesh's uv range 0..1 (of the quad: along its side).
    pub grid: u32,
    /// Level of detail by the pixel's footprint: maps and march take the mip level that fits, the relief fades to its polygon
    /// where its march spans less than a pixel, and highlights widen as the normals that a pixel covers scatter.
    pub lod: bool,
    /// The hit, not the polygon, gives the depth, and is where lights are seen from. Default: yes for `cone` and `exact`, no
    /// for the techniques that the tutorials light at the polygon.
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
            lod: false,
            write_depth: None,
        }
    }
}

impl Relief {
    /// How the relief is marched on an object whose texture range ends at `repeat`, with this height on the polygon.
    /// Displaced geometry is flat as a march sees it.
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

    /// How maps go on with this wrap mode on an object whose texture range ends at `repeat`, and for `edge = "clamp"` the
    /// range beyond which their border stretches. (A single tile needs no such care.)
    #[must_use]
    pub fn addressing(&self, wrap: Wrap, repeat: Vec2) -> (Wrap, Option<[f32; 2]>) {
        match self.edge {
            Edge::Clamp if repeat == Vec2::ONE => (Wrap::Clamp, None),
            Edge::Clamp => (wrap, Some(repeat.into())),
            Edge::Clip | Edge::Wrap => (wrap, None),
        }
    }

    /// Whether the hit, not the polygon, is where the surface is: as asked for, else for `cone` and `exact` alone.
    #[must_use]
    pub fn writes_depth(&self) -> bool {
        let on_surface = [Technique::Cone, Technique::Exact].map(SurfaceTechnique::Marched);
        self.write_depth.unwrap_or(on_surface.contains(&self.technique))
    }

    /// The cones that have to be built for the technique, if any.
    #[must_use]
    pub fn needed_cones(&self) -> Option<Cones> {
        (self.technique == SurfaceTechnique::Marched(Technique::Cone)).then_some(self.cones)
    }
}

/// What finds the surface: a march through the height field, or real geometry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SurfaceTechnique {
    /// A technique that marches (or ignores) the height field.
    Marched(Technique),
    /// A grid of vertices moved along the normal: `displacement`.
    Displacement,
}

impl Default for SurfaceTechnique {
    fn default() -> Self {
        Self::Marched(Technique::Exact)
    }
}

impl SurfaceTechnique {
    /// The name in scene files and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Marched(technique) => technique.name(),
            Self::Displacement => "displacement",
        }
    }

    /// The technique with this name, if there is one.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        if name == "displacement" { Some(Self::Displacement) } else { Technique::from_name(name).map(Self::Marched) }
    }

    /// All names, in the order of [`Technique::ALL`] with `displacement` last.
    pub fn names() -> impl Iterator<Item = &'static str> {
        Technique::ALL.into_iter().map(Technique::name).chain(["displacement"])
    }
}

/// What happens where the displaced uv leaves the object's texture range (0 to `uv_repeat`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Edge {
    /// The ray goes on to what lies behind: a wall that ends.
    Clip,
    /// The relief goes on tiling.
    #[default]
    Wrap,
    /// The border's height and colour stretch outwards.
    Clamp,
}
