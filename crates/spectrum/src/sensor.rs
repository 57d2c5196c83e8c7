//! Response of the film to light.
//!
//! The sensor of the CIE 1931 observer: X = r · mean over wavelengths of L(λ) x̄(λ) / pdf(λ), likewise Y and Z, an
//! estimate of r ∫ L x̄ dλ. The imaging ratio r = exposure time × ISO / 100 stands for the exposure. XYZ is not divided by
//! ∫ ȳ dλ, because lights are divided by ∫ s ȳ dλ ([`crate::spectrum_to_photometric`]): a light with Y = 1 gives a film
//! value of 1. For the same reason the bands of a path ([`crate::Bands`]) are multiplied by ∫ ȳ dλ: they are linear sRGB of
//! light divided by it. White balance maps the white of daylight of a temperature to the white of the output space.

use crate::cie::{CIE_Y_INTEGRAL, color_matching};
use crate::matrix::{Matrix3, multiply, transform};
use crate::tables::weighted_rows;
use crate::xyz::white_balance_f64;
use crate::{
    ColorSpace, ColorSpaceName, LAMBDA_MIN_NM, N_DENSE, N_LAMBDA, Sampled, SpectrumTables, Wavelengths, Xyz,
    daylight, spectrum_to_xyz,
};

/// What a sensor is made from.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SensorSettings {
    /// Exposure time in s.
    pub exposure_time_s: f32,
    /// Speed of the film; 100 and 1 s leave values as they are.
    pub iso: f32,
    /// Temperature in kelvin of the daylight that shall become white; `None` for no white balance.
    pub white_balance_kelvin: Option<f32>,
    /// Colour space of the output.
    pub color_space: ColorSpaceName,
}

impl Default for SensorSettings {
    fn default() -> Self {
        Self {
            exposure_time_s: 1.0,
            iso: 100.0,
            white_balance_kelvin: None,
            color_space: ColorSpaceName::Srgb,
        }
    }
}

impl SensorSettings {
    /// Film value per unit of luminance.
    #[must_use]
    pub fn imaging_ratio(&self) -> f32 {
        self.exposure_time_s * self.iso / 100.0
    }
}

/// A film's response: from radiance at the wavelengths of a path to linear RGB of the output space.
#[derive(Clone, Debug)]
pub struct Sensor {
    settings: SensorSettings,
    /// Response of R, G, B of the output space, and of Y before white balance, at every nm.
    response: Vec<[f32; 4]>,
    /// The same of the bands red, green and blue.
    band_response: [[f32; 4]; 3],
}

impl Sensor {
    /// The sensor of the CIE 1931 observer, `cie1931` in scene files.
    #[must_use]
    pub fn cie1931(settings: &SensorSettings) -> Self {
        let space = ColorSpace::get(settings.color_space);
        let rgb_from_xyz: Matrix3 = space.rgb_from_xyz.map(|row| row.map(f64::from));
        let rgb_from_sensor = match settings.white_balance_kelvin {
            Some(kelvin) => multiply(
                &rgb_from_xyz,
                &white_balance_f64(daylight_xy(kelvin).map(f64::from), space.white_xy.map(f64::from)),
            ),
            None => rgb_from_xyz,
        };
        let ratio = f64::from(settings.imaging_ratio());
        let respond = |xyz: [f64; 3]| {
            let [r, g, b] = transform(&rgb_from_sensor, xyz);
            [r, g, b, xyz[1]].map(|v| (v * ratio) as f32)
        };
        let observer = color_matching();
        let response = (0..N_DENSE)
            .map(|i| respond([observer.x_bar[i], observer.y_bar[i], observer.z_bar[i]].map(f64::from)))
            .collect();
        let srgb = ColorSpace::get(ColorSpaceName::Srgb);
        let band_response = std::array::from_fn(|band| {
            respond(srgb.xyz_from_rgb.map(|row| f64::from(row[band]) * f64::from(CIE_Y_INTEGRAL)))
        });
        Self { settings: *settings, response, band_response }
    }

    /// What the sensor was made from.
    #[must_use]
    pub fn settings(&self) -> &SensorSettings {
        &self.settings
    }

    /// Linear RGB of the output space for radiance `l` at the wavelengths of a path; wavelengths of density 0 add nothing.
    #[inline]
    #[must_use]
    pub fn sensor_rgb(&self, l: Sampled, wavelengths: &Wavelengths) -> [f32; 3] {
        let [r, g, b, _] = self.respond(l, wavelengths);
        [r, g, b]
    }

    /// Luminance Y times the imaging ratio, before white balance: in cd/m² for lights as in the module's text.
    #[inline]
    #[must_use]
    pub fn luminance(&self, l: Sampled, wavelengths: &Wavelengths) -> f32 {
        self.respond(l, wavelengths)[3]
    }

    /// XYZ of the output: the colour of [`Self::sensor_rgb`].
    #[must_use]
    pub fn sensor_xyz(&self, l: Sampled, wavelengths: &Wavelengths) -> Xyz {
        ColorSpace::get(self.settings.color_space).to_xyz(self.sensor_rgb(l, wavelengths))
    }

    /// Mean of l × response / pdf, or the sum over bands.
    #[inline]
    fn respond(&self, l: Sampled, wavelengths: &Wavelengths) -> [f32; 4] {
        if let Some(rgb) = wavelengths.estimate_bands(l) {
            return std::array::from_fn(|c| (0..3).map(|band| rgb[band] * self.band_response[band][c]).sum());
        }
        weighted_rows(&self.response, l.safe_div(wavelengths.pdf() * N_LAMBDA as f32), wavelengths)
    }
}

/// Chromaticity of daylight of a temperature in kelvin.
fn daylight_xy(kelvin: f32) -> [f32; 2] {
    let mut tables = SpectrumTables::new();
    let values = daylight(kelvin);
    let table = tables.add_dense(|nm| values[(nm - LAMBDA_MIN_NM) as usize]);
    let spectrum = crate::Spectrum::table(table, &tables);
    spectrum_to_xyz(&spectrum, &tables).chromaticity()
}
