//! The radius of the first pass, for each place: so large that some photons of a pass fall within it, and not smaller than a
//! pixel.
//!
//! A few photons, the same for all passes, tell how dense they are everywhere. They are no part of the estimate, so that a
//! radius that follows their density is no bias.

use etendue_geometry::points::{Neighbours, PointTree};
use etendue_math::{Point2, Point3, Vector3};
use etendue_scene::Scene;
use rayon::prelude::*;

use super::ProgressiveSettings;
use super::families::Family;
use super::photons::receiving_lobes;
use crate::photon::{Onward, PhotonVertex, PhotonWalk, trace_photons};

/// Photons that are emitted to measure the density.
const N_PILOTS: u64 = 1 << 15;
/// Neighbours that tell the density at a pilot.
const N_NEIGHBOURS: usize = 12;
/// Photons of a group that are expected within the radius.
const N_WANTED: f32 = 10.0;
/// Least radius, in pixels.
const LEAST_PIXELS: f32 = 1.0;
/// Largest radius, in radii of the scene.
const LARGEST: f32 = 0.1;

/// The radius of the first pass.
#[derive(Clone, Debug)]
pub(super) enum FirstRadius {
    /// The same everywhere.
    Constant(f32),
    /// By the density of photons.
    Density(Density),
}

/// How dense photons are.
#[derive(Clone, Debug)]
pub(super) struct Density {
    pilots: PointTree,
    /// Radius at each of them.
    radii: Vec<f32>,
    /// Where there are none.
    largest: f32,
    footprint: Footprint,
}

impl FirstRadius {
    /// For groups of so many emitted photons.
    pub(super) fn new(
        scene: &Scene,
        settings: &ProgressiveSettings,
        families: &[Family],
        n_group: u64,
        least_depth: u32,
    ) -> Self {
        if let Some(radius) = settings.radius {
            return Self::Constant(radius);
        }
        let mut points = Vec::new();
        for family in families {
            let walk = PhotonWalk { stream: family.walk.stream + 1, ..family.walk };
            let n = N_PILOTS * family.n_photons / n_group;
            let keep = |_, vertex: &PhotonVertex<'_>, points: &mut Vec<Point3>| {
                let holds = family.holds(vertex);
                if holds == Some(true)
                    && vertex.depth >= least_depth
                    && !receiving_lobes(vertex.bsdf, settings.receiver_alpha).is_empty()
                {
                    points.push(vertex.surface.point.p);
                }
                if holds == Some(false) { Onward::Stop } else { Onward::Continue }
            };
            points.extend(trace_photons(scene, &family.emitter, 0..n, &walk, keep).0);
        }
        let pilots = PointTree::new(&points);
        let largest = LARGEST * scene.light_tables.scene_sphere.radius;
        // As many of the group's photons as are wanted, where so many pilots have so many neighbours.
        let share = N_WANTED / N_NEIGHBOURS as f32 * (N_PILOTS as f32 / n_group as f32);
        let radius = |found: &mut Neighbours, p: &Point3| {
            pilots.nearest(*p, N_NEIGHBOURS + 1, largest / share.sqrt(), found);
            (found.limit_squared() * share).sqrt().min(largest)
        };
        let radii = points.par_iter().map_init(Neighbours::new, radius).collect();
        Self::Density(Density { pilots, radii, largest, footprint: Footprint::new(scene) })
    }

    /// The radius at a place of geometric normal with that cosine to the ray, which has come so far from the camera.
    pub(super) fn at(&self, p: Point3, distance: f32, cosine: f32, found: &mut Neighbours) -> f32 {
        match self {
            Self::Constant(radius) => *radius,
            Self::Density(density) => density.radius(p, distance, cosine, found),
        }
    }
}

impl Density {
    fn radius(&self, p: Point3, distance: f32, cosine: f32, found: &mut Neighbours) -> f32 {
        self.pilots.nearest(p, 1, self.largest, found);
        let by_density = found.iter().next().map_or(self.largest, |pilot| self.radii[pilot.index as usize]);
        by_density.max(LEAST_PIXELS * self.footprint.at(distance) / cosine.max(0.1).sqrt())
    }
}

/// How wide a pixel is, seen straight from a distance: linear in it.
#[derive(Clone, Copy, Debug, Default)]
struct Footprint {
    at_camera: f32,
    per_metre: f32,
}

impl Footprint {
    fn new(scene: &Scene) -> Self {
        let [width, height] = scene.film.resolution;
        let middle = Point2::new(width as f32 / 2.0, height as f32 / 2.0);
        let Some(camera_ray) = scene.camera.sample_ray(middle, Point2::new(0.5, 0.5), 0.5) else {
            return Self::default();
        };
        let ray = camera_ray.ray;
        let width = |distance: f32| {
            let n = (-ray.direction).as_normal();
            let (dpdx, dpdy) = scene.camera.dpdx_dpdy(ray.origin + ray.direction * distance, n, ray.time, 1);
            (Vector3::length(dpdx) * dpdy.length()).sqrt()
        };
        let per_metre = (width(2.0) - width(1.0)).max(0.0);
        let at_camera = (width(1.0) - per_metre).max(0.0);
        let is_sound = per_metre.is_finite() && at_camera.is_finite();
        if is_sound { Self { at_camera, per_metre } } else { Self::default() }
    }

    fn at(&self, distance: f32) -> f32 {
        self.at_camera + self.per_metre * distance
    }
}
