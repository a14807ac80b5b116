//! The native window: winit's events become inputs of the [`Session`].

use std::time::Instant;

use relievo_scene::Scene;
use winit::application::ApplicationHandler;
use winit::dpi::{PhysicalPosition, PhysicalSize};
use winit::event::{ElementState, KeyEvent, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::keyboard::{KeyCode, ModifiersState, PhysicalKey};
use winit::window::{Window, WindowId};

use crate::error::ViewerError;
use crate::input::event::{Button, Input, Key, Modifiers};
use crate::options::{Options, Summary};
use crate::session::Session;
use crate::window::display::event_loop;
use crate::window::watch::watch;

/// Pixels of a touchpad that make a line of a wheel.
const PIXELS_PER_LINE: f64 = 40.0;

/// Opens a window on a scene, and returns when it is closed. The window is as large as the scene's image, in physical
/// pixels, if the window system lets it.
///
/// Must be called on the main thread, and once in a program.
///
/// # Errors
/// If there is no display or adapter, the script is wrong, or the GPU cannot draw the scene.
pub fn run(scene: Scene, options: Options) -> Result<Summary, ViewerError> {
    let file = options.file.clone();
    let session = Session::new(scene, options)?;
    let event_loop = event_loop()?;
    event_loop.set_control_flow(ControlFlow::Wait);
    // A script's session must not depend on what else happens.
    if let Some(file) = file.filter(|_| !session.is_scripted()) {
        let proxy = event_loop.create_proxy();
        watch(file, move |loaded| proxy.send_event(Reloaded(Box::new(loaded))).is_ok());
    }
    let display = event_loop.owned_display_handle();
    let instance = wgpu::InstanceDescriptor::new_with_display_handle_from_env(Box::new(display));
    let mut app = App { instance: wgpu::Instance::new(instance), session, pointer: None };
    event_loop.run_app(&mut app).map_err(|error| ViewerError::Window(error.to_string()))?;
    app.session.end()
}

/// The scene's file changed: the scene, or why there is none.
struct Reloaded(Box<Result<Scene, String>>);

struct App {
    instance: wgpu::Instance,
    session: Session,
    /// Last position of the pointer, if it is in the window.
    pointer: Option<PhysicalPosition<f64>>,
}

impl ApplicationHandler<Reloaded> for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.session.is_open() {
            return;
        }
        let [width, height] = self.session.size();
        let attributes =
            Window::default_attributes().with_title("Relievo").with_inner_size(PhysicalSize::new(width, height));
        match event_loop.create_window(attributes) {
            Ok(window) => self.session.open(window, self.instance.clone()),
            Err(error) => self.session.fail(ViewerError::Window(error.to_string())),
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, Reloaded(loaded): Reloaded) {
        self.session.reload(*loaded);
    }

    fn window_event(&mut self, _: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested => self.session.quit(),
            WindowEvent::RedrawRequested => self.session.redraw(),
            WindowEvent::Resized(_) | WindowEvent::ScaleFactorChanged { .. } => self.session.resized(),
            WindowEvent::Occluded(hidden) => self.session.hide(hidden),
            other => {
                if let Some(input) = self.input(&other) {
                    self.session.listen(input);
                }
            }
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let now = Instant::now();
        match self.session.next_time(now) {
            _ if self.session.is_over() => event_loop.exit(),
            Some(time) => event_loop.set_control_flow(ControlFlow::WaitUntil(time)),
            None => event_loop.set_control_flow(ControlFlow::Wait),
        }
    }
}

impl App {
    /// Input of an event, if it is one that a script could send, too.
    fn input(&mut self, event: &WindowEvent) -> Option<Input> {
        Some(match event {
            WindowEvent::KeyboardInput {
                event: KeyEvent { physical_key, state, repeat, .. }, is_synthetic, ..
            } => {
                let PhysicalKey::Code(code) = physical_key else { return None };
                let pressed = *state == ElementState::Pressed;
                // A key that was down before the window had the keyboard was not meant for it.
                if *is_synthetic && pressed {
                    return None;
                }
                Input::Key { key: key(*code)?, pressed, repeat: *repeat }
            }
            WindowEvent::ModifiersChanged(modifiers) => {
                let held = |modifier| modifiers.state().contains(modifier);
                Input::Modifiers(Modifiers { shift: held(ModifiersState::SHIFT), ctrl: held(ModifiersState::CONTROL) })
            }
            WindowEvent::MouseInput { state, button, .. } => {
                let button = match button {
                    MouseButton::Left => Button::Left,
                    MouseButton::Middle => Button::Middle,
                    MouseButton::Right => Button::Right,
                    _ => return None,
                };
                Input::Button { button, pressed: *state == ElementState::Pressed }
            }
            WindowEvent::CursorMoved { position, .. } => {
                let before = self.pointer.replace(*position)?;
                Input::Moved([(position.x - before.x) as f32, (position.y - before.y) as f32])
            }
            WindowEvent::CursorLeft { .. } => {
                self.pointer = None;
                return None;
            }
            WindowEvent::MouseWheel { delta, .. } => Input::Wheel(match delta {
                MouseScrollDelta::LineDelta(_, lines) => *lines,
                MouseScrollDelta::PixelDelta(pixels) => (pixels.y / PIXELS_PER_LINE) as f32,
            }),
            WindowEvent::Focused(false) => Input::FocusLost,
            _ => return None,
        })
    }
}

/// Keys by their place, whatever is printed on them.
fn key(code: KeyCode) -> Option<Key> {
    Some(match code {
        KeyCode::Home => Key::Home,
        KeyCode::Backspace => Key::Backspace,
        KeyCode::Escape => Key::Escape,
        KeyCode::Space => Key::Space,
        KeyCode::Comma => Key::Comma,
        KeyCode::Period => Key::Period,
        KeyCode::ArrowLeft => Key::Left,
        KeyCode::ArrowRight => Key::Right,
        // winit names the others KeyA, Digit1 and F1.
        other => {
            let name = format!("{other:?}");
            let short = name.strip_prefix("Key").or_else(|| name.strip_prefix("Digit"));
            return Key::from_name(short.unwrap_or(&name)).filter(|_| short.is_some() || name.starts_with('F'));
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_known_by_their_place() {
        assert_eq!(key(KeyCode::KeyQ), Some(Key::Letter('Q')));
        assert_eq!(key(KeyCode::Digit0), Some(Key::Digit(0)));
        assert_eq!(key(KeyCode::F12), Some(Key::Function(12)));
        assert_eq!(key(KeyCode::Home), Some(Key::Home));
        assert_eq!((key(KeyCode::Space), key(KeyCode::ArrowLeft)), (Some(Key::Space), Some(Key::Left)));
        for other in [KeyCode::F13, KeyCode::Fn, KeyCode::Find, KeyCode::Numpad1, KeyCode::Tab, KeyCode::Again] {
            assert_eq!(key(other), None, "{other:?}");
        }
    }
}
