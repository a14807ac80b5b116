//! Colour spaces of FLIP: linear light, the opponent axes that are blurred, and Hunt-adjusted CIELab that is compared.

type Matrix = [[f64; 3]; 3];

/// Conversions between linear sRGB and the spaces in which FLIP blurs and compares.
///
/// XYZ is divided by the white point throughout, so white is (1, 1, 1). The paper blurs YCxCz = (116 Y − 16, 500 (X − Y),
/// 200 (Y − Z)); as its blurs are linear and keep constants, those factors and the offset cancel and are left out.
pub(super) struct ColorSpace {
    to_xyz: [[f32; 3]; 3],
    to_rgb: [[f32; 3]; 3],
}

impl ColorSpace {
    pub(super) fn new() -> Self {
        let to_xyz = srgb_to_xyz_over_white();
        Self {
            to_xyz: to_xyz.map(|row| row.map(|x| x as f32)),
            to_rgb: inverse(&to_xyz).map(|row| row.map(|x| x as f32)),
        }
    }

    /// Linear sRGB to (Y, X − Y, Y − Z).
    #[inline]
    pub(super) fn opponent(&self, rgb: [f32; 3]) -> [f32; 3] {
        let [x, y, z] = apply(&self.to_xyz, rgb);
        [y, x - y, y - z]
    }

    /// (Y, X − Y, Y − Z) to Hunt-adjusted CIELab, with out-of-gamut colours clamped first.
    #[inline]
    pub(super) fn hunt_lab_of_opponent(&self, [y, x_y, y_z]: [f32; 3]) -> [f32; 3] {
        self.hunt_lab(apply(&self.to_rgb, [y + x_y, y, y - y_z]).map(|c| c.clamp(0.0, 1.0)))
    }

    /// Linear sRGB to CIELab whose a and b fade with darkness, as colourfulness does (the Hunt effect).
    #[inline]
    pub(super) fn hunt_lab(&self, rgb: [f32; 3]) -> [f32; 3] {
        let [x, y, z] = apply(&self.to_xyz, rgb).map(lab_curve);
        let lightness = 116.0 * y - 16.0;
        let fade = 0.01 * lightness;
        [lightness, fade * 500.0 * (x - y), fade * 200.0 * (y - z)]
    }
}

/// The HyAB distance: lightness by city block, colour by Euclid; fits large differences better than plain ΔE.
#[inline]
pub(super) fn hyab(p: [f32; 3], q: [f32; 3]) -> f32 {
    let (da, db) = (p[1] - q[1], p[2] - q[2]);
    (p[0] - q[0]).abs() + (da * da + db * db).sqrt()
}

#[inline]
fn lab_curve(t: f32) -> f32 {
    const BEND: f32 = 6.0 / 29.0;
    if t > BEND * BEND * BEND { t.cbrt() } else { t / (3.0 * BEND * BEND) + 4.0 / 29.0 }
}

#[inline]
fn apply(m: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// The matrix from linear sRGB to XYZ divided by white, from the chromaticities that define sRGB (BT.709 primaries, D65).
fn srgb_to_xyz_over_white() -> Matrix {
    let xyz = |x: f64, y: f64| [x / y, 1.0, (1.0 - x - y) / y];
    let (r, g, b) = (xyz(0.64, 0.33), xyz(0.30, 0.60), xyz(0.15, 0.06));
    let white = xyz(0.3127, 0.3290);
    let primaries: Matrix = std::array::from_fn(|i| [r[i], g[i], b[i]]);
    let strength = inverse(&primaries).map(|row| row[0] * white[0] + row[1] * white[1] + row[2] * white[2]);
    std::array::from_fn(|i| std::array::from_fn(|j| primaries[i][j] * strength[j] / white[i]))
}

fn inverse(m: &Matrix) -> Matrix {
    let cofactor = |i: usize, j: usize| {
        let (i1, i2, j1, j2) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| cofactor(j, i) / determinant))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn luminance_weights_are_those_of_bt_709_and_white_is_one() {
        let m = srgb_to_xyz_over_white();
        for (got, want) in m[1].iter().zip([0.2126, 0.7152, 0.0722]) {
            assert!((got - want).abs() < 1e-4, "{got} {want}");
        }
        for row in m {
            assert!((row.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn going_through_the_opponent_axes_changes_no_displayable_colour() {
        let colors = ColorSpace::new();
        for rgb in [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.9, 0.1, 0.2], [0.02, 0.5, 0.7]] {
            let (direct, around) = (colors.hunt_lab(rgb), colors.hunt_lab_of_opponent(colors.opponent(rgb)));
            assert!(hyab(direct, around) < 1e-2, "{direct:?} {around:?}");
        }
    }

    #[test]
    fn lightness_runs_from_0_to_100_and_greys_have_no_colour() {
        let colors = ColorSpace::new();
        for (light, lightness) in [(0.0, 0.0), (0.184_186_52, 50.0), (1.0, 100.0)] {
            let [l, a, b] = colors.hunt_lab([light; 3]);
            assert!((l - lightness).abs() < 1e-3 && a.abs() < 1e-3 && b.abs() < 1e-3, "{l} {a} {b}");
        }
    }
}
