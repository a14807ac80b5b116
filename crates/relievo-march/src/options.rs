use crate::{Bounds, Cones, Ray, Technique};

/// The most layers; more are taken as this many, so that every loop is bounded.
pub const MAX_LAYERS: f32 = 4096.0;

/// The most bisections; more are taken as this many: f32 has nothing left to halve.
pub const MAX_REFINE_STEPS: u32 = 64;

/// The technique of a march and its settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarchOptions {
    /// The technique.
    pub technique: Technique,
    /// True if the layered techniques and their shadows drop the division by V.z.
    pub offset_limiting: bool,
    /// Layers when looking along the normal; 1 to [`MAX_LAYERS`].
    pub min_layers: f32,
    /// Layers when looking along the surface; 1 to [`MAX_LAYERS`]. Also the most steps of relaxed cones, at any angle.
    pub max_layers: f32,
    /// Bisections of `relief` and `binary`, and the most that relaxed cones take; at most [`MAX_REFINE_STEPS`].
    pub refine_steps: u32,
    /// The cones that `cone` steps through. The field has to have them: see [`crate::ReliefMap::with_cones`].
    pub cones: Cones,
    /// The height that lies at `ray.uv`, on the polygon: with less than 1 the relief rises above it, and the march starts
    /// at its lid, the height 1. In [0, 1].
    pub midlevel: f32,
    /// The bounds of the surface (`edge = "clip"`); without, it tiles for ever.
    pub bounds: Option<Bounds>,
}

impl Default for MarchOptions {
    fn default() -> Self {
        Self {
            technique: Technique::default(),
            offset_limiting: false,
            min_layers: 8.0,
            max_layers: 32.0,
            refine_steps: 5,
            cones: Cones::default(),
            midlevel: 1.0,
            bounds: None,
        }
    }
}

impl MarchOptions {
    /// Returns the number of layers for a ray with this cosine: `mix(max, min, |cos|)`, used with its fraction.
    #[inline]
    #[must_use]
    pub fn layers(&self, cos: f32) -> f32 {
        // Where the normal leans, the height along a ray grows faster than its length.
        let n = self.max_layers + (self.min_layers - self.max_layers) * cos.abs().min(1.0);
        // `max` first: it also turns NaN into 1.
        n.max(1.0).min(MAX_LAYERS)
    }

    /// Returns the most cells that a march through relaxed cones looks at, before it takes the point it has reached.
    pub(crate) fn cone_steps(&self) -> u32 {
        self.max_layers.max(1.0).min(MAX_LAYERS).ceil() as u32
    }

    /// Moves the ray along itself from the polygon to the lid.
    #[must_use]
    pub fn on_lid(&self, ray: &Ray) -> Ray {
        let lid_offset = self.lid_offset();
        if lid_offset == 0.0 {
            return *ray;
        }
        let slope = self.search_slope(ray);
        Ray { uv: [ray.uv[0] - slope[0] * lid_offset, ray.uv[1] - slope[1] * lid_offset], ..*ray }
    }

    /// Returns the uv travelled from the lid to the floor by this technique.
    #[inline]
    pub(crate) fn search_slope(&self, ray: &Ray) -> [f32; 2] {
        match self.technique {
            Technique::Steep | Technique::Relief | Technique::Occlusion | Technique::Contact => self.layered_slope(ray),
            _ => ray.slope(),
        }
    }

    /// Returns the distance of the lid above the polygon, as a fraction of the full depth.
    #[inline]
    pub(crate) fn lid_offset(&self) -> f32 {
        1.0 - self.midlevel.max(0.0).min(1.0)
    }

    /// Returns the uv travelled from the lid to the floor by the layered techniques.
    #[inline]
    pub(crate) fn layered_slope(&self, ray: &Ray) -> [f32; 2] {
        if self.offset_limiting { ray.uv_delta } else { ray.slope() }
    }
}
