//! Playing a script in a session.

use std::time::{Duration, Instant};

use winit::dpi::PhysicalSize;

use super::{Session, Shown};
use crate::error::ViewerError;
use crate::input::script::{Action, Player};
use crate::options::Message;
use crate::session::title::title;

/// Time that a script waits for a window to get the size it asked for.
const RESIZE_PATIENCE: Duration = Duration::from_secs(10);

impl Session {
    /// Plays the script up to the next frame; `false` if there is none now.
    pub(super) fn play(&mut self) -> bool {
        while !self.over && self.awaited.is_none() {
            let Some(player) = &mut self.player else { return true };
            match player.next() {
                Some(Action::Frame) => return true,
                Some(Action::Input(input)) => self.take(input),
                Some(Action::Resize(size)) => self.resize(size),
                Some(Action::Screenshot(name)) => {
                    let path = self.options.screenshots.join(name);
                    self.try_to(|session| session.screenshot(&path));
                }
                Some(Action::Title) => {
                    self.try_to(Self::measure);
                    self.say(Message::Print(&title(&self.options.title, &self.state, self.figures)));
                }
                Some(Action::LoseDevice) => {
                    if let Some(Shown { stage, .. }) = &self.shown {
                        stage.lose();
                    }
                }
                // With --frames the window stays for the rest of them.
                None if self.options.frames.is_some() => return true,
                Some(Action::Quit) | None => self.quit(),
            }
        }
        false
    }

    fn resize(&mut self, size: [u32; 2]) {
        let Some(Shown { screen, .. }) = &self.shown else { return };
        let [width, height] = size;
        let _ = screen.window.request_inner_size(PhysicalSize::new(width, height));
        self.awaited = Some((size, Instant::now() + RESIZE_PATIENCE));
    }

    pub(super) fn size_is(&mut self, size: [u32; 2]) -> bool {
        let is = self.shown.as_ref().is_some_and(|Shown { screen, .. }| screen.size() == size);
        if is && self.size() != size {
            self.resized();
        }
        is
    }

    pub(super) fn resize_failed(&mut self, [width, height]: [u32; 2]) {
        let [is_wide, is_high] = self.shown.as_ref().map_or([0; 2], |Shown { screen, .. }| screen.size());
        let line = self.player.as_ref().map_or(0, Player::line);
        let message = format!(
            "the window has {is_wide}×{is_high} pixels, not {width}×{height}: the window system did not follow; \
             ask for a smaller size, or use a display without a window manager"
        );
        self.fail_script(line, message);
    }

    pub(super) fn fail_script(&mut self, line: usize, message: String) {
        let file = self.options.script.clone().unwrap_or_default();
        self.fail(ViewerError::Script { file, line: Some(line).filter(|&line| line > 0), message });
    }
}
