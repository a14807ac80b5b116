/// Arithmetic that finds hits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Precision {
    /// Each material's own technique, in f32.
    #[default]
    Single,
    /// The f64 oracle, whatever the technique: the truth that techniques are judged by.
    Oracle,
}

/// Settings of a picture beside those of the scene.
#[derive(Clone, Copy, Default)]
pub struct RenderOptions<'a> {
    /// Threads to use; `None`: all cores.
    pub threads: Option<usize>,
    /// Arithmetic that finds hits.
    pub precision: Precision,
    /// Progress callback: (rows done, rows in all). Called from any thread.
    pub progress: Option<&'a (dyn Fn(u32, u32) + Sync)>,
}
