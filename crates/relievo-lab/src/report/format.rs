//! Numbers as text.

/// Formats a number with three significant digits.
pub(super) fn short(x: f64) -> String {
    match x.abs() {
        a if !a.is_finite() => "–".to_owned(),
        0.0 => "0".to_owned(),
        a if a >= 100.0 => format!("{x:.0}"),
        a if a >= 10.0 => format!("{x:.1}"),
        a if a >= 1.0 => format!("{x:.2}"),
        a if a >= 0.001 => format!("{x:.3}"),
        _ => format!("{x:.0e}"),
    }
}

/// Formats a fraction in per cent.
pub(super) fn percent(x: f64) -> String {
    match x * 100.0 {
        0.0 => "0".to_owned(),
        p if p < 0.1 => "<0.1".to_owned(),
        p if p < 10.0 => format!("{p:.1}"),
        p => format!("{p:.0}"),
    }
}

/// Formats a PSNR in decibels; `None` where the pictures are equal.
pub(super) fn decibels(psnr: Option<f64>) -> String {
    psnr.map_or_else(|| "equal".to_owned(), |psnr| format!("{psnr:.1} dB"))
}
