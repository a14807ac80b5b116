use std::sync::Arc;

use relievo_map::{GridId, MapSet};
use relievo_scene::{ColorSpace, Material, Object, Scene};

/// Everything of a scene that its world is made of: two scenes with the same have the same world.
pub(crate) struct WorldKey {
    objects: Vec<Object>,
    /// Without their maps.
    materials: Vec<Material>,
    maps: Vec<[Option<GridId>; 6]>,
    space: ColorSpace,
}

impl WorldKey {
    pub(crate) fn of(scene: &Scene) -> Self {
        let bare = |material: &Material| {
            let material = material.clone();
            Material { maps: MapSet::default(), changing_heights: None, heights_are_made: true, ..material }
        };
        Self {
            objects: scene.objects.clone(),
            materials: scene.materials.iter().map(bare).collect(),
            maps: scene.materials.iter().map(|material| material.maps.ids()).collect(),
            space: scene.shading.color_space,
        }
    }
}

impl PartialEq for WorldKey {
    fn eq(&self, other: &Self) -> bool {
        let same = |(a, b): (&Object, &Object)| {
            Arc::ptr_eq(&a.mesh, &b.mesh)
                && (a.material, a.transform, a.uv_repeat) == (b.material, b.transform, b.uv_repeat)
        };
        self.objects.len() == other.objects.len()
            && self.objects.iter().zip(&other.objects).all(same)
            && (&self.materials, &self.maps, self.space) == (&other.materials, &other.maps, other.space)
    }
}
