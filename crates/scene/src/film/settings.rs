//! How a film is set up: resolution, crop, sensor and channels.

use etendue_spectrum::cie::CIE_Y_INTEGRAL;
use etendue_spectrum::{
    ColorSpace, ColorSpaceName, LAMBDA_MIN_NM, N_DENSE, N_LAMBDA, Sampled, Sensor, Wavelengths,
};

/// A rectangle of pixels; the upper ends are exclusive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct PixelBounds {
    /// Left and top pixel.
    pub min: [u32; 2],
    /// One past the right and bottom pixel.
    pub max: [u32; 2],
}

impl PixelBounds {
    /// Pixels across.
    #[must_use]
    pub const fn width(self) -> u32 {
        self.max[0].saturating_sub(self.min[0])
    }

    /// Pixels down.
    #[must_use]
    pub const fn height(self) -> u32 {
        self.max[1].saturating_sub(self.min[1])
    }

    /// Number of pixels.
    #[must_use]
    pub const fn n_pixels(self) -> usize {
        self.width() as usize * self.height() as usize
    }

    /// Position of a pixel in row-major order.
    #[inline]
    #[must_use]
    pub fn index(self, pixel: [u32; 2]) -> usize {
        (pixel[1] - self.min[1]) as usize * self.width() as usize + (pixel[0] - self.min[0]) as usize
    }

    /// All pixels, row by row.
    pub fn pixels(self) -> impl Iterator<Item = [u32; 2]> {
        (self.min[1]..self.max[1]).flat_map(move |y| (self.min[0]..self.max[0]).map(move |x| [x, y]))
    }

    /// Square tiles that cover the rectangle, in rows.
    #[must_use]
    pub fn tiles(self, size: u32) -> Vec<Self> {
        let mut tiles = Vec::new();
        for y in (self.min[1]..self.max[1]).step_by(size as usize) {
            for x in (self.min[0]..self.max[0]).step_by(size as usize) {
                let max = [(x + size).min(self.max[0]), (y + size).min(self.max[1])];
                tiles.push(Self { min: [x, y], max });
            }
        }
        tiles
    }
}

/// The space in which a `gbuffer` film states positions and normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AovSpace {
    /// Camera space.
    Camera,
    /// World space.
    World,
}

/// What a film records beyond colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilmKind {
    /// Colour alone.
    Rgb,
    /// Colour and features of the first surface.
    GBuffer(AovSpace),
    /// Colour and spectral radiance in equal bands of wavelength.
    Spectral {
        /// Number of bands.
        n_buckets: usize,
        /// Lower end of the first band in nanometres.
        min_nm: f32,
        /// Upper end of the last band in nanometres.
        max_nm: f32,
    },
}

/// How a film is set up.
#[derive(Clone, Debug)]
pub struct FilmSettings {
    /// Pixels of the full image across and down.
    pub resolution: [u32; 2],
    /// The pixels that are rendered.
    pub crop: PixelBounds,
    /// Channels.
    pub kind: FilmKind,
    /// Whether it records what a denoiser needs: features, variances and two halves of the samples.
    pub guides: bool,
    /// Response of the sensor, with exposure.
    pub sensor: Sensor,
    /// Colour space of the output.
    pub color_space: ColorSpaceName,
    /// Samples are scaled down to this largest component; infinite for no limit.
    pub max_component: f32,
    /// Name of the output file that the scene asks for.
    pub filename: String,
    /// Diagonal of the film in millimetres (for lens files).
    pub diagonal_mm: f32,
}

impl FilmSettings {
    /// The colour of a sample in the output colour space.
    #[inline]
    #[must_use]
    pub fn output_rgb(&self, radiance: Sampled, lambda: &Wavelengths) -> [f32; 3] {
        self.limited(self.sensor.sensor_rgb(radiance, lambda))
    }

    /// A colour, scaled down to [`max_component`](Self::max_component).
    #[inline]
    pub(super) fn limited(&self, rgb: [f32; 3]) -> [f32; 3] {
        let largest = rgb[0].max(rgb[1]).max(rgb[2]);
        if largest > self.max_component { rgb.map(|c| c * (self.max_component / largest)) } else { rgb }
    }

    /// Luminance of the unit red, green and blue of the output colour space.
    #[must_use]
    pub fn luminance_weights(&self) -> [f32; 3] {
        ColorSpace::get(self.color_space).xyz_from_rgb[1]
    }

    /// The colour of a reflectance under the white of the output colour space, without exposure.
    #[must_use]
    pub fn white_rgb(&self, reflectance: Sampled, lambda: &Wavelengths) -> [f32; 3] {
        let white = self.white(lambda);
        let rgb = self.sensor.sensor_rgb(reflectance * white, lambda);
        rgb.map(|c| c / self.sensor.settings().imaging_ratio())
    }

    /// White light of the output colour space, of luminance 1.
    #[must_use]
    pub fn white(&self, lambda: &Wavelengths) -> Sampled {
        let space = ColorSpace::get(self.color_space);
        if lambda.is_bands() {
            return lambda.of_bands(space.light_bands([1.0 / CIE_Y_INTEGRAL; 3]));
        }
        Sampled::from_array(lambda.lambda_nm().map(|nm| {
            let index = (nm - LAMBDA_MIN_NM).round().clamp(0.0, (N_DENSE - 1) as f32) as usize;
            space.illuminant[index] / CIE_Y_INTEGRAL
        }))
    }

    /// Name of a spectral channel by the spectral EXR layout of Fichet, Pacanowski and Wilkie 2021: `S0.` and the
    /// wavelength at the middle of the band.
    #[must_use]
    pub fn bucket_name(&self, bucket: usize) -> String {
        let FilmKind::Spectral { n_buckets, min_nm, max_nm } = self.kind else {
            return String::new();
        };
        let middle = min_nm + (bucket as f32 + 0.5) * (max_nm - min_nm) / n_buckets as f32;
        format!("S0.{}nm", format!("{middle:.3}").replace('.', ","))
    }

    /// Adds a sample's radiance to the bands of its wavelengths: the expectation of a band's sum is the mean of the
    /// spectral radiance over the band. Paths that carry red, green and blue tell nothing of the spectrum: they leave
    /// these bands black.
    pub(super) fn add_to_buckets(&self, radiance: Sampled, lambda: &Wavelengths, buckets: &mut [f32]) {
        let FilmKind::Spectral { n_buckets, min_nm, max_nm } = self.kind else {
            return;
        };
        if lambda.is_bands() {
            return;
        }
        let width = (max_nm - min_nm) / n_buckets as f32;
        let (nm, pdf) = (lambda.lambda_nm(), lambda.pdf());
        for i in 0..N_LAMBDA {
            let position = (nm[i] - min_nm) / width;
            if pdf[i] == 0.0 || position < 0.0 || position >= n_buckets as f32 {
                continue;
            }
            let estimate = radiance[i] / (pdf[i] * N_LAMBDA as f32 * width);
            buckets[position as usize] += estimate;
        }
    }
}
