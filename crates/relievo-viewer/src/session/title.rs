//! The window's title.

use relievo_scene::SceneTime;

use crate::frame::times::FrameTime;
use crate::state::scene_state::State;

/// Measurements of the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Figures {
    /// The last frame's time.
    pub(crate) frame: Option<FrameTime>,
    /// Mean height look-ups of the pixels that show a surface.
    pub(crate) fetches: Option<f64>,
}

/// Scene, technique, shadow, milliseconds, fetches per pixel, size.
pub(crate) fn title(name: &str, state: &State, figures: Figures) -> String {
    let mut parts = vec![format!("Relievo: {name}"), state.describe_reliefs()];
    if let Some(time) = figures.frame {
        parts.push(format!("{:.1} ms {}", time.milliseconds(), time.clock()));
    }
    if let Some(fetches) = figures.fetches {
        parts.push(format!("{fetches:.1} fetches per pixel"));
    }
    if state.is_playing() || state.time() != SceneTime::default() {
        parts.push(format!("{:.2} s", state.time().seconds()));
    }
    let image = &state.scene().image;
    parts.push(format!("{}×{}", image.width, image.height));
    parts.join(" | ")
}
