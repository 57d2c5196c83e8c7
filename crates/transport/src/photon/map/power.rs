//! The power of a photon in four bytes: three mantissas and the exponent that they share (Ward 1991, "Real Pixels", in Graphics
//! Gems II; SPEC KD-3, KD-5).
//!
//! A component `v` has the mantissa `v 256 / 2^e`, where `2^e` is the least power of two above the largest component. What a
//! mantissa cannot hold is rounded up or down at random, so that sums of many photons are right even if all have the same
//! power: with rounding to the nearest they would all err to the same side. The error of one photon is below 1/128 of its
//! largest component (1/256 by rounding to the nearest), its expectation is exact.
//!
//! Components are those of XYZ, which no light has below 0. Those of RGB, [`PowerCodec::Rgb`], are the book's: what lies
//! outside the gamut of sRGB loses its negative components and grows brighter. Of white light, the four wavelengths of a path are nearly
//! always within the gamut (the mean Y is right to 0.1 %); of a path that dispersion left with one wavelength, the mean Y
//! grows by 20 %. A test measures both.

use etendue_spectrum::{ColorSpace, ColorSpaceName, Xyz};

/// What the three mantissas of a power are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PowerCodec {
    /// X, Y and Z of the CIE 1931 observer.
    #[default]
    Xyz,
    /// Linear sRGB. Negative components become 0.
    Rgb,
}

impl PowerCodec {
    /// The bytes of a power. `dither` are three numbers in [0, 1) that decide on rounding: 1/2 is to the nearest.
    #[must_use]
    pub fn encode(self, power: Xyz, dither: [f32; 3]) -> [u8; 4] {
        match self {
            Self::Xyz => encode(power.to_array(), dither),
            Self::Rgb => encode(ColorSpace::get(ColorSpaceName::Srgb).to_rgb(power), dither),
        }
    }

    /// The power of the bytes.
    #[inline]
    #[must_use]
    pub fn decode(self, bytes: [u8; 4]) -> Xyz {
        let components = decode(bytes);
        match self {
            Self::Xyz => Xyz::from(components),
            Self::Rgb => ColorSpace::get(ColorSpaceName::Srgb).to_xyz(components),
        }
    }
}

/// The exponent byte of powers below 1 and at least 1/2.
const BIAS: i32 = 128;

/// What a mantissa of 1 is worth, by exponent byte.
const SCALES: [f32; 256] = scales();

const fn scales() -> [f32; 256] {
    // An exponent byte of 0 means 0, whatever the mantissas.
    let mut scales = [0.0; 256];
    // 2^(1 - 128 - 8), a subnormal number, which is exact as all of them are.
    let mut scale = f32::from_bits(1 << 14);
    let mut byte = 1;
    while byte < 256 {
        scales[byte] = scale;
        scale *= 2.0;
        byte += 1;
    }
    scales
}

fn encode(components: [f32; 3], dither: [f32; 3]) -> [u8; 4] {
    // What is negative or NaN is 0.
    let components = components.map(|v| if v > 0.0 { v.min(f32::MAX) } else { 0.0 });
    let largest = components[0].max(components[1]).max(components[2]);
    let exponent = exponent(largest) + BIAS;
    if exponent < 1 {
        return [0; 4];
    }
    let mantissas = |exponent: usize| {
        let place = |i: usize| f64::from(components[i]) / f64::from(SCALES[exponent]);
        [0, 1, 2].map(|i| (place(i) + f64::from(dither[i])).floor())
    };
    let mut exponent = (exponent as usize).min(255);
    let mut digits = mantissas(exponent);
    if digits.iter().any(|digit| *digit > 255.0) && exponent < 255 {
        exponent += 1;
        digits = mantissas(exponent);
    }
    let [x, y, z] = digits.map(|digit| digit.min(255.0) as u8);
    [x, y, z, exponent as u8]
}

#[inline]
fn decode([x, y, z, exponent]: [u8; 4]) -> [f32; 3] {
    let scale = SCALES[usize::from(exponent)];
    [x, y, z].map(|mantissa| f32::from(mantissa) * scale)
}

/// The least `e` with `v < 2^e`; for 0 and subnormal numbers one below all others.
const fn exponent(v: f32) -> i32 {
    (v.to_bits() >> 23) as i32 - 126
}

#[cfg(test)]
mod tests {
    use etendue_math::Rng;
    use etendue_spectrum::{Sampled, Wavelengths, flux_to_xyz};

    use super::*;

    const NEAREST: [f32; 3] = [0.5; 3];

    fn power(rng: &mut Rng) -> Xyz {
        let size = (rng.next_f32() * 120.0 - 60.0).exp2();
        Xyz::from([0; 3].map(|_| rng.next_f32() * size))
    }

    fn largest(power: Xyz) -> f32 {
        power.x.max(power.y).max(power.z)
    }

    fn greatest_error(a: Xyz, b: Xyz) -> f32 {
        let [a, b] = [a, b].map(Xyz::to_array);
        (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max)
    }

    /// Each component is right to 1/256 of the largest by rounding to the nearest, to 1/128 by rounding at random.
    #[test]
    fn errors_are_within_their_bounds() {
        let mut rng = Rng::new(1, 0);
        for _ in 0..20_000 {
            let power = power(&mut rng);
            for (dither, bound) in [(NEAREST, 1.0 / 256.0), ([0; 3].map(|_| rng.next_f32()), 1.0 / 128.0)] {
                let read = PowerCodec::Xyz.decode(PowerCodec::Xyz.encode(power, dither));
                assert!(greatest_error(read, power) <= bound * 1.0001 * largest(power), "{power:?} {read:?}");
            }
        }
    }

    /// What is read is written again as the same bytes, or as others of the same value.
    #[test]
    fn bytes_are_stable() {
        let mut rng = Rng::new(2, 0);
        for _ in 0..20_000 {
            let bytes = PowerCodec::Xyz.encode(power(&mut rng), NEAREST);
            assert_eq!(PowerCodec::Xyz.encode(PowerCodec::Xyz.decode(bytes), NEAREST), bytes);
        }
    }

    /// A mean over photons of equal power is their power: 1e5 of them err by 1/256 each, of either sign, so that their mean
    /// has a standard deviation below 1/256/sqrt(1e5) of the largest component; five of these are allowed.
    #[test]
    fn rounding_at_random_has_no_bias() {
        let mut rng = Rng::new(3, 0);
        let (power, n) = (Xyz::new(0.503, 0.777_7, 0.021), 100_000);
        let mut sum = [0.0_f64; 3];
        for _ in 0..n {
            let bytes = PowerCodec::Xyz.encode(power, [0; 3].map(|_| rng.next_f32()));
            let read = PowerCodec::Xyz.decode(bytes).to_array();
            (0..3).for_each(|i| sum[i] += f64::from(read[i]));
        }
        for (sum, expected) in sum.iter().zip(power.to_array()) {
            let error = sum / f64::from(n) - f64::from(expected);
            assert!(error.abs() < 5.0 / 256.0 / f64::from(n).sqrt(), "{error}");
        }
    }

    /// Zero is zero; what is negative, NaN or too small becomes 0, what is too large the greatest power.
    #[test]
    fn odd_values() {
        for codec in [PowerCodec::Xyz, PowerCodec::Rgb] {
            assert_eq!(codec.decode(codec.encode(Xyz::default(), NEAREST)), Xyz::default());
            assert_eq!(codec.decode([200, 100, 1, 0]), Xyz::default());
        }
        let round = |power: Xyz| PowerCodec::Xyz.decode(PowerCodec::Xyz.encode(power, NEAREST));
        assert_eq!(round(Xyz::new(-1.0, f32::NAN, 1.0)), Xyz::new(0.0, 0.0, 1.0));
        assert_eq!(round(Xyz::new(0.0, 1e-42, 0.0)), Xyz::default());
        for large in [f32::MAX, f32::INFINITY] {
            let read = round(Xyz::new(0.0, large, 1.0));
            assert!(read.y.is_finite() && read.y > 1e38, "{read:?}");
        }
        for bytes in [[255; 4], [255, 0, 0, 255], [0, 0, 1, 1]] {
            assert!(PowerCodec::Xyz.decode(bytes).to_array().iter().all(|v| v.is_finite()));
        }
        assert_eq!(exponent(1.0), 1);
        assert_eq!(exponent(0.99), 0);
        assert_eq!(SCALES[BIAS as usize], 1.0 / 256.0);
        assert!(PowerCodec::Xyz.decode([1, 1, 1, 1]).y > 0.0, "the least scale is not zero");
    }

    /// Colours within the gamut of sRGB survive as RGB too; spectral ones grow, in the mean over white light by what the text
    /// of the module says.
    #[test]
    fn clamping_of_rgb() {
        let srgb = ColorSpace::get(ColorSpaceName::Srgb);
        let mut rng = Rng::new(4, 0);
        for _ in 0..2000 {
            let power = srgb.to_xyz([0; 3].map(|_| rng.next_f32()));
            let read = PowerCodec::Rgb.decode(PowerCodec::Rgb.encode(power, NEAREST));
            assert!(greatest_error(read, power) <= 1.1 / 128.0 * largest(power), "{power:?} {read:?}");
        }
        let n = 4000;
        let growth = |lambda: &dyn Fn(f32) -> Wavelengths| {
            let (mut read, mut stored) = (0.0_f64, 0.0_f64);
            for i in 0..n {
                let power = flux_to_xyz(Sampled::ONE, &lambda((i as f32 + 0.5) / n as f32));
                stored += f64::from(power.y);
                read += f64::from(PowerCodec::Rgb.decode(PowerCodec::Rgb.encode(power, NEAREST)).y);
            }
            read / stored
        };
        let single = |u: f32| {
            let mut lambda = Wavelengths::sample_visible(u);
            lambda.terminate_secondary();
            lambda
        };
        let (hero, single) = (growth(&Wavelengths::sample_visible), growth(&single));
        assert!((hero - 1.0).abs() < 0.001 && (single - 1.195).abs() < 0.01, "{hero} {single}");
    }
}
