//! Tests of pixel filters.

use etendue_math::statistics::{Moments, mean_test, square_chi_square};
use etendue_math::{Point2, Rng, Vector2, hash64};

use super::{FILTERS, Filter, FilterKind};
use crate::assets::Assets;
use crate::document::{Entity, Value};
use crate::parameters::{BuildContext, Parameters};

const ALL: [FilterKind; 5] = [
    FilterKind::Box,
    FilterKind::Triangle,
    FilterKind::Gaussian { sigma: 0.5 },
    FilterKind::Mitchell { b: 1.0 / 3.0, c: 1.0 / 3.0 },
    FilterKind::LanczosSinc { tau: 3.0 },
];
/// Significance of one test: 1e-3 split over about 100.
const SIGNIFICANCE: f64 = 1e-5;

fn with_default_radius(kind: FilterKind) -> Filter {
    Filter::new(kind, Vector2::splat(kind.default_radius())).unwrap()
}

/// Different radii, so that an exchange of axes shows.
fn lopsided(kind: FilterKind) -> Filter {
    Filter::new(kind, Vector2::new(kind.default_radius(), 0.75 * kind.default_radius())).unwrap()
}

fn read(entity: &Entity) -> (Filter, usize) {
    let assets = Assets::default();
    let mut context = BuildContext::new(&assets);
    let mut parameters = Parameters::new(entity, &mut context);
    let filter = Filter::from_parameters(&mut parameters);
    parameters.finish();
    (filter, context.diagnostics.list().len())
}

/// Midpoint rule over the support.
fn quadrature(filter: &Filter, f: impl Fn(Vector2, f64) -> f64) -> f64 {
    const N: usize = 600;
    let r = filter.radius();
    let at = |i: usize, radius: f32| radius * (2.0 * (i as f32 + 0.5) / N as f32 - 1.0);
    let cell = 4.0 * f64::from(r.x) * f64::from(r.y) / (N * N) as f64;
    let mut sum = 0.0;
    for i in 0..N {
        for j in 0..N {
            let offset = Vector2::new(at(i, r.x), at(j, r.y));
            sum += f(offset, f64::from(filter.eval(offset))) * cell;
        }
    }
    sum
}

/// A pixel is a mean of radiance: its weights average to 1, so that a uniform image keeps its value (CAM-5).
#[test]
fn weights_average_to_one() {
    for (i, kind) in ALL.into_iter().enumerate() {
        let filter = lopsided(kind);
        let mut rng = Rng::new(hash64(&[i as u64]), 1);
        let weights: Moments =
            (0..100_000).map(|_| f64::from(filter.sample(rng.next_point2()).weight)).collect();
        mean_test(&weights, 1.0, SIGNIFICANCE).unwrap();
    }
}

/// Filters without negative lobes add no noise: each sample counts the same.
#[test]
fn positive_filters_have_constant_weight() {
    let mut rng = Rng::new(7, 2);
    for kind in &ALL[..3] {
        let filter = with_default_radius(*kind);
        for _ in 0..1000 {
            let weight = filter.sample(rng.next_point2()).weight;
            assert!((weight - 1.0).abs() < 1e-5, "{kind:?}: {weight}");
        }
    }
}

/// In negative lobes light is taken away: the sign of a sample's weight is that of the filter where it fell.
#[test]
fn weights_have_the_sign_of_the_filter() {
    let mut rng = Rng::new(8, 3);
    for kind in &ALL[3..] {
        let filter = with_default_radius(*kind);
        let mut n_negative = 0;
        for _ in 0..20_000 {
            let sample = filter.sample(rng.next_point2());
            let value = filter.eval(sample.offset);
            n_negative += usize::from(sample.weight < 0.0);
            // Cells that hold a change of sign are narrower than what this leaves out.
            assert!(value * sample.weight >= -1e-2, "{kind:?} at {:?}: {value}", sample.offset);
        }
        assert!(n_negative > 1000, "{kind:?} has negative lobes");
    }
}

/// The integral that weights are divided by is that of the filter itself.
#[test]
fn integral_matches_quadrature() {
    for kind in ALL {
        let filter = lopsided(kind);
        let expected = quadrature(&filter, |_, f| f);
        let found = f64::from(filter.integral());
        assert!((found / expected - 1.0).abs() < 2e-3, "{kind:?}: {found} but {expected}");
    }
}

/// Samples fall where the filter is large: their density is proportional to its absolute value.
#[test]
fn samples_follow_the_absolute_filter() {
    for (i, kind) in ALL.into_iter().enumerate() {
        let filter = lopsided(kind);
        let r = filter.radius();
        let total = quadrature(&filter, |_, f| f.abs());
        let unit = |offset: Vector2| Point2::new(0.5 + offset.x / (2.0 * r.x), 0.5 + offset.y / (2.0 * r.y));
        let offset = |p: Point2| Vector2::new((2.0 * p.x - 1.0) * r.x, (2.0 * p.y - 1.0) * r.y);
        let density = |p: Point2| filter.eval(offset(p)).abs() * 4.0 * r.x * r.y / total as f32;
        let sample = |rng: &mut Rng| Some(unit(filter.sample(rng.next_point2()).offset));
        square_chi_square(100_000, hash64(&[10, i as u64]), sample, density, SIGNIFICANCE)
            .unwrap_or_else(|message| panic!("{kind:?}: {message}"));
    }
}

/// The width of a filter decides how much an edge is blurred: weighted second moments agree with quadrature.
#[test]
fn second_moments_agree() {
    for (i, kind) in ALL.into_iter().enumerate() {
        let filter = lopsided(kind);
        for axis in 0..2 {
            let square = |v: Vector2| f64::from(v[axis]) * f64::from(v[axis]);
            let expected = quadrature(&filter, |v, f| f * square(v)) / quadrature(&filter, |_, f| f);
            let mut rng = Rng::new(hash64(&[20, i as u64]), axis as u64);
            let moments: Moments = (0..200_000)
                .map(|_| {
                    let sample = filter.sample(rng.next_point2());
                    f64::from(sample.weight) * square(sample.offset)
                })
                .collect();
            mean_test(&moments, expected, SIGNIFICANCE)
                .unwrap_or_else(|message| panic!("{kind:?}: {message}"));
        }
    }
}

/// An edge through the middle of a pixel gives half of the step between its sides (CAM-5).
#[test]
fn edge_covers_half_of_a_pixel() {
    for (i, kind) in ALL.into_iter().enumerate() {
        let filter = with_default_radius(kind);
        let mut rng = Rng::new(hash64(&[30, i as u64]), 0);
        let covered: Moments = (0..100_000)
            .map(|_| {
                let sample = filter.sample(rng.next_point2());
                if sample.offset.x < 0.0 { f64::from(sample.weight) } else { 0.0 }
            })
            .collect();
        mean_test(&covered, 0.5, SIGNIFICANCE).unwrap();
    }
}

/// Mitchell's cubics shifted by whole pixels add up to 1: a constant image passes unchanged without normalisation.
#[test]
fn mitchell_is_a_partition_of_unity() {
    for (b, c) in [(1.0 / 3.0, 1.0 / 3.0), (0.0, 0.5), (1.0, 0.0)] {
        let kind = FilterKind::Mitchell { b, c };
        for step in 0..10 {
            let x = f64::from(step) / 10.0;
            let sum: f64 = (-3..=3).map(|shift| kind.profile(x + f64::from(shift), 2.0)).sum();
            assert!((sum - 1.0).abs() < 1e-9, "b = {b}, c = {c}, x = {x}: {sum}");
        }
    }
}

/// A scene that names only the filter gets pbrt-v4's radii.
#[test]
fn defaults_are_those_of_pbrt() {
    for (name, radius) in
        [("box", 0.5), ("triangle", 2.0), ("gaussian", 1.5), ("mitchell", 2.0), ("sinc", 4.0)]
    {
        let (filter, n_problems) = read(&Entity::new(name));
        assert_eq!(filter.radius(), Vector2::splat(radius), "{name}");
        assert_eq!(n_problems, 0, "{name}");
        assert!(FILTERS.iter().any(|(known, _)| *known == name));
    }
    assert_eq!(read(&Entity::new("gaussian")).0.kind(), Filter::default().kind());
}

/// A mistyped filter is reported, not silently replaced.
#[test]
fn problems_are_reported() {
    assert_eq!(read(&Entity::new("gausian")).1, 1);
    assert_eq!(read(&Entity::new("box").with("xradius", Value::Floats(vec![-1.0]))).1, 1);
    assert_eq!(read(&Entity::new("gaussian").with("sigma", Value::Floats(vec![0.7]))).1, 0);
    assert_eq!(read(&Entity::new("gaussian").with("sygma", Value::Floats(vec![0.7]))).1, 1);
}
