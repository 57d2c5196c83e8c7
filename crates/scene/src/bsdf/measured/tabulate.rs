//! Measurements of models: what a gonioreflectometer would make of them.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use etendue_math::{Point2, Vector3, sqr};

use super::data::{MeasuredBrdf, MeasuredFault, MeasuredParts};
use super::maps::{Densities, Maps};
use super::table::{in_square, of_square, solid_angle};
use crate::bsdf::fresnel::reflect;

/// Where to measure.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredGrid {
    /// Number of azimuths of incidence over a quarter from -180° to -90°, for models that look the same if either
    /// tangent is reversed; 1 for isotropic ones.
    pub n_phi: usize,
    /// Number of angles of incidence from 0 to 88°.
    pub n_theta: usize,
    /// Nodes of the densities of facets along theta and phi.
    pub n_facets: [usize; 2],
    /// Nodes of the spectra along each side.
    pub n_spectra: usize,
    /// Wavelengths in nm.
    pub wavelengths: Vec<f32>,
}

/// Largest angle of incidence.
const THETA_MAX: f32 = 88.0 * PI / 180.0;
/// Along each side of the unit square, for the projected area of facets.
const N_AREA: usize = 96;

impl MeasuredBrdf {
    /// The measurement of a model whose facets have the density `ndf` and whose f in 1/sr is that of directions and
    /// wavelength in nm.
    ///
    /// # Errors
    /// If the grid has too few nodes, or the model is unsound.
    pub fn of_model(
        grid: &MeasuredGrid,
        ndf: impl Fn(Vector3) -> f32,
        f: impl Fn(Vector3, Vector3, f32) -> f32,
    ) -> Result<Self, MeasuredFault> {
        grid.check()?;
        let (views, facets) = (grid.views(), grid.n_facets);
        // Of isotropic models two rows are enough.
        let by_direction = if grid.n_phi == 1 { [facets[0], 2] } else { facets };
        let area = Area::of(&ndf);
        let sigma = maps(by_direction, &[()], |(), p| area.seen_from(of_square(p, 0.0)));
        let vndf = maps(facets, &views, |wo, p| {
            let m = of_square(p, 0.0);
            ndf(m) * wo.dot(m).max(0.0) * solid_angle(p.x)
        });
        let densities = Densities::new(vndf.clone());
        let spectra = maps([grid.n_spectra; 2], &grid.conditions(&views), |(view, wo, nm), u| {
            let m = densities.sample(&[(*view, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)], u);
            // f cos_i goes through 0 at the horizon, also between nodes.
            let reflected = reflect(*wo, of_square(m, 0.0));
            let wi = Vector3 { z: reflected.z.abs(), ..reflected };
            let density = (*wo + wi).try_normalized().map_or(0.0, &ndf);
            let scale = 4.0 * sigma.at(0, in_square(*wo, 0.0)) / density;
            if scale.is_finite() { f(*wo, wi, *nm) * reflected.z * scale } else { 0.0 }
        });
        Self::new(MeasuredParts {
            phi_i: grid.phi_i(),
            theta_i: grid.theta_i(),
            wavelengths: grid.wavelengths.clone(),
            ndf: maps(by_direction, &[()], |(), p| ndf(of_square(p, 0.0))),
            sigma,
            vndf,
            luminance: mean_of_wavelengths(&spectra, grid.wavelengths.len()),
            spectra,
            jacobian: true,
        })
    }
}

impl MeasuredGrid {
    fn check(&self) -> Result<(), MeasuredFault> {
        let n_least = self.n_facets[0].min(self.n_facets[1]).min(self.n_spectra);
        let why = "should have at least 2 by 2 values".to_owned();
        if n_least >= 2 { Ok(()) } else { Err(MeasuredFault { field: "spectra", why }) }
    }

    fn phi_i(&self) -> Vec<f32> {
        steps(self.n_phi, -PI, -FRAC_PI_2)
    }

    fn theta_i(&self) -> Vec<f32> {
        steps(self.n_theta, 0.0, THETA_MAX)
    }

    /// Directions of incidence; of isotropic models in the plane from which azimuths of facets count.
    fn views(&self) -> Vec<Vector3> {
        let azimuth = |phi: f32| if self.n_phi == 1 { 0.0 } else { phi };
        let view = |phi: f32, theta: f32| {
            of_square(Point2::new((theta / FRAC_PI_2).sqrt(), 0.5 + azimuth(phi) / TAU), 0.0)
        };
        let theta_i = self.theta_i();
        self.phi_i().into_iter().flat_map(|phi| theta_i.iter().map(move |theta| view(phi, *theta))).collect()
    }

    /// Views with their numbers, for each wavelength.
    fn conditions(&self, views: &[Vector3]) -> Vec<(usize, Vector3, f32)> {
        let numbered = views.iter().enumerate();
        numbered.flat_map(|(i, wo)| self.wavelengths.iter().map(move |nm| (i, *wo, *nm))).collect()
    }
}

/// Numbers with even steps from the first to the last.
fn steps(n: usize, first: f32, last: f32) -> Vec<f32> {
    (0..n).map(|i| first + (last - first) * i as f32 / (n - 1).max(1) as f32).collect()
}

/// Values at nodes, for each condition.
fn maps<C>(size: [usize; 2], conditions: &[C], value: impl Fn(&C, Point2) -> f32) -> Maps {
    let [xs, ys] = size.map(|n| steps(n, 0.0, 1.0));
    let mut values = Vec::new();
    for condition in conditions {
        for y in &ys {
            values.extend(xs.iter().map(|x| value(condition, Point2::new(*x, *y))));
        }
    }
    Maps { size, values }
}

fn mean_of_wavelengths(spectra: &Maps, n: usize) -> Maps {
    let stride = spectra.size[0] * spectra.size[1];
    let of_condition = |values: &[f32]| -> Vec<f32> {
        let sum = |node: usize| values.iter().skip(node).step_by(stride).sum::<f32>();
        (0..stride).map(|node| sum(node) / n as f32).collect()
    };
    let values = spectra.values.chunks((stride * n).max(1)).flat_map(of_condition).collect();
    Maps { size: spectra.size, values }
}

/// All facets.
struct Area(Vec<(Vector3, f32)>);

impl Area {
    fn of(ndf: &impl Fn(Vector3) -> f32) -> Self {
        let n = N_AREA as f32;
        let places = (0..N_AREA * N_AREA).map(|i| ((i % N_AREA) as f32 + 0.5, (i / N_AREA) as f32 + 0.5));
        let part = |(x, y): (f32, f32)| {
            let p = Point2::new(x / n, y / n);
            let m = of_square(p, 0.0);
            (m, ndf(m) * solid_angle(p.x) / sqr(n))
        };
        Self(places.map(part).collect())
    }

    /// Their projected area per area of the surface.
    fn seen_from(&self, w: Vector3) -> f32 {
        self.0.iter().map(|(m, area)| area * w.dot(*m).max(0.0)).sum()
    }
}
