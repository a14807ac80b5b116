use crate::composer::Composer;
use crate::error::ComposeError;
use crate::permutation::Permutation;

/// The WGSL of `relief_march` and `relief_shadow` with everything they need but the texture: the program that includes it
/// declares `relief_heights: texture_2d<f32>` where its bindings have it, and `relief_pyramid: texture_2d<u32>` if it chose
/// [`relievo_march::Technique::Exact`] or [`relievo_march::Shadow::Exact`]; [`relievo_march::Technique::Cone`] needs that too, and `relief_cones: texture_2d<u32>`.
///
/// The entry into the march from a view vector is in the module `tangent`; see [`Composer`] for taking more or other
/// modules, or adding one's own.
///
/// # Errors
/// Never with the modules of this crate, as its tests show.
pub fn shader_source(permutation: &Permutation) -> Result<String, ComposeError> {
    let mut composer = Composer::new(permutation);
    composer.add("relief", "//! #import march\n//! #import shadow\n");
    composer.compose("relief")
}
