//! Far away, level of detail matches the supersampled truth better than any technique without it.

// A test reports its figures.
#![allow(clippy::print_stdout)]

mod distant;

use distant::{Sampling, Verdict, contender, floor, frames, from_afar, judge, subject, truth};
use relievo_march::Technique;

/// The verdict of `exact` with level of detail, and the best of any technique without, each figure by itself.
fn verdicts(subject: &distant::Subject, times: f32) -> (Verdict, Verdict) {
    let frames = frames(&from_afar(&subject.scene, times), 2);
    let truth = truth(&frames, subject.grid);
    let with = judge(&truth, &contender(&frames, Technique::Exact, Sampling::Lod));
    let mut best = Verdict { flip: f64::INFINITY, psnr: 0.0, change: f64::INFINITY, fetches: f64::INFINITY };
    for technique in Technique::ALL {
        for sampling in [Sampling::Linear, Sampling::Trilinear] {
            let verdict = judge(&truth, &contender(&frames, technique, sampling));
            best.flip = best.flip.min(verdict.flip);
            best.psnr = best.psnr.max(verdict.psnr);
            best.change = best.change.min(verdict.change);
        }
    }
    println!("{} at {times}×: {with:.4?}; the best without {best:.4?}", subject.name);
    (with, best)
}

#[test]
fn the_wall_at_sixteen_times_its_distance_matches_its_truth_better_than_any_technique_without() {
    let (with, best) = verdicts(&subject("wall", "wall.toml", 256), 16.0);
    assert!(with.flip < best.flip && with.psnr > best.psnr, "{with:?} {best:?}");
}

#[test]
fn a_grazing_floor_matches_its_truth_better_than_any_technique_without() {
    let (with, best) = verdicts(&floor(64), 1.0);
    assert!(with.flip < best.flip && with.psnr > best.psnr, "{with:?} {best:?}");
}
