//! The scene as the window shows it: as loaded, with the changes since.

use std::sync::Arc;

use relievo_march::Shadow;
use relievo_scene::{
    Camera, Edge, HeightRange, Light, LightKind, Mesh, Relief, SHAPE_NAMES, Scene, SceneTime, SurfaceTechnique,
};

use crate::control::commands::Command;
use crate::state::edits::{Edits, HEIGHT_STEPS};

/// Frames per second of steps in time.
const STEPS_PER_SECOND: f64 = 30.0;

/// The parts of a renderer that are no longer up to date.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[must_use]
pub struct Change {
    /// The camera.
    pub camera: bool,
    /// The lights.
    pub lights: bool,
    /// Heights, techniques, shadows, edges.
    pub reliefs: bool,
    /// The time: the scene is to be loaded as it is then, see [`State::move_to`].
    pub time: bool,
    /// Everything that changes in the course of time.
    pub moment: bool,
    /// The meshes, or everything.
    pub scene: bool,
}

impl Change {
    pub(crate) const ALL: Self =
        Self { camera: true, lights: true, reliefs: true, time: false, moment: false, scene: true };

    /// True if anything changed.
    #[must_use]
    pub fn any(self) -> bool {
        self != Self::default()
    }

    /// Union of two changes.
    pub fn and(self, other: Self) -> Self {
        Self {
            camera: self.camera || other.camera,
            lights: self.lights || other.lights,
            reliefs: self.reliefs || other.reliefs,
            time: self.time || other.time,
            moment: self.moment || other.moment,
            scene: self.scene || other.scene,
        }
    }
}

/// A scene with its changes. They outlive the scene: when its file is loaded again, they are made again.
pub struct State {
    /// With all changes.
    scene: Scene,
    loaded: Loaded,
    edits: Edits,
    /// The built-in mesh that stands in for the first object's, as in the edits when they were last made.
    stand_in: Option<&'static str>,
    chosen_light: usize,
    time: SceneTime,
    playing: bool,
}

/// The parts of a scene that edits replace, as they were loaded.
struct Loaded {
    camera: Camera,
    lights: Vec<Light>,
    reliefs: Vec<(Relief, HeightRange)>,
    mesh: Option<Arc<Mesh>>,
    /// Its name, if the first object's mesh is a built-in one.
    mesh_name: Option<&'static str>,
}

impl Loaded {
    fn of(scene: &Scene) -> Self {
        let mesh = scene.objects.first().map(|object| Arc::clone(&object.mesh));
        let is = |name: &&&str| Mesh::shape(name).is_some_and(|shape| mesh.as_deref() == Some(&shape));
        Self { mesh_name: SHAPE_NAMES.iter().find(is).copied(), mesh, ..Self::without_mesh(scene) }
    }

    fn without_mesh(scene: &Scene) -> Self {
        Self {
            camera: scene.camera,
            lights: scene.lights.clone(),
            reliefs: scene.materials.iter().map(|material| (material.relief, material.height)).collect(),
            mesh_name: None,
            mesh: None,
        }
    }
}

impl State {
    /// A scene as it was loaded.
    #[must_use]
    pub fn new(scene: Scene) -> Self {
        Self::at(scene, SceneTime::default())
    }

    /// A scene as it was loaded at a time.
    #[must_use]
    pub fn at(scene: Scene, time: SceneTime) -> Self {
        let (loaded, edits) = (Loaded::of(&scene), Edits::default());
        Self { loaded, scene, edits, stand_in: None, chosen_light: 0, time, playing: false }
    }

    /// The time that is shown.
    #[must_use]
    pub fn time(&self) -> SceneTime {
        self.time
    }

    /// True while time goes on by itself.
    #[must_use]
    pub fn is_playing(&self) -> bool {
        self.playing
    }

    /// Stops time.
    pub fn pause(&mut self) {
        self.playing = false;
    }

    /// Moves time by seconds.
    pub fn advance(&mut self, seconds: f64) -> Change {
        let time = SceneTime::from_seconds(self.time.seconds() + seconds).unwrap_or(self.time);
        let change = Change { time: time != self.time, ..Change::default() };
        self.time = time;
        change
    }

    /// Takes the scene as it is at the time that is shown, with the changes made so far and the window's size.
    pub fn move_to(&mut self, mut scene: Scene) -> Change {
        let (width, height) = (self.scene.image.width, self.scene.image.height);
        (scene.image.width, scene.image.height) = (width, height);
        let mesh = scene.objects.first().map(|object| Arc::clone(&object.mesh));
        self.loaded = Loaded { mesh_name: self.loaded.mesh_name, mesh, ..Loaded::without_mesh(&scene) };
        // A mesh that stands in goes on to do so.
        if let (Some(_), Some(new), Some(old)) = (self.stand_in, scene.objects.first_mut(), self.scene.objects.first())
        {
            new.mesh = Arc::clone(&old.mesh);
        }
        self.scene = scene;
        Change { moment: true, ..Change::default() }.and(self.make_edits())
    }

    /// The scene to draw.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Replaces the scene by a new state of its file, with the changes made so far and the window's size.
    pub fn reload(&mut self, scene: Scene) -> Change {
        let (width, height) = (self.scene.image.width, self.scene.image.height);
        self.loaded = Loaded::of(&scene);
        self.scene = scene;
        self.stand_in = None;
        (self.scene.image.width, self.scene.image.height) = (width, height);
        let _ = self.make_edits();
        Change::ALL
    }

    /// Sets the size of the picture, in pixels.
    pub fn resize(&mut self, [width, height]: [u32; 2]) {
        (self.scene.image.width, self.scene.image.height) = (width, height);
    }

    /// The options with which `relievo render` draws the same.
    #[must_use]
    pub fn arguments(&self) -> Vec<String> {
        let mut arguments = self.edits.arguments(&self.scene);
        if self.time != SceneTime::default() {
            arguments.extend(["--time".to_owned(), self.time.seconds().to_string()]);
        }
        arguments
    }

    /// Applies a command that changes the scene; other commands change nothing.
    pub fn apply(&mut self, command: Command) -> Change {
        let names: Vec<&str> = SurfaceTechnique::names().collect();
        match command {
            Command::Technique(number) => {
                self.edits.technique = names.get(number).and_then(|name| SurfaceTechnique::from_name(name));
            }
            Command::NextTechnique { back } => {
                let now = self.first_relief().technique.name();
                let at = names.iter().position(|name| *name == now).unwrap_or(0);
                let step = if back { names.len() - 1 } else { 1 };
                self.edits.technique = SurfaceTechnique::from_name(names[(at + step) % names.len()]);
            }
            Command::Raise | Command::Lower => {
                let step = if command == Command::Raise { 1 } else { -1 };
                let [least, most] = HEIGHT_STEPS;
                self.edits.height_steps = (self.edits.height_steps + step).clamp(least, most);
            }
            Command::NextShadow => self.edits.shadow = Some(after(&Shadow::ALL, self.first_relief().shadow)),
            Command::NextEdge => {
                self.edits.edge = Some(after(&Edge::ALL, self.first_relief().edge));
            }
            Command::NextMesh => self.edits.mesh = self.next_mesh(),
            Command::NextLight => {
                self.chosen_light = (self.chosen_light + 1) % self.scene.lights.len().max(1);
                return Change::default();
            }
            Command::ResetView => self.edits.camera = None,
            Command::ResetAll => self.edits = Edits::default(),
            Command::Play => {
                self.playing = !self.playing;
                return Change::default();
            }
            Command::Step { back, second } => {
                let step = if second { 1.0 } else { 1.0 / STEPS_PER_SECOND };
                return self.advance(if back { -step } else { step });
            }
            Command::PrintCommand | Command::Help | Command::Fullscreen | Command::Screenshot | Command::Quit => {
                return Change::default();
            }
        }
        self.make_edits()
    }

    /// Moves the camera.
    pub fn move_camera(&mut self, with: impl FnOnce(&mut Camera)) -> Change {
        let mut camera = self.scene.camera;
        with(&mut camera);
        if camera == self.scene.camera {
            return Change::default();
        }
        self.edits.camera = Some(camera);
        self.scene.camera = camera;
        Change { camera: true, ..Change::default() }
    }

    /// Moves the chosen light, if the scene has one.
    pub fn move_light(&mut self, with: impl FnOnce(&mut LightKind, &Camera)) -> Change {
        let Some(light) = self.scene.lights.get_mut(self.chosen_light) else { return Change::default() };
        let before = light.kind;
        with(&mut light.kind, &self.scene.camera);
        if light.kind == before {
            return Change::default();
        }
        self.edits.lights.insert(self.chosen_light, light.kind);
        Change { lights: true, ..Change::default() }
    }

    /// The chosen light in words, as in "light 1 of 2: spot".
    #[must_use]
    pub fn describe_light(&self) -> String {
        let Some(light) = self.scene.lights.get(self.chosen_light) else {
            return "the scene has no lights".to_owned();
        };
        let kind = light.kind.name();
        format!("light {} of {}: {kind}", self.chosen_light + 1, self.scene.lights.len())
    }

    /// Technique and shadow of the materials in use, as in "relief, shadow soft"; several are told apart by slashes.
    #[must_use]
    pub fn describe_reliefs(&self) -> String {
        let reliefs = self.scene.objects.iter().filter_map(|object| self.scene.materials.get(object.material));
        let words = |word: fn(&Relief) -> &'static str| {
            let mut words: Vec<&str> = Vec::new();
            for material in reliefs.clone() {
                let word = word(&material.relief);
                if !words.contains(&word) {
                    words.push(word);
                }
            }
            words.join("/")
        };
        let mut text =
            format!("{}, shadow {}", words(|relief| relief.technique.name()), words(|relief| relief.shadow.name()));
        if self.edits.edge.is_some() {
            text.push_str(&format!(", edge {}", words(|relief| relief.edge.name())));
        }
        if self.edits.height_steps != 0 {
            text.push_str(&format!(", height ×{:.2}", self.edits.height_factor()));
        }
        text
    }

    /// Relief of the first material, from which cycles start where materials differ.
    fn first_relief(&self) -> Relief {
        self.scene.materials.first().map_or_else(Relief::default, |material| material.relief)
    }

    /// The built-in meshes one after the other, and between the last and the first the scene's own if it is none of them.
    fn next_mesh(&self) -> Option<&'static str> {
        let first = self.scene.objects.first();
        if first.is_some_and(|object| self.scene.materials[object.material].is_mist()) {
            // Mist lies on flat meshes alone.
            return self.edits.mesh;
        }
        let own = self.loaded.mesh_name;
        let now = self.edits.mesh.or(own);
        let next = match now.and_then(|name| SHAPE_NAMES.iter().position(|known| *known == name)) {
            Some(at) if at + 1 < SHAPE_NAMES.len() => Some(SHAPE_NAMES[at + 1]),
            Some(_) if own.is_none() => None,
            _ => Some(SHAPE_NAMES[0]),
        };
        next.filter(|_| next != own)
    }

    /// Brings the scene in line with the edits, and says what became different.
    fn make_edits(&mut self) -> Change {
        let (scene, edits, loaded) = (&mut self.scene, &self.edits, &self.loaded);
        let mut change = Change::default();

        let camera = edits.camera.unwrap_or(loaded.camera);
        change.camera = camera != scene.camera;
        scene.camera = camera;

        let mut lights = loaded.lights.clone();
        for (&index, &kind) in &edits.lights {
            // A light that has become another kind in its file is another light.
            if let Some(light) = lights.get_mut(index)
                && std::mem::discriminant(&light.kind) == std::mem::discriminant(&kind)
            {
                light.kind = kind;
            }
        }
        change.lights = lights != scene.lights;
        scene.lights = lights;
        self.chosen_light = self.chosen_light.min(scene.lights.len().saturating_sub(1));

        let factor = edits.height_factor();
        for (material, &(mut relief, height)) in scene.materials.iter_mut().zip(&loaded.reliefs) {
            // Mist has one technique, its own shadows, and ends where its mesh does.
            if !material.is_mist() {
                relief.technique = edits.technique.unwrap_or(relief.technique);
                relief.shadow = edits.shadow.unwrap_or(relief.shadow);
                relief.edge = edits.edge.unwrap_or(relief.edge);
            }
            let height = match height {
                HeightRange::Scale(scale) => HeightRange::Scale(scale * factor),
                HeightRange::Depth(depth) => HeightRange::Depth(depth * factor),
            };
            change.reliefs |= (material.relief, material.height) != (relief, height);
            (material.relief, material.height) = (relief, height);
        }

        if self.stand_in != edits.mesh {
            let mesh = edits.mesh.and_then(Mesh::shape).map(Arc::new).or_else(|| loaded.mesh.clone());
            if let (Some(object), Some(mesh)) = (scene.objects.first_mut(), mesh) {
                object.mesh = mesh;
                change.scene = true;
            }
            self.stand_in = edits.mesh;
        }
        change
    }
}

/// The element after this one, around.
fn after<T: Copy + PartialEq>(all: &[T], one: T) -> T {
    let at = all.iter().position(|known| *known == one).map_or(0, |at| (at + 1) % all.len());
    all.get(at).copied().unwrap_or(one)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use glam::Vec3;
    use relievo_scene::LoadOptions;

    use super::*;
    use crate::control::camera::orbit;

    const SCENE: &str = r#"
        [[lights]]
        kind = "directional"
        direction = [0, 0, -1]
        [[lights]]
        kind = "point"
        position = [0, 0, 1]
        [materials.wall]
        from = "make:brick-wall"
        height_scale = 0.06
        [materials."a b"]
        from = "make:brick-wall"
        depth = 0.2
        [[objects]]
        mesh = "quad"
        material = "wall"
        [[objects]]
        mesh = "cube"
        material = "a b"
    "#;

    fn load(text: &str, overrides: &[String]) -> Scene {
        let overrides = overrides.iter().map(|text| text.parse().unwrap()).collect();
        let options = LoadOptions { make_size: 16, overrides, ..LoadOptions::default() };
        Scene::parse(text, "s.toml", Path::new(""), &options).unwrap()
    }

    fn state() -> State {
        State::new(load(SCENE, &[]))
    }

    #[test]
    fn techniques_go_round_both_ways_and_by_number() {
        let mut state = state();
        let count = SurfaceTechnique::names().count();
        let name = |state: &State| state.scene().materials[1].relief.technique.name();
        assert_eq!(name(&state), "exact");
        let mut seen = vec![];
        for _ in 0..count {
            assert!(state.apply(Command::NextTechnique { back: false }).reliefs);
            seen.push(name(&state));
        }
        assert_eq!(name(&state), "exact");
        for back in seen.iter().rev().skip(1) {
            let _ = state.apply(Command::NextTechnique { back: true });
            assert_eq!(name(&state), *back);
        }
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), count);
        for (number, expected) in SurfaceTechnique::names().enumerate() {
            let _ = state.apply(Command::Technique(number));
            assert_eq!(name(&state), expected);
        }
    }

    #[test]
    fn heights_go_up_and_down_within_bounds_and_back_to_where_they_were() {
        let mut state = state();
        let heights = |state: &State| {
            let heights = state.scene().materials.iter().map(|material| match material.height {
                HeightRange::Scale(x) | HeightRange::Depth(x) => x,
            });
            heights.collect::<Vec<_>>()
        };
        let start = heights(&state);
        for _ in 0..500 {
            let _ = state.apply(Command::Raise);
        }
        assert_eq!(heights(&state), [0.06 * 16.0, 0.2 * 16.0]);
        assert!(!state.apply(Command::Raise).any());
        for _ in 0..500 {
            let _ = state.apply(Command::Lower);
        }
        assert_eq!(heights(&state), [0.06 / 256.0, 0.2 / 256.0]);
        for _ in 0..64 {
            let _ = state.apply(Command::Raise);
        }
        assert_eq!(heights(&state), start);
    }

    #[test]
    fn shadows_edges_and_meshes_go_round() {
        let mut state = state();
        let before = state.scene().objects[0].mesh.triangles.len();
        for _ in 0..4 {
            assert_eq!(state.apply(Command::NextShadow), Change { reliefs: true, ..Change::default() });
        }
        for _ in 0..3 {
            assert!(state.apply(Command::NextEdge).reliefs);
        }
        let mut seen = vec![];
        for _ in SHAPE_NAMES {
            assert!(state.apply(Command::NextMesh).scene);
            seen.push(state.scene().objects[0].mesh.positions.len());
        }
        assert_eq!(state.scene().objects[0].mesh.triangles.len(), before);
        assert_eq!(state.edits.mesh, None);
        seen.dedup();
        assert!(seen.len() >= 5, "{seen:?}");
        assert_eq!(state.scene().objects[1].mesh.triangles.len(), 12);
    }

    #[test]
    fn another_moment_keeps_the_changes_made_by_hand_and_brings_all_else() {
        let mut state = state();
        for command in [Command::NextMesh, Command::Raise, Command::NextLight] {
            let _ = state.apply(command);
        }
        let _ = state.move_light(|kind, _| *kind = LightKind::Point { position: Vec3::X });
        let _ = state.move_camera(|camera| orbit(camera, [20.0, 0.0]));
        let (camera, mesh) = (state.scene().camera, Arc::clone(&state.scene().objects[0].mesh));
        assert!(state.advance(0.25).time && state.time() == SceneTime::from_seconds(0.25).unwrap());
        let moved = load(
            SCENE,
            &[
                "materials.wall.height_scale=0.12".to_owned(),
                "camera.near=0.5".to_owned(),
                "lights.0.intensity=3".to_owned(),
            ],
        );
        assert!(state.move_to(moved).moment);
        let scene = state.scene();
        assert!(scene.camera == camera && Arc::ptr_eq(&scene.objects[0].mesh, &mesh));
        assert_eq!((scene.lights[0].intensity, scene.lights[1].kind), (3.0, LightKind::Point { position: Vec3::X }));
        let factor = Edits { height_steps: 1, ..Edits::default() }.height_factor();
        assert_eq!(scene.materials[0].height, HeightRange::Scale(0.12 * factor));
        let arguments = state.arguments();
        assert!(arguments.windows(2).any(|pair| pair == ["--time", "0.25"]), "{arguments:?}");
        // Without a change by hand the moment's own camera counts.
        let _ = state.apply(Command::ResetAll);
        assert_eq!(state.scene().camera.near, 0.5);
    }

    #[test]
    fn the_chosen_light_alone_moves() {
        let mut state = state();
        assert_eq!(state.describe_light(), "light 1 of 2: directional");
        let _ = state.apply(Command::NextLight);
        assert_eq!(state.describe_light(), "light 2 of 2: point");
        let change = state.move_light(|light, camera| crate::control::light::drag(light, camera, [30.0, 0.0], 600));
        assert_eq!(change, Change { lights: true, ..Change::default() });
        assert_eq!(state.scene().lights[0], state.loaded.lights[0]);
        assert_ne!(state.scene().lights[1], state.loaded.lights[1]);
        let _ = state.apply(Command::NextLight);
        assert_eq!(state.describe_light(), "light 1 of 2: directional");

        let mut dark = State::new(load("materials.a.from = \"make:brick-wall\"\n[[objects]]\nmesh = \"quad\"", &[]));
        assert!(!dark.apply(Command::NextLight).any());
        assert!(!dark.move_light(|_, _| unreachable!()).any());
        assert_eq!(dark.describe_light(), "the scene has no lights");
    }

    #[test]
    fn resetting_the_view_keeps_the_rest_and_resetting_all_keeps_nothing() {
        let mut state = state();
        let _ = state.move_camera(|camera| orbit(camera, [10.0, 10.0]));
        let _ = state.apply(Command::Raise);
        assert_eq!(state.apply(Command::ResetView), Change { camera: true, ..Change::default() });
        assert_eq!((state.scene().camera, state.edits.height_steps), (state.loaded.camera, 1));
        let _ = state.apply(Command::NextMesh);
        let change = state.apply(Command::ResetAll);
        assert_eq!(change, Change { reliefs: true, scene: true, ..Change::default() });
        assert_eq!(state.edits, Edits::default());
    }

    #[test]
    fn changes_outlive_the_file_they_were_made_on() {
        let mut state = state();
        let _ = state.apply(Command::Technique(5));
        let _ = state.apply(Command::Raise);
        let _ = state.move_camera(|camera| orbit(camera, [10.0, 0.0]));
        let camera = state.scene().camera;
        let _ = state.apply(Command::NextLight);
        let fewer = load(
            "materials.a.from = \"make:toy-box\"\nmaterials.a.height_scale = 0.5\n[[objects]]\nmesh = \"torus\"",
            &[],
        );
        assert_eq!(state.reload(fewer), Change::ALL);
        assert_eq!(state.scene().camera, camera);
        assert_eq!(state.scene().materials[0].relief.technique.name(), "steep");
        assert_eq!(state.scene().materials[0].height, HeightRange::Scale(0.5 * 2f32.powf(0.125)));
        assert_eq!(state.describe_light(), "the scene has no lights");
    }

    #[test]
    fn the_arguments_make_the_same_scene_of_the_same_file() {
        let mut state = state();
        for command in [
            Command::Technique(7),
            Command::NextShadow,
            Command::NextEdge,
            Command::Raise,
            Command::NextMesh,
            Command::NextMesh,
        ] {
            let _ = state.apply(command);
        }
        let _ = state.move_camera(|camera| orbit(camera, [123.0, -45.0]));
        let _ = state.move_light(|light, camera| crate::control::light::drag(light, camera, [30.0, 9.0], 600));
        state.resize([123, 45]);

        let arguments = state.arguments();
        let pairs: Vec<(&str, &str)> = arguments.chunks(2).map(|pair| (pair[0].as_str(), pair[1].as_str())).collect();
        let get = |name| pairs.iter().find(|(known, _)| *known == name).unwrap().1;
        assert_eq!((get("--size"), get("--technique"), get("--shadow")), ("123x45", "relief", "hard"));
        let sets: Vec<String> = pairs.iter().filter(|(n, _)| *n == "--set").map(|(_, set)| (*set).to_owned()).collect();
        let again = load(SCENE, &sets);
        let edited = state.scene();
        assert_eq!(again.camera, edited.camera);
        assert_eq!(again.objects[0].mesh, edited.objects[0].mesh);
        for (again, edited) in again.materials.iter().zip(&edited.materials) {
            assert_eq!((again.height, again.relief.edge), (edited.height, edited.relief.edge));
        }
        let direction = |scene: &Scene| match scene.lights[0].kind {
            LightKind::Directional { direction } => direction,
            _ => panic!(),
        };
        assert!(direction(&again).distance(direction(edited)) < 1e-6);
    }
}
