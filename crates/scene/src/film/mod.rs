//! The film: what arrives at each pixel, summed exactly, and its development into an image.
//!
//! Every pixel sample carries the weight of the pixel filter at its offset; a pixel's value is the weighted mean of
//! its samples. Filters are importance-sampled (Ernst, Stamminger and Greiner 2006, "Filter Importance Sampling"), so
//! that a sample belongs to one pixel, and sums are exact, so that neither threads nor a split of passes can change a
//! bit of the result.

mod exact_sum;
mod guides;
mod settings;
mod splats;
mod sums;
#[cfg(test)]
mod tests;
mod tile;

use std::ops::Range;

use etendue_image::Image;

pub use exact_sum::ExactSum;
pub use settings::{AovSpace, FilmKind, FilmSettings, PixelBounds};
pub use splats::{SplatSums, Splats};
pub use sums::{FilmSums, MergeError, SampleFaults, SumsError};
pub use tile::{FilmTile, PixelSample, TileSamples};

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

    /// The weighted sum of features: of interpolated pixels.
    #[must_use]
    pub fn mean(features: &[Self], weights: &[f32]) -> Self {
        let mut values = [0.0; 15];
        for (features, weight) in features.iter().zip(weights) {
            for (sum, value) in values.iter_mut().zip(features.to_array()) {
                *sum += value * weight;
            }
        }
        let three = |i: usize| [values[i], values[i + 1], values[i + 2]];
        Self {
            albedo: three(0),
            position: three(3),
            normal: three(6),
            shading_normal: three(9),
            uv: [values[12], values[13]],
            depth: values[14],
        }
    }
}

/// The channels of a film beyond colour.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilmLayout {
    /// Names of the layers by path expression.
    pub layers: Vec<String>,
    /// Positions among the values of [`Features`] of those that are recorded.
    features: &'static [usize],
    n_buckets: usize,
    /// Sums that a denoiser needs, or none.
    n_guides: usize,
}

/// All positions of features.
const ALL_FEATURES: [usize; Features::CHANNELS.len()] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14];

impl FilmLayout {
    fn new(settings: &FilmSettings, layers: Vec<String>) -> Self {
        let few: &[usize] = if settings.guides { &guides::GUIDES } else { &[] };
        let (features, n_buckets): (&[usize], _) = match settings.kind {
            FilmKind::Rgb => (few, 0),
            FilmKind::GBuffer(_) => (&ALL_FEATURES, 0),
            FilmKind::Spectral { n_buckets, .. } => (few, n_buckets),
        };
        let n_guides = if settings.guides { guides::N_GUIDES } else { 0 };
        Self { layers, features, n_buckets, n_guides }
    }

    /// Places of the features that guide a denoiser among those that are recorded.
    fn guide_places(&self) -> impl Iterator<Item = usize> {
        let is_all = self.features.len() > guides::GUIDES.len();
        guides::GUIDES.into_iter().enumerate().map(move |(i, place)| if is_all { place } else { i })
    }

    /// Length of the record of a sample.
    fn record_len(&self) -> usize {
        tile::EXTRA + self.features.len() + self.n_buckets + N_COLOR * self.layers.len() + self.n_guides
    }

    /// Names of the values of a pixel, in their order.
    fn channel_names(&self, settings: &FilmSettings) -> Vec<String> {
        let mut names: Vec<String> = CANONICAL_NAMES.map(str::to_owned).to_vec();
        names.extend(self.features.iter().map(|place| Features::CHANNELS[*place].to_owned()));
        names.extend((0..self.n_buckets).map(|bucket| settings.bucket_name(bucket)));
        for layer in &self.layers {
            names.extend(["R", "G", "B"].map(|component| format!("{layer}.{component}")));
        }
        if self.n_guides > 0 {
            names.extend(guides::names(&guides::GUIDES.map(|place| Features::CHANNELS[place])));
        }
        names
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

    /// An empty tile for one thread, in the memory of an old one.
    #[must_use]
    pub fn start_tile(&self, bounds: PixelBounds, memory: TileSamples) -> FilmTile<'_> {
        FilmTile::new(&self.settings, &self.layout, bounds, memory)
    }

    /// Adds what tiles gathered, in parallel. The tiles are disjoint and in the order of [`tiles`](Self::tiles).
    pub fn add_tiles(&mut self, tiles: &[TileSamples]) {
        self.sums.add_tiles(tiles, &self.layout);
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
