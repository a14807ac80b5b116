//! A session's frames, figures and screenshots, and the reactions to their errors.

use std::path::Path;
use std::time::{Duration, Instant};

use relievo_map::write_picture;

use super::{LATER, Session, Shown};
use crate::error::ViewerError;
use crate::frame::screen::NextTexture;
use crate::options::Message;
use crate::session::title::title;
use crate::state::scene_state::Change;

/// The title is not written more often.
const TITLE_PERIOD: Duration = Duration::from_millis(250);

impl Session {
    /// Brings the renderer in line with the state.
    fn update(&mut self) -> Result<(), ViewerError> {
        self.follow_time();
        let Some(Shown { stage, .. }) = &mut self.shown else { return Ok(()) };
        let change = std::mem::take(&mut self.change);
        let updated = stage.update(&self.state, change);
        if updated.is_err() {
            // Nobody knows how far it came: whatever comes next begins anew.
            self.change = Change::ALL;
        }
        Ok(updated?)
    }

    /// Loads the scene as it is at the time that the state shows.
    fn follow_time(&mut self) {
        if !std::mem::take(&mut self.change.time) {
            return;
        }
        let Some(film) = &self.options.film else { return };
        match film(self.state.time()) {
            Ok(scene) => self.change = self.change.and(self.state.move_to(scene)),
            Err(error) => self.say(Message::Error(&error)),
        }
    }

    /// Draws the state into the window.
    pub(super) fn frame(&mut self) -> Result<(), ViewerError> {
        let (runs, size) = (self.runs(), self.size());
        let Some(Shown { screen, .. }) = &self.shown else { return Ok(()) };
        let minimised = screen.size().contains(&0);
        if (minimised || self.hidden) && !runs {
            return Ok(());
        }
        self.update()?;
        let Some(Shown { screen, stage }) = &mut self.shown else { return Ok(()) };
        let acquired = if minimised { NextTexture::Later } else { screen.acquire(stage, size)? };
        let time = match acquired {
            NextTexture::Ready(texture) => {
                let view = texture.texture.create_view(&wgpu::TextureViewDescriptor::default());
                let time = stage.draw(&view, size)?;
                screen.window.pre_present_notify();
                stage.gpu().queue.present(texture);
                time
            }
            // A script goes on, seen or not.
            NextTexture::Later if runs => stage.draw_aside(size)?,
            NextTexture::Later => {
                self.later = Some(Instant::now() + LATER);
                return Ok(());
            }
        };
        self.reopened = false;
        self.frames += 1;
        self.figures.frame = Some(time);
        if runs {
            self.times.push(time);
        }
        self.write_title();
        Ok(())
    }

    /// Counts the fetches of the picture, for the title.
    pub(super) fn measure(&mut self) -> Result<(), ViewerError> {
        let size = self.size();
        self.update()?;
        let Some(Shown { stage, .. }) = self.shown.as_mut().filter(|_| self.measures) else {
            self.write_title();
            return Ok(());
        };
        match stage.fetches(size) {
            Err(error) if stage.lost().is_none() => {
                // Some devices can draw, but not measure.
                self.measures = false;
                self.say(Message::Note(&format!("fetches are not counted: {error}")));
            }
            fetches => self.figures.fetches = fetches?,
        }
        self.write_title();
        Ok(())
    }

    fn write_title(&mut self) {
        let Some(Shown { screen, .. }) = &self.shown else { return };
        let now = Instant::now();
        let fresh = self.titled.as_ref().is_some_and(|(at, _)| now.duration_since(*at) < TITLE_PERIOD);
        if fresh && self.rest.is_some() {
            return;
        }
        let text = title(&self.options.title, &self.state, self.figures);
        if self.titled.as_ref().is_none_or(|(_, known)| *known != text) {
            screen.window.set_title(&text);
        }
        self.titled = Some((now, text));
    }

    /// Writes what the window shows.
    pub(super) fn screenshot(&mut self, path: &Path) -> Result<(), ViewerError> {
        let size = self.size();
        self.update()?;
        let Some(Shown { stage, .. }) = &mut self.shown else { return Ok(()) };
        let pixels = stage.picture(size)?;
        write_picture(path, &pixels)?;
        self.say(Message::Note(&format!("{} was written", path.display())));
        Ok(())
    }

    /// Runs work that may fail. A lost device is opened anew; other errors end the session.
    pub(super) fn try_to(&mut self, work: impl FnOnce(&mut Self) -> Result<(), ViewerError>) {
        let Err(error) = work(self) else { return };
        let trouble = self.shown.as_ref().and_then(|Shown { stage, .. }| stage.lost());
        match (error, trouble) {
            (ViewerError::Gpu(_), Some(why)) if self.reopened => self.fail(ViewerError::Lost(why)),
            (ViewerError::Gpu(_), Some(why)) => {
                self.say(Message::Error(&format!("the GPU was lost ({why}); opening it anew")));
                if let Err(error) = self.reopen() {
                    self.fail(error);
                }
            }
            // A scene that cannot be drawn: the picture stays, and the next change may mend it.
            (error @ ViewerError::Gpu(_), None) if self.frames > 0 && !self.runs() => {
                self.say(Message::Error(&error.to_string()));
            }
            // The window can do without a picture of it.
            (error @ ViewerError::Screenshot(_), _) if self.player.is_none() => {
                self.say(Message::Error(&error.to_string()));
            }
            (error, _) => self.fail(error),
        }
    }

    fn reopen(&mut self) -> Result<(), ViewerError> {
        let Some(Shown { mut screen, stage }) = self.shown.take() else { return Ok(()) };
        drop(stage);
        screen.renew()?;
        let stage = self.new_stage(&screen)?;
        self.shown = Some(Shown { screen, stage });
        self.reopened = true;
        self.change = Change::default();
        self.request();
        Ok(())
    }
}
