use relievo_journal::{Input, Work};

use super::figures::Machine;
use super::file_name::file_name;
use super::options::{PictureOptions, SweepOptions};
use crate::error::LabError;
use crate::material::TestMaterial;
use crate::measure::MarchBackend;

/// The kind of figures of a job.
pub(super) enum SweepJobKind {
    /// Hits and times, on the backend of this index.
    Hits { backend: usize },
    /// Pictures.
    Pictures,
}

/// One case to measure: all angles and techniques of a material at one depth, minification and backend.
pub(super) struct SweepJob<'a> {
    pub(super) material: &'a TestMaterial,
    pub(super) kind: SweepJobKind,
    /// The full depth, in texels of the full-size map.
    pub(super) depth: f32,
    pub(super) minification: u32,
}

/// Lists the jobs of a material.
pub(super) fn jobs<'a>(material: &'a TestMaterial, options: &SweepOptions, backends: usize) -> Vec<SweepJob<'a>> {
    let mut jobs = Vec::new();
    for backend in 0..backends {
        for &depth in &options.depths {
            for &minification in &options.minifications {
                jobs.push(SweepJob { material, kind: SweepJobKind::Hits { backend }, depth, minification });
            }
        }
    }
    if let Some(pictures) = &options.pictures {
        for &depth in &pictures.depths {
            for &minification in &pictures.minifications {
                jobs.push(SweepJob { material, kind: SweepJobKind::Pictures, depth, minification });
            }
        }
    }
    jobs
}

impl SweepJob<'_> {
    /// The name of the case: unique in a folder, and fit for a file's name.
    pub(super) fn name(&self, backends: &[MarchBackend]) -> String {
        let kind = match self.kind {
            SweepJobKind::Hits { backend } => backends[backend].backend(),
            SweepJobKind::Pictures => "pictures",
        };
        format!("{}-{kind}-{}-{}", file_name(&self.material.name), self.depth, self.minification)
    }

    /// The work of the case: everything that its figures depend on. Of the options it holds those of this case alone, so that
    /// the other cases may change.
    pub(super) fn work(
        &self,
        options: &SweepOptions,
        backends: &[MarchBackend],
        machine: &Machine,
    ) -> Result<Work, LabError> {
        let (depths, minifications) = (vec![self.depth], vec![self.minification]);
        let product = env!("CARGO_PKG_VERSION");
        let work = match (&self.kind, &options.pictures) {
            (SweepJobKind::Hits { backend }, _) => {
                let options = SweepOptions { depths, minifications, pictures: None, ..options.clone() };
                Work::new(product, &(backends[*backend].name(), machine.threads, options))
            }
            (SweepJobKind::Pictures, Some(pictures)) => {
                Work::new(product, &PictureOptions { depths, minifications, ..pictures.clone() })
            }
            (SweepJobKind::Pictures, None) => Work::new(product, &()),
        };
        Ok(work?.reading(Input::of_content(&self.material.name, self.material.fingerprint())))
    }
}
