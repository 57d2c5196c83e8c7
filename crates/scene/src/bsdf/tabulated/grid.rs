//! Values of a BRDF on a grid of angles, and the values between.
//!
//! With the half vector h at theta_h from the normal, both directions are theta_d from h, and phi_d is the angle
//! about h from the plane of h and the normal to that of the directions. Exchanging these turns phi_d by 180°, so
//! that a table over [0°, 180°) is reciprocal. Nodes lie denser where highlights are (Matusik, Pfister, Brand and
//! McMillan 2003, "A Data-Driven Reflectance Model"): node i of n at `theta_h = 90° (i / (n - 1))²`, node j of m at
//! `theta_d = 90° j / (m - 1)`, node k of l at `phi_d = 180° k / l`; between them f is linear in each index.

use std::f32::consts::{FRAC_PI_2, PI};

use etendue_math::{Vector3, sqr};

/// A BRDF in 1/sr as linear sRGB on a grid over theta_h, theta_d and phi_d.
#[derive(Clone, Debug, PartialEq)]
pub struct BrdfGrid {
    resolution: [usize; 3],
    /// The last angle changes quickest.
    rgb: Vec<[f32; 3]>,
}

impl BrdfGrid {
    /// From at least two nodes over theta_h and theta_d and one over phi_d, the last changing quickest; `None` if
    /// there are fewer, their number is not that of the values, or a value is negative or no number.
    #[must_use]
    pub fn new(resolution: [usize; 3], rgb: Vec<[f32; 3]>) -> Option<Self> {
        let [n, m, l] = resolution;
        let n_nodes = n.checked_mul(m)?.checked_mul(l)?;
        let is_sound = |value: &[f32; 3]| value.iter().all(|c| c.is_finite() && *c >= 0.0);
        let is_grid = n >= 2 && m >= 2 && l >= 1 && n_nodes == rgb.len();
        (is_grid && rgb.iter().all(is_sound)).then_some(Self { resolution, rgb })
    }

    /// The table of `f(wo, wi)`. Nodes with a direction below the horizon, between which and others values are
    /// interpolated, get f of the nearest that is a little above. `None` if f or the resolution is unsound.
    #[must_use]
    pub fn tabulate(resolution: [usize; 3], f: impl Fn(Vector3, Vector3) -> [f32; 3]) -> Option<Self> {
        let [n, m, l] = resolution;
        let mut rgb = Vec::new();
        for i in 0..n {
            let theta_h = FRAC_PI_2 * sqr(i as f32 / (n - 1) as f32);
            for j in 0..m {
                let theta_d = FRAC_PI_2 * j as f32 / (m - 1) as f32;
                for k in 0..l {
                    let (wo, wi) = directions(theta_h, theta_d, PI * k as f32 / l as f32);
                    rgb.push(f(lifted(wo), lifted(wi)));
                }
            }
        }
        Self::new(resolution, rgb)
    }

    /// The least value anywhere, by channel.
    pub(super) fn least(&self) -> [f32; 3] {
        self.rgb.iter().fold([f32::MAX; 3], |least, value| std::array::from_fn(|c| least[c].min(value[c])))
    }

    /// The largest sum of the channels anywhere.
    pub(super) fn largest_sum(&self) -> f32 {
        self.rgb.iter().map(|value| value.iter().sum()).fold(0.0, f32::max)
    }

    /// f for directions above the surface, the same if they are exchanged, to the last bit.
    #[must_use]
    pub fn at(&self, wo: Vector3, wi: Vector3) -> [f32; 3] {
        let Some([theta_h, theta_d, phi_d]) = angles(wo, wi) else { return [0.0; 3] };
        let [n, m, l] = self.resolution;
        let (i, x) = place((theta_h / FRAC_PI_2).sqrt(), n);
        let (j, y) = place(theta_d / FRAC_PI_2, m);
        let turn = phi_d / PI * l as f32;
        let (k, z) = (turn as usize, turn.fract());
        let mut sum = [0.0; 3];
        for corner in 0..8 {
            let [a, b, c] = [corner & 1, corner >> 1 & 1, corner >> 2];
            let share = |upper: usize, t: f32| if upper == 1 { t } else { 1.0 - t };
            let weight = share(a, x) * share(b, y) * share(c, z);
            let value = self.rgb[((i + a) * m + j + b) * l + (k + c) % l];
            sum.iter_mut().zip(value).for_each(|(sum, value)| *sum += weight * value);
        }
        sum
    }

    /// theta_h where retroreflection, `wi` = `wo`, falls to half of what it is at the normal; `None` if it does not.
    pub(super) fn half_width(&self) -> Option<f32> {
        let [n, m, l] = self.resolution;
        let at = |i: usize| self.rgb[i * m * l].iter().sum::<f32>();
        let i = (1..n).find(|i| at(*i) < 0.5 * at(0))?;
        let between = (at(i - 1) - 0.5 * at(0)) / (at(i - 1) - at(i));
        Some(FRAC_PI_2 * sqr(((i - 1) as f32 + between) / (n - 1) as f32))
    }
}

/// The lower of two of `n` nodes, and the share of the way to the upper, of a place from 0 to 1.
#[inline]
pub(in crate::bsdf) fn place(t: f32, n: usize) -> (usize, f32) {
    let x = t * (n - 1) as f32;
    let lower = (x as usize).min(n - 2);
    (lower, (x - lower as f32).clamp(0.0, 1.0))
}

/// theta_h, theta_d and phi_d; `None` for opposite directions.
fn angles(wo: Vector3, wi: Vector3) -> Option<[f32; 3]> {
    let (sum, difference) = (wo + wi, wi - wo);
    let h = sum.try_normalized()?;
    let rho = h.x.hypot(h.y);
    let (cos, sin) = if rho > 0.0 { (h.x / rho, h.y / rho) } else { (1.0, 0.0) };
    let x = difference.dot(Vector3::new(cos * h.z, sin * h.z, -rho));
    let y = difference.y * cos - difference.x * sin;
    // Exchanged directions have both signs reversed.
    let (x, y) = if y < 0.0 || (y == 0.0 && x < 0.0) { (-x, -y) } else { (x, y) };
    Some([rho.atan2(h.z), difference.length().atan2(sum.length()), y.atan2(x).clamp(0.0, PI)])
}

/// `wo` and `wi` of theta_h, theta_d and phi_d.
fn directions(theta_h: f32, theta_d: f32, phi_d: f32) -> (Vector3, Vector3) {
    let ((sin_h, cos_h), (sin_d, cos_d)) = (theta_h.sin_cos(), theta_d.sin_cos());
    let (h, x) = (Vector3::new(sin_h, 0.0, cos_h), Vector3::new(cos_h, 0.0, -sin_h));
    let across = (x * phi_d.cos() + Vector3::new(0.0, phi_d.sin(), 0.0)) * sin_d;
    (h * cos_d - across, h * cos_d + across)
}

/// The direction, or the nearest that is one degree above the horizon.
fn lifted(w: Vector3) -> Vector3 {
    const LOWEST: f32 = 0.02;
    let rho = w.x.hypot(w.y);
    if w.z >= LOWEST || rho == 0.0 {
        return Vector3::new(w.x, w.y, w.z.abs());
    }
    let scale = (1.0 - LOWEST * LOWEST).sqrt() / rho;
    Vector3::new(w.x * scale, w.y * scale, LOWEST)
}
