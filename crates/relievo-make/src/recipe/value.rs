//! The output of a recipe's step: a number or a colour at every texel of a square map.

/// Values of a square map, row by row; one run of numbers, or three for red, green and blue (display values).
#[derive(Clone, Debug, PartialEq)]
pub(in crate::recipe) enum RecipeValue {
    Number(Vec<f32>),
    Color([Vec<f32>; 3]),
}

impl RecipeValue {
    /// Returns the numbers, or one of the colours' channels.
    pub(in crate::recipe) fn channel(&self, k: usize) -> &[f32] {
        match self {
            Self::Number(values) => values,
            Self::Color(channels) => &channels[k],
        }
    }
}
