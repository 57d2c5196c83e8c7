//! Features without their own noise, which comes from defocus, motion, edges of objects and fine textures.

use rayon::prelude::*;

use crate::plane::Plane;

use super::input::{Feature, Input};
use super::regression::N_TERMS;
use super::weights::{Guide, Reach, Tile, tile_rows, weight};

const REACH: Reach = Reach { window: 5, patch: 3 };
const BANDWIDTH: f32 = 1.0;
const TILE: usize = 32;

/// Features as the terms of a regression: row-major pixels, the first term 0, absent features 0.
#[derive(Debug)]
pub(super) struct Terms {
    pub(super) values: Vec<[f32; N_TERMS]>,
    pub(super) variances: Vec<[f32; N_TERMS]>,
}

/// All features, filtered by non-local means where their variance is known. Depths are in units of their mean.
pub(super) fn features(input: &Input) -> Terms {
    let n = input.size[0] * input.size[1];
    let mut terms = Terms { values: vec![[0.0; N_TERMS]; n], variances: vec![[0.0; N_TERMS]; n] };
    let mut term = 1;
    for (_, feature) in &input.features {
        let [values, variances] = filtered(feature);
        for (values, variances) in values.iter().zip(&variances) {
            let unit = if feature.values.len() == 1 { mean_size(values) } else { 1.0 };
            for i in 0..n {
                terms.values[i][term] = values.values[i] / unit;
                terms.variances[i][term] = variances.values[i] / (unit * unit);
            }
            term += 1;
        }
    }
    terms
}

/// Mean absolute value, 1 if that is 0.
fn mean_size(plane: &Plane) -> f32 {
    let sum: f64 = plane.values.iter().map(|v| f64::from(v.abs())).sum();
    let mean = (sum / plane.values.len().max(1) as f64) as f32;
    if mean > 0.0 && mean.is_finite() { mean } else { 1.0 }
}

/// The components of a feature and their variances after filtering.
fn filtered(feature: &Feature) -> [Vec<Plane>; 2] {
    let Some(variances) = &feature.variances else {
        return [feature.values.clone(), feature.values.iter().map(|plane| plane.map(|_| 0.0)).collect()];
    };
    let (width, height) = (feature.values[0].width, feature.values[0].height);
    let guide = Guide::new(&feature.values, variances, REACH);
    let mut result = [(); 2].map(|()| vec![Plane::zeros(width, height); feature.values.len()]);
    for tiles in tile_rows(width, height, TILE) {
        let parts: Vec<Vec<Mean>> =
            tiles.par_iter().map(|tile| filter_tile(feature, variances, &guide, tile)).collect();
        for (tile, part) in tiles.iter().zip(parts) {
            let pixels = tile.y.clone().flat_map(|y| tile.x.clone().map(move |x| y * width + x));
            for (pixel, mean) in pixels.zip(part) {
                for (planes, values) in result.iter_mut().zip(mean) {
                    planes.iter_mut().zip(values).for_each(|(plane, value)| plane.values[pixel] = value);
                }
            }
        }
    }
    result
}

/// Weighted means of up to three components, and the variances of these.
type Mean = [[f32; 3]; 2];

fn filter_tile(feature: &Feature, variances: &[Plane], guide: &Guide, tile: &Tile) -> Vec<Mean> {
    let mut distances = Vec::new();
    guide.distances(tile, &mut distances);
    let side = 2 * REACH.window + 1;
    let pixels = tile.y.clone().flat_map(|y| tile.x.clone().map(move |x| [x, y]));
    let mean = |([x, y], distances): ([usize; 2], &[f32])| {
        let (mut sums, mut total) = ([[0.0; 3]; 2], 0.0);
        for (offset, distance) in distances.iter().enumerate() {
            let weight = weight(*distance, BANDWIDTH);
            if weight == 0.0 {
                continue;
            }
            // A pixel with a weight lies within the picture.
            let (x, y) = (x + offset % side - REACH.window, y + offset / side - REACH.window);
            total += weight;
            for (c, (values, variances)) in feature.values.iter().zip(variances).enumerate() {
                sums[0][c] += weight * values.row(y)[x];
                sums[1][c] += weight * weight * variances.row(y)[x];
            }
        }
        let [values, variances] = sums;
        [values.map(|sum| sum / total), variances.map(|sum| sum / (total * total))]
    };
    pixels.zip(distances.chunks_exact(REACH.n_offsets())).map(mean).collect()
}
