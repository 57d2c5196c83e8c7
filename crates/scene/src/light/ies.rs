//! A luminaire as a point with measured intensity, in candela as the file says (SPEC EMI-8). Emitted directions are
//! sampled in proportion to the table, so that photons carry equal power.
//!
//! A spectrum gives it colour; its luminous intensity stays that of the table. The size of the luminous opening is not
//! used: from five times that size away, where such tables are measured, it makes no difference.

use std::f32::consts::PI;
use std::sync::Arc;

use etendue_geometry::Reference;
use etendue_math::{Bounds2, Bounds3, Normal3, PiecewiseConstant2, Point2, Point3, Ray, Transform, Vector3};
use etendue_spectrum::{Sampled, Spectrum, Wavelengths};

use super::build::{self, spec};
use super::context::point_sample;
use super::{EmittedRay, LightBounds, LightContext, LightPower, LightSample, LightUnits, Photometry};
use crate::parameters::{ParameterSpec, Parameters, SpectrumRole};

/// Index of a luminaire in [`LightTables`](super::LightTables).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct IesLightId(pub u32);

/// Cells of the density over the angle to the nadir and the azimuth.
const N_CELLS: (usize, usize) = (360, 180);

/// A luminaire.
#[derive(Clone, Debug)]
pub struct IesLight {
    p: Point3,
    world_from_light: Transform,
    light_from_world: Transform,
    /// Intensity for each candela of the table.
    intensity: Spectrum,
    photometry: Arc<Photometry>,
    /// Flux of the table in lumen.
    lumens: f64,
    /// Largest intensity of the table in candela.
    peak: f32,
    /// Over azimuth / 2 pi and angle to the nadir / pi.
    distribution: PiecewiseConstant2,
}

/// The direction at a place of the density's domain.
fn direction_at(place: Point2) -> Vector3 {
    let ((sine, cosine), (y, x)) = ((PI * place.y).sin_cos(), (2.0 * PI * place.x).sin_cos());
    Vector3::new(sine * x, sine * y, -cosine)
}

/// Twice the share of the sphere that a row of cells has: the difference of the cosines at its ends.
fn row_height(row: usize) -> f32 {
    let step = PI / N_CELLS.0 as f32;
    2.0 * ((row as f32 + 0.5) * step).sin() * (0.5 * step).sin()
}

/// The direction at a place of the density's domain, uniform in solid angle within its row.
fn emitted_direction(place: Point2) -> (Vector3, usize) {
    let n = N_CELLS.0 as f32;
    let row = ((place.y * n) as usize).min(N_CELLS.0 - 1);
    let within = (place.y * n - row as f32).clamp(0.0, 1.0);
    // From the pole that is nearer, where 1 - cos has all its digits.
    let is_up = 2 * row >= N_CELLS.0;
    let (from_pole, within) = if is_up { (N_CELLS.0 - 1 - row, 1.0 - within) } else { (row, within) };
    let half = 0.5 * PI * from_pole as f32 / n;
    let h = 2.0 * half.sin() * half.sin() + within * row_height(from_pole);
    let (sine, (y, x)) = ((h * (2.0 - h)).max(0.0).sqrt(), (2.0 * PI * place.x).sin_cos());
    (Vector3::new(sine * x, sine * y, if is_up { 1.0 - h } else { h - 1.0 }), row)
}

/// For each cell of the density, rows from the nadir, its largest intensity times its solid angle. For the web C, whose
/// angles are those of the cells, no cell with light has weight 0; for others corners and middle stand for a cell.
fn cell_weights(photometry: &Photometry) -> Vec<f32> {
    let (rows, columns) = N_CELLS;
    let (vertical, horizontal) = photometry.bends();
    let by_row: Vec<Vec<f32>> = (0..rows).map(|row| places_within(row, rows, 180.0, vertical)).collect();
    let by_column: Vec<Vec<f32>> =
        (0..columns).map(|column| places_within(column, columns, 360.0, horizontal)).collect();
    let mut weights = Vec::with_capacity(rows * columns);
    for (row, ys) in by_row.iter().enumerate() {
        for xs in &by_column {
            let places = ys.iter().flat_map(|y| xs.iter().map(move |x| Point2::new(*x, *y)));
            let candela = places.map(|place| photometry.intensity(direction_at(place)));
            weights.push(row_height(row) * candela.fold(0.0, f32::max));
        }
    }
    weights
}

/// Where one of `n` cells over the angles up to `whole` degrees may be brightest, as shares of the whole: at its ends, in its
/// middle and where intensity bends. Ends are taken a little within, for a table may end there; of bends in tables that are
/// mirrored the mirror images count as well.
fn places_within(index: usize, n: usize, whole: f32, bends: &[f32]) -> Vec<f32> {
    let at = |offset: f32| (index as f32 + offset) / n as f32;
    let (first, last) = (at(1e-3), at(1.0 - 1e-3));
    let mut places = vec![first, at(0.5), last];
    // Cells do not straddle multiples of a right angle, where tables are mirrored: up and down, then by turns.
    for bend in bends {
        let half = [*bend, 180.0 - bend];
        let images = half.into_iter().chain(half.map(|angle| 360.0 - angle)).chain(half.map(|a| 180.0 + a));
        let images = if whole > 180.0 { images.collect() } else { vec![*bend] };
        places.extend(images.into_iter().map(|angle| angle / whole).filter(|x| (first..last).contains(x)));
    }
    places.sort_by(f32::total_cmp);
    places.dedup();
    places
}

/// Density per steradian in a row of cells where the density of the domain is `pdf`.
fn density_of(pdf: f32, row: usize) -> f32 {
    pdf / (2.0 * PI * N_CELLS.0 as f32 * row_height(row))
}

impl IesLight {
    /// Parameters in scene files.
    pub const PARAMETERS: &[ParameterSpec] = &[
        spec(
            "filename",
            "string",
            "",
            "",
            "photometric file in the format IES LM-63 (1986, 1991, 1995, 2002)",
        ),
        spec("I", "spectrum", "illuminant of the colour space", "", "colour; its size does not count"),
        build::SCALE,
        build::POWER,
    ];

    /// A luminaire with one candela of `colour` for each of the table.
    fn new(world_from_light: &Transform, unit: Spectrum, photometry: Arc<Photometry>) -> Self {
        let (rows, columns) = N_CELLS;
        let domain = Bounds2::new(Point2::splat(0.0), Point2::splat(1.0));
        Self {
            p: world_from_light.point(Point3::ORIGIN),
            world_from_light: *world_from_light,
            light_from_world: world_from_light.inverse(),
            intensity: unit,
            lumens: photometry.lumens(),
            peak: photometry.peak(),
            distribution: PiecewiseConstant2::new(&cell_weights(&photometry), columns, rows, domain),
            photometry,
        }
    }

    pub(super) fn build(p: &mut Parameters, world_from_light: &Transform) -> Option<Self> {
        let scale = p.float("scale", 1.0);
        if !(scale >= 0.0 && scale.is_finite()) {
            let span = p.span_of("scale");
            p.diagnostics().error(span, format!("\"scale\" of a light must be at least 0, not {scale}"));
        }
        let power = p.float("power", -1.0);
        let colour =
            p.spectrum("I", SpectrumRole::Illuminant).unwrap_or_else(|| build::default_illuminant(p));
        let photometry = build::read_photometry(p, "filename")?;
        let colour = super::emission::emitted(colour, 1.0, LightUnits::Photometric, &p.context.spectra);
        let luminance = LightPower::of(&colour, &p.context.spectra).lumens;
        let unit = colour.scaled(if luminance > 0.0 { (1.0 / luminance) as f32 } else { 0.0 });
        let mut light = Self::new(world_from_light, unit, photometry);
        if light.lumens <= 0.0 {
            let span = p.span_of("filename");
            p.diagnostics().warning(span, "the luminaire emits no light");
        }
        let factor = if power > 0.0 && light.lumens > 0.0 { f64::from(power) / light.lumens } else { 1.0 };
        light.intensity = unit.scaled((factor * f64::from(scale)) as f32);
        Some(light)
    }

    fn to_light_space(&self, w: Vector3) -> Option<Vector3> {
        self.light_from_world.vector(w).try_normalized()
    }

    fn intensity_towards(&self, context: &LightContext, w: Vector3, lambda: &Wavelengths) -> Option<Sampled> {
        let candela = self.photometry.intensity(self.to_light_space(w)?);
        (candela > 0.0).then(|| self.intensity.sample(context.spectra, lambda) * candela)
    }

    pub(super) fn sample_li(
        &self,
        context: &LightContext,
        reference: &Reference,
        _u: Point2,
        lambda: &Wavelengths,
    ) -> Option<LightSample> {
        let w = (reference.p - self.p).try_normalized()?;
        point_sample(self.p, reference, self.intensity_towards(context, w, lambda)?)
    }

    pub(super) const fn pdf_li(&self, _: &LightContext, _: &Reference, _: Vector3) -> f32 {
        0.0
    }

    pub(super) fn sample_le(
        &self,
        context: &LightContext,
        _u_position: Point2,
        u_direction: Point2,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        let (place, pdf) = self.distribution.sample(u_direction);
        let (w_light, row) = emitted_direction(place);
        let w = self.world_from_light.vector(w_light).try_normalized()?;
        let le = self.intensity_towards(context, w, lambda)?;
        EmittedRay::from_point(self.p, w, le, density_of(pdf, row))
    }

    pub(super) fn emit_towards(
        &self,
        context: &LightContext,
        w: Vector3,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        EmittedRay::from_point(self.p, w, self.intensity_towards(context, w, lambda)?, 1.0)
    }

    pub(super) fn pdf_le(&self, _: &LightContext, ray: &Ray, _: Option<Normal3>) -> (f32, f32) {
        let Some(w) = self.to_light_space(ray.direction) else { return (0.0, 0.0) };
        let sine = w.x.hypot(w.y);
        let turn = (w.y.atan2(w.x) / (2.0 * PI)).rem_euclid(1.0).min(1.0 - f32::EPSILON / 2.0);
        let place = Point2::new(turn, (sine.atan2(-w.z) / PI).min(1.0 - f32::EPSILON / 2.0));
        let row = ((place.y * N_CELLS.0 as f32) as usize).min(N_CELLS.0 - 1);
        (0.0, density_of(self.distribution.pdf(place), row))
    }

    pub(super) fn power(&self, context: &LightContext) -> LightPower {
        LightPower::of(&self.intensity, context.spectra) * self.lumens
    }

    /// Intensity in the brightest direction.
    #[must_use]
    pub fn peak_intensity(&self, context: &LightContext) -> LightPower {
        LightPower::of(&self.intensity, context.spectra) * f64::from(self.peak)
    }

    pub(super) fn bounds(&self, context: &LightContext) -> Option<LightBounds> {
        let intensity = LightPower::of(&self.intensity, context.spectra).weight * f64::from(self.peak);
        Some(LightBounds::point(Bounds3::new(self.p, self.p), intensity))
    }
}
