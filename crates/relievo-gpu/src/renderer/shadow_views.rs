//! The views that the shadow maps of a scene's lights are drawn from.

use glam::Vec3;
use relievo_scene::{Light, ReliefDepth, SurfaceMesh};

use super::layout::{CameraViewLayout, LightLayout};

/// Texture arrays have at least as many layers on every device.
const MAX_LAYERS: usize = 256;

/// Wider spots than this half-angle, in degrees, get the six faces of a point light.
const WIDEST_SPOT: f32 = 70.0;

/// The extent of an object that throws a shadow.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Caster {
    min: Vec3,
    max: Vec3,
    /// Normal and distance from the origin, if all of it lies in one plane.
    plane: Option<(Vec3, f32)>,
}

/// One picture to draw: a layer of the maps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LayerView {
    eye: Vec3,
    /// Divided by half the picture's width and height at distance 1, or by those themselves if rays are parallel.
    right: Vec3,
    up: Vec3,
    forward: Vec3,
    window_offset: [f32; 2],
    near: f32,
    far: f32,
    parallel: bool,
}

/// The maps of all lights.
#[derive(Clone, Debug, Default)]
pub(crate) struct ShadowViews {
    pub(crate) layers: Vec<LayerView>,
    /// Of each light its first layer, if it has any, and whether they are the faces of a cube.
    first: Vec<Option<(usize, bool)>>,
    /// Lights for which there was no room.
    pub(crate) left_out: usize,
}

impl Caster {
    /// `None` if there is nothing to see. `rises`: there may be more above the polygons.
    pub(crate) fn of(surface_mesh: &SurfaceMesh, rises: bool) -> Option<Self> {
        let used = || surface_mesh.triangles.iter().flatten().map(|&i| surface_mesh.vertices[i as usize].position);
        let (min, max) = used().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(min, max), p| (min.min(p), max.max(p)));
        if !(min.is_finite() && max.is_finite()) {
            return None;
        }
        let normals = surface_mesh.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|i| surface_mesh.vertices[i as usize].position);
            (b - a).cross(c - a)
        });
        let normal = normals.max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))?.normalize_or_zero();
        let distance = normal.dot(used().next()?);
        let flat = 1e-5 * ((max - min).max_element() + max.abs().max(min.abs()).max_element());
        let is_plane = !rises && normal != Vec3::ZERO && used().all(|p| (normal.dot(p) - distance).abs() <= flat);
        Some(Self { min, max, plane: is_plane.then_some((normal, distance)) })
    }

    /// Returns the caster as mist sees it: its relief throws shadows into the mist beside and below it, even where its polygons lie in
    /// one plane with nothing behind.
    pub(crate) fn in_mist(self, surface_mesh: &SurfaceMesh, depth: &ReliefDepth, midlevel: f32) -> Self {
        let ends = surface_mesh.vertices.iter().flat_map(|vertex| {
            let (direction, depth) = (vertex.direction.normalize_or_zero(), depth.at(vertex));
            [1.0 - midlevel, -midlevel].map(|height| vertex.position + direction * (height * depth))
        });
        let (min, max) = ends.fold((self.min, self.max), |(min, max), end| (min.min(end), max.max(end)));
        Self { min, max, plane: None }
    }

    fn corners(&self) -> impl Iterator<Item = Vec3> {
        let sides = [self.min, self.max];
        (0..8).map(move |k: usize| Vec3::new(sides[k & 1].x, sides[(k >> 1) & 1].y, sides[k >> 2].z))
    }
}

impl ShadowViews {
    pub(crate) fn new(lights: &[Light], casters: &[Caster]) -> Self {
        let mut views = Self::default();
        let Some(all) =
            casters.iter().copied().reduce(|a, b| Caster { min: a.min.min(b.min), max: a.max.max(b.max), plane: None })
        else {
            views.first = vec![None; lights.len()];
            return views;
        };
        for light in lights {
            let seen = visible_casters(light, casters, &all);
            let layers = if seen.is_empty() { Vec::new() } else { layers(light, &seen) };
            if views.layers.len() + layers.len() > MAX_LAYERS {
                views.left_out += 1;
                views.first.push(None);
                continue;
            }
            views.first.push((!layers.is_empty()).then_some((views.layers.len(), layers.len() == 6)));
            views.layers.extend(layers);
        }
        views
    }

    /// Writes the maps' views into the lights.
    pub(crate) fn write(&self, lights: &mut [LightLayout]) {
        for (light, first) in lights.iter_mut().zip(&self.first) {
            let Some((first, is_cube)) = *first else {
                light.map_layer = -1;
                continue;
            };
            let view = &self.layers[first];
            light.map_layer = first as i32;
            light.map_eye = view.eye.into();
            light.map_near = view.near;
            light.map_far = view.far;
            light.map_window_offset = view.window_offset;
            // Without axes it is a cube's.
            let axes = if is_cube { [Vec3::ZERO; 2] } else { [view.right, view.up] };
            (light.map_right, light.map_up) = (axes[0].into(), axes[1].into());
        }
    }
}

impl LayerView {
    pub(crate) fn layout(&self) -> CameraViewLayout {
        CameraViewLayout {
            eye: self.eye.into(),
            // A relief may rise above where a directional light's map begins.
            near: if self.parallel { f32::MIN } else { self.near },
            right: self.right.into(),
            up: self.up.into(),
            forward: self.forward.into(),
            jitter: self.window_offset,
            parallel: self.parallel.into(),
            far: self.far,
            ..bytemuck::Zeroable::zeroed()
        }
    }
}

/// The casters whose shadow a light can throw on something else: not those with everything else before them.
fn visible_casters(light: &Light, casters: &[Caster], all: &Caster) -> Vec<Caster> {
    if let [only] = casters
        && only.plane.is_some()
    {
        return Vec::new();
    }
    let is_floor = |caster: &Caster| {
        let Some((normal, distance)) = caster.plane else { return false };
        let height = match light.kind.position() {
            None => -normal.dot(light.kind.direction().unwrap_or_default()),
            Some(position) => normal.dot(position) - distance,
        };
        let thin = 1e-4 * (all.max - all.min).max_element();
        all.corners().all(|corner| (normal.dot(corner) - distance) * height.signum() >= -thin)
    };
    casters.iter().filter(|caster| !is_floor(caster)).copied().collect()
}

fn layers(light: &Light, casters: &[Caster]) -> Vec<LayerView> {
    match (light.kind.position(), light.kind.direction(), light.kind.cone_angles()) {
        (None, Some(direction), _) => vec![along(direction, casters)],
        (None, None, _) => Vec::new(),
        (Some(position), Some(direction), Some([_, outer_angle])) if outer_angle <= WIDEST_SPOT => {
            within_cone(position, direction, outer_angle, casters).into_iter().collect()
        }
        (Some(position), ..) => around(position, casters).to_vec(),
    }
}

/// Unit vectors to the right and up in a picture along `forward`.
fn axes(forward: Vec3) -> (Vec3, Vec3) {
    let up = if forward.y.abs() < 0.99 { Vec3::Y } else { Vec3::Z };
    let right = forward.cross(up).normalize();
    (right, right.cross(forward))
}

/// The range of some numbers.
fn range(numbers: impl Iterator<Item = f32>) -> (f32, f32) {
    numbers.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
}

/// Half of a window's side, with room for what is looked up beside a border.
fn half((low, high): (f32, f32)) -> f32 {
    (0.5 * (high - low) * 1.01).max(1e-6)
}

/// All casters as a directional light sees them.
fn along(direction: Vec3, casters: &[Caster]) -> LayerView {
    let (right, up) = axes(direction);
    let reach = |axis: Vec3| range(casters.iter().flat_map(Caster::corners).map(|corner| corner.dot(axis)));
    let (x, y, z) = (reach(right), reach(up), reach(direction));
    let deep = (z.1 - z.0).max(1e-6);
    let middle = |(low, high): (f32, f32)| 0.5 * (low + high);
    LayerView {
        eye: right * middle(x) + up * middle(y) + direction * (z.0 - 0.01 * deep),
        right: right / half(x),
        up: up / half(y),
        forward: direction,
        window_offset: [0.0; 2],
        near: 0.0,
        // Depth 0 is where there is nothing.
        far: 1.03 * deep,
        parallel: true,
    }
}

/// The casters inside a spot's cone; `None` if there are none.
fn within_cone(position: Vec3, direction: Vec3, outer_angle: f32, casters: &[Caster]) -> Option<LayerView> {
    let (right, up) = axes(direction);
    let widest = outer_angle.to_radians().tan();
    let corners: Vec<Vec3> = casters
        .iter()
        .flat_map(Caster::corners)
        .map(|corner| corner - position)
        .map(|offset| Vec3::new(offset.dot(right), offset.dot(up), offset.dot(direction)))
        .collect();
    let (nearest, farthest) = range(corners.iter().map(|corner| corner.z));
    if farthest <= 0.0 {
        return None;
    }
    let least = 1e-3 * farthest;
    let window = |side: fn(&Vec3) -> f32| {
        if nearest <= least {
            // What lies beside the light and behind it has no place in its picture.
            return (-widest, widest);
        }
        let (low, high) = range(corners.iter().map(|corner| side(corner) / corner.z));
        (low.max(-widest), high.min(widest))
    };
    let (x, y) = (window(|corner| corner.x), window(|corner| corner.y));
    if x.0 >= x.1 || y.0 >= y.1 {
        return None;
    }
    let halves = [half(x), half(y)];
    Some(LayerView {
        eye: position,
        right: right / halves[0],
        up: up / halves[1],
        forward: direction,
        window_offset: [-0.5 * (x.0 + x.1) / halves[0], -0.5 * (y.0 + y.1) / halves[1]],
        near: (0.5 * nearest).max(least),
        far: 0.0,
        parallel: false,
    })
}

/// The faces of a cube around a point light, in the order +x, −x, +y, −y, +z, −z.
fn around(position: Vec3, casters: &[Caster]) -> [LayerView; 6] {
    let farthest = casters.iter().flat_map(Caster::corners).map(|c| c.distance(position)).fold(0.0, f32::max);
    let near = (1e-3 * farthest).max(1e-6);
    std::array::from_fn(|face| {
        let axis = [Vec3::X, Vec3::Y, Vec3::Z][face / 2];
        let forward = if face % 2 == 0 { axis } else { -axis };
        let up = if face / 2 == 1 { Vec3::Z } else { Vec3::Y };
        let right = forward.cross(up);
        LayerView { eye: position, right, up, forward, window_offset: [0.0; 2], near, far: 0.0, parallel: false }
    })
}

#[cfg(test)]
mod tests {
    use relievo_scene::LightKind;

    use super::*;

    fn block(min: [f32; 3], max: [f32; 3]) -> Caster {
        Caster { min: min.into(), max: max.into(), plane: None }
    }

    fn floor(y: f32) -> Caster {
        let plane = Some((Vec3::Y, y));
        Caster { min: Vec3::new(-9.0, y, -9.0), max: Vec3::new(9.0, y, 9.0), plane }
    }

    fn light(kind: LightKind) -> Light {
        Light { kind, color: [1.0; 3], intensity: 1.0, radius: 0.0 }
    }

    /// Position of a point in a view's picture, and its depth, as the shaders compute them.
    fn project(view: &LayerView, point: Vec3) -> [f32; 3] {
        let offset = point - view.eye;
        let view_depth = offset.dot(view.forward);
        let (x, y) = (offset.dot(view.right), offset.dot(view.up));
        if view.parallel {
            [x + view.window_offset[0], y + view.window_offset[1], 1.0 - view_depth / view.far]
        } else {
            [x / view_depth + view.window_offset[0], y / view_depth + view.window_offset[1], view.near / view_depth]
        }
    }

    fn shows(view: &LayerView, caster: &Caster) -> bool {
        caster.corners().all(|corner| {
            let [x, y, z] = project(view, corner);
            x.abs() <= 1.0 && y.abs() <= 1.0 && z > 0.0 && z <= 1.0
        })
    }

    #[test]
    fn maps_show_all_casters_and_little_else() {
        let casters = [block([-1.0, 0.0, -1.0], [1.0, 1.0, 1.0]), floor(0.0)];
        let direction = Vec3::new(0.3, -0.8, -0.2).normalize();
        let position = Vec3::new(3.0, 6.0, 2.0);
        let spot = LightKind::Spot { position, direction: -position.normalize(), inner_angle: 20.0, outer_angle: 60.0 };
        for kind in [LightKind::Directional { direction }, spot] {
            let views = ShadowViews::new(&[light(kind)], &casters);
            assert_eq!(views.layers.len(), 1, "the floor has nothing below it");
            assert!(shows(&views.layers[0], &casters[0]), "{kind:?}: {views:?}");
            let outermost =
                casters[0].corners().map(|corner| project(&views.layers[0], corner)[0].abs()).fold(0.0, f32::max);
            assert!(outermost > 0.9, "{kind:?}: the map is larger than what is in it");
        }
    }

    #[test]
    fn a_point_light_sees_every_direction_in_one_of_six_faces() {
        let casters = [block([-2.0; 3], [-1.0; 3]), block([1.0; 3], [2.0; 3])];
        let views = ShadowViews::new(&[light(LightKind::Point { position: Vec3::ZERO })], &casters);
        assert_eq!(views.layers.len(), 6);
        for caster in &casters {
            for corner in caster.corners() {
                let faces = views.layers.iter().map(|view| project(view, corner));
                assert!(faces.into_iter().any(|[x, y, z]| x.abs() <= 1.0 && y.abs() <= 1.0 && z > 0.0 && z <= 1.0));
            }
        }
        let mut layouts = [bytemuck::Zeroable::zeroed(); 1];
        views.write(&mut layouts);
        assert_eq!((layouts[0].map_layer, layouts[0].map_right), (0, [0.0; 3]));
    }

    #[test]
    fn two_opposite_spots_are_no_cube() {
        let spot =
            |direction| LightKind::Spot { position: Vec3::ZERO, direction, inner_angle: 20.0, outer_angle: 40.0 };
        let lights = [Vec3::X, Vec3::NEG_X].map(|direction| light(spot(direction)));
        let views = ShadowViews::new(&lights, &[block([-2.0; 3], [2.0; 3])]);
        assert_eq!(views.layers.len(), 2);
        let mut layouts = [bytemuck::Zeroable::zeroed(); 2];
        views.write(&mut layouts);
        assert!(layouts.iter().all(|layout| layout.map_right != [0.0; 3]));
    }

    #[test]
    fn what_can_shadow_nothing_needs_no_map() {
        let sun = light(LightKind::Directional { direction: Vec3::NEG_Y });
        assert!(ShadowViews::new(&[sun], &[floor(0.0)]).layers.is_empty());
        assert!(ShadowViews::new(&[sun], &[]).layers.is_empty());
        // A ceiling throws its shadow on the floor.
        assert_eq!(ShadowViews::new(&[sun], &[floor(0.0), floor(2.0)]).layers.len(), 1);
        let behind = LightKind::Spot {
            position: Vec3::new(0.0, 0.0, -5.0),
            direction: Vec3::NEG_Z,
            inner_angle: 10.0,
            outer_angle: 20.0,
        };
        assert!(ShadowViews::new(&[light(behind)], &[block([-1.0; 3], [1.0; 3])]).layers.is_empty());
    }

    #[test]
    fn lights_beyond_the_layers_there_are_are_counted() {
        let lights = [light(LightKind::Point { position: Vec3::ZERO }); 50];
        let views = ShadowViews::new(&lights, &[block([1.0; 3], [2.0; 3])]);
        assert_eq!((views.layers.len(), views.left_out), (42 * 6, 8));
        let mut layouts = [bytemuck::Zeroable::zeroed(); 50];
        views.write(&mut layouts);
        assert_eq!((layouts[41].map_layer, layouts[42].map_layer), (41 * 6, -1));
    }
}
