//! The event loop of a display, without a panic where there is none.

use winit::event_loop::EventLoop;

use crate::error::ViewerError;

/// The event loop of the machine's window system.
pub(crate) fn event_loop<T>() -> Result<EventLoop<T>, ViewerError> {
    #[cfg(all(unix, not(target_vendor = "apple"), not(target_os = "android")))]
    check_libraries().map_err(ViewerError::NoDisplay)?;
    EventLoop::with_user_event().build().map_err(|error| {
        let mut why = plain(&error.to_string());
        if why.contains("shared libraries") {
            why.push_str(INSTALL);
        }
        ViewerError::NoDisplay(why)
    })
}

/// The command that installs the libraries that a window needs.
const INSTALL: &str = "; on Debian and Ubuntu `apt-get install libx11-6 libx11-xcb1 libxcursor1 libxi6 libxkbcommon-x11-0` \
                       brings them";

/// winit panics where these libraries are missing; everything else it reports.
#[cfg(all(unix, not(target_vendor = "apple"), not(target_os = "android")))]
fn check_libraries() -> Result<(), String> {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let wayland = is_set("WAYLAND_DISPLAY") || is_set("WAYLAND_SOCKET");
    if !wayland && !is_set("DISPLAY") {
        return Err("neither WAYLAND_DISPLAY nor DISPLAY is set".to_owned());
    }
    if xkbcommon_dl::xkbcommon_option().is_none() {
        return Err(format!("the library libxkbcommon.so.0 is missing{INSTALL}"));
    }
    if !wayland && xkbcommon_dl::x11::xkbcommon_x11_option().is_none() {
        return Err(format!("the library libxkbcommon-x11.so.0 is missing{INSTALL}"));
    }
    Ok(())
}

/// An error of winit's without the place in its source, which it begins with.
fn plain(text: &str) -> String {
    let after = text.split_once(".rs:").and_then(|(_, rest)| rest.split_once(": "));
    after.map_or(text, |(_, rest)| rest).trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::plain;

    #[test]
    fn an_error_loses_its_place_in_the_source() {
        let text = "os error at /a/winit-0.30.13/src/linux/mod.rs:780: X11: no server.";
        assert_eq!(plain(text), "X11: no server");
        assert_eq!(plain("not supported"), "not supported");
    }
}
