use relievo_make::paint::{Stroke, paint};

/// Heights stay numbers under these strokes, on a map that tiles and on one that ends.
pub fn painted(strokes: &[Stroke]) {
    let points: usize = strokes.iter().map(|stroke| stroke.points.len()).sum();
    assert!(!strokes.is_empty() && points <= Stroke::MAX_POINTS);
    // Longer drawings take their time.
    if points > 256 {
        return;
    }
    for wrap in [false, true] {
        let map = paint(&relievo_map::Grid::filled(16, 12, 0.5), strokes, wrap, 1);
        assert!(map.texels().iter().all(|h| h.is_finite()));
    }
}
