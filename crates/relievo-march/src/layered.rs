//! The layered searches: approximate, each with a refinement of its own.

use crate::{HeightField, MAX_REFINE_STEPS, MarchOptions, Ray, Record};

/// The layer in which a linear search went below the surface.
struct LayerCrossing {
    /// The sample below (or on) the surface.
    uv: [f32; 2],
    /// Its layer's depth.
    t: f32,
    /// D at `uv`.
    surface: f32,
    /// The uv travelled per layer.
    step: [f32; 2],
    /// One layer.
    layer: f32,
    samples: u32,
}

impl LayerCrossing {
    /// Returns the record of a technique that ends at this uv and depth.
    fn record(&self, uv: [f32; 2], t: f32, more_samples: u32) -> Record {
        Record {
            uv,
            depth: t.clamp(0.0, 1.0),
            hit: true,
            fetches: self.samples + more_samples,
            iterations: self.samples + more_samples,
        }
    }
}

/// Steps down from `uv`, at depth `t`, in layers of depth `layer`, to the first sample that lies below the surface.
fn linear_search(
    field: &impl HeightField,
    mut uv: [f32; 2],
    mut t: f32,
    slope: [f32; 2],
    layer: f32,
    max_steps: u32,
) -> LayerCrossing {
    let step = slope.map(|s| s * layer);
    let mut surface = 1.0 - field.sample(uv);
    let mut samples = 1;
    // Two more than the number of layers: sums of fractions may stay a rounding error below 1.
    while t < surface && samples <= max_steps {
        uv = [uv[0] + step[0], uv[1] + step[1]];
        surface = 1.0 - field.sample(uv);
        t += layer;
        samples += 1;
    }
    LayerCrossing { uv, t, surface, step, layer, samples }
}

/// Searches all layers from the lid down.
fn search_layers(field: &impl HeightField, ray: &Ray, options: &MarchOptions) -> LayerCrossing {
    let n = options.layers(ray.cos);
    linear_search(field, ray.uv, 0.0, options.layered_slope(ray), 1.0 / n, n.ceil() as u32 + 1)
}

/// Steep parallax mapping: the first layer below the surface.
pub(crate) fn steep(field: &impl HeightField, ray: &Ray, options: &MarchOptions) -> Record {
    let found = search_layers(field, ray, options);
    found.record(found.uv, found.t, 0)
}

/// Relief mapping: halves the last layer again and again.
pub(crate) fn relief(field: &impl HeightField, ray: &Ray, options: &MarchOptions) -> Record {
    let found = search_layers(field, ray, options);
    let steps = options.refine_steps.min(MAX_REFINE_STEPS);
    // Both move by the same signed fraction of the layer: back where the sample is below the surface, on where above.
    let (mut back, mut half) = (0.5, 0.5);
    let at = |back: f32| [found.uv[0] - found.step[0] * back, found.uv[1] - found.step[1] * back];
    for _ in 0..steps {
        half *= 0.5;
        let below = found.t - found.layer * back >= 1.0 - field.sample(at(back));
        back += if below { half } else { -half };
    }
    found.record(at(back), found.t - found.layer * back, steps)
}

/// Parallax occlusion mapping: one secant step between the samples above and below.
pub(crate) fn occlusion(field: &impl HeightField, ray: &Ray, options: &MarchOptions) -> Record {
    let found = search_layers(field, ray, options);
    let previous = [found.uv[0] - found.step[0], found.uv[1] - found.step[1]];
    let after = found.surface - found.t;
    let before = (1.0 - field.sample(previous)) - found.t + found.layer;
    // Both zero: the surface runs along the ray, and any point between is right.
    let weight = if after == before { 0.0 } else { after / (after - before) };
    let uv = [0, 1].map(|k| previous[k] * weight + found.uv[k] * (1.0 - weight));
    found.record(uv, found.t - found.layer * weight, 1)
}

/// Contact refinement: goes back one layer and marches it again in layers n times finer.
pub(crate) fn contact(field: &impl HeightField, ray: &Ray, options: &MarchOptions) -> Record {
    let coarse = search_layers(field, ray, options);
    if coarse.t <= 0.0 {
        return coarse.record(coarse.uv, coarse.t, 0);
    }
    let n = options.layers(ray.cos);
    let start = [coarse.uv[0] - coarse.step[0], coarse.uv[1] - coarse.step[1]];
    let fine = linear_search(
        field,
        start,
        coarse.t - coarse.layer,
        options.layered_slope(ray),
        coarse.layer / n,
        n.ceil() as u32 + 1,
    );
    fine.record(fine.uv, fine.t, coarse.samples)
}

/// Bisection of the whole depth, without a linear search: fast, and wrong where the ray crosses the surface twice.
pub(crate) fn bisect(field: &impl HeightField, ray: &Ray, options: &MarchOptions) -> Record {
    let steps = options.refine_steps.min(MAX_REFINE_STEPS);
    let (mut above, mut below) = (0.0f32, 1.0f32);
    for _ in 0..steps {
        let middle = 0.5 * (above + below);
        if middle >= 1.0 - field.sample(ray.at(middle)) {
            below = middle;
        } else {
            above = middle;
        }
    }
    let t = 0.5 * (above + below);
    Record { uv: ray.at(t), depth: t, hit: true, fetches: steps, iterations: steps }
}
