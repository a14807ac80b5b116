use rayon::prelude::*;
use relievo_map::Grid;

/// A picture with everything that was learnt on the way.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Display RGB, as it goes into a PNG.
    pub pixels: Grid<[u8; 3]>,
    /// One value per pixel of everything else.
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
    /// Index of the material that is seen; `None` where nothing is hit.
    pub material: Grid<Option<u32>>,
    /// Height look-ups of the view ray's marches.
    pub fetches: Grid<f32>,
    /// Loop turns of the view ray's marches.
    pub iterations: Grid<f32>,
    /// Mean shadow factor over the lights: 1 = unshadowed (also where nothing is hit).
    pub shadow: Grid<f32>,
    /// 1 = a surface, 0 = background.
    pub hit: Grid<f32>,
}

/// A pixel before it is split into pictures.
pub(crate) struct Pixel {
    pub(crate) display: [u8; 3],
    pub(crate) depth: f32,
    pub(crate) normal: [f32; 3],
    pub(crate) uv: [f32; 2],
    pub(crate) material: Option<u32>,
    pub(crate) fetches: f32,
    pub(crate) iterations: f32,
    pub(crate) shadow: f32,
    pub(crate) hit: f32,
}

/// One row of a frame, being drawn.
pub(crate) struct Row<'a> {
    display: &'a mut [[u8; 3]],
    depth: &'a mut [f32],
    normal: &'a mut [[f32; 3]],
    uv: &'a mut [[f32; 2]],
    material: &'a mut [Option<u32>],
    fetches: &'a mut [f32],
    iterations: &'a mut [f32],
    shadow: &'a mut [f32],
    hit: &'a mut [f32],
}

impl Row<'_> {
    pub(crate) fn set(&mut self, x: usize, pixel: &Pixel) {
        self.display[x] = pixel.display;
        self.depth[x] = pixel.depth;
        self.normal[x] = pixel.normal;
        self.uv[x] = pixel.uv;
        self.material[x] = pixel.material;
        self.fetches[x] = pixel.fetches;
        self.iterations[x] = pixel.iterations;
        self.shadow[x] = pixel.shadow;
        self.hit[x] = pixel.hit;
    }
}

impl Frame {
    /// A frame before anything is drawn.
    pub(crate) fn blank(width: u32, height: u32) -> Self {
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

    /// All rows with their numbers, to be drawn side by side.
    pub(crate) fn par_rows_mut(&mut self) -> impl ParallelIterator<Item = (u32, Row<'_>)> {
        let width = self.pixels.width() as usize;
        let Aovs { depth, normal, uv, material, fetches, iterations, shadow, hit } = &mut self.aovs;
        fn rows<T: Send>(grid: &mut Grid<T>, width: usize) -> rayon::slice::ChunksMut<'_, T> {
            grid.texels_mut().par_chunks_mut(width)
        }
        let pictures = (rows(&mut self.pixels, width), rows(depth, width), rows(normal, width), rows(uv, width));
        let counts = (rows(material, width), rows(fetches, width), rows(iterations, width));
        let shares = (rows(shadow, width), rows(hit, width));
        (pictures.into_par_iter(), counts.into_par_iter(), shares.into_par_iter()).into_par_iter().enumerate().map(
            |(y, ((display, depth, normal, uv), (material, fetches, iterations), (shadow, hit)))| {
                (y as u32, Row { display, depth, normal, uv, material, fetches, iterations, shadow, hit })
            },
        )
    }
}
