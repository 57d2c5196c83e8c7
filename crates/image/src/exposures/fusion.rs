//! One picture of the best parts of several.

use crate::plane::Plane;

use super::ExposureError;

/// Powers of what makes a pixel good.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fusion {
    /// Of contrast: the length of the Laplacian.
    pub contrast: f32,
    /// Of saturation: the standard deviation of the channels.
    pub saturation: f32,
    /// Of being neither dark nor bright.
    pub exposedness: f32,
}

impl Default for Fusion {
    fn default() -> Self {
        Self { contrast: 1.0, saturation: 1.0, exposedness: 1.0 }
    }
}

/// Standard deviation of what counts as well exposed, about one half.
const EXPOSED_SIGMA: f32 = 0.2;

/// The pictures blended by how good each is at each place, band by band of a Laplacian pyramid, so that seams do not show.
/// All are encoded values in [0, 1], and so is the result, which is clipped.
///
/// # Errors
/// If there are fewer than two pictures or their sizes differ.
pub fn fuse(
    pictures: &[&[[f32; 3]]],
    width: usize,
    settings: Fusion,
) -> Result<Vec<[f32; 3]>, ExposureError> {
    let [first, _, ..] = pictures else { return Err(ExposureError::TooFew) };
    if let Some(index) = pictures.iter().position(|picture| picture.len() != first.len()) {
        return Err(ExposureError::Size(index));
    }
    if first.is_empty() {
        return Ok(Vec::new());
    }
    let weights = normalized(pictures.iter().map(|picture| goodness(picture, width, settings)).collect());
    let channels = [0, 1, 2].map(|channel| {
        let mut sum: Option<Vec<Plane>> = None;
        for (picture, weight) in pictures.iter().zip(&weights) {
            let plane = channel_of(picture, width, channel);
            let bands = laplacian(gaussian(&plane)).into_iter().zip(gaussian(weight));
            let blended: Vec<Plane> =
                bands.map(|(band, weight)| combine(&band, &weight, |a, b| a * b)).collect();
            sum = Some(match sum {
                None => blended,
                Some(sum) => sum.iter().zip(&blended).map(|(a, b)| combine(a, b, |a, b| a + b)).collect(),
            });
        }
        collapse(sum.unwrap_or_default())
    });
    let pixel = |i: usize| [0, 1, 2].map(|c| channels[c].values[i].clamp(0.0, 1.0));
    Ok((0..first.len()).map(pixel).collect())
}

fn channel_of(picture: &[[f32; 3]], width: usize, channel: usize) -> Plane {
    Plane::new(
        width,
        picture.len() / width,
        picture.iter().map(|pixel| pixel[channel].clamp(0.0, 1.0)).collect(),
    )
}

/// How good each pixel is.
fn goodness(picture: &[[f32; 3]], width: usize, settings: Fusion) -> Plane {
    let height = picture.len() / width;
    let grey = |x: usize, y: usize| picture[y * width + x].iter().sum::<f32>() / 3.0;
    Plane::from_rows(width, height, |y, row| {
        for (x, value) in row.iter_mut().enumerate() {
            let pixel = picture[y * width + x].map(|v| v.clamp(0.0, 1.0));
            let around = grey(x.saturating_sub(1), y)
                + grey((x + 1).min(width - 1), y)
                + grey(x, y.saturating_sub(1))
                + grey(x, (y + 1).min(height - 1));
            let contrast = (around - 4.0 * grey(x, y)).abs();
            let mean = pixel.iter().sum::<f32>() / 3.0;
            let saturation = (pixel.iter().map(|v| (v - mean).powi(2)).sum::<f32>() / 3.0).sqrt();
            let exposed = |v: f32| (-0.5 * ((v - 0.5) / EXPOSED_SIGMA).powi(2)).exp();
            let exposedness: f32 = pixel.iter().map(|v| exposed(*v)).product();
            *value = contrast.powf(settings.contrast)
                * saturation.powf(settings.saturation)
                * exposedness.powf(settings.exposedness)
                + 1e-12;
        }
    })
}

/// Weights that sum to 1 at each pixel.
fn normalized(mut weights: Vec<Plane>) -> Vec<Plane> {
    for i in 0..weights[0].values.len() {
        let sum: f32 = weights.iter().map(|plane| plane.values[i]).sum();
        weights.iter_mut().for_each(|plane| plane.values[i] /= sum);
    }
    weights
}

/// The plane and its halves, down to one pixel on a side.
fn gaussian(plane: &Plane) -> Vec<Plane> {
    let mut levels = vec![plane.clone()];
    while let Some(last) = levels.last()
        && last.width.min(last.height) > 1
    {
        levels.push(last.blurred(1.0).halved());
    }
    levels
}

/// What each level has beyond the next.
fn laplacian(mut levels: Vec<Plane>) -> Vec<Plane> {
    for i in 0..levels.len() - 1 {
        let (width, height) = (levels[i].width, levels[i].height);
        levels[i] = combine(&levels[i], &levels[i + 1].doubled(width, height), |a, b| a - b);
    }
    levels
}

fn collapse(mut levels: Vec<Plane>) -> Plane {
    let mut sum = levels.pop().unwrap_or_else(|| Plane::zeros(0, 0));
    while let Some(level) = levels.pop() {
        sum = combine(&level, &sum.doubled(level.width, level.height), |a, b| a + b);
    }
    sum
}

fn combine(a: &Plane, b: &Plane, f: impl Fn(f32, f32) -> f32) -> Plane {
    Plane::new(a.width, a.height, a.values.iter().zip(&b.values).map(|(a, b)| f(*a, *b)).collect())
}
