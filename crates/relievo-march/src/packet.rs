//! The exact march of many neighbouring rays at once, with the hits of the scalar march.
//!
//! Sixteen rays are a packet. Sixteen packets look ahead, each as one beam in a lane of its own ([`beam`]). From the depth at
//! which its beam stops being free, each ray searches in a lane ([`search`]), from cell to cell and, where that takes long, by
//! windows of 8×8 cells, for the first cell that it does not pass clearly above; the cells it steps over are free whatever
//! rounding does, so the search need not know the borders exactly. The cell is then entered by the border by which the plain
//! walk enters it ([`axis`]), and its patch is solved as the plain walk solves it. Rays that meet nothing there search on; when
//! only few of a packet are left they are compacted into new packets.

mod axis;
mod beam;
mod context;
mod lanes;
mod marcher;
mod pending;
mod ray_packet;
mod search;
mod walk;

use context::PacketContext;
use fearless_simd::{Level, dispatch};
use marcher::MIN_SIZE;
use pending::ScalarRay;

use crate::pyramid::PyramidField;
use crate::{HeightField, MarchOptions, Ray, Record, Technique, march};

/// Marches many rays: the same hits as [`march`] to the last bit, in less time.
///
/// [`Technique::Exact`] on a field with a pyramid marches sixteen rays at a time with the processor's vector instructions (SSE,
/// AVX2, AVX-512, NEON, WASM SIMD). Every 16 rays in a row look ahead together, so neighbours should follow each other: tiles
/// of 4×4 pixels, and these in tiles (Morton order). Everything else is marched ray by ray. `fetches` and `iterations` are the
/// ray's own here, without the lookups for a whole packet. A ray that [`march`] cuts off may go on here.
///
/// # Panics
/// If `records` has not the length of `rays`.
pub fn march_all(field: &impl HeightField, rays: &[Ray], options: &MarchOptions, records: &mut [Record]) {
    assert_eq!(rays.len(), records.len(), "there is a record for each ray");
    match field.pyramid() {
        Some(map) if options.technique == Technique::Exact && map.pyramid.size().iter().all(|&n| n >= MIN_SIZE) => {
            let mut scalar_rays = Vec::new();
            march_packets(map, field.range(), rays, options, records, &mut scalar_rays);
            for ScalarRay { index, cost } in scalar_rays {
                let record = march(field, &rays[index], options);
                let (fetches, iterations) = (record.fetches + cost, record.iterations + cost);
                records[index] = Record { fetches, iterations, ..record };
            }
        }
        _ => {
            for (record, ray) in records.iter_mut().zip(rays) {
                *record = march(field, ray, options);
            }
        }
    }
}

/// Marches rays in packets. Not generic, so that it is compiled once for every kind of processor and no more. `range` is that
/// of the field.
fn march_packets(
    map: PyramidField<'_>,
    range: [f32; 2],
    rays: &[Ray],
    options: &MarchOptions,
    records: &mut [Record],
    scalar_rays: &mut Vec<ScalarRay>,
) {
    dispatch!(Level::new(), simd => PacketContext::new(simd, map, range, options).march_groups(rays, records, scalar_rays));
}
