//! Spectra with names: standard illuminants, refractive indices of glasses and metals, scattering by molecules.
//!
//! Sources are in `data/README.md`. Illuminants are scaled so that their Y is 1 (see [`crate::spectrum_to_xyz`]). All are
//! continued with their end values where the data end inside 360–830 nm.

use crate::cie::{CIE_Y_INTEGRAL, integrate_1nm, parse_columns};
use crate::scattering::rayleigh;
use crate::tables::{dense_nm, piecewise_linear};
use crate::{LAMBDA_MAX_NM, LAMBDA_MIN_NM, N_DENSE};

/// A measured or defined spectrum.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedSpectrum {
    /// `[wavelength in nm, value]`, ascending, covering 360–830 nm.
    pub samples: Vec<[f32; 2]>,
}

/// Formula for the index of refraction n at a wavelength λ in µm.
#[derive(Copy, Clone, Debug)]
enum Dispersion {
    /// n² = 1 + Σ B λ² / (λ² − C), with pairs (B, C), C in µm² (Sellmeier).
    Sellmeier(&'static [[f64; 2]]),
    /// n² = constant + B / (λ² − C) + D λ² + E λ⁴.
    Oxide([f64; 5]),
}

/// Indices of refraction by formula. Schott catalogue of 2017; Malitson 1965 (silica), Peter 1923 (diamond),
/// Stephens and Malitson 1952 (MgO), Devore 1951 (TiO2, rutile, ordinary).
const FORMULAS: &[(&str, Dispersion)] = &[
    (
        "glass-BK7",
        Dispersion::Sellmeier(&[
            [1.039_612_12, 0.006_000_698_67],
            [0.231_792_344, 0.020_017_914_4],
            [1.010_469_45, 103.560_653],
        ]),
    ),
    (
        "glass-BAF10",
        Dispersion::Sellmeier(&[
            [1.585_149_5, 0.009_266_812_82],
            [0.143_559_385, 0.042_448_980_5],
            [1.085_212_69, 105.613_573],
        ]),
    ),
    (
        "glass-FK51A",
        Dispersion::Sellmeier(&[
            [0.971_247_817, 0.004_723_019_95],
            [0.216_901_417, 0.015_357_561_2],
            [0.904_651_666, 168.681_33],
        ]),
    ),
    (
        "glass-LASF9",
        Dispersion::Sellmeier(&[
            [2.000_295_47, 0.012_142_601_7],
            [0.298_926_886, 0.053_873_623_6],
            [1.806_918_43, 156.530_829],
        ]),
    ),
    (
        "glass-SF5",
        Dispersion::Sellmeier(&[
            [1.524_818_89, 0.011_254_756],
            [0.187_085_527, 0.058_899_539_2],
            [1.427_290_15, 129.141_675],
        ]),
    ),
    (
        "glass-SF10",
        Dispersion::Sellmeier(&[
            [1.621_539_02, 0.012_224_145_7],
            [0.256_287_842, 0.059_573_677_5],
            [1.644_475_52, 147.468_793],
        ]),
    ),
    (
        "glass-SF11",
        Dispersion::Sellmeier(&[
            [1.737_596_95, 0.013_188_707],
            [0.313_747_346, 0.062_306_814_2],
            [1.898_781_01, 155.236_29],
        ]),
    ),
    (
        "glass-silica",
        Dispersion::Sellmeier(&[
            [0.696_166_3, 0.004_679_148_3],
            [0.407_942_6, 0.013_512_063_1],
            [0.897_479_4, 97.934_002_5],
        ]),
    ),
    ("glass-diamond", Dispersion::Sellmeier(&[[0.3306, 0.030_625], [4.3356, 0.011_236]])),
    (
        "metal-MgO-eta",
        Dispersion::Oxide([2.956_362, 0.021_957_70, 0.014_283_22, -0.010_623_87, -0.000_020_496_8]),
    ),
    ("metal-TiO2-eta", Dispersion::Oxide([5.913, 0.2441, 0.0803, 0.0, 0.0])),
];

/// Other names for the same spectra.
const ALIASES: [(&str, &str); 3] =
    [("glass-F5", "glass-SF5"), ("glass-F10", "glass-SF10"), ("glass-F11", "glass-SF11")];

/// Spectra that are zero: the extinction of transparent oxides.
const ZERO: [&str; 2] = ["metal-MgO-k", "metal-TiO2-k"];

/// Camera sensors that scene files name and whose responses are not part of the crate.
pub const CAMERA_SENSORS: [&str; 17] = [
    "canon_eos_100d",
    "canon_eos_1dx_mkii",
    "canon_eos_200d",
    "canon_eos_200d_mkii",
    "canon_eos_5d",
    "canon_eos_5d_mkii",
    "canon_eos_5d_mkiii",
    "canon_eos_5d_mkiv",
    "canon_eos_5ds",
    "canon_eos_m",
    "hasselblad_l1d_20c",
    "nikon_d810",
    "nikon_d850",
    "sony_ilce_6400",
    "sony_ilce_7m3",
    "sony_ilce_7rm3",
    "sony_ilce_9",
];

/// Coefficients of scattering by molecules, relative to that at 550 nm.
const RAYLEIGH: &str = "rayleigh";

/// The spectrum of that name, such as `glass-BK7`, `metal-Au-eta`, `metal-Au-k`, `stdillum-D65` or `rayleigh`.
#[must_use]
pub fn named_spectrum(name: &str) -> Option<NamedSpectrum> {
    let name = ALIASES.iter().find(|(alias, _)| *alias == name).map_or(name, |(_, known)| known);
    let samples = if let Some((_, formula)) = FORMULAS.iter().find(|(known, _)| *known == name) {
        formula_samples(*formula)
    } else if name == RAYLEIGH {
        dense_samples(rayleigh)
    } else if ZERO.contains(&name) {
        vec![[LAMBDA_MIN_NM, 0.0], [LAMBDA_MAX_NM, 0.0]]
    } else if name.starts_with("metal-") {
        metal_samples(name)?
    } else {
        illuminant_samples(name)?
    };
    Some(NamedSpectrum { samples })
}

/// All names that [`named_spectrum`] knows.
#[must_use]
pub fn named_spectrum_names() -> Vec<String> {
    let mut names: Vec<String> = FORMULAS.iter().map(|(name, _)| (*name).to_owned()).collect();
    names.extend(ALIASES.map(|(alias, _)| alias.to_owned()));
    names.extend(ZERO.map(str::to_owned));
    names.push(RAYLEIGH.to_owned());
    for line in METALS.lines().skip(1) {
        let metal = line.split(',').next().unwrap_or_default();
        let eta = format!("metal-{metal}-eta");
        if !names.contains(&eta) {
            names.push(eta);
            names.push(format!("metal-{metal}-k"));
        }
    }
    names.extend(illuminant_names().map(str::to_owned));
    names.sort();
    names
}

/// For a name that scene files use and whose data are not part of the crate: what to use instead.
#[must_use]
pub fn known_but_missing(name: &str) -> Option<&'static str> {
    CAMERA_SENSORS.contains(&name).then_some("cie1931")
}

const METALS: &str = include_str!("../data/metals.csv");
const ILLUMINANTS: &str = include_str!("../data/illuminants.csv");

/// Names in the heading of the table of illuminants.
fn illuminant_names() -> impl Iterator<Item = &'static str> {
    ILLUMINANTS.lines().next().unwrap_or_default().split(',').skip(1)
}

/// A column of the table of illuminants, scaled to Y = 1.
fn illuminant_samples(name: &str) -> Option<Vec<[f32; 2]>> {
    let column = 1 + illuminant_names().position(|known| known == name)?;
    let measured = parse_columns(ILLUMINANTS)
        .iter()
        .map(|row| [row[0], row[column]])
        .filter(|sample| !sample[1].is_nan())
        .collect();
    let samples = extended(measured);
    let [_, y, _] = integrate_1nm(|nm| piecewise_linear(&samples, nm));
    let scale = CIE_Y_INTEGRAL / y;
    Some(samples.iter().map(|s| [s[0], s[1] * scale]).collect())
}

/// Index or extinction of a metal, `metal-<symbol>-eta` or `metal-<symbol>-k`.
fn metal_samples(name: &str) -> Option<Vec<[f32; 2]>> {
    let (metal, quantity) = name.strip_prefix("metal-")?.rsplit_once('-')?;
    let field = match quantity {
        "eta" => 2,
        "k" => 3,
        _ => return None,
    };
    let samples: Vec<[f32; 2]> = METALS
        .lines()
        .skip(1)
        .map(|line| line.split(',').collect::<Vec<_>>())
        .filter(|row| row[0] == metal)
        .map(|row| [row[1], row[field]].map(|v| v.parse().expect("tables of the crate hold numbers")))
        .collect();
    (!samples.is_empty()).then(|| extended(samples))
}

/// The formula at every nm.
fn formula_samples(formula: Dispersion) -> Vec<[f32; 2]> {
    dense_samples(|nm| formula.index(f64::from(nm) * 1e-3) as f32)
}

/// A function of the wavelength in nm, at every nm.
fn dense_samples(f: impl Fn(f32) -> f32) -> Vec<[f32; 2]> {
    (0..N_DENSE).map(dense_nm).map(|nm| [nm, f(nm)]).collect()
}

/// Continues the ends with constants over the rendered range.
fn extended(mut samples: Vec<[f32; 2]>) -> Vec<[f32; 2]> {
    let (Some(&first), Some(&last)) = (samples.first(), samples.last()) else {
        return samples;
    };
    if first[0] > LAMBDA_MIN_NM {
        samples.insert(0, [LAMBDA_MIN_NM - 1.0, first[1]]);
    }
    if last[0] < LAMBDA_MAX_NM {
        samples.push([LAMBDA_MAX_NM + 1.0, last[1]]);
    }
    samples
}

impl Dispersion {
    /// Index of refraction at a wavelength in µm.
    fn index(self, micrometres: f64) -> f64 {
        let l2 = micrometres * micrometres;
        match self {
            Self::Sellmeier(terms) => {
                let sum: f64 = terms.iter().map(|[b, c]| b * l2 / (l2 - c)).sum();
                (1.0 + sum).sqrt()
            }
            Self::Oxide([a, b, c, d, e]) => (a + b / (l2 - c) + (d + e * l2) * l2).sqrt(),
        }
    }
}
