use glam::Vec3;
use relievo_march::{Bounds, Prism};
use relievo_scene::{MarchSpace, MistVolume, Scene, SurfaceMesh, Vertex};

use super::bvh::{self, TriangleBvh};
use super::displaced::{HeightRanges, MicroHit, MicroRay, MicroSurface, RangedMap, Sides};
use super::instance::Instance;
use super::world_builder::WorldBuilder;
use crate::RenderError;
use crate::shading::material::MaterialShading;

/// The scene made ready for tracing: its triangles in three trees, its materials.
pub(crate) struct World {
    pub(crate) materials: Vec<MaterialShading>,
    pub(crate) instances: Vec<Instance>,
    pub(crate) surface_mesh: SurfaceMesh,
    /// The instance that each triangle belongs to.
    pub(crate) owner: Vec<u32>,
    /// Number of triangles, without the backs of reliefs.
    pub(crate) triangles: usize,
    /// The triangles that are the surface, or have it below them: no part of the surface lies before the polygon.
    pub(crate) bvh: TriangleBvh,
    /// The triangles whose relief rises above them. The surface may be far from where a ray meets the polygon, so that no
    /// distance rules one out.
    pub(crate) raised_bvh: TriangleBvh,
    /// The triangles whose relief is marched in a shell, by the boxes around their shells.
    pub(crate) shell_bvh: TriangleBvh,
    /// Shells of the triangles of each instance that is marched in them.
    shells: Vec<Vec<Prism>>,
    /// The triangles whose displaced surface is traced without being kept.
    pub(crate) micro_bvh: TriangleBvh,
    /// Ranges of the height maps of those, by material.
    ranges: Vec<Option<HeightRanges>>,
    /// The spaces that mist fills.
    pub(crate) mists: Vec<MistVolume>,
}

/// The trees of the world.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Tree {
    Surface,
    Raised,
    Shell,
}

impl World {
    /// Makes a scene ready. `known` are the materials of one that may have the same maps.
    pub(crate) fn new(scene: &Scene, known: &[MaterialShading]) -> Result<Self, RenderError> {
        let mut build = WorldBuilder::new(scene, known);
        let is_surface = |index: &usize| !scene.materials[scene.objects[*index].material].is_mist();
        for index in (0..scene.objects.len()).filter(is_surface) {
            build.add(index)?;
        }
        let WorldBuilder { materials, instances, surface_mesh, owner, triangles, .. } = build;
        let empty = || TriangleBvh::build(&[], &[]);
        let mut this = Self {
            ranges: micro_ranges(&materials, &instances),
            materials,
            instances,
            surface_mesh,
            owner,
            triangles,
            bvh: empty(),
            raised_bvh: empty(),
            shell_bvh: empty(),
            shells: Vec::new(),
            micro_bvh: empty(),
            // Scenes that are wrong were refused before.
            mists: scene.mist_volumes().unwrap_or_default(),
        };
        this.shells = this.make_shells();
        let [bvh, raised, shell] = [Tree::Surface, Tree::Raised, Tree::Shell].map(|tree| this.tree(tree));
        (this.bvh, this.raised_bvh, this.shell_bvh) = (bvh, raised, shell);
        this.micro_bvh = this.build_micro_bvh();
        Ok(this)
    }

    fn build_micro_bvh(&self) -> TriangleBvh {
        let (bounds, triangles): (Vec<bvh::Bounds>, Vec<u32>) = (0..self.owner.len() as u32)
            .filter_map(|triangle| {
                let (micro, heights) = self.micro_surface(triangle)?;
                let [min, max] = micro.bounds(&self.surface_mesh, triangle, heights);
                Some((bvh::Bounds::between(min, max), triangle))
            })
            .unzip();
        TriangleBvh::build(&bounds, &triangles)
    }

    /// Returns the displaced surface that is traced over a triangle, and its height map.
    fn micro_surface(&self, triangle: u32) -> Option<(&MicroSurface, RangedMap<'_>)> {
        let instance = &self.instances[self.owner[triangle as usize] as usize];
        let micro = instance.micro.as_ref()?;
        let ranges = self.ranges[instance.material].as_ref()?;
        let map = self.materials[instance.material].heights.as_ref()?.levels().first()?;
        Some((micro, RangedMap { map, ranges }))
    }

    /// Returns the point where a ray first meets the displaced surface over a triangle of [`World::micro_bvh`], nearer than
    /// `limit`; `raise` moves the surface along its normals, in texels.
    pub(crate) fn micro_hit(
        &self,
        triangle: u32,
        ray: &MicroRay,
        raise: f64,
        limit: f32,
        sides: Sides,
    ) -> Option<MicroHit> {
        let (micro, heights) = self.micro_surface(triangle)?;
        micro.hit(&self.surface_mesh, triangle, heights, raise, ray, f64::from(limit), sides)
    }

    /// Returns the displaced surfaces that are traced, with their objects, materials, and the number of triangles of
    /// the mesh below each.
    pub(crate) fn micro_surfaces(&self) -> impl Iterator<Item = ([usize; 2], &MicroSurface, usize)> {
        let ends = self.instances.iter().skip(1).map(|next| next.first_triangle as usize).chain([self.owner.len()]);
        self.instances.iter().zip(ends).filter_map(|(instance, end)| {
            let count = end - instance.first_triangle as usize;
            Some(([instance.object as usize, instance.scene_material], instance.micro.as_ref()?, count))
        })
    }

    /// Returns the object that a triangle belongs to, and the triangle of its mesh that it is part of.
    pub(crate) fn place_in_scene(&self, triangle: u32) -> [u32; 2] {
        let instance = &self.instances[self.owner[triangle as usize] as usize];
        [instance.object, (triangle - instance.first_triangle) / instance.pieces.max(1)]
    }

    /// Builds the tree of the triangles that belong in it.
    fn tree(&self, tree: Tree) -> TriangleBvh {
        let belongs = |&triangle: &u32| {
            let (instance, material) = self.instance_of(triangle);
            let own = match instance.space {
                MarchSpace::Shell => Tree::Shell,
                MarchSpace::Plane if material.is_raised() => Tree::Raised,
                MarchSpace::Plane => Tree::Surface,
            };
            own == tree && instance.micro.is_none()
        };
        let triangles: Vec<u32> = (0..self.owner.len() as u32).filter(belongs).collect();
        let bounds: Vec<bvh::Bounds> = triangles
            .iter()
            .map(|&triangle| match (tree, self.instance_of(triangle).1.march()) {
                (Tree::Shell, Some((_, heights))) => {
                    bvh::Bounds::around(&self.prism(triangle).hull(heights.range()).map(Vec3::from))
                }
                _ => bvh::Bounds::around(&self.positions(triangle)),
            })
            .collect();
        TriangleBvh::build(&bounds, &triangles)
    }

    /// Makes the shells of all instances that are marched in them.
    fn make_shells(&self) -> Vec<Vec<Prism>> {
        let mut shells: Vec<Vec<Prism>> = self.instances.iter().map(|_| Vec::new()).collect();
        for (triangle, &owner) in self.owner.iter().enumerate() {
            let instance = &self.instances[owner as usize];
            if instance.space == MarchSpace::Shell {
                let corners = self.corners(triangle as u32);
                let depth = corners.map(|corner| instance.depth.at(corner)).iter().sum::<f32>() / 3.0;
                let midlevel = self.materials[instance.material].midlevel;
                shells[owner as usize].push(Prism::new(corners.map(Vertex::as_corner), depth, midlevel));
            }
        }
        shells
    }

    /// Returns the shell over a triangle of an instance that is marched in shells.
    pub(crate) fn prism(&self, triangle: u32) -> &Prism {
        let owner = self.owner[triangle as usize] as usize;
        &self.shells[owner][(triangle - self.instances[owner].first_triangle) as usize]
    }

    /// Returns true if the relief of a triangle is marched in a shell.
    pub(crate) fn is_shell(&self, triangle: u32) -> bool {
        self.instance_of(triangle).0.space == MarchSpace::Shell
    }

    /// Returns the texture range of a triangle's chart.
    pub(crate) fn range(&self, triangle: u32) -> Bounds {
        self.surface_mesh.chart(triangle as usize).bounds()
    }

    /// Index of the material of a triangle in the scene.
    pub(crate) fn material_of(&self, triangle: u32) -> u32 {
        self.instances[self.owner[triangle as usize] as usize].scene_material as u32
    }

    /// True if triangles of the instance `caster` may hide a light from a point of `receiver`. One side of a relief is enough
    /// for that: the front, and to the back itself the back.
    pub(crate) fn casts_on(&self, caster: u32, receiver: u32) -> bool {
        let front_of = |instance: u32| self.instances[instance as usize].front;
        caster == receiver || (front_of(caster).is_none() && front_of(receiver) != Some(caster))
    }

    pub(crate) fn corners(&self, triangle: u32) -> [&Vertex; 3] {
        self.surface_mesh.triangles[triangle as usize].map(|i| &self.surface_mesh.vertices[i as usize])
    }

    pub(crate) fn instance_of(&self, triangle: u32) -> (&Instance, &MaterialShading) {
        let instance = &self.instances[self.owner[triangle as usize] as usize];
        (instance, &self.materials[instance.material])
    }

    /// Positions of the corners of a triangle.
    pub(crate) fn positions(&self, triangle: u32) -> [Vec3; 3] {
        self.corners(triangle).map(|corner| corner.position)
    }
}

/// Returns the ranges of the height maps of displaced surfaces that are traced, by material.
fn micro_ranges(materials: &[MaterialShading], instances: &[Instance]) -> Vec<Option<HeightRanges>> {
    let is_traced = |material: usize| instances.iter().any(|i| i.material == material && i.micro.is_some());
    let ranges = materials.iter().enumerate().map(|(index, material)| {
        let heights = material.heights.as_ref().filter(|_| is_traced(index))?;
        Some(HeightRanges::build(heights.levels().first()?))
    });
    ranges.collect()
}
