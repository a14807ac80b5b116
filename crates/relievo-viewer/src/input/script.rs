//! Input from a file, for tests.

use std::collections::VecDeque;
use std::path::PathBuf;

use relievo_scene::ImageSettings;
use thiserror::Error;

use super::event::{Button, Input, Key, Modifiers};

/// The time between two frames of a script, seconds.
pub(crate) const FRAME_SECONDS: f32 = 1.0 / 60.0;

/// A drag is this many moves.
const DRAG_FRAMES: usize = 4;

/// Most repetitions of a step, so that a typing error does not draw for days.
const MAX_COUNT: u32 = 1_000_000;

/// The steps of a script, as they are explained to users.
pub const SCRIPT_STEPS: &str = include_str!("script_steps.txt").trim_ascii_end();

/// Input from a file, a line per step:
///
#[doc = "```text"]
#[doc = include_str!("script_steps.txt")]
#[doc = "```"]
///
/// Empty lines and what follows a `#` are skipped. Every step but `title` and `quit` draws at least one frame. Keys have
/// the names of [`Key::from_name`]. Time goes by 1/60 s per frame, however long it takes: a script does the same each time.
#[derive(Clone, Debug, PartialEq)]
pub struct Script {
    steps: Vec<(usize, Step)>,
}

/// One line.
#[derive(Clone, Debug, PartialEq)]
enum Step {
    Key { key: Key, modifiers: Modifiers, times: u32 },
    Hold { key: Key, frames: u32 },
    Drag { button: Button, modifiers: Modifiers, pixels: [f32; 2] },
    Wheel { modifiers: Modifiers, lines: f32 },
    Frames(u32),
    Other(Action),
}

/// An action of a script.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Action {
    Input(Input),
    Frame,
    Resize([u32; 2]),
    Screenshot(PathBuf),
    Title,
    LoseDevice,
    Quit,
}

/// Error of a script that cannot be read.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("line {line}: {message}")]
pub struct ScriptError {
    /// Line number, from 1.
    pub line: usize,
    /// Text of the error.
    pub message: String,
}

impl Script {
    /// Reads a script.
    ///
    /// # Errors
    /// The first line that is none of those above.
    pub fn parse(text: &str) -> Result<Self, ScriptError> {
        let mut steps = Vec::new();
        for (number, line) in text.lines().enumerate() {
            let line = line.split('#').next().unwrap_or_default();
            let words: Vec<&str> = line.split_whitespace().collect();
            let Some((&word, rest)) = words.split_first() else { continue };
            let step = step(word, rest).map_err(|message| ScriptError { line: number + 1, message })?;
            steps.push((number + 1, step));
        }
        Ok(Self { steps })
    }
}

fn step(word: &str, rest: &[&str]) -> Result<Step, String> {
    let usage = |usage: &str| Err(format!("expected {usage}"));
    Ok(match (word, rest) {
        ("key", [name, times @ ..]) if times.len() < 2 => {
            let (modifiers, name) = modifiers(name);
            let times = times.first().map_or(Ok(1), |times| count(times))?;
            Step::Key { key: key(name)?, modifiers, times }
        }
        ("key", _) => return usage("key NAME, or key NAME TIMES, as in key E 3"),
        ("hold", [name, frames]) => Step::Hold { key: key(name)?, frames: count(frames)? },
        ("hold", _) => return usage("hold NAME FRAMES, as in hold W 30"),
        ("drag", [button, x, y]) => {
            let (modifiers, button) = modifiers(button);
            let button = match button {
                "left" => Button::Left,
                "middle" => Button::Middle,
                "right" => Button::Right,
                _ => return Err(format!("\"{button}\" is not a button: left, middle or right")),
            };
            Step::Drag { button, modifiers, pixels: [number(x)?, number(y)?] }
        }
        ("drag", _) => return usage("drag BUTTON X Y, as in drag left 100 40"),
        ("wheel", [lines]) => {
            let (modifiers, lines) = modifiers(lines);
            Step::Wheel { modifiers, lines: number(lines)? }
        }
        ("wheel", _) => return usage("wheel LINES, as in wheel -2"),
        ("resize", [size]) => Step::Other(Action::Resize(window_size(size)?)),
        ("resize", _) => return usage("resize WIDTHxHEIGHT, as in resize 640x480"),
        ("frames", [frames]) => Step::Frames(count(frames)?),
        ("frames", _) => return usage("frames N, as in frames 10"),
        ("screenshot", [file]) if file.to_lowercase().ends_with(".png") => {
            Step::Other(Action::Screenshot(PathBuf::from(file)))
        }
        ("screenshot", _) => return usage("screenshot FILE.png, a name without spaces that ends in .png"),
        ("title", []) => Step::Other(Action::Title),
        ("lose-device", []) => Step::Other(Action::LoseDevice),
        ("quit", []) => Step::Other(Action::Quit),
        ("title" | "lose-device" | "quit", _) => return Err(format!("{word} stands alone")),
        _ => {
            let steps = "key, hold, drag, wheel, resize, frames, screenshot, title, lose-device or quit";
            return Err(format!("\"{word}\" is not a step: {steps}"));
        }
    })
}

/// `shift+` and `ctrl+` before a word, and the word.
fn modifiers(mut word: &str) -> (Modifiers, &str) {
    let mut modifiers = Modifiers::default();
    loop {
        if let Some(rest) = word.strip_prefix("shift+") {
            (modifiers.shift, word) = (true, rest);
        } else if let Some(rest) = word.strip_prefix("ctrl+") {
            (modifiers.ctrl, word) = (true, rest);
        } else {
            return (modifiers, word);
        }
    }
}

fn key(name: &str) -> Result<Key, String> {
    Key::from_name(name)
        .ok_or_else(|| format!("\"{name}\" is not a key: A to Z, 0 to 9, F1 to F12, Home, Backspace, Escape, Space, Comma, Period, Left or Right"))
}

fn count(text: &str) -> Result<u32, String> {
    let count = text.parse().ok().filter(|n| (1..=MAX_COUNT).contains(n));
    count.ok_or_else(|| format!("\"{text}\" is not a whole number from 1 to {MAX_COUNT}"))
}

fn number(text: &str) -> Result<f32, String> {
    let number = text.parse().ok().filter(|x: &f32| x.abs() <= 1e6);
    number.ok_or_else(|| format!("\"{text}\" is not a number from -1000000 to 1000000"))
}

fn window_size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| text.parse().ok().filter(|n| (1..=ImageSettings::MAX_SIDE).contains(n));
    let sides = text.split_once('x').and_then(|(width, height)| Some([side(width)?, side(height)?]));
    sides.ok_or_else(|| {
        format!("\"{text}\" is not WIDTHxHEIGHT, each from 1 to {}, as in 640x480", ImageSettings::MAX_SIDE)
    })
}

/// A script being played.
#[derive(Debug)]
pub(crate) struct Player {
    steps: VecDeque<(usize, Step)>,
    pending: VecDeque<Action>,
    line: usize,
}

impl Player {
    pub(crate) fn new(script: Script) -> Self {
        Self { steps: script.steps.into(), pending: VecDeque::new(), line: 0 }
    }

    /// Begins with a size of the window.
    pub(crate) fn resize_first(&mut self, size: [u32; 2]) {
        self.pending.push_front(Action::Resize(size));
    }

    /// True if nothing is left to do.
    pub(crate) fn is_over(&self) -> bool {
        self.steps.is_empty() && self.pending.is_empty()
    }

    /// The line that is being played, from 1.
    pub(crate) fn line(&self) -> usize {
        self.line
    }

    /// The next action; `None` at the end.
    pub(crate) fn next(&mut self) -> Option<Action> {
        while self.pending.is_empty() {
            let (line, step) = self.steps.pop_front()?;
            self.line = line;
            self.begin(step);
        }
        self.pending.pop_front()
    }

    /// Takes a step apart; long ones frame by frame, so that a million frames take no memory.
    fn begin(&mut self, step: Step) {
        let press = |key, pressed| Action::Input(Input::Key { key, pressed, repeat: false });
        let pending = &mut self.pending;
        let mut go_on = None;
        match step {
            Step::Key { key, modifiers, times } => {
                pending.extend([Action::Input(Input::Modifiers(modifiers)), press(key, true), press(key, false)]);
                pending.extend([Action::Input(Input::Modifiers(Modifiers::default())), Action::Frame]);
                go_on = (times > 1).then(|| Step::Key { key, modifiers, times: times - 1 });
            }
            Step::Hold { key, frames } => {
                pending.push_back(press(key, true));
                if frames > 1 {
                    go_on = Some(Step::Hold { key, frames: frames - 1 });
                } else {
                    // The last frame still sees it: keys walk up to their release.
                    pending.push_back(press(key, false));
                }
                pending.push_back(Action::Frame);
            }
            Step::Drag { button, modifiers, pixels } => {
                pending.push_back(Action::Input(Input::Modifiers(modifiers)));
                pending.push_back(Action::Input(Input::Button { button, pressed: true }));
                for _ in 0..DRAG_FRAMES {
                    let part = pixels.map(|x| x / DRAG_FRAMES as f32);
                    pending.extend([Action::Input(Input::Moved(part)), Action::Frame]);
                }
                pending.push_back(Action::Input(Input::Button { button, pressed: false }));
                pending.push_back(Action::Input(Input::Modifiers(Modifiers::default())));
            }
            Step::Wheel { modifiers, lines } => {
                pending.extend([Action::Input(Input::Modifiers(modifiers)), Action::Input(Input::Wheel(lines))]);
                pending.extend([Action::Frame, Action::Input(Input::Modifiers(Modifiers::default()))]);
            }
            Step::Frames(frames) => {
                pending.push_back(Action::Frame);
                go_on = (frames > 1).then(|| Step::Frames(frames - 1));
            }
            // What is shown from now on is of the new size, or without the device.
            Step::Other(action @ (Action::Resize(_) | Action::LoseDevice)) => pending.extend([action, Action::Frame]),
            // What is shown now, not what was.
            Step::Other(action @ Action::Screenshot(_)) => pending.extend([Action::Frame, action]),
            Step::Other(action) => pending.push_back(action),
        }
        if let Some(step) = go_on {
            self.steps.push_front((self.line, step));
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn actions(text: &str) -> Vec<Action> {
        let mut player = Player::new(Script::parse(text).unwrap());
        std::iter::from_fn(|| player.next()).collect()
    }

    fn frames(text: &str) -> usize {
        actions(text).iter().filter(|action| **action == Action::Frame).count()
    }

    #[test]
    fn every_step_draws_as_many_frames_as_it_says() {
        assert_eq!(frames("key E 3"), 3);
        assert_eq!(frames("hold W 30"), 30);
        assert_eq!(frames("drag left 100 40"), DRAG_FRAMES);
        assert_eq!(frames("wheel -2\nresize 640x480\n\nframes 10 # comment\n# screenshot x.png"), 12);
        assert_eq!(frames("title\nquit"), 0);
        assert_eq!(frames(""), 0);
    }

    #[test]
    fn a_drag_moves_by_what_it_says_with_its_button_held() {
        let actions = actions("drag ctrl+right 100 -40");
        let ctrl = Modifiers { ctrl: true, shift: false };
        assert_eq!(actions[0], Action::Input(Input::Modifiers(ctrl)));
        assert_eq!(actions[1], Action::Input(Input::Button { button: Button::Right, pressed: true }));
        let moved = actions.iter().fold([0.0, 0.0], |[x, y], action| match action {
            Action::Input(Input::Moved([dx, dy])) => [x + dx, y + dy],
            _ => [x, y],
        });
        assert_eq!(moved, [100.0, -40.0]);
        assert_eq!(actions.last(), Some(&Action::Input(Input::Modifiers(Modifiers::default()))));
    }

    #[test]
    fn a_held_key_goes_down_again_and_again_and_up_once() {
        let held = actions("hold W 3");
        let ups = held.iter().filter(|action| matches!(action, Action::Input(Input::Key { pressed: false, .. })));
        assert_eq!(ups.count(), 1);
    }

    #[test]
    fn lines_that_say_nothing_known_are_refused_by_number() {
        for (line, expected) in [
            ("jump", "\"jump\" is not a step"),
            ("key", "expected key NAME"),
            ("key E 3 4", "expected key NAME"),
            ("key Enter", "\"Enter\" is not a key"),
            ("key E 0", "\"0\" is not a whole number"),
            ("key E 1000001", "from 1 to 1000000"),
            ("hold W", "expected hold NAME FRAMES"),
            ("drag up 1 2", "\"up\" is not a button"),
            ("drag left 1", "expected drag BUTTON X Y"),
            ("drag left 1 nan", "\"nan\" is not a number"),
            ("wheel inf", "\"inf\" is not a number"),
            ("resize 0x5", "\"0x5\" is not WIDTHxHEIGHT"),
            ("resize 640", "\"640\" is not WIDTHxHEIGHT"),
            ("resize 640x99999", "each from 1 to 16384"),
            ("frames -1", "\"-1\" is not a whole number"),
            ("screenshot out.jpg", "ends in .png"),
            ("screenshot", "expected screenshot FILE.png"),
            ("quit now", "quit stands alone"),
        ] {
            let error = Script::parse(&format!("# first\nframes 1\n{line}\nquit")).unwrap_err();
            assert!(error.message.contains(expected), "{line}: {error}");
            assert_eq!(error.line, 3, "{line}");
        }
    }

    #[test]
    fn the_documentation_has_every_step_and_every_key_of_the_help() {
        let documentation = include_str!("../../../../docs/viewer.md");
        assert!(documentation.contains(SCRIPT_STEPS));
        for line in SCRIPT_STEPS.lines() {
            let word = line.split(' ').next().unwrap();
            assert!(!matches!(step(word, &["?"; 9]), Err(text) if text.contains("is not a step")), "{word}");
        }
        for name in
            relievo_scene::SurfaceTechnique::names().chain(relievo_march::Shadow::ALL.map(relievo_march::Shadow::name))
        {
            assert!(documentation.contains(&format!("`{name}`")), "{name}");
        }
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_refused(text in "(key|hold|drag|wheel|resize|frames|[a-zé+ ]{0,9})( [-a-zA-Z0-9+.x#é]{0,9}){0,4}\n?") {
            if let Err(error) = Script::parse(&text) {
                prop_assert!(error.line == 1 && !error.message.is_empty());
            }
        }
    }
}
