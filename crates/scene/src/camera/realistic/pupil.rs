//! Where on the rear plane light gets through: the bounds of the exit pupil by distance from the axis.
//!
//! A pupil is a spot of the plane through the rear vertex, nearly convex, small if the stop is, and often far from the middle
//! of the rear surface. What is searched for is the pupil of a stop that is a full disc, whatever the form of its opening: forms
//! lie within their disc, and need be neither convex nor in its middle. A grid closes in on it, through a stop that is opened
//! wide first if few points of the grid see through, and closed step by step.
//!
//! Between the points that see through and the rim of a disc of radius R there is less than a cell and the part of a cell
//! 1 / (8 R / cell); bounds are wider than the points by more, so that only the tips of narrow crescents are lost.

use etendue_math::{Bounds2, Point2, Point3, Ray, Vector2};
use rayon::prelude::*;

use super::irradiance_per_area;
use super::trace::Barrel;

/// Distances from the axis between which pupils are taken as alike, as in pbrt.
const N_INTERVALS: usize = 64;
/// Points across a grid.
const N_GRID: usize = 32;
/// What of a grid must see through, in cells each way, before the search closes in.
const LEAST_SPAN: f32 = 4.0;
/// By how many cells bounds are wider than the points that see through, while the search closes in.
const SEARCH_MARGIN: f32 = 2.0;
/// And in the end: narrower bounds waste fewer rays.
const FINAL_MARGIN: f32 = 1.5;
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
    let (mut step, mut found) = (0, open_cells(barrel, film, whole, 0));
    while step + 1 < MOST_STEPS && !found.is_some_and(|cells| cells.span() >= LEAST_SPAN) {
        step += 1;
        found = open_cells(barrel, film, whole, step);
    }
    let mut bounds = found?.bounds(whole, SEARCH_MARGIN);
    for step in (0..=step).rev() {
        // Closes in until that gains little.
        loop {
            let cells = open_cells(barrel, film, bounds, step)?;
            let closer = cells.bounds(bounds, SEARCH_MARGIN);
            let gain = closer.area() / bounds.area();
            if gain.is_nan() || gain >= 0.7 {
                if step == 0 {
                    return Some(cells.bounds(bounds, FINAL_MARGIN));
                }
                break;
            }
            bounds = closer;
        }
    }
    None
}

/// The first and the last point of a grid that light passes, each way, in cells.
#[derive(Clone, Copy, Debug)]
struct Cells {
    first: Vector2,
    last: Vector2,
}

impl Cells {
    /// How many cells they span, the shorter way.
    fn span(self) -> f32 {
        let span = self.last - self.first;
        span.x.min(span.y) + 1.0
    }

    /// Their bounds in the region of the grid, widened by so many cells.
    fn bounds(self, region: Bounds2, margin: f32) -> Bounds2 {
        let cell = (region.max - region.min) / N_GRID as f32;
        let at = |place: Vector2| region.min + Vector2::new(place.x * cell.x, place.y * cell.y);
        Bounds2::new(at(self.first - Vector2::splat(margin)), at(self.last + Vector2::splat(margin)))
    }
}

/// The grid's points that light passes through a stop that is opened by so many steps.
fn open_cells(barrel: &Barrel, film: Point3, region: Bounds2, step: i32) -> Option<Cells> {
    let cell = (region.max - region.min) / N_GRID as f32;
    let widened = WIDENING.powi(step);
    let mut open: Option<Cells> = None;
    for i in 0..N_GRID * N_GRID {
        let (x, y) = ((i % N_GRID) as f32 + 0.5, (i / N_GRID) as f32 + 0.5);
        let p = region.min + Vector2::new(x * cell.x, y * cell.y);
        if ray_to(film, p, barrel.rear_z()).is_some_and(|ray| barrel.passes_disc(ray, widened)) {
            let Cells { first, last } =
                open.unwrap_or(Cells { first: Vector2::new(x, y), last: Vector2::new(x, y) });
            open = Some(Cells {
                first: Vector2::new(first.x.min(x), first.y.min(y)),
                last: Vector2::new(last.x.max(x), last.y.max(y)),
            });
        }
    }
    open
}
