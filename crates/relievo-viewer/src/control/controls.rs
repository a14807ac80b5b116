//! Changes that follow from input: the same for a window's events and for a script's.

use glam::Vec3;

use crate::control::camera::{orbit, pan, walk, zoom};
use crate::control::commands::{Command, command, scrub_direction, walk_direction};
use crate::control::light;
use crate::input::event::{Button, Input, Key, Modifiers};
use crate::state::scene_state::{Change, State};

/// Walking covers this part of the distance to the target per second.
const WALK_PER_SECOND: f32 = 0.8;

/// Scrubbing goes through this many seconds of the scene per second.
const SCRUB_SPEED: f32 = 2.0;

/// A pause between two frames counts as no more than this, seconds: nobody is thrown through a wall.
const LONGEST_FRAME: f32 = 0.1;

/// Keys and buttons that are held.
#[derive(Debug, Default)]
pub struct Controls {
    modifiers: Modifiers,
    button: Option<Button>,
    walking: Vec<Held>,
}

/// A key that walks. One that was let go walks once more: a tap between two frames is not lost, and neither is a key that
/// the system lets go and presses again while it is held.
#[derive(Clone, Copy, Debug)]
struct Held {
    key: Key,
    released: bool,
}

impl Controls {
    /// Applies one input. Returns the change, and the command that it was, for those that do more than change the scene.
    pub fn apply(&mut self, input: Input, state: &mut State) -> (Change, Option<Command>) {
        let nothing = Change::default();
        match input {
            Input::Key { key, pressed, repeat } => return self.take_key(key, pressed, repeat, state),
            Input::Modifiers(modifiers) => self.modifiers = modifiers,
            Input::Button { button, pressed: true } => self.button = Some(button),
            Input::Button { button, pressed: false } => self.button = self.button.filter(|held| *held != button),
            Input::Moved(pixels) => return (self.drag(pixels, state), None),
            Input::Wheel(lines) if self.modifiers.ctrl => {
                return (state.move_light(|kind, camera| light::push(kind, camera, lines)), None);
            }
            Input::Wheel(lines) => return (state.move_camera(|camera| zoom(camera, lines)), None),
            Input::FocusLost => *self = Self::default(),
        }
        (nothing, None)
    }

    /// True while a held key moves the camera or time.
    #[must_use]
    pub fn is_moving(&self) -> bool {
        !self.walking.is_empty()
    }

    /// Advances time by seconds, while keys are held.
    pub fn tick(&mut self, seconds: f32, state: &mut State) -> Change {
        let seconds = seconds.max(0.0).min(LONGEST_FRAME);
        let scrubbed: f32 = self.walking.iter().filter_map(|held| scrub_direction(held.key)).sum();
        let played = if state.is_playing() { seconds } else { 0.0 };
        let time = state.advance(f64::from(scrubbed * SCRUB_SPEED * seconds + played));
        let directions = self.walking.iter().filter_map(|held| walk_direction(held.key)).map(Vec3::from);
        let offset = directions.sum::<Vec3>().normalize_or_zero() * WALK_PER_SECOND * seconds;
        self.walking.retain(|held| !held.released);
        state.move_camera(|camera| walk(camera, offset)).and(time)
    }

    fn take_key(&mut self, key: Key, pressed: bool, repeat: bool, state: &mut State) -> (Change, Option<Command>) {
        if let Some(held) = self.walking.iter_mut().find(|held| held.key == key) {
            held.released = !pressed;
            return (Change::default(), None);
        }
        // With Ctrl held, letters are left to the system and to what may come.
        if !pressed || self.modifiers.ctrl {
            return (Change::default(), None);
        }
        if walk_direction(key).is_some() || scrub_direction(key).is_some() {
            self.walking.push(Held { key, released: false });
        }
        let asked = command(key, self.modifiers.shift);
        let asked = asked
            .filter(|command| !repeat || matches!(command, Command::Raise | Command::Lower | Command::Step { .. }));
        let change = asked.map_or_else(Change::default, |command| state.apply(command));
        (change, asked)
    }

    fn drag(&self, pixels: [f32; 2], state: &mut State) -> Change {
        let height = state.scene().image.height;
        match (self.button, self.modifiers.ctrl) {
            (None, _) => Change::default(),
            (Some(Button::Left), false) => state.move_camera(|camera| orbit(camera, pixels)),
            (Some(_), false) => state.move_camera(|camera| pan(camera, pixels, height)),
            (Some(Button::Left), true) => state.move_light(|kind, camera| light::drag(kind, camera, pixels, height)),
            (Some(_), true) => state.move_light(|kind, camera| light::rotate(kind, camera, pixels)),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use relievo_scene::{LoadOptions, Scene};

    use super::*;

    fn state() -> State {
        let text = "lights = [{ kind = \"point\", position = [0, 0, 1] }]\n\
                    materials.a.from = \"make:brick-wall\"\n\
                    [[objects]]\nmesh = \"quad\"";
        let options = LoadOptions { make_size: 16, ..LoadOptions::default() };
        State::new(Scene::parse(text, "s.toml", Path::new(""), &options).unwrap())
    }

    fn key(name: &str, pressed: bool) -> Input {
        Input::Key { key: Key::from_name(name).unwrap(), pressed, repeat: false }
    }

    #[test]
    fn buttons_and_ctrl_say_what_a_drag_moves() {
        let drag = |button, ctrl| {
            let (mut controls, mut state) = (Controls::default(), state());
            let _ = controls.apply(Input::Modifiers(Modifiers { ctrl, ..Modifiers::default() }), &mut state);
            if let Some(button) = button {
                let _ = controls.apply(Input::Button { button, pressed: true }, &mut state);
            }
            let (change, command) = controls.apply(Input::Moved([20.0, 10.0]), &mut state);
            assert_eq!(command, None);
            (change.camera, change.lights, state.scene().camera.target != Vec3::ZERO)
        };
        assert_eq!(drag(None, false), (false, false, false));
        assert_eq!(drag(Some(Button::Left), false), (true, false, false));
        assert_eq!(drag(Some(Button::Right), false), (true, false, true));
        assert_eq!(drag(Some(Button::Middle), false), (true, false, true));
        assert_eq!(drag(Some(Button::Left), true), (false, true, false));
        assert_eq!(drag(Some(Button::Right), true), (false, false, false)); // a point light does not turn
    }

    #[test]
    fn walking_goes_on_while_keys_are_held_and_not_after() {
        let (mut controls, mut state) = (Controls::default(), state());
        assert!(!controls.tick(1.0, &mut state).any());
        let _ = controls.apply(key("W", true), &mut state);
        assert!(controls.is_moving() && controls.tick(1.0 / 60.0, &mut state).camera);
        let after_one = state.scene().camera.position.z;
        assert!((3.0 - after_one - 3.0 * WALK_PER_SECOND / 60.0).abs() < 1e-5, "{after_one}");
        let _ = controls.tick(1e9, &mut state);
        assert!(after_one - state.scene().camera.position.z < 0.3, "a long pause is no long way");
        let _ = controls.apply(key("W", false), &mut state);
        assert!(controls.tick(0.01, &mut state).camera, "the time up to the release");
        assert!(!controls.is_moving() && !controls.tick(0.01, &mut state).any());
        for pressed in [true, false] {
            let _ = controls.apply(key("S", pressed), &mut state);
        }
        assert!(controls.tick(0.01, &mut state).camera && !controls.is_moving(), "a tap moves");
        let _ = controls.apply(key("D", true), &mut state);
        let _ = controls.apply(Input::FocusLost, &mut state);
        assert!(!controls.is_moving() && !controls.tick(f32::NAN, &mut state).any());
    }

    #[test]
    fn time_plays_pauses_steps_and_is_scrubbed() {
        let (mut controls, mut state) = (Controls::default(), state());
        let seconds = |state: &State| (state.time().seconds() * 1000.0).round();
        let tap = |controls: &mut Controls, state: &mut State, name| {
            let changed = controls.apply(key(name, true), state).0;
            let _ = controls.apply(key(name, false), state);
            changed
        };
        assert!(!controls.tick(0.05, &mut state).time);
        let _ = tap(&mut controls, &mut state, "Space");
        assert!(state.is_playing() && controls.tick(0.05, &mut state).time && seconds(&state) == 50.0);
        let _ = tap(&mut controls, &mut state, "Space");
        assert!(!state.is_playing() && !controls.tick(0.05, &mut state).time);
        for _ in 0..3 {
            assert!(tap(&mut controls, &mut state, "Period").time);
        }
        assert_eq!(seconds(&state), 150.0);
        let _ = controls.apply(Input::Modifiers(Modifiers { shift: true, ..Modifiers::default() }), &mut state);
        let _ = tap(&mut controls, &mut state, "Comma");
        assert_eq!(seconds(&state), -850.0);
        let _ = controls.apply(Input::Modifiers(Modifiers::default()), &mut state);
        let _ = controls.apply(key("Right", true), &mut state);
        assert!(controls.is_moving() && controls.tick(0.1, &mut state).time && seconds(&state) == -650.0);
        let _ = controls.apply(key("Right", false), &mut state);
        let _ = controls.tick(0.0, &mut state);
        assert!(!controls.is_moving() && !controls.tick(0.1, &mut state).any());
    }

    #[test]
    fn opposite_keys_hold_each_other() {
        let (mut controls, mut state) = (Controls::default(), state());
        for name in ["A", "D"] {
            let _ = controls.apply(key(name, true), &mut state);
        }
        assert!(!controls.tick(0.05, &mut state).any());
    }

    #[test]
    fn a_held_key_repeats_heights_alone() {
        let (mut controls, mut state) = (Controls::default(), state());
        let held = |name| Input::Key { key: Key::from_name(name).unwrap(), pressed: true, repeat: true };
        assert!(controls.apply(held("E"), &mut state).0.reliefs);
        for name in ["T", "O", "M", "F12", "Escape"] {
            assert_eq!(controls.apply(held(name), &mut state), (Change::default(), None), "{name}");
        }
        assert_eq!(controls.apply(key("Escape", true), &mut state).1, Some(Command::Quit));
    }

    #[test]
    fn the_wheel_zooms_and_with_ctrl_pushes_the_light() {
        let (mut controls, mut state) = (Controls::default(), state());
        assert!(controls.apply(Input::Wheel(1.0), &mut state).0.camera);
        let _ = controls.apply(Input::Modifiers(Modifiers { ctrl: true, shift: false }), &mut state);
        assert!(controls.apply(Input::Wheel(1.0), &mut state).0.lights);
    }
}
