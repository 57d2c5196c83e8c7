//! LDR-FLIP: the difference that an observer sees when flipping between two pictures.
//!
//! Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild 2020, "FLIP: A Difference Evaluator for
//! Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), doi 10.1145/3406183.
//!
//! Colour: both pictures go to the opponent space `YCxCz`, each channel is blurred by the contrast sensitivity of
//! the eye at the given pixels per degree, clipped to the RGB cube, taken to CIELAB with the Hunt effect (chroma
//! scaled by lightness) and compared by the distance `HyAB = |dL| + sqrt(da^2 + db^2)`. The distance to the power
//! 0.7 is mapped to [0, 1] so that 0.4 of the largest distance (green to blue) takes 0.95 of the range.
//! Features: derivatives of Gaussians of the achromatic channel find edges and points, and
//! `dE_f = (max(d_edge, d_point) / sqrt 2)^0.5`. The error is `dE_c^(1 - dE_f)`.
//!
//! Every filter is a sum of products of 1-D kernels, so blurring costs two 1-D passes instead of one 2-D pass; the
//! result is the same but for rounding. Pixels beyond the border repeat the border.

use rayon::prelude::*;

/// Observer of the paper: a 0.7 m wide display of 3840 pixels at 0.7 m.
pub const PIXELS_PER_DEGREE: f32 = 67.020_64;

/// Exponent of the colour distance, called `q_c`.
const COLOR_EXPONENT: f64 = 0.7;
/// Exponent of the feature difference, called `q_f`.
const FEATURE_EXPONENT: f64 = 0.5;
/// Share of the largest colour distance, called `p_c`, that is mapped to [`RANGE_AT_KNEE`], called `p_t`.
const KNEE: f64 = 0.4;
const RANGE_AT_KNEE: f64 = 0.95;
/// Width of the feature detectors in degrees of visual angle, called w.
const FEATURE_WIDTH_DEG: f64 = 0.082;

/// Contrast sensitivity of each opponent channel as a sum of Gaussians `a sqrt(pi/b) exp(-pi^2 x^2 / b)`, x in
/// degrees: pairs of a and b for the achromatic, red-green and blue-yellow channels.
const SENSITIVITY: [&[[f64; 2]]; 3] = [&[[1.0, 0.0047]], &[[1.0, 0.0053]], &[[34.1, 0.04], [13.5, 0.025]]];
/// The widest b above; it decides the radius of all kernels.
const WIDEST: f64 = 0.04;

/// Error in [0, 1] of each pixel of two pictures in linear RGB within [0, 1].
///
/// # Panics
/// When the lengths are not `width * height` or `pixels_per_degree` is not positive.
pub fn error_map(
    test: &[[f32; 3]],
    reference: &[[f32; 3]],
    [width, height]: [usize; 2],
    pixels_per_degree: f32,
) -> Vec<f32> {
    assert_eq!(test.len(), width * height, "one test pixel per place");
    assert_eq!(reference.len(), width * height, "one reference pixel per place");
    assert!(pixels_per_degree > 0.0, "an observer sees a positive number of pixels per degree");
    let pixels_per_degree = f64::from(pixels_per_degree);
    let test = Seen::new(test, width, pixels_per_degree);
    let reference = Seen::new(reference, width, pixels_per_degree);
    let largest = hyab(hunt_lab([0.0, 1.0, 0.0]), hunt_lab([0.0, 0.0, 1.0])).powf(COLOR_EXPONENT);
    let error = |index: usize| {
        let distance = hyab(reference.colors[index], test.colors[index]);
        let color = spread(distance.powf(COLOR_EXPONENT), largest);
        let edge = (reference.edges[index] - test.edges[index]).abs();
        let point = (reference.points[index] - test.points[index]).abs();
        let feature = (f64::from(edge.max(point)) / f64::sqrt(2.0)).powf(FEATURE_EXPONENT);
        color.powf(1.0 - feature).clamp(0.0, 1.0) as f32
    };
    (0..width * height).into_par_iter().map(error).collect()
}

/// What is kept of one picture.
struct Seen {
    /// Blurred colours in CIELAB with the Hunt effect.
    colors: Vec<[f64; 3]>,
    /// Strength of edges.
    edges: Vec<f32>,
    /// Strength of points.
    points: Vec<f32>,
}

impl Seen {
    fn new(pixels: &[[f32; 3]], width: usize, pixels_per_degree: f64) -> Seen {
        let opponent: Vec<[f64; 3]> =
            pixels.par_iter().map(|pixel| opponent_from_rgb(pixel.map(f64::from))).collect();
        let plane =
            |channel: usize| -> Vec<f32> { opponent.iter().map(|color| color[channel] as f32).collect() };
        let [y, cx, cz] =
            std::array::from_fn(|channel| blur(&plane(channel), width, channel, pixels_per_degree));
        let color = |index: usize| {
            let blurred = [y[index], cx[index], cz[index]].map(f64::from);
            hunt_lab(rgb_from_opponent(blurred).map(|value| value.clamp(0.0, 1.0)))
        };
        let achromatic: Vec<f32> = opponent.iter().map(|color| ((color[0] + 16.0) / 116.0) as f32).collect();
        let detectors = Detectors::new(pixels_per_degree);
        Seen {
            colors: (0..pixels.len()).into_par_iter().map(color).collect(),
            edges: detectors.strength(&achromatic, width, &detectors.edge),
            points: detectors.strength(&achromatic, width, &detectors.point),
        }
    }
}

/// Blurs an opponent channel by the sensitivity of the eye.
fn blur(plane: &[f32], width: usize, channel: usize, pixels_per_degree: f64) -> Vec<f32> {
    let radius = (3.0 * (WIDEST / 2.0).sqrt() / std::f64::consts::PI * pixels_per_degree).ceil() as i64;
    let terms: Vec<(f64, Vec<f64>)> = SENSITIVITY[channel]
        .iter()
        .map(|&[a, b]| {
            let scale = -(std::f64::consts::PI / pixels_per_degree).powi(2) / b;
            let kernel = (-radius..=radius).map(|x| (scale * (x * x) as f64).exp()).collect();
            (a * (std::f64::consts::PI / b).sqrt(), kernel)
        })
        .collect();
    // The weights of the 2-D kernel, all terms together, sum to 1.
    let total: f64 = terms.iter().map(|(weight, kernel)| weight * kernel.iter().sum::<f64>().powi(2)).sum();
    let mut blurred = vec![0.0; plane.len()];
    for (weight, kernel) in &terms {
        let along_x: Vec<f64> = kernel.iter().map(|value| value * weight / total).collect();
        let term = convolve(plane, width, &along_x, kernel);
        blurred.iter_mut().zip(term).for_each(|(sum, value)| *sum += value);
    }
    blurred
}

/// 1-D kernels of the feature detectors; each acts along one axis with `smooth` along the other.
struct Detectors {
    smooth: Vec<f64>,
    edge: Vec<f64>,
    point: Vec<f64>,
}

impl Detectors {
    fn new(pixels_per_degree: f64) -> Detectors {
        let deviation = 0.5 * FEATURE_WIDTH_DEG * pixels_per_degree;
        let radius = (3.0 * deviation).ceil() as i64;
        let gaussian = |x: f64| (-x * x / (2.0 * deviation * deviation)).exp();
        let tabulate =
            |f: &dyn Fn(f64) -> f64| -> Vec<f64> { (-radius..=radius).map(|x| f(x as f64)).collect() };
        let smooth = tabulate(&gaussian);
        let edge = tabulate(&|x| -x * gaussian(x));
        let point = tabulate(&|x| (x * x / (deviation * deviation) - 1.0) * gaussian(x));
        Detectors { smooth: balanced(smooth), edge: balanced(edge), point: balanced(point) }
    }

    /// Length of the responses along both axes.
    fn strength(&self, plane: &[f32], width: usize, kernel: &[f64]) -> Vec<f32> {
        let along_x = convolve(plane, width, kernel, &self.smooth);
        let along_y = convolve(plane, width, &self.smooth, kernel);
        along_x.iter().zip(along_y).map(|(x, y)| x.hypot(y)).collect()
    }
}

/// Scales positive weights to the sum 1 and negative ones to -1.
fn balanced(kernel: Vec<f64>) -> Vec<f64> {
    let sum_of = |sign: f64| kernel.iter().map(|value| (sign * value).max(0.0)).sum::<f64>();
    let (positive, negative) = (sum_of(1.0), sum_of(-1.0));
    kernel
        .iter()
        .map(|&value| {
            if value > 0.0 {
                value / positive
            } else if value < 0.0 {
                value / negative
            } else {
                0.0
            }
        })
        .collect()
}

/// Correlates rows with one kernel and columns with another; pixels beyond the border repeat it.
pub(crate) fn convolve(plane: &[f32], width: usize, along_x: &[f64], along_y: &[f64]) -> Vec<f32> {
    let height = plane.len() / width;
    let radius = along_x.len() / 2;
    let mut rows = vec![0.0f64; plane.len()];
    rows.par_chunks_mut(width).zip(plane.par_chunks(width)).for_each(|(out, row)| {
        for (x, value) in out.iter_mut().enumerate() {
            let at = |k: usize| f64::from(row[(x + k).saturating_sub(radius).min(width - 1)]);
            *value = along_x.iter().enumerate().map(|(k, weight)| weight * at(k)).sum();
        }
    });
    let radius = along_y.len() / 2;
    let mut result = vec![0.0f32; plane.len()];
    result.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        let mut sums = vec![0.0f64; width];
        for (k, weight) in along_y.iter().enumerate() {
            let source = (y + k).saturating_sub(radius).min(height - 1) * width;
            sums.iter_mut()
                .zip(&rows[source..source + width])
                .for_each(|(sum, value)| *sum += weight * value);
        }
        out.iter_mut().zip(sums).for_each(|(value, sum)| *value = sum as f32);
    });
    result
}

/// Maps the exponentiated distance to [0, 1] with a knee, so that large distances share the last twentieth.
fn spread(distance: f64, largest: f64) -> f64 {
    let knee = KNEE * largest;
    if distance < knee {
        return distance * RANGE_AT_KNEE / knee;
    }
    RANGE_AT_KNEE + (distance - knee) / (largest - knee) * (1.0 - RANGE_AT_KNEE)
}

/// City-block distance in lightness plus Euclidean distance in chroma.
fn hyab(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

/// Linear sRGB to XYZ with exact fractions, and back.
const XYZ_FROM_RGB: [[f64; 3]; 3] = [
    [10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0],
    [2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0],
    [1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0],
];
const RGB_FROM_XYZ: [[f64; 3]; 3] = [
    [3.241003275, -1.537398934, -0.498615861],
    [-0.969224334, 1.875930071, 0.041554224],
    [0.055639423, -0.204011202, 1.057148933],
];

fn multiply(matrix: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// XYZ relative to the white of linear RGB (1, 1, 1).
fn relative_xyz(rgb: [f64; 3]) -> [f64; 3] {
    let xyz = multiply(&XYZ_FROM_RGB, rgb);
    let white = multiply(&XYZ_FROM_RGB, [1.0; 3]);
    std::array::from_fn(|i| xyz[i] / white[i])
}

/// The linearised CIELAB space `YCxCz`.
fn opponent_from_rgb(rgb: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = relative_xyz(rgb);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

fn rgb_from_opponent([yy, cx, cz]: [f64; 3]) -> [f64; 3] {
    let y = (yy + 16.0) / 116.0;
    let relative = [y + cx / 500.0, y, y - cz / 200.0];
    let white = multiply(&XYZ_FROM_RGB, [1.0; 3]);
    multiply(&RGB_FROM_XYZ, std::array::from_fn(|i| relative[i] * white[i]))
}

/// CIELAB of linear RGB with chroma scaled by lightness: colours look more saturated when brighter (Hunt 1952).
fn hunt_lab(rgb: [f64; 3]) -> [f64; 3] {
    let delta = 6.0 / 29.0_f64;
    let f = |t: f64| if t > delta.powi(3) { t.cbrt() } else { t / (3.0 * delta * delta) + 4.0 / 29.0 };
    let [x, y, z] = relative_xyz(rgb).map(f);
    let lightness = 116.0 * y - 16.0;
    [lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)]
}
