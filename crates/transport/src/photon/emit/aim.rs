//! Projection maps: where a light has something to meet (SPEC EMI-10; Jensen 1993, "Global Illumination Using Photon Maps"; Jensen and
//! Christensen 1995, "Photon Maps in Bidirectional Monte Carlo Ray Tracing of Complex Objects").
//!
//! Balls cover what photons are aimed at ([`Geometry::covering_spheres`](etendue_geometry::Geometry::covering_spheres)). A light that
//! is a point or a lamp divides its directions into cells, each active if a ray from anywhere on the light in one of its directions may meet a
//! ball; parallel light divides a plane across it. Photons leave through active cells only, and carry as much less flux as those
//! have of the whole, so that what the light does to its targets stays the same in expectation; what would miss all of them is
//! left out. Other lights at infinity choose a direction first and then a ball whose shadow they hit; where shadows overlap,
//! the flux is divided by their number. Of curved lamps photons that are off their targets are not sent.
//!
//! SPEC EMI-10 names three schemes: (a) to go round the active cells, (b) to draw directions until one is active, (c) to draw an
//! active cell, then a direction in it. (b) and (c) are the same density, and here by choice. (a) is biased where the number of
//! photons is no multiple of that of the cells, and not offered: the stratified pattern over (c) spreads photons as evenly.

use std::f32::consts::FRAC_1_PI;

use etendue_geometry::BoundingSphere;
use etendue_math::{Bounds2, Bounds3, Frame, PiecewiseConstant2, Point2, Point3, Ray, Rng, Vector3, warp};
use etendue_scene::light::{Directions, EmittedRay, Light, LightContext};
use etendue_spectrum::Wavelengths;

use super::chart::Chart;
use super::targets::{Targets, rounding};

/// How photons find active cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MapScheme {
    /// (c): an active cell by chance, then a direction in it.
    #[default]
    Cell,
    /// (b): directions by chance until one lies in an active cell. Spoils the evenness of patterns.
    Retry,
}

impl MapScheme {
    /// Names in scene files.
    pub const NAMES: [(&'static str, Self); 2] = [("cell", Self::Cell), ("retry", Self::Retry)];
}

/// Most tries of [`MapScheme::Retry`], and the least share of active cells for which it is used: of those photons one in
/// e^100 is lost.
const MAX_TRIES: u32 = 10_000;
const LEAST_RETRY_SHARE: f64 = 0.01;

/// Share of photons of lights that a map may know badly, such as those with pictures, that leave by the light's own density, so that none carries more than ten times what
/// it would without a map, even where a feature of the picture is smaller than a cell.
const DEFENCE: f32 = 0.1;

/// What a cell without light that was found has of the mean of all, where there may be some.
const FLOOR: f32 = 1e-3;

/// Most cells of the maps of all lights together: some 100 MB.
const MAX_CELLS: usize = 1 << 22;

/// Places along the side of a cell where pictured lights are looked at.
const N_LOOKS: usize = 4;

/// From which share of active cells on a map does not pay.
const USELESS_SHARE: f64 = 0.95;

/// With fewer active cells a map tells little of where its targets are, and is made anew for the cone that holds them.
const FEW_CELLS: usize = 64;

/// Cells along the side of each map of so many lights, if they want `n`.
pub(super) fn affordable_side(n: usize, n_lights: usize) -> usize {
    let n_each = MAX_CELLS / (2 * n_lights.max(1));
    n.min(n_each.isqrt()).max(2)
}

/// The map of a light.
#[derive(Clone, Debug)]
pub(super) enum Aim {
    /// Cells of directions.
    Directions(DirectionMap),
    /// Cells of a plane across parallel light.
    Plane(PlaneMap),
    /// Shadows of balls across the light.
    Discs(Vec<BoundingSphere>),
    /// Cells of directions outside of which nothing is sent.
    Sieve(DirectionMap),
}

/// What a map does with a light.
pub(super) enum Aimed {
    /// Nothing: it sends light wherever it may.
    Everywhere,
    /// It meets no target.
    Nowhere,
    /// It sends this share of its flux.
    Towards(Box<Aim>, f64),
}

impl Aim {
    /// The map of a light, whose squares are cut into `n` by `n` cells.
    pub(super) fn of(
        light: &Light,
        context: &LightContext,
        targets: &Targets,
        n: usize,
        scheme: MapScheme,
    ) -> Aimed {
        if targets.spheres.is_empty() {
            return Aimed::Nowhere;
        }
        if let Directions::Parallel(w) = light.directions(context) {
            return PlaneMap::across(w, &targets.spheres, context, n);
        }
        if light.is_infinite() {
            return discs(light, &targets.few_spheres, context);
        }
        let Some(bounds) = light.bounds(context) else { return Aimed::Everywhere };
        let Some(place) = ball_around(bounds.bounds) else { return Aimed::Everywhere };
        let chart = Chart::of(light.directions(context));
        let map_of = |view| DirectionMap::new(light, context, view, place, targets, n, scheme);
        let Some(mut map) = map_of(View::Whole(chart.unwrap_or(Chart::SPHERE))) else {
            return Aimed::Everywhere;
        };
        if chart.is_some()
            && (1..FEW_CELLS).contains(&map.n_active)
            && let Some(closer) = targets.cone_from(place).and_then(|chart| map_of(View::Part(chart)))
        {
            map = closer;
        }
        match map.share {
            share if share <= 0.0 => Aimed::Nowhere,
            share if share >= USELESS_SHARE => Aimed::Everywhere,
            share if chart.is_none() => Aimed::Towards(Box::new(Self::Sieve(map)), share),
            share => Aimed::Towards(Box::new(Self::Directions(map)), share),
        }
    }

    /// A ray of the light.
    pub(super) fn emit(
        &self,
        light: &Light,
        context: &LightContext,
        [u_position, u_direction]: [Point2; 2],
        u: f32,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        match self {
            Self::Directions(map) => map.emit(light, context, [u_position, u_direction], u, lambda),
            Self::Sieve(map) => {
                let emitted = light.sample_le(context, u_position, u_direction, lambda)?;
                map.is_active(emitted.ray.direction).then_some(emitted)
            }
            Self::Plane(map) => {
                let emitted = light.sample_le(context, u_position, u_direction, lambda)?;
                let (origin, pdf_a) = map.sample(u_position);
                Some(EmittedRay { ray: Ray::new(origin, emitted.ray.direction), pdf_a, ..emitted })
            }
            Self::Discs(spheres) => {
                let emitted = light.sample_le(context, u_position, u_direction, lambda)?;
                let (ray, pdf_a) = sample_discs(spheres, emitted.ray.direction, u_position, context)?;
                Some(EmittedRay { ray, pdf_a, ..emitted })
            }
        }
    }
}

/// The ball around a box, which may be a point.
fn ball_around(bounds: Bounds3) -> Option<BoundingSphere> {
    BoundingSphere::around(bounds).filter(|ball| ball.radius.is_finite() && ball.centre.is_finite())
}

/// Cells of a light's directions.
#[derive(Clone, Debug)]
pub(super) struct DirectionMap {
    chart: Chart,
    /// Flux of the active cells, 0 for others.
    active: PiecewiseConstant2,
    /// Flux of all cells, to draw from until one is active.
    all: Option<PiecewiseConstant2>,
    n_active: usize,
    /// Share of the flux in active cells.
    share: f64,
    /// Share of the photons that leave by the light's own density.
    defence: f32,
}

/// The directions that a map is of.
#[derive(Clone, Copy)]
enum View {
    /// All that the light has.
    Whole(Chart),
    /// Some of them.
    Part(Chart),
}

/// A cone of directions, ready for comparison.
#[derive(Clone, Copy)]
struct Cone {
    axis: Vector3,
    sin: f32,
    cos: f32,
}

impl Cone {
    fn new(axis: Vector3, angle: f32) -> Self {
        let (sin, cos) = angle.min(std::f32::consts::PI).sin_cos();
        Self { axis, sin, cos }
    }

    fn of_cosine(axis: Vector3, cos: f32) -> Self {
        Self { axis, sin: (1.0 - cos * cos).max(0.0).sqrt(), cos }
    }

    /// False if the cones surely have no direction in common.
    fn meets(&self, other: &Self) -> bool {
        // The angle between the axes against the sum of the half angles, unless that is more than half a turn.
        let is_wide =
            self.sin * other.cos + self.cos * other.sin < 0.0 || self.cos < -0.999 || other.cos < -0.999;
        is_wide || self.axis.dot(other.axis) >= self.cos * other.cos - self.sin * other.sin - 1e-6
    }
}

/// Directions in which a ray from within the first ball may meet the second.
fn cone_between(from: BoundingSphere, to: BoundingSphere) -> Cone {
    let rounding = rounding(from.centre, to.centre);
    let widened = BoundingSphere { radius: to.radius + from.radius + rounding, ..to };
    let (axis, cos) = widened.cone_from(from.centre);
    Cone::of_cosine(axis, cos)
}

impl DirectionMap {
    /// `None` if no look at the light finds any.
    fn new(
        light: &Light,
        context: &LightContext,
        view: View,
        place: BoundingSphere,
        targets: &Targets,
        n: usize,
        scheme: MapScheme,
    ) -> Option<Self> {
        let (View::Whole(chart) | View::Part(chart)) = view;
        let n = n.next_multiple_of(2).max(2);
        let width = n * chart.n_squares();
        let targets: Vec<Cone> = targets.spheres.iter().map(|target| cone_between(place, *target)).collect();
        let flux: Vec<f32> =
            (0..width * n).map(|i| cell_flux(light, context, view, [i % width, i / width], n)).collect();
        let sum = |cells: &[f32]| cells.iter().map(|cell| f64::from(*cell)).sum::<f64>();
        let found = sum(&flux);
        if !(found > 0.0 && found.is_finite()) {
            return None;
        }
        let floor = FLOOR * (found / flux.len() as f64) as f32;
        let own = match light.directions(context) {
            Directions::Cone { axis, cos_max } => Some(Cone::of_cosine(axis, cos_max)),
            _ => None,
        };
        let is_pictured = is_pictured(light);
        let mut is_uncertain = is_pictured;
        let active: Vec<f32> = (0..width * n)
            .map(|i| {
                let (axis, angle) = chart.cell_cone([i % width, i / width], n);
                let cell = Cone::new(axis, angle);
                if !targets.iter().any(|cone| cone.meets(&cell)) {
                    return 0.0;
                }
                // Where the light's cone ends within a cell, all looks may be beyond it.
                let is_missed = flux[i] <= 0.0 && own.is_none_or(|own| own.meets(&cell));
                is_uncertain |= is_missed;
                if is_missed || is_pictured { flux[i].max(floor) } else { flux[i] }
            })
            .collect();
        let whole = match view {
            View::Whole(_) => found,
            // The mean over the chart is the probability of its directions.
            View::Part(_) => flux.len() as f64,
        };
        let share = (sum(&active) / whole).min(1.0);
        let domain = Bounds2::new(Point2::splat(0.0), Point2::new(chart.n_squares() as f32, 1.0));
        let table = |cells: &[f32]| PiecewiseConstant2::new(cells, width, n, domain);
        let defence = if is_uncertain { DEFENCE } else { 0.0 };
        let retries = scheme == MapScheme::Retry && share >= LEAST_RETRY_SHARE && defence == 0.0;
        let n_active = active.iter().filter(|flux| **flux > 0.0).count();
        let all = retries.then(|| table(&flux));
        Some(Self { chart, active: table(&active), all, n_active, share, defence })
    }

    /// True if the direction lies in an active cell.
    fn is_active(&self, w: Vector3) -> bool {
        self.pdf_w(w) > 0.0
    }

    /// Density per steradian of directions through active cells.
    fn pdf_w(&self, w: Vector3) -> f32 {
        self.chart.place(w).map_or(0.0, |place| self.active.pdf(place) * self.chart.density(w))
    }

    fn sample(&self, u: Point2) -> Option<(Vector3, f32)> {
        let place = match &self.all {
            Some(all) => self.retry(all, u)?,
            None => self.active.sample(u).0,
        };
        let w = self.chart.direction(place);
        Some((w, self.active.pdf(place) * self.chart.density(w)))
    }

    /// A place of an active cell, found by trying.
    fn retry(&self, all: &PiecewiseConstant2, u: Point2) -> Option<Point2> {
        let mut rng = Rng::new(u64::from(u.x.to_bits()) << 32 | u64::from(u.y.to_bits()), 1);
        let mut u = u;
        (0..MAX_TRIES).find_map(|_| {
            let (place, _) = all.sample(u);
            u = rng.next_point2();
            (self.active.pdf(place) > 0.0).then_some(place)
        })
    }

    fn emit(
        &self,
        light: &Light,
        context: &LightContext,
        [u_position, u_direction]: [Point2; 2],
        u: f32,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        if u < self.defence {
            let emitted = light.sample_le(context, u_position, u_direction, lambda)?;
            let aimed = self.pdf_w(emitted.ray.direction);
            let pdf_w = (1.0 - self.defence) * aimed + self.defence * emitted.pdf_w;
            return (aimed > 0.0).then_some(EmittedRay { pdf_w, ..emitted });
        }
        let (w, aimed) = self.sample(u_direction)?;
        let emitted = light.emit_towards(context, u_position, w, lambda)?;
        let own = if self.defence > 0.0 { light.pdf_le(context, &emitted.ray, emitted.n).1 } else { 0.0 };
        let pdf_w = (1.0 - self.defence) * aimed + self.defence * own;
        (pdf_w > 0.0).then_some(EmittedRay { pdf_w, ..emitted })
    }
}

/// True for lights whose intensity may vary within a cell.
const fn is_pictured(light: &Light) -> bool {
    matches!(light, Light::Goniometric(_) | Light::Ies(_) | Light::Projection(_))
}

/// Flux that leaves through a cell, in units of its own for each light; of a part of its directions the greatest density over that
/// of the chart.
fn cell_flux(light: &Light, context: &LightContext, view: View, [column, row]: [usize; 2], n: usize) -> f32 {
    let (View::Whole(chart) | View::Part(chart)) = view;
    let is_even = matches!(light.directions(context), Directions::Sphere | Directions::Varied);
    if is_even && !is_pictured(light) {
        return match view {
            View::Whole(_) => 1.0,
            View::Part(chart) => 0.25 * FRAC_1_PI / chart.density(Vector3::new(0.0, 0.0, 1.0)),
        };
    }
    let at = |i: usize, cell: usize| (cell as f32 + (i as f32 + 0.5) / N_LOOKS as f32) / n as f32;
    let looks = (0..N_LOOKS * N_LOOKS).map(|i| {
        let w = chart.direction(Point2::new(at(i % N_LOOKS, column), at(i / N_LOOKS, row)));
        let n = match light.directions(context) {
            Directions::Cosine { axis, .. } => Some(axis.as_normal()),
            _ => None,
        };
        light.pdf_le(context, &Ray::new(Point3::ORIGIN, w), n).1 / chart.density(w)
    });
    // The largest: where a cone or a picture ends within a cell, photons rather carry less than more.
    looks.fold(0.0, f32::max)
}

/// Cells of a plane.
#[derive(Clone, Debug)]
pub(super) struct PlaneMap {
    frame: Frame,
    /// A point before all of the scene.
    start: Point3,
    cells: PiecewiseConstant2,
}

impl PlaneMap {
    /// For light in the unit direction `w`.
    fn across(w: Vector3, spheres: &[BoundingSphere], context: &LightContext, n: usize) -> Aimed {
        let frame = Frame::from_z(w);
        let sphere = &context.tables.scene_sphere;
        let discs: Vec<(Point2, f32)> = spheres
            .iter()
            .map(|ball| {
                let local = frame.to_local(ball.centre - sphere.center);
                (Point2::new(local.x, local.y), ball.radius * 1.0001 + 1e-5 * sphere.radius)
            })
            .collect();
        let (min, max) = discs.iter().fold((discs[0].0, discs[0].0), |(min, max), (p, r)| {
            let r = Point2::splat(*r);
            (min.min(Point2::new(p.x - r.x, p.y - r.y)), max.max(Point2::new(p.x + r.x, p.y + r.y)))
        });
        let size = max - min;
        let cell = |i: usize| {
            let low = Point2::new(
                min.x + size.x * (i % n) as f32 / n as f32,
                min.y + size.y * (i / n) as f32 / n as f32,
            );
            let high = Point2::new(low.x + size.x / n as f32, low.y + size.y / n as f32);
            let is_active = discs.iter().any(|(p, r)| {
                let (dx, dy) = (p.x.clamp(low.x, high.x) - p.x, p.y.clamp(low.y, high.y) - p.y);
                dx * dx + dy * dy <= r * r
            });
            f32::from(u8::from(is_active))
        };
        let cells: Vec<f32> = (0..n * n).map(cell).collect();
        let domain = Bounds2 { min, max };
        if !(domain.area() > 0.0 && domain.area().is_finite()) {
            return Aimed::Everywhere;
        }
        let area = domain.area() * cells.iter().sum::<f32>() / (n * n) as f32;
        let share = f64::from(area / context.tables.entry_area(w));
        if share >= USELESS_SHARE {
            return Aimed::Everywhere;
        }
        let start = sphere.center - w * (1.01 * sphere.radius);
        let cells = PiecewiseConstant2::new(&cells, n, n, domain);
        Aimed::Towards(Box::new(Aim::Plane(Self { frame, start, cells })), share)
    }

    /// A start, and its density per square metre.
    fn sample(&self, u: Point2) -> (Point3, f32) {
        let (p, pdf_a) = self.cells.sample(u);
        (self.start + self.frame.x * p.x + self.frame.y * p.y, pdf_a)
    }
}

/// Area of the shadows of balls, overlaps counted as often as they do.
fn shadow_area(spheres: &[BoundingSphere]) -> f32 {
    spheres.iter().map(|ball| std::f32::consts::PI * ball.radius * ball.radius).sum()
}

/// The map of a light at infinity that is not parallel.
fn discs(light: &Light, spheres: &[BoundingSphere], context: &LightContext) -> Aimed {
    // The opening of a portal is the better map.
    if matches!(light, Light::InfinitePortal(_)) {
        return Aimed::Everywhere;
    }
    let sphere = &context.tables.scene_sphere;
    let widened = |ball: &BoundingSphere| BoundingSphere {
        radius: ball.radius * 1.0001 + 1e-5 * sphere.radius,
        ..*ball
    };
    let spheres: Vec<BoundingSphere> = spheres.iter().map(widened).collect();
    let share = f64::from(shadow_area(&spheres) / super::mean_entry_area(light, context));
    if share >= USELESS_SHARE {
        return Aimed::Everywhere;
    }
    Aimed::Towards(Box::new(Aim::Discs(spheres)), share)
}

/// A ray in the unit direction `w` that meets a ball, and its density per square metre across it.
fn sample_discs(
    spheres: &[BoundingSphere],
    w: Vector3,
    u: Point2,
    context: &LightContext,
) -> Option<(Ray, f32)> {
    let areas = |ball: &BoundingSphere| ball.radius * ball.radius;
    let mut rest = u.x * spheres.iter().map(areas).sum::<f32>();
    let last = spheres.last()?;
    let chosen = spheres.iter().find(|ball| {
        let is_here = rest < areas(ball);
        rest -= if is_here { 0.0 } else { areas(ball) };
        is_here
    });
    let (ball, u_x) = chosen.map_or((last, 0.5), |ball| (ball, (rest / areas(ball)).min(1.0)));
    let frame = Frame::from_z(w);
    let d = warp::sample_concentric_disk(Point2::new(u_x, u.y));
    let p = ball.centre + (frame.x * d.x + frame.y * d.y) * ball.radius;
    let n_covering =
        spheres.iter().filter(|other| (p - other.centre).cross(w).length_squared() <= areas(other)).count();
    let scene = &context.tables.scene_sphere;
    let back = 1.01 * (scene.radius + (p - scene.center).dot(w).abs());
    let ray = Ray::new(p - w * ((p - scene.center).dot(w) + back), w);
    // The chosen one covers the point but for rounding.
    Some((ray, n_covering.max(1) as f32 / shadow_area(spheres)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// However many lights there are and whatever they want, their maps have a bounded number of cells; few lights get what they want.
    #[test]
    fn maps_together_are_bounded() {
        for n_lights in [1, 2, 7, super::super::MAX_PREPARED] {
            for wanted in [2, 128, 1024] {
                let n = affordable_side(wanted, n_lights);
                assert!(n >= 2 && n <= wanted && 2 * n * n * n_lights <= MAX_CELLS, "{n} for {n_lights}");
            }
            assert_eq!(affordable_side(128, n_lights), 128);
        }
        assert_eq!(affordable_side(1024, 1), 1024);
    }
}
