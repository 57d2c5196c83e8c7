//! What one thread gathers of a part of the film: samples as they come. They enter the film's exact sums later, so
//! that a tile is small and a cancelled pass leaves no trace.

use etendue_spectrum::{Sampled, Wavelengths};

use super::{Features, FilmLayout, FilmSettings, N_COLOR, PixelBounds, SampleFaults, guides};

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

/// Position of the weight and of the colour in the record of a sample; features, spectral bands and layers follow.
pub(super) const WEIGHT: usize = 0;
pub(super) const COLOR: usize = 1;
pub(super) const EXTRA: usize = COLOR + N_COLOR;

/// The samples of a tile.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TileSamples {
    pub(super) bounds: PixelBounds,
    /// Position of each sample's pixel within the bounds.
    pub(super) pixels: Vec<u32>,
    /// A record of equal length for each sample.
    pub(super) values: Vec<f32>,
    pub(super) faults: SampleFaults,
}

/// A part of the film that one thread fills.
#[derive(Debug)]
pub struct FilmTile<'f> {
    settings: &'f FilmSettings,
    layout: &'f FilmLayout,
    samples: TileSamples,
    /// Whether the samples belong to the second half of all.
    is_second_half: bool,
}

impl<'f> FilmTile<'f> {
    pub(super) fn new(
        settings: &'f FilmSettings,
        layout: &'f FilmLayout,
        bounds: PixelBounds,
        memory: TileSamples,
    ) -> Self {
        let TileSamples { mut pixels, mut values, .. } = memory;
        pixels.clear();
        values.clear();
        Self {
            settings,
            layout,
            samples: TileSamples { bounds, pixels, values, faults: SampleFaults::default() },
            is_second_half: false,
        }
    }

    /// Tells that the samples are those of a pass, which decides the half of the film that they belong to.
    #[must_use]
    pub fn of_pass(self, pass: u64) -> Self {
        Self { is_second_half: guides::is_in_second_half(pass), ..self }
    }

    /// The pixels of this tile.
    #[must_use]
    pub const fn bounds(&self) -> PixelBounds {
        self.samples.bounds
    }

    /// True if samples should come with [`Features`].
    #[must_use]
    pub const fn wants_features(&self) -> bool {
        !self.layout.features.is_empty()
    }

    /// Adds one sample. NaN, infinite or negative radiance is counted and taken as black; debug builds panic.
    pub fn add(&mut self, pixel: [u32; 2], sample: &PixelSample<'_>) {
        let samples = &mut self.samples;
        let mut radiance = sample.radiance;
        if !radiance.is_finite() || radiance.min_value() < 0.0 {
            debug_assert!(false, "radiance {radiance:?} at pixel {pixel:?}");
            samples.faults.invalid += 1;
            samples.faults.first_pixel.get_or_insert(pixel);
            radiance = Sampled::ZERO;
        }
        samples.pixels.push(samples.bounds.index(pixel) as u32);
        let [r, g, b] = self.settings.output_rgb(radiance, sample.lambda);
        samples.values.extend_from_slice(&[sample.filter_weight, r, g, b]);
        if self.layout.record_len() > EXTRA {
            self.add_extra(radiance, sample);
        }
    }

    /// Completes the record of a sample by what the film holds beyond colour.
    fn add_extra(&mut self, radiance: Sampled, sample: &PixelSample<'_>) {
        let samples = &mut self.samples;
        let end = samples.values.len() - EXTRA + self.layout.record_len();
        let start = samples.values.len() - EXTRA;
        if !self.layout.features.is_empty() {
            let features = sample.features.unwrap_or_default().to_array();
            samples.values.extend(self.layout.features.iter().map(|place| features[*place]));
        }
        let first_bucket = samples.values.len();
        samples.values.resize(first_bucket + self.layout.n_buckets, 0.0);
        self.settings.add_to_buckets(radiance, sample.lambda, &mut samples.values[first_bucket..]);
        for layer in sample.layers {
            samples.values.extend(self.settings.output_rgb(*layer, sample.lambda));
        }
        samples.values.resize(end, 0.0);
        if self.layout.n_guides > 0 {
            let (record, guides) = samples.values[start..].split_at_mut(end - start - self.layout.n_guides);
            guides::set_half(guides, self.is_second_half);
            guides::fill(guides, record, self.layout);
        }
    }

    /// What was gathered, apart from the film, which may then change.
    #[must_use]
    pub fn finish(self) -> TileSamples {
        self.samples
    }
}
