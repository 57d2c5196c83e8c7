//! Pixel reconstruction filters (SPEC CAM-5): how radiance near a pixel's centre is averaged into its value.
//!
//! A pixel is `I = integral f(x - x_p) L(x) dx / integral f(x) dx`. Instead of spreading each sample over several
//! pixels, each pixel draws its own samples from the density `p ~ |f|` and weighs them with `w = f / (p integral f)`
//! (Ernst, Stamminger and Greiner 2006, "Filter Importance Sampling"). The mean of `w` is 1; it is exactly 1 for
//! filters without negative lobes, so that filtering then adds no noise.
//!
//! All five filters are products of one-dimensional profiles `f(x, y) = f1(x) f1(y)`, so two tables in one
//! dimension replace one in two. Tables hold averages over cells of 1/64 pixel: samples follow a staircase
//! within a part in a thousand of the filter.

use etendue_math::{PiecewiseConstant1, Point2, Vector2, warp};

use crate::parameters::{ParameterSpec, Parameters};

#[cfg(test)]
mod tests;

/// Shape of a filter's profile. To add one: a variant here, its line in [`FilterKind::profile`], its default radius,
/// and a name with parameters in [`Filter::from_parameters`]; sampling comes from the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilterKind {
    /// 1 within the radius.
    Box,
    /// Falls linearly to 0 at the radius.
    Triangle,
    /// A normal density lowered to reach 0 at the radius.
    Gaussian {
        /// Standard deviation in pixels.
        sigma: f32,
    },
    /// Two cubics (Mitchell and Netravali 1988, "Reconstruction Filters in Computer Graphics"); negative lobes.
    Mitchell {
        /// Blur, from 0 to 1; 1/3 by default, `2 c + b = 1` recommended.
        b: f32,
        /// Ringing, from 0 to 1; 1/3 by default.
        c: f32,
    },
    /// A sinc windowed by another sinc; negative lobes.
    LanczosSinc {
        /// Number of cycles that the window passes.
        tau: f32,
    },
}

impl FilterKind {
    /// Radius along both axes if none is given, in pixels.
    #[must_use]
    pub const fn default_radius(self) -> f32 {
        match self {
            Self::Box => 0.5,
            Self::Triangle | Self::Mitchell { .. } => 2.0,
            Self::Gaussian { .. } => 1.5,
            Self::LanczosSinc { .. } => 4.0,
        }
    }

    /// The profile at distance `x` from the centre along an axis, both in pixels; 0 beyond the radius.
    #[must_use]
    pub fn profile(self, x: f64, radius: f64) -> f64 {
        let x = x.abs();
        if x > radius {
            return 0.0;
        }
        match self {
            Self::Box => 1.0,
            Self::Triangle => radius - x,
            Self::Gaussian { sigma } => {
                let sigma = f64::from(sigma);
                let normal = |x: f64| {
                    (-x * x / (2.0 * sigma * sigma)).exp() / (sigma * (2.0 * std::f64::consts::PI).sqrt())
                };
                (normal(x) - normal(radius)).max(0.0)
            }
            Self::Mitchell { b, c } => mitchell(2.0 * x / radius, f64::from(b), f64::from(c)),
            Self::LanczosSinc { tau } => sinc(x) * sinc(x / f64::from(tau)),
        }
    }
}

/// The piecewise cubic of Mitchell and Netravali on [0, 2] (their equation 8).
fn mitchell(x: f64, b: f64, c: f64) -> f64 {
    if x <= 1.0 {
        ((12.0 - 9.0 * b - 6.0 * c) * x.powi(3) + (-18.0 + 12.0 * b + 6.0 * c) * x * x + (6.0 - 2.0 * b))
            / 6.0
    } else if x <= 2.0 {
        ((-b - 6.0 * c) * x.powi(3)
            + (6.0 * b + 30.0 * c) * x * x
            + (-12.0 * b - 48.0 * c) * x
            + (8.0 * b + 24.0 * c))
            / 6.0
    } else {
        0.0
    }
}

/// `sin(pi x) / (pi x)`.
fn sinc(x: f64) -> f64 {
    let t = std::f64::consts::PI * x;
    if t.abs() < 1e-4 { 1.0 - t * t / 6.0 } else { t.sin() / t }
}

/// A point of the filter's support.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterSample {
    /// From the centre of the pixel, in pixels.
    pub offset: Vector2,
    /// `f / (p integral f)`: mean 1, negative in negative lobes.
    pub weight: f32,
}

/// One axis of a tabulated filter.
#[derive(Clone, Debug)]
struct Axis {
    /// Density proportional to the absolute cell averages.
    distribution: PiecewiseConstant1,
    /// `f / (p integral f)` of each cell: plus or minus the same number.
    weights: Vec<f32>,
    integral: f64,
}

impl Axis {
    fn new(kind: FilterKind, radius: f32) -> Self {
        const CELLS_PER_PIXEL: f32 = 64.0;
        let n_cells = ((2.0 * radius * CELLS_PER_PIXEL).ceil() as usize).clamp(32, 4096);
        let r = f64::from(radius);
        let width = 2.0 * r / n_cells as f64;
        let average = |cell: usize| {
            // Simpson's rule: exact for the cubics but for the cell that holds their joint.
            let x = -r + (cell as f64 + 0.5) * width;
            let edge = 0.4999 * width;
            (kind.profile(x - edge, r) + 4.0 * kind.profile(x, r) + kind.profile(x + edge, r)) / 6.0
        };
        let averages: Vec<f64> = (0..n_cells).map(average).collect();
        let integral = averages.iter().sum::<f64>() * width;
        let absolute = averages.iter().map(|f| f.abs()).sum::<f64>() * width;
        let weights = averages.iter().map(|f| (absolute / integral * f.signum()) as f32).collect();
        let density: Vec<f32> = averages.iter().map(|f| f.abs() as f32).collect();
        Self { distribution: PiecewiseConstant1::new(&density, -radius, radius), weights, integral }
    }

    fn sample(&self, u: f32) -> (f32, f32) {
        let (x, _, cell) = self.distribution.sample(u);
        (x, self.weights[cell])
    }
}

/// A pixel filter, ready to be sampled.
#[derive(Clone, Debug)]
pub struct Filter {
    kind: FilterKind,
    radius: Vector2,
    /// Tables of x and y; `None` where sampling has a closed form.
    axes: Option<Box<[Axis; 2]>>,
    integral: f32,
}

impl Default for Filter {
    /// The Gaussian of radius 1.5 and sigma 0.5, in pixels.
    fn default() -> Self {
        let kind = FilterKind::Gaussian { sigma: 0.5 };
        Self::new(kind, Vector2::splat(kind.default_radius()))
            .expect("the default filter has a positive integral")
    }
}

impl Filter {
    /// A filter with radii along x and y in pixels; `None` if a radius or the integral is not positive and finite.
    #[must_use]
    pub fn new(kind: FilterKind, radius: Vector2) -> Option<Self> {
        let is_valid = |x: f32| x > 0.0 && x.is_finite();
        if !is_valid(radius.x) || !is_valid(radius.y) {
            return None;
        }
        let (axes, integral) = match kind {
            FilterKind::Box => (None, 4.0 * radius.x * radius.y),
            FilterKind::Triangle => (None, radius.x * radius.x * radius.y * radius.y),
            _ => {
                let axes = [Axis::new(kind, radius.x), Axis::new(kind, radius.y)];
                let integral = (axes[0].integral * axes[1].integral) as f32;
                (Some(Box::new(axes)), integral)
            }
        };
        is_valid(integral).then_some(Self { kind, radius, axes, integral })
    }

    /// The profile.
    #[must_use]
    pub const fn kind(&self) -> FilterKind {
        self.kind
    }

    /// Half the size of the support, in pixels.
    #[must_use]
    pub const fn radius(&self) -> Vector2 {
        self.radius
    }

    /// The filter at an offset from the pixel's centre, not normalised.
    #[must_use]
    pub fn eval(&self, offset: Vector2) -> f32 {
        let along = |x: f32, radius: f32| self.kind.profile(f64::from(x), f64::from(radius));
        (along(offset.x, self.radius.x) * along(offset.y, self.radius.y)) as f32
    }

    /// The factor of [`eval`](Self::eval) that depends on the horizontal offset from the pixel's centre, normalised to an integral
    /// of 1.
    #[inline]
    #[must_use]
    pub fn weight_across(&self, x: f64) -> f64 {
        self.weight_along(0, x, self.radius.x)
    }

    /// The same for the vertical offset.
    #[inline]
    #[must_use]
    pub fn weight_down(&self, y: f64) -> f64 {
        self.weight_along(1, y, self.radius.y)
    }

    #[inline]
    fn weight_along(&self, axis: usize, x: f64, radius: f32) -> f64 {
        let radius = f64::from(radius);
        let integral = match (&self.axes, self.kind) {
            (Some(axes), _) => axes[axis].integral,
            (None, FilterKind::Triangle) => radius * radius,
            (None, _) => 2.0 * radius,
        };
        self.kind.profile(x, radius) / integral
    }

    /// Integral of [`eval`](Self::eval) over the support, in square pixels.
    #[must_use]
    pub const fn integral(&self) -> f32 {
        self.integral
    }

    /// Draws an offset with a density proportional to the absolute value of the filter.
    #[inline]
    #[must_use]
    pub fn sample(&self, u: Point2) -> FilterSample {
        if let Some(axes) = &self.axes {
            let (x, weight_x) = axes[0].sample(u.x);
            let (y, weight_y) = axes[1].sample(u.y);
            return FilterSample { offset: Vector2::new(x, y), weight: weight_x * weight_y };
        }
        let offset = match self.kind {
            FilterKind::Triangle => {
                Vector2::new(warp::sample_tent(u.x, self.radius.x), warp::sample_tent(u.y, self.radius.y))
            }
            _ => Vector2::new(self.radius.x * (2.0 * u.x - 1.0), self.radius.y * (2.0 * u.y - 1.0)),
        };
        FilterSample { offset, weight: 1.0 }
    }

    /// Reads a filter; problems are reported and answered with the default filter.
    pub fn from_parameters(parameters: &mut Parameters<'_, '_>) -> Self {
        let name = parameters.entity().type_name.as_str();
        let kind = match name {
            "box" => FilterKind::Box,
            "triangle" => FilterKind::Triangle,
            "gaussian" => FilterKind::Gaussian { sigma: parameters.float("sigma", 0.5) },
            "mitchell" => FilterKind::Mitchell {
                b: parameters.float("B", 1.0 / 3.0),
                c: parameters.float("C", 1.0 / 3.0),
            },
            "sinc" => FilterKind::LanczosSinc { tau: parameters.float("tau", 3.0) },
            _ => {
                let span = parameters.span();
                parameters.accept_all();
                let known = FILTERS.iter().map(|(name, _)| *name);
                parameters.diagnostics().unknown_name(span, "pixel filter", name, known);
                return Self::default();
            }
        };
        let default_radius = kind.default_radius();
        let radius = Vector2::new(
            parameters.float("xradius", default_radius),
            parameters.float("yradius", default_radius),
        );
        Self::new(kind, radius).unwrap_or_else(|| {
            let span = parameters.span();
            let message = format!("the \"{name}\" filter needs positive radii and a positive integral");
            parameters.diagnostics().error(span, message);
            Self::default()
        })
    }
}

const fn radius(name: &'static str, default: &'static str) -> ParameterSpec {
    ParameterSpec {
        name,
        kind: "float",
        default,
        unit: "pixel",
        doc: "half the size of the support along the axis",
    }
}
static BOX_PARAMETERS: [ParameterSpec; 2] = [radius("xradius", "0.5"), radius("yradius", "0.5")];
static TRIANGLE_PARAMETERS: [ParameterSpec; 2] = [radius("xradius", "2"), radius("yradius", "2")];
static GAUSSIAN_PARAMETERS: [ParameterSpec; 3] = [
    radius("xradius", "1.5"),
    radius("yradius", "1.5"),
    ParameterSpec { name: "sigma", kind: "float", default: "0.5", unit: "pixel", doc: "standard deviation" },
];
static MITCHELL_PARAMETERS: [ParameterSpec; 4] = [
    radius("xradius", "2"),
    radius("yradius", "2"),
    ParameterSpec { name: "B", kind: "float", default: "1/3", unit: "", doc: "blur, 0 to 1" },
    ParameterSpec { name: "C", kind: "float", default: "1/3", unit: "", doc: "ringing, 0 to 1" },
];
static SINC_PARAMETERS: [ParameterSpec; 3] = [
    radius("xradius", "4"),
    radius("yradius", "4"),
    ParameterSpec {
        name: "tau",
        kind: "float",
        default: "3",
        unit: "",
        doc: "cycles that the window passes",
    },
];

/// Filters with their parameters.
pub static FILTERS: &[(&str, &[ParameterSpec])] = &[
    ("box", &BOX_PARAMETERS),
    ("triangle", &TRIANGLE_PARAMETERS),
    ("gaussian", &GAUSSIAN_PARAMETERS),
    ("mitchell", &MITCHELL_PARAMETERS),
    ("sinc", &SINC_PARAMETERS),
];
