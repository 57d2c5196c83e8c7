//! The film: what arrives at each pixel, summed exactly, and its development into an image.
//!
//! Every pixel sample carries the weight of the pixel filter at its offset; a pixel's value is the weighted mean of
//! its samples. Filters are importance-sampled (Ernst, Stamminger and Greiner 2006, "Filter Importance Sampling"), so
//! that a sample belongs to one pixel, and sums are exact, so that neither threads nor a split of passes can change a
//! bit of the result.

mod exact_sum;
mod settings;
mod sums;
#[cfg(test)]
mod tests;

use std::ops::Range;

use etendue_image::Image;
use etendue_spectrum::{Sampled, Wavelengths};

pub use exact_sum::ExactSum;
pub use settings::{AovSpace, FilmKind, FilmSettings, PixelBounds};
pub use sums::{FilmSums, MergeError, SampleFaults, SumsError};

/// Position of the colour among the values of a pixel and of the sums of w², w² Y and w² Y² that tell the variance
/// (w the weight, Y the luminance of a sample); extra channels follow.
const N_COLOR: usize = 3;
const MOMENTS: Range<usize> = N_COLOR..N_COLOR + 3;
const FIRST_EXTRA: usize = MOMENTS.end;
/// Names of what every film has, in its order. Images do not show the moments.
const CANONICAL_NAMES: [&str; FIRST_EXTRA] =
    ["R", "G", "B", "weight squared", "weighted luminance", "weighted luminance squared"];

/// Features of the first surface that a camera ray meets, for the channels of a `gbuffer` film.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Features {
    /// Reflectance under white light, RGB.
    pub albedo: [f32; 3],
    /// Position, in the space that the film asks for.
    pub position: [f32; 3],
    /// Geometric normal.
    pub normal: [f32; 3],
    /// Shading normal.
    pub shading_normal: [f32; 3],
    /// Texture coordinates.
    pub uv: [f32; 2],
    /// Distance along the camera's axis, in metres.
    pub depth: f32,
}

impl Features {
    /// Channel names in the order of [`to_array`](Self::to_array).
    pub const CHANNELS: [&'static str; 15] = [
        "Albedo.R", "Albedo.G", "Albedo.B", "P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "Ns.X", "Ns.Y", "Ns.Z",
        "u", "v", "depth.Z",
    ];

    fn to_array(self) -> [f32; 15] {
        let mut values = [0.0; 15];
        values[0..3].copy_from_slice(&self.albedo);
        values[3..6].copy_from_slice(&self.position);
        values[6..9].copy_from_slice(&self.normal);
        values[9..12].copy_from_slice(&self.shading_normal);
        values[12..14].copy_from_slice(&self.uv);
        values[14] = self.depth;
        values
    }
}

/// One finished camera path.
#[derive(Clone, Copy, Debug)]
pub struct PixelSample<'a> {
    /// Radiance along the camera ray in W/(m^2 sr nm), times the camera's weight.
    pub radiance: Sampled,
    /// Its wavelengths.
    pub lambda: &'a Wavelengths,
    /// Weight of the pixel filter.
    pub filter_weight: f32,
    /// Features of the first surface, if the film wants them.
    pub features: Option<Features>,
    /// Radiance of each named layer, in the order of [`FilmLayout::layers`].
    pub layers: &'a [Sampled],
}

/// The channels of a film beyond colour.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilmLayout {
    /// Names of the layers by path expression.
    pub layers: Vec<String>,
    n_features: usize,
    n_buckets: usize,
}

impl FilmLayout {
    fn new(settings: &FilmSettings, layers: Vec<String>) -> Self {
        let (n_features, n_buckets) = match settings.kind {
            FilmKind::Rgb => (0, 0),
            FilmKind::GBuffer(_) => (Features::CHANNELS.len(), 0),
            FilmKind::Spectral { n_buckets, .. } => (0, n_buckets),
        };
        Self { layers, n_features, n_buckets }
    }

    /// Names of the values of a pixel, in their order.
    fn channel_names(&self, settings: &FilmSettings) -> Vec<String> {
        let mut names: Vec<String> = CANONICAL_NAMES.map(str::to_owned).to_vec();
        names.extend(Features::CHANNELS.iter().take(self.n_features).map(|name| (*name).to_owned()));
        names.extend((0..self.n_buckets).map(|bucket| settings.bucket_name(bucket)));
        for layer in &self.layers {
            names.extend(["R", "G", "B"].map(|component| format!("{layer}.{component}")));
        }
        names
    }
}

/// A part of the film that one thread fills.
#[derive(Debug)]
pub struct FilmTile<'f> {
    settings: &'f FilmSettings,
    layout: &'f FilmLayout,
    sums: FilmSums,
}

impl FilmTile<'_> {
    /// The pixels of this tile.
    #[must_use]
    pub const fn bounds(&self) -> PixelBounds {
        self.sums.bounds
    }

    /// True if samples should come with [`Features`].
    #[must_use]
    pub const fn wants_features(&self) -> bool {
        self.layout.n_features > 0
    }

    /// Adds one sample. NaN, infinite or negative radiance is counted and taken as black; debug builds panic.
    pub fn add(&mut self, pixel: [u32; 2], sample: &PixelSample<'_>) {
        let mut radiance = sample.radiance;
        if !radiance.is_finite() || radiance.min_value() < 0.0 {
            debug_assert!(false, "radiance {radiance:?} at pixel {pixel:?}");
            self.sums.faults.invalid += 1;
            self.sums.faults.first_pixel.get_or_insert(pixel);
            radiance = Sampled::ZERO;
        }
        let index = self.sums.bounds.index(pixel);
        let weight = f64::from(sample.filter_weight);
        self.sums.weights[index] += ExactSum::of(weight);

        let rgb = self.settings.output_rgb(radiance, sample.lambda);
        let luminance = self.sums.luminance(rgb);
        let stride = self.sums.stride();
        let values = &mut self.sums.values[index * stride..(index + 1) * stride];
        for (sum, value) in values.iter_mut().zip(rgb) {
            let term = f64::from(value) * weight;
            self.sums.faults.saturated += u64::from(ExactSum::saturates(term));
            *sum += ExactSum::of(term);
        }
        let mut moment = weight * weight;
        for sum in &mut values[MOMENTS] {
            *sum += ExactSum::of(moment);
            moment *= luminance;
        }

        let extra = &mut values[FIRST_EXTRA..];
        let (features, extra) = extra.split_at_mut(self.layout.n_features);
        if let Some(found) = sample.features {
            for (sum, value) in features.iter_mut().zip(found.to_array()) {
                *sum += ExactSum::of(f64::from(value) * weight);
            }
        }
        let (buckets, layers) = extra.split_at_mut(self.layout.n_buckets);
        if !buckets.is_empty() {
            self.settings.add_to_buckets(radiance, sample.lambda, weight, buckets);
        }
        for (sums, layer) in layers.chunks_exact_mut(N_COLOR).zip(sample.layers) {
            for (sum, value) in sums.iter_mut().zip(self.settings.output_rgb(*layer, sample.lambda)) {
                *sum += ExactSum::of(f64::from(value) * weight);
            }
        }
    }
}

/// The sums of all pixels with the film's setup.
#[derive(Clone, Debug)]
pub struct Film {
    settings: FilmSettings,
    layout: FilmLayout,
    sums: FilmSums,
}

impl Film {
    /// A film without samples, with these layers by path expression.
    #[must_use]
    pub fn new(settings: FilmSettings, layers: Vec<String>) -> Self {
        let layout = FilmLayout::new(&settings, layers);
        let sums =
            FilmSums::new(settings.crop, layout.channel_names(&settings), settings.luminance_weights());
        Self { settings, layout, sums }
    }

    /// How it was set up.
    #[must_use]
    pub const fn settings(&self) -> &FilmSettings {
        &self.settings
    }

    /// Its channels beyond colour.
    #[must_use]
    pub const fn layout(&self) -> &FilmLayout {
        &self.layout
    }

    /// The sums of all pixels.
    #[must_use]
    pub const fn sums(&self) -> &FilmSums {
        &self.sums
    }

    /// The sums of all pixels, to restore them.
    #[must_use]
    pub const fn sums_mut(&mut self) -> &mut FilmSums {
        &mut self.sums
    }

    /// Disjoint ascending ranges of the passes it holds.
    #[must_use]
    pub fn passes(&self) -> &[Range<u64>] {
        self.sums.passes()
    }

    /// Number of passes it holds.
    #[must_use]
    pub fn n_passes(&self) -> u64 {
        self.sums.n_passes()
    }

    /// True if that pass is in the sums.
    #[must_use]
    pub fn holds_pass(&self, pass: u64) -> bool {
        self.passes().iter().any(|r| r.contains(&pass))
    }

    /// Square tiles that cover the film, in rows.
    #[must_use]
    pub fn tiles(&self, size: u32) -> Vec<PixelBounds> {
        self.settings.crop.tiles(size)
    }

    /// An empty tile for one thread.
    #[must_use]
    pub fn start_tile(&self, bounds: PixelBounds) -> FilmTile<'_> {
        FilmTile { settings: &self.settings, layout: &self.layout, sums: self.sums.like(bounds) }
    }

    /// Takes the sums out of a tile, so that the film can change; [`add_sums`](Self::add_sums) brings them in.
    #[must_use]
    pub fn finish_tile(tile: FilmTile<'_>) -> FilmSums {
        tile.sums
    }

    /// Adds what a tile gathered.
    pub fn add_sums(&mut self, tile: &FilmSums) {
        self.sums.add_tile(tile);
    }

    /// Notes that a pass is complete.
    pub fn note_pass(&mut self, pass: u64) {
        self.sums.note_passes(pass..pass + 1);
    }

    /// The image so far; see [`FilmSums::develop`].
    #[must_use]
    pub fn develop(&self) -> Image {
        self.sums.develop()
    }

    /// Relative standard error of the image; see [`FilmSums::relative_error`].
    #[must_use]
    pub fn relative_error(&self) -> f64 {
        self.sums.relative_error()
    }
}
