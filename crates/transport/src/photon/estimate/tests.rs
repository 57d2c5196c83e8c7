//! The estimate on fields of photons whose density is known.

use etendue_geometry::points::PointTree;
use etendue_math::statistics::{Moments, mean_test};
use etendue_math::{Point3, Rng, Vector3, hash64};
use etendue_spectrum::Xyz;

use super::*;

/// Significance of each test; none of them is run more than a hundred times in the suite.
const SIGNIFICANCE: f64 = 1e-5;

/// Photons of unit power in three lists.
#[derive(Default)]
pub(super) struct Field {
    pub(super) p: Vec<Point3>,
    pub(super) wi: Vec<Vector3>,
    pub(super) power: Vec<f32>,
}

impl Photons for Field {
    fn position(&self, index: u32) -> Point3 {
        self.p[index as usize]
    }
    fn wi(&self, index: u32) -> Vector3 {
        self.wi[index as usize]
    }
    fn power(&self, index: u32) -> Xyz {
        let y = self.power[index as usize];
        Xyz::new(y, y, y)
    }
}

const UP: Vector3 = Vector3::new(0.0, 0.0, 1.0);

impl Field {
    fn add(&mut self, p: Point3, wi: Vector3, power: f32) {
        self.p.push(p);
        self.wi.push(wi);
        self.power.push(power);
    }

    /// Photons on a rectangle of the plane z = 0, from above.
    fn floor(n: usize, x: [f32; 2], y: [f32; 2], rng: &mut Rng) -> Self {
        let mut field = Self::default();
        for _ in 0..n {
            let mut between = |[a, b]: [f32; 2]| a + (b - a) * rng.next_f32();
            field.add(Point3::new(between(x), between(y), 0.0), UP, 1.0);
        }
        field
    }

    /// Irradiance (Y) of the plane z = 0.
    pub(super) fn irradiance(
        &self,
        estimate: &DensityEstimate,
        p: Point3,
        k: usize,
        max_radius: f32,
    ) -> (f32, Density) {
        let mut scratch = EstimateScratch::default();
        let wanted = estimate.search_size(k);
        PointTree::new(&self.p).nearest(p, wanted, max_radius, &mut scratch.found);
        let (xyz, density) = irradiance(estimate, (p, UP), wanted, self, &mut scratch);
        (xyz.y, density)
    }
}

/// The estimate's mean over fields.
fn moments(
    name: &str,
    n_fields: u64,
    estimate: &DensityEstimate,
    (p, k, max_radius): (Point3, usize, f32),
    field: impl Fn(&mut Rng) -> Field,
) -> Moments {
    let mut moments = Moments::default();
    let name = name.bytes().fold(0, |hash, byte| hash64(&[hash, u64::from(byte)]));
    for index in 0..n_fields {
        let field = field(&mut Rng::new(name, index));
        moments.push(f64::from(field.irradiance(estimate, p, k, max_radius).0));
    }
    moments
}

#[track_caller]
fn check_mean(moments: &Moments, expected: f64) {
    mean_test(moments, expected, SIGNIFICANCE).unwrap();
}

const FILTERS: [Filter; 4] = [Filter::Constant, Filter::CONE, Filter::GAUSSIAN, Filter::BOOK_GAUSSIAN];
const VOLUMES: [Volume; 4] = [Volume::Sphere, Volume::DISC, Volume::CYLINDER, Volume::Cube];
const MIDDLE: Point3 = Point3::new(0.0, 0.0, 0.0);

fn square(rng: &mut Rng) -> Field {
    Field::floor(400, [-1.0, 1.0], [-1.0, 1.0], rng)
}

/// 400 photons on 4 m^2: each filter, volume and way to the radius gives 100 per m^2 in the mean.
#[test]
fn uniform_fields_are_exact() {
    for filter in FILTERS {
        for volume in VOLUMES {
            for uses_hull in [false, true] {
                let estimate = DensityEstimate { filter, volume, uses_hull, ..DensityEstimate::default() };
                let scaled = DensityEstimate { farthest: Farthest::Scale, ..estimate };
                for (estimate, k, max_radius) in
                    [(estimate, 25, 10.0), (estimate, 400, 0.3), (scaled, 5, 10.0)]
                {
                    let name = format!("{estimate:?} {k}");
                    let moments = moments(&name, 600, &estimate, (MIDDLE, k, max_radius), square);
                    mean_test(&moments, 100.0, SIGNIFICANCE).unwrap_or_else(|e| panic!("{name}: {e}"));
                }
            }
        }
    }
}

/// The farthest photon may count if the sum is scaled for it; counting it as the book does is too bright by k / (k - 1).
#[test]
fn the_farthest_photon_brightens_by_one_in_k() {
    let with = |farthest, filter| DensityEstimate { farthest, filter, ..DensityEstimate::default() };
    for filter in FILTERS {
        let scale = with(Farthest::Scale, filter);
        check_mean(&moments("scale", 2000, &scale, (MIDDLE, 5, 10.0), square), 100.0);
    }
    let count = with(Farthest::Count, Filter::Constant);
    for k in [2, 5, 20] {
        let expected = 100.0 * k as f64 / (k - 1) as f64;
        let moments = moments("count", 2000, &count, (MIDDLE, k, 10.0), square);
        check_mean(&moments, expected);
        if k > 2 {
            // Mutation: the test would notice if the farthest were forgotten.
            assert!(mean_test(&moments, 100.0, SIGNIFICANCE).is_err());
        }
    }
}

/// A quarter of the disc at the corner of a floor is lit: the book's disc sees a quarter of the light, the hull all of it, at
/// edges too, with every filter.
#[test]
fn hulls_are_exact_beside_straight_walls() {
    let corner = |rng: &mut Rng| Field::floor(400, [0.0, 2.0], [0.0, 2.0], rng);
    for filter in FILTERS {
        let hull = DensityEstimate { filter, uses_hull: true, ..DensityEstimate::default() };
        for p in [MIDDLE, Point3::new(0.0, 1.0, 0.0), Point3::new(0.05, 0.02, 0.0)] {
            let name = format!("hull {filter:?} {p:?}");
            let moments = moments(&name, 600, &hull, (p, 40, 10.0), corner);
            mean_test(&moments, 100.0, SIGNIFICANCE).unwrap_or_else(|e| panic!("{name}: {e}"));
        }
        let disc = DensityEstimate { filter, ..DensityEstimate::default() };
        check_mean(&moments("no hull", 600, &disc, (MIDDLE, 40, 10.0), corner), 25.0);
    }
}

/// What the hull's corners would add if they counted: about `3.4 n^(-2/3)` too much, as Jensen's area would.
#[test]
fn corners_of_hulls_must_not_count() {
    let hull = DensityEstimate { uses_hull: true, ..DensityEstimate::default() };
    let mut counted = Moments::default();
    for index in 0..300 {
        let field = square(&mut Rng::new(11, index));
        let (_, density) = field.irradiance(&hull, MIDDLE, 50, 10.0);
        counted.push(50.0 * f64::from(density.per_area));
    }
    let expected = 100.0 / (1.0 - 3.383 * 50_f64.powf(-2.0 / 3.0));
    assert!((counted.mean() - expected).abs() < 0.05 * expected, "{} {expected}", counted.mean());
}

/// A floor of 100 photons per m² beside a wall of 300: the sphere takes photons of the wall, flat volumes do not.
#[test]
fn flat_volumes_leave_walls_out() {
    let room = |rng: &mut Rng| {
        let mut field = Field::floor(400, [0.0, 2.0], [-1.0, 1.0], rng);
        let wall = Field::floor(1200, [0.0, 2.0], [-1.0, 1.0], rng);
        for p in wall.p {
            // From above: a light in the ceiling.
            field.add(Point3::new(0.0, p.y, p.x), Vector3::new(0.6, 0.0, 0.8), 1.0);
        }
        field
    };
    let p = Point3::new(0.1, 0.0, 0.0);
    let mean = |volume| {
        let estimate = DensityEstimate { volume, uses_hull: true, ..DensityEstimate::default() };
        moments(&format!("{volume:?}"), 600, &estimate, (p, 150, 10.0), room)
    };
    // The lowest photons of the wall are in flat volumes too: a strip of a tenth of the radius.
    for (volume, share) in [(Volume::DISC, 0.25), (Volume::CYLINDER, 0.4)] {
        let moments = mean(volume);
        let excess = moments.mean() / 100.0 - 1.0;
        assert!(excess > -0.05 && excess < share, "{volume:?}: {}", moments.mean());
    }
    assert!(mean(Volume::Sphere).mean() > 200.0);
}

/// Photons from below do not light the upper side.
#[test]
fn only_the_right_side_counts() {
    let both = |rng: &mut Rng| {
        let mut field = square(rng);
        for i in 0..field.wi.len() {
            if i % 4 == 0 {
                field.wi[i] = -UP;
            }
        }
        field
    };
    for uses_hull in [false, true] {
        let estimate = DensityEstimate { uses_hull, ..DensityEstimate::default() };
        check_mean(&moments("side", 600, &estimate, (MIDDLE, 40, 10.0), both), 75.0);
    }
}

/// EST-4: with k = sqrt(N) the error falls as `k^(-1/2) = N^(-1/4)`: the estimate counts k photons of a Poisson field, whose
/// relative variance is `1 / (k - 1)`.
#[test]
fn estimates_are_consistent() {
    for (n, k, n_fields) in [(400, 20, 800), (40_000, 200, 100)] {
        let estimate = DensityEstimate::default();
        let field = |rng: &mut Rng| Field::floor(n, [-1.0, 1.0], [-1.0, 1.0], rng);
        let moments = moments("consistent", n_fields, &estimate, (MIDDLE, k, 10.0), field);
        let density = n as f64 / 4.0;
        check_mean(&moments, density);
        let expected = density / ((k - 1) as f64).sqrt();
        // A standard deviation of so many values is known to 1 / sqrt(2 n).
        let tolerance = 5.0 / (2.0 * n_fields as f64).sqrt();
        let ratio = moments.standard_deviation() / expected;
        assert!((ratio - 1.0).abs() < tolerance, "{n}: {ratio}");
    }
}

/// Where photons keep one density the estimate goes up and down; where the density halves, as beyond an edge, it falls with each
/// photon, and so many photons later the radius is taken.
#[test]
fn differential_checking_notices_drift() {
    let photons = |edge: u32| -> Vec<(f32, f32)> {
        let place = |i: u32| 0.01 * (i.min(edge) + 2 * i.saturating_sub(edge)) as f32;
        (1..200)
            .map(|i| (place(i) + if i < edge { [0.004, -0.004][i as usize % 2] } else { 0.0 }, 1.0))
            .collect()
    };
    for run in [3, 10] {
        let checking = DifferentialChecking { min_photons: 8, run };
        assert_eq!(checking::drift_radius_squared(checking, &photons(200)), None);
        let radius_squared = checking::drift_radius_squared(checking, &photons(100)).unwrap();
        let n_beyond = (radius_squared - 1.0) / 0.02;
        assert!((n_beyond - run as f32).abs() < 2.0, "{n_beyond}");
    }
    // Nothing is concluded from the first photons.
    let checking = DifferentialChecking { min_photons: 150, run: 3 };
    assert!(checking::drift_radius_squared(checking, &photons(100)).unwrap() > 1.0 + 50.0 * 0.02);
}

/// Of half a floor, checked estimates beside the edge see more than others do.
#[test]
fn differential_checking_helps_at_edges() {
    let half = |rng: &mut Rng| Field::floor(2000, [0.0, 2.0], [-1.0, 1.0], rng);
    let p = Point3::new(0.1, 0.0, 0.0);
    let checking = Some(DifferentialChecking { min_photons: 8, run: 6 });
    let plain = moments("plain", 300, &DensityEstimate::default(), (p, 200, 10.0), half);
    let checked = DensityEstimate { checking, ..DensityEstimate::default() };
    let checked = moments("checked", 300, &checked, (p, 200, 10.0), half);
    assert!(checked.mean() > 1.1 * plain.mean(), "{} {}", checked.mean(), plain.mean());
}

/// No photon, one photon, all at one point, more wanted than there are, photons that are nowhere: finite, not negative.
#[test]
fn odd_fields_give_numbers() {
    let at = |points: &[Point3]| {
        let mut field = Field::default();
        points.iter().for_each(|p| field.add(*p, UP, 1.0));
        field
    };
    let far = Point3::new(1e6, -1e6, 3e5);
    let fields = [
        at(&[]),
        at(&[MIDDLE]),
        at(&[MIDDLE; 30]),
        at(&[far; 30]),
        at(&[Point3::new(0.0, f32::NAN, 0.0), Point3::new(f32::INFINITY, 0.0, 0.0)]),
        at(&[Point3::new(1e-30, 0.0, 0.0), Point3::new(0.0, 1e-30, 0.0), Point3::new(1e30, 1.0, 0.0)]),
        at(&[0.1, 0.2, 0.3, 0.4, 0.5].map(|x| Point3::new(x, 0.0, 0.0))),
    ];
    let checkings = [None, Some(DifferentialChecking { min_photons: 0, run: 1 })];
    for field in &fields {
        for filter in FILTERS {
            for volume in VOLUMES {
                for farthest in [Farthest::LeaveOut, Farthest::Scale, Farthest::Count] {
                    for (uses_hull, checking) in [false, true].into_iter().zip(checkings) {
                        let estimate =
                            DensityEstimate { filter, volume, farthest, uses_hull, checking, min_photons: 0 };
                        for p in [MIDDLE, far] {
                            for (k, radius) in
                                [(0, 1.0), (1, 0.0), (1, 1.0), (50, 1e-20), (50, f32::INFINITY)]
                            {
                                let (value, density) = field.irradiance(&estimate, p, k, radius);
                                assert!(
                                    value >= 0.0 && value.is_finite(),
                                    "{estimate:?} at {p:?} with {k}, {radius}: {value} {density:?}"
                                );
                            }
                        }
                    }
                }
            }
        }
    }
}

/// All photons at one point: bright, and the same however many more are looked for.
#[test]
fn a_point_of_photons_is_bright_and_finite() {
    let mut field = Field::default();
    (0..30).for_each(|_| field.add(Point3::new(1.0, 0.0, 0.0), UP, 1.0));
    let (value, density) = field.irradiance(&DensityEstimate::default(), Point3::new(1.0, 0.0, 0.0), 29, 1.0);
    assert!(value > 1e9 && value.is_finite());
    assert_eq!(density.n_photons, 30);
}

/// With fewer photons than asked for at least, it is dark.
#[test]
fn a_least_number_of_photons() {
    let field = square(&mut Rng::new(5, 5));
    for (min_photons, is_dark) in [(30, false), (31, true)] {
        let estimate = DensityEstimate { min_photons, ..DensityEstimate::default() };
        assert_eq!(field.irradiance(&estimate, MIDDLE, 30, 10.0).0 == 0.0, is_dark);
    }
}

/// The filters' means are their integrals, and Pavičić's alpha makes his integral 1 over the unit disc: `alpha pi mean = 1`.
#[test]
fn filters_know_their_means() {
    for filter in FILTERS {
        for t_squared in [0.003_f32, 0.3, 1.0] {
            let n = 20_000;
            let sum: f64 =
                (0..n).map(|i| f64::from(filter.weight(t_squared * (i as f32 + 0.5) / n as f32))).sum();
            let mean = f64::from(filter.mean(t_squared));
            assert!((sum / f64::from(n) - mean).abs() < 3e-5, "{filter:?} {t_squared}: {mean}");
        }
    }
    let alpha = 0.918;
    assert!((alpha * std::f32::consts::PI * Filter::GAUSSIAN.mean(1.0) - 1.0).abs() < 2e-3);
    assert!((alpha * Filter::BOOK_GAUSSIAN.mean(1.0) - 0.5312).abs() < 1e-3);
    assert!(Filter::GAUSSIAN.weight(1.0).abs() < 1e-6);
}

/// Areas of hulls, and integrals of filters over them wherever the middle is.
#[test]
fn integrals_over_hulls() {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.5], [0.5, 0.0]];
    for shift in [0.0, -0.5, 0.7] {
        let mut photons: Vec<PlanePhoton> = (0..)
            .zip(square)
            .map(|(index, [x, y])| PlanePhoton {
                p: Point2::new(x + shift, y + shift),
                index,
                distance_squared: 0.0,
                is_corner: false,
            })
            .collect();
        let mut corners = Vec::new();
        hull::mark_corners(&mut photons, &mut corners);
        assert_eq!(corners.len(), 4);
        for filter in FILTERS {
            let n = 200;
            let at = |i: i32| shift + (i as f32 + 0.5) / n as f32;
            let weight = |i: i32| filter.weight((at(i / n).powi(2) + at(i % n).powi(2)) / 4.0);
            let expected = (0..n * n).map(|i| f64::from(weight(i))).sum::<f64>() / f64::from(n * n);
            let integral = f64::from(hull::integral(&photons, &corners, (filter, Volume::Sphere), 4.0));
            assert!((integral / expected - 1.0).abs() < 4e-3, "{filter:?} {shift}: {integral} {expected}");
        }
    }
}

/// A histogram's cells have flux over area, and cells that no photon met are black.
#[test]
fn histograms_count_flux() {
    let mut histogram = histogram::FluxHistogram::new([0.5, 2.0, 0.0]);
    histogram.add(0, Xyz::new(1.0, 2.0, 3.0));
    histogram.add(0, Xyz::new(1.0, 2.0, 3.0));
    histogram.add(2, Xyz::new(1.0, 1.0, 1.0));
    histogram.add(7, Xyz::new(1.0, 1.0, 1.0));
    assert_eq!(histogram.irradiance(0), Xyz::new(4.0, 8.0, 12.0));
    assert_eq!([1, 2, 7].map(|cell| histogram.irradiance(cell)), [Xyz::default(); 3]);
    assert_eq!((histogram.len(), histogram.n_black()), (3, 1));
}

mod surfaces {
    use etendue_math::Normal3;
    use etendue_math::statistics::Moments;
    use etendue_scene::bsdf::{
        Bsdf, BsdfKind, Diffuse, DiffuseTransmission, Lobes, TransportMode, catalogue,
    };
    use etendue_spectrum::{N_LAMBDA, Sampled, Wavelengths, lift};

    use super::*;

    fn estimate_of(bsdf: &Bsdf, field: &Field, wo: Vector3) -> (Sampled, Wavelengths, Density) {
        let estimate = DensityEstimate::default();
        let mut scratch = EstimateScratch::default();
        let wanted = estimate.search_size(100);
        PointTree::new(&field.p).nearest(MIDDLE, wanted, 10.0, &mut scratch.found);
        let lambda = Wavelengths::sample_visible(0.37);
        let place = radiance::LitPlace { p: MIDDLE, wo, bsdf, lobes: Lobes::ALL, lambda: &lambda };
        let found = super::super::radiance(&estimate, &place, wanted, field, &mut scratch);
        (found.radiance, lambda, found.density)
    }

    /// Means over places so near to each other that the photons around are the same, and their standard errors.
    fn mean_estimate_of(bsdf: &Bsdf, field: &Field, wo: Vector3) -> [Moments; N_LAMBDA] {
        let estimate = DensityEstimate::default();
        let mut scratch = EstimateScratch::default();
        let wanted = estimate.search_size(100);
        PointTree::new(&field.p).nearest(MIDDLE, wanted, 10.0, &mut scratch.found);
        let lambda = Wavelengths::sample_visible(0.37);
        let mut means = [Moments::new(); N_LAMBDA];
        for i in 0..2000 {
            let p = MIDDLE + Vector3::new(i as f32 * 1e-8, 0.0, 0.0);
            let place = radiance::LitPlace { p, wo, bsdf, lobes: Lobes::ALL, lambda: &lambda };
            let found = super::super::radiance(&estimate, &place, wanted, field, &mut scratch).radiance;
            means.iter_mut().zip(found.to_array()).for_each(|(mean, value)| mean.push(f64::from(value)));
        }
        means
    }

    /// Photons from all directions above; a third of them from below.
    fn field() -> Field {
        let mut rng = Rng::new(3, 3);
        let mut field = Field::floor(1000, [-1.0, 1.0], [-1.0, 1.0], &mut rng);
        for (i, wi) in field.wi.iter_mut().enumerate() {
            let z = (1.0 - rng.next_f32()) * if i % 3 == 0 { -1.0 } else { 1.0 };
            let (y, x) = (std::f32::consts::TAU * rng.next_f32()).sin_cos();
            let r = (1.0 - z * z).max(0.0).sqrt();
            *wi = Vector3::new(r * x, r * y, z);
        }
        field
    }

    /// `L = sum f Φ / A`, photon by photon.
    fn direct_sum(
        bsdf: &Bsdf,
        field: &Field,
        wo: Vector3,
        lambda: &Wavelengths,
        density: Density,
    ) -> Sampled {
        let mut sum = Sampled::ZERO;
        for (p, wi) in field.p.iter().zip(&field.wi) {
            if p.distance_squared(MIDDLE) < density.radius * density.radius * (1.0 - 1e-5) {
                let f = bsdf.eval(wo, *wi, TransportMode::Radiance, Lobes::NON_SPECULAR);
                let is_bent = bsdf.ns() != bsdf.ng();
                let stretch = bsdf.abs_cos(*wi) / wi.dot(bsdf.ng().as_vector()).abs().max(0.02);
                let stretch = if is_bent { stretch } else { 1.0 };
                sum += f * lift(Xyz::new(1.0, 1.0, 1.0), lambda) * stretch;
            }
        }
        sum * density.per_area
    }

    /// Each model of the catalogue, seen from above and from below, with and without a bent shading normal: photons of one colour give just the sum of
    /// the definition; in the mean where some of them stand for all.
    #[test]
    fn all_models_give_the_sum_of_the_definition() {
        let field = field();
        let ng = Normal3::new(0.0, 0.0, 1.0);
        let bent = Normal3::new(0.28, 0.0, 0.96);
        for line in catalogue::catalogue() {
            for ns in [ng, bent] {
                for wo in [Vector3::new(0.6, 0.0, 0.8), Vector3::new(0.0, 0.6, -0.8)] {
                    let bsdf = Bsdf::new(ns, ng, Vector3::new(1.0, 0.0, 0.0), line.kind);
                    let (radiance, lambda, density) = estimate_of(&bsdf, &field, wo);
                    let expected = direct_sum(&bsdf, &field, wo, &lambda, density);
                    if matches!(bsdf.kind(), BsdfKind::Layered(_)) {
                        // Some photons stand for all, and coats are followed by random walks, which differ from lobe to lobe.
                        let means = mean_estimate_of(&bsdf, &field, wo);
                        for (mean, b) in means.iter().zip(expected.to_array().map(f64::from)) {
                            let tolerance = 0.05 * b.abs().max(1e-3) + 5.0 * mean.standard_error();
                            let a = mean.mean();
                            let is_sharp = tolerance < 0.5 * b.abs().max(1e-2);
                            assert!(
                                (a - b).abs() <= tolerance && is_sharp,
                                "{}: {a} {b} {tolerance}",
                                line.name
                            );
                        }
                        continue;
                    }
                    for (a, b) in radiance.to_array().into_iter().zip(expected.to_array()) {
                        assert!((a - b).abs() <= 1e-3 * b.abs().max(1e-3), "{}: {a} {b}", line.name);
                    }
                }
            }
        }
    }

    /// A diffuse surface in uniform light of irradiance E: `rho E / pi` on each side that it scatters from.
    #[test]
    fn diffuse_surfaces_reflect_irradiance() {
        let mut rng = Rng::new(4, 4);
        let mut field = Field::floor(100_000, [-1.0, 1.0], [-1.0, 1.0], &mut rng);
        field.wi.iter_mut().step_by(5).for_each(|wi| *wi = -UP);
        let (rho, tau) = (Sampled::splat(0.5), Sampled::splat(0.3));
        let both =
            BsdfKind::DiffuseTransmission(DiffuseTransmission { reflectance: rho, transmittance: tau });
        let ng = Normal3::new(0.0, 0.0, 1.0);
        for (kind, share) in
            [(BsdfKind::Diffuse(Diffuse { reflectance: rho }), 0.5 * 0.8), (both, 0.5 * 0.8 + 0.3 * 0.2)]
        {
            let bsdf = Bsdf::isotropic(ng, ng, kind);
            let (radiance, lambda, _) = estimate_of(&bsdf, &field, Vector3::new(0.0, 0.6, 0.8));
            let expected = lift(Xyz::new(1.0, 1.0, 1.0), &lambda) * (25_000.0 * share / std::f32::consts::PI);
            let ratio = radiance[0] / expected[0];
            // 100 photons: five standard errors.
            assert!((ratio - 1.0).abs() < 0.5, "{ratio}");
        }
    }
}
