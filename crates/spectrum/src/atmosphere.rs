//! The sun above the atmosphere, and how much of its light clear air takes away: published measurements and fits, from
//! which the sky is computed (SPEC EMI-12).
//!
//! Optical depths are for a vertical path from sea level to space: of light from the zenith, `exp(-depth)` arrives
//! unscattered. Water vapour and oxygen absorb in narrow bands above 690 nm, where the eye hardly sees; they are left
//! out, which costs less than 0.5 % of illuminance.

/// Angular radius of the sun's disc at its mean distance, in degrees.
pub const SUN_RADIUS_DEGREES: f64 = 0.2666;

/// Irradiance outside the atmosphere at the mean distance of the sun, in W/(m^2 um), by wavelength in nm: the revised
/// spectrum of Neckel and Labs, as tabulated by Bird and Riordan 1984 ("Simple Solar Spectral Model for Direct and
/// Diffuse Irradiance on Horizontal and Tilted Planes at the Earth's Surface for Cloudless Atmospheres", SERI/TR-215-2436).
const SOLAR: [[f64; 2]; 42] = [
    [350.0, 975.5],
    [360.0, 975.9],
    [370.0, 1119.9],
    [380.0, 1103.8],
    [390.0, 1033.8],
    [400.0, 1479.1],
    [410.0, 1701.3],
    [420.0, 1740.4],
    [430.0, 1587.2],
    [440.0, 1837.0],
    [450.0, 2005.0],
    [460.0, 2043.0],
    [470.0, 1987.0],
    [480.0, 2027.0],
    [490.0, 1896.0],
    [500.0, 1909.0],
    [510.0, 1927.0],
    [520.0, 1831.0],
    [530.0, 1891.0],
    [540.0, 1898.0],
    [550.0, 1892.0],
    [570.0, 1840.0],
    [593.0, 1768.0],
    [610.0, 1728.0],
    [630.0, 1658.0],
    [656.0, 1524.0],
    [667.6, 1531.0],
    [690.0, 1420.0],
    [710.0, 1399.0],
    [718.0, 1374.0],
    [724.4, 1373.0],
    [740.0, 1298.0],
    [752.5, 1269.0],
    [757.5, 1245.0],
    [762.5, 1223.0],
    [767.5, 1205.0],
    [780.0, 1183.0],
    [800.0, 1148.0],
    [816.0, 1091.0],
    [823.7, 1062.0],
    [831.5, 1038.0],
    [840.0, 1022.0],
];

/// Absorption of ozone (Chappuis bands) per cm of the gas at standard pressure, to base e; from the same report.
const OZONE: [[f64; 2]; 28] = [
    [440.0, 0.0],
    [450.0, 0.003],
    [460.0, 0.006],
    [470.0, 0.009],
    [480.0, 0.014],
    [490.0, 0.021],
    [500.0, 0.030],
    [510.0, 0.040],
    [520.0, 0.048],
    [530.0, 0.063],
    [540.0, 0.075],
    [550.0, 0.085],
    [570.0, 0.120],
    [593.0, 0.119],
    [610.0, 0.120],
    [630.0, 0.090],
    [656.0, 0.065],
    [667.6, 0.051],
    [690.0, 0.028],
    [710.0, 0.018],
    [718.0, 0.015],
    [724.4, 0.012],
    [740.0, 0.010],
    [752.5, 0.008],
    [757.5, 0.007],
    [762.5, 0.006],
    [767.5, 0.005],
    [780.0, 0.0],
];

/// Irradiance in W/(m^2 nm) of a plane that faces the sun, outside the atmosphere and at the mean distance of the sun.
#[must_use]
pub fn solar_irradiance(nm: f64) -> f64 {
    interpolate(&SOLAR, nm) * 1e-3
}

/// Optical depth of the molecules of air above sea level (Bodhaine, Wood, Dutton and Slusser 1999, "On Rayleigh Optical
/// Depth Calculations", eq. 30).
#[must_use]
pub fn rayleigh_optical_depth(nm: f64) -> f64 {
    let l2 = (nm * 1e-3).powi(2);
    0.002_152_0 * (1.045_599_6 - 341.290_61 / l2 - 0.902_308_50 * l2)
        / (1.0 + 0.002_705_988_9 / l2 - 85.968_563 * l2)
}

/// Optical depth of so much ozone, in Dobson units: hundredths of a millimetre of the gas at standard pressure.
#[must_use]
pub fn ozone_optical_depth(nm: f64, dobson_units: f64) -> f64 {
    interpolate(&OZONE, nm) * dobson_units * 1e-3
}

/// Optical depth of haze: `beta (nm / 1000)^-1.3` (Ångström 1929), where `beta` follows from the turbidity by the line of
/// Preetham, Shirley and Smits 1999 ("A Practical Analytic Model for Daylight").
#[must_use]
pub fn aerosol_optical_depth(nm: f64, turbidity: f64) -> f64 {
    let beta = (0.046_08 * turbidity - 0.045_86).max(0.0);
    beta * (nm * 1e-3).powf(-1.3)
}

/// Exponent of the limb darkening of the sun's disc: its radiance is that of the centre times `mu^alpha`, where
/// `mu = sqrt(1 - (r / R)^2)` (Hestroffer and Magnan 1998, "Wavelength dependency of the Solar limb darkening").
#[must_use]
pub fn limb_darkening_exponent(nm: f32) -> f32 {
    -0.023 + 292.0 / nm
}

/// Linear between the points of a table, constant beyond.
fn interpolate(table: &[[f64; 2]], nm: f64) -> f64 {
    let next = table.partition_point(|point| point[0] <= nm);
    let (Some(a), Some(b)) = (table.get(next.wrapping_sub(1)), table.get(next)) else {
        return table[next.min(table.len() - 1)][1];
    };
    a[1] + (b[1] - a[1]) * (nm - a[0]) / (b[0] - a[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cie;

    #[track_caller]
    fn assert_close(value: f64, expected: f64, relative: f64) {
        assert!((value - expected).abs() <= relative * expected.abs(), "{value} is not near {expected}");
    }

    #[test]
    fn the_sun_above_the_air_has_its_published_illuminance() {
        // 133.1 klx by the spectrum of ASTM E490, 134.1 by that of Wehrli 1985 (Darula, Kittler and Gueymard 2005).
        let [_, y, _] = cie::integrate_1nm(|nm| solar_irradiance(f64::from(nm)) as f32);
        assert_close(683.0 * f64::from(y), 133.6e3, 0.01);
    }

    #[test]
    fn optical_depths_have_their_published_values() {
        // Bodhaine et al. 1999, Table 3: 0.09736 at 550 nm (dry air, 360 ppm of CO2, 1013.25 mbar).
        assert_close(rayleigh_optical_depth(550.0), 0.0973, 0.005);
        assert_close(rayleigh_optical_depth(400.0), 0.3604, 0.01);
        // The molecules of the library's own air above a square metre: scale height 8.44 km at 15 degrees.
        assert_close(rayleigh_optical_depth(500.0), crate::scattering::air(500.0) * 8440.0, 0.02);
        assert_close(ozone_optical_depth(593.0, 300.0), 0.0357, 1e-6);
        assert_eq!(ozone_optical_depth(400.0, 300.0), 0.0);
        // beta = 0.04608 T - 0.04586.
        assert_close(aerosol_optical_depth(1000.0, 3.0), 0.09238, 1e-4);
        assert_eq!(aerosol_optical_depth(550.0, 0.5), 0.0);
    }

    #[test]
    fn tables_are_constant_beyond_their_ends() {
        assert_eq!(solar_irradiance(300.0), 0.9755);
        assert_eq!(solar_irradiance(900.0), 1.022);
        assert_close(solar_irradiance(405.0), 1.5902, 1e-6);
    }
}
