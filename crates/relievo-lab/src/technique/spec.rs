use std::fmt;

use relievo_march::Technique;
use relievo_scene::{Relief, SurfaceTechnique};

/// A technique with the settings that were asked for; a scene or the defaults fill in the others.
///
/// Written `relief`, `occlusion:8..32` (layers), `relief:8..32+5` (layers and bisections), `binary:8` (bisections),
/// `displacement:100` (vertices per side), `exact:cells` (no pyramid), or as a [`NamedTechnique`](crate::NamedTechnique).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct TechniqueSpec {
    /// The technique that finds the surface.
    pub technique: SurfaceTechnique,
    /// Vertices per side, for `displacement` only.
    pub grid: Option<u32>,
    /// Layers along the normal and along the surface, for the layered techniques only.
    pub layers: Option<[u32; 2]>,
    /// Bisections, for `relief` and `binary` only.
    pub refine_steps: Option<u32>,
    /// True if the exact march visits every cell, without the pyramid: a sweep measures that, a renderer cannot draw it.
    pub cell_by_cell: bool,
}

impl TechniqueSpec {
    /// A technique with all settings left to the scene.
    #[must_use]
    pub const fn of(technique: SurfaceTechnique) -> Self {
        Self { technique, grid: None, layers: None, refine_steps: None, cell_by_cell: false }
    }

    /// A marching technique with all settings left to the scene.
    #[must_use]
    pub const fn marched(technique: Technique) -> Self {
        Self::of(SurfaceTechnique::Marched(technique))
    }

    /// A layered technique with these layers along the normal and along the surface.
    #[must_use]
    pub const fn layered(technique: Technique, layers: [u32; 2], refine_steps: Option<u32>) -> Self {
        Self { layers: Some(layers), refine_steps, ..Self::marched(technique) }
    }

    /// Displaced geometry with this number of vertices per side.
    #[must_use]
    pub const fn displacement(grid: u32) -> Self {
        Self { grid: Some(grid), ..Self::of(SurfaceTechnique::Displacement) }
    }

    /// The exact march over every cell, without the pyramid.
    #[must_use]
    pub const fn exact_cells() -> Self {
        Self { cell_by_cell: true, ..Self::marched(Technique::Exact) }
    }

    /// Every marching technique, and the tutorials' coarse and fine displaced grids.
    #[must_use]
    pub fn all() -> Vec<Self> {
        Technique::ALL.into_iter().map(Self::marched).chain([10, 100].map(Self::displacement)).collect()
    }

    /// Returns true if the technique samples layers.
    #[must_use]
    pub fn has_layers(&self) -> bool {
        use Technique::{Contact, Occlusion, Relief, Steep};
        matches!(self.technique, SurfaceTechnique::Marched(Steep | Relief | Occlusion | Contact))
    }

    /// Returns true if the technique bisects.
    #[must_use]
    pub fn has_refine_steps(&self) -> bool {
        matches!(self.technique, SurfaceTechnique::Marched(Technique::Relief | Technique::Binary))
    }

    /// Replaces a relief's technique; settings that are not specified stay as they are.
    pub fn apply(&self, relief: &mut Relief) {
        relief.technique = self.technique;
        if let Some(grid) = self.grid {
            (relief.grid, relief.vertices_per_texel) = (grid, None);
        }
        if let Some([min, max]) = self.layers {
            (relief.min_layers, relief.max_layers) = (min as f32, max as f32);
        }
        relief.refine_steps = self.refine_steps.or(relief.refine_steps);
    }
}

impl fmt::Display for TechniqueSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.technique.name())?;
        match (self.grid, self.layers, self.refine_steps) {
            _ if self.cell_by_cell => f.write_str(":cells"),
            (Some(grid), _, _) => write!(f, ":{grid}"),
            (_, Some([min, max]), Some(steps)) => write!(f, ":{min}..{max}+{steps}"),
            (_, Some([min, max]), None) => write!(f, ":{min}..{max}"),
            (_, None, Some(steps)) => write!(f, ":{steps}"),
            (None, None, None) => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_open_stays_as_the_scene_has_it() {
        let mut relief = Relief { grid: 7, min_layers: 3.0, refine_steps: Some(9), ..Relief::default() };
        TechniqueSpec::of(SurfaceTechnique::Displacement).apply(&mut relief);
        assert_eq!((relief.grid, relief.min_layers, relief.refine_steps), (7, 3.0, Some(9)));
        TechniqueSpec::layered(Technique::Relief, [4, 20], None).apply(&mut relief);
        assert_eq!((relief.min_layers, relief.max_layers, relief.refine_steps), (4.0, 20.0, Some(9)));
    }
}
