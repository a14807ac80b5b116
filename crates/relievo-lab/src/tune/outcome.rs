use serde::Serialize;

use crate::technique::ResolvedTechnique;

/// A technique with settings that was tried.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Trial {
    /// The technique.
    #[serde(rename = "candidate")]
    pub technique: ResolvedTechnique,
    /// Its largest error over the angles that were tried.
    pub error: f64,
    /// The angle of that error, in degrees.
    pub angle: f32,
    /// True if it keeps the allowed error at every angle.
    pub keeps: bool,
    /// Mean fetches of a ray over the angles; `None` if not measured, since it does not keep the error.
    pub fetches: Option<f64>,
    /// Mean nanoseconds of a ray over the angles; `None` likewise.
    pub ns_per_ray: Option<f64>,
}

/// The outcome of tuning.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TuneOutcome {
    /// All trials, from the plainest technique to the finest.
    pub trials: Vec<Trial>,
    /// Index of the cheapest trial that keeps the error; `None` if none does.
    pub best: Option<usize>,
    /// The angles that were tried, in degrees.
    pub angles: Vec<f32>,
}

impl TuneOutcome {
    /// The cheapest trial that keeps the error.
    #[must_use]
    pub fn best(&self) -> Option<&Trial> {
        self.trials.get(self.best?)
    }

    /// The trial of a technique, by its name.
    #[must_use]
    pub fn trial(&self, technique: &str) -> Option<&Trial> {
        let technique: ResolvedTechnique = technique.parse().ok()?;
        self.trials.iter().find(|trial| trial.technique == technique)
    }
}
