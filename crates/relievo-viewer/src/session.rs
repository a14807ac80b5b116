//! A session in a window: inputs come in, frames go out, until it is closed.

mod drawing;
mod play;
mod script_file;
mod title;

use std::sync::Arc;
use std::time::{Duration, Instant};

use relievo_gpu::{AdapterChoice, Gpu};
use relievo_scene::Scene;
use winit::window::{Fullscreen, Window};

use crate::control::commands::{Command, help};
use crate::control::controls::Controls;
use crate::error::ViewerError;
use crate::frame::screen::Screen;
use crate::frame::screenshot::free_name;
use crate::frame::stage::Stage;
use crate::frame::times::{FrameTime, FrameTimes};
use crate::input::event::Input;
use crate::input::script::{FRAME_SECONDS, Player};
use crate::options::{Message, Options, Summary};
use crate::session::script_file::read_script;
use crate::session::title::Figures;
use crate::state::edits::{shell_line, with_changes};
use crate::state::scene_state::{Change, State};

/// Time without a change after which the picture is measured.
const REST: Duration = Duration::from_millis(300);

/// Time until the next look for a texture to draw into, or for a size.
const LATER: Duration = Duration::from_millis(20);

pub(crate) struct Session {
    options: Options,
    state: State,
    controls: Controls,
    player: Option<Player>,
    shown: Option<Shown>,
    /// Changes that the renderer does not know yet.
    change: Change,
    figures: Figures,
    /// The time of each frame, where that is wanted.
    times: Vec<FrameTime>,
    frames: u32,
    last_frame: Instant,
    /// True if a key that moves the camera was held at the last frame.
    moving: bool,
    /// The time at which the picture is to be measured.
    rest: Option<Instant>,
    /// The time at which to try again to draw.
    later: Option<Instant>,
    /// The size that a script waits for, and until when.
    awaited: Option<([u32; 2], Instant)>,
    /// The title, and when it was written.
    titled: Option<(Instant, String)>,
    hidden: bool,
    /// True if the device can measure, as far as is known.
    measures: bool,
    /// The device was opened anew, and has not drawn since.
    reopened: bool,
    over: bool,
    failure: Option<ViewerError>,
}

struct Shown {
    screen: Screen,
    stage: Stage,
}

impl Session {
    pub(crate) fn new(scene: Scene, options: Options) -> Result<Self, ViewerError> {
        let mut player = options.script.as_deref().map(read_script).transpose()?.map(Player::new);
        if let Some(player) = &mut player {
            // Whatever the window system made of it at first.
            player.resize_first([scene.image.width, scene.image.height]);
        }
        let state = State::at(scene, options.time);
        Ok(Self {
            options,
            state,
            controls: Controls::default(),
            player,
            shown: None,
            change: Change::default(),
            figures: Figures::default(),
            times: Vec::new(),
            frames: 0,
            last_frame: Instant::now(),
            moving: false,
            rest: None,
            later: None,
            awaited: None,
            titled: None,
            hidden: false,
            measures: true,
            reopened: false,
            over: false,
            failure: None,
        })
    }

    pub(crate) fn end(self) -> Result<Summary, ViewerError> {
        match self.failure {
            Some(error) => Err(error),
            None => Ok(Summary { times: FrameTimes::of(&self.times) }),
        }
    }

    pub(crate) fn is_scripted(&self) -> bool {
        self.player.is_some()
    }

    pub(crate) fn is_open(&self) -> bool {
        self.shown.is_some()
    }

    pub(crate) fn is_over(&self) -> bool {
        self.over
    }

    /// Width and height of the picture in pixels.
    pub(crate) fn size(&self) -> [u32; 2] {
        [self.state.scene().image.width, self.state.scene().image.height]
    }

    pub(crate) fn quit(&mut self) {
        self.over = true;
    }

    pub(crate) fn fail(&mut self, error: ViewerError) {
        self.failure.get_or_insert(error);
        self.over = true;
    }

    /// Takes the window, once.
    pub(crate) fn open(&mut self, window: Window, instance: wgpu::Instance) {
        let open = |session: &mut Self| {
            let screen = Screen::new(Arc::new(window), instance, !session.runs())?;
            let stage = session.new_stage(&screen)?;
            session.say(Message::Note(&format!("drawing on {}", stage.gpu().name())));
            for note in stage.notes() {
                session.say(Message::Note(&note));
            }
            session.shown = Some(Shown { screen, stage });
            session.resized();
            Ok(())
        };
        if let Err(error) = open(self) {
            self.fail(error);
        }
    }

    fn new_stage(&self, screen: &Screen) -> Result<Stage, ViewerError> {
        let choice = AdapterChoice { name: self.options.adapter.as_deref(), surface: Some(&screen.surface) };
        let gpu = pollster::block_on(Gpu::open(screen.instance(), &choice))?;
        let format = screen.format(&gpu.adapter)?;
        Ok(Stage::new(gpu, format, &self.state)?)
    }

    /// Applies input of mouse and keys; a script has the window for itself.
    pub(crate) fn listen(&mut self, input: Input) {
        if self.player.is_none() {
            self.take(input);
        }
    }

    fn take(&mut self, input: Input) {
        let (change, command) = self.controls.apply(input, &mut self.state);
        self.changed(change);
        match command {
            Some(Command::Play | Command::Step { .. }) if self.options.film.is_none() => {
                self.state.pause();
                self.say(Message::Note("nothing in the scene changes with time"));
            }
            Some(Command::Help) => self.say(Message::Print(&help())),
            Some(Command::NextLight) => self.say(Message::Note(&self.state.describe_light())),
            Some(Command::PrintCommand) => {
                let words = with_changes(&self.options.command, self.state.arguments());
                self.say(Message::Print(&shell_line(&words)));
            }
            Some(Command::Fullscreen) => {
                if let Some(Shown { screen, .. }) = &self.shown {
                    let is_full = screen.window.fullscreen().is_some();
                    screen.window.set_fullscreen((!is_full).then_some(Fullscreen::Borderless(None)));
                }
            }
            Some(Command::Screenshot) => match free_name(&self.options.screenshots, &self.options.title) {
                Some(path) => self.try_to(|session| session.screenshot(&path)),
                None => self.say(Message::Error("every number for a screenshot is taken; move some away")),
            },
            Some(Command::Quit) => self.quit(),
            _ => {}
        }
        if self.controls.is_moving() || self.state.is_playing() {
            self.request();
        }
    }

    /// Takes over the changed scene file.
    pub(crate) fn reload(&mut self, loaded: Result<Scene, String>) {
        match loaded {
            Ok(scene) => {
                for note in &scene.notes {
                    self.say(Message::Note(note));
                }
                let change = self.state.reload(scene).and(Change { time: true, ..Change::default() });
                self.say(Message::Note("the scene was loaded again"));
                self.changed(change);
            }
            Err(error) => self.say(Message::Error(&error)),
        }
    }

    fn changed(&mut self, change: Change) {
        if change.any() {
            self.change = self.change.and(change);
            self.figures.fetches = None;
            self.rest = Some(Instant::now() + REST);
            self.request();
        }
    }

    pub(crate) fn resized(&mut self) {
        let Some(Shown { screen, stage }) = &mut self.shown else { return };
        let most = stage.gpu().device.limits().max_texture_dimension_2d;
        let size = screen.size().map(|side| side.min(most));
        if size.contains(&0) {
            return;
        }
        self.state.resize(size);
        self.rest = Some(Instant::now() + REST);
        self.request();
    }

    pub(crate) fn hide(&mut self, hidden: bool) {
        self.hidden = hidden;
        self.request();
    }

    /// True if frames follow each other without being asked for.
    fn runs(&self) -> bool {
        self.player.is_some() || self.options.frames.is_some()
    }

    /// The time of the next work without an event; asks for a frame if that is now.
    pub(crate) fn next_time(&mut self, now: Instant) -> Option<Instant> {
        if let Some((size, until)) = self.awaited {
            if self.size_is(size) {
                self.awaited = None;
            } else if now > until {
                self.resize_failed(size);
            } else {
                return Some(now + LATER);
            }
        }
        if let Some(later) = self.later {
            if later > now {
                return Some(later);
            }
            self.later = None;
            self.request();
        }
        if self.runs() || self.controls.is_moving() || self.state.is_playing() {
            self.request();
            return None;
        }
        let rest = self.rest?;
        if rest > now {
            return Some(rest);
        }
        self.rest = None;
        self.try_to(Self::measure);
        None
    }

    /// Draws a frame, after the script's actions before it.
    pub(crate) fn redraw(&mut self) {
        if self.over || self.awaited.is_some() || self.later.is_some() {
            return;
        }
        let seconds = match &self.player {
            Some(_) => FRAME_SECONDS,
            None if self.moving => self.last_frame.elapsed().as_secs_f32(),
            // Nobody knows when it began to move since the last frame, which may be long ago.
            None => FRAME_SECONDS,
        };
        if self.player.is_some() && !self.play() {
            return;
        }
        self.last_frame = Instant::now();
        let change = self.controls.tick(seconds, &mut self.state);
        self.moving = self.controls.is_moving() || self.state.is_playing();
        self.changed(change);
        self.try_to(Self::frame);
        if self.options.frames.is_some_and(|frames| self.frames >= frames) && !self.over {
            match self.player.as_ref().filter(|player| !player.is_over()) {
                Some(player) => {
                    let message = format!("the {} frames of --frames were over before this line was", self.frames);
                    self.fail_script(player.line(), message);
                }
                None => self.quit(),
            }
        }
    }

    /// Asks for a frame.
    fn request(&self) {
        if let Some(Shown { screen, .. }) = &self.shown {
            screen.window.request_redraw();
        }
    }

    fn say(&self, message: Message<'_>) {
        (self.options.on_message)(message);
    }
}
