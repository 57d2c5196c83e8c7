//! Curves that map equal luminances alike (SPEC TONE-3 to TONE-5, TONE-11).

use super::{
    DisplayCurve, Logarithmic, Operator, Reinhard, finite_luminances, log_average_luminance, mean_luminance,
};

/// An operator with the statistics of its image.
#[derive(Copy, Clone, Debug)]
pub(super) enum Curve {
    Clamp,
    Scale(f64),
    Exponential {
        mean: f64,
    },
    Reinhard {
        scale: f64,
        inverse_white_squared: f64,
    },
    /// Luminances are multiplied by `scale`; the largest is then `max`.
    Logarithmic {
        scale: f64,
        max: f64,
        exponent: f64,
        white: f64,
    },
    Display(DisplayCurve),
}

impl Curve {
    /// `None` for operators that need more than a curve.
    pub(super) fn of_pixels(operator: Operator, pixels: &[[f32; 3]]) -> Option<Self> {
        Some(match operator {
            Operator::Clamp => Self::Clamp,
            Operator::DivideByMaximum => {
                let finite = pixels.iter().flatten().copied().filter(|value| value.is_finite());
                Self::Scale(positive_reciprocal(f64::from(finite.fold(0.0, f32::max))))
            }
            Operator::Exponential => Self::Exponential { mean: mean_luminance(pixels).unwrap_or(0.0) },
            Operator::Reinhard(Reinhard { key, delta, white }) => {
                let average = log_average_luminance(pixels, delta).unwrap_or(0.0);
                let inverse_white_squared = white.map_or(0.0, |white| f64::from(white).powi(-2));
                Self::Reinhard { scale: f64::from(key) * positive_reciprocal(average), inverse_white_squared }
            }
            Operator::Logarithmic(Logarithmic { bias, display }) => {
                let scale = positive_reciprocal(log_average_luminance(pixels, 0.0).unwrap_or(0.0));
                Self::Logarithmic {
                    scale,
                    max: scale * finite_luminances(pixels).fold(0.0, f64::max),
                    exponent: f64::from(bias).ln() / 0.5_f64.ln(),
                    white: 0.01 * f64::from(display),
                }
            }
            Operator::Display(curve) => Self::Display(curve),
            Operator::Histogram(_)
            | Operator::ReinhardLocal(_)
            | Operator::Bilateral(_)
            | Operator::Gradient(_) => return None,
        })
    }

    /// One pixel through the curve.
    pub(super) fn map(self, pixel: [f32; 3]) -> [f32; 3] {
        if pixel.iter().any(|value| value.is_nan()) {
            return [0.0; 3];
        }
        if let Self::Clamp = self {
            return pixel.map(|value| value.clamp(0.0, 1.0));
        }
        if pixel.contains(&f32::INFINITY) {
            return [1.0; 3];
        }
        let pixel = pixel.map(|value| f64::from(value.max(0.0)));
        if let Self::Display(curve) = self {
            return curve.map(pixel).map(|value| value as f32);
        }
        let scale = self.scale(luminance_f64(pixel));
        pixel.map(|value| (value * scale) as f32)
    }

    /// `L_d / L` for a finite luminance.
    fn scale(self, l: f64) -> f64 {
        if l <= 0.0 {
            return 0.0;
        }
        match self {
            Self::Clamp | Self::Display(_) => 1.0,
            Self::Scale(scale) => scale,
            Self::Exponential { mean } if mean > 0.0 => -(-l / mean).exp_m1() / l,
            Self::Exponential { .. } => 0.0,
            Self::Reinhard { scale, inverse_white_squared } => {
                let scaled = l * scale;
                let shown = scaled * (1.0 + scaled * inverse_white_squared) / (1.0 + scaled);
                shown.min(1.0) / l
            }
            Self::Logarithmic { scale, max, exponent, white } => {
                let scaled = l * scale;
                let base = 2.0 + 8.0 * (scaled / max).powf(exponent);
                (white / (max + 1.0).log10() * scaled.ln_1p() / base.ln()).min(1.0) / l
            }
        }
    }
}

fn positive_reciprocal(value: f64) -> f64 {
    if value > 0.0 { value.recip() } else { 0.0 }
}

fn luminance_f64([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}
