//! Measurements of models: what a gonioreflectometer would make of them.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use etendue_math::{Point2, Vector3, sqr};

use super::data::{MeasuredBrdf, MeasuredFault, MeasuredParts};
use super::maps::{Densities, Maps};
use super::table::{in_square, solid_angle};
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
        let n_least = grid.n_facets[0].min(grid.n_facets[1]).min(grid.n_spectra);
        if n_least < 2 || grid.n_phi == 0 {
            let why = "should have at least 2 by 2 values".to_owned();
            return Err(MeasuredFault { field: "spectra", why });
        }
        let is_isotropic = grid.n_phi == 1;
        let phi_i = steps(grid.n_phi, -PI, -FRAC_PI_2);
        let theta_i = steps(grid.n_theta, 0.0, THETA_MAX);
        let directions: Vec<Vector3> = phi_i
            .iter()
            .flat_map(|phi| {
                theta_i.iter().map(|theta| direction(*theta, if is_isotropic { 0.0 } else { *phi }))
            })
            .collect();
        let facets = grid.n_facets;
        // Of isotropic models two rows are enough.
        let of_directions = if is_isotropic { [facets[0], 2] } else { facets };
        let ndf_map = map(of_directions, |p| ndf(facet(p)));
        let area = Area::of(&ndf);
        let sigma = map(of_directions, |p| area.seen_from(facet(p)));
        let vndf = maps(
            facets,
            directions.iter().map(|wo| {
                |p: Point2| {
                    let m = facet(p);
                    ndf(m) * wo.dot(m).max(0.0) * solid_angle(p.x)
                }
            }),
        );
        let densities = Densities::new(vndf.clone());
        let size = [grid.n_spectra; 2];
        let spectra = maps(
            size,
            directions.iter().enumerate().flat_map(|(condition, wo)| {
                let (densities, sigma, ndf, f) = (&densities, &sigma, &ndf, &f);
                grid.wavelengths.iter().map(move |nm| {
                    move |u: Point2| {
                        let m = densities.sample(&[(condition, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)], u);
                        // f cos_i goes through 0 at the horizon, also between nodes.
                        let reflected = reflect(*wo, facet(m));
                        let wi = Vector3 { z: reflected.z.abs(), ..reflected };
                        let density = (*wo + wi).try_normalized().map_or(0.0, ndf);
                        let scale = 4.0 * sigma.at(0, in_square(*wo, 0.0)) / density;
                        if scale.is_finite() { f(*wo, wi, *nm) * reflected.z * scale } else { 0.0 }
                    }
                })
            }),
        );
        let luminance = mean_of_wavelengths(&spectra, grid.wavelengths.len());
        let wavelengths = grid.wavelengths.clone();
        let jacobian = true;
        Self::new(MeasuredParts {
            phi_i,
            theta_i,
            wavelengths,
            ndf: ndf_map,
            sigma,
            vndf,
            luminance,
            spectra,
            jacobian,
        })
    }
}

/// Numbers with even steps from the first to the last.
fn steps(n: usize, first: f32, last: f32) -> Vec<f32> {
    (0..n).map(|i| first + (last - first) * i as f32 / (n - 1).max(1) as f32).collect()
}

fn direction(theta: f32, phi: f32) -> Vector3 {
    let ((sin, cos), (sin_phi, cos_phi)) = (theta.sin_cos(), phi.sin_cos());
    Vector3::new(sin * cos_phi, sin * sin_phi, cos)
}

/// The direction at a place of the unit square.
fn facet(p: Point2) -> Vector3 {
    direction(FRAC_PI_2 * sqr(p.x), TAU * (p.y - 0.5))
}

fn map(size: [usize; 2], value: impl Fn(Point2) -> f32) -> Maps {
    maps(size, std::iter::once(value))
}

/// Values at nodes, for each condition.
fn maps<F: Fn(Point2) -> f32>(size: [usize; 2], conditions: impl Iterator<Item = F>) -> Maps {
    let [nx, ny] = size;
    let place = |i: usize, n: usize| i as f32 / (n - 1).max(1) as f32;
    let values = conditions.flat_map(|value| {
        let nodes = (0..ny).flat_map(move |row| (0..nx).map(move |column| (column, row)));
        nodes.map(|(column, row)| value(Point2::new(place(column, nx), place(row, ny)))).collect::<Vec<f32>>()
    });
    Maps { size, values: values.collect() }
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
            let m = facet(p);
            (m, ndf(m) * solid_angle(p.x) / sqr(n))
        };
        Self(places.map(part).collect())
    }

    /// Their projected area per area of the surface.
    fn seen_from(&self, w: Vector3) -> f32 {
        self.0.iter().map(|(m, area)| area * w.dot(*m).max(0.0)).sum()
    }
}
