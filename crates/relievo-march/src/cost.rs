/// The longest march over cells. A ray 0.5° above the surface crosses fewer even in a relief 100 texels deep; a longer one
/// has its hit where it is then: thousands of texels share its pixel.
pub const MAX_CELLS: u32 = 1 << 16;

/// The cost of a march over cells.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct MarchCost {
    /// Nodes and cells that were loaded.
    pub(crate) fetches: u32,
    /// The cells among them.
    pub(crate) gathers: u32,
    /// Iterations of the loop.
    pub(crate) iterations: u32,
}
