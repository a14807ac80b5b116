//! Level of detail at a distance matches the supersampled truth better than any technique without it.

use relievo_march::Technique;

use crate::distant::{
    ImageError, Sampling, Subject, change, floor, frames, from_afar, image_error, subject, technique_frames, truth,
};

/// Image errors of `exact` with level of detail, of `exact` with trilinear filtering alone, and the best of any technique
/// without level of detail, each figure by itself.
fn image_errors(subject: &Subject, times: f32) -> [ImageError; 3] {
    let frames = frames(&from_afar(&subject.scene, times), 1);
    let truth = truth(&frames, subject.grid);
    let with = image_error(&truth, &technique_frames(&frames, Technique::Exact, Sampling::Lod));
    let trilinear = image_error(&truth, &technique_frames(&frames, Technique::Exact, Sampling::Trilinear));
    println!("exact, trilinear: FLIP {:.4}, {:.2} dB", trilinear.flip, trilinear.psnr);
    let mut best = ImageError { flip: f64::INFINITY, psnr: 0.0, ..with };
    for technique in Technique::ALL {
        for sampling in [Sampling::Linear, Sampling::Trilinear] {
            let error = image_error(&truth, &technique_frames(&frames, technique, sampling));
            best.flip = best.flip.min(error.flip);
            best.psnr = best.psnr.max(error.psnr);
        }
    }
    println!(
        "{} at {times}×: FLIP {:.4}, {:.2} dB, {:.1} fetches, {:.2}/255 from frame to frame; the best without: {:.4}, {:.2} dB",
        subject.name, with.flip, with.psnr, with.fetches, with.change, best.flip, best.psnr
    );
    [with, trilinear, best]
}

#[test]
fn the_wall_at_sixteen_times_its_distance_matches_its_truth_better_than_any_technique_without() {
    let [with, _, best] = image_errors(&subject("wall", "wall.toml", 256), 16.0);
    assert!(with.flip < best.flip && with.psnr > best.psnr);
}

#[test]
fn a_grazing_floor_is_nearer_to_its_truth_than_any_technique_without_in_squared_error() {
    let [with, trilinear, best] = image_errors(&floor(32), 1.0);
    // FLIP, which minds blur more than noise, is only compared with the same technique filtered by level.
    assert!(with.psnr > best.psnr && with.flip < trilinear.flip);
}

#[test]
fn a_camera_that_moves_by_less_than_a_pixel_makes_no_shimmer() {
    let frames = frames(&from_afar(&subject("wall", "wall.toml", 128).scene, 16.0), 6);
    let [linear, lod] = [Sampling::Linear, Sampling::Lod]
        .map(|sampling| change(&technique_frames(&frames, Technique::Exact, sampling).0));
    println!("from frame to frame {linear:.2}/255, with level of detail {lod:.2}/255");
    assert!(lod < 0.9 * linear, "{lod} for {linear}");
}
