use glam::Vec2;
use relievo_map::{Grid, MipMap, ScalarMap, Texel, Wrap};
use relievo_march::{Heights, ObjectField, Technique, inset};
use relievo_scene::{ColorSpace, Filter, HeightRange, Material, Relief, ShadingModel, SurfaceTechnique};

/// A material with its maps ready to be sampled.
pub(crate) struct Look {
    base_color: Option<MipMap<[f32; 4]>>,
    normal: Option<MipMap<[f32; 3]>>,
    pub(crate) heights: Option<Heights>,
    roughness: Option<MipMap<f32>>,
    metallic: Option<MipMap<f32>>,
    ao: Option<MipMap<f32>>,
    factors: Texels,
    pub(crate) range: HeightRange,
    pub(crate) midlevel: f32,
    pub(crate) relief: Relief,
    /// Whether any map is sampled by mip level.
    pub(crate) needs_footprint: bool,
    /// Addressing of all maps inside the object's texture range.
    wrap: Wrap,
}

/// What shading needs to know of a point.
#[derive(Clone, Copy)]
pub(crate) struct Texels {
    pub(crate) base_color: [f32; 3],
    pub(crate) roughness: f32,
    pub(crate) metallic: f32,
    pub(crate) ao: f32,
}

impl Look {
    pub(crate) fn new(material: &Material, space: ColorSpace) -> Self {
        let filter = material.filter;
        let relief = material.relief;
        let maps = &material.maps;
        let scalar = |map: &Option<ScalarMap>| map.as_ref().map(|map| mips(map.grid().clone(), filter));
        Self {
            base_color: maps.base_color.as_ref().map(|map| {
                let colors = match space {
                    ColorSpace::Linear => map.to_linear(),
                    ColorSpace::Display => map.to_display(),
                };
                mips(colors, filter)
            }),
            normal: maps.normal.as_ref().map(|map| mips(map.grid().clone(), filter)),
            heights: material.heights(space),
            roughness: scalar(&maps.roughness),
            metallic: scalar(&maps.metallic),
            ao: scalar(&maps.ao),
            factors: Texels {
                base_color: material.base_color,
                roughness: material.roughness,
                metallic: material.metallic,
                ao: 1.0,
            },
            range: material.height,
            midlevel: material.midlevel,
            relief,
            needs_footprint: filter == Filter::Trilinear || relief.lod,
            wrap: material.wrap,
        }
    }

    /// The technique that marches this material's height map, if it has both.
    pub(crate) fn march(&self) -> Option<(Technique, &Heights)> {
        match (self.relief.technique, &self.heights) {
            (SurfaceTechnique::March(Technique::None | Technique::Normal) | SurfaceTechnique::Displacement, _) => None,
            (SurfaceTechnique::March(technique), Some(heights)) => Some((technique, heights)),
            (_, None) => None,
        }
    }

    /// Whether parts of the relief lie above the polygons that it is marched from.
    pub(crate) fn is_risen(&self) -> bool {
        self.march().is_some() && self.midlevel < 1.0
    }

    /// The height map at a level of detail, addressed as on an object with this texture range.
    pub(crate) fn field<'a>(&self, heights: &'a Heights, lod: f32, repeat: Vec2) -> ObjectField<'a> {
        let (wrap, stretched) = self.relief.addressing(self.wrap, repeat);
        ObjectField::new(heights.field(lod, wrap), stretched)
    }

    /// A map at `uv` of an object with this texture range.
    #[inline]
    pub(crate) fn sample<T: Texel>(&self, map: &MipMap<T>, uv: [f32; 2], footprint: &Footprint, repeat: Vec2) -> T {
        let lod = footprint.lod(map.base());
        let (wrap, stretched) = self.relief.addressing(self.wrap, repeat);
        let uv = stretched.map_or(uv, |repeat| {
            // Half a texel inside, where no neighbour tile mixes in.
            let texel = lod.ceil().exp2();
            let size = [map.base().width(), map.base().height()];
            std::array::from_fn(|k| inset(uv[k], 0.5 * texel / size[k] as f32, repeat[k]))
        });
        map.sample(uv, lod, wrap)
    }

    /// The tangent-space normal of the normal map, if there is one: turned over where the map stands mirrored.
    pub(crate) fn normal(&self, uv: [f32; 2], footprint: &Footprint, repeat: Vec2) -> Option<[f32; 3]> {
        let [x, y, z] = self.sample(self.normal.as_ref()?, uv, footprint, repeat);
        let (wrap, _) = self.relief.addressing(self.wrap, repeat);
        let facing = |u: f32| if wrap.is_mirrored(u) { -1.0 } else { 1.0 };
        Some([x * facing(uv[0]), y * facing(uv[1]), z])
    }

    /// Whether the relief is real geometry.
    pub(crate) fn is_displaced(&self) -> bool {
        self.relief.technique == SurfaceTechnique::Displacement && self.heights.is_some()
    }

    /// Whether `technique = "none"` asks for the geometric normal.
    pub(crate) fn is_flat(&self) -> bool {
        self.relief.technique == SurfaceTechnique::March(Technique::None)
    }

    /// All maps but the normal at `uv`, as far as `model` asks for them; `footprint` is the pixel's size in texture repeats.
    pub(crate) fn texels(&self, uv: [f32; 2], footprint: &Footprint, repeat: Vec2, model: ShadingModel) -> Texels {
        let scalar = |map: &Option<MipMap<f32>>, factor: f32| {
            map.as_ref().map_or(factor, |map| factor * self.sample(map, uv, footprint, repeat))
        };
        let base_color = self.base_color.as_ref().map_or(self.factors.base_color, |map| {
            let texel = self.sample(map, uv, footprint, repeat);
            [0, 1, 2].map(|k| texel[k] * self.factors.base_color[k])
        });
        let ao = scalar(&self.ao, self.factors.ao);
        match model {
            ShadingModel::BlinnPhong => Texels { base_color, ao, ..self.factors },
            ShadingModel::Pbr => Texels {
                base_color,
                ao,
                roughness: scalar(&self.roughness, self.factors.roughness),
                metallic: scalar(&self.metallic, self.factors.metallic),
            },
        }
    }
}

fn mips<T: Texel>(grid: Grid<T>, filter: Filter) -> MipMap<T> {
    match filter {
        Filter::Trilinear => MipMap::build(grid),
        Filter::Linear => MipMap::single(grid),
    }
}

/// How far a step of one pixel goes on the surface, in texture repeats: the gradients of the base uv.
#[derive(Clone, Copy, Default)]
pub(crate) struct Footprint {
    pub(crate) dx: [f32; 2],
    pub(crate) dy: [f32; 2],
}

impl Footprint {
    /// The mip level at which the longer gradient spans one texel of a map of this size, as graphics APIs define it.
    pub(crate) fn lod<T>(&self, base: &Grid<T>) -> f32 {
        self.lod_for([base.width(), base.height()])
    }

    pub(crate) fn lod_for(&self, size: [u32; 2]) -> f32 {
        if self.dx == [0.0; 2] && self.dy == [0.0; 2] {
            return 0.0;
        }
        let length = |d: [f32; 2]| (d[0] * size[0] as f32).hypot(d[1] * size[1] as f32);
        // log2(0) = −∞ and NaN both mean level 0.
        length(self.dx).max(length(self.dy)).log2().max(0.0)
    }
}
