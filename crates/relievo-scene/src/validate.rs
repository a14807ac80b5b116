//! The one check of a scene that every renderer relies on.

use glam::Vec2;
use thiserror::Error;

use crate::{
    Camera, HeightRange, ImageSettings, Material, Mesh, MeshError, MistError, MistVolume, Object, Scene, UvTransform,
};

/// The most pixels on a side of a picture that a renderer draws; scene files allow [`ImageSettings::MAX_SIDE`].
const MAX_SIDE: u32 = 1 << 16;

/// Reason why a [`Scene`] cannot be drawn: the first promise that does not hold. Loaded scenes always pass.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum InvalidScene {
    /// A side of the picture is 0 or far too long.
    #[error("a picture of {width}×{height} pixels is not possible")]
    ImageSize {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
    },
    /// The number of samples per pixel is not in 1 to [`ImageSettings::MAX_SAMPLES`].
    #[error("{0} samples per pixel are not possible: 1 to {max} are", max = ImageSettings::MAX_SAMPLES)]
    Samples(u32),
    /// The camera has no direction or no roll.
    #[error("the camera looks nowhere: its target is its position, or its up is along the view")]
    CameraDirection,
    /// The camera's field of view is not in (0°, 180°), or its near distance is not above 0.
    #[error("a camera with a view of {vertical_fov}° from {near} on is not possible")]
    CameraView {
        /// Degrees.
        vertical_fov: f32,
        /// Scene units.
        near: f32,
    },
    /// An orthographic camera's height is not above 0.
    #[error("an orthographic camera with a picture {0} high is not possible")]
    CameraSize(f32),
    /// A material's depth is negative or not finite, or its midlevel is not in 0 to 1.
    #[error("material {material} is {depth} deep with a midlevel of {midlevel}")]
    ReliefRange {
        /// Index into [`Scene::materials`].
        material: usize,
        /// Value of [`Material::height`].
        depth: f32,
        /// Value of [`Material::midlevel`].
        midlevel: f32,
    },
    /// A material's map of texture coordinates is not finite, or scales to nothing.
    #[error("material {material} maps its texture coordinates by {uv:?}")]
    Uv {
        /// Index into [`Scene::materials`].
        material: usize,
        /// Value of [`Material::uv`].
        uv: UvTransform,
    },
    /// A material's part of an atlas is empty or not finite.
    #[error("material {material} takes the part {rect:?} of an atlas")]
    UvRect {
        /// Index into [`Scene::materials`].
        material: usize,
        /// Value of [`Material::uv_rect`].
        rect: [f32; 4],
    },
    /// An object names a material that is not there.
    #[error("object {object} asks for material {material} of {count}")]
    NoSuchMaterial {
        /// Index into [`Scene::objects`].
        object: usize,
        /// Value of [`Object::material`].
        material: usize,
        /// Number of materials.
        count: usize,
    },
    /// An object's transform is not finite or not invertible.
    #[error("object {0} is squeezed flat by its transform")]
    Transform(usize),
    /// An object's texture repeats are not above 0.
    #[error("object {object} repeats its texture {uv_repeat} times")]
    UvRepeat {
        /// Index into [`Scene::objects`].
        object: usize,
        /// Value of [`Object::uv_repeat`].
        uv_repeat: Vec2,
    },
    /// A material cannot be mist as it is, or not on an object that has it.
    #[error("material {material} cannot be mist: {source}")]
    Mist {
        /// Index into [`Scene::materials`].
        material: usize,
        /// The cause.
        source: MistError,
    },
    /// An object's mesh breaks a promise of [`crate::Mesh`].
    #[error("object {object} has a mesh that cannot be drawn: {source}")]
    Mesh {
        /// Index into [`Scene::objects`].
        object: usize,
        /// The mesh's own check.
        source: MeshError,
    },
}

impl Scene {
    /// Checks everything that renderers rely on. Scenes that were loaded pass; those put together or changed in code may not.
    ///
    /// # Errors
    /// The first promise that does not hold.
    pub fn validate(&self) -> Result<(), InvalidScene> {
        self.image.validate()?;
        self.camera.validate()?;
        self.materials.iter().enumerate().try_for_each(|(index, material)| check_material(index, material))?;
        let count = self.materials.len();
        self.objects.iter().enumerate().try_for_each(|(index, object)| {
            check_object(index, object, count)?;
            let (number, material) = (object.material, &self.materials[object.material]);
            check_mist_mesh(material, object).map_err(|source| InvalidScene::Mist { material: number, source })
        })
    }
}

impl ImageSettings {
    /// Checks the size of the picture and the number of samples.
    ///
    /// # Errors
    /// The first promise that does not hold.
    pub fn validate(&self) -> Result<(), InvalidScene> {
        let &Self { width, height, samples, .. } = self;
        if [width, height].iter().any(|side| !(1..=MAX_SIDE).contains(side)) {
            return Err(InvalidScene::ImageSize { width, height });
        }
        if !(1..=Self::MAX_SAMPLES).contains(&samples) {
            return Err(InvalidScene::Samples(samples));
        }
        Ok(())
    }
}

impl Camera {
    /// Checks that the camera sees something.
    ///
    /// # Errors
    /// If it has no direction, no roll, no field of view or no near distance.
    pub fn validate(&self) -> Result<(), InvalidScene> {
        let &Self { kind: _, position, target, up, vertical_fov, size, near } = self;
        let forward = (target - position).normalize_or_zero();
        // Written so that NaN is refused, here and below.
        if !(forward.cross(up.normalize_or_zero()).length() >= 1e-6 && position.is_finite()) {
            return Err(InvalidScene::CameraDirection);
        }
        if !(vertical_fov > 0.0 && vertical_fov < 180.0 && near > 0.0) {
            return Err(InvalidScene::CameraView { vertical_fov, near });
        }
        if self.is_orthographic() && !(size > 0.0 && size.is_finite()) {
            return Err(InvalidScene::CameraSize(size));
        }
        Ok(())
    }
}

fn check_material(index: usize, material: &Material) -> Result<(), InvalidScene> {
    let (HeightRange::Scale(depth) | HeightRange::Depth(depth)) = material.height;
    let midlevel = material.midlevel;
    if !((0.0..=f32::MAX).contains(&depth) && (0.0..=1.0).contains(&midlevel)) {
        return Err(InvalidScene::ReliefRange { material: index, depth, midlevel });
    }
    let uv = material.uv;
    let sound = |x: f32| (1.0 / Mesh::MAX_COORDINATE..=Mesh::MAX_COORDINATE).contains(&x.abs());
    if !(uv.offset.abs().max_element() <= Mesh::MAX_COORDINATE
        && uv.rotate.is_finite()
        && uv.scale.to_array().into_iter().all(sound))
    {
        return Err(InvalidScene::Uv { material: index, uv });
    }
    if let Some(rect) = material.uv_rect {
        let [u0, v0, u1, v1] = rect;
        if !(u0 < u1 && v0 < v1 && rect.iter().all(|x| x.is_finite())) {
            return Err(InvalidScene::UvRect { material: index, rect });
        }
    }
    material.check_mist().map_err(|source| InvalidScene::Mist { material: index, source })
}

/// Checks that the mesh of an object is one that its material, if it is mist, can lie on.
pub(crate) fn check_mist_mesh(material: &Material, object: &Object) -> Result<(), MistError> {
    if material.is_mist() { MistVolume::of(object, material, [0; 2]).map(|_| ()) } else { Ok(()) }
}

fn check_object(index: usize, object: &Object, materials: usize) -> Result<(), InvalidScene> {
    let &Object { material, transform, uv_repeat, .. } = object;
    if material >= materials {
        return Err(InvalidScene::NoSuchMaterial { object: index, material, count: materials });
    }
    if !transform.is_finite() || transform.matrix3.determinant() == 0.0 {
        return Err(InvalidScene::Transform(index));
    }
    if !(uv_repeat.is_finite() && uv_repeat.min_element() > 0.0) {
        return Err(InvalidScene::UvRepeat { object: index, uv_repeat });
    }
    object.mesh.validate().map_err(|source| InvalidScene::Mesh { object: index, source })
}
