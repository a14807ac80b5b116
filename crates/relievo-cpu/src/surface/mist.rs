//! Rays through mist.

use glam::Vec3;
use relievo_march::{Medium, ObjectField, optical_depth, scatter_distances};
use relievo_scene::{Mist, MistSpan, MistVolume};

use crate::geometry::World;
use crate::shading::material::MaterialShading;

/// A space of mist with its material.
pub(crate) struct MistPart<'a> {
    volume: &'a MistVolume,
    pub(crate) material: &'a MaterialShading,
    pub(crate) mist: Mist,
    medium: Medium,
    field: ObjectField<'a>,
}

/// The light of a ray that mist has scattered.
pub(crate) struct Scattering {
    /// Fraction of the light from behind that comes through.
    pub(crate) transmittance: f32,
    /// Distances along the ray at which equal shares of the rest were scattered.
    distances: [f32; Mist::MAX_STEPS as usize],
    count: usize,
}

impl Scattering {
    /// Returns the distances along the ray at which equal shares of the light were scattered.
    pub(crate) fn distances(&self) -> &[f32] {
        &self.distances[..self.count]
    }
}

impl World {
    /// Returns a space of mist of [`World::mists`] with its material.
    pub(crate) fn mist_part(&self, index: usize) -> Option<MistPart<'_>> {
        let volume = &self.mists[index];
        let material = &self.materials[volume.material];
        let mist = material.mist?;
        let field = material.whole_field()?;
        Some(MistPart { volume, material, mist, medium: mist.medium(), field })
    }

    /// Returns the fraction of the light in `direction` at `distance` that all mist lets through to a point.
    pub(crate) fn mist_transmittance(&self, point: Vec3, direction: Vec3, distance: f32) -> f32 {
        let parts = (0..self.mists.len()).filter_map(|index| self.mist_part(index));
        parts.map(|part| part.transmittance(point, direction, distance)).product()
    }
}

impl MistPart<'_> {
    /// Returns the unit vector that points up out of the mist.
    pub(crate) fn up(&self) -> Vec3 {
        self.volume.gradients[2].normalize_or_zero()
    }

    /// Returns the fraction of light that passes between a point and another in `direction` at `distance`.
    pub(crate) fn transmittance(&self, point: Vec3, direction: Vec3, distance: f32) -> f32 {
        let Some(MistSpan { length, ray, .. }) = self.volume.span(point, direction, [0.0, distance]) else {
            return 1.0;
        };
        optical_depth(&self.field, &ray, [0.0, length], &self.medium).transmittance()
    }

    /// Finds where the light along a view ray between two distances was scattered; `offset` in [0, 1) moves the points.
    pub(crate) fn scattering(&self, origin: Vec3, direction: Vec3, range: [f32; 2], offset: f32) -> Option<Scattering> {
        let MistSpan { start, length, ray } = self.volume.span(origin, direction, range)?;
        let total = optical_depth(&self.field, &ray, [0.0, length], &self.medium);
        let transmittance = total.transmittance();
        if transmittance >= 1.0 {
            return None;
        }
        let mut scattering = Scattering { transmittance, distances: [0.0; _], count: self.mist.steps as usize };
        let distances = &mut scattering.distances[..scattering.count];
        scatter_distances(&self.field, &ray, [0.0, length], &self.medium, &total, offset, distances);
        distances.iter_mut().for_each(|distance| *distance += start);
        Some(scattering)
    }
}
