//! A whole sphere after a map that keeps its shape: a [`Globe`] that knows how it is turned, for texture coordinates and
//! tangents. u = phi / 2 pi, v = 1 - theta / pi, theta from the sphere's own +z.

use std::f32::consts::{FRAC_1_PI, TAU};

use etendue_math::approx::atan2;
use etendue_math::{Bounds3, Normal3, Point2, Ray, Vector3};
use glam::{DAffine3, DVec3};

use super::globe::Globe;
use super::sphere::Sphere;
use super::{Candidate, Candidates, LocalSurface};
use crate::double;
use crate::hit::{Reference, ShapeSample, SurfaceDerivatives, SurfacePoint};

/// A whole sphere in the space of its group.
#[derive(Clone, Debug)]
pub(crate) struct WholeSphere {
    globe: Globe,
    /// The sphere's own axes.
    axes: [Vector3; 3],
}

impl WholeSphere {
    /// Places a sphere of this radius by a map that scales all lengths by `scale`. A mirroring map keeps the outside outside.
    pub(crate) fn new(radius: f64, map: &DAffine3, scale: f64, reverse_orientation: bool) -> Self {
        let sign = if reverse_orientation { -1.0 } else { 1.0 };
        let m = map.matrix3;
        let axes = [m.x_axis, m.y_axis, m.z_axis].map(|axis| double::to_vector(axis / scale));
        Self { globe: Globe::new(double::to_point(map.translation), (radius * scale) as f32, sign), axes }
    }

    pub(crate) const fn globe(&self) -> &Globe {
        &self.globe
    }

    pub(crate) fn bounds(&self) -> Bounds3 {
        let (centre, radius) = (double::point(self.globe.centre), f64::from(self.globe.radius));
        super::round_outwards(centre - radius, centre + radius)
    }

    /// Up to two hits in order of t.
    pub(crate) fn intersect(&self, ray: &Ray) -> Candidates {
        let candidate = |t: f64| Candidate { t, u: 0.0, v: 0.0 };
        self.globe.intersect(ray).map_or([None; 2], |(near, far)| [Some(candidate(near)), far.map(candidate)])
    }

    /// Texture coordinates where this is the outward normal.
    #[inline]
    fn uv(&self, n: Vector3) -> Point2 {
        let [x, y, z] = self.axes.map(|axis| axis.dot(n));
        let phi = atan2(y, x);
        let phi = if phi < 0.0 { phi + TAU } else { phi };
        let theta = atan2((x * x + y * y).sqrt(), z);
        Point2::new(phi / TAU, 1.0 - theta * FRAC_1_PI)
    }

    /// The point where `ray` hits at `t`, before rounding too.
    #[inline]
    pub(crate) fn point(&self, ray: &Ray, t: f32) -> (DVec3, SurfacePoint) {
        let (p, n) = self.globe.nearest(ray, t);
        let n = double::to_vector(n);
        let (rounded, ng) = (double::to_point(p), (n * self.globe.sign).as_normal());
        let point = SurfacePoint {
            p: rounded,
            p_error: double::surface_error(rounded, f64::from(self.globe.size)),
            ng,
            ns: ng,
            uv: self.uv(n),
            face_index: 0,
        };
        (p, point)
    }

    /// Differential geometry where `ray` hits at `t`.
    pub(crate) fn surface(&self, ray: &Ray, t: f32) -> LocalSurface {
        let (p, point) = self.point(ray, t);
        let (_, n) = self.globe.nearest(ray, t);
        let axes = self.axes.map(double::vector);
        let own = DVec3::from_array(axes.map(|axis| axis.dot(n)));
        let radius = f64::from(self.globe.radius);
        let local = Sphere::whole(radius).surface(own * radius);
        let carried = |v: DVec3| double::to_vector(axes[0] * v.x + axes[1] * v.y + axes[2] * v.z);
        let (dpdu, dpdv) = (carried(local.dpdu), carried(local.dpdv));
        let derivatives = SurfaceDerivatives {
            dpdu,
            dpdv,
            shading_dpdu: dpdu,
            shading_dpdv: dpdv,
            dndu: carried(local.dndu) * self.globe.sign,
            dndv: carried(local.dndv) * self.globe.sign,
        };
        LocalSurface { p, point, derivatives }
    }

    /// A point, uniform in area.
    pub(crate) fn sample_area(&self, u: Point2) -> ShapeSample {
        self.with_uv(self.globe.sample_area(u))
    }

    /// A point uniform in solid angle from `reference` with its density per steradian; `None` from inside.
    pub(crate) fn sample_cone(&self, reference: &Reference, u: Point2) -> Option<(ShapeSample, f32)> {
        let (sample, pdf_w) = self.globe.sample_cone(reference, u)?;
        Some((self.with_uv(sample), pdf_w))
    }

    fn with_uv(&self, sample: ShapeSample) -> ShapeSample {
        ShapeSample { uv: self.uv(sample.n.as_vector() * self.globe.sign), ..sample }
    }

    /// A cone that holds all normals: all directions.
    pub(crate) const fn emission_cone() -> (Normal3, f32) {
        (Normal3::new(0.0, 0.0, 1.0), -1.0)
    }
}
