use super::*;
use crate::{Encoding, srgb_encode};

/// Radiance over five powers of ten, each level of it many times.
fn radiance() -> Vec<[f32; 3]> {
    (0..4096)
        .map(|i| {
            let l = 10_f32.powf((i % 1024) as f32 / 1024.0 * 5.0 - 3.0);
            [l, 0.6 * l, 0.3 * l]
        })
        .collect()
}

/// What a camera of that curve stores as bytes.
fn photograph(seconds: f32, curve: impl Fn(f32) -> f32) -> Vec<[f32; 3]> {
    let byte = |v: f32| (curve((v * seconds).clamp(0.0, 1.0)) * 255.0).round() / 255.0;
    radiance().into_iter().map(|pixel| pixel.map(byte)).collect()
}

const TIMES: [f32; 9] = [0.005, 0.02, 0.08, 0.3, 1.2, 5.0, 20.0, 80.0, 300.0];

fn relative_errors(found: &[[f32; 3]], scale: f32) -> Vec<f32> {
    let truth = radiance();
    let mut errors: Vec<f32> =
        found.iter().zip(&truth).map(|(a, b)| (a[1] * scale / b[1] - 1.0).abs()).collect();
    errors.sort_by(f32::total_cmp);
    errors
}

/// A stack made of known radiance gives it back, where the camera's curve is known.
#[test]
fn known_response() {
    let pictures: Vec<Vec<[f32; 3]>> = TIMES.iter().map(|t| photograph(*t, srgb_encode)).collect();
    let exposures: Vec<Exposure<'_>> =
        pictures.iter().zip(TIMES).map(|(pixels, seconds)| Exposure { pixels, seconds }).collect();
    let found = merge(&exposures, &Response::of_encoding(Encoding::Srgb)).expect("exposures");
    let errors = relative_errors(&found, 1.0);
    assert!(errors[errors.len() - 1] < 0.03, "{}", errors[errors.len() - 1]);
}

/// And where it is not: the curve is recovered from the stack, up to a factor.
#[test]
fn recovered_response() {
    // No curve that is known: a soft shoulder.
    let curve = |v: f32| 1.25 * v.powf(0.6) / (0.25 + v.powf(0.6));
    let pictures: Vec<Vec<[f32; 3]>> = TIMES.iter().map(|t| photograph(*t, curve)).collect();
    let exposures: Vec<Exposure<'_>> =
        pictures.iter().zip(TIMES).map(|(pixels, seconds)| Exposure { pixels, seconds }).collect();
    let response = Response::recover(&exposures, 20.0).expect("exposures");
    let found = merge(&exposures, &response).expect("exposures");
    let middle =
        radiance().iter().zip(&found).map(|(a, b)| (a[1] / b[1]).ln()).sum::<f32>() / found.len() as f32;
    let errors = relative_errors(&found, middle.exp());
    // At both ends of the range a single exposure near its own end tells, by levels that are steps of several per cent.
    assert!(errors[errors.len() * 95 / 100] < 0.03, "{}", errors[errors.len() * 95 / 100]);
    assert!(errors[errors.len() / 2] < 0.01, "{}", errors[errors.len() / 2]);
}

#[test]
fn exposures_that_cannot_be_combined() {
    let (one, other) = (vec![[0.5; 3]; 4], vec![[0.5; 3]; 5]);
    let exposure = |pixels, seconds| Exposure { pixels, seconds };
    let response = Response::of_encoding(Encoding::Srgb);
    assert_eq!(merge(&[], &response), Err(ExposureError::TooFew));
    assert_eq!(merge(&[exposure(&one, 1.0)], &response), Err(ExposureError::TooFew));
    assert_eq!(merge(&[exposure(&one, 1.0), exposure(&other, 2.0)], &response), Err(ExposureError::Size(1)));
    assert_eq!(merge(&[exposure(&one, 1.0), exposure(&one, -2.0)], &response), Err(ExposureError::Time(1)));
    let same = [exposure(&one, 1.0), exposure(&one, 1.0)];
    assert_eq!(Response::recover(&same, 20.0), Err(ExposureError::SameTimes));
    assert_eq!(fuse(&[&one], 2, Fusion::default()), Err(ExposureError::TooFew));
    assert_eq!(fuse(&[&one, &other], 2, Fusion::default()), Err(ExposureError::Size(1)));
    // Black and white tell nothing, of the camera nor of light.
    let clipped = [vec![[0.0; 3]; 4], vec![[1.0; 3]; 4], vec![[0.001; 3]; 4]];
    for pixels in &clipped {
        for other in &clipped {
            let two = [exposure(pixels, 1.0), exposure(other, 2.0)];
            assert_eq!(merge(&two, &response), Err(ExposureError::Clipped));
            assert_eq!(Response::recover(&two, 20.0), Err(ExposureError::Clipped));
        }
    }
    // Where some do, pixels that are clipped in all are finite, and what is white is brighter.
    let (short, long) =
        (vec![[0.0; 3], [0.5; 3], [1.0; 3], [0.1; 3]], vec![[0.0; 3], [0.7; 3], [1.0; 3], [0.2; 3]]);
    let two = [exposure(&short, 1.0), exposure(&long, 2.0)];
    let merged = merge(&two, &response).expect("exposures");
    assert!(merged.iter().flatten().all(|v| v.is_finite() && *v >= 0.0), "{merged:?}");
    assert!(merged[0][1] < merged[3][1] && merged[1][1] < merged[2][1], "{merged:?}");
    let recovered = Response::recover(&two, 20.0).expect("a curve");
    assert!((0..256).all(|z| recovered.ln_exposure(0, z).is_finite()));
}

/// Equal pictures fuse to themselves; of two, each gives what it shows well.
#[test]
fn fusion_takes_the_best() {
    let (width, height) = (64, 48);
    let texture = |x: usize, y: usize| 0.5 + 0.1 * (x as f32 * 1.3).sin() * (y as f32 * 1.1).cos();
    let picture = |dark_half: usize, value: f32| -> Vec<[f32; 3]> {
        (0..width * height)
            .map(|i| {
                let (x, y) = (i % width, i / width);
                let l = if (x < width / 2) == (dark_half == 0) { value } else { texture(x, y) };
                [l, 0.9 * l, 0.8 * l]
            })
            .collect()
    };
    let (left_black, right_white) = (picture(0, 0.01), picture(1, 0.99));
    let same = fuse(&[&left_black, &left_black], width, Fusion::default()).expect("pictures");
    assert!(same.iter().zip(&left_black).all(|(a, b)| (a[0] - b[0]).abs() < 1e-4));
    let fused = fuse(&[&left_black, &right_white], width, Fusion::default()).expect("pictures");
    // Texture of both halves is kept, away from black and white. The left stays darker than the right.
    for (first, last) in [(4, 28), (36, 60)] {
        let (mut product, mut square, mut n, mut sum) = (0.0, 0.0, 0.0, 0.0);
        for y in 4..height - 4 {
            for x in first..last {
                let step = |f: &dyn Fn(usize, usize) -> f32| f(x + 1, y) - f(x, y);
                let there = step(&texture);
                product += there * step(&|x, y| fused[y * width + x][0]);
                square += there * there;
                sum += fused[y * width + x][0];
                n += 1.0;
            }
        }
        assert!((0.75..1.1).contains(&(product / square)), "{}", product / square);
        assert!((0.15..0.85).contains(&(sum / n)), "{}", sum / n);
    }
    assert_eq!(fuse(&[&[], &[]], 1, Fusion::default()), Ok(Vec::new()));
}
