use crate::composer::Composer;
use crate::error::ComposeError;
use crate::permutation::Permutation;
use crate::prefix::with_prefix;

/// Composes the WGSL of `relievo_march` and `relievo_shadow` with everything they need but the textures, which the program
/// that includes it declares: see [`Permutation::texture_declarations`].
///
/// `relievo_ray_from_axes` makes rays from a view vector and the axes of the texture. See [`Composer`] for taking more or
/// other modules, or adding one's own.
///
/// # Errors
/// Never with the modules of this crate, as its tests show.
pub fn shader_source(permutation: &Permutation) -> Result<String, ComposeError> {
    relief_composer(permutation).compose(RELIEF)
}

/// Name of the module that imports all that [`shader_source`] has.
pub(crate) const RELIEF: &str = "relief";

/// Makes a composer with the module [`RELIEF`].
pub(crate) fn relief_composer(permutation: &Permutation) -> Composer {
    let mut composer = Composer::new(permutation);
    composer.add(RELIEF, "//! #import march\n//! #import shadow\n//! #import axes\n");
    composer
}

/// Composes [`shader_source`] and the declarations of its textures (group and first binding), with another prefix than
/// `relievo` for all names: for a second relief in the same shader. See [`with_prefix`].
///
/// ```
/// use relievo_march::{Shadow, Technique};
/// use relievo_shader::{Permutation, shader_source, shader_source_named};
///
/// let floor = Permutation { technique: Technique::Exact, ..Permutation::default() };
/// let wall = Permutation { technique: Technique::Relief, shadow: Shadow::Soft, ..Permutation::default() };
/// // relievo_march reads relievo_heights, wall_march reads wall_heights.
/// let wgsl = [
///     floor.texture_declarations(0, 0),
///     shader_source(&floor)?,
///     shader_source_named(&wall, "wall", 0, floor.textures().len() as u32)?,
/// ]
/// .concat();
/// assert!(wgsl.contains("fn relievo_march(") && wgsl.contains("fn wall_march("));
/// # Ok::<(), relievo_shader::ComposeError>(())
/// ```
///
/// # Errors
/// If the prefix is not made of lower-case words joined by single underscores.
pub fn shader_source_named(
    permutation: &Permutation,
    prefix: &str,
    group: u32,
    first_binding: u32,
) -> Result<String, ComposeError> {
    let source = permutation.texture_declarations(group, first_binding) + &shader_source(permutation)?;
    with_prefix(&source, prefix)
}
