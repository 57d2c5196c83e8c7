//! What a denoiser finds in a picture, made fit for arithmetic.

use crate::Image;
use crate::plane::Plane;

use super::DenoiseError;

/// Layers of the features with their components.
pub(super) const FEATURES: [(&str, &[&str]); 3] =
    [("Albedo", &["R", "G", "B"]), ("Ns", &["X", "Y", "Z"]), ("depth", &["Z"])];

/// Side of the square over which the variances of samples are held against those of halves.
const CALIBRATION_SIGMA: f32 = 8.0;

/// A feature of several components.
#[derive(Debug)]
pub(super) struct Feature {
    pub(super) values: Vec<Plane>,
    /// Variances of the values; none if unknown.
    pub(super) variances: Option<Vec<Plane>>,
}

/// What is known of a picture.
#[derive(Debug)]
pub(super) struct Input {
    pub(super) size: [usize; 2],
    /// Two halves of the samples, or the picture twice.
    pub(super) halves: [[Plane; 3]; 2],
    /// Whether the halves are two.
    pub(super) is_dual: bool,
    /// Variance of a half.
    pub(super) variance: [Plane; 3],
    /// 1 where the colour is finite, else 0.
    pub(super) valid: Plane,
    /// Features that were found, each with its place in [`FEATURES`].
    pub(super) features: Vec<(usize, Feature)>,
}

impl Input {
    /// Finds the channels by their names.
    ///
    /// # Errors
    /// Without colour, variance or pixels.
    pub(super) fn of(image: &Image) -> Result<Self, DenoiseError> {
        if image.n_pixels() == 0 {
            return Err(DenoiseError::Empty);
        }
        let mut color = rgb(image, "").ok_or(DenoiseError::NoColor)?;
        let dual = rgb(image, "halfA").zip(rgb(image, "halfB")).filter(|(a, b)| !is_black(a) && !is_black(b));
        let is_dual = dual.is_some();
        let mut halves = dual.map_or_else(|| [color.clone(), color.clone()], |(a, b)| [a, b]);
        let valid = repair(&mut color, &mut halves);
        let variance = variance(image, &halves, is_dual).ok_or(DenoiseError::NoVariance)?;
        let features = FEATURES
            .iter()
            .enumerate()
            .filter_map(|(i, (layer, components))| Some((i, feature(image, layer, components)?)));
        let features = features.collect();
        Ok(Self { size: [image.width, image.height], halves, is_dual, variance, valid, features })
    }

    /// Pixels of a half with their validity.
    pub(super) fn colors(&self, half: usize) -> Vec<[f32; 4]> {
        let [r, g, b] = &self.halves[half];
        let pixel = |i: usize| [r.values[i], g.values[i], b.values[i], self.valid.values[i]];
        (0..self.size[0] * self.size[1]).map(pixel).collect()
    }
}

/// After a single sample one half is empty.
fn is_black(planes: &[Plane; 3]) -> bool {
    planes.iter().all(|plane| plane.values.iter().all(|v| *v == 0.0))
}

fn plane(image: &Image, name: &str) -> Option<Plane> {
    Some(Plane::new(image.width, image.height, image.channel(name)?.values.clone()))
}

fn rgb(image: &Image, layer: &str) -> Option<[Plane; 3]> {
    let pixels = image.layer_rgb(layer)?;
    Some(
        [0, 1, 2]
            .map(|c| Plane::new(image.width, image.height, pixels.iter().map(|pixel| pixel[c]).collect())),
    )
}

/// Gives pixels that are not finite the mean of their neighbours; returns 0 for them and 1 for all others.
fn repair(color: &mut [Plane; 3], halves: &mut [[Plane; 3]; 2]) -> Plane {
    let (width, height) = (color[0].width, color[0].height);
    let planes = || color.iter().chain(halves.iter().flatten());
    let is_valid = |i: usize| planes().all(|plane| plane.values[i].is_finite());
    let valid: Vec<f32> = (0..width * height).map(|i| f32::from(u8::from(is_valid(i)))).collect();
    for plane in color.iter_mut().chain(halves.iter_mut().flatten()) {
        let repaired: Vec<(usize, f32)> = (0..width * height)
            .filter(|i| valid[*i] == 0.0)
            .map(|i| (i, neighbours_mean(plane, &valid, i)))
            .collect();
        repaired.into_iter().for_each(|(i, value)| plane.values[i] = value);
    }
    Plane::new(width, height, valid)
}

/// The mean of the valid pixels of the 5 x 5 around one; 0 without any.
fn neighbours_mean(plane: &Plane, valid: &[f32], i: usize) -> f32 {
    let (x, y) = (i % plane.width, i / plane.width);
    let (mut sum, mut n) = (0.0_f32, 0.0_f32);
    for y in y.saturating_sub(2)..(y + 3).min(plane.height) {
        let near = y * plane.width + x.saturating_sub(2)..y * plane.width + (x + 3).min(plane.width);
        for (value, is_valid) in plane.values[near.clone()].iter().zip(&valid[near]) {
            if *is_valid > 0.0 {
                sum += value;
                n += 1.0;
            }
        }
    }
    if n > 0.0 { sum / n } else { 0.0 }
}

/// Variance of a half (of the picture where there are none): that of the samples, which is precise but does not know of
/// patterns that are more even than chance, scaled by what the halves say of a neighbourhood (Rousselle, Knaus and Zwicker 2012,
/// section 5).
fn variance(image: &Image, halves: &[[Plane; 3]; 2], is_dual: bool) -> Option<[Plane; 3]> {
    let all = plane(image, "variance.Y");
    let of_samples = |c: usize| {
        plane(image, ["variance.R", "variance.G", "variance.B"][c]).or_else(|| all.clone()).map(sanitized)
    };
    let of_halves = |c: usize| {
        let [a, b] = [&halves[0][c], &halves[1][c]];
        let quarter = |(a, b): (&f32, &f32)| 0.25 * (a - b) * (a - b);
        sanitized(Plane::new(a.width, a.height, a.values.iter().zip(&b.values).map(quarter).collect()))
    };
    let variance = |c: usize| match (of_samples(c), is_dual) {
        (Some(samples), false) => Some(samples),
        (None, false) => None,
        (None, true) => Some(of_halves(c).blurred(1.5).map(|v| 2.0 * v)),
        (Some(mut samples), true) => {
            let (dual, own) = (of_halves(c).blurred(CALIBRATION_SIGMA), samples.blurred(CALIBRATION_SIGMA));
            for (value, (dual, own)) in samples.values.iter_mut().zip(dual.values.iter().zip(&own.values)) {
                *value *= 2.0 * if *own > 0.0 { dual / own } else { 1.0 };
            }
            Some(samples)
        }
    };
    Some([variance(0)?, variance(1)?, variance(2)?])
}

/// Variances that are none count as 0.
fn sanitized(plane: Plane) -> Plane {
    plane.map(|v| if v.is_finite() && v > 0.0 { v } else { 0.0 })
}

fn feature(image: &Image, layer: &str, components: &[&str]) -> Option<Feature> {
    let finite = |plane: Plane| plane.map(|v| if v.is_finite() { v } else { 0.0 });
    let values: Option<Vec<Plane>> =
        components.iter().map(|c| plane(image, &format!("{layer}.{c}")).map(finite)).collect();
    let variances: Option<Vec<Plane>> =
        components.iter().map(|c| plane(image, &format!("variance.{layer}.{c}")).map(sanitized)).collect();
    Some(Feature { values: values?, variances })
}
