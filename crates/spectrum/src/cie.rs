//! The CIE 1931 2° standard observer.
//!
//! X = ∫ L(λ) x̄(λ) dλ and so on. Integrals are sums over whole nanometres from 360 to 830 nm. ȳ is also the luminous
//! efficiency V(λ) of photometry. Source: `data/README.md`.

use std::sync::OnceLock;

use crate::tables::{dense_lookup, dense_nm};
use crate::{LAMBDA_MAX_NM, LAMBDA_MIN_NM, N_DENSE};

/// ∫ ȳ(λ) dλ in nm: the sum of ȳ over whole nanometres.
pub const CIE_Y_INTEGRAL: f32 = 106.856_895;

/// Colour-matching functions at every nanometre from 360 to 830 nm.
#[derive(Debug)]
pub struct ColorMatching {
    /// x̄, red.
    pub x_bar: Vec<f32>,
    /// ȳ, luminous efficiency.
    pub y_bar: Vec<f32>,
    /// z̄, blue.
    pub z_bar: Vec<f32>,
    /// All three side by side, and a 0.
    pub(crate) rows: Vec<[f32; 4]>,
}

/// The colour-matching functions of the CIE 1931 2° observer.
#[must_use]
pub fn color_matching() -> &'static ColorMatching {
    static TABLES: OnceLock<ColorMatching> = OnceLock::new();
    TABLES.get_or_init(|| {
        let rows = parse_columns(include_str!("../data/cie1931.csv"));
        assert_eq!(rows.len(), N_DENSE, "the table has one row per rendered nanometre");
        let column = |c: usize| rows.iter().map(|row| row[c]).collect();
        ColorMatching {
            x_bar: column(1),
            y_bar: column(2),
            z_bar: column(3),
            rows: rows.iter().map(|row| [row[1], row[2], row[3], 0.0]).collect(),
        }
    })
}

/// x̄ at a wavelength in nm; 0 outside the rendered range.
#[must_use]
pub fn x_bar(nm: f32) -> f32 {
    at(&color_matching().x_bar, nm)
}

/// ȳ at a wavelength in nm; 0 outside the rendered range. The same as the luminous efficiency V(λ), 1 at 555 nm.
#[must_use]
pub fn y_bar(nm: f32) -> f32 {
    at(&color_matching().y_bar, nm)
}

/// z̄ at a wavelength in nm; 0 outside the rendered range.
#[must_use]
pub fn z_bar(nm: f32) -> f32 {
    at(&color_matching().z_bar, nm)
}

/// ∫ f(λ) (x̄, ȳ, z̄)(λ) dλ, the wavelength in nm.
#[must_use]
pub fn integrate_1nm(f: impl Fn(f32) -> f32) -> [f32; 3] {
    let observer = color_matching();
    let mut sum = [0.0_f64; 3];
    for i in 0..N_DENSE {
        let value = f64::from(f(dense_nm(i)));
        sum[0] += value * f64::from(observer.x_bar[i]);
        sum[1] += value * f64::from(observer.y_bar[i]);
        sum[2] += value * f64::from(observer.z_bar[i]);
    }
    sum.map(|s| s as f32)
}

/// Table look-up that is 0 outside the rendered range.
fn at(table: &[f32], nm: f32) -> f32 {
    if !(LAMBDA_MIN_NM..=LAMBDA_MAX_NM).contains(&nm) {
        return 0.0;
    }
    dense_lookup(table, nm)
}

/// Rows of numbers below a heading; an empty field is NaN.
pub(crate) fn parse_columns(csv: &str) -> Vec<Vec<f32>> {
    let number = |field: &str| {
        if field.is_empty() {
            return f32::NAN;
        }
        field.parse().expect("tables of the crate hold numbers")
    };
    csv.lines().skip(1).map(|line| line.split(',').map(number).collect()).collect()
}
