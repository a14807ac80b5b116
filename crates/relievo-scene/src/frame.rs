use relievo_map::Grid;

/// A picture with its arbitrary output variables.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Display RGB, as it goes into a PNG.
    pub pixels: Grid<[u8; 3]>,
    /// Arbitrary output variables.
    pub aovs: Aovs,
}

/// Arbitrary output variables. With several samples per pixel, `fetches`, `iterations`, `shadow` and `hit` are means over
/// the samples; `depth`, `normal`, `uv` and `material` are those of the sample at the pixel's centre.
#[derive(Clone, Debug, PartialEq)]
pub struct Aovs {
    /// Distance along the camera's axis in scene units; infinite where nothing is hit.
    pub depth: Grid<f32>,
    /// Shading normal in scene space, unit length; 0 where nothing is hit.
    pub normal: Grid<[f32; 3]>,
    /// Displaced texture coordinates, in texture repeats; 0 where nothing is hit.
    pub uv: Grid<[f32; 2]>,
    /// Index of the visible material; `None` where nothing is hit.
    pub material: Grid<Option<u32>>,
    /// Height fetches of the view ray's marches.
    pub fetches: Grid<f32>,
    /// Loop iterations of the view ray's marches.
    pub iterations: Grid<f32>,
    /// Mean shadow factor over the lights: 1 = unshadowed (also where nothing is hit).
    pub shadow: Grid<f32>,
    /// 1 = a surface, 0 = background.
    pub hit: Grid<f32>,
}

impl Frame {
    /// Returns a frame before anything is drawn.
    #[must_use]
    pub fn blank(width: u32, height: u32) -> Self {
        Self {
            pixels: Grid::filled(width, height, [0; 3]),
            aovs: Aovs {
                depth: Grid::filled(width, height, 0.0),
                normal: Grid::filled(width, height, [0.0; 3]),
                uv: Grid::filled(width, height, [0.0; 2]),
                material: Grid::filled(width, height, None),
                fetches: Grid::filled(width, height, 0.0),
                iterations: Grid::filled(width, height, 0.0),
                shadow: Grid::filled(width, height, 0.0),
                hit: Grid::filled(width, height, 0.0),
            },
        }
    }
}
