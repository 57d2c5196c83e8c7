//! Fit of a smooth reflectance to an RGB colour.
//!
//! Finds the coefficients of a [`SigmoidPolynomial`] s so that ∫ s(λ) E(λ) (r̄, ḡ, b̄)(λ) dλ is the given linear RGB,
//! E the illuminant of the colour space, by Gauss-Newton steps with the damping of Levenberg and Marquardt (Jakob and
//! Hanika 2019, "A Low-Dimensional Function Space for Efficient Spectral Upsampling", doi:10.1111/cgf.13626, who measure
//! the residual in CIELAB; ours is in linear RGB, which agrees wherever the colour is reached).
//!
//! A colour that no such reflectance has is desaturated towards the grey of equal luminance until one has it.
//!
//! The iteration runs on a grid of 5 nm, whose weights integrate piecewise linear functions exactly, and ends on 1 nm.

use crate::cie::color_matching;
use crate::matrix::{Matrix3, invert, solve, transform};
use crate::{N_DENSE, SigmoidPolynomial};

/// Spacing of the coarse grid in nm; divides 470.
const COARSE_NM: usize = 5;
/// Largest component of the residual at which a fit is done.
const TOLERANCE: f64 = 1e-7;
/// Largest component of the residual at which a colour counts as reached.
const REACHED: f64 = 2e-4;
/// Halvings of the interval when a colour is out of reach: saturation to 1/256.
const BISECTIONS: usize = 8;
/// Components nearer than this to 0 or 1 need sigmoids beyond any use.
const MARGIN: f64 = 1e-6;

/// The integrals from a reflectance to linear RGB, as weights on wavelengths.
#[derive(Debug)]
pub(crate) struct Uplift {
    coarse: Vec<Weight>,
    fine: Vec<Weight>,
    /// Luminance of R, G and B.
    luminance: [f64; 3],
}

/// One term of the integrals.
#[derive(Copy, Clone, Debug)]
struct Weight {
    /// The wavelength mapped to [-1, 1].
    t: f64,
    /// Contribution of a reflectance of 1 here to R, G and B.
    rgb: [f64; 3],
}

/// State of the iteration: coefficients of t², t and 1, and where they lead.
#[derive(Copy, Clone, Debug)]
struct Step {
    coefficients: [f64; 3],
    residual: [f64; 3],
    /// Derivative of each component of RGB (row) by each coefficient (column).
    jacobian: Matrix3,
}

impl Uplift {
    /// For an illuminant (one value per nm, Y = 1) and a matrix from XYZ to RGB.
    pub(crate) fn new(illuminant: &[f32], rgb_from_xyz: &Matrix3) -> Self {
        let observer = color_matching();
        let mut fine: Vec<Weight> = (0..N_DENSE)
            .map(|i| {
                let bars = [observer.x_bar[i], observer.y_bar[i], observer.z_bar[i]];
                let xyz = bars.map(|bar| f64::from(bar) * f64::from(illuminant[i]));
                Weight { t: 2.0 * i as f64 / (N_DENSE - 1) as f64 - 1.0, rgb: transform(rgb_from_xyz, xyz) }
            })
            .collect();
        // White is (1, 1, 1) up to rounding of the illuminant; make it so exactly.
        let white: [f64; 3] = std::array::from_fn(|c| fine.iter().map(|w| w.rgb[c]).sum());
        for weight in &mut fine {
            weight.rgb = std::array::from_fn(|c| weight.rgb[c] / white[c]);
        }
        Self { coarse: coarsen(&fine), fine, luminance: invert(rgb_from_xyz)[1] }
    }

    /// The reflectance of a linear RGB, whose components are limited to [0, 1].
    pub(crate) fn fit(&self, rgb: [f32; 3]) -> SigmoidPolynomial {
        let rgb = rgb.map(|c| c.clamp(0.0, 1.0));
        if rgb[0] == rgb[1] && rgb[1] == rgb[2] {
            return SigmoidPolynomial::constant(rgb[0]);
        }
        let target = rgb.map(|c| f64::from(c).clamp(MARGIN, 1.0 - MARGIN));
        let start = constant_start(target);
        let step = match self.solve(target, start) {
            step if step.is_reached() => step,
            _ => self.solve_desaturated(target),
        };
        in_nanometres(step.coefficients)
    }

    /// Iterates on the coarse grid, then on the fine one.
    fn solve(&self, target: [f64; 3], start: [f64; 3]) -> Step {
        let coarse = levenberg_marquardt(&self.coarse, target, start, 60);
        levenberg_marquardt(&self.fine, target, coarse.coefficients, 8)
    }

    /// The fit of the most saturated colour that is reached on the way from the grey of equal luminance to the target.
    fn solve_desaturated(&self, target: [f64; 3]) -> Step {
        let luminance = (0..3).map(|c| self.luminance[c] * target[c]).sum::<f64>();
        let grey = luminance.clamp(MARGIN, 1.0 - MARGIN);
        let mut best = levenberg_marquardt(&self.fine, [grey; 3], constant_start([grey; 3]), 60);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            let colour = target.map(|c| grey + middle * (c - grey));
            let step = self.solve(colour, best.coefficients);
            if step.is_reached() {
                (low, best) = (middle, step);
            } else {
                high = middle;
            }
        }
        best
    }
}

impl Step {
    /// Whether the colour is met well enough.
    fn is_reached(&self) -> bool {
        self.residual.iter().all(|r| r.abs() < REACHED)
    }
}

/// Weights on every fifth wavelength that integrate functions linear between them as the fine weights do.
fn coarsen(fine: &[Weight]) -> Vec<Weight> {
    let mut coarse: Vec<Weight> =
        fine.iter().step_by(COARSE_NM).map(|w| Weight { t: w.t, rgb: [0.0; 3] }).collect();
    for (i, weight) in fine.iter().enumerate() {
        let (node, f) = (i / COARSE_NM, (i % COARSE_NM) as f64 / COARSE_NM as f64);
        for c in 0..3 {
            coarse[node].rgb[c] += (1.0 - f) * weight.rgb[c];
            if f > 0.0 {
                coarse[node + 1].rgb[c] += f * weight.rgb[c];
            }
        }
    }
    coarse
}

/// The grey of the mean component.
fn constant_start(target: [f64; 3]) -> [f64; 3] {
    let v = (target.iter().sum::<f64>() / 3.0).clamp(0.01, 0.99);
    [0.0, 0.0, (v - 0.5) / (v * (1.0 - v)).sqrt()]
}

/// Reduces the squared residual from a start until it is negligible or stops falling.
fn levenberg_marquardt(weights: &[Weight], target: [f64; 3], start: [f64; 3], max_steps: usize) -> Step {
    let mut current = evaluate(weights, target, start);
    let mut damping = 1e-4;
    for _ in 0..max_steps {
        if current.residual.iter().all(|r| r.abs() < TOLERANCE) {
            break;
        }
        let Some(coefficients) = damped_step(&current, damping) else {
            break;
        };
        let next = evaluate(weights, target, coefficients);
        if square(next.residual) < square(current.residual) {
            current = next;
            damping = (damping * 0.1).max(1e-12);
        } else {
            damping *= 10.0;
            if damping > 1e8 {
                break;
            }
        }
    }
    current
}

/// The residual and its derivatives at given coefficients.
fn evaluate(weights: &[Weight], target: [f64; 3], coefficients: [f64; 3]) -> Step {
    let [a, b, c] = coefficients;
    let mut rgb = [0.0; 3];
    let mut jacobian = [[0.0; 3]; 3];
    for weight in weights {
        let t = weight.t;
        let x = (a * t + b) * t + c;
        let inverse_root = 1.0 / (1.0 + x * x).sqrt();
        let s = 0.5 + 0.5 * x * inverse_root;
        let ds = 0.5 * inverse_root * inverse_root * inverse_root;
        for k in 0..3 {
            rgb[k] += weight.rgb[k] * s;
            let d = weight.rgb[k] * ds;
            jacobian[k][0] += d * t * t;
            jacobian[k][1] += d * t;
            jacobian[k][2] += d;
        }
    }
    Step { coefficients, residual: std::array::from_fn(|k| rgb[k] - target[k]), jacobian }
}

/// Coefficients after a step that solves (JᵀJ + μ diag JᵀJ) δ = −Jᵀ r.
fn damped_step(step: &Step, damping: f64) -> Option<[f64; 3]> {
    let j = &step.jacobian;
    let mut normal: Matrix3 =
        std::array::from_fn(|r| std::array::from_fn(|c| (0..3).map(|k| j[k][r] * j[k][c]).sum()));
    for (i, row) in normal.iter_mut().enumerate() {
        row[i] *= 1.0 + damping;
    }
    let gradient = std::array::from_fn(|c| -(0..3).map(|k| j[k][c] * step.residual[k]).sum::<f64>());
    let delta = solve(&normal, gradient)?;
    Some(std::array::from_fn(|i| step.coefficients[i] + delta[i]))
}

/// Sum of squares.
fn square(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum()
}

/// Replaces t by the wavelength in nm: t = (λ − 595) / 235.
fn in_nanometres([a, b, c]: [f64; 3]) -> SigmoidPolynomial {
    let (centre, half) = (595.0, 235.0);
    let (a, b) = (a / (half * half), b / half);
    SigmoidPolynomial::new(
        a as f32,
        (b - 2.0 * a * centre) as f32,
        (a * centre * centre - b * centre + c) as f32,
    )
}
