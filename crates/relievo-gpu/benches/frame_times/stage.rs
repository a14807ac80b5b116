//! What is drawn: a wall that fills the picture, seen through a long lens; and the ways of timing it.

use std::error::Error;
use std::path::{Path, PathBuf};

use glam::{Vec2, Vec3};
use relievo_gpu::FrameTime;
use relievo_march::{Bounds, Ray, ReliefMap};
use relievo_scene::{LoadOptions, Scene};

pub(crate) const SIZE: [u32; 2] = [1280, 720];
pub(crate) const DEGREES: [f32; 3] = [0.0, 60.0, 80.0];
/// A long lens: the angle is nearly the same all over the picture.
const VERTICAL_FOV: f32 = 8.0;
/// As in the wall's scene.
const DEPTH: f32 = 0.055;
/// Texels of a made material along u and v.
const MADE_SIZE: u32 = 512;

pub(crate) type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// The wall as such.
pub(crate) const WHOLE: Bounds = Bounds { min: [0.0; 2], max: [1.0; 2] };

/// A material on a square polygon: the folder that the environment variable `MATERIAL` names, from the workspace on, or the
/// wall's.
pub(crate) struct Stage {
    material: Option<PathBuf>,
}

impl Stage {
    pub(crate) fn new() -> Result<Self> {
        let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let material = std::env::var_os("MATERIAL").map(|name| workspace.join(name).canonicalize()).transpose()?;
        Ok(Self { material })
    }

    /// The material's name, and the texels of its height map.
    pub(crate) fn name(&self) -> Result<String> {
        let map = self.scene(0.0, &[])?.materials[0].maps.height.clone().ok_or("the material has no height map")?;
        let name = self.material.as_ref().and_then(|path| path.file_name()).map(|name| name.to_string_lossy());
        let name = name.unwrap_or("the built-in wall".into());
        Ok(format!("{name}, {}×{} texels", map.grid().width(), map.grid().height()))
    }

    /// The scene, `degrees` from the normal, with changes to its material and relief and to anything else.
    pub(crate) fn scene(&self, degrees: f32, changes: &[&str]) -> Result<Scene> {
        let Vec3 { x, y, z } = eye(degrees);
        let mut overrides = vec![
            format!("camera.position=[{x}, {y}, {z}]"),
            "camera.target=[0, 0, 0]".to_owned(),
            format!("camera.vertical_fov={VERTICAL_FOV}"),
            format!("image.width={}", SIZE[0]),
            format!("image.height={}", SIZE[1]),
            "materials.wall.filter=trilinear".to_owned(),
            "materials.wall.relief.shadow=none".to_owned(),
        ];
        if let Some(folder) = &self.material {
            let folder = folder.to_string_lossy().replace('\\', "/");
            overrides.push(format!("materials.wall.from={folder}"));
        }
        overrides.extend(changes.iter().map(|change| match change.split('=').next().unwrap_or_default() {
            "filter" => format!("materials.wall.{change}"),
            key if key.contains('.') => (*change).to_owned(),
            _ => format!("materials.wall.relief.{change}"),
        }));
        let overrides = overrides.iter().map(|change| change.parse()).collect::<std::result::Result<_, _>>()?;
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/wall.toml");
        Ok(Scene::load(&path, &LoadOptions { overrides, make_size: MADE_SIZE, ..LoadOptions::default() })?)
    }

    pub(crate) fn heights(&self) -> Result<ReliefMap> {
        let scene = self.scene(0.0, &[])?;
        Ok(ReliefMap::new(scene.materials[0].maps.height.as_ref().ok_or("the material has no height map")?))
    }
}

/// A ray through each pixel, in the order of these places.
pub(crate) fn rays(degrees: f32, places: impl Iterator<Item = [u32; 2]>) -> Vec<Ray> {
    let eye = eye(degrees);
    let ray = |[x, y]: [u32; 2]| {
        let at = |i: u32, n: u32| (i as f32 + 0.5) / n as f32 * 2.0 - 1.0;
        let (place, direction) = on_wall(eye, Vec2::new(at(x, SIZE[0]), -at(y, SIZE[1])));
        Ray::from_view([0.5 + 0.5 * place.x, 0.5 - 0.5 * place.y], (-direction).into(), [DEPTH, -DEPTH])
    };
    places.map(ray).collect()
}

/// The pixels row by row.
pub(crate) fn by_rows() -> impl Iterator<Item = [u32; 2]> {
    (0..SIZE[0] * SIZE[1]).map(|i| [i % SIZE[0], i / SIZE[0]])
}

/// The pixels in tiles of 8×4.
pub(crate) fn by_tiles() -> impl Iterator<Item = [u32; 2]> {
    (0..SIZE[0] * SIZE[1]).map(|i| {
        let (tile, k) = (i / 32, i % 32);
        let across = SIZE[0] / 8;
        [tile % across * 8 + k % 8, tile / across * 4 + k / 8]
    })
}

/// Where the camera stands, `degrees` from the normal, so that the wall just fills the picture.
fn eye(degrees: f32) -> Vec3 {
    let towards = Vec3::new(0.0, -degrees.to_radians().sin(), degrees.to_radians().cos());
    // What is seen grows with the distance: from one unit away, how far does it reach?
    let corners = [Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0), Vec2::new(-1.0, 1.0), Vec2::new(1.0, 1.0)];
    let reach = corners.map(|corner| on_wall(towards, corner).0.truncate().abs().max_element());
    towards * (0.96 / reach.into_iter().fold(0.0, f32::max))
}

/// Where the view through a place of the picture (−1..1, up) meets the wall, and its direction.
fn on_wall(eye: Vec3, place: Vec2) -> (Vec3, Vec3) {
    let forward = -eye.normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let half = (VERTICAL_FOV.to_radians() * 0.5).tan();
    let aspect = SIZE[0] as f32 / SIZE[1] as f32;
    let direction = (forward + right * (place.x * half * aspect) + right.cross(forward) * (place.y * half)).normalize();
    (eye - direction * (eye.z / direction.z), direction)
}

pub(crate) fn milliseconds(time: FrameTime) -> f64 {
    time.gpu.unwrap_or(time.wall).as_secs_f64() * 1e3
}

pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values[values.len() / 2]
}

/// For every row: the median, and the median of the ratios to the reference of the same round.
pub(crate) fn summed_up(rounds: &[Vec<f64>], reference: usize) -> Vec<(f64, f64)> {
    let row = |k: usize| {
        let ratios = rounds.iter().map(|round| round[k] / round[reference]).collect();
        (median(rounds.iter().map(|round| round[k]).collect()), median(ratios))
    };
    (0..rounds[0].len()).map(row).collect()
}
