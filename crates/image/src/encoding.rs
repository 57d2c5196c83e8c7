//! How numbers stored in a picture relate to light.
//!
//! The sRGB transfer function (IEC 61966-2-1:1999) maps linear light `l` to the stored value
//!
//! ```text
//! v = 12.92 l                     for l <= 0.0031308
//! v = 1.055 l^(1/2.4) - 0.055     above
//! ```
//!
//! Its two pieces miss each other by about 2e-8 at the joint, as the standard's rounded constants have it.

/// The relation between a stored value in [0, 1] and linear light.
#[derive(Copy, Clone, Debug, PartialEq, Default)]
pub enum Encoding {
    /// The stored value is the linear one.
    Linear,
    /// The sRGB transfer function, the default of 8-bit pictures.
    #[default]
    Srgb,
    /// A pure power law: linear = stored^gamma.
    Gamma(f32),
}

impl Encoding {
    /// Linear light of a stored value.
    #[inline]
    pub fn decode(self, stored: f32) -> f32 {
        match self {
            Encoding::Linear => stored,
            Encoding::Srgb => srgb_decode(stored),
            Encoding::Gamma(gamma) => stored.max(0.0).powf(gamma),
        }
    }

    /// Stored value of linear light, not clipped to [0, 1].
    #[inline]
    pub fn encode(self, linear: f32) -> f32 {
        match self {
            Encoding::Linear => linear,
            Encoding::Srgb => srgb_encode(linear),
            Encoding::Gamma(gamma) => linear.max(0.0).powf(gamma.recip()),
        }
    }

    /// Reads the names used in scene files: `linear`, `sRGB`, `gamma 2.2`.
    pub fn parse(text: &str) -> Option<Encoding> {
        let mut words = text.split_whitespace();
        let encoding = match words.next()? {
            "linear" => Encoding::Linear,
            "sRGB" | "srgb" => Encoding::Srgb,
            "gamma" => {
                let gamma: f32 = words.next()?.parse().ok()?;
                (gamma.is_finite() && gamma > 0.0).then_some(Encoding::Gamma(gamma))?
            }
            _ => return None,
        };
        words.next().is_none().then_some(encoding)
    }
}

/// Linear light of an sRGB value; values below zero stay on the linear piece.
#[inline]
pub fn srgb_decode(stored: f32) -> f32 {
    if stored <= 0.04045 {
        return stored / 12.92;
    }
    ((f64::from(stored) + 0.055) / 1.055).powf(2.4) as f32
}

/// sRGB value of linear light; values below zero stay on the linear piece.
#[inline]
pub fn srgb_encode(linear: f32) -> f32 {
    if linear <= 0.003_130_8 {
        return 12.92 * linear;
    }
    (1.055 * f64::from(linear).powf(1.0 / 2.4) - 0.055) as f32
}

/// The perceptual quantizer of SMPTE ST 2084, whose steps are about as fine as the eye's.
mod pq {
    pub(super) const M1: f64 = 2610.0 / 16384.0;
    pub(super) const M2: f64 = 2523.0 / 4096.0 * 128.0;
    pub(super) const C1: f64 = 3424.0 / 4096.0;
    pub(super) const C2: f64 = 2413.0 / 4096.0 * 32.0;
    pub(super) const C3: f64 = 2392.0 / 4096.0 * 32.0;
    /// Luminance of the value 1 in cd/m^2.
    pub(super) const PEAK: f64 = 10_000.0;
}

/// Value in [0, 1] that stands for a luminance in cd/m^2 by the perceptual quantizer of SMPTE ST 2084; 0 to 10,000 cd/m^2, beyond
/// which it is clipped. NaN becomes 0.
#[must_use]
pub fn pq_encode(luminance: f32) -> f32 {
    let shown = if luminance.is_nan() { 0.0 } else { f64::from(luminance).clamp(0.0, pq::PEAK) };
    let share = shown / pq::PEAK;
    let power = share.powf(pq::M1);
    ((pq::C1 + pq::C2 * power) / (1.0 + pq::C3 * power)).powf(pq::M2) as f32
}

/// Luminance in cd/m^2 of a value in [0, 1]: the inverse of [`pq_encode`].
#[must_use]
pub fn pq_decode(stored: f32) -> f32 {
    let power = f64::from(stored).clamp(0.0, 1.0).powf(1.0 / pq::M2);
    let share = (power - pq::C1).max(0.0) / (pq::C2 - pq::C3 * power);
    (share.powf(1.0 / pq::M1) * pq::PEAK) as f32
}

/// Linear light of each of the 256 values of a byte under one [`Encoding`].
#[derive(Clone, Debug)]
pub struct DecodeTable {
    encoding: Encoding,
    linear: [f32; 256],
}

impl DecodeTable {
    /// Tabulates `encoding`.
    pub fn new(encoding: Encoding) -> Self {
        let linear = std::array::from_fn(|byte| encoding.decode(byte as f32 / 255.0));
        Self { encoding, linear }
    }

    /// The encoding tabulated.
    pub fn encoding(&self) -> Encoding {
        self.encoding
    }

    /// Linear light of a byte.
    #[inline]
    pub fn byte(&self, byte: u8) -> f32 {
        self.linear[usize::from(byte)]
    }
}
