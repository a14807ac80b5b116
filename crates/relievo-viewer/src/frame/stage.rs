//! The scene on the device: updated from the state, drawn, measured.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use relievo_gpu::{Gpu, GpuError, Renderer, RendererOptions, Target};
use relievo_map::Grid;

use crate::frame::picture::{Picture, wait};
use crate::frame::timer::Timer;
use crate::frame::times::FrameTime;
use crate::state::scene_state::{Change, State};

/// The longer side of pictures whose fetches are counted: enough for a mean, and soon done.
const MEASURED_SIDE: u32 = 400;

pub(crate) struct Stage {
    gpu: Gpu,
    format: wgpu::TextureFormat,
    renderer: Renderer,
    aside: Option<Picture>,
    timer: Option<Timer>,
    lost: Report,
    failed: Report,
}

/// First error that the device reported by itself.
#[derive(Clone, Default)]
struct Report(Arc<Mutex<Option<String>>>);

impl Report {
    fn set(&self, text: String) {
        // The first one is the cause of the others.
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(text);
    }

    fn get(&self) -> Option<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl Stage {
    /// Makes the scene ready on a device, for textures of this format.
    pub(crate) fn new(gpu: Gpu, format: wgpu::TextureFormat, state: &State) -> Result<Self, GpuError> {
        let (lost, failed) = (Report::default(), Report::default());
        let report = lost.clone();
        gpu.device.set_device_lost_callback(move |reason, text| report.set(format!("{reason:?}: {text}")));
        // Without this, wgpu would panic.
        let report = failed.clone();
        gpu.device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| report.set(error.to_string())));
        let renderer = renderer(&gpu, format, state)?;
        let timer = Timer::new(&gpu);
        Ok(Self { gpu, timer, format, renderer, aside: None, lost, failed })
    }

    pub(crate) fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Notes on differences between the renderer and the CPU.
    pub(crate) fn notes(&self) -> Vec<String> {
        self.renderer.notes()
    }

    /// The reason why the device is lost, if it is.
    pub(crate) fn lost(&self) -> Option<String> {
        // It tells when it is polled; a poll that fails tells nothing new.
        let _ = self.gpu.device.poll(wgpu::PollType::Poll);
        self.lost.get()
    }

    pub(crate) fn format(&self) -> wgpu::TextureFormat {
        self.format
    }

    /// Checks that the device has reported no error so far.
    pub(crate) fn check(&self) -> Result<(), GpuError> {
        self.lost.get().or_else(|| self.failed.get()).map_or(Ok(()), |text| Err(GpuError::Device(text)))
    }

    /// Brings the renderer in line with a change.
    pub(crate) fn update(&mut self, state: &State, change: Change) -> Result<(), GpuError> {
        let scene = state.scene();
        if change.scene {
            self.renderer = renderer(&self.gpu, self.format, state)?;
            return Ok(());
        }
        if change.moment {
            return self.renderer.set_scene(scene);
        }
        if change.reliefs {
            self.renderer.set_reliefs(scene)?;
        }
        if change.lights {
            self.renderer.set_lights(&scene.lights)?;
        }
        if change.camera {
            self.renderer.set_camera(&scene.camera)?;
        }
        Ok(())
    }

    /// Draws, and waits until it is done.
    pub(crate) fn draw(&mut self, view: &wgpu::TextureView, size: [u32; 2]) -> Result<FrameTime, GpuError> {
        let start = Instant::now();
        let timestamps = self.timer.as_ref().map(Timer::timestamps);
        self.renderer.draw(&Target { timestamps, ..Target::new(view, size) })?;
        wait(&self.gpu.device)?;
        let wall = start.elapsed().as_secs_f64() * 1e3;
        let own = self.timer.as_ref().map_or(Ok(None), |timer| timer.read(&self.gpu))?;
        self.check()?;
        Ok(own.map_or(FrameTime::Wall(wall), FrameTime::Gpu))
    }

    /// Mean height look-ups of the pixels that show a surface, in a picture of these proportions; `None` if none does.
    pub(crate) fn fetches(&mut self, [width, height]: [u32; 2]) -> Result<Option<f64>, GpuError> {
        let scale = (f64::from(MEASURED_SIDE) / f64::from(width.max(height))).min(1.0);
        let size = [width, height].map(|side| ((f64::from(side) * scale).round() as u32).max(1));
        let aovs = self.renderer.measure(size)?;
        let seen = aovs.fetches.texels().iter().zip(aovs.hit.texels()).filter(|&(_, &hit)| hit > 0.0);
        let (count, sum) = seen.fold((0_u64, 0.0), |(count, sum), (&x, _)| (count + 1, sum + f64::from(x)));
        Ok((count > 0).then(|| sum / count as f64))
    }

    /// Draws into a texture of its own, as [`Stage::draw`].
    pub(crate) fn draw_aside(&mut self, size: [u32; 2]) -> Result<FrameTime, GpuError> {
        let picture = match self.aside.take() {
            Some(picture) if picture.size() == size => picture,
            _ => Picture::new(&self.gpu.device, size, self.format),
        };
        let drawn = self.draw(&picture.view, size);
        self.aside = Some(picture);
        drawn
    }

    /// The picture that the window shows.
    pub(crate) fn picture(&mut self, size: [u32; 2]) -> Result<Grid<[u8; 3]>, GpuError> {
        self.draw_aside(size)?;
        match &self.aside {
            Some(picture) => picture.read(&self.gpu.device, &self.gpu.queue),
            None => Err(GpuError::Device("there is no picture to read".to_owned())),
        }
    }

    /// Destroys the device, for tests of what happens then.
    pub(crate) fn lose(&self) {
        self.gpu.device.destroy();
    }
}

fn renderer(gpu: &Gpu, format: wgpu::TextureFormat, state: &State) -> Result<Renderer, GpuError> {
    Renderer::new(&gpu.device, &gpu.queue, state.scene(), format, &RendererOptions::default())
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use relievo_gpu::AdapterChoice;
    use relievo_scene::{LoadOptions, Scene};

    use super::*;
    use crate::control::commands::Command;
    use crate::frame::picture::FORMATS;

    /// `None` where there is no adapter and there need not be one.
    fn gpu() -> Option<Gpu> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        match pollster::block_on(Gpu::open(&instance, &AdapterChoice::default())) {
            Ok(gpu) => Some(gpu),
            Err(error) if std::env::var_os("RELIEVO_REQUIRE_ADAPTER").is_none() => {
                eprintln!("skipped: {error}");
                None
            }
            Err(error) => panic!("RELIEVO_REQUIRE_ADAPTER is set, but: {error}"),
        }
    }

    fn state(color_space: &str) -> State {
        let text = format!(
            "shading.color_space = \"{color_space}\"\nmaterials.a.from = \"make:brick-wall\"\n\
             lights = [{{ kind = \"directional\", direction = [-1, -1, -1] }}]\n[[objects]]\nmesh = \"quad\""
        );
        let options = LoadOptions { make_size: 32, ..LoadOptions::default() };
        State::new(Scene::parse(&text, "s.toml", Path::new(""), &options).unwrap())
    }

    #[test]
    fn a_window_of_any_format_shows_the_same_picture() {
        let Some(gpu) = gpu() else { return };
        for space in ["linear", "display"] {
            // An odd width: rows of the read-back do not follow each other without gaps.
            let pictures = FORMATS
                .map(|format| Stage::new(gpu.clone(), format, &state(space)).unwrap().picture([37, 23]).unwrap());
            let colors = pictures[0].texels().iter().filter(|[r, _, b]| r > b).count();
            assert!(colors > 100, "bricks are red: {colors}");
            for (picture, format) in pictures.iter().zip(FORMATS) {
                let steps = picture.texels().as_flattened().iter().zip(pictures[0].texels().as_flattened());
                let most = steps.map(|(a, b)| a.abs_diff(*b)).max().unwrap();
                assert!(most <= 1, "{space} {format:?}: {most}");
            }
        }
    }

    #[test]
    fn updates_show_what_a_new_stage_would() {
        let Some(gpu) = gpu() else { return };
        let mut state = state("linear");
        let mut stage = Stage::new(gpu.clone(), FORMATS[0], &state).unwrap();
        let mut before = stage.picture([40, 30]).unwrap();
        for command in [Command::Technique(7), Command::NextShadow, Command::Raise, Command::NextMesh] {
            let change = state.apply(command);
            stage.update(&state, change).unwrap();
            let updated = stage.picture([40, 30]).unwrap();
            let anew = Stage::new(gpu.clone(), FORMATS[0], &state).unwrap().picture([40, 30]).unwrap();
            assert!(updated == anew && updated != before, "{command:?}");
            before = updated;
        }
    }

    #[test]
    fn fetches_are_those_of_the_pixels_that_show_something() {
        let Some(gpu) = gpu() else { return };
        let mut state = state("linear");
        let _ = state.apply(Command::Technique(2));
        let mut stage = Stage::new(gpu, FORMATS[0], &state).unwrap();
        assert_eq!(stage.fetches([60, 40]).unwrap(), Some(1.0), "basic takes one");
        assert!(stage.draw_aside([60, 40]).unwrap().milliseconds() > 0.0);
        let away = state.move_camera(|camera| camera.target.z = 10.0);
        stage.update(&state, away).unwrap();
        assert_eq!(stage.fetches([60, 40]).unwrap(), None);
    }
}
