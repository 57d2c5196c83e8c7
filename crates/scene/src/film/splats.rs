//! Light that paths from the lights bring to the film, wherever it arrives there (SPEC BDPT-7).
//!
//! A path from the lights reaches the film at a place p of its own, and belongs to every pixel whose filter reaches there:
//! the pixel at x gains `f(p - x) / integral f` of it. Filters cost no noise here, negative lobes no sign of the light.
//!
//! Of a filter that reaches hundreds of pixels one is drawn for each splat, as if the filter were blurred by a pixel, which does not
//! show at that width.
//!
//! Tasks gather [`Splats`] as they come; [`SplatSums`] adds those of a pass up, for each pixel in the order of the paths, so
//! that the number of threads changes no bit. What a pixel got in a pass then joins the pixel's one sample of that pass: variance,
//! merging and checkpoints know no difference.

use etendue_math::{Point2, Vector2, hash64};
use etendue_spectrum::{Sampled, Wavelengths};
use rayon::prelude::*;

use super::tile::{COLOR, WEIGHT};
use super::{Film, FilmLayout, FilmSettings, N_COLOR, PixelBounds, SampleFaults, TileSamples, guides};
use crate::filter::Filter;

/// Strips of rows that are added up in parallel.
const N_BANDS: u32 = 16;

/// Filters that reach more pixels are sampled.
const MANY_PIXELS: f32 = 400.0;

/// What a task brings to the film.
#[derive(Debug)]
pub struct Splats<'f> {
    settings: &'f FilmSettings,
    layout: &'f FilmLayout,
    /// Raster positions, in pixels.
    places: Vec<Point2>,
    /// A record of equal length for each: colour, spectral bands, layers.
    values: Vec<f32>,
    faults: SampleFaults,
}

impl<'f> Splats<'f> {
    /// None, for this film.
    #[must_use]
    pub const fn new(film: &'f Film) -> Self {
        Self {
            settings: &film.settings,
            layout: &film.layout,
            places: Vec::new(),
            values: Vec::new(),
            faults: SampleFaults { invalid: 0, first_pixel: None, saturated: 0 },
        }
    }

    /// Adds light at a raster position: its part in the mean over the pixels there, in radiance, and that of each layer. NaN,
    /// infinite or negative light is counted and left out; debug builds panic.
    pub fn add(&mut self, p_film: Point2, radiance: Sampled, lambda: &Wavelengths, layers: &[Sampled]) {
        if !radiance.is_finite() || radiance.min_value() < 0.0 {
            debug_assert!(false, "radiance {radiance:?} at {p_film:?}");
            self.faults.invalid += 1;
            self.faults.first_pixel.get_or_insert([p_film.x.max(0.0) as u32, p_film.y.max(0.0) as u32]);
            return;
        }
        self.places.push(p_film);
        self.values.extend(self.settings.sensor.sensor_rgb(radiance, lambda));
        let first_bucket = self.values.len();
        self.values.resize(first_bucket + self.layout.n_buckets, 0.0);
        self.settings.add_to_buckets(radiance, lambda, &mut self.values[first_bucket..]);
        for layer in &layers[..self.layout.layers.len()] {
            self.values.extend(self.settings.sensor.sensor_rgb(*layer, lambda));
        }
    }

    /// For each strip of `rows` rows the splats that reach it, in their order.
    fn by_band(&self, bounds: PixelBounds, rows: u32, filter: &Filter, is_wide: bool) -> Vec<Vec<u32>> {
        let mut by_band = vec![Vec::new(); bounds.height().div_ceil(rows) as usize];
        let ([_, top], [_, bottom]) = (bounds.min, bounds.max);
        for (index, p) in self.places.iter().enumerate() {
            let (y, radius) = if is_wide { (drawn(*p, filter).0.y, 0.5) } else { (p.y, filter.radius().y) };
            let reached = reached(y, radius, top, bottom);
            if !reached.is_empty() {
                let bands = (reached.start - top) / rows..=(reached.end - 1 - top) / rows;
                bands.for_each(|band| by_band[band as usize].push(index as u32));
            }
        }
        by_band
    }

    /// Numbers that each of them takes in memory.
    #[must_use]
    pub fn numbers_each(&self) -> usize {
        2 + splat_len(self.layout)
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// True if there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }
}

/// What the paths of a pass bring to each pixel.
#[derive(Clone, Debug, Default)]
pub struct SplatSums {
    bounds: PixelBounds,
    /// Numbers of a pixel.
    stride: usize,
    /// Of all pixels, row by row.
    sums: Vec<f64>,
    faults: SampleFaults,
}

impl SplatSums {
    /// Starts a pass, in the memory of the last.
    pub fn restart(&mut self, film: &Film) {
        self.bounds = film.settings.crop;
        self.stride = splat_len(&film.layout);
        self.sums.clear();
        self.sums.resize(self.bounds.n_pixels() * self.stride, 0.0);
        self.faults = SampleFaults::default();
    }

    /// Adds what tasks brought, in this order.
    pub fn add(&mut self, tasks: &[Splats<'_>], filter: &Filter) {
        let (bounds, stride) = (self.bounds, self.stride);
        let rows = bounds.height().div_ceil(N_BANDS).max(1);
        let band_len = rows as usize * bounds.width() as usize * stride;
        if band_len == 0 {
            return;
        }
        let is_wide = 4.0 * filter.radius().x * filter.radius().y > MANY_PIXELS;
        let by_band: Vec<Vec<Vec<u32>>> =
            tasks.par_iter().map(|task| task.by_band(bounds, rows, filter, is_wide)).collect();
        self.sums.par_chunks_mut(band_len).enumerate().for_each(|(band, sums)| {
            let top = bounds.min[1] + band as u32 * rows;
            let bottom = bounds.max[1].min(top + rows);
            let bounds = PixelBounds { min: [bounds.min[0], top], max: [bounds.max[0], bottom] };
            let mut strip = Band { bounds, stride, sums, filter, across: Vec::new() };
            for (task, by_band) in tasks.iter().zip(&by_band) {
                for index in &by_band[band] {
                    let (p, first) = (task.places[*index as usize], *index as usize * stride);
                    let record = &task.values[first..first + stride];
                    if is_wide { strip.add_by_chance(p, record) } else { strip.add(p, record) }
                }
            }
        });
        for task in tasks {
            self.faults.merge(task.faults);
        }
    }

    /// Joins the sums, times `scale`, with the samples of a pass, of which every pixel has one. From then on all samples have
    /// the weight 1: what paths from the lights bring knows no weights.
    pub fn join(&self, tiles: &mut [TileSamples], film: &Film, scale: f64) {
        let (layout, settings) = (&film.layout, &film.settings);
        let record_len = layout.record_len();
        tiles.par_iter_mut().for_each(|tile| {
            let tile_width = tile.bounds.width();
            for (record, place) in tile.values.chunks_exact_mut(record_len).zip(&tile.pixels) {
                let pixel =
                    [tile.bounds.min[0] + place % tile_width, tile.bounds.min[1] + place / tile_width];
                let first = self.bounds.index(pixel) * self.stride;
                join_record(record, &self.sums[first..first + self.stride], scale, layout, settings);
            }
        });
        if let Some(tile) = tiles.first_mut() {
            tile.faults.merge(self.faults);
        }
    }
}

/// Length of the record of a splat.
fn splat_len(layout: &FilmLayout) -> usize {
    N_COLOR + layout.n_buckets + N_COLOR * layout.layers.len()
}

fn join_record(record: &mut [f32], sums: &[f64], scale: f64, layout: &FilmLayout, settings: &FilmSettings) {
    let (record, guides) = record.split_at_mut(record.len() - layout.n_guides);
    let weight = std::mem::replace(&mut record[WEIGHT], 1.0);
    if weight != 1.0 {
        record[COLOR..].iter_mut().for_each(|value| *value *= weight);
    }
    let (color, extra) = record[COLOR..].split_at_mut(N_COLOR);
    let targets = color.iter_mut().chain(&mut extra[layout.features.len()..]);
    for (target, sum) in targets.zip(sums) {
        *target += (sum * scale) as f32;
    }
    color.copy_from_slice(&settings.limited([color[0], color[1], color[2]]));
    for layer in extra[layout.features.len() + layout.n_buckets..].chunks_exact_mut(N_COLOR) {
        layer.copy_from_slice(&settings.limited([layer[0], layer[1], layer[2]]));
    }
    if layout.n_guides > 0 {
        guides::fill(guides, record, layout);
    }
}

/// Some rows of the film.
struct Band<'s> {
    bounds: PixelBounds,
    stride: usize,
    sums: &'s mut [f64],
    filter: &'s Filter,
    /// Weights of the columns that a splat reaches.
    across: Vec<f64>,
}

impl Band<'_> {
    #[inline]
    fn add(&mut self, p: Point2, record: &[f32]) {
        let (bounds, radius) = (self.bounds, self.filter.radius());
        let rows = reached(p.y, radius.y, bounds.min[1], bounds.max[1]);
        if rows.is_empty() {
            return;
        }
        let columns = reached(p.x, radius.x, bounds.min[0], bounds.max[0]);
        let offset = |p: f32, pixel: u32| f64::from(p) - (f64::from(pixel) + 0.5);
        self.across.clear();
        self.across.extend(columns.clone().map(|x| self.filter.weight_across(offset(p.x, x))));
        for y in rows {
            let weight_down = self.filter.weight_down(offset(p.y, y));
            let row = (y - bounds.min[1]) as usize * bounds.width() as usize;
            for (x, weight_across) in columns.clone().zip(&self.across) {
                let first = (row + (x - bounds.min[0]) as usize) * self.stride;
                add_weighted(&mut self.sums[first..first + self.stride], record, weight_across * weight_down);
            }
        }
    }

    /// Adds all to one pixel, chosen by the filter.
    fn add_by_chance(&mut self, p: Point2, record: &[f32]) {
        let (Vector2 { x, y }, weight) = drawn(p, self.filter);
        let PixelBounds { min, max } = self.bounds;
        let is_within = |p: f32, axis: usize| p >= min[axis] as f32 && p < max[axis] as f32;
        if is_within(x, 0) && is_within(y, 1) {
            let first = self.bounds.index([x as u32, y as u32]) * self.stride;
            add_weighted(&mut self.sums[first..first + self.stride], record, f64::from(weight));
        }
    }
}

/// A place near `p` drawn by the filter, and its weight. The choice depends on `p` alone, so that all bands agree on it.
fn drawn(p: Point2, filter: &Filter) -> (Vector2, f32) {
    let bits = hash64(&[u64::from(p.x.to_bits()) << 32 | u64::from(p.y.to_bits())]);
    let unit = |bits: u64| (bits & 0xff_ffff) as f32 / (1_u32 << 24) as f32;
    let chosen = filter.sample(Point2::new(unit(bits), unit(bits >> 32)));
    (Vector2::new(p.x - chosen.offset.x, p.y - chosen.offset.y), chosen.weight)
}

#[inline]
fn add_weighted(sums: &mut [f64], record: &[f32], weight: f64) {
    for (sum, value) in sums.iter_mut().zip(record) {
        *sum += weight * f64::from(*value);
    }
}

/// The pixels from `min` to `max` whose centre is within `radius` of `p` along an axis; of two that are just that far away, one.
fn reached(p: f32, radius: f32, min: u32, max: u32) -> std::ops::Range<u32> {
    let (p, radius) = (f64::from(p) - 0.5, f64::from(radius));
    // The floor of `x` plus 1: below 0 the conversion gives 0. To ask for the floor itself calls a function on many machines.
    let bound = |x: f64| ((x + 1.0) as u32).clamp(min, max);
    bound(p - radius)..bound(p + radius)
}

#[cfg(test)]
mod tests;
