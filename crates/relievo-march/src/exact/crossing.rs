/// The end of a march over cells.
pub(crate) enum SurfaceCrossing<F> {
    /// On or below the surface, for the first time.
    At(F),
    /// At its end, above the surface all along.
    None,
    /// Above the surface up to here, after as many cells as it may cross.
    CutOff(F),
}
