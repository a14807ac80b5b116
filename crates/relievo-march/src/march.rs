use crate::cone::cone_crossing;
use crate::cost::MAX_CELLS;
use crate::exact::{CellWalk, enters_below, first_crossing, first_hit, walk_cells};
use crate::field::ClippedField;
use crate::layered::{bisect, contact, occlusion, relief, steep};
use crate::{Bounds, HeightField, MarchOptions, Ray, Record, Technique};

/// Marches `ray` to the relief.
///
/// Ends for every input: rays that are not finite, run along or away from the surface, or reach beyond 2³⁰ texels are
/// misses at no cost. `uv` and `depth` of a hit are finite, and depth is in [0, 1].
#[must_use]
pub fn march(field: &impl HeightField, ray: &Ray, options: &MarchOptions) -> Record {
    march_from(field, ray, options, 0.0)
}

/// Marches a ray that is known to stay above the surface down to the depth `entry` (see [`crate::tile_entry`]), or that
/// begins there: at an eye below the lid.
///
/// `cone` and `exact` begin there, and do not see what lies above; the other techniques begin at the lid.
#[must_use]
pub fn march_from(field: &impl HeightField, ray: &Ray, options: &MarchOptions, entry: f32) -> Record {
    if !ray.is_usable(field.size()) {
        return Record::miss(ray, 0, 0);
    }
    let lid_offset = options.lid_offset();
    let lid = options.on_lid(ray);
    // A relief that rises above its polygon may be entered beside it, where there is none.
    // (Walks over the cells know their bounds.)
    let is_beside = |bounds: &Bounds| lid_offset > 0.0 && !bounds.contains(lid.uv) && !options.technique.walks_cells();
    match options.bounds.filter(is_beside) {
        Some(bounds) => {
            let slope = options.search_slope(ray);
            if options.technique.samples_ray()
                && enters_below(field, &CellWalk { uv: lid.uv, slope, bounds: Some(bounds), entry: 0.0 })
            {
                return Record::miss(ray, 1, 1);
            }
            march_usable(&ClippedField { field, bounds }, ray, &lid, options, entry)
        }
        None => march_usable(field, ray, &lid, options, entry),
    }
}

/// The loads of an exact march, by kind; together they are its [`Record::fetches`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ExactLoads {
    /// Nodes of the max pyramid, 16 bytes each.
    pub nodes: u32,
    /// Cells: the four heights at the corners of one, at once.
    pub gathers: u32,
}

/// Marches `ray` by [`Technique::Exact`], whatever `options` says, and counts its loads: for measuring.
#[must_use]
pub fn exact_loads(field: &impl HeightField, ray: &Ray, options: &MarchOptions) -> ExactLoads {
    if !ray.is_usable(field.size()) {
        return ExactLoads::default();
    }
    let options = MarchOptions { technique: Technique::Exact, ..*options };
    let walk = CellWalk { uv: options.on_lid(ray).uv, slope: ray.slope(), bounds: options.bounds, entry: 0.0 };
    let (_, cost) = first_hit(field, &walk, |line, start, end| first_crossing(field, line, start, end, MAX_CELLS));
    ExactLoads { nodes: cost.fetches - cost.gathers, gathers: cost.gathers }
}

/// Marches a usable ray; `lid` is the same ray moved to the lid.
fn march_usable(field: &impl HeightField, ray: &Ray, lid: &Ray, options: &MarchOptions, entry: f32) -> Record {
    let lid_offset = options.lid_offset();
    let slope = ray.slope();
    // One sample, where the ray meets the polygon: `offset` is the uv travelled per unit of depth below the polygon.
    let one_sample = |offset: [f32; 2], reference: f32| {
        let height = field.sample(ray.uv);
        let uv = [0, 1].map(|k| ray.uv[k] + offset[k] * (reference - height));
        Record { uv, depth: 1.0 - height, hit: true, fetches: 1, iterations: 1 }
    };
    let record = match options.technique {
        Technique::None | Technique::Normal => {
            Record { uv: ray.uv, depth: lid_offset, hit: true, fetches: 0, iterations: 0 }
        }
        Technique::Basic => one_sample(slope, 1.0 - lid_offset),
        Technique::OffsetLimiting => one_sample(ray.uv_delta, 1.0 - lid_offset),
        // Unity's shader has the middle of its range on the polygon, whatever the material says.
        Technique::UnityOffset => one_sample(ray.uv_delta.map(|s| s / (ray.cos + 0.42)), 0.5),
        Technique::Steep => steep(field, lid, options),
        Technique::Binary => bisect(field, lid, options),
        Technique::Relief => relief(field, lid, options),
        Technique::Occlusion => occlusion(field, lid, options),
        Technique::Contact => contact(field, lid, options),
        Technique::Cone | Technique::Exact => {
            let walk = CellWalk { uv: lid.uv, slope, bounds: options.bounds, entry };
            let (hit, cost) = if options.technique == Technique::Exact {
                first_hit(field, &walk, |line, start, end| first_crossing(field, line, start, end, MAX_CELLS))
            } else {
                first_hit(field, &walk, |line, start, end| match field.cones(options.cones) {
                    Some(cones) => cone_crossing(field, &cones, line, start, end, options),
                    None => walk_cells(field, line, start, end, MAX_CELLS),
                })
            };
            match hit {
                Some(t) => {
                    Record { uv: lid.at(t), depth: t, hit: true, fetches: cost.fetches, iterations: cost.iterations }
                }
                None => Record::miss(ray, cost.fetches, cost.iterations),
            }
        }
    };
    match options.bounds {
        Some(bounds) if !bounds.contains(record.uv) => Record::miss(ray, record.fetches, record.iterations),
        _ => record,
    }
}
