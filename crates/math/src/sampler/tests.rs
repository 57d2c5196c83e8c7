//! Samplers: reproducible, uniform, independent between dimensions and pixels, and as even as promised.

use super::*;
use crate::statistics::{Moments, chi_square_test, log_log_slope, mean_test};

const KINDS: [SamplerKind; 5] = [
    SamplerKind::Independent,
    SamplerKind::Stratified { x: 4, y: 4, jitter: true },
    SamplerKind::Halton,
    SamplerKind::Sobol,
    SamplerKind::ZSobol,
];

fn settings(kind: SamplerKind) -> SamplerSettings {
    SamplerSettings { kind, seed: 1, samples_per_pixel: 16 }
}

/// Numbers of one sample in a typical order of calls: 1, 2, 2, 1, 1, 2 dimensions.
fn deal(sampler: &mut Sampler) -> [f32; 9] {
    let a = sampler.next_1d();
    let (b, c) = (sampler.next_2d(), sampler.next_2d());
    let (d, e) = (sampler.next_1d(), sampler.next_1d());
    let f = sampler.next_2d();
    [a, b.x, b.y, c.x, c.y, d, e, f.x, f.y]
}

/// A sample depends on seed, pixel and index alone, and on each of them.
#[test]
fn samples_are_fixed_by_seed_pixel_and_index() {
    for kind in KINDS {
        let settings = settings(kind);
        let numbers =
            |settings: &SamplerSettings, pixel, index| deal(&mut Sampler::new(settings, pixel, index));
        let reference = numbers(&settings, [3, 4], 5);
        assert_eq!(reference, numbers(&settings, [3, 4], 5));
        if kind != SamplerKind::ZSobol {
            assert_eq!(reference, numbers(&SamplerSettings { samples_per_pixel: 99, ..settings }, [3, 4], 5));
        }
        for other in [
            numbers(&settings, [4, 3], 5),
            numbers(&settings, [3, 4], 6),
            numbers(&settings, [3, 4], 5 + (1 << 40)),
            numbers(&SamplerSettings { seed: 2, ..settings }, [3, 4], 5),
        ] {
            assert!(reference.iter().zip(other).all(|(a, b)| *a != b), "{kind:?}: {reference:?} {other:?}");
        }
    }
}

/// Numbers stay in [0, 1) however many dimensions a path takes.
#[test]
fn numbers_stay_in_range() {
    for kind in KINDS {
        for index in 0..64 {
            let mut sampler = Sampler::new(&settings(kind), [9, 9], index);
            for _ in 0..100 {
                assert!(deal(&mut sampler).iter().all(|x| (0.0..1.0).contains(x)), "{kind:?}");
            }
        }
    }
}

/// Over pixels every number is uniform, every pair fills the square, and numbers of one sample are uncorrelated.
#[test]
fn numbers_are_uniform_and_uncorrelated() {
    const CELLS: usize = 8;
    let pixels = 20_000;
    for kind in KINDS {
        let settings = settings(kind);
        let samples: Vec<[f32; 9]> = (0..pixels)
            .map(|i| deal(&mut Sampler::new(&settings, [i % 200, i / 200], u64::from(i % 7))))
            .collect();
        let significance = crate::statistics::sidak(1e-3, 36 + 9);
        for d in 0..9 {
            mean_test(&samples.iter().map(|s| f64::from(s[d])).collect(), 0.5, significance)
                .unwrap_or_else(|error| panic!("{kind:?} dimension {d}: {error}"));
            for e in 0..d {
                let mut counts = vec![0.0; CELLS * CELLS];
                for sample in &samples {
                    let cell = |x: f32| (x * CELLS as f32) as usize;
                    counts[cell(sample[d]) * CELLS + cell(sample[e])] += 1.0;
                }
                let expected = vec![f64::from(pixels) / (CELLS * CELLS) as f64; CELLS * CELLS];
                chi_square_test(&counts, &expected, 5.0, significance)
                    .unwrap_or_else(|error| panic!("{kind:?} dimensions {d}, {e}: {error}"));
            }
        }
    }
}

/// Neighbouring pixels have independent numbers, but on a curve: the product of their deviations averages to 0.
#[test]
fn pixels_are_independent() {
    for kind in &KINDS[..4] {
        let settings = settings(*kind);
        let first = |x, y| f64::from(Sampler::new(&settings, [x, y], 0).next_1d()) - 0.5;
        let mut products = Moments::new();
        for y in 0..150 {
            for x in 0..150 {
                products.push(12.0 * first(2 * x, y) * first(2 * x + 1, y));
            }
        }
        mean_test(&products, 0.0, 1e-4).unwrap_or_else(|error| panic!("{kind:?}: {error}"));
    }
}

/// MC-9: of one round of samples, one falls into each stratum of every single number and of every pair.
#[test]
fn stratified_samples_hit_every_stratum_once() {
    let settings = settings(SamplerKind::Stratified { x: 5, y: 3, jitter: true });
    for round in 0..3 {
        let mut intervals = vec![0; 15];
        let mut cells = vec![0; 15];
        for index in 0..15 {
            let mut sampler = Sampler::new(&settings, [1, 2], 15 * round + index);
            intervals[(sampler.next_1d() * 15.0) as usize] += 1;
            let p = sampler.next_2d();
            cells[(p.y * 3.0) as usize * 5 + (p.x * 5.0) as usize] += 1;
        }
        assert!(intervals.iter().all(|n| *n == 1), "{intervals:?}");
        assert!(cells.iter().all(|n| *n == 1), "{cells:?}");
    }
    let centred = SamplerSettings { kind: SamplerKind::Stratified { x: 2, y: 2, jitter: false }, ..settings };
    let p = Sampler::new(&centred, [0, 0], 0).next_2d();
    assert!([0.25, 0.75].contains(&p.x) && [0.25, 0.75].contains(&p.y), "{p:?}");
}

/// MC-10: every power-of-two prefix of Sobol samples is a net in every pair of numbers, and stratified in every single one.
#[test]
fn sobol_prefixes_are_nets() {
    let settings = settings(SamplerKind::Sobol);
    for m in 0..=8_u32 {
        let n = 1_usize << m;
        let samples: Vec<[f32; 9]> =
            (0..n as u64).map(|index| deal(&mut Sampler::new(&settings, [7, 8], index))).collect();
        for d in 0..9 {
            let mut seen = vec![false; n];
            samples.iter().for_each(|s| seen[(s[d] * n as f32) as usize] = true);
            assert!(seen.iter().all(|s| *s), "dimension {d} of 2^{m} samples");
        }
        for [d, e] in [[1, 2], [3, 4], [7, 8]] {
            for k in 0..=m {
                let (nx, ny) = (1_usize << k, 1_usize << (m - k));
                let mut seen = vec![false; n];
                for s in &samples {
                    seen[(s[d] * nx as f32) as usize * ny + (s[e] * ny as f32) as usize] = true;
                }
                assert!(seen.iter().all(|s| *s), "dimensions {d}, {e} of 2^{m} samples, {nx} by {ny}");
            }
        }
    }
}

/// Place in the pixel and on the first light, or direction and the next light.
fn segment(sampler: &mut Sampler) -> [f32; 4] {
    let p = sampler.next_2d();
    sampler.start_vertex();
    let q = sampler.next_2d();
    [p.x, p.y, q.x, q.y]
}

/// True if every box of volume 2^(t - m), its sides powers of 1/2, holds 2^t of the 2^m points.
fn is_net<const N: usize>(points: &[[f32; N]], t: u32) -> bool {
    fn visit<const N: usize>(points: &[[f32; N]], bits: &mut [u32; N], d: usize, left: u32, t: u32) -> bool {
        if d + 1 < N {
            return (0..=left).all(|k| {
                bits[d] = k;
                visit(points, bits, d + 1, left - k, t)
            });
        }
        bits[d] = left;
        let mut counts = vec![0; points.len() >> t];
        for point in points {
            let cell = point
                .iter()
                .zip(*bits)
                .fold(0, |cell, (x, k)| cell << k | (x * (1_u32 << k) as f32) as usize);
            counts[cell] += 1;
        }
        counts.iter().all(|n| *n == 1 << t)
    }
    let m = points.len().ilog2();
    visit(points, &mut [0; N], 0, m - t.min(m), t.min(m))
}

/// The four numbers of a group: every box of volume 2^(2 - m) holds four of 2^m samples.
#[test]
fn sobol_groups_are_nets_of_quality_2() {
    let settings = settings(SamplerKind::Sobol);
    let numbers = |deal: &dyn Fn(&mut Sampler) -> [f32; 4], m: u32| -> Vec<[f32; 4]> {
        (0..1 << m).map(|index| deal(&mut Sampler::new(&settings, [5, 6], index))).collect()
    };
    for m in 0..=9 {
        assert!(is_net(&numbers(&segment, m), 2), "2^{m} samples from the camera");
        let later = |sampler: &mut Sampler| {
            sampler.start_vertex();
            sampler.next_2d();
            segment(sampler)
        };
        assert!(is_net(&numbers(&later, m), 2), "2^{m} samples from the first vertex");
    }
    assert!(!is_net(&numbers(&segment, 8), 1), "the test can fail");
}

/// Choice of a light and point on it, wavelength and place in the pixel: three numbers that are even together.
#[test]
fn sobol_triples_are_nets() {
    let triple = |sampler: &mut Sampler| {
        let (x, p) = (sampler.next_1d(), sampler.next_2d());
        [x, p.x, p.y]
    };
    let settings = settings(SamplerKind::Sobol);
    for m in 0..=10 {
        let samplers = || (0..1 << m).map(|index| Sampler::new(&settings, [5, 6], index));
        let cameras: Vec<[f32; 3]> = samplers().map(|mut s| triple(&mut s)).collect();
        let lights: Vec<[f32; 3]> = samplers()
            .map(|mut s| {
                s.start_vertex();
                triple(&mut s)
            })
            .collect();
        assert!(is_net(&cameras, 3), "2^{m} samples at the camera");
        assert!(is_net(&lights, if m <= 6 { 2 } else { 3 }), "2^{m} samples at a light");
    }
}

/// On the curve every pixel has a net, the pixels of every square of 2^k by 2^k together have one, and samples beyond the
/// planned ones form nets of their own.
#[test]
fn pixels_along_the_curve_share_nets() {
    let settings = SamplerSettings { kind: SamplerKind::ZSobol, seed: 3, samples_per_pixel: 16 };
    let numbers = |x: std::ops::Range<u32>, y: std::ops::Range<u32>, samples: std::ops::Range<u64>| {
        let mut points = Vec::new();
        for (x, y) in x.flat_map(|x| y.clone().map(move |y| (x, y))) {
            points.extend(samples.clone().map(|i| segment(&mut Sampler::new(&settings, [x, y], i))));
        }
        points
    };
    assert!(is_net(&numbers(7..8, 300..301, 0..16), 2));
    assert!(is_net(&numbers(7..8, 300..301, 0..8), 2));
    assert!(is_net(&numbers(6..8, 4..6, 0..16), 2));
    assert!(is_net(&numbers(8..12, 16..20, 0..16), 2));
    assert!(is_net(&numbers(8..12, 16..20, 16..32), 2));
    // Other squares are none, and neither is what no one planned.
    assert!(!is_net(&numbers(7..9, 4..6, 0..16), 2));
    assert!(!is_net(&numbers(8..12, 16..20, 8..24), 2));
    // Beyond the curve's end another begins.
    let last = SamplerSettings { samples_per_pixel: 1 << 20, ..settings };
    let at = |x: u32| Sampler::new(&last, [x, 0], 0).next_2d();
    assert_ne!(at(3), at(3 + 64));
}

/// The errors of neighbours on the curve cancel: the mean over blocks of pixels errs less than with points of their own.
#[test]
fn errors_along_the_curve_cancel() {
    let block_error = |kind| {
        let mut squares = 0.0;
        for seed in 0..200 {
            let settings = SamplerSettings { kind, seed, samples_per_pixel: 4 };
            let mut sum = 0.0;
            for (x, y) in (0..4).flat_map(|x| (0..4).map(move |y| (x, y))) {
                sum += (0..4).map(|i| bump(Sampler::new(&settings, [x, y], i).next_2d())).sum::<f64>();
            }
            squares += (sum / 64.0 - 7.0 / 12.0).powi(2);
        }
        squares
    };
    let (curve, own) = (block_error(SamplerKind::ZSobol), block_error(SamplerKind::Sobol));
    assert!(curve < 0.3 * own, "{curve} {own}");
}

/// Root mean square error of the mean of `f` over the first n samples, over pixels, for each n of 2^0 ... 2^(steps - 1).
fn errors(kind: SamplerKind, steps: u32, expected: f64, f: impl Fn(&mut Sampler) -> f64) -> Vec<f64> {
    let pixels = 128;
    let settings = settings(kind);
    let mut squares = vec![0.0; steps as usize];
    for pixel in 0..pixels {
        let mut sum = 0.0;
        for index in 0..1_u64 << (steps - 1) {
            sum += f(&mut Sampler::new(&settings, [pixel, 0], index));
            let n = index + 1;
            if n.is_power_of_two() {
                squares[n.ilog2() as usize] += (sum / n as f64 - expected).powi(2);
            }
        }
    }
    squares.iter().map(|s| (s / f64::from(pixels)).sqrt()).collect()
}

fn counts(steps: u32) -> Vec<f64> {
    (0..steps).map(|k| f64::from(1_u32 << k)).collect()
}

/// A smooth bump, x^2 + x y + sin(2 pi y) e^x, of mean 1/3 + 1/4.
fn bump(p: Point2) -> f64 {
    let (x, y) = (f64::from(p.x), f64::from(p.y));
    x * x + x * y + (std::f64::consts::TAU * y).sin() * x.exp()
}

/// MC-10: errors of Sobol samples fall at every doubling below those of random samples, faster than N^-1 if smooth.
#[test]
fn sobol_converges_faster_than_random() {
    let steps = 11;
    let smooth = errors(SamplerKind::Sobol, steps, 7.0 / 12.0, |s| bump(s.next_2d()));
    let random = errors(SamplerKind::Independent, steps, 7.0 / 12.0, |s| bump(s.next_2d()));
    assert!((log_log_slope(&counts(steps), &random) + 0.5).abs() < 0.06, "{random:?}");
    assert!(log_log_slope(&counts(steps), &smooth) < -1.2, "{smooth:?}");
    for n in 1..steps as usize {
        assert!(smooth[n] < 0.8 * smooth[n - 1], "2^{n} samples: {smooth:?}");
    }
    // The edge of a disk: N^(-3/4).
    let disk = |p: Point2| if p.x * p.x + p.y * p.y < 1.0 { 1.0 } else { 0.0 };
    let edge = errors(SamplerKind::Sobol, steps, std::f64::consts::FRAC_PI_4, |s| disk(s.next_2d()));
    assert!(log_log_slope(&counts(steps), &edge) < -0.65, "{edge:?}");
}

/// Four dimensions of a group are even together; the product of smooth factors converges faster than random.
#[test]
fn sobol_groups_are_even_in_four_dimensions() {
    let steps = 11;
    let product = |s: &mut Sampler| segment(s).iter().map(|x| 1.0 + (f64::from(*x) - 0.5)).product();
    let together = errors(SamplerKind::Sobol, steps, 1.0, product);
    assert!(log_log_slope(&counts(steps), &together) < -1.1, "{together:?}");
    // Halves of two groups share no order: their product falls as N^-1/2 only.
    let apart = errors(SamplerKind::Sobol, steps, 0.0, |s| {
        let a = s.next_1d();
        s.start_vertex();
        s.start_vertex();
        let b = s.next_1d();
        f64::from(a - 0.5) * f64::from(b - 0.5)
    });
    assert!((log_log_slope(&counts(steps), &apart) + 0.5).abs() < 0.1, "{apart:?}");
}

/// MC-10: Halton samples converge faster than random ones too, without waiting for a power of two.
#[test]
fn halton_converges_faster_than_random() {
    let steps = 11;
    let smooth = errors(SamplerKind::Halton, steps, 7.0 / 12.0, |s| bump(s.next_2d()));
    assert!(log_log_slope(&counts(steps), &smooth) < -0.8, "{smooth:?}");
    // Dimensions beyond the primes are plain random numbers.
    let late = errors(SamplerKind::Halton, 8, 0.5, |s| {
        for _ in 0..70 {
            s.next_2d();
        }
        f64::from(s.next_1d())
    });
    assert!((log_log_slope(&counts(8), &late) + 0.5).abs() < 0.15, "{late:?}");
}

/// Few samples of many pixels have the right mean: randomisation leaves no bias.
#[test]
fn estimates_are_unbiased() {
    for kind in KINDS {
        let settings = settings(kind);
        for n in [1, 3, 4] {
            let estimates: Moments = (0..10_000)
                .map(|pixel| {
                    (0..n).map(|i| bump(Sampler::new(&settings, [pixel, n], i.into()).next_2d())).sum::<f64>()
                        / f64::from(n)
                })
                .collect();
            mean_test(&estimates, 7.0 / 12.0, 1e-4).unwrap_or_else(|error| panic!("{kind:?} {n}: {error}"));
        }
    }
}

/// MC-9: one sample per stratum of a smooth integrand: the error falls as N^(-3/2) in one dimension and as 1/N in two.
#[test]
fn stratified_errors_have_their_slopes() {
    let rms = |x: u32, y: u32, f: &dyn Fn(&mut Sampler) -> f64| {
        let settings = settings(SamplerKind::Stratified { x, y, jitter: true });
        let estimate = |pixel| {
            let n = x * y;
            let sum: f64 = (0..n).map(|i| f(&mut Sampler::new(&settings, [pixel, 0], i.into()))).sum();
            sum / f64::from(n)
        };
        (0..200).map(estimate).collect::<Moments>().standard_deviation()
    };
    let line: Vec<f64> = [4, 16, 64, 256].map(|n| rms(n, 1, &|s| f64::from(s.next_1d()).exp())).to_vec();
    let slope = log_log_slope(&[4.0, 16.0, 64.0, 256.0], &line);
    assert!((slope + 1.5).abs() < 0.07, "{slope}: {line:?}");
    let square: Vec<f64> = [6, 12, 24].map(|n| rms(n, n, &|s| bump(s.next_2d()))).to_vec();
    let slope = log_log_slope(&[36.0, 144.0, 576.0], &square);
    assert!((slope + 1.0).abs() < 0.07, "{slope}: {square:?}");
}
