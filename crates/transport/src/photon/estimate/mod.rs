//! The radiance estimate: how bright a surface is by the photons near a point (Jensen 2001, "Realistic Image Synthesis Using
//! Photon Mapping", chapter 7; SPEC EST-1 to EST-12).
//!
//! ```text
//! L(x, wo) = ∫ f(wo, wi) d²Φ/dA  ≈  1/ΔA  sum over photons in ΔA of  f(wo, wi_p) ΔΦ_p      with ΔA = pi r^2
//! ```
//!
//! The `k` nearest photons give the radius. That the farthest lies just on the rim is no chance: counting it among the `k` in
//! the disc makes all surfaces too bright by `k / (k - 1)`. In a field of uniform density the disc's area has `E[1 / ΔA] = density / (k - 1)`
//! exactly, so one more photon is looked for, which defines the radius and does not count ([`Farthest`]). Where the greatest
//! radius that is allowed holds fewer photons, all of them count.
//!
//! [`DensityEstimate::sum`] is the estimate on photons that were found: which count, with which weight, and what to divide by;
//! [`radiance`] is what surfaces make of it.

mod checking;
mod filter;
mod hull;
mod in_map;
pub mod radiance;
mod settings;
mod volume;

pub mod gathering;
pub mod histogram;

#[cfg(test)]
mod tests;

use etendue_geometry::points::Neighbours;
use etendue_math::{Frame, Point2, Point3, Vector3};
use etendue_spectrum::Xyz;

pub use checking::DifferentialChecking;
pub use filter::Filter;
pub use in_map::MapEstimate;
pub use radiance::{LitPlace, RadianceEstimate, irradiance, radiance};
pub use volume::Volume;

use hull::PlanePhoton;

/// Photons by their index.
pub trait Photons {
    /// Where it lies.
    fn position(&self, index: u32) -> Point3;
    /// Unit direction towards where it came from.
    fn wi(&self, index: u32) -> Vector3;
    /// Flux that it carries, divided by the number emitted.
    fn power(&self, index: u32) -> Xyz;
}

/// What is done about the farthest of the `k` photons, whose distance is the radius.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Farthest {
    /// It does not count; one more is looked for. Unbiased.
    #[default]
    LeaveOut,
    /// It counts, and the sum of `k` is multiplied by `(k - 1) / k`, or what corresponds to that with a filter. Unbiased too.
    /// The same as `LeaveOut` in cylinders and cubes, whose rim it does not lie on.
    Scale,
    /// It counts, as in the book: too bright by `k / (k - 1)` in the mean.
    Count,
}

/// How density is estimated from the photons near a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DensityEstimate {
    /// How weights fall with distance.
    pub filter: Filter,
    /// Where photons are taken from.
    pub volume: Volume,
    /// What is done about the farthest photon.
    pub farthest: Farthest,
    /// Divides by what the photons' convex hull covers in place of the whole disc.
    pub uses_hull: bool,
    /// Stops where the estimate drifts.
    pub checking: Option<DifferentialChecking>,
    /// With fewer photons than this the estimate is 0. Any number but 0 makes it too dark in the mean (SPEC KD-11).
    pub min_photons: u32,
}

/// Memory of the estimates of one thread.
#[derive(Clone, Debug, Default)]
pub struct EstimateScratch {
    /// What the search found.
    pub found: Neighbours,
    photons: Vec<PlanePhoton>,
    hull: Vec<u32>,
    ordered: Vec<(f32, f32)>,
    weighted: Vec<(f32, u32)>,
}

/// What an estimate rests on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Density {
    /// To multiply sums by, in 1/m^2; 0 if there is nothing to be said.
    pub per_area: f32,
    /// Radius of the sphere that was searched, or at which drift was noticed, in metres.
    pub radius: f32,
    /// Photons that counted.
    pub n_photons: u32,
    /// True if the greatest radius allowed held fewer photons than were wanted.
    pub is_limited: bool,
}

/// Radius over the size of coordinates below which photons lie at one point as far as `f32` can tell.
const SMALLEST_RADIUS: f32 = 1.0 / (1 << 20) as f32;
/// The same at the origin, in metres: its square, and what is divided by it, are well within `f32`.
const SMALLEST_RADIUS_M: f32 = 1e-9;
/// Hulls of less than this part of the disc are lines as far as `f32` can tell; the disc stands in for them.
const SMALLEST_HULL: f32 = 1e-4;
/// Photons within the disc from which hulls are unbiased.
const MIN_HULL_PHOTONS: usize = 4;

impl DensityEstimate {
    /// How many photons to look for where `k` are to count.
    #[inline]
    #[must_use]
    pub const fn search_size(&self, k: usize) -> usize {
        match self.rule() {
            Farthest::LeaveOut => k.saturating_add(1),
            Farthest::Scale | Farthest::Count => k,
        }
    }

    /// What is done about the farthest photon. It lies on the rim of spheres and discs; in cylinders and cubes it counts for
    /// itself only in a few directions, so that they scale nothing.
    const fn rule(&self) -> Farthest {
        match (self.farthest, self.volume) {
            (Farthest::Scale, Volume::Cylinder { .. } | Volume::Cube) => Farthest::LeaveOut,
            (farthest, _) => farthest,
        }
    }

    /// Calls `add` with the weight of each photon that counts, and tells what to multiply the sum by.
    ///
    /// The photons in `scratch.found` are the answer to a search around `p` for [`Self::search_size`] photons, `wanted`. `n` is the
    /// unit normal of the tangent plane. `accept` tells what is needed of a photon, or nothing if it came from the wrong side.
    #[inline]
    pub fn sum<T>(
        &self,
        (p, n): (Point3, Vector3),
        wanted: usize,
        photons: &impl Photons,
        scratch: &mut EstimateScratch,
        accept: impl Fn(u32) -> Option<T>,
        mut add: impl FnMut(f32, T),
    ) -> Density {
        let mut rim = Rim::of(&scratch.found, wanted, p, self.rule());
        if scratch.found.iter().len() == 0 {
            return Density { radius: rim.radius_squared.sqrt(), is_limited: true, ..Density::default() };
        }
        let place = Place { p, frame: Frame::from_z(n), volume: self.volume };
        if let Some(checking) = self.checking {
            let ordered = &mut scratch.ordered;
            rim = place.checked(rim, checking, photons, &scratch.found, ordered, |i| accept(i).is_some());
        }
        let (n_photons, per_area) = if self.uses_hull {
            self.sum_in_hull(&place, rim, photons, scratch, accept, add)
        } else {
            let mut n_photons = 0;
            for near in scratch.found.iter() {
                if !rim.holds(near.distance_squared) {
                    continue;
                }
                let distance_squared = place.distance_squared(photons, near.index, near.distance_squared);
                if !rim.holds(distance_squared) {
                    continue;
                }
                if let Some(photon) = accept(near.index) {
                    n_photons += 1;
                    add(self.filter.weight(distance_squared / rim.radius_squared), photon);
                }
            }
            (n_photons, self.per_area(rim))
        };
        let per_area = if n_photons < self.min_photons { 0.0 } else { per_area };
        let is_limited = rim.is_limited;
        Density { per_area, radius: rim.radius_squared.sqrt(), n_photons, is_limited }
    }

    /// What sums over the whole disc are multiplied by.
    fn per_area(&self, rim: Rim) -> f32 {
        let mean = self.filter.mean(1.0);
        let area = self.volume.unit_area() * rim.radius_squared * mean;
        let n = rim.n_to_scale as f32;
        if n > 0.0 {
            // Of n photons, n - 1 have the mean weight and the farthest has that of the rim.
            let inside = (n - 1.0) * mean;
            inside / (inside + self.filter.weight(1.0)).max(f32::MIN_POSITIVE) / area
        } else {
            1.0 / area
        }
    }

    fn sum_in_hull<T>(
        &self,
        place: &Place,
        rim: Rim,
        photons: &impl Photons,
        scratch: &mut EstimateScratch,
        accept: impl Fn(u32) -> Option<T>,
        mut add: impl FnMut(f32, T),
    ) -> (u32, f32) {
        let EstimateScratch { found, photons: in_plane, hull, .. } = scratch;
        in_plane.clear();
        for near in found.iter().filter(|near| rim.holds(near.distance_squared)) {
            let offset = photons.position(near.index) - place.p;
            let distance_squared = place.volume.distance_squared(&place.frame, offset, near.distance_squared);
            if rim.holds(distance_squared) && accept(near.index).is_some() {
                let p = Point2::new(offset.dot(place.frame.x), offset.dot(place.frame.y));
                in_plane.push(PlanePhoton { p, index: near.index, distance_squared, is_corner: false });
            }
        }
        hull::mark_corners(in_plane, hull);
        let area = hull::integral(in_plane, hull, (self.filter, self.volume), rim.radius_squared);
        let disc = self.volume.unit_area() * rim.radius_squared;
        let is_hull = in_plane.len() >= MIN_HULL_PHOTONS && area > SMALLEST_HULL * disc;
        let (mut n_photons, per_area) = (0, if is_hull { 1.0 / area } else { self.per_area(rim) });
        for photon in in_plane.iter().filter(|photon| !(is_hull && photon.is_corner)) {
            if let Some(accepted) = accept(photon.index) {
                n_photons += 1;
                add(self.filter.weight(photon.distance_squared / rim.radius_squared), accepted);
            }
        }
        (n_photons, per_area)
    }
}

/// Where an estimate is made.
#[derive(Clone, Copy, Debug)]
struct Place {
    p: Point3,
    frame: Frame,
    volume: Volume,
}

impl Place {
    /// Squared distance of a photon by the measure of the volume.
    #[inline(always)]
    fn distance_squared(&self, photons: &impl Photons, index: u32, distance_squared: f32) -> f32 {
        match self.volume {
            Volume::Sphere => distance_squared,
            volume => {
                volume.distance_squared(&self.frame, photons.position(index) - self.p, distance_squared)
            }
        }
    }

    /// The rim at which drift is noticed, if there is any within the one given.
    fn checked(
        &self,
        rim: Rim,
        checking: DifferentialChecking,
        photons: &impl Photons,
        found: &Neighbours,
        ordered: &mut Vec<(f32, f32)>,
        accepts: impl Fn(u32) -> bool,
    ) -> Rim {
        ordered.clear();
        for near in found.iter().filter(|near| accepts(near.index)) {
            let distance_squared = self.distance_squared(photons, near.index, near.distance_squared);
            if rim.holds(distance_squared) {
                ordered.push((distance_squared, photons.power(near.index).y));
            }
        }
        ordered.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        match checking::drift_radius_squared(checking, ordered) {
            Some(radius_squared) if radius_squared > 0.0 => {
                Rim { radius_squared, is_outside: true, n_to_scale: 0, is_limited: false }
            }
            _ => rim,
        }
    }
}

/// The boundary of what counts.
#[derive(Clone, Copy, Debug)]
struct Rim {
    radius_squared: f32,
    /// What lies on it does not count.
    is_outside: bool,
    /// How many photons lie within and on it, if their sum is to be scaled.
    n_to_scale: u32,
    is_limited: bool,
}

impl Rim {
    #[inline]
    fn of(found: &Neighbours, wanted: usize, p: Point3, farthest: Farthest) -> Self {
        let n = found.iter().len();
        let is_limited = n < wanted;
        let mut radius_squared = found.limit_squared();
        // Without a greatest radius, all photons there are were found: the farthest defines the radius again.
        let is_unbounded = radius_squared == f32::INFINITY;
        if is_unbounded {
            radius_squared = found.iter().map(|near| near.distance_squared).fold(0.0, f32::max);
            // What is so far that the square overflows does not count.
            radius_squared = radius_squared.min(f32::MAX);
        }
        let is_by_photon = !is_limited || is_unbounded;
        let smallest = (p.abs().max_element() * SMALLEST_RADIUS).max(SMALLEST_RADIUS_M);
        if radius_squared <= smallest * smallest {
            // All at one point: how dense they are cannot be told, but that it is finite.
            let radius_squared = smallest * smallest;
            return Self { radius_squared, is_outside: false, n_to_scale: 0, is_limited };
        }
        let n_to_scale = if is_by_photon && farthest == Farthest::Scale { n as u32 } else { 0 };
        let is_outside = is_by_photon && farthest == Farthest::LeaveOut;
        Self { radius_squared, is_outside, n_to_scale, is_limited }
    }

    #[inline(always)]
    fn holds(self, distance_squared: f32) -> bool {
        distance_squared < self.radius_squared || !self.is_outside && distance_squared == self.radius_squared
    }
}
