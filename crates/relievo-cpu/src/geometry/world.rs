use glam::Vec3;
use relievo_march::{Bounds, Prism};
use relievo_scene::{MarchSpace, ReliefDepth, Scene, SurfaceMesh, Vertex};

use super::bvh::{self, TriangleBvh};
use crate::RenderError;
use crate::shading::material::MaterialShading;

/// Limit of the number of triangles: more would take over 4 GB of memory.
const MAX_TRIANGLES: u64 = 16_000_000;

/// An object of the scene.
pub(crate) struct Instance {
    /// Index into [`World::materials`].
    pub(crate) material: usize,
    /// The same in the scene, where both sides of a material are one.
    pub(crate) scene_material: usize,
    /// Of the back of a relief, the instance that is its front.
    pub(crate) front: Option<u32>,
    pub(crate) depth: ReliefDepth,
    pub(crate) space: MarchSpace,
}

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
    /// Shells of the triangles of each instance that is marched in them, and the number of the first of these.
    shells: Vec<(u32, Vec<Prism>)>,
}

/// The trees of the world.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Tree {
    Surface,
    Raised,
    Shell,
}

impl World {
    pub(crate) fn new(scene: &Scene) -> Result<Self, RenderError> {
        let mut build = WorldBuilder::new(scene);
        for index in 0..scene.objects.len() {
            build.add(index)?;
        }
        let WorldBuilder { materials, instances, surface_mesh, owner, triangles, .. } = build;
        let empty = || TriangleBvh::build(&[], &[]);
        let mut this = Self {
            materials,
            instances,
            surface_mesh,
            owner,
            triangles,
            bvh: empty(),
            raised_bvh: empty(),
            shell_bvh: empty(),
            shells: Vec::new(),
        };
        this.shells = this.make_shells();
        let [bvh, raised, shell] = [Tree::Surface, Tree::Raised, Tree::Shell].map(|tree| this.tree(tree));
        (this.bvh, this.raised_bvh, this.shell_bvh) = (bvh, raised, shell);
        Ok(this)
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
            own == tree
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
    fn make_shells(&self) -> Vec<(u32, Vec<Prism>)> {
        let mut shells: Vec<(u32, Vec<Prism>)> = self.instances.iter().map(|_| (u32::MAX, Vec::new())).collect();
        for (triangle, &owner) in self.owner.iter().enumerate() {
            let instance = &self.instances[owner as usize];
            let (first, shells) = &mut shells[owner as usize];
            *first = (*first).min(triangle as u32);
            if instance.space == MarchSpace::Shell {
                let corners = self.corners(triangle as u32);
                let depth = corners.map(|corner| instance.depth.at(corner)).iter().sum::<f32>() / 3.0;
                let midlevel = self.materials[instance.material].midlevel;
                shells.push(Prism::new(corners.map(Vertex::as_corner), depth, midlevel));
            }
        }
        shells
    }

    /// Returns the shell over a triangle of an instance that is marched in shells.
    pub(crate) fn prism(&self, triangle: u32) -> &Prism {
        let (first, shells) = &self.shells[self.owner[triangle as usize] as usize];
        &shells[(triangle - first) as usize]
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

/// Puts the objects of a scene together.
struct WorldBuilder<'a> {
    scene: &'a Scene,
    materials: Vec<MaterialShading>,
    /// Of each material of the scene the index of its back, if one has to be marched.
    backs: Vec<Option<usize>>,
    instances: Vec<Instance>,
    surface_mesh: SurfaceMesh,
    owner: Vec<u32>,
    triangles: usize,
}

impl<'a> WorldBuilder<'a> {
    fn new(scene: &'a Scene) -> Self {
        let space = scene.shading.color_space;
        let mut materials: Vec<MaterialShading> =
            scene.materials.iter().map(|material| MaterialShading::new(material, space)).collect();
        let mut backs = vec![None; materials.len()];
        for (number, material) in scene.materials.iter().enumerate() {
            if material.has_marched_back() {
                backs[number] = Some(materials.len());
                materials.push(materials[number].back(material, space));
            }
        }
        let (instances, owner) = (Vec::new(), Vec::new());
        Self { scene, materials, backs, instances, surface_mesh: SurfaceMesh::default(), owner, triangles: 0 }
    }

    /// Adds an object, and the back of its relief if that can be seen.
    fn add(&mut self, index: usize) -> Result<(), RenderError> {
        let object = &self.scene.objects[index];
        let (number, repeat) = (object.material, object.uv_repeat);
        let (in_scene, material) = (&self.scene.materials[number], &self.materials[number]);
        let depth = ReliefDepth::new(material.range, object);
        let mut part = SurfaceMesh::in_scene_space(object, in_scene);
        let space = in_scene.march_space(&part);
        let instance = |material: usize, front: Option<u32>| Instance {
            material,
            scene_material: number,
            front,
            depth,
            space,
        };
        let grid = if material.is_displaced() { material.relief.grid } else { 1 };
        let uvs = in_scene.uv.after(repeat);
        let sides = 1 + u64::from(self.backs[number].is_some());
        let triangles = self.owner.len() as u64 + part.displaced_count(grid, &uvs) * sides;
        if triangles > MAX_TRIANGLES {
            return Err(RenderError::TooManyTriangles { object: index, triangles, grid, max: MAX_TRIANGLES });
        }
        if let Some(heights) = material.heights.as_ref().filter(|_| material.is_displaced()) {
            let field = material.field(heights, 0.0, part.texture_range());
            part = part.displaced(&field, &depth, material.midlevel, grid, &uvs);
        }
        self.triangles += part.triangles.len();
        let front = self.instances.len() as u32;
        let back = self.backs[number].map(|back| (part.back(), instance(back, Some(front))));
        self.push(part, instance(number, None));
        if let Some((part, instance)) = back {
            self.push(part, instance);
        }
        Ok(())
    }

    fn push(&mut self, mut part: SurfaceMesh, instance: Instance) {
        self.owner.resize(self.owner.len() + part.triangles.len(), self.instances.len() as u32);
        self.surface_mesh.append(&mut part);
        self.instances.push(instance);
    }
}
