//! Power laws through measurements.

/// A power law `y = c x^slope`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    /// The exponent.
    pub slope: f64,
    /// The value at x = 1.
    pub factor: f64,
}

impl PowerLaw {
    /// The law through points of positive coordinates, by least squares of the logarithms; `None` for fewer than two
    /// different x.
    #[must_use]
    pub fn fit(points: &[[f64; 2]]) -> Option<Self> {
        let logs: Vec<[f64; 2]> = points.iter().map(|p| p.map(f64::ln)).collect();
        let n = logs.len() as f64;
        let mean = |axis: usize| logs.iter().map(|p| p[axis]).sum::<f64>() / n;
        let (x_mean, y_mean) = (mean(0), mean(1));
        let xx: f64 = logs.iter().map(|[x, _]| (x - x_mean).powi(2)).sum();
        let xy: f64 = logs.iter().map(|[x, y]| (x - x_mean) * (y - y_mean)).sum();
        let slope = xy / xx;
        slope.is_finite().then(|| Self { slope, factor: (y_mean - slope * x_mean).exp() })
    }

    /// Its value.
    #[must_use]
    pub fn at(&self, x: f64) -> f64 {
        self.factor * x.powf(self.slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points on a power law give it back.
    #[test]
    fn power_law_is_recovered() {
        let points: Vec<[f64; 2]> = [1.0, 3.0, 10.0, 700.0].map(|x: f64| [x, 2.5 * x.powf(-0.75)]).into();
        let law = PowerLaw::fit(&points).expect("four points");
        assert!((law.slope + 0.75).abs() < 1e-12 && (law.factor - 2.5).abs() < 1e-12, "{law:?}");
        assert!((law.at(16.0) - 2.5 / 8.0).abs() < 1e-12);
    }

    /// One point, or points above each other, have no slope.
    #[test]
    fn too_few_points_have_no_slope() {
        assert_eq!(PowerLaw::fit(&[[2.0, 3.0]]), None);
        assert_eq!(PowerLaw::fit(&[[2.0, 3.0], [2.0, 5.0]]), None);
        assert_eq!(PowerLaw::fit(&[]), None);
    }
}
