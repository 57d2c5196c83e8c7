//! Volumes and hulls at walls (SPEC EXP-42, EST-5 to EST-7): a floor beside a wall, both evenly lit.
//!
//! A sphere takes photons of the wall where it reaches up, and misses half of the floor: near the wall both errors nearly cancel when
//! both are alike bright, and no longer when they are not. Flat volumes leave the wall out, and darken. The hull corrects the area.

use etendue_math::statistics::Moments;
use etendue_math::{Point3, Rng, Vector3, hash64};
use etendue_transport::photon::estimate::{DensityEstimate, Filter, Volume};
use rayon::prelude::*;

use super::CurveStudy;
use super::field::{Field, Searchable, UP, from_above, place};
use crate::plot::{Axes, Corner, Mark, Panel, Series};

/// Settings of the study.
#[derive(Clone, Debug, PartialEq)]
pub struct WallSettings {
    /// Independent fields.
    pub n_fields: u64,
    /// Photons of an estimate.
    pub k: usize,
    /// Determines all random numbers.
    pub seed: u64,
}

impl WallSettings {
    /// As the documentation shows it.
    #[must_use]
    pub const fn full(seed: u64) -> Self {
        Self { n_fields: 200, k: 100, seed }
    }

    /// A rough version.
    #[must_use]
    pub const fn quick(seed: u64) -> Self {
        Self { n_fields: 20, k: 100, seed }
    }
}

/// Photons per m^2 of the floor.
const DENSITY: f32 = 10_000.0;
const N_STEPS: u32 = 24;
const N_ALONG: u32 = 8;

const WAYS: [(&str, Volume, bool, Filter); 7] = [
    ("sphere", Volume::Sphere, false, Filter::Constant),
    ("disc", Volume::DISC, false, Filter::Constant),
    ("cylinder", Volume::CYLINDER, false, Filter::Constant),
    ("cube", Volume::Cube, false, Filter::Constant),
    ("sphere, hull", Volume::Sphere, true, Filter::Constant),
    ("disc, hull", Volume::DISC, true, Filter::Constant),
    ("disc, hull, cone", Volume::DISC, true, Filter::CONE),
];

/// A floor of the first octant and a wall at x = 0, whose density is that of the floor times `wall`. Light comes from all around.
fn room(wall: f32, rng: &mut Rng) -> Field {
    let mut field = Field::default();
    let n = (0.5 * DENSITY) as usize;
    for _ in 0..n {
        let [x, y] = place(rng, [[0.0, 0.5], [-0.5, 0.5]]);
        field.add(Point3::new(x, y, 0.0), from_above(rng));
    }
    for _ in 0..(n as f32 * wall) as usize {
        let [z, y] = place(rng, [[0.0, 0.5], [-0.5, 0.5]]);
        let Vector3 { x, y: side, z: along } = from_above(rng);
        // The wall's normal is +x.
        field.add(Point3::new(0.0, y, z), Vector3::new(along, side, x));
    }
    field
}

/// Runs the study.
#[must_use]
pub fn walls(settings: &WallSettings) -> CurveStudy {
    let mut summary =
        String::from("irradiance at the wall, and its greatest error anywhere, as shares of the truth\n");
    let panels = [
        (0.0, "an edge: no wall"),
        (1.0, "a wall as bright as the floor"),
        (4.0, "a wall four times as bright"),
    ];
    let panels = panels.map(|(wall, title)| {
        summary += &format!("{title}\n");
        panel(settings, wall, title, &mut summary)
    });
    CurveStudy { panels: panels.into(), summary }
}

fn panel(settings: &WallSettings, wall: f32, title: &str, summary: &mut String) -> Panel {
    let radius = (settings.k as f32 / (std::f32::consts::PI * DENSITY)).sqrt();
    let step = 2.5 * radius / N_STEPS as f32;
    let fields: Vec<Vec<Moments>> = (0..settings.n_fields)
        .into_par_iter()
        .map(|index| {
            let seed = hash64(&[settings.seed, index, u64::from(wall.to_bits())]);
            let field = Searchable::new(room(wall, &mut Rng::new(seed, 0)));
            let at = |estimate: &DensityEstimate, i: u32| -> Moments {
                let y = |j: u32| 0.5 * (j as f32 + 0.5) / N_ALONG as f32 - 0.25;
                let p = |j: u32| Point3::new(i as f32 * step, y(j), 0.0);
                (0..N_ALONG).map(|j| field.density(estimate, (p(j), UP), settings.k)).collect()
            };
            WAYS.iter()
                .flat_map(|&(_, volume, uses_hull, filter)| {
                    let estimate =
                        DensityEstimate { volume, uses_hull, filter, ..DensityEstimate::default() };
                    (0..=N_STEPS).map(move |i| (estimate, i))
                })
                .map(|(estimate, i)| at(&estimate, i))
                .collect()
        })
        .collect();
    let n_places = N_STEPS as usize + 1;
    let mut sums = vec![Moments::default(); WAYS.len() * n_places];
    for field in &fields {
        sums.iter_mut().zip(field).for_each(|(sum, moments)| sum.merge(moments));
    }
    let series = WAYS.iter().zip(sums.chunks(n_places)).map(|((name, ..), profile)| {
        let points: Vec<[f64; 2]> = profile
            .iter()
            .enumerate()
            .map(|(i, m)| [f64::from(i as f32 * step / radius), m.mean() / f64::from(DENSITY)])
            .collect();
        let worst = points.iter().map(|p| (p[1] - 1.0).abs()).fold(0.0, f64::max);
        *summary += &format!("  {name}: {:.3}, {worst:.3}\n", points[0][1]);
        Series { name: (*name).to_owned(), points, mark: Mark::Line }
    });
    let series: Vec<Series> = series.collect();
    Panel {
        title: title.to_owned(),
        x_label: "distance from the wall / radius".to_owned(),
        y_label: "irradiance / truth".to_owned(),
        axes: Axes::Linear([0.0, 2.5]),
        y_range: Some([0.0, 3.0]),
        legend: Corner::UpperRight,
        series,
        ..Panel::default()
    }
}
