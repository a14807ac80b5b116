//! Meaning of the keys: one table, which the window, its help and the documentation share.

use relievo_scene::SurfaceTechnique;

use crate::input::event::Key;

/// An action that a key asks for, once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Command {
    /// Draw with the technique that has this number in [`SurfaceTechnique::names`].
    Technique(usize),
    /// The next technique, or the one before.
    NextTechnique {
        /// The one before.
        back: bool,
    },
    /// Higher relief, by one step.
    Raise,
    /// Lower relief, by one step.
    Lower,
    /// The next kind of shadow.
    NextShadow,
    /// The next edge mode.
    NextEdge,
    /// The next mesh for the scene's first object.
    NextMesh,
    /// The next light, for moving it.
    NextLight,
    /// The scene's own camera.
    ResetView,
    /// Everything as the scene file has it.
    ResetAll,
    /// Play, or pause.
    Play,
    /// The next frame of 1/30 s, or the one before.
    Step {
        /// The one before.
        back: bool,
        /// A whole second.
        second: bool,
    },
    /// Print the command that draws this picture.
    PrintCommand,
    /// Print the keys.
    Help,
    /// Fullscreen on or off.
    Fullscreen,
    /// Write a picture.
    Screenshot,
    /// Close the window.
    Quit,
}

/// A line of the help.
pub(crate) struct Line {
    pub(crate) keys: &'static str,
    pub(crate) does: &'static str,
}

const fn line(keys: &'static str, does: &'static str) -> Line {
    Line { keys, does }
}

/// Actions of mouse and keys. Techniques have lines of their own: see [`help`].
pub(crate) const LINES: [Line; 21] = [
    line("left drag", "turn around the target"),
    line("right or middle drag", "move in the picture's plane"),
    line("wheel", "nearer to the target or away from it"),
    line("W A S D", "walk forward, left, backward, right"),
    line("R, F", "move up, down"),
    line("Q, E", "lower, raise the relief of every material"),
    line("T, Shift+T", "next, previous technique"),
    line("O", "next shadow: none, hard, soft, exact"),
    line("G", "next edge: clip, wrap, clamp"),
    line("M", "next mesh for the first object"),
    line("L", "choose the next light"),
    line("Ctrl + left drag", "move the chosen light; turn it if it is directional"),
    line("Ctrl + right drag", "turn the chosen light if it is a spot or directional"),
    line("Ctrl + wheel", "push the chosen light away, or pull it nearer"),
    line("Home, Backspace", "the scene's own view; with Shift, all as the scene has it"),
    line("Space", "play the scene's time; pause"),
    line(", .", "one frame back, forward: 1/30 s; Shift: one second"),
    line("Left, Right", "go back and forward in time while held"),
    line("P", "print the command that draws this picture"),
    line("F11, F12", "fullscreen; screenshot"),
    line("H or F1, Escape", "this help; quit"),
];

/// The command of a key that goes down, if it has one. Keys that move the camera while they are held are not here.
#[must_use]
pub fn command(key: Key, shift: bool) -> Option<Command> {
    Some(match key {
        Key::Digit(digit) => {
            // 1 to 9 and 0 are the first ten, with Shift the next ten.
            let number = (usize::from(digit) + 9) % 10 + if shift { 10 } else { 0 };
            return (number < SurfaceTechnique::names().count()).then_some(Command::Technique(number));
        }
        Key::Letter('Q') => Command::Lower,
        Key::Letter('E') => Command::Raise,
        Key::Letter('T') => Command::NextTechnique { back: shift },
        Key::Letter('O') => Command::NextShadow,
        Key::Letter('G') => Command::NextEdge,
        Key::Letter('M') => Command::NextMesh,
        Key::Letter('L') => Command::NextLight,
        Key::Space => Command::Play,
        Key::Comma => Command::Step { back: true, second: shift },
        Key::Period => Command::Step { back: false, second: shift },
        Key::Letter('P') => Command::PrintCommand,
        Key::Home | Key::Backspace if shift => Command::ResetAll,
        Key::Home | Key::Backspace => Command::ResetView,
        Key::Letter('H') | Key::Function(1) => Command::Help,
        Key::Function(11) => Command::Fullscreen,
        Key::Function(12) => Command::Screenshot,
        Key::Escape => Command::Quit,
        _ => return None,
    })
}

/// Direction in which a key moves the camera while it is held: right, up and forward.
#[must_use]
pub fn walk_direction(key: Key) -> Option<[f32; 3]> {
    Some(match key {
        Key::Letter('W') => [0.0, 0.0, 1.0],
        Key::Letter('S') => [0.0, 0.0, -1.0],
        Key::Letter('A') => [-1.0, 0.0, 0.0],
        Key::Letter('D') => [1.0, 0.0, 0.0],
        Key::Letter('R') => [0.0, 1.0, 0.0],
        Key::Letter('F') => [0.0, -1.0, 0.0],
        _ => return None,
    })
}

/// Direction in which a key moves time while it is held.
#[must_use]
pub(crate) fn scrub_direction(key: Key) -> Option<f32> {
    match key {
        Key::Left => Some(-1.0),
        Key::Right => Some(1.0),
        _ => None,
    }
}

/// The keys with what they do, as the window prints them: a line each, without the last line's end.
#[must_use]
pub fn help() -> String {
    let techniques = SurfaceTechnique::names().enumerate().map(|(number, name)| {
        let shift = if number < 10 { "" } else { "Shift+" };
        format!("{shift}{} {name}", (number + 1) % 10)
    });
    let techniques: Vec<String> = techniques.collect();
    let mut text = String::new();
    for Line { keys, does } in LINES {
        text.push_str(&format!("{keys:<22}{does}\n"));
    }
    for (row, names) in techniques.chunks(3).enumerate() {
        let keys = if row == 0 { "techniques" } else { "" };
        text.push_str(&format!("{keys:<22}{}\n", names.join(", ")));
    }
    text.trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_technique_has_a_key_of_its_own_which_the_help_names() {
        let mut seen = Vec::new();
        for shift in [false, true] {
            for digit in [1, 2, 3, 4, 5, 6, 7, 8, 9, 0] {
                if let Some(Command::Technique(number)) = command(Key::Digit(digit), shift) {
                    let key = format!("{}{digit}", if shift { "Shift+" } else { "" });
                    let name = SurfaceTechnique::names().nth(number).unwrap();
                    assert!(help().contains(&format!("{key} {name}")), "{key} {name}\n{}", help());
                    seen.push(number);
                }
            }
        }
        assert_eq!(seen, (0..SurfaceTechnique::names().count()).collect::<Vec<_>>());
    }

    #[test]
    fn no_key_both_walks_and_commands() {
        for letter in 'A'..='Z' {
            let key = Key::Letter(letter);
            assert!(walk_direction(key).is_none() || command(key, false).is_none(), "{letter}");
        }
    }

    #[test]
    fn shift_makes_another_command_of_a_key() {
        assert_eq!(command(Key::Home, false), Some(Command::ResetView));
        assert_eq!(command(Key::Backspace, true), Some(Command::ResetAll));
        assert_eq!(command(Key::Letter('T'), true), Some(Command::NextTechnique { back: true }));
        assert_eq!(command(Key::Letter('Z'), false), None);
        assert_eq!(command(Key::Comma, true), Some(Command::Step { back: true, second: true }));
    }

    #[test]
    fn the_help_fits_a_terminal() {
        assert!(help().lines().all(|line| line.chars().count() <= 80), "{}", help());
    }
}
