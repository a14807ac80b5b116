//! Input events that know no window system: windows and scripts both send them.

/// An input event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Input {
    /// A key went down (again, while it is held: `repeat`) or up.
    Key {
        /// The key.
        key: Key,
        /// Down, not up.
        pressed: bool,
        /// Sent by the system because the key is held.
        repeat: bool,
    },
    /// The modifier keys that are down from now on.
    Modifiers(Modifiers),
    /// A mouse button went down or up.
    Button {
        /// The button.
        button: Button,
        /// Down, not up.
        pressed: bool,
    },
    /// The pointer moved by so many pixels, right and down.
    Moved([f32; 2]),
    /// The wheel turned by so many lines; away from the user is positive.
    Wheel(f32),
    /// The window lost the keyboard: whatever was held is held no more.
    FocusLost,
}

/// Keys by their place on a US keyboard.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Key {
    /// A to Z, in capitals.
    Letter(char),
    /// 0 to 9, above the letters.
    Digit(u8),
    /// F1 to F12.
    Function(u8),
    /// Home.
    Home,
    /// Backspace.
    Backspace,
    /// Escape.
    Escape,
    /// The space bar.
    Space,
    /// Comma.
    Comma,
    /// Full stop.
    Period,
    /// The arrow to the left.
    Left,
    /// The arrow to the right.
    Right,
}

/// Keys that are called by a word.
const NAMED: [(&str, Key); 8] = [
    ("Home", Key::Home),
    ("Backspace", Key::Backspace),
    ("Escape", Key::Escape),
    ("Space", Key::Space),
    ("Comma", Key::Comma),
    ("Period", Key::Period),
    ("Left", Key::Left),
    ("Right", Key::Right),
];

impl Key {
    /// The key with this name, as it is written in scripts: `W`, `1`, `F12`, `Home`, `Backspace`, `Escape`,
    /// `Space`, `Comma`, `Period`, `Left`, `Right`, in any case.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let mut letters = name.chars();
        match (letters.next(), letters.next()) {
            (Some(letter), None) if letter.is_ascii_alphabetic() => Some(Self::Letter(letter.to_ascii_uppercase())),
            (Some(digit), None) => digit.to_digit(10).map(|digit| Self::Digit(digit as u8)),
            (Some('f' | 'F'), Some(_)) => name[1..]
                .parse()
                .ok()
                .filter(|n| (1..=12).contains(n) && !name[1..].starts_with(['+', '0']))
                .map(Self::Function),
            _ => NAMED.into_iter().find_map(|(known, key)| name.eq_ignore_ascii_case(known).then_some(key)),
        }
    }
}

impl std::fmt::Display for Key {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Letter(letter) => write!(f, "{letter}"),
            Self::Digit(digit) => write!(f, "{digit}"),
            Self::Function(number) => write!(f, "F{number}"),
            named => f.write_str(NAMED.iter().find(|(_, key)| key == named).map_or("", |(name, _)| name)),
        }
    }
}

/// Modifier keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Modifiers {
    /// Either Shift.
    pub shift: bool,
    /// Either Ctrl.
    pub ctrl: bool,
}

/// Mouse buttons.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    /// The main one.
    Left,
    /// The wheel, pressed.
    Middle,
    /// The other one.
    Right,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_found_by_the_names_they_show() {
        let mut keys: Vec<Key> = ('A'..='Z').map(Key::Letter).chain((0..10).map(Key::Digit)).collect();
        keys.extend((1..=12).map(Key::Function));
        keys.extend([Key::Home, Key::Backspace, Key::Escape]);
        for key in keys {
            let name = key.to_string();
            assert_eq!(Key::from_name(&name), Some(key), "{name}");
            assert_eq!(Key::from_name(&name.to_lowercase()), Some(key), "{name}");
        }
        for name in ["", "F0", "F13", "F01", "F+1", "WW", "10", "é", "Fé", "²", "-", "Hom"] {
            assert_eq!(Key::from_name(name), None, "{name}");
        }
    }
}
