use crate::cone::cone_crossing;
use crate::exact::{MAX_CELLS, Walk, enters_below, first_crossing, first_hit, first_hit_by};
use crate::search::{bisect, contact, occlusion, relief, steep};
use crate::{Cones, HeightField, Ray, Record, Technique};

/// More layers than this are taken as this many: every loop is bounded.
pub const MAX_LAYERS: f32 = 4096.0;

/// More bisections than this are taken as this many; f32 has nothing left to halve.
pub const MAX_REFINE_STEPS: u32 = 64;

/// A rectangle of uv outside of which there is no surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lower corner, in texture repeats.
    pub min: [f32; 2],
    /// Upper corner, in texture repeats.
    pub max: [f32; 2],
}

impl Bounds {
    /// Whether `uv` lies inside or on the border.
    #[inline]
    #[must_use]
    pub fn contains(&self, uv: [f32; 2]) -> bool {
        (0..2).all(|k| uv[k] >= self.min[k] && uv[k] <= self.max[k])
    }
}

/// How to march.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarchOptions {
    /// The technique.
    pub technique: Technique,
    /// Drop the division by V.z in the layered techniques and their shadows.
    pub offset_limiting: bool,
    /// Layers when looking along the normal; 1 to [`MAX_LAYERS`].
    pub min_layers: f32,
    /// Layers when looking along the surface; 1 to [`MAX_LAYERS`]. Also the most steps of relaxed cones, at any angle.
    pub max_layers: f32,
    /// Bisections of `relief` and `binary`, and the most of relaxed cones; at most [`MAX_REFINE_STEPS`].
    pub refine_steps: u32,
    /// The cones that `cone` steps through. The field has to have them: see [`crate::ReliefMap::with_cones`].
    pub cones: Cones,
    /// The height that lies at `ray.uv`, on the polygon: with less than 1 the relief rises above it, and the march starts
    /// at its lid, the height 1. In [0, 1].
    pub midlevel: f32,
    /// Where the surface ends (`edge = "clip"`); without, it tiles for ever.
    pub bounds: Option<Bounds>,
}

impl Default for MarchOptions {
    fn default() -> Self {
        Self {
            technique: Technique::default(),
            offset_limiting: false,
            min_layers: 8.0,
            max_layers: 32.0,
            refine_steps: 5,
            cones: Cones::default(),
            midlevel: 1.0,
            bounds: None,
        }
    }
}

impl MarchOptions {
    /// The number of layers for a ray with this cosine: `mix(max, min, |cos|)`, used with its fraction.
    #[inline]
    #[must_use]
    pub fn layers(&self, cos: f32) -> f32 {
        let n = self.max_layers + (self.min_layers - self.max_layers) * cos.abs();
        // `max` first: it also turns NaN into 1.
        n.max(1.0).min(MAX_LAYERS)
    }

    /// The most cells that a march through relaxed cones looks at, before it takes the place it has reached.
    pub(crate) fn cone_steps(&self) -> u32 {
        self.max_layers.max(1.0).min(MAX_LAYERS).ceil() as u32
    }

    /// The ray moved along itself from the polygon to the lid.
    #[must_use]
    pub fn on_lid(&self, ray: &Ray) -> Ray {
        let rise = self.rise();
        if rise == 0.0 {
            return *ray;
        }
        let slope = self.search_slope(ray);
        Ray { uv: [ray.uv[0] - slope[0] * rise, ray.uv[1] - slope[1] * rise], ..*ray }
    }

    /// The uv travelled from the lid to the floor by this technique.
    fn search_slope(&self, ray: &Ray) -> [f32; 2] {
        match self.technique {
            Technique::Steep | Technique::Relief | Technique::Occlusion | Technique::Contact => self.layered_slope(ray),
            _ => ray.slope(),
        }
    }

    /// How far the lid lies above the polygon, as a fraction of the full depth.
    fn rise(&self) -> f32 {
        1.0 - self.midlevel.max(0.0).min(1.0)
    }

    /// The uv travelled from the lid to the floor by the layered techniques.
    #[inline]
    pub(crate) fn layered_slope(&self, ray: &Ray) -> [f32; 2] {
        if self.offset_limiting { ray.uv_delta } else { ray.slope() }
    }
}

/// Finds where `ray` meets the relief.
///
/// Ends for every input: rays that are not finite, run along or away from the surface, or reach beyond 2³⁰ texels are
/// misses at no cost. `uv` and `depth` of a hit are finite, and depth is in [0, 1].
#[must_use]
pub fn march(field: &impl HeightField, ray: &Ray, options: &MarchOptions) -> Record {
    march_from(field, ray, options, 0.0)
}

/// [`march`], for a ray that is known to stay above the surface down to the depth `entry`, as [`crate::tile_entry`] tells:
/// the walks over the cells, `cone` and `exact`, begin there. The other techniques begin where they always do. What lies above `entry` is not seen.
#[must_use]
pub fn march_from(field: &impl HeightField, ray: &Ray, options: &MarchOptions, entry: f32) -> Record {
    if !ray.is_usable(field.size()) {
        return Record::miss(ray, 0, 0);
    }
    let rise = options.rise();
    let lid = options.on_lid(ray);
    // A relief that rises above its polygon may be entered beside it, where there is none.
    // (Walks over the cells know their bounds.)
    let is_beside = |bounds: &Bounds| rise > 0.0 && !bounds.contains(lid.uv) && !options.technique.walks();
    match options.bounds.filter(is_beside) {
        Some(bounds) => {
            let slope = options.search_slope(ray);
            if options.technique.searches()
                && enters_below(field, &Walk { uv: lid.uv, slope, bounds: Some(bounds), entry: 0.0 })
            {
                return Record::miss(ray, 1, 1);
            }
            search(&Fenced { field, bounds }, ray, &lid, options, entry)
        }
        None => search(field, ray, &lid, options, entry),
    }
}

/// What the exact march of a ray loads, by kind; together they are its [`Record::fetches`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ExactLoads {
    /// Nodes of the max pyramid, 16 bytes each.
    pub nodes: u32,
    /// Cells: the four heights at the corners of one, at once.
    pub gathers: u32,
}

/// Marches `ray` as [`Technique::Exact`] does, whatever `options` says, and counts what is loaded: for measuring.
#[must_use]
pub fn exact_loads(field: &impl HeightField, ray: &Ray, options: &MarchOptions) -> ExactLoads {
    if !ray.is_usable(field.size()) {
        return ExactLoads::default();
    }
    let options = MarchOptions { technique: Technique::Exact, ..*options };
    let walk = Walk { uv: options.on_lid(ray).uv, slope: ray.slope(), bounds: options.bounds, entry: 0.0 };
    let (_, cost) = first_hit(field, &walk, MAX_CELLS);
    ExactLoads { nodes: cost.fetches - cost.gathers, gathers: cost.gathers }
}

/// [`march`], for a ray that is usable, with the same ray on the lid.
fn search(field: &impl HeightField, ray: &Ray, lid: &Ray, options: &MarchOptions, entry: f32) -> Record {
    let rise = options.rise();
    let slope = ray.slope();
    // One sample, where the ray meets the polygon: `offset` is the way in uv per unit of depth below the polygon.
    let one_sample = |offset: [f32; 2], reference: f32| {
        let height = field.sample(ray.uv);
        let uv = [0, 1].map(|k| ray.uv[k] + offset[k] * (reference - height));
        Record { uv, depth: 1.0 - height, hit: true, fetches: 1, iterations: 1 }
    };
    let record = match options.technique {
        Technique::None | Technique::Normal => Record { uv: ray.uv, depth: rise, hit: true, fetches: 0, iterations: 0 },
        Technique::Basic => one_sample(slope, 1.0 - rise),
        Technique::OffsetLimiting => one_sample(ray.uv_delta, 1.0 - rise),
        // Unity's shader has the middle of its range on the polygon, whatever the material says.
        Technique::UnityOffset => one_sample(ray.uv_delta.map(|s| s / (ray.cos + 0.42)), 0.5),
        Technique::Steep => steep(field, lid, options),
        Technique::Binary => bisect(field, lid, options),
        Technique::Relief => relief(field, lid, options),
        Technique::Occlusion => occlusion(field, lid, options),
        Technique::Contact => contact(field, lid, options),
        Technique::Cone | Technique::Exact => {
            let walk = Walk { uv: lid.uv, slope, bounds: options.bounds, entry };
            let (hit, cost) = if options.technique == Technique::Exact {
                first_hit(field, &walk, MAX_CELLS)
            } else {
                first_hit_by(field, &walk, |line, start, end| match field.cones(options.cones) {
                    Some(cones) => cone_crossing(field, &cones, line, start, end, options),
                    None => first_crossing(field, line, start, end, MAX_CELLS),
                })
            };
            match hit {
                Some(t) => Record { uv: lid.at(t), depth: t, hit: true, fetches: cost.fetches, iterations: cost.turns },
                None => Record::miss(ray, cost.fetches, cost.turns),
            }
        }
    };
    match options.bounds {
        Some(bounds) if !bounds.contains(record.uv) => Record::miss(ray, record.fetches, record.iterations),
        _ => record,
    }
}

/// A field with nothing above the floor outside of its bounds, as samples see it. Cells are those of the field.
struct Fenced<'a, F> {
    field: &'a F,
    bounds: Bounds,
}

impl<F: HeightField> HeightField for Fenced<'_, F> {
    fn size(&self) -> [u32; 2] {
        self.field.size()
    }

    fn corners(&self, i: i32, j: i32) -> [f32; 4] {
        self.field.corners(i, j)
    }

    fn sample(&self, uv: [f32; 2]) -> f32 {
        if self.bounds.contains(uv) { self.field.sample(uv) } else { 0.0 }
    }

    fn range(&self) -> [f32; 2] {
        self.field.range()
    }
}
