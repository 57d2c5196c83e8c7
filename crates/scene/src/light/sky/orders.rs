//! Light that the air scatters more than once, by successive orders: the light of one order, scattered once more, is the
//! next (Hansen and Travis 1974, "Light Scattering in Planetary Atmospheres", section 2).
//!
//! The air lies in flat layers here, but the sun shines through spherical ones. Directions are Gauss nodes of the cosine,
//! azimuths are cosine series, and phase functions are series of Legendre polynomials, so that by the addition theorem
//! scattering is a sum over their products:
//!
//! ```text
//!   I(mu, phi) = sum_m (2 - [m = 0]) I_m(mu) cos(m phi),
//!   J_m(mu) = 1/2 sum_l (2 l + 1) chi_l Y_lm(mu) integral Y_lm(mu') I_m(mu') dmu',   Y_lm = sqrt((l - m)! / (l + m)!) P_l^m.
//! ```

use std::f64::consts::PI;

use super::air::{Amounts, HAZE_ASYMMETRY, Optics, TOP_KM};

/// Heights of the levels between layers, in km.
const LEVELS_KM: [f64; N_LEVELS] = [
    0.0, 0.15, 0.3, 0.5, 0.75, 1.0, 1.4, 1.9, 2.5, 3.3, 4.2, 5.5, 7.0, 9.0, 11.5, 14.5, 18.0, 22.0, 27.0,
    33.0, 40.0, 60.0, TOP_KM,
];
const N_LEVELS: usize = 23;
/// Gauss nodes of a hemisphere.
const N_NODES: usize = 16;
/// Legendre polynomials; the first left out weighs 0.7^20 = 0.0008.
const N_LEGENDRE: usize = 20;
/// Terms of the series of azimuth. What they leave out of light scattered twice is near the sun, where light scattered once
/// is far brighter.
pub(super) const N_AZIMUTH: usize = 10;
/// Orders end when one adds less than this to the sum of all sources.
const SMALLEST_ORDER: f64 = 1e-3;
const MAX_ORDERS: usize = 60;

/// Directions and polynomials, which depend on no wavelength.
#[derive(Debug)]
pub(super) struct Basis {
    /// Cosines of a hemisphere, ascending.
    nodes: [f64; N_NODES],
    weights: [f64; N_NODES],
    /// `Y_lm` at the downward directions by m, node, l; upwards it is the same but for the sign (-1)^(l + m).
    down: Vec<Polynomials>,
    /// At the direction of sunlight, by m.
    sun: [Polynomials; N_AZIMUTH],
    /// Share of sunlight and the air that it crosses at each level; `None` in the shadow of the earth.
    sun_path: [Option<Amounts>; N_LEVELS],
    layers: [Amounts; N_LEVELS - 1],
    sun_cosine: f64,
}

type Polynomials = [f64; N_LEGENDRE];
/// A value for each downward, then each upward node.
type Field = [f64; 2 * N_NODES];

impl Basis {
    /// For a sun of that cosine to the zenith.
    pub(super) fn new(sun_cosine: f64) -> Self {
        let (nodes, weights) = gauss_legendre();
        let down = (0..N_AZIMUTH).flat_map(|m| nodes.map(|mu| polynomials(m, -mu))).collect();
        Self {
            nodes,
            weights,
            down,
            sun: std::array::from_fn(|m| polynomials(m, -sun_cosine)),
            sun_path: LEVELS_KM.map(|height| Amounts::to_space(height, sun_cosine)),
            layers: std::array::from_fn(|k| Amounts::between(LEVELS_KM[k], LEVELS_KM[k + 1])),
            sun_cosine,
        }
    }

    fn at(&self, m: usize, node: usize) -> &Polynomials {
        &self.down[m * N_NODES + node]
    }
}

/// Light of one wavelength that was scattered more than once, where the sun's irradiance outside the air is 1.
#[derive(Debug)]
pub(super) struct Scattered {
    /// Source per unit of optical depth and steradian by m, level and downward node.
    source: Vec<[f64; N_NODES]>,
}

/// One wavelength during the sum over orders.
struct Orders<'a> {
    basis: &'a Basis,
    /// Share of what a level takes that molecules and haze scatter.
    albedos: [[f64; 2]; N_LEVELS],
    /// Share of light that crosses a layer, and the weights of the sources at its start and end, by layer and node.
    layers: Vec<[f64; 3]>,
}

impl Scattered {
    pub(super) fn new(basis: &Basis, optics: &Optics, ground_albedo: f64) -> Self {
        let orders = Orders::new(basis, optics);
        let sunlight: [f64; N_LEVELS] =
            basis.sun_path.map(|path| path.map_or(0.0, |amounts| (-optics.depth(amounts)).exp()));
        let direct = ground_albedo / PI * basis.sun_cosine.max(0.0) * sunlight[0];
        let mut total = vec![[0.0; N_NODES]; N_AZIMUTH * N_LEVELS];
        for m in 0..N_AZIMUTH {
            let mut source = orders.of_sunlight(m, &sunlight);
            let (mut from_ground, mut sum) = (if m == 0 { direct } else { 0.0 }, 0.0);
            for _ in 0..MAX_ORDERS {
                let field = orders.transport(&source, from_ground);
                let at_ground = orders.irradiance(&field[0]);
                from_ground = if m == 0 { ground_albedo / PI * at_ground } else { 0.0 };
                source = orders.scatter(m, &field);
                for (total, source) in total[m * N_LEVELS..].iter_mut().zip(&source) {
                    (0..N_NODES).for_each(|i| total[i] += source[i]);
                }
                let brightness: f64 = source.iter().flatten().map(|j| j.abs()).sum();
                sum += brightness;
                if brightness <= SMALLEST_ORDER * sum {
                    break;
                }
            }
        }
        Self { source: total }
    }

    /// The source towards an eye at one azimuth from the sun: of each level by downward node.
    pub(super) fn at_azimuth(&self, azimuth: f64) -> AzimuthSource {
        let mut levels = [[0.0; N_NODES]; N_LEVELS];
        for m in 0..N_AZIMUTH {
            let factor = if m == 0 { 1.0 } else { 2.0 * (m as f64 * azimuth).cos() };
            for (level, source) in levels.iter_mut().zip(&self.source[m * N_LEVELS..]) {
                (0..N_NODES).for_each(|i| level[i] += factor * source[i]);
            }
        }
        AzimuthSource { levels }
    }
}

/// The source of multiply scattered light in one vertical half plane.
#[derive(Debug)]
pub(super) struct AzimuthSource {
    levels: [[f64; N_NODES]; N_LEVELS],
}

impl AzimuthSource {
    /// Per unit of optical depth and steradian, at a height in km, of light that comes down with that cosine to the vertical.
    pub(super) fn at(&self, basis: &Basis, height_km: f64, cosine: f64) -> f64 {
        let (k, t) = bracket(&LEVELS_KM, height_km);
        let (i, s) = bracket(&basis.nodes, cosine);
        let row = |k: usize| self.levels[k][i] * (1.0 - s) + self.levels[k][i + 1] * s;
        (row(k) * (1.0 - t) + row(k + 1) * t).max(0.0)
    }
}

/// The interval of ascending values that holds `x`, and where in it; the ends are held beyond.
fn bracket(values: &[f64], x: f64) -> (usize, f64) {
    let i = values.partition_point(|value| *value <= x).clamp(1, values.len() - 1) - 1;
    (i, ((x - values[i]) / (values[i + 1] - values[i])).clamp(0.0, 1.0))
}

impl<'a> Orders<'a> {
    fn new(basis: &'a Basis, optics: &Optics) -> Self {
        let albedos = LEVELS_KM.map(|height| {
            let amounts = Amounts::at(height);
            let total = optics.depth(amounts);
            optics.scattering(amounts).map(|scattered| if total > 0.0 { scattered / total } else { 0.0 })
        });
        let crossing = |amounts: &Amounts, mu: f64| {
            let depth = optics.depth(*amounts) / mu;
            let through = (-depth).exp();
            if depth < 1e-3 {
                return [through, depth / 2.0, depth / 2.0];
            }
            // A source that is linear in depth.
            let mean = (1.0 - through) / depth;
            [through, mean - through, 1.0 - mean]
        };
        let layers =
            basis.layers.iter().flat_map(|layer| basis.nodes.map(|mu| crossing(layer, mu))).collect();
        Self { basis, albedos, layers }
    }

    /// Coefficients of the two phase functions, (2 l + 1) chi_l.
    fn phase_coefficients(l: usize) -> [f64; 2] {
        let rayleigh = match l {
            0 => 1.0,
            2 => 0.5,
            _ => 0.0,
        };
        [rayleigh, (2 * l + 1) as f64 * HAZE_ASYMMETRY.powi(l as i32)]
    }

    /// The source of light scattered once.
    fn of_sunlight(&self, m: usize, sunlight: &[f64; N_LEVELS]) -> Vec<Field> {
        let moments: Vec<f64> = self.basis.sun[m].iter().map(|y| y / (4.0 * PI)).collect();
        (0..N_LEVELS).map(|k| self.source_of(m, k, |l| moments[l] * sunlight[k])).collect()
    }

    /// Scatters once more, at every level.
    fn scatter(&self, m: usize, field: &[Field]) -> Vec<Field> {
        let basis = self.basis;
        (0..N_LEVELS)
            .map(|k| {
                let mut moments = [0.0; N_LEGENDRE];
                for i in 0..N_NODES {
                    let (down, up) =
                        (field[k][i] * basis.weights[i], field[k][N_NODES + i] * basis.weights[i]);
                    let y = basis.at(m, i);
                    for l in m..N_LEGENDRE {
                        let sign = if (l + m).is_multiple_of(2) { up } else { -up };
                        moments[l] += 0.5 * y[l] * (down + sign);
                    }
                }
                self.source_of(m, k, |l| moments[l])
            })
            .collect()
    }

    fn source_of(&self, m: usize, level: usize, moment: impl Fn(usize) -> f64) -> Field {
        let [molecules, haze] = self.albedos[level];
        let mut source = [0.0; 2 * N_NODES];
        for l in m..N_LEGENDRE {
            let [a, b] = Self::phase_coefficients(l);
            let strength = (molecules * a + haze * b) * moment(l);
            let sign = if (l + m).is_multiple_of(2) { strength } else { -strength };
            for i in 0..N_NODES {
                let y = self.basis.at(m, i)[l];
                source[i] += strength * y;
                source[N_NODES + i] += sign * y;
            }
        }
        source
    }

    /// Radiance at every level, of a source and of what the ground sends up.
    fn transport(&self, source: &[Field], from_ground: f64) -> Vec<Field> {
        let mut field = vec![[0.0; 2 * N_NODES]; N_LEVELS];
        for i in 0..N_NODES {
            for k in (0..N_LEVELS - 1).rev() {
                let [through, start, end] = self.layers[k * N_NODES + i];
                field[k][i] = field[k + 1][i] * through + source[k + 1][i] * start + source[k][i] * end;
            }
            let up = N_NODES + i;
            field[0][up] = from_ground;
            for k in 0..N_LEVELS - 1 {
                let [through, start, end] = self.layers[k * N_NODES + i];
                field[k + 1][up] = field[k][up] * through + source[k][up] * start + source[k + 1][up] * end;
            }
        }
        field
    }

    /// Of the ground.
    fn irradiance(&self, field: &Field) -> f64 {
        let basis = self.basis;
        2.0 * PI * (0..N_NODES).map(|i| basis.weights[i] * basis.nodes[i] * field[i]).sum::<f64>()
    }
}

/// `Y_lm` for l below [`N_LEGENDRE`] at x, without the sign (-1)^m, which cancels in products.
fn polynomials(m: usize, x: f64) -> Polynomials {
    let mut y = [0.0; N_LEGENDRE];
    if m >= N_LEGENDRE {
        return y;
    }
    let sine = (1.0 - x * x).max(0.0).sqrt();
    // Y_mm = sqrt((2 m)!) / (2^m m!) sin^m, then (l - m) recurrence of Legendre functions, normalised.
    y[m] = (1..=m).fold(1.0, |y, k| y * sine * ((2 * k - 1) as f64 / (2 * k) as f64).sqrt());
    if m + 1 < N_LEGENDRE {
        y[m + 1] = x * ((2 * m + 1) as f64).sqrt() * y[m];
    }
    for l in m + 2..N_LEGENDRE {
        let (lf, mf) = (l as f64, m as f64);
        let previous = ((lf - 1.0).powi(2) - mf * mf).sqrt() * y[l - 2];
        y[l] = ((2.0 * lf - 1.0) * x * y[l - 1] - previous) / (lf * lf - mf * mf).sqrt();
    }
    y
}

/// Nodes and weights of Gauss and Legendre on [0, 1], ascending: zeros of the polynomial by Newton's method.
fn gauss_legendre() -> ([f64; N_NODES], [f64; N_NODES]) {
    let (mut nodes, mut weights) = ([0.0; N_NODES], [0.0; N_NODES]);
    let n = N_NODES as f64;
    for i in 0..N_NODES {
        let mut x = -(PI * (i as f64 + 0.75) / (n + 0.5)).cos();
        let mut derivative = 1.0;
        for _ in 0..50 {
            let (mut p, mut before) = (x, 1.0);
            for k in 2..=N_NODES {
                let kf = k as f64;
                (p, before) = (((2.0 * kf - 1.0) * x * p - (kf - 1.0) * before) / kf, p);
            }
            derivative = n * (x * p - before) / (x * x - 1.0);
            let step = p / derivative;
            x -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        nodes[i] = (x + 1.0) / 2.0;
        weights[i] = 1.0 / ((1.0 - x * x) * derivative * derivative);
    }
    (nodes, weights)
}
