//! Changes made to a scene in the window, and the options of `relievo render` for the same.

use std::collections::BTreeMap;

use glam::Vec3;
use relievo_march::Shadow;
use relievo_scene::{Camera, Edge, HeightRange, LightKind, Scene, SurfaceTechnique};

/// Every step of the height scale is a factor of the eighth root of 2.
pub(crate) const STEPS_PER_DOUBLING: i32 = 8;

/// Steps from the scene's own height scale: from a 256th to 16 times.
pub(crate) const HEIGHT_STEPS: [i32; 2] = [-8 * STEPS_PER_DOUBLING, 4 * STEPS_PER_DOUBLING];

/// Changes; what is `None` is as the scene has it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Edits {
    pub(crate) camera: Option<Camera>,
    pub(crate) technique: Option<SurfaceTechnique>,
    pub(crate) shadow: Option<Shadow>,
    pub(crate) edge: Option<Edge>,
    /// Within [`HEIGHT_STEPS`].
    pub(crate) height_steps: i32,
    /// A name of `SHAPE_NAMES`.
    pub(crate) mesh: Option<&'static str>,
    /// Lights that were moved, by their index.
    pub(crate) lights: BTreeMap<usize, LightKind>,
}

impl Edits {
    /// The factor on the scene's own heights; exactly 1 without steps, so that up and down again is where it was.
    pub(crate) fn height_factor(&self) -> f32 {
        (f64::from(self.height_steps) / f64::from(STEPS_PER_DOUBLING)).exp2() as f32
    }

    /// The options with which `relievo render` draws `scene`, which has these edits, as the window does.
    pub(crate) fn arguments(&self, scene: &Scene) -> Vec<String> {
        let mut arguments = Vec::new();
        let mut option = |name: &str, value: String| arguments.extend([name.to_owned(), value]);
        option("--size", format!("{}x{}", scene.image.width, scene.image.height));
        if let Some(technique) = self.technique {
            option("--technique", technique.name().to_owned());
        }
        if let Some(shadow) = self.shadow {
            option("--shadow", shadow.name().to_owned());
        }
        for material in &scene.materials {
            let name = if material.name.chars().all(|c| c.is_alphanumeric() || "-_".contains(c)) {
                material.name.clone()
            } else {
                format!("\"{}\"", material.name)
            };
            if self.height_steps != 0 && material.maps.height.is_some() {
                let (key, value) = match material.height {
                    HeightRange::Scale(scale) => ("height_scale", scale),
                    HeightRange::Depth(depth) => ("depth", depth),
                };
                option("--set", format!("materials.{name}.{key}={value}"));
            }
            if let Some(edge) = self.edge.filter(|_| material.maps.height.is_some()) {
                option("--set", format!("materials.{name}.relief.edge={}", edge.name()));
            }
        }
        if let Some(mesh) = self.mesh {
            option("--set", format!("objects.0.mesh={mesh}"));
        }
        if let Some(camera) = self.camera {
            option("--set", format!("camera.position={}", numbers(camera.position)));
            option("--set", format!("camera.target={}", numbers(camera.target)));
            if camera.is_orthographic() {
                option("--set", format!("camera.size={}", camera.size));
            }
        }
        for (index, light) in self.lights.iter().filter(|&(&index, _)| index < scene.lights.len()) {
            if let Some(position) = light.position() {
                option("--set", format!("lights.{index}.position={}", numbers(position)));
            }
            if let Some(direction) = light.direction() {
                option("--set", format!("lights.{index}.direction={}", numbers(direction)));
            }
        }
        arguments
    }
}

/// Writes numbers as in scene files, without spaces. f32 shows as many digits as it takes to read the same number again.
fn numbers(v: Vec3) -> String {
    format!("[{},{},{}]", v.x, v.y, v.z)
}

/// A command with changes, which stand for what it says of the same options already.
pub(crate) fn with_changes(command: &[String], changes: Vec<String>) -> Vec<String> {
    let mut words = Vec::new();
    let mut rest = command.iter();
    while let Some(word) = rest.next() {
        // What is repeatable is overridden by what comes later.
        if word.starts_with("--") && word != "--set" && changes.contains(word) {
            rest.next();
        } else {
            words.push(word.clone());
        }
    }
    words.extend(changes);
    words
}

/// A command as a shell takes it.
pub(crate) fn shell_line(words: &[String]) -> String {
    let plain = |word: &str| !word.is_empty() && word.chars().all(|c| c.is_alphanumeric() || "-_./=,:+".contains(c));
    let quoted = |word: &str| if plain(word) { word.to_owned() } else { format!("'{}'", word.replace('\'', r"'\''")) };
    words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn height_steps_are_bounded_factors_and_none_changes_nothing() {
        let factor = |height_steps| Edits { height_steps, ..Edits::default() }.height_factor();
        assert_eq!((factor(0), factor(8), factor(-8)), (1.0, 2.0, 0.5));
        assert_eq!(HEIGHT_STEPS.map(factor), [1.0 / 256.0, 16.0]);
    }

    #[test]
    fn an_option_is_changed_and_not_said_twice() {
        let words = |text: &str| text.split(' ').map(str::to_owned).collect::<Vec<_>>();
        let command = words("relievo render --shadow soft s.toml --set a=1");
        let changed = with_changes(&command, words("--shadow hard --set b=2"));
        assert_eq!(changed, words("relievo render s.toml --set a=1 --shadow hard --set b=2"));
    }

    #[test]
    fn words_that_a_shell_would_take_apart_are_quoted() {
        let words = ["relievo", "--set", "camera.position=[1,2,3]", "it's", "", "a b"].map(str::to_owned);
        assert_eq!(shell_line(&words), r"relievo --set 'camera.position=[1,2,3]' 'it'\''s' '' 'a b'");
    }
}
