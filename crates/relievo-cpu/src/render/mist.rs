//! Mist before a surface or the background: single scattering.

use std::f32::consts::{PI, TAU};

use glam::Vec3;
use relievo_march::Shadow;

use super::Renderer;
use crate::shading::light::{Incoming, incoming};
use crate::surface::{MistPart, ViewRay};

impl Renderer {
    /// Returns the colour of a ray that ends at the distance `end` with `color`, seen through all mist before it.
    pub(super) fn through_mist(&self, mut color: Vec3, ray: &ViewRay<'_>, end: f32, rotation: f32) -> Vec3 {
        // The angle that turns a penumbra's points from pixel to pixel moves the points along a ray too.
        let offset = (rotation / TAU).fract();
        for part in self.mist_order.iter().filter_map(|&index| self.world.mist_part(index)) {
            if let Some(scattering) = part.scattering(ray.origin, ray.direction, [ray.near, end], offset) {
                let points = scattering.distances().iter().map(|&t| ray.origin + ray.direction * t);
                let arriving: Vec3 = points.map(|point| self.scattered(&part, point, ray.direction)).sum();
                let share = (1.0 - scattering.transmittance) / scattering.distances().len() as f32;
                color = color * scattering.transmittance + part.material.albedo() * arriving * share;
            }
        }
        color
    }

    /// Returns the fraction of a light that all mist lets through to a surface; of a light with a radius, from its middle.
    pub(super) fn mist_factor(&self, point: Vec3, arriving: &Incoming) -> f32 {
        self.world.mist_transmittance(point, arriving.direction, arriving.distance)
    }

    /// Returns the light that arrives at a point of mist, as far as it is scattered against `direction`.
    fn scattered(&self, part: &MistPart<'_>, point: Vec3, direction: Vec3) -> Vec3 {
        let shading = &self.shading;
        let mut sum = Vec3::splat(shading.ambient);
        if let Some(environment) = &self.environment {
            sum += environment.irradiance(part.up());
        }
        // Blinn-Phong's lights leave out the π that a matt surface divides by.
        let unit = if shading.model.is_physical() { 1.0 } else { PI };
        for light in &self.lights {
            let Some(arriving) = incoming(light, point, shading.model) else { continue };
            let factor = self.mist_light_factor(part, point, arriving.direction, arriving.distance);
            sum += arriving.color * (factor * unit * part.mist.phase(arriving.direction.dot(direction)));
        }
        sum
    }

    /// Returns the fraction of a light that reaches a point of mist, through the mist itself and past every surface.
    fn mist_light_factor(&self, part: &MistPart<'_>, point: Vec3, direction: Vec3, distance: f32) -> f32 {
        if part.material.relief.shadow == Shadow::None {
            return 1.0;
        }
        let factor = part.transmittance(point, direction, distance);
        if factor > 0.0 && self.world.is_hidden_from_space(point, direction, distance) { 0.0 } else { factor }
    }
}
