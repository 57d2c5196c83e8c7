//! Cost of one random number: `cargo bench -p etendue-math`. A rate of 100 Mitem/s is 10 ns for each number; the
//! start of a sample is part of it, spread over its 32 dimensions as in a path of three or four vertices.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use etendue_math::{Sampler, SamplerKind, SamplerSettings};

fn main() {
    divan::main();
}

const KINDS: [SamplerKind; 5] = [
    SamplerKind::Independent,
    SamplerKind::Stratified { x: 16, y: 16, jitter: true },
    SamplerKind::Halton,
    SamplerKind::Sobol,
    SamplerKind::ZSobol,
];
const N_SAMPLES: u64 = 256;
const N_DIMENSIONS: usize = 32;

fn bench(bencher: Bencher, kind: SamplerKind, sum: impl Fn(&mut Sampler) -> f32 + Sync) {
    let settings = SamplerSettings { kind, seed: 1, samples_per_pixel: N_SAMPLES as u32 };
    bencher.counter(ItemsCount::new(N_SAMPLES as usize * N_DIMENSIONS)).bench(|| {
        (0..N_SAMPLES).map(|index| sum(&mut Sampler::new(black_box(&settings), [3, 5], index))).sum::<f32>()
    });
}

/// As a path tracer asks: wavelength, place in the pixel, time and lens, then seven numbers at each of four vertices;
/// 34 in all.
#[divan::bench(args = KINDS)]
fn path(bencher: Bencher, kind: SamplerKind) {
    let settings = SamplerSettings { kind, seed: 1, samples_per_pixel: N_SAMPLES as u32 };
    let deal = |index| {
        let sampler = &mut Sampler::new(black_box(&settings), [3, 5], index);
        let pair = |sampler: &mut Sampler| {
            let (x, p) = (sampler.next_1d(), sampler.next_2d());
            x + p.x * p.y
        };
        let mut sum = pair(sampler) + pair(sampler);
        for _ in 0..4 {
            sampler.start_vertex();
            sum += pair(sampler) * pair(sampler) + sampler.next_1d();
        }
        sum
    };
    bencher.counter(ItemsCount::new(N_SAMPLES as usize * 34)).bench(|| (0..N_SAMPLES).map(deal).sum::<f32>());
}

/// Numbers one by one.
#[divan::bench(args = KINDS)]
fn next_1d(bencher: Bencher, kind: SamplerKind) {
    bench(bencher, kind, |sampler| (0..N_DIMENSIONS).map(|_| sampler.next_1d()).sum());
}

/// Numbers in pairs.
#[divan::bench(args = KINDS)]
fn next_2d(bencher: Bencher, kind: SamplerKind) {
    bench(bencher, kind, |sampler| {
        (0..N_DIMENSIONS / 2).map(|_| sampler.next_2d()).map(|point| point.x + point.y).sum()
    });
}
