//! CIE daylight of any correlated colour temperature.
//!
//! S(λ) = S0 + M1 S1 + M2 S2, M1 and M2 from the chromaticity of daylight (Judd, MacAdam and Wyszecki 1964, "Spectral
//! Distribution of Typical Daylight as a Function of Correlated Color Temperature", doi:10.1364/JOSA.54.001031; CIE 015).

use std::sync::OnceLock;

use crate::blackbody;
use crate::cie::{integrate_1nm, parse_columns};
use crate::tables::{dense_nm, piecewise_linear};
use crate::{LAMBDA_MAX_NM, LAMBDA_MIN_NM, N_DENSE, Xyz};

/// Relative power at every nm from 360 to 830 nm, about 1 at 560 nm, of daylight of a nominal temperature in kelvin
/// (6500 for D65). Below 4000 K, where there is no daylight, a black body takes its place.
#[must_use]
pub fn daylight(kelvin: f32) -> Vec<f32> {
    // The radiation constant has been revised since the illuminants got their names.
    let cct = f64::from(kelvin) * 1.4388 / 1.4380;
    if cct < 4000.0 {
        return (0..N_DENSE).map(|i| blackbody::normalized(dense_nm(i), cct as f32)).collect();
    }
    let (m1, m2) = component_weights(daylight_chromaticity(cct));
    let [s0, s1, s2] = components();
    (0..N_DENSE)
        .map(|i| {
            let nm = dense_nm(i).min(LAMBDA_MAX_NM);
            let [a, b, c] = [s0, s1, s2].map(|s| f64::from(piecewise_linear(s, nm)));
            ((a + m1 * b + m2 * c) * 0.01) as f32
        })
        .collect()
}

/// Chromaticity (x, y) of [`daylight`] of a colour temperature in kelvin.
#[must_use]
pub fn chromaticity_of_temperature(kelvin: f32) -> [f32; 2] {
    let values = daylight(kelvin);
    let at = |nm: f32| values[((nm - LAMBDA_MIN_NM) as usize).min(N_DENSE - 1)];
    Xyz::from(integrate_1nm(at)).chromaticity()
}

/// Chromaticity (x, y) of daylight; the fit is meant for 4000 to 25000 K.
fn daylight_chromaticity(cct: f64) -> [f64; 2] {
    let t = 1000.0 / cct;
    let x = if cct <= 7000.0 {
        ((-4.607 * t + 2.9678) * t + 0.09911) * t + 0.244_063
    } else {
        ((-2.0064 * t + 1.9018) * t + 0.24748) * t + 0.237_040
    };
    [x, (-3.0 * x + 2.870) * x - 0.275]
}

/// Weights of the components S1 and S2 for a chromaticity.
fn component_weights([x, y]: [f64; 2]) -> (f64, f64) {
    let m = 0.0241 + 0.2562 * x - 0.7341 * y;
    let m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / m;
    let m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / m;
    (m1, m2)
}

/// Samples of S0, S1 and S2.
fn components() -> &'static [Vec<[f32; 2]>; 3] {
    static COMPONENTS: OnceLock<[Vec<[f32; 2]>; 3]> = OnceLock::new();
    COMPONENTS.get_or_init(|| {
        let rows = parse_columns(include_str!("../data/daylight.csv"));
        std::array::from_fn(|c| rows.iter().map(|row| [row[0], row[c + 1]]).collect())
    })
}
