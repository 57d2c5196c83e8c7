//! The picture of an exploration: lobes, curves and histograms in rows of three.

use etendue_image::tonemap::{Operator, apply};

use super::{Curve, Exploration, FresnelCurves, Histogram, Lobe, SHOWN_INCIDENCE_DEG};
use crate::plot::{Axes, Corner, Mark, Palette, Panel, Part, Polar, Series, Wires};

/// Parts of the figure side by side.
pub(super) const N_COLUMNS: usize = 3;

/// All parts of the figure.
pub(super) fn parts(exploration: &Exploration) -> Vec<Part> {
    let scale = LobeScale::of(&exploration.lobes);
    let mut parts: Vec<Part> =
        exploration.lobes.iter().map(|lobe| Part::Polar(polar(lobe, scale, &exploration.lobes))).collect();
    parts.push(Part::Panel(albedo_panel(&exploration.albedo)));
    parts.extend(exploration.fresnel.iter().map(|f| Part::Panel(fresnel_panel(f))));
    parts.extend(exploration.histograms.iter().map(|h| Part::Panel(histogram_panel(h))));
    if !exploration.meridians.is_empty() {
        parts.push(Part::Wires(wires(&exploration.meridians, scale)));
    }
    parts.push(Part::Picture("ball under a lamp".to_owned(), apply(&exploration.ball, Operator::Clamp, 0.0)));
    parts
}

/// How values become radii.
#[derive(Clone, Copy, Debug, PartialEq)]
enum LobeScale {
    Linear,
    /// Cube roots, where a peak would hide the rest.
    CubeRoot,
}

impl LobeScale {
    /// The same for all lobes of a figure: linear if the highest peak is not far above what is spread out.
    fn of(lobes: &[Lobe]) -> Self {
        let is_peaked = |lobe: &Lobe| {
            let mean = lobe.points.iter().map(|p| p[1]).sum::<f64>() / lobe.points.len() as f64;
            peak(lobe) > 12.0 * mean
        };
        if lobes.iter().any(is_peaked) { Self::CubeRoot } else { Self::Linear }
    }

    fn radius(self, share: f64) -> f64 {
        match self {
            Self::Linear => share,
            Self::CubeRoot => share.cbrt(),
        }
    }
}

fn peak(lobe: &Lobe) -> f64 {
    lobe.points.iter().map(|p| p[1]).filter(|f| f.is_finite()).fold(0.0, f64::max)
}

fn polar(lobe: &Lobe, scale: LobeScale, all: &[Lobe]) -> Polar {
    let peak = peak(lobe);
    let points = lobe.points.iter().filter(|_| peak > 0.0);
    let is_below = |p: &[f64; 2]| p[0].abs() > 90.0 && p[1] > 0.0;
    let has_lower_half = all.iter().any(|l| l.points.iter().any(is_below) || l.spikes.iter().any(is_below));
    let what = match scale {
        LobeScale::Linear => "f cos",
        LobeScale::CubeRoot => "root of f cos",
    };
    let range = if peak > 0.0 {
        format!("{what}, up to {peak:.3} / sr")
    } else {
        "mirror directions alone".to_owned()
    };
    let shares = match scale {
        LobeScale::Linear => [0.5, 1.0],
        LobeScale::CubeRoot => [0.125, 1.0],
    };
    let ring = |share: f64| {
        let name = if peak > 0.0 { format!("{:.2}", share * peak) } else { String::new() };
        (scale.radius(share), name)
    };
    Polar {
        title: format!("{:.0}°: {range}", lobe.incidence_deg),
        points: points.map(|[angle, f]| [*angle, scale.radius(f / peak).clamp(0.0, 1.0)]).collect(),
        spikes: lobe
            .spikes
            .iter()
            .map(|[angle, share]| ([*angle, *share], format!("{:.1} %", 100.0 * share)))
            .collect(),
        arrival_deg: -f64::from(lobe.incidence_deg),
        rings: shares.map(ring).into(),
        has_lower_half,
    }
}

/// The lobe in space, seen from the front, a little from the left and from above; light arrives from the left.
fn wires(meridians: &[Vec<[f64; 3]>], scale: LobeScale) -> Wires {
    let (sin_a, cos_a) = 25.0_f64.to_radians().sin_cos();
    let (sin_e, cos_e) = 20.0_f64.to_radians().sin_cos();
    let seen = |[x, y, z]: [f64; 3]| {
        let (right, depth) = (x * cos_a - y * sin_a, x * sin_a + y * cos_a);
        [right, z * cos_e + depth * sin_e]
    };
    let length = |p: &[f64; 3]| p.iter().map(|x| x * x).sum::<f64>().sqrt();
    let peak = meridians.iter().flatten().map(length).filter(|l| l.is_finite()).fold(1e-30, f64::max);
    let scaled = |p: &[f64; 3]| {
        let share = (length(p) / peak).max(1e-30);
        seen(p.map(|x| x / peak * scale.radius(share) / share))
    };
    let angle = f64::from(SHOWN_INCIDENCE_DEG).to_radians();
    let circle = (0..=72).map(|i| (f64::from(i) * 5.0).to_radians()).map(|a| seen([a.cos(), a.sin(), 0.0]));
    Wires {
        title: format!("{SHOWN_INCIDENCE_DEG}°, in space"),
        lines: meridians.iter().map(|line| line.iter().map(scaled).collect()).collect(),
        surface: circle.collect(),
        arrival: vec![seen([-angle.sin(), 0.0, angle.cos()]), [0.0, 0.0]],
    }
}

fn series(curve: &Curve, mark: Mark) -> Series {
    Series { name: curve.name.clone(), points: curve.points.clone(), mark }
}

fn albedo_panel(curves: &[Curve]) -> Panel {
    let highest = curves.iter().flat_map(|c| &c.points).map(|p| p[1]).fold(0.0, f64::max);
    Panel {
        title: "albedo".to_owned(),
        x_label: "angle of incidence in degrees".to_owned(),
        y_label: "share of the flux that leaves".to_owned(),
        y_range: Some([0.0, 1.05_f64.max(1.05 * highest)]),
        axes: Axes::Linear([0.0, 90.0]),
        palette: if curves.len() >= 4 { Palette::Wavelengths } else { Palette::Apart },
        legend: Corner::LowerLeft,
        series: curves.iter().map(|curve| series(curve, Mark::Line)).collect(),
    }
}

fn fresnel_panel(fresnel: &FresnelCurves) -> Panel {
    let &FresnelCurves { place, is_metal, ref curves } = fresnel;
    let series_of = |(i, curve): (usize, &Curve)| match (is_metal, i) {
        (true, 1) => Series { name: "by Schlick's fit".to_owned(), ..series(curve, Mark::DashesAsBefore) },
        (true, i) if i % 2 == 1 => Series { name: String::new(), ..series(curve, Mark::DashesAsBefore) },
        (false, 4) => series(curve, Mark::Dashes),
        (_, i) if i % 2 == 0 => series(curve, Mark::Line),
        _ => series(curve, Mark::DashesAsBefore),
    };
    Panel {
        title: format!("Fresnel reflectance of the {place}, exact and by Schlick's fit"),
        x_label: "angle of incidence in degrees".to_owned(),
        y_label: "share reflected".to_owned(),
        y_range: Some([0.0, 1.02]),
        axes: Axes::Linear([0.0, 90.0]),
        palette: if is_metal { Palette::Wavelengths } else { Palette::Apart },
        legend: if is_metal { Corner::LowerLeft } else { Corner::UpperLeft },
        series: curves.iter().enumerate().map(series_of).collect(),
    }
}

fn histogram_panel(histogram: &Histogram) -> Panel {
    let width = match &histogram.samples.points[..] {
        [first, second, ..] => second[0] - first[0],
        _ => 1.0,
    };
    let steps = |curve: &Curve| -> Vec<[f64; 2]> {
        curve.points.iter().flat_map(|[x, y]| [[x - 0.5 * width, *y], [x + 0.5 * width, *y]]).collect()
    };
    let ends = |curve: &Curve| {
        let x = |point: Option<&[f64; 2]>| point.map_or(0.0, |p| p[0]);
        [x(curve.points.first()) - 0.5 * width, x(curve.points.last()) + 0.5 * width]
    };
    let samples = Series { name: "samples".to_owned(), points: steps(&histogram.samples), mark: Mark::Line };
    Panel {
        title: format!("samples and density at {SHOWN_INCIDENCE_DEG}°: {}", histogram.angle),
        x_label: format!("{} in degrees", histogram.angle),
        y_label: "share per degree".to_owned(),
        axes: Axes::Linear(ends(&histogram.samples)),
        legend: Corner::UpperRight,
        series: vec![samples, series(&histogram.pdf, Mark::Line)],
        ..Panel::default()
    }
}
