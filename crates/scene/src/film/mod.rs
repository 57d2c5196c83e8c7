//! The film: what arrives at each pixel, summed exactly, and its development into an image.
//!
//! Every pixel sample carries the weight of the pixel filter at its offset; a pixel's value is the weighted mean of
//! its samples. Filters are importance-sampled (Ernst, Stamminger and Greiner 2006, "Filter Importance Sampling"), so
//! that a sample belongs to one pixel, and sums are exact, so that neither threads nor a split of passes can change a
//! bit of the result.

mod exact_sum;
mod settings;
#[cfg(test)]
mod tests;

use std::ops::Range;

use etendue_image::{Channel, Image};
use etendue_spectrum::{Sampled, Wavelengths};

pub use exact_sum::ExactSum;
pub use settings::{AovSpace, FilmKind, FilmSettings, PixelBounds};

/// Position of the colour and of its squared luminance among the values of a pixel; extra channels follow.
const N_COLOR: usize = 3;
const SQUARE: usize = N_COLOR;
const FIRST_EXTRA: usize = SQUARE + 1;

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
        "Albedo.R", "Albedo.G", "Albedo.B", "P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "Ns.X", "Ns.Y", "Ns.Z", "u",
        "v", "depth.Z",
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

    fn stride(&self) -> usize {
        FIRST_EXTRA + self.n_features + self.n_buckets + N_COLOR * self.layers.len()
    }
}

/// What went wrong while samples were added.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SampleFaults {
    /// Samples with NaN, infinite or negative radiance; they count as black.
    pub invalid: u64,
    /// Pixel of the first of them, if any.
    pub first_pixel: Option<[u32; 2]>,
    /// Samples whose value exceeded what a sum can hold.
    pub saturated: u64,
}

impl SampleFaults {
    fn merge(&mut self, other: Self) {
        self.invalid += other.invalid;
        self.saturated += other.saturated;
        self.first_pixel = self.first_pixel.or(other.first_pixel);
    }
}

/// Sums of a rectangle of pixels.
#[derive(Clone, Debug)]
struct Pixels {
    bounds: PixelBounds,
    stride: usize,
    weights: Vec<ExactSum>,
    values: Vec<ExactSum>,
}

impl Pixels {
    fn new(bounds: PixelBounds, stride: usize) -> Self {
        let n = bounds.n_pixels();
        Self { bounds, stride, weights: vec![ExactSum::ZERO; n], values: vec![ExactSum::ZERO; n * stride] }
    }
}

/// A part of the film that one thread fills.
#[derive(Debug)]
pub struct FilmTile<'f> {
    settings: &'f FilmSettings,
    layout: &'f FilmLayout,
    pixels: Pixels,
    faults: SampleFaults,
}

impl FilmTile<'_> {
    /// The pixels of this tile.
    #[must_use]
    pub const fn bounds(&self) -> PixelBounds {
        self.pixels.bounds
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
            self.faults.invalid += 1;
            self.faults.first_pixel.get_or_insert(pixel);
            radiance = Sampled::ZERO;
        }
        let index = self.pixels.bounds.index(pixel);
        let weight = f64::from(sample.filter_weight);
        self.pixels.weights[index] += ExactSum::of(weight);

        let rgb = self.settings.output_rgb(radiance, sample.lambda);
        let luminance = self.settings.luminance(rgb);
        let stride = self.pixels.stride;
        let values = &mut self.pixels.values[index * stride..(index + 1) * stride];
        for (sum, value) in values.iter_mut().zip(rgb) {
            let term = f64::from(value) * weight;
            self.faults.saturated += u64::from(ExactSum::saturates(term));
            *sum += ExactSum::of(term);
        }
        values[SQUARE] += ExactSum::of(luminance * luminance * weight);

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

/// Why two films cannot be added.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MergeError {
    /// Different resolution, crop or channels.
    Layout,
    /// Both hold these passes.
    Overlap(Range<u64>),
}

impl std::fmt::Display for MergeError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Layout => write!(f, "the films differ in resolution, crop or channels"),
            Self::Overlap(range) => write!(f, "both films hold the passes {}..{}", range.start, range.end),
        }
    }
}

impl std::error::Error for MergeError {}

/// The sums of all pixels, and which passes they hold.
#[derive(Clone, Debug)]
pub struct Film {
    settings: FilmSettings,
    layout: FilmLayout,
    pixels: Pixels,
    passes: Vec<Range<u64>>,
    /// What went wrong so far.
    pub faults: SampleFaults,
}

impl Film {
    /// A film without samples.
    #[must_use]
    pub fn new(settings: FilmSettings, layers: Vec<String>) -> Self {
        let layout = FilmLayout::new(&settings, layers);
        let pixels = Pixels::new(settings.crop, layout.stride());
        Self { settings, layout, pixels, passes: Vec::new(), faults: SampleFaults::default() }
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

    /// Disjoint ascending ranges of the passes it holds.
    #[must_use]
    pub fn passes(&self) -> &[Range<u64>] {
        &self.passes
    }

    /// Number of passes it holds.
    #[must_use]
    pub fn n_passes(&self) -> u64 {
        self.passes.iter().map(|r| r.end - r.start).sum()
    }

    /// True if that pass is in the sums.
    #[must_use]
    pub fn holds_pass(&self, pass: u64) -> bool {
        self.passes.iter().any(|r| r.contains(&pass))
    }

    /// Square tiles that cover the film, in rows.
    #[must_use]
    pub fn tiles(&self, size: u32) -> Vec<PixelBounds> {
        self.settings.crop.tiles(size)
    }

    /// An empty tile for one thread.
    #[must_use]
    pub fn start_tile(&self, bounds: PixelBounds) -> FilmTile<'_> {
        FilmTile {
            settings: &self.settings,
            layout: &self.layout,
            pixels: Pixels::new(bounds, self.layout.stride()),
            faults: SampleFaults::default(),
        }
    }

    /// Takes the sums out of tiles, so that the film can change; [`add_sums`](Self::add_sums) brings them in.
    #[must_use]
    pub fn finish_tile(tile: FilmTile<'_>) -> TileSums {
        TileSums { pixels: tile.pixels, faults: tile.faults }
    }

    /// Adds what a tile gathered.
    pub fn add_sums(&mut self, tile: &TileSums) {
        self.faults.merge(tile.faults);
        let stride = self.pixels.stride;
        for (source, pixel) in tile.pixels.bounds.pixels().enumerate() {
            let target = self.pixels.bounds.index(pixel);
            self.pixels.weights[target] += tile.pixels.weights[source];
            let from = &tile.pixels.values[source * stride..(source + 1) * stride];
            let to = &mut self.pixels.values[target * stride..(target + 1) * stride];
            for (sum, term) in to.iter_mut().zip(from) {
                *sum += *term;
            }
        }
    }

    /// Notes that a pass is complete.
    pub fn note_pass(&mut self, pass: u64) {
        self.note_passes(pass..pass + 1);
    }

    fn note_passes(&mut self, range: Range<u64>) {
        self.passes.push(range);
        self.passes.sort_by_key(|r| r.start);
        let mut joined: Vec<Range<u64>> = Vec::with_capacity(self.passes.len());
        for range in self.passes.drain(..) {
            match joined.last_mut() {
                Some(last) if last.end == range.start => last.end = range.end,
                _ => joined.push(range),
            }
        }
        self.passes = joined;
    }

    /// Adds another film of the same scene and seed, exactly.
    ///
    /// # Errors
    /// If the films differ in shape or share a pass.
    pub fn merge(&mut self, other: &Self) -> Result<(), MergeError> {
        self.check_layout(other)?;
        for a in &self.passes {
            for b in &other.passes {
                let shared = a.start.max(b.start)..a.end.min(b.end);
                if !shared.is_empty() {
                    return Err(MergeError::Overlap(shared));
                }
            }
        }
        self.add_pixels(other);
        for range in &other.passes {
            self.note_passes(range.clone());
        }
        Ok(())
    }

    /// Adds a film of the same scene with another seed; the passes of the sum are counted, not named.
    ///
    /// # Errors
    /// If the films differ in shape.
    pub fn merge_independent(&mut self, other: &Self) -> Result<(), MergeError> {
        self.check_layout(other)?;
        self.add_pixels(other);
        let total = self.n_passes() + other.n_passes();
        self.passes = std::iter::once(0..total).collect();
        Ok(())
    }

    fn check_layout(&self, other: &Self) -> Result<(), MergeError> {
        if self.layout != other.layout
            || self.pixels.bounds != other.pixels.bounds
            || self.settings.resolution != other.settings.resolution
        {
            return Err(MergeError::Layout);
        }
        Ok(())
    }

    fn add_pixels(&mut self, other: &Self) {
        self.faults.merge(other.faults);
        for (sum, term) in self.pixels.weights.iter_mut().zip(&other.pixels.weights) {
            *sum += *term;
        }
        for (sum, term) in self.pixels.values.iter_mut().zip(&other.pixels.values) {
            *sum += *term;
        }
    }

    /// Relative standard error of the image: the root mean square over pixels of the standard error of luminance,
    /// divided by the luminance plus a tenth of its mean, so that black pixels do not count without bound.
    /// Infinite for fewer than two passes.
    #[must_use]
    pub fn relative_error(&self) -> f64 {
        if self.n_passes() < 2 {
            return f64::INFINITY;
        }
        let image = self.develop();
        let Some(rgb) = image.rgb_pixels() else { return f64::INFINITY };
        let luminance: Vec<f64> = rgb.iter().map(|c| self.settings.luminance(*c)).collect();
        let n = luminance.len() as f64;
        let floor = 0.1 * luminance.iter().sum::<f64>() / n;
        let variance = self.variance_channel().values;
        let terms = luminance.iter().zip(&variance).map(|(y, v)| {
            let scale = y.max(0.0) + floor;
            if scale > 0.0 { f64::from(*v) / (scale * scale) } else { 0.0 }
        });
        (terms.sum::<f64>() / n).sqrt()
    }

    /// The exact sums, for checkpoints: weights, then values, 16 bytes each.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let sums = self.pixels.weights.iter().chain(&self.pixels.values);
        sums.flat_map(|sum| sum.to_bytes()).collect()
    }

    /// Brings back the sums of [`to_bytes`](Self::to_bytes); `false` if the size does not fit this film.
    #[must_use]
    pub fn restore(&mut self, bytes: &[u8], passes: &[Range<u64>]) -> bool {
        let n_weights = self.pixels.weights.len();
        let (sums, rest) = bytes.as_chunks::<16>();
        if !rest.is_empty() || sums.len() != n_weights + self.pixels.values.len() {
            return false;
        }
        let targets = self.pixels.weights.iter_mut().chain(&mut self.pixels.values);
        for (target, bytes) in targets.zip(sums) {
            *target = ExactSum::from_bytes(*bytes);
        }
        self.passes = passes.to_vec();
        true
    }

    /// The image: channels `R G B`, features, spectral buckets, layers `name.R` and so on, and `variance.Y`, the
    /// variance of the mean luminance as estimated from the samples (0 where there are fewer than two).
    ///
    /// Pixels without samples are black.
    #[must_use]
    pub fn develop(&self) -> Image {
        let bounds = self.pixels.bounds;
        let mut image = Image::new(bounds.width() as usize, bounds.height() as usize);
        let extra = FIRST_EXTRA + self.layout.n_features + self.layout.n_buckets;
        for (index, name) in ["R", "G", "B"].iter().enumerate() {
            image.channels.push(self.mean_channel((*name).to_owned(), index));
        }
        for (index, name) in Features::CHANNELS.iter().take(self.layout.n_features).enumerate() {
            image.channels.push(self.mean_channel((*name).to_owned(), FIRST_EXTRA + index));
        }
        for bucket in 0..self.layout.n_buckets {
            let name = self.settings.bucket_name(bucket);
            image.channels.push(self.mean_channel(name, FIRST_EXTRA + self.layout.n_features + bucket));
        }
        for (layer, name) in self.layout.layers.iter().enumerate() {
            for (component, suffix) in ["R", "G", "B"].iter().enumerate() {
                let channel = format!("{name}.{suffix}");
                image.channels.push(self.mean_channel(channel, extra + layer * N_COLOR + component));
            }
        }
        image.channels.push(self.variance_channel());
        image
    }

    fn mean_channel(&self, name: String, offset: usize) -> Channel {
        let stride = self.pixels.stride;
        let mean = |(index, weight): (usize, &ExactSum)| {
            let weight = weight.value();
            if weight == 0.0 { 0.0 } else { (self.pixels.values[index * stride + offset].value() / weight) as f32 }
        };
        Channel { name, values: self.pixels.weights.iter().enumerate().map(mean).collect() }
    }

    fn variance_channel(&self) -> Channel {
        let stride = self.pixels.stride;
        let n = self.n_passes() as f64;
        let variance = |(index, weight): (usize, &ExactSum)| {
            let weight = weight.value();
            if n < 2.0 || weight == 0.0 {
                return 0.0;
            }
            let values = &self.pixels.values[index * stride..];
            let mean = std::array::from_fn(|c| (values[c].value() / weight) as f32);
            let mean = self.settings.luminance(mean);
            let mean_square = values[SQUARE].value() / weight;
            ((mean_square - mean * mean).max(0.0) / (n - 1.0)) as f32
        };
        Channel {
            name: "variance.Y".to_owned(),
            values: self.pixels.weights.iter().enumerate().map(variance).collect(),
        }
    }
}

/// The sums of a finished tile.
#[derive(Debug)]
pub struct TileSums {
    pixels: Pixels,
    faults: SampleFaults,
}
