//! The exact sums of a rectangle of pixels: added, split, stored and developed without knowing what made them.

use std::ops::Range;

use etendue_image::{Channel, Image};

use rayon::prelude::*;

use super::settings::PixelBounds;
use super::tile::{COLOR, EXTRA, TileSamples, WEIGHT};
use super::{CANONICAL_NAMES, ExactSum, FilmLayout, MOMENTS, N_COLOR, guides};

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
    pub(super) fn merge(&mut self, other: Self) {
        self.invalid += other.invalid;
        self.saturated += other.saturated;
        self.first_pixel = self.first_pixel.or(other.first_pixel);
    }
}

/// Why two films cannot be added.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MergeError {
    /// Different pixels or channels.
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

/// Why an image or a checkpoint does not hold the sums of a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SumsError;

impl std::fmt::Display for SumsError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "it does not hold the sums of this film")
    }
}

impl std::error::Error for SumsError {}

/// Weighted sums for each pixel of a rectangle, by channel.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmSums {
    pub(super) bounds: PixelBounds,
    names: Vec<String>,
    /// Luminance of the unit red, green and blue of the output.
    luminance: [f32; N_COLOR],
    pub(super) weights: Vec<ExactSum>,
    /// Row-major pixels, each with all its channels.
    pub(super) values: Vec<ExactSum>,
    passes: Vec<Range<u64>>,
    /// What went wrong so far.
    pub faults: SampleFaults,
}

/// Channels that hold exact sums in an image are named with this prefix.
const SUM_PREFIX: &str = "sums.";

/// 24 bits at a time, so many floats hold any sum of 127 bits.
const N_TERMS: usize = 6;

impl FilmSums {
    pub(super) fn new(bounds: PixelBounds, names: Vec<String>, luminance: [f32; N_COLOR]) -> Self {
        let n = bounds.n_pixels();
        let values = vec![ExactSum::ZERO; n * names.len()];
        let weights = vec![ExactSum::ZERO; n];
        Self {
            bounds,
            names,
            luminance,
            weights,
            values,
            passes: Vec::new(),
            faults: SampleFaults::default(),
        }
    }

    #[inline]
    pub(super) const fn stride(&self) -> usize {
        self.names.len()
    }

    /// Luminance of a colour of the output.
    #[cfg(test)]
    pub(super) fn luminance(&self, rgb: [f32; N_COLOR]) -> f64 {
        luminance(self.luminance, rgb)
    }

    /// The pixels.
    #[must_use]
    pub const fn bounds(&self) -> PixelBounds {
        self.bounds
    }

    /// Disjoint ascending ranges of the passes they hold.
    #[must_use]
    pub fn passes(&self) -> &[Range<u64>] {
        &self.passes
    }

    /// Number of passes they hold.
    #[must_use]
    pub fn n_passes(&self) -> u64 {
        self.passes.iter().map(|r| r.end - r.start).sum()
    }

    /// Number of passes in a range that they do not hold.
    #[must_use]
    pub fn n_missing(&self, range: &Range<u64>) -> u64 {
        let shared = |held: &Range<u64>| held.end.min(range.end).saturating_sub(held.start.max(range.start));
        let n_wanted = range.end.saturating_sub(range.start);
        n_wanted - self.passes.iter().map(shared).sum::<u64>()
    }

    /// Notes complete passes.
    pub fn note_passes(&mut self, range: Range<u64>) {
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

    /// Adds the samples of disjoint tiles, which come in rows from the top; one thread takes a row of tiles.
    pub(super) fn add_tiles(&mut self, tiles: &[TileSamples], layout: &FilmLayout) {
        let (width, stride, luminance) = (self.bounds.width() as usize, self.stride(), self.luminance);
        let (mut weights, mut values) = (self.weights.as_mut_slice(), self.values.as_mut_slice());
        let mut rows = Vec::new();
        let mut y = self.bounds.min[1];
        for tiles in tiles.chunk_by(|a, b| a.bounds.min[1] == b.bounds.min[1]) {
            let skipped = (tiles[0].bounds.min[1] - y) as usize * width;
            let n = tiles[0].bounds.height() as usize * width;
            let row_weights;
            let row_values;
            (row_weights, weights) = std::mem::take(&mut weights)[skipped..].split_at_mut(n);
            (row_values, values) = std::mem::take(&mut values)[skipped * stride..].split_at_mut(n * stride);
            y = tiles[0].bounds.max[1];
            rows.push(TileRow {
                left: self.bounds.min[0],
                width,
                stride,
                weights: row_weights,
                values: row_values,
                tiles,
            });
        }
        let saturated: u64 = rows.into_par_iter().map(|mut row| row.add(layout, luminance)).sum();
        self.faults.saturated += saturated;
        for tile in tiles {
            self.faults.merge(tile.faults);
        }
    }

    /// Adds the sums of other passes of the same scene and seed, exactly.
    ///
    /// # Errors
    /// If pixels or channels differ, or a pass is in both.
    pub fn merge(&mut self, other: &Self) -> Result<(), MergeError> {
        for a in &self.passes {
            for b in &other.passes {
                let shared = a.start.max(b.start)..a.end.min(b.end);
                if !shared.is_empty() {
                    return Err(MergeError::Overlap(shared));
                }
            }
        }
        self.add_pixels(other)?;
        for range in &other.passes {
            self.note_passes(range.clone());
        }
        Ok(())
    }

    /// Adds the sums of the same scene with another seed; passes are then counted, not named.
    ///
    /// # Errors
    /// If pixels or channels differ.
    pub fn merge_independent(&mut self, other: &Self) -> Result<(), MergeError> {
        self.add_pixels(other)?;
        let total = self.n_passes() + other.n_passes();
        self.passes = std::iter::once(0..total).collect();
        Ok(())
    }

    fn add_pixels(&mut self, other: &Self) -> Result<(), MergeError> {
        if self.names != other.names || self.bounds != other.bounds {
            return Err(MergeError::Layout);
        }
        self.faults.merge(other.faults);
        let sums = self.weights.iter_mut().chain(&mut self.values);
        for (sum, term) in sums.zip(other.weights.iter().chain(&other.values)) {
            *sum += *term;
        }
        Ok(())
    }

    /// The exact state, for checkpoints: weights, then values, 16 bytes each.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let sums = self.weights.iter().chain(&self.values);
        sums.flat_map(|sum| sum.to_bytes()).collect()
    }

    /// Brings back the state of [`to_bytes`](Self::to_bytes).
    ///
    /// # Errors
    /// If the size does not fit these pixels and channels.
    pub fn restore(&mut self, bytes: &[u8], passes: &[Range<u64>]) -> Result<(), SumsError> {
        let (sums, rest) = bytes.as_chunks::<16>();
        if !rest.is_empty() || sums.len() != self.weights.len() + self.values.len() {
            return Err(SumsError);
        }
        for (target, bytes) in self.weights.iter_mut().chain(&mut self.values).zip(sums) {
            *target = ExactSum::from_bytes(*bytes);
        }
        self.passes = passes.to_vec();
        Ok(())
    }

    /// Channels that hold the exact sums as exact sums of a few floats, so that an ordinary image file carries them:
    /// `sums.NAME.0` and so on, as many as are not all zero.
    #[must_use]
    pub fn exact_channels(&self) -> Vec<Channel> {
        let stride = self.stride();
        let mut channels = split_channel("weight", self.weights.iter().copied());
        for (index, name) in self.names.iter().enumerate() {
            let values = self.values.iter().skip(index).step_by(stride).copied();
            channels.extend(split_channel(name, values));
        }
        channels
    }

    /// The sums that an image holds in the channels of [`exact_channels`](Self::exact_channels).
    ///
    /// # Errors
    /// If there are none, or they do not fit the pixels.
    pub fn from_image(image: &Image, bounds: PixelBounds, luminance: [f32; 3]) -> Result<Self, SumsError> {
        let mut names: Vec<String> = Vec::new();
        for channel in &image.channels {
            let Some(name) = channel.name.strip_prefix(SUM_PREFIX).and_then(|n| n.rsplit_once('.')) else {
                continue;
            };
            if name.0 != "weight" && !names.iter().any(|known| known == name.0) {
                names.push(name.0.to_owned());
            }
        }
        // A file may order channels by name; the colour comes first here.
        names
            .sort_by_key(|name| CANONICAL_NAMES.iter().position(|first| first == name).unwrap_or(usize::MAX));
        if !names.iter().map(String::as_str).take(CANONICAL_NAMES.len()).eq(CANONICAL_NAMES)
            || bounds.n_pixels() != image.width * image.height
        {
            return Err(SumsError);
        }
        let mut sums = Self::new(bounds, names, luminance);
        join_channel(image, "weight", sums.weights.iter_mut());
        let stride = sums.stride();
        for (index, name) in sums.names.iter().enumerate() {
            join_channel(image, name, sums.values.iter_mut().skip(index).step_by(stride));
        }
        Ok(sums)
    }

    /// The image: the weighted mean of every channel, and `variance.Y`, the variance of the mean luminance as
    /// estimated from the samples (0 where there are fewer than two). Pixels without samples are black.
    ///
    /// The mean is a quotient, m = sum of w Y / sum of w, of variance n / (n - 1) sum of w² (Y - m)² / (sum of w)² (Cochran
    /// 1977, "Sampling Techniques", chapter 6). With equal weights that is the usual estimate, without bias; filters with
    /// negative lobes raise it. Where squares are too large for the sums, the number of such samples tells: see
    /// `variance_of_outliers`.
    #[must_use]
    pub fn develop(&self) -> Image {
        let mut image = Image::new(self.bounds.width() as usize, self.bounds.height() as usize);
        for (index, name) in self.names.iter().enumerate() {
            if !MOMENTS.contains(&index) && !guides::is_guide(name) {
                image.channels.push(self.mean_channel(name.clone(), index));
            }
        }
        image.channels.push(self.variance_channel());
        let n = self.n_passes() as f64;
        for (name, channel) in guides::channels(&self.names) {
            let pixels = self.weights.iter().zip(self.values.chunks_exact(self.stride()));
            let values = pixels.map(|(weight, sums)| channel.value(weight.value(), sums, n)).collect();
            image.channels.push(Channel { name, values });
        }
        image
    }

    fn mean_channel(&self, name: String, offset: usize) -> Channel {
        let stride = self.stride();
        let mean = |(index, weight): (usize, &ExactSum)| {
            let weight = weight.value();
            if weight == 0.0 { 0.0 } else { (self.values[index * stride + offset].value() / weight) as f32 }
        };
        Channel { name, values: self.weights.iter().enumerate().map(mean).collect() }
    }

    fn variance_channel(&self) -> Channel {
        let stride = self.stride();
        let n = self.n_passes() as f64;
        let variance = |(index, weight): (usize, &ExactSum)| {
            let weight = weight.value();
            if n < 2.0 || weight == 0.0 {
                return 0.0;
            }
            let values = &self.values[index * stride..(index + 1) * stride];
            let mean: f64 =
                (0..N_COLOR).map(|c| f64::from(self.luminance[c]) * values[c].value() / weight).sum();
            let n_saturated = values[MOMENTS][2].n_saturated();
            if n_saturated > 0 {
                return guides::variance_of_outliers(mean, n_saturated, n) as f32;
            }
            let [m0, m1, m2] = std::array::from_fn(|power| values[MOMENTS][power].value());
            let deviations = (m2 - 2.0 * mean * m1 + mean * mean * m0).max(0.0);
            (n / (n - 1.0) * deviations / (weight * weight)) as f32
        };
        Channel {
            name: "variance.Y".to_owned(),
            values: self.weights.iter().enumerate().map(variance).collect(),
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
        let color: [Channel; N_COLOR] = std::array::from_fn(|c| self.mean_channel(String::new(), c));
        let n = self.weights.len();
        let luminance: Vec<f64> =
            (0..n).map(|i| luminance(self.luminance, std::array::from_fn(|c| color[c].values[i]))).collect();
        let floor = 0.1 * luminance.iter().sum::<f64>() / n as f64;
        let variance = self.variance_channel().values;
        let terms = luminance.iter().zip(&variance).map(|(y, v)| {
            let scale = y.max(0.0) + floor;
            if scale > 0.0 { f64::from(*v) / (scale * scale) } else { 0.0 }
        });
        (terms.sum::<f64>() / n as f64).sqrt()
    }
}

/// Luminance of a colour, where `weights` are those of its unit components.
#[inline]
fn luminance(weights: [f32; N_COLOR], rgb: [f32; N_COLOR]) -> f64 {
    (0..N_COLOR).map(|c| f64::from(weights[c]) * f64::from(rgb[c])).sum()
}

/// The sums of some rows of pixels, and the tiles that lie in them.
struct TileRow<'s> {
    /// First column of the sums, and their number of columns.
    left: u32,
    width: usize,
    stride: usize,
    weights: &'s mut [ExactSum],
    values: &'s mut [ExactSum],
    tiles: &'s [TileSamples],
}

impl TileRow<'_> {
    /// Adds the samples; returns how many terms were too large.
    fn add(&mut self, layout: &FilmLayout, luminance: [f32; N_COLOR]) -> u64 {
        let mut saturated = 0;
        for tile in self.tiles {
            let (tile_width, x) = (tile.bounds.width() as usize, (tile.bounds.min[0] - self.left) as usize);
            for (record, place) in tile.values.chunks_exact(layout.record_len()).zip(&tile.pixels) {
                let place = *place as usize;
                let pixel = place / tile_width * self.width + x + place % tile_width;
                saturated += self.add_record(pixel, record, layout, luminance);
            }
        }
        saturated
    }

    #[inline]
    fn add_record(
        &mut self,
        pixel: usize,
        record: &[f32],
        layout: &FilmLayout,
        luminance_weights: [f32; N_COLOR],
    ) -> u64 {
        let weight = f64::from(record[WEIGHT]);
        self.weights[pixel] += ExactSum::of(weight);
        let values = &mut self.values[pixel * self.stride..(pixel + 1) * self.stride];
        let rgb = [record[COLOR], record[COLOR + 1], record[COLOR + 2]];
        let mut saturated = 0;
        for (sum, value) in values.iter_mut().zip(rgb) {
            let term = f64::from(value) * weight;
            saturated += u64::from(ExactSum::saturates(term));
            *sum += ExactSum::of(term);
        }
        let luminance = luminance(luminance_weights, rgb);
        let mut moment = weight * weight;
        for sum in &mut values[MOMENTS] {
            *sum += ExactSum::of_square(moment);
            moment *= luminance;
        }
        let squares = guides::squares(layout);
        for (index, (sum, value)) in values[MOMENTS.end..].iter_mut().zip(&record[EXTRA..]).enumerate() {
            let term = f64::from(*value) * weight;
            *sum += if squares.contains(&index) { ExactSum::of_square(term) } else { ExactSum::of(term) };
        }
        saturated
    }
}

fn split_channel(name: &str, sums: impl Iterator<Item = ExactSum>) -> Vec<Channel> {
    let mut terms: [Vec<f32>; N_TERMS] = Default::default();
    for sum in sums {
        for (channel, term) in terms.iter_mut().zip(sum.to_terms::<N_TERMS>()) {
            channel.push(term);
        }
    }
    let channels = terms
        .into_iter()
        .enumerate()
        .map(|(index, values)| Channel { name: format!("{SUM_PREFIX}{name}.{index}"), values });
    channels
        .filter(|channel| channel.name.ends_with(".0") || channel.values.iter().any(|v| *v != 0.0))
        .collect()
}

fn join_channel<'s>(image: &Image, name: &str, targets: impl Iterator<Item = &'s mut ExactSum>) {
    let is_part = |channel: &&Channel| {
        let sum = channel.name.strip_prefix(SUM_PREFIX).and_then(|rest| rest.rsplit_once('.'));
        sum.is_some_and(|(of, _)| of == name)
    };
    let parts: Vec<&Channel> = image.channels.iter().filter(is_part).collect();
    for (index, target) in targets.enumerate() {
        for part in &parts {
            *target += ExactSum::from_term(part.values[index]);
        }
    }
}
