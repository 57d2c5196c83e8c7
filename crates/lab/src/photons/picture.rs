//! The photon picture: stored photons as dots on the surfaces, as the camera sees them (Jensen 2001, Fig 5.4; SPEC PHT-11).
//!
//! A dot is as bright as a white surface would be there: the power of its photon times the density of photons around it, over
//! pi. Dots are discs on surfaces, as large as a pixel or so wherever they are: each ray of the camera looks for the nearest
//! photon within its own width. So they hide behind things, and any camera shows them.

use etendue_geometry::points::{Neighbours, PointTree};
use etendue_image::Image;
use etendue_math::{Point2, Ray};
use etendue_scene::Scene;
use rayon::prelude::*;

use super::PhotonCloud;

/// How dots are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureSettings {
    /// Radius of a dot in pixels.
    pub radius_px: f32,
    /// Photons by which density is told; 0 shows all dots alike bright.
    pub n_density: usize,
}

impl Default for PictureSettings {
    fn default() -> Self {
        Self { radius_px: 0.7, n_density: 50 }
    }
}

/// Rays across and down a pixel.
const SUBPIXELS: u32 = 3;

impl PhotonCloud {
    /// The picture, of the film's resolution. Surfaces without photons are black.
    #[must_use]
    pub fn picture(&self, scene: &Scene, settings: PictureSettings) -> Image {
        let tree = self.tree();
        let dots = self.dots(&tree, settings.n_density);
        let [width, height] = scene.film.resolution;
        let pixel = |index: u32, found: &mut Neighbours| {
            let mut sum = [0.0; 3];
            for sub in 0..SUBPIXELS * SUBPIXELS {
                let within = |k: u32| (k as f32 + 0.5) / SUBPIXELS as f32;
                let [x, y] = [
                    (index % width) as f32 + within(sub % SUBPIXELS),
                    (index / width) as f32 + within(sub / SUBPIXELS),
                ];
                if let Some(dot) = self.dot_at(scene, &tree, Point2::new(x, y), settings.radius_px, found) {
                    (0..3).for_each(|c| sum[c] += dots[dot][c]);
                }
            }
            sum.map(|value| value / (SUBPIXELS * SUBPIXELS) as f32)
        };
        let pixels: Vec<[f32; 3]> = (0..width * height)
            .into_par_iter()
            .map_init(Neighbours::new, |found, i| pixel(i, found))
            .collect();
        Image::rgb(width as usize, height as usize, pixels)
    }

    /// Colour of each photon's dot.
    fn dots(&self, tree: &PointTree, n_density: usize) -> Vec<[f32; 3]> {
        let n = self.photons.len().max(1) as f32;
        let total =
            self.photons.iter().flat_map(|photon| photon.power).map(|v| v.max(0.0)).sum::<f32>() / (3.0 * n);
        let dot = |found: &mut Neighbours, photon: &super::SeenPhoton| {
            if n_density == 0 {
                // Half of white in the mean.
                return photon.power.map(|value| 0.5 * value / total.max(f32::MIN_POSITIVE));
            }
            tree.nearest(photon.p, n_density + 1, f32::INFINITY, found);
            let radius_squared = found.iter().map(|near| near.distance_squared).fold(0.0, f32::max);
            // The photon itself is one of those found, and so says nothing of the density; nor does the farthest.
            // Of a single other one nothing is left, so it counts.
            let n_within = found.iter().len().saturating_sub(2).max(1) as f32;
            let density = n_within / (std::f32::consts::PI * radius_squared.max(1e-12));
            photon.power.map(|value| value * density * std::f32::consts::FRAC_1_PI)
        };
        self.photons.par_iter().map_init(Neighbours::new, dot).collect()
    }

    /// The photon whose dot a ray of the camera meets.
    fn dot_at(
        &self,
        scene: &Scene,
        tree: &PointTree,
        p_film: Point2,
        radius_px: f32,
        found: &mut Neighbours,
    ) -> Option<usize> {
        let middle = Point2::new(0.5, 0.5);
        let ray = scene.camera.sample_ray(p_film, middle, 0.5)?.ray;
        let hit = scene.intersect(&ray, f32::INFINITY)?;
        let surface = scene.surface(&ray, &hit);
        let p = surface.point.p;
        // Pixels are as wide there as the rays beside this one are apart.
        let beside = scene.camera.sample_ray(Point2::new(p_film.x + 1.0, p_film.y), middle, 0.5)?.ray;
        let radius = radius_px * distance_to_ray(&beside, &ray, hit.t);
        tree.nearest(p, 1, radius, found);
        let near = found.iter().next()?;
        let photon = &self.photons[near.index as usize];
        // Photons on the other side of thin things are not seen.
        (photon.n.dot_vector(surface.wo) > 0.0).then_some(near.index as usize)
    }
}

/// How far apart two rays are at a distance along them.
fn distance_to_ray(a: &Ray, b: &Ray, t: f32) -> f32 {
    ((a.origin + a.direction * t) - (b.origin + b.direction * t)).length()
}
