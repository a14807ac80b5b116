//! A value for `XDG_RUNTIME_DIR` where a machine without a desktop has none.
//!
//! Mesa's Vulkan layer for choosing devices looks for a Wayland display whenever adapters are listed, and libwayland then
//! prints `error: XDG_RUNTIME_DIR is invalid or not set in the environment.` on stderr, past us. Neither can be told
//! otherwise through wgpu, and a process cannot safely change its own environment: so it starts itself anew, in place, with
//! a folder in which no display can be.

use std::env;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::Command;

const VARIABLE: &str = "XDG_RUNTIME_DIR";

/// A path that is absolute, as libwayland asks, and in which nobody can put a socket.
const EMPTY: &str = "/dev/null";

/// Makes sure that the variable is valid. Replaces this process by one of the same arguments if it is not.
///
/// To be called before any work: it would be done twice.
pub(crate) fn ensure() {
    if env::var_os(VARIABLE).is_some_and(|folder| Path::new(&folder).is_absolute()) {
        return;
    }
    let (Ok(program), mut arguments) = (env::current_exe(), env::args_os()) else { return };
    let mut command = Command::new(program);
    if let Some(name) = arguments.next() {
        command.arg0(name);
    }
    // It comes back only if it fails; then the library's line is all that is lost.
    let _ = command.args(arguments).env(VARIABLE, EMPTY).exec();
}
