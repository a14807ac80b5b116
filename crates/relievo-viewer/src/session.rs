//! A session in a window: inputs come in, frames go out, until somebody has seen enough.

use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use relievo_gpu::{AdapterChoice, Gpu};
use relievo_map::write_picture;
use relievo_scene::Scene;
use winit::dpi::PhysicalSize;
use winit::window::{Fullscreen, Window};

use crate::commands::{Command, help};
use crate::controls::Controls;
use crate::edits::{shell_line, with_changes};
use crate::error::ViewerError;
use crate::frame_times::{FrameTime, FrameTimes};
use crate::input::Input;
use crate::screen::{Next, Screen};
use crate::screenshot::free_name;
use crate::script::{Action, FRAME_SECONDS, Player, Script};
use crate::stage::Stage;
use crate::state::{Change, State};
use crate::title::{Figures, title};
use crate::{Message, Options, Summary};

/// After so long without a change the picture rests, and is measured.
const REST: Duration = Duration::from_millis(300);

/// The title is not written more often.
const TITLE_PERIOD: Duration = Duration::from_millis(250);

/// How long a script waits for a window to get the size it asked for.
const RESIZE_PATIENCE: Duration = Duration::from_secs(10);

/// When to look again for a texture to draw into, or a size, that there was none of.
const LATER: Duration = Duration::from_millis(20);

/// The largest script that is read, bytes.
const MAX_SCRIPT: u64 = 16 << 20;

pub(crate) struct Session {
    options: Options,
    state: State,
    controls: Controls,
    player: Option<Player>,
    shown: Option<Shown>,
    /// What the renderer does not know yet.
    change: Change,
    figures: Figures,
    /// The time of each frame, where that is wanted.
    times: Vec<FrameTime>,
    frames: u32,
    last_frame: Instant,
    /// Whether a key that walks was held at the last frame.
    moving: bool,
    /// When the picture is to be measured.
    rest: Option<Instant>,
    /// When to try again to draw.
    later: Option<Instant>,
    /// The size that a script waits for, and until when.
    awaited: Option<([u32; 2], Instant)>,
    /// The title, and when it was written.
    titled: Option<(Instant, String)>,
    hidden: bool,
    /// Whether the device can measure, as far as is known.
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
        Ok(Self {
            options,
            state: State::new(scene),
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

    /// Takes what mouse and keys do; a script has the window for itself.
    pub(crate) fn listen(&mut self, input: Input) {
        if self.player.is_none() {
            self.take(input);
        }
    }

    fn take(&mut self, input: Input) {
        let (change, command) = self.controls.take(input, &mut self.state);
        self.changed(change);
        if self.controls.moves() {
            self.request();
        }
        match command {
            Some(Command::Help) => self.say(Message::Print(&help())),
            Some(Command::NextLight) => self.say(Message::Note(&self.state.light_in_words())),
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
    }

    /// The scene's file has changed.
    pub(crate) fn reload(&mut self, loaded: Result<Scene, String>) {
        match loaded {
            Ok(scene) => {
                for note in &scene.notes {
                    self.say(Message::Note(note));
                }
                let change = self.state.reload(scene);
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

    /// Whether frames follow each other without being asked for.
    fn runs(&self) -> bool {
        self.player.is_some() || self.options.frames.is_some()
    }

    /// When there is something to do without an event; asks for a frame if that is now.
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
        if self.runs() || self.controls.moves() {
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

    /// Draws a frame, and whatever a script has to do before.
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
        self.moving = self.controls.moves();
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

    /// Does what the script says up to the next frame; `false` if there is none now.
    fn play(&mut self) -> bool {
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

    fn size_is(&mut self, size: [u32; 2]) -> bool {
        let is = self.shown.as_ref().is_some_and(|Shown { screen, .. }| screen.size() == size);
        if is && self.size() != size {
            self.resized();
        }
        is
    }

    fn resize_failed(&mut self, [width, height]: [u32; 2]) {
        let [is_wide, is_high] = self.shown.as_ref().map_or([0; 2], |Shown { screen, .. }| screen.size());
        let line = self.player.as_ref().map_or(0, Player::line);
        let message = format!(
            "the window has {is_wide}×{is_high} pixels, not {width}×{height}: the window system did not follow; \
             ask for a smaller size, or use a display without a window manager"
        );
        self.fail_script(line, message);
    }

    fn fail_script(&mut self, line: usize, message: String) {
        let file = self.options.script.clone().unwrap_or_default();
        self.fail(ViewerError::Script { file, line: Some(line).filter(|&line| line > 0), message });
    }

    /// Brings the renderer in line with the state.
    fn update(&mut self) -> Result<(), ViewerError> {
        let Some(Shown { stage, .. }) = &mut self.shown else { return Ok(()) };
        let change = std::mem::take(&mut self.change);
        let updated = stage.update(&self.state, change);
        if updated.is_err() {
            // Nobody knows how far it came: whatever comes next begins anew.
            self.change = Change::ALL;
        }
        Ok(updated?)
    }

    /// Draws the state into the window.
    fn frame(&mut self) -> Result<(), ViewerError> {
        let (runs, size) = (self.runs(), self.size());
        let Some(Shown { screen, .. }) = &self.shown else { return Ok(()) };
        let minimised = screen.size().contains(&0);
        if (minimised || self.hidden) && !runs {
            return Ok(());
        }
        self.update()?;
        let Some(Shown { screen, stage }) = &mut self.shown else { return Ok(()) };
        let next = if minimised { Next::Later } else { screen.next(stage, size)? };
        let time = match next {
            Next::Texture(texture) => {
                let view = texture.texture.create_view(&wgpu::TextureViewDescriptor::default());
                let time = stage.draw(&view, size)?;
                screen.window.pre_present_notify();
                stage.gpu().queue.present(texture);
                time
            }
            // A script goes on, seen or not.
            Next::Later if runs => stage.draw_aside(size)?,
            Next::Later => {
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
    fn measure(&mut self) -> Result<(), ViewerError> {
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
    fn screenshot(&mut self, path: &Path) -> Result<(), ViewerError> {
        let size = self.size();
        self.update()?;
        let Some(Shown { stage, .. }) = &mut self.shown else { return Ok(()) };
        let pixels = stage.picture(size)?;
        write_picture(path, &pixels)?;
        self.say(Message::Note(&format!("{} was written", path.display())));
        Ok(())
    }

    /// Does what may fail. A lost device is opened anew; what else fails ends the session.
    fn try_to(&mut self, work: impl FnOnce(&mut Self) -> Result<(), ViewerError>) {
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

    /// Asks for a frame.
    fn request(&self) {
        if let Some(Shown { screen, .. }) = &self.shown {
            screen.window.request_redraw();
        }
    }

    fn say(&self, message: Message<'_>) {
        (self.options.talk)(message);
    }
}

fn read_script(path: &Path) -> Result<Script, ViewerError> {
    let failed = |line, message: String| ViewerError::Script { file: path.to_owned(), line, message };
    let mut text = String::new();
    let read = File::open(path).and_then(|file| file.take(MAX_SCRIPT + 1).read_to_string(&mut text));
    let bytes = read.map_err(|error| failed(None, format!("cannot read the script: {error}")))?;
    if bytes as u64 > MAX_SCRIPT {
        return Err(failed(None, format!("a script may have at most {} MiB", MAX_SCRIPT >> 20)));
    }
    Script::parse(&text).map_err(|error| failed(Some(error.line), error.message))
}
