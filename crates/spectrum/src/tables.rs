//! Tabulated spectra, one value per nanometre.

use etendue_math::Lanes4;

use crate::{
    ColorSpaceName, LAMBDA_MAX_NM, LAMBDA_MIN_NM, N_DENSE, Sampled, Spectrum, Wavelengths, named_spectrum,
};

/// Names a table of a [`SpectrumTables`].
#[derive(Copy, Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TableId(u32);

/// All tabulated spectra of a scene. Each has one value per nm from 360 to 830 nm and is linear between them.
#[derive(Clone, Debug, Default)]
pub struct SpectrumTables {
    /// The tables one after another, [`N_DENSE`] values each.
    values: Vec<f32>,
    /// Spectra already entered by name.
    named: Vec<(String, Spectrum)>,
    /// Illuminants of the colour spaces already entered.
    illuminants: [Option<TableId>; ColorSpaceName::ALL.len()],
}

impl SpectrumTables {
    /// No tables.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Number of tables.
    #[must_use]
    pub fn len(&self) -> usize {
        self.values.len() / N_DENSE
    }

    /// Whether there is no table.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Adds a function of wavelength (nm), taken at every nm.
    pub fn add_dense(&mut self, f: impl Fn(f32) -> f32) -> TableId {
        let id = TableId(u32::try_from(self.len()).expect("fewer than 2^32 tables fit in memory"));
        self.values.extend((0..N_DENSE).map(|i| f(dense_nm(i))));
        id
    }

    /// Adds a function given at `[wavelength in nm, value]`, linear between the wavelengths and 0 outside.
    ///
    /// Values that are all equal over the whole range give a constant. Where samples lie closer than 1 nm, as in line
    /// spectra, each nm takes the mean around it, so that no power is lost. Samples out of order are sorted, samples with
    /// infinities or NaN left out.
    pub fn add_samples(&mut self, samples: &[[f32; 2]]) -> Spectrum {
        let mut samples: Vec<[f32; 2]> =
            samples.iter().copied().filter(|s| s[0].is_finite() && s[1].is_finite()).collect();
        samples.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let Some((&[first_nm, value], &[last_nm, _])) = samples.first().zip(samples.last()) else {
            return Spectrum::Constant(0.0);
        };
        let covers = first_nm <= LAMBDA_MIN_NM && last_nm >= LAMBDA_MAX_NM;
        if covers && samples.iter().all(|s| s[1] == value) {
            return Spectrum::Constant(value);
        }
        let is_fine = samples.windows(2).any(|w| w[1][0] - w[0][0] < 0.999);
        let table = if is_fine {
            self.add_dense(|nm| {
                mean_linear(&samples, (nm - 0.5).max(LAMBDA_MIN_NM), (nm + 0.5).min(LAMBDA_MAX_NM))
            })
        } else {
            self.add_dense(|nm| piecewise_linear(&samples, nm))
        };
        Spectrum::table(table, self)
    }

    /// Adds a measured spectrum of [`named_spectrum`] once; `None` if there is none of that name.
    pub fn add_named(&mut self, name: &str) -> Option<Spectrum> {
        if let Some((_, spectrum)) = self.named.iter().find(|(known, _)| known == name) {
            return Some(*spectrum);
        }
        let spectrum = self.add_samples(&named_spectrum(name)?.samples);
        self.named.push((name.to_owned(), spectrum));
        Some(spectrum)
    }

    /// The illuminant of a colour space, entered at the first call.
    pub fn illuminant(&mut self, space: ColorSpaceName) -> TableId {
        if let Some(id) = self.illuminants[space as usize] {
            return id;
        }
        let illuminant = &crate::ColorSpace::get(space).illuminant;
        let id = self.add_dense(|nm| illuminant[(nm - LAMBDA_MIN_NM) as usize]);
        self.illuminants[space as usize] = Some(id);
        id
    }

    /// The values of a table at 360, 361, ... 830 nm.
    #[inline]
    #[must_use]
    pub fn table(&self, id: TableId) -> &[f32] {
        let start = id.0 as usize * N_DENSE;
        &self.values[start..start + N_DENSE]
    }

    /// Largest value of a table.
    #[must_use]
    pub fn max_value(&self, id: TableId) -> f32 {
        self.table(id).iter().fold(f32::NEG_INFINITY, |a, &b| a.max(b))
    }

    /// Value of a table at a wavelength in nm; 0 outside 360–830 nm.
    #[inline]
    #[must_use]
    pub fn at(&self, id: TableId, nm: f32) -> f32 {
        if !(LAMBDA_MIN_NM..=LAMBDA_MAX_NM).contains(&nm) {
            return 0.0;
        }
        dense_lookup(self.table(id), nm)
    }

    /// Values of a table at the wavelengths of a path; for bands at the wavelengths that stand for them.
    #[inline]
    #[must_use]
    pub fn sample(&self, id: TableId, wavelengths: &Wavelengths) -> Sampled {
        let table = self.table(id);
        let [a, b, c, d] = wavelengths.lambda_nm();
        let at = |nm: f32| dense_lookup(table, nm);
        Sampled::from_array([at(a), at(b), at(c), at(d)])
    }
}

/// Wavelength in nm of an entry of a dense table.
pub(crate) fn dense_nm(i: usize) -> f32 {
    LAMBDA_MIN_NM + i as f32
}

/// Where a wavelength in nm lies in a dense table: the entry below it, and the share of the next one.
#[inline]
pub(crate) fn dense_place(nm: f32) -> (usize, f32) {
    let t = (nm - LAMBDA_MIN_NM).clamp(0.0, (N_DENSE - 1) as f32);
    // Of an integer below 2^31, which the processor converts in one step.
    let i = (t as i32 as usize).min(N_DENSE - 2);
    (i, t - i as f32)
}

/// Linear interpolation in a dense table at a wavelength in nm inside the rendered range.
#[inline]
pub(crate) fn dense_lookup(table: &[f32], nm: f32) -> f32 {
    let (i, f) = dense_place(nm);
    table[i] * (1.0 - f) + table[i + 1] * f
}

/// Sum of the rows of a dense table at wavelengths in nm inside the rendered range, each times a weight.
#[inline]
pub(crate) fn weighted_rows(rows: &[[f32; 4]], weights: Sampled, wavelengths: &Wavelengths) -> [f32; 4] {
    let mut sum = Lanes4::splat(0.0);
    for (w, nm) in weights.to_array().into_iter().zip(wavelengths.lambda_nm()) {
        let (i, f) = dense_place(nm);
        let [a, b] = [rows[i], rows[i + 1]].map(Lanes4);
        sum = sum + a * Lanes4::splat(w * (1.0 - f)) + b * Lanes4::splat(w * f);
    }
    sum.0
}

/// The function through the samples, linear between and 0 outside. At a jump (two samples at one wavelength) the later.
pub(crate) fn piecewise_linear(samples: &[[f32; 2]], nm: f32) -> f32 {
    let after = samples.partition_point(|s| s[0] <= nm);
    if after == 0 {
        return 0.0;
    }
    let [x0, y0] = samples[after - 1];
    let Some(&[x1, y1]) = samples.get(after) else {
        return if nm == x0 { y0 } else { 0.0 };
    };
    y0 + (y1 - y0) * ((nm - x0) / (x1 - x0))
}

/// Mean of [`piecewise_linear`] over an interval of wavelengths in nm.
fn mean_linear(samples: &[[f32; 2]], from: f32, to: f32) -> f32 {
    let mut integral = 0.0_f64;
    for w in samples.windows(2) {
        let ([x0, y0], [x1, y1]) = (w[0], w[1]);
        let (a, b) = (x0.max(from), x1.min(to));
        if a >= b {
            continue;
        }
        let at = |x: f32| y0 + (y1 - y0) * ((x - x0) / (x1 - x0));
        integral += 0.5 * f64::from(at(a) + at(b)) * f64::from(b - a);
    }
    (integral / f64::from(to - from)) as f32
}
