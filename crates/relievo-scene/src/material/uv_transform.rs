use glam::{Mat2, Vec2};

use crate::angle::sin_cos_degrees;

/// A map of texture coordinates: uv = offset + rotation · scale · uv, as KHR_texture_transform of glTF has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvTransform {
    /// Move in texture repeats, applied last.
    pub offset: Vec2,
    /// Turn in degrees, counter-clockwise on the picture, where v runs down; the picture on the surface turns clockwise.
    pub rotate: f32,
    /// Scale, applied first; not 0. Negative numbers mirror.
    pub scale: Vec2,
}

impl Default for UvTransform {
    fn default() -> Self {
        Self { offset: Vec2::ZERO, rotate: 0.0, scale: Vec2::ONE }
    }
}

impl UvTransform {
    /// Returns the map of coordinates that are scaled by `repeat` first.
    #[must_use]
    pub fn after(&self, repeat: Vec2) -> Self {
        Self { scale: self.scale * repeat, ..*self }
    }

    /// Returns the image of texture coordinates.
    #[must_use]
    pub fn apply(&self, uv: Vec2) -> Vec2 {
        self.offset + self.rotation() * (self.scale * uv)
    }

    /// Returns the coordinates' difference whose image is `step`.
    #[must_use]
    pub fn undo(&self, step: Vec2) -> Vec2 {
        self.rotation().transpose() * step / self.scale
    }

    /// Returns true if directions stay what they are: nothing is turned or mirrored.
    #[must_use]
    pub fn keeps_directions(&self) -> bool {
        self.rotation() == Mat2::IDENTITY && self.scale.min_element() > 0.0
    }

    /// Returns the turn alone.
    #[must_use]
    pub fn rotation(&self) -> Mat2 {
        let (sin, cos) = sin_cos_degrees(self.rotate);
        Mat2::from_cols(Vec2::new(cos, -sin), Vec2::new(sin, cos))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extensions_own_example_takes_the_lower_left_quarter_turned_clockwise() {
        let transform = UvTransform { offset: Vec2::new(0.0, 1.0), rotate: 90.0, scale: Vec2::splat(0.5) };
        // The picture's upper left corner shows the quarter's lower left, its upper right what was above that.
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let images = corners.map(|uv| transform.apply(uv.into()).to_array());
        assert_eq!(images, [[0.0, 1.0], [0.0, 0.5], [0.5, 0.5], [0.5, 1.0]]);
    }

    #[test]
    fn what_was_done_is_undone() {
        let transform = UvTransform { offset: Vec2::new(3.0, -2.0), rotate: 33.0, scale: Vec2::new(-2.0, 0.25) };
        let (a, b) = (Vec2::new(0.3, 0.8), Vec2::new(-1.2, 0.1));
        let back = transform.undo(transform.apply(b) - transform.apply(a));
        assert!((back - (b - a)).abs().max_element() < 1e-5, "{back}");
        let repeated = transform.after(Vec2::new(3.0, 7.0));
        assert_eq!(repeated.apply(a), transform.apply(a * Vec2::new(3.0, 7.0)));
        assert!(UvTransform::default().keeps_directions() && !transform.keeps_directions());
        let half = UvTransform { rotate: 180.0, ..UvTransform::default() };
        assert!(!half.keeps_directions() && UvTransform { rotate: -360.0, ..half }.keeps_directions());
    }
}
