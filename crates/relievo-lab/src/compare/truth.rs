//! The truth of a comparison: displaced geometry, as fine as the maps everywhere.

use relievo_cpu::{DisplacedSurface, Renderer};
use relievo_scene::{Scene, SurfaceMesh, SurfaceTechnique, UvTransform};

/// Vertices along a texel of the picture.
pub(super) const PICTURE_PER_TEXEL: u32 = 2;

/// Vertices along a texel of the surface that judges hits: so many that it is as good as the surface itself.
pub(super) const HITS_PER_TEXEL: u32 = 16;

/// Vertices along a texel of nearest maps, on both: between two of them a wall leans.
const NEAREST_PER_TEXEL: u32 = 64;

/// The grid of one material's truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TruthGrid {
    /// Vertices per side of the uv range 0 to 1.
    pub(super) vertices: u32,
    /// Vertices along a texel, where they stand farthest apart.
    pub(super) per_texel: f64,
}

/// Returns the scene with its reliefs displaced: with this number of vertices per texel, traced without being kept, or with
/// `grid` vertices per side.
pub(super) fn displaced(scene: &Scene, per_texel: u32, grid: Option<u32>) -> Scene {
    let mut scene = scene.clone();
    for material in scene.materials.iter_mut().filter(|material| material.maps.height.is_some()) {
        material.relief.technique = SurfaceTechnique::Displacement;
        match grid {
            Some(grid) => (material.relief.grid, material.relief.vertices_per_texel) = (grid, None),
            None if material.is_nearest() => material.relief.vertices_per_texel = Some(NEAREST_PER_TEXEL),
            None => material.relief.vertices_per_texel = Some(per_texel),
        }
    }
    scene
}

/// Returns the grids of the truth, one per material with a height map.
pub(super) fn grids(scene: &Scene, renderer: &Renderer, forced: Option<u32>) -> Vec<TruthGrid> {
    let surfaces = renderer.displaced_surfaces();
    let reliefs =
        scene.materials.iter().enumerate().filter_map(|(i, material)| Some((i, material.maps.height.as_ref()?.grid())));
    reliefs
        .map(|(i, map)| {
            let size = [map.width(), map.height()];
            let densities =
                scene.objects.iter().enumerate().filter(|(_, object)| object.material == i).map(|(number, object)| {
                    match forced {
                        Some(grid) => {
                            let material = &scene.materials[i];
                            let mesh = SurfaceMesh::in_scene_space(object, material);
                            kept_density(&mesh, grid, &material.uv.after(object.uv_repeat), size)
                        }
                        None => traced_density(&surfaces, number),
                    }
                });
            let per_texel = densities.fold(f64::INFINITY, f64::min);
            let texels = scene.objects.iter().filter(|object| object.material == i).map(|object| {
                (f64::from(object.uv_repeat.x) * f64::from(size[0]))
                    .max(f64::from(object.uv_repeat.y) * f64::from(size[1]))
            });
            let cells = texels.fold(0.0, f64::max) * if per_texel.is_finite() { per_texel } else { 0.0 };
            TruthGrid { vertices: forced.unwrap_or((cells.round() + 1.0) as u32), per_texel }
        })
        .collect()
}

fn traced_density(surfaces: &[DisplacedSurface], object: usize) -> f64 {
    surfaces.iter().find(|surface| surface.object == object).map_or(f64::INFINITY, |surface| surface.vertices_per_texel)
}

/// Returns the vertices along a texel of a mesh that is cut for `grid` vertices per side.
fn kept_density(mesh: &SurfaceMesh, grid: u32, uvs: &UvTransform, size: [u32; 2]) -> f64 {
    let pieces = mesh.displaced_count(grid, uvs) as f64 / mesh.triangles.len().max(1) as f64;
    let longest = mesh.triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]).fold(0.0, |longest, (a, b)| {
        let side = (mesh.vertices[a as usize].uv - mesh.vertices[b as usize].uv).abs().as_dvec2();
        (side.x * f64::from(size[0])).max(side.y * f64::from(size[1])).max(longest)
    });
    if longest > 0.0 { pieces.sqrt() / longest } else { f64::INFINITY }
}

/// Returns a sentence for every material whose truth is coarser than its map.
pub(super) fn notes(scene: &Scene, grids: &[TruthGrid]) -> Vec<String> {
    let names = scene.materials.iter().filter(|material| material.maps.height.is_some()).map(|material| &material.name);
    let coarse = names.zip(grids).filter(|(_, grid)| grid.per_texel < 1.0 - 1e-6);
    coarse
        .map(|(name, grid)| {
            format!(
                "the truth's picture has {:.2} vertices per texel of \"{name}\", fewer than one: FLIP and PSNR judge by a surface \
                 that is coarser than its map",
                grid.per_texel
            )
        })
        .collect()
}
