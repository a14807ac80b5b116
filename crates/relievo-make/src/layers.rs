use rayon::prelude::*;
use relievo_map::{Grid, GridError, HeightMap, Wrap};

/// Height maps that move over each other and blend into one: the classic cheap clouds.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightLayers {
    /// At least one.
    pub layers: Vec<HeightLayer>,
    /// Blending of the layers.
    pub blend: LayerBlend,
    /// Texels of the blended map along u and v.
    pub size: [u32; 2],
}

/// A height map that repeats and moves.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightLayer {
    /// The heights, in 0..1.
    pub map: HeightMap,
    /// Repeats of the map within one repeat of the blended map, along u and v.
    pub repeat: [u32; 2],
    /// Movement of the picture in repeats of the blended map per second, along u and v.
    pub velocity: [f64; 2],
    /// Weight of the layer, 0 or more: a factor on its heights but for [`LayerBlend::Mean`], where it is its share.
    pub weight: f32,
}

/// Blending of the heights of layers, clamped to 0..1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum LayerBlend {
    /// Mean by weight.
    #[default]
    Mean,
    /// Sum.
    Add,
    /// Product.
    Multiply,
    /// The highest.
    Max,
    /// The lowest.
    Min,
}

impl LayerBlend {
    /// All kinds with their names in scene files.
    pub const ALL: [(&'static str, Self); 5] = [
        ("mean", Self::Mean),
        ("add", Self::Add),
        ("multiply", Self::Multiply),
        ("max", Self::Max),
        ("min", Self::Min),
    ];

    fn first(self) -> f32 {
        match self {
            Self::Mean | Self::Add | Self::Max => 0.0,
            Self::Multiply | Self::Min => 1.0,
        }
    }

    fn with(self, sum: f32, height: f32) -> f32 {
        match self {
            Self::Mean | Self::Add => sum + height,
            Self::Multiply => sum * height,
            Self::Max => sum.max(height),
            Self::Min => sum.min(height),
        }
    }
}

impl HeightLayers {
    /// The most layers.
    pub const MAX_LAYERS: usize = 16;

    /// Returns the place of each layer's map at a time: the texture coordinates at the corner of the blended map, in repeats of
    /// the layer's map, each 0 to below 1.
    #[must_use]
    pub fn offsets(&self, seconds: f64) -> Vec<[f32; 2]> {
        let offset = |layer: &HeightLayer| {
            std::array::from_fn(|k| {
                let moved = -layer.velocity[k] * seconds * f64::from(layer.repeat[k]);
                let rest = (moved - moved.floor()) as f32;
                if rest < 1.0 { rest } else { 0.0 }
            })
        };
        self.layers.iter().map(offset).collect()
    }

    /// Returns the factor of each layer's heights: its weight, for [`LayerBlend::Mean`] its share.
    #[must_use]
    pub fn factors(&self) -> Vec<f32> {
        let all = if self.blend == LayerBlend::Mean { self.layers.iter().map(|layer| layer.weight).sum() } else { 1.0 };
        self.layers.iter().map(|layer| if all > 0.0 { layer.weight / all } else { 0.0 }).collect()
    }

    /// Blends the layers as they are at a time. The same time gives the same bits.
    ///
    /// # Errors
    /// If a side of the blended map is 0 or too long.
    pub fn heights(&self, seconds: f64) -> Result<HeightMap, GridError> {
        let [width, height] = self.size;
        if width == 0 || height == 0 || width.max(height) > Grid::<f32>::MAX_SIDE {
            return Err(GridError::Size { width, height });
        }
        let moved: Vec<_> = self.layers.iter().zip(self.offsets(seconds)).zip(self.factors()).collect();
        let mut texels = vec![0.0; width as usize * height as usize];
        texels.par_chunks_mut(width as usize).enumerate().for_each(|(y, row)| {
            for (x, out) in row.iter_mut().enumerate() {
                let uv = [(x as f32 + 0.5) / width as f32, (y as f32 + 0.5) / height as f32];
                let sum = moved.iter().fold(self.blend.first(), |sum, ((layer, offset), factor)| {
                    let at: [f32; 2] = std::array::from_fn(|k| uv[k] * layer.repeat[k] as f32 + offset[k]);
                    self.blend.with(sum, layer.map.grid().sample(at, Wrap::Repeat) * factor)
                });
                *out = sum.max(0.0).min(1.0);
            }
        });
        Ok(HeightMap::new(Grid::new(width, height, texels)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layers(blend: LayerBlend, velocity: [f64; 2]) -> HeightLayers {
        let map = HeightMap::new(Grid::from_fn(8, 4, |x, y| ((x * 5 + y * 3) % 7) as f32 / 6.0));
        let still = HeightLayer { map: map.clone(), repeat: [1, 2], velocity: [0.0; 2], weight: 1.0 };
        let moving = HeightLayer { map, repeat: [1; 2], velocity, weight: 3.0 };
        HeightLayers { layers: vec![still, moving], blend, size: [8, 8] }
    }

    #[test]
    fn a_layer_moves_by_whole_texels_as_its_texels_do() {
        let mut layers = layers(LayerBlend::Mean, [0.125, -0.25]);
        layers.layers.remove(0);
        layers.size = [8, 4];
        let (before, after) = (layers.heights(0.0).unwrap(), layers.heights(3.0).unwrap());
        for (x, y) in [(0, 0), (3, 2), (7, 3)] {
            let moved = *after.grid().get((x + 3) % 8, (y + 4 - 3) % 4);
            assert!((before.grid().get(x, y) - moved).abs() < 1e-6, "{x} {y}");
        }
    }

    #[test]
    fn blends_are_as_named_and_close_after_whole_repeats() {
        for (name, blend) in LayerBlend::ALL {
            let layers = layers(blend, [0.25, -0.5]);
            let at = |seconds| layers.heights(seconds).unwrap();
            assert_eq!(at(0.0), at(4.0), "{name}");
            assert!(at(0.0) != at(1.0), "{name}");
            let [a, b] = [0, 1].map(|k: usize| {
                let only = HeightLayers { layers: vec![layers.layers[k].clone()], ..layers.clone() };
                let only = HeightLayers { blend: LayerBlend::Mean, ..only };
                only.heights(1.0).unwrap()
            });
            let [a, b] = [*a.grid().get(2, 5), *b.grid().get(2, 5)];
            let expected = match blend {
                LayerBlend::Mean => (a + 3.0 * b) / 4.0,
                LayerBlend::Add => a + 3.0 * b,
                LayerBlend::Multiply => a * 3.0 * b,
                LayerBlend::Max => a.max(3.0 * b),
                LayerBlend::Min => a.min(3.0 * b),
            };
            assert!((at(1.0).grid().get(2, 5) - expected.min(1.0)).abs() < 1e-6, "{name}");
        }
        assert!(HeightLayers { size: [0, 1], ..layers(LayerBlend::Add, [0.0; 2]) }.heights(0.0).is_err());
    }
}
