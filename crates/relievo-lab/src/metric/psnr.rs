use relievo_map::Grid;

use super::size_mismatch::SizeMismatch;

/// Difference of two 8-bit pictures, channel by channel, without a model of perception.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelDifference {
    /// Mean absolute difference over all pixels and channels, in 8-bit steps: 0 to 255.
    pub mean: f64,
    /// Fraction of pixels that differ by more than the threshold in at least one channel: 0 to 1.
    pub over: f64,
    /// The largest difference in any channel of any pixel.
    pub max: u8,
    /// Peak signal-to-noise ratio over all pixels and channels, in decibels; infinite for equal pictures.
    pub psnr: f64,
}

/// Compares two pictures channel by channel.
///
/// A pixel counts as [`over`](PixelDifference::over) when one of its channels differs by *more* than `threshold`, so a
/// threshold of 0 counts every pixel that is not exactly equal. The order of the pictures does not matter.
///
/// # Errors
/// If the pictures differ in size.
pub fn pixel_difference(a: &Grid<[u8; 3]>, b: &Grid<[u8; 3]>, threshold: u8) -> Result<PixelDifference, SizeMismatch> {
    SizeMismatch::check(a, b)?;
    // Whole numbers: the largest grid, 2^32 pixels of 3 × 255², still fits, and no order of summing can change them.
    let (mut sum, mut squares, mut over, mut max) = (0u64, 0u64, 0u64, 0u8);
    for (a, b) in a.texels().iter().zip(b.texels()) {
        let mut worst = 0;
        for (&a, &b) in a.iter().zip(b) {
            let d = a.abs_diff(b);
            worst = worst.max(d);
            sum += u64::from(d);
            squares += u64::from(d) * u64::from(d);
        }
        over += u64::from(worst > threshold);
        max = max.max(worst);
    }
    let pixels = a.texels().len() as f64;
    let numbers = 3.0 * pixels;
    let mean_square = squares as f64 / numbers;
    Ok(PixelDifference {
        mean: sum as f64 / numbers,
        over: over as f64 / pixels,
        max,
        psnr: if squares == 0 { f64::INFINITY } else { 10.0 * (255.0 * 255.0 / mean_square).log10() },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(width: u32, height: u32, value: u8) -> Grid<[u8; 3]> {
        Grid::from_fn(width, height, |_, _| [value; 3])
    }

    #[test]
    fn equal_pictures_are_infinitely_alike() {
        let picture = Grid::from_fn(7, 5, |x, y| [x as u8 * 30, y as u8 * 40, 9]);
        let d = pixel_difference(&picture, &picture, 0).unwrap();
        assert_eq!(d, PixelDifference { mean: 0.0, over: 0.0, max: 0, psnr: f64::INFINITY });
    }

    #[test]
    fn black_against_white_is_0_db_and_one_step_everywhere_is_48_13_db() {
        let d = pixel_difference(&grey(4, 3, 0), &grey(4, 3, 255), 254).unwrap();
        assert_eq!(d, PixelDifference { mean: 255.0, over: 1.0, max: 255, psnr: 0.0 });
        let d = pixel_difference(&grey(4, 3, 100), &grey(4, 3, 101), 0).unwrap();
        assert!((d.psnr - 48.130_803_6).abs() < 1e-6, "{}", d.psnr);
    }

    #[test]
    fn one_channel_of_one_pixel_counts_once_and_is_averaged_over_all_channels() {
        let a = grey(5, 2, 40);
        let mut b = a.clone();
        b.texels_mut()[3] = [40, 52, 40];
        let d = pixel_difference(&a, &b, 11).unwrap();
        assert_eq!((d.over, d.max), (0.1, 12));
        assert!((d.mean - 12.0 / 30.0).abs() < 1e-12);
        assert!((d.psnr - 10.0 * (255.0f64 * 255.0 / (144.0 / 30.0)).log10()).abs() < 1e-12);
    }

    #[test]
    fn a_difference_equal_to_the_threshold_is_not_over_it() {
        let (a, b) = (grey(2, 2, 10), grey(2, 2, 15));
        assert_eq!(pixel_difference(&a, &b, 5).unwrap().over, 0.0);
        assert_eq!(pixel_difference(&a, &b, 4).unwrap().over, 1.0);
    }

    #[test]
    fn the_order_of_the_pictures_does_not_matter() {
        let a = Grid::from_fn(9, 4, |x, y| [(x * 27) as u8, (y * 60) as u8, (x * y) as u8]);
        let b = Grid::from_fn(9, 4, |x, y| [(y * 31) as u8, (x * 20) as u8, 77]);
        assert_eq!(pixel_difference(&a, &b, 3), pixel_difference(&b, &a, 3));
    }

    #[test]
    fn pictures_of_different_sizes_are_refused_and_both_sizes_are_named() {
        let error = pixel_difference(&grey(2, 6, 0), &grey(4, 3, 0), 0).unwrap_err();
        assert_eq!(error, SizeMismatch { a: (2, 6), b: (4, 3) });
        let text = error.to_string();
        assert!(text.contains("2×6") && text.contains("4×3"), "{text}");
    }
}
