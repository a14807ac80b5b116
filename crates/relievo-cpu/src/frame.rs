use rayon::prelude::*;
use relievo_map::Grid;
use relievo_scene::{Aovs, Frame};

/// A pixel of all pictures of a frame.
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

/// One row of all pictures of a frame, being drawn.
pub(crate) struct FrameRow<'a> {
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

impl FrameRow<'_> {
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

/// Returns all rows of a frame with their numbers, to be drawn in parallel.
pub(crate) fn par_rows(frame: &mut Frame) -> impl ParallelIterator<Item = (u32, FrameRow<'_>)> {
    let width = frame.pixels.width() as usize;
    let Aovs { depth, normal, uv, material, fetches, iterations, shadow, hit } = &mut frame.aovs;
    fn rows<T: Clone + Send>(grid: &mut Grid<T>, width: usize) -> rayon::slice::ChunksMut<'_, T> {
        grid.texels_mut().par_chunks_mut(width)
    }
    let pictures = (rows(&mut frame.pixels, width), rows(depth, width), rows(normal, width), rows(uv, width));
    let counts = (rows(material, width), rows(fetches, width), rows(iterations, width));
    let shares = (rows(shadow, width), rows(hit, width));
    (pictures.into_par_iter(), counts.into_par_iter(), shares.into_par_iter()).into_par_iter().enumerate().map(
        |(y, ((display, depth, normal, uv), (material, fetches, iterations), (shadow, hit)))| {
            (y as u32, FrameRow { display, depth, normal, uv, material, fetches, iterations, shadow, hit })
        },
    )
}
