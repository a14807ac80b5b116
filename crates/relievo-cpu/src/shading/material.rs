use std::sync::Arc;

use glam::Vec3;
use relievo_map::{Grid, GridId, MipMap, ScalarMap, Texel, Wrap};
use relievo_march::{Bounds, Cones, Footprint, ObjectField, ReliefMap, Technique, inset};
use relievo_scene::{ColorSpace, HeightRange, Material, Mist, Relief, ShadingModel, Side, SurfaceTechnique};

use super::material_sample::MaterialSample;
use super::mean_normal::MeanNormal;

/// A side of a material with its maps ready to be sampled. All but the heights are shared by both sides.
pub(crate) struct MaterialShading {
    base_color: Option<Arc<MipMap<[f32; 4]>>>,
    /// The mean normal of a texel and its length, as [`relievo_map::NormalMap::toksvig_mips`] has them.
    normal: Option<Arc<MipMap<[f32; 4]>>>,
    /// Scatter of the heights' slopes within a texel, where there is no normal map.
    slopes: Option<Arc<MipMap<[f32; 3]>>>,
    pub(crate) heights: Option<Arc<ReliefMap>>,
    roughness: Option<Arc<MipMap<f32>>>,
    metallic: Option<Arc<MipMap<f32>>>,
    ao: Option<Arc<MipMap<f32>>>,
    factors: MaterialSample,
    pub(crate) range: HeightRange,
    pub(crate) midlevel: f32,
    pub(crate) relief: Relief,
    /// True if any map is sampled by mip level.
    pub(crate) needs_footprint: bool,
    /// True if the maps' nearest texels are taken.
    nearest: bool,
    /// Addressing of all maps inside the object's texture range.
    wrap: Wrap,
    side: Side,
    /// True if displaced geometry is drawn from both sides.
    pub(crate) two_sided: bool,
    /// The medium that the relief is, if it is no surface.
    pub(crate) mist: Option<Mist>,
    /// The maps that these were made of, and their form.
    made_of: ([Option<GridId>; 6], MapForm),
}

/// Settings on which the form of all of a material's maps depends.
#[derive(Clone, Copy, Debug, PartialEq)]
struct MapForm {
    has_levels: bool,
    lod: bool,
    nearest: bool,
    cones: Option<Cones>,
    wrap: Wrap,
    space: ColorSpace,
}

impl MaterialShading {
    /// Makes a material's maps ready. Those that `known` has of the same form are shared with it.
    pub(crate) fn new(material: &Material, space: ColorSpace, known: Option<&Self>) -> Self {
        let relief = material.relief;
        let (has_levels, nearest) = (material.has_levels(), material.is_nearest());
        let maps = &material.maps;
        let cones = relief.needed_cones();
        let form = MapForm { has_levels, lod: relief.lod, nearest, cones, wrap: material.wrap, space };
        let ids = maps.ids();
        let known = known.filter(|known| known.made_of.1 == form && known.side == Side::Front);
        let same = |map: usize| known.filter(|known| known.made_of.0[map] == ids[map]);
        let scalar = |map: &Option<ScalarMap>| map.as_ref().map(|map| Arc::new(mips(map.grid().clone(), has_levels)));
        let colors = || {
            let map = maps.base_color.as_ref()?;
            let colors = match space {
                ColorSpace::Linear => map.to_linear(),
                ColorSpace::Display => map.to_display(),
            };
            Some(Arc::new(mips(colors, has_levels)))
        };
        let normals = || {
            let map = maps.normal.as_ref()?;
            let plain = || mips(map.grid().map(|&[x, y, z]| [x, y, z, 1.0]), has_levels);
            Some(Arc::new(if relief.lod { map.toksvig_mips() } else { plain() }))
        };
        let scatter = same(1).and(same(2));
        Self {
            base_color: same(0).map_or_else(colors, |known| known.base_color.clone()),
            normal: same(1).map_or_else(normals, |known| known.normal.clone()),
            slopes: scatter.map_or_else(|| material.slope_scatter().map(Arc::new), |known| known.slopes.clone()),
            heights: same(2).map_or_else(|| material.heights(space).map(Arc::new), |known| known.heights.clone()),
            roughness: same(3).map_or_else(|| scalar(&maps.roughness), |known| known.roughness.clone()),
            metallic: same(4).map_or_else(|| scalar(&maps.metallic), |known| known.metallic.clone()),
            ao: same(5).map_or_else(|| scalar(&maps.ao), |known| known.ao.clone()),
            factors: MaterialSample {
                base_color: material.base_color,
                roughness: material.roughness,
                metallic: material.metallic,
                ao: 1.0,
            },
            range: material.height,
            midlevel: material.midlevel,
            relief,
            needs_footprint: has_levels,
            nearest,
            wrap: material.wrap,
            side: Side::Front,
            two_sided: material.is_two_sided(),
            mist: material.mist,
            made_of: (ids, form),
        }
    }

    /// Makes the back of a material from its front; `known` is a back that may have the same heights.
    pub(crate) fn back(&self, material: &Material, space: ColorSpace, known: Option<&Self>) -> Self {
        let is_same = |known: &&Self| {
            known.side == Side::Back && (known.made_of.0[2], known.made_of.1) == (self.made_of.0[2], self.made_of.1)
        };
        let heights = known
            .filter(is_same)
            .map_or_else(|| material.side_heights(Side::Back, space).map(Arc::new), |known| known.heights.clone());
        Self {
            base_color: self.base_color.clone(),
            normal: self.normal.clone(),
            slopes: self.slopes.clone(),
            heights,
            roughness: self.roughness.clone(),
            metallic: self.metallic.clone(),
            ao: self.ao.clone(),
            midlevel: Side::Back.midlevel(material.midlevel),
            side: Side::Back,
            ..*self
        }
    }

    /// Returns the technique that marches this material's height map, if it has both.
    pub(crate) fn march(&self) -> Option<(Technique, &ReliefMap)> {
        self.relief.technique.marched().zip(self.heights.as_deref())
    }

    /// Returns true if parts of the relief lie above the polygons that it is marched from.
    pub(crate) fn is_raised(&self) -> bool {
        self.march().is_some() && self.midlevel < 1.0
    }

    /// Returns the height map at a level of detail, addressed as on a chart with this texture range.
    pub(crate) fn field<'a>(&self, heights: &'a ReliefMap, lod: f32, range: Bounds) -> ObjectField<'a> {
        self.relief.field(heights, lod, self.wrap, range)
    }

    /// Returns the full-size height map, continued beyond every border.
    pub(crate) fn whole_field(&self) -> Option<ObjectField<'_>> {
        Some(ObjectField::Tiled(self.heights.as_ref()?.field(0.0, self.wrap)))
    }

    /// Returns the share of light that mist scatters, linear RGB.
    pub(crate) fn albedo(&self) -> Vec3 {
        self.factors.base_color.into()
    }

    /// Returns the addressing mode of all maps inside the object's texture range.
    pub(crate) fn wrap(&self) -> Wrap {
        self.wrap
    }

    /// Samples a map over the footprint around `uv`, on a chart with this texture range.
    #[inline]
    fn sample_map<T: Texel>(&self, map: &MipMap<T>, uv: [f32; 2], footprint: &Footprint, range: Bounds) -> T {
        let size = [map.base().width(), map.base().height()];
        if !self.relief.lod {
            return self.sample_level(map, uv, footprint.lod(size), range);
        }
        let probes = footprint.probes(size);
        let share = 1.0 / probes.count as f32;
        (0..probes.count)
            .fold(T::ZERO, |sum, i| sum.add_scaled(self.sample_level(map, probes.uv(uv, i), probes.lod, range), share))
    }

    /// Samples a map at `uv` of a chart with this texture range.
    #[inline]
    fn sample_level<T: Texel>(&self, map: &MipMap<T>, uv: [f32; 2], lod: f32, range: Bounds) -> T {
        let (wrap, stretched) = self.relief.addressing(self.wrap, range);
        let uv = stretched.map_or(uv, |bounds| {
            // Half a texel inside, where no neighbour tile mixes in.
            let texel = lod.ceil().exp2();
            let size = [map.base().width(), map.base().height()];
            std::array::from_fn(|k| inset(uv[k], 0.5 * texel / size[k] as f32, [bounds.min[k], bounds.max[k]]))
        });
        if self.nearest {
            // A texel's middle is the texel alone.
            let size = [map.base().width(), map.base().height()].map(|n| n as f32);
            let uv = std::array::from_fn(|k| ((uv[k] * size[k]).floor() + 0.5) / size[k]);
            return map.sample(uv, lod, wrap);
        }
        map.sample(uv, lod, wrap)
    }

    /// Returns the scatter of the heights' slopes within a texel at `uv`, if normals come from the heights: variances and
    /// covariance.
    pub(crate) fn slope_scatter(&self, uv: [f32; 2], lod: f32, range: Bounds) -> [f32; 3] {
        self.slopes.as_ref().map_or([0.0; 3], |map| self.sample_level(map, uv, lod, range))
    }

    /// Returns the mean tangent-space normal of the normal map over a footprint, if there is one.
    pub(crate) fn normal(&self, uv: [f32; 2], footprint: &Footprint, range: Bounds) -> Option<MeanNormal> {
        let map = self.normal.as_ref()?;
        let size = [map.base().width(), map.base().height()];
        let (wrap, _) = self.relief.addressing(self.wrap, range);
        let mirror_sign = |u: f32| if wrap.is_mirrored(u) { -1.0 } else { 1.0 };
        let normal_sign = self.side.normal_sign();
        // x and y change sign where the map is mirrored.
        let at = |uv: [f32; 2], lod: f32| {
            let [x, y, z, length] = self.sample_level(map, uv, lod, range);
            (Vec3::new(x * normal_sign * mirror_sign(uv[0]), y * normal_sign * mirror_sign(uv[1]), z), length)
        };
        if !self.relief.lod {
            return Some(MeanNormal { direction: at(uv, footprint.lod(size)).0, length: 1.0 });
        }
        let probes = footprint.probes(size);
        Some(MeanNormal::of((0..probes.count).map(|i| at(probes.uv(uv, i), probes.lod))))
    }

    /// Returns true if the relief is real geometry.
    pub(crate) fn is_displaced(&self) -> bool {
        self.relief.technique == SurfaceTechnique::Displacement && self.heights.is_some()
    }

    /// Returns true if the technique asks for the geometric normal: `none`.
    pub(crate) fn is_flat(&self) -> bool {
        self.relief.technique.shades_flat()
    }

    /// Samples all maps but the normal at `uv`, as far as `model` needs them; `footprint` is the pixel's size in texture
    /// repeats.
    pub(crate) fn sample(
        &self,
        uv: [f32; 2],
        footprint: &Footprint,
        range: Bounds,
        model: ShadingModel,
    ) -> MaterialSample {
        let scalar = |map: &Option<Arc<MipMap<f32>>>, factor: f32| {
            map.as_ref().map_or(factor, |map| factor * self.sample_map(map, uv, footprint, range))
        };
        let base_color = self.base_color.as_ref().map_or(self.factors.base_color, |map| {
            let texel = self.sample_map(map, uv, footprint, range);
            [0, 1, 2].map(|k| texel[k] * self.factors.base_color[k])
        });
        let ao = scalar(&self.ao, self.factors.ao);
        let sample = MaterialSample { base_color, ao, ..self.factors };
        if !model.is_physical() {
            return sample;
        }
        MaterialSample {
            roughness: scalar(&self.roughness, self.factors.roughness),
            metallic: scalar(&self.metallic, self.factors.metallic),
            ..sample
        }
    }
}

fn mips<T: Texel>(grid: Grid<T>, has_levels: bool) -> MipMap<T> {
    if has_levels { MipMap::build(grid) } else { MipMap::single(grid) }
}
