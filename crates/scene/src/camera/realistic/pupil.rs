//! Where on the rear plane light gets through: the bounds of the exit pupil by distance from the axis.
//!
//! A pupil is a convex spot of the plane through the rear vertex, small if the stop is, and often far from the middle of the
//! rear surface. It is searched for by a grid that closes in on it, through a stop that is opened wide first if the grid finds
//! nothing, and closed step by step.

use etendue_math::{Bounds2, Point2, Point3, Ray, Vector2};
use rayon::prelude::*;

use super::irradiance_per_area;
use super::trace::Barrel;

/// Distances from the axis between which pupils are taken as alike, as in pbrt.
const N_INTERVALS: usize = 64;
/// Points across a grid. Bounds end up wider than the pupil by two of its cells.
const N_GRID: usize = 32;
/// The stop is opened by powers of this, so that what passed before spans several cells when it is closed again.
const WIDENING: f32 = 4.0;
/// Most such steps: a stop of 1 um is found in a lens of 1 m.
const MOST_STEPS: i32 = 10;

/// Bounds of the exit pupil, on the rear plane, by distance of the film point from the axis; for film points on +x.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ExitPupils {
    /// `None` where no light gets through.
    bounds: Vec<Option<Bounds2>>,
    /// Largest distance, in metres.
    max_distance: f32,
}

impl ExitPupils {
    /// Finds the pupils for film points up to `max_distance` metres from the axis.
    pub(super) fn new(barrel: &Barrel, max_distance: f32) -> Self {
        // Each interval holds what its ends see: pupils move steadily.
        let found: Vec<Option<Bounds2>> = (0..=N_INTERVALS)
            .into_par_iter()
            .map(|i| {
                let x = max_distance * i as f32 / N_INTERVALS as f32;
                find_pupil(barrel, Point3::new(x, 0.0, 0.0))
            })
            .collect();
        let join = |points: &[Option<Bounds2>]| points.iter().flatten().copied().reduce(join_bounds);
        let bounds = (0..N_INTERVALS).map(|i| join(&found[i..=i + 1])).collect();
        Self { bounds, max_distance }
    }

    /// True if some light gets through.
    pub(super) fn is_open(&self) -> bool {
        self.bounds.iter().any(Option::is_some)
    }

    /// A uniformly distributed point of the bounds for a film point, and their area in square metres.
    pub(super) fn sample(&self, film: Point3, rear_z: f32, u: Point2) -> Option<(Point3, f32)> {
        let r = film.x.hypot(film.y);
        let interval = ((r / self.max_distance * N_INTERVALS as f32) as usize).min(N_INTERVALS - 1);
        let Bounds2 { min, max } = self.bounds[interval]?;
        let (x, y) = (min.x + (max.x - min.x) * u.x, min.y + (max.y - min.y) * u.y);
        let (cos, sin) = if r > 0.0 { (film.x / r, film.y / r) } else { (1.0, 0.0) };
        let p = Point3::new(cos * x - sin * y, sin * x + cos * y, rear_z);
        Some((p, (max.x - min.x) * (max.y - min.y)))
    }

    /// Irradiance in the middle of the film by radiance 1.
    pub(super) fn axial_irradiance(&self, barrel: &Barrel) -> f32 {
        const N: usize = 256;
        let Some(Bounds2 { min, max }) = self.bounds[0] else { return 0.0 };
        let size = max - min;
        let sum: f64 = (0..N * N)
            .map(|i| {
                let place = |k: usize| (k as f32 + 0.5) / N as f32;
                let p = min + Vector2::new(size.x * place(i % N), size.y * place(i / N));
                let Some(ray) = ray_to(Point3::ORIGIN, p, barrel.rear_z()) else { return 0.0 };
                let cos_theta = ray.direction.z;
                let open = barrel.trace(ray).map_or(0.0, |(_, open)| open);
                f64::from(open * irradiance_per_area(cos_theta, barrel.rear_z()))
            })
            .sum();
        (sum * f64::from(size.x * size.y) / (N * N) as f64) as f32
    }
}

fn join_bounds(a: Bounds2, b: Bounds2) -> Bounds2 {
    Bounds2::new(
        Point2::new(a.min.x.min(b.min.x), a.min.y.min(b.min.y)),
        Point2::new(a.max.x.max(b.max.x), a.max.y.max(b.max.y)),
    )
}

fn ray_to(film: Point3, p: Point2, rear_z: f32) -> Option<Ray> {
    let direction = Point3::new(p.x, p.y, rear_z) - film;
    Some(Ray::new(film, direction.try_normalized()?))
}

/// The bounds of what of the rear plane a film point sees the scene through.
fn find_pupil(barrel: &Barrel, film: Point3) -> Option<Bounds2> {
    // A rear surface that is curved reaches beyond its clear radius on the plane through its vertex.
    let half = Vector2::splat(1.5 * barrel.rear_radius());
    let whole = Bounds2::new(Point2::new(0.0, 0.0) - half, Point2::new(0.0, 0.0) + half);
    let widened = |step: i32| WIDENING.powi(step);
    let (steps, mut bounds) =
        (0..MOST_STEPS).find_map(|step| Some((step, open_cells(barrel, film, whole, widened(step))?)))?;
    for step in (0..=steps).rev() {
        // Closes in until that gains little.
        loop {
            let closer = open_cells(barrel, film, bounds, widened(step))?;
            let gain = closer.area() / bounds.area();
            bounds = closer;
            if gain.is_nan() || gain >= 0.7 {
                break;
            }
        }
    }
    Some(bounds)
}

/// The bounds of the grid's points that light passes, widened by a cell.
fn open_cells(barrel: &Barrel, film: Point3, region: Bounds2, widened: f32) -> Option<Bounds2> {
    let cell = (region.max - region.min) / N_GRID as f32;
    let mut open: Option<Bounds2> = None;
    for i in 0..N_GRID * N_GRID {
        let (x, y) = ((i % N_GRID) as f32 + 0.5, (i / N_GRID) as f32 + 0.5);
        let p = region.min + Vector2::new(x * cell.x, y * cell.y);
        if ray_to(film, p, barrel.rear_z()).is_some_and(|ray| barrel.trace_widened(ray, widened).is_some()) {
            let this = Bounds2::new(p - cell, p + cell);
            open = Some(open.map_or(this, |open| join_bounds(open, this)));
        }
    }
    open
}
