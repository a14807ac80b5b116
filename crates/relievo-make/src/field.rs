//! What a recipe's step makes: a number or a colour at every texel of a square.

/// Values of a square map, row by row; one run of numbers, or three for red, green and blue (display values).
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Field {
    Number(Vec<f32>),
    Color([Vec<f32>; 3]),
}

impl Field {
    /// The numbers, or one of the colours' channels.
    pub(crate) fn channel(&self, k: usize) -> &[f32] {
        match self {
            Self::Number(values) => values,
            Self::Color(channels) => &channels[k],
        }
    }
}
