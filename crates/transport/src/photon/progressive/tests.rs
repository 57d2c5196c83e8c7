use super::schedule::{group, shrink};

/// The product of the paper, also where it is not multiplied out.
#[test]
fn radii_shrink_by_the_product() {
    let alpha = 2.0_f32 / 3.0;
    let mut squared = 1.0_f64;
    for pass in 0..5000_u64 {
        let expected = squared.sqrt() as f32;
        assert!((shrink(pass, alpha) / expected - 1.0).abs() < 1e-5, "{pass}");
        let i = (pass + 1) as f64;
        squared *= (i + f64::from(alpha)) / (i + 1.0);
    }
    assert_eq!(shrink(1_000_000, 1.0), 1.0);
    assert!(shrink(u64::MAX / 2, 0.5) > 0.0);
}

/// Four groups have four heroes, and few groups have wavelengths that are even.
#[test]
fn groups_are_even() {
    for seed in 0..10 {
        let numbers: Vec<f32> = (0..32).map(|number| group(seed, number).u_lambda).collect();
        for four in numbers.chunks(4) {
            let mut heroes: Vec<u32> = four.iter().map(|u| (u * 4.0) as u32).collect();
            heroes.sort_unstable();
            assert_eq!(heroes, [0, 1, 2, 3]);
        }
        let mut places: Vec<f32> = numbers.iter().map(|u| (u * 4.0).fract()).collect();
        places.sort_by(f32::total_cmp);
        let gaps = places.windows(2).map(|pair| pair[1] - pair[0]);
        let widest = gaps.fold(1.0 - places[31] + places[0], f32::max);
        assert!((widest * 32.0 - 1.0).abs() < 1e-4, "{widest}");
    }
}

/// One hero in each of as many equal parts of the spectrum as there are groups: dispersion leaves the heroes alone.
#[test]
fn heroes_are_even() {
    for seed in 0..10 {
        // The place of the first group is how far all are shifted within their quarters.
        let shift = (group(seed, 0).u_lambda * 4.0).fract();
        for n in [4, 8, 16, 32, 64, 256, 1024_u32] {
            let part = |number: u32| {
                let u = group(seed, number.into()).u_lambda * 4.0;
                let place = (u.fract() - shift + 1.0 + 1e-5).fract();
                u.floor() as u32 * (n / 4) + (place * (n / 4) as f32) as u32
            };
            let mut parts: Vec<u32> = (0..n).map(part).collect();
            parts.sort_unstable();
            assert!(parts.iter().copied().eq(0..n), "{n} groups of seed {seed}: {parts:?}");
        }
    }
}
