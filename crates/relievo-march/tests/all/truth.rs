//! The exact march against the f64 oracle: materials × angles × depths × wrap modes, not one wrong hit.

use rayon::prelude::*;
use relievo_map::Wrap;
use relievo_march::{HeightField, MarchOptions, MaxPyramid, PyramidField, Ray, Record, march, march_all};
use relievo_testkit::{Tally, WRAPS, WithPyramid, corpus, many_rays, share};

/// Marches one ray after the other.
fn scalar(field: &(impl HeightField + Sync), rays: &[Ray]) -> Vec<Record> {
    rays.par_iter().map(|ray| march(field, ray, &MarchOptions::default())).collect()
}

/// Marches many rays at a time.
fn packets(field: &(impl HeightField + Sync), rays: &[Ray]) -> Vec<Record> {
    let mut records = vec![Record::default(); rays.len()];
    // Several groups of packets, the last one not full.
    let parts = records.par_chunks_mut(1000).zip(rays.par_chunks(1000));
    parts.for_each(|(records, rays)| march_all(field, rays, &MarchOptions::default(), records));
    records
}

fn no_ray_is_wrong(rays: u64) {
    let mut total = [Tally::default(); 2];
    let corpus = corpus();
    let share = share(rays, &corpus);
    for relief in &corpus {
        for wrap in WRAPS {
            let field = relief.field(wrap);
            let tallies = relief.march_and_judge(wrap, share, |rays| {
                let (scalar, packets) = (scalar(&field, rays), packets(&field, rays));
                // Beyond a stretched border clearances are computed from other points.
                if wrap != Wrap::Clamp {
                    let hit = |r: &Record| (r.uv, r.depth, r.hit);
                    let odd = (0..rays.len()).find(|&k| hit(&scalar[k]) != hit(&packets[k]));
                    let shown = odd.map(|k| (rays[k], scalar[k], packets[k]));
                    assert!(odd.is_none(), "{} {wrap:?}: {shown:?}", relief.name);
                }
                [scalar, packets]
            });
            println!("{:22} {wrap:?}: {tallies:?}", relief.name);
            total = [total[0] + tallies[0], total[1] + tallies[1]];
        }
    }
    println!("{total:?}");
    total[0].assert_right("ray by ray");
    total[1].assert_right("together");
}

#[test]
fn no_hit_is_wrong_from_straight_down_to_half_a_degree_in_reliefs_of_1_to_100_texels() {
    no_ray_is_wrong(60_000);
}

/// `cargo test --release -p relievo-march --test all truth -- --ignored --nocapture`; `RAYS` says how many.
#[test]
#[ignore = "takes minutes to hours"]
fn no_hit_is_wrong_among_many_rays() {
    no_ray_is_wrong(many_rays());
}

#[test]
fn a_pyramid_rounded_down_gives_wrong_hits() {
    let relief = corpus().swap_remove(1);
    let map = &relief.heights.levels()[0];
    let pyramid = MaxPyramid::build(&map.map(|h| (h - 1.0 / 255.0).max(0.0)), true);
    let field = relief.field(Wrap::Repeat);
    let low = WithPyramid(field, PyramidField::new(map, &pyramid, Wrap::Repeat));
    let [right, scalar_low, packets_low] = relief
        .march_and_judge(Wrap::Repeat, 5_000, |rays| [scalar(&field, rays), scalar(&low, rays), packets(&low, rays)]);
    right.assert_right("the pyramid as it is");
    assert!(scalar_low.wrong > 50 && packets_low.wrong > 50, "{scalar_low:?}, {packets_low:?}");
}
