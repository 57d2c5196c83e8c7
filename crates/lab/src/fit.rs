//! Lines and power laws through measurements.

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
        let line = Line::fit(&logs)?;
        Some(Self { slope: line.slope, factor: line.offset.exp() })
    }

    /// Its value.
    #[must_use]
    pub fn at(&self, x: f64) -> f64 {
        self.factor * x.powf(self.slope)
    }
}

/// A line `y = offset + slope x`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// The value at x = 0.
    pub offset: f64,
    /// Growth for each unit of x.
    pub slope: f64,
    /// The share of the variance of y that the line explains, in [0, 1].
    pub explained: f64,
}

impl Line {
    /// The line through points by least squares; `None` for fewer than two different x.
    #[must_use]
    pub fn fit(points: &[[f64; 2]]) -> Option<Self> {
        let n = points.len() as f64;
        let mean = |axis: usize| points.iter().map(|p| p[axis]).sum::<f64>() / n;
        let means = [mean(0), mean(1)];
        let moment = |a: usize, b: usize| -> f64 {
            points.iter().map(|p| (p[a] - means[a]) * (p[b] - means[b])).sum()
        };
        let (xx, xy, yy) = (moment(0, 0), moment(0, 1), moment(1, 1));
        let slope = xy / xx;
        let explained = if yy > 0.0 { xy * slope / yy } else { 1.0 };
        slope.is_finite().then(|| Self { offset: means[1] - slope * means[0], slope, explained })
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

    /// A line explains itself, and nothing of what is as often above as below.
    #[test]
    fn lines_explain_what_is_straight() {
        let line = Line::fit(&[[1.0, 5.0], [2.0, 7.0], [4.0, 11.0]]).expect("three points");
        assert!((line.slope - 2.0).abs() < 1e-12 && (line.offset - 3.0).abs() < 1e-12, "{line:?}");
        assert!((line.explained - 1.0).abs() < 1e-12, "{line:?}");
        let zigzag = Line::fit(&[[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]).expect("three points");
        assert!(zigzag.explained.abs() < 1e-12, "{zigzag:?}");
    }
}
