//! Sampling of a table by rejection, without cells: directions spread by the cosine are kept with the probability `a = f /
//! f_max` (von Neumann 1951, "Various Techniques Used in Connection With Random Digits").
//!
//! Of up to [`N_REFUSED`] refusals in a row, then the next direction whatever it is, so that a sample takes bounded time.
//! With `A = ∫ a cos / pi dw`, the chance to be kept, and `q = 1 - A`, its density is
//! `cos / pi (a (1 + q + ... + q^(n-1)) + q^n)`, which integrates to 1. A is tabulated over the angle of view. The first direction
//! uses the random numbers of the sample, the others follow from these by a hash.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, TAU};

use etendue_math::{Point2, Rng, Vector3, hash64, lerp, sqr, warp};

use super::BrdfGrid;
use super::table::rest;

/// How often a direction may be refused, a power of 2.
pub(super) const N_REFUSED: u32 = 1 << LOG2_N_REFUSED;
const LOG2_N_REFUSED: u32 = 5;
/// Angles of view at which A is known.
const N_VIEWS: usize = 128;

/// What rejection needs to know of a table.
#[derive(Debug)]
pub(super) struct Rejection {
    /// 1 over the largest sum of the channels of f.
    scale: f32,
    /// A at even angles of view from 0 to 90 degrees.
    kept: Vec<f32>,
}

impl Rejection {
    pub(super) fn new(grid: &BrdfGrid, diffuse: [f32; 3]) -> Self {
        // Values between nodes are means of those at nodes.
        let largest = grid.largest_sum() - diffuse.iter().sum::<f32>();
        let scale = 1.0 / largest.max(f32::MIN_POSITIVE);
        let angle = |view: usize| FRAC_PI_2 * view as f32 / (N_VIEWS - 1) as f32;
        let kept = (0..N_VIEWS).map(|view| (scale * mean(grid, diffuse, angle(view))).min(1.0));
        Self { scale, kept: kept.collect() }
    }

    /// a of a direction whose sum of channels of f is this.
    fn kept(&self, f: [f32; 3]) -> f32 {
        (self.scale * f.iter().sum::<f32>()).min(1.0)
    }

    pub(super) fn sample(&self, f: impl Fn(Vector3) -> [f32; 3], u_choice: f32, u: Point2) -> Vector3 {
        let bits = [u.x, u.y, u_choice].map(|x| u64::from(x.to_bits()));
        let mut rng = Rng::new(hash64(&bits), 0);
        let (mut wi, mut choice) = (warp::sample_cosine_hemisphere(u), u_choice);
        for _ in 0..N_REFUSED {
            if choice < self.kept(f(wi)) {
                break;
            }
            wi = warp::sample_cosine_hemisphere(rng.next_point2());
            choice = rng.next_f32();
        }
        wi
    }

    /// Density in 1/sr of `wi`, where f has these channels, for a view of this angle from the normal.
    pub(super) fn pdf(&self, theta_o: f32, f: [f32; 3], cos_i: f32) -> f32 {
        let place = (theta_o / FRAC_PI_2).clamp(0.0, 1.0) * (N_VIEWS - 1) as f32;
        let i = (place as usize).min(N_VIEWS - 2);
        let mut power = 1.0 - lerp(place - i as f32, self.kept[i], self.kept[i + 1]);
        // 1 + q + ... + q^(2m - 1) = (1 + ... + q^(m - 1)) (1 + q^m).
        let mut sum = 1.0;
        for _ in 0..LOG2_N_REFUSED {
            sum *= 1.0 + power;
            power *= power;
        }
        FRAC_1_PI * cos_i * (self.kept(f) * sum + power)
    }
}

/// `∫ f cos / pi dw` of the sum of channels at an angle of view, by half vectors: `dw = 4 (wo·h) dw_h`.
fn mean(grid: &BrdfGrid, diffuse: [f32; 3], theta_o: f32) -> f32 {
    // Theta_h goes by squares, as the nodes do.
    const N_RINGS: usize = 128;
    const N_SECTORS: usize = 48;
    let wo = Vector3::new(theta_o.sin(), 0.0, theta_o.cos());
    let mut sum = 0.0_f64;
    for cell in 0..N_RINGS * N_SECTORS {
        let t = ((cell / N_SECTORS) as f32 + 0.5) / N_RINGS as f32;
        let (sin, cos) = (FRAC_PI_2 * sqr(t)).sin_cos();
        let (sin_phi, cos_phi) = (TAU * ((cell % N_SECTORS) as f32 + 0.5) / N_SECTORS as f32).sin_cos();
        let h = Vector3::new(sin * cos_phi, sin * sin_phi, cos);
        let cos_d = wo.dot(h);
        let wi = h * (2.0 * cos_d) - wo;
        if cos_d > 0.0 && wi.z > 0.0 {
            // Solid angle of half vectors: sin theta_h d theta_h d phi with d theta_h = 90 degrees 2 t dt.
            let flux = rest(grid, diffuse, wo, wi).iter().sum::<f32>() * wi.z * 4.0 * cos_d;
            sum += f64::from(flux * sin * FRAC_PI_2 * 2.0 * t);
        }
    }
    (sum / N_RINGS as f64) as f32 * (TAU / N_SECTORS as f32) * FRAC_1_PI
}
