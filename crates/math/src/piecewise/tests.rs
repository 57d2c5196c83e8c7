//! Tabulated densities: integrals, inversion, chi-square.

use super::*;
use crate::statistics::{interval_chi_square, square_chi_square};
use crate::{Bounds2, Point2, Rng};

const UNIT: Bounds2 = Bounds2 { min: Point2::new(0.0, 0.0), max: Point2::new(1.0, 1.0) };

fn numbers(n: usize) -> impl Iterator<Item = f32> {
    (0..n).map(move |i| i as f32 / n as f32)
}

/// MC-7: the integral of |f| is the sum over the cells, and signs do not matter.
#[test]
fn integral_is_the_sum_over_cells() {
    let d = PiecewiseConstant1::new(&[1.0, -2.0, 3.0, 0.0], -1.0, 3.0);
    assert_eq!(d.integral(), 6.0);
    assert_eq!(d.pdf(-0.5), 1.0 / 6.0);
    assert_eq!(d.pdf(0.5), 2.0 / 6.0);
    assert_eq!(d.pdf(3.0), 0.0);
    assert_eq!(d.pdf(3.1), 0.0);
    assert_eq!(d.pdf(f32::NAN), 0.0);
}

/// MC-7: sampling inverts the distribution function, and `invert` inverts sampling.
#[test]
fn one_dimension_round_trips() {
    let d = PiecewiseConstant1::new(&[0.0, 1.0, 0.0, 0.0, 4.0, 2.0, 0.0], 2.0, 9.0);
    for u in numbers(1000) {
        let (x, pdf, offset) = d.sample(u);
        assert!(pdf > 0.0, "u {u} lands in an empty cell {offset}");
        assert!((2.0..9.0).contains(&x));
        let back = d.invert(x).unwrap();
        assert!((back - u).abs() < 1e-6, "{u} came back as {back}");
    }
    assert_eq!(d.invert(1.9), None);
    // A number of exactly 0 or the largest below 1 does not reach cells without density.
    assert_eq!(d.sample(0.0).2, 1);
    assert_eq!(d.sample(crate::ONE_MINUS_EPSILON).2, 5);
}

/// MC-7: samples have the density of the table.
#[test]
fn one_dimension_passes_chi_square() {
    let d = PiecewiseConstant1::new(&[3.0, 1.0, 0.0, 0.5], 0.0, 2.0);
    interval_chi_square(100_000, 1, [0.0, 2.0], |rng| Some(d.sample(rng.next_f32()).0), |x| d.pdf(x), 1e-4)
        .unwrap();
}

/// A function of 0 has samples, but no density.
#[test]
fn nothing_is_sampled_with_density_zero() {
    let d = PiecewiseConstant1::new(&[0.0, 0.0], 0.0, 1.0);
    assert_eq!(d.sample(0.75), (0.75, 0.0, 1));
    let d = PiecewiseConstant2::new(&[0.0; 4], 2, 2, UNIT);
    assert_eq!(d.sample(Point2::new(0.25, 0.75)), (Point2::new(0.25, 0.75), 0.0));
}

fn sky(nx: usize, ny: usize) -> Vec<f32> {
    let mut rng = Rng::new(3, 3);
    let mut func: Vec<f32> = (0..nx * ny).map(|_| rng.next_f32() * rng.next_f32()).collect();
    func[nx + 1] = 20.0;
    func[2 * nx..3 * nx].fill(0.0);
    func
}

/// MC-7 in two dimensions: density of samples, their round trip, and a bright spot where rows and columns differ.
#[test]
fn two_dimensions_match_the_table() {
    let (nx, ny) = (8, 5);
    let func = sky(nx, ny);
    let domain = Bounds2::new(Point2::new(-1.0, 2.0), Point2::new(3.0, 4.0));
    let d = PiecewiseConstant2::new(&func, nx, ny, domain);
    assert_eq!(d.resolution(), [8, 5]);
    let total = func.iter().sum::<f32>() * domain.area() / 40.0;
    assert!((d.integral() / total - 1.0).abs() < 1e-6);
    let value = func[4 * nx + 3] / total;
    assert!((d.pdf(Point2::new(-1.0 + 3.5 * 0.5, 2.0 + 4.5 * 0.4)) / value - 1.0).abs() < 1e-5);
    assert_eq!(d.pdf(Point2::new(3.5, 3.0)), 0.0);
    let mut rng = Rng::new(4, 4);
    for _ in 0..2000 {
        let u = rng.next_point2();
        let (p, pdf) = d.sample(u);
        assert!((pdf / d.pdf(p) - 1.0).abs() < 1e-5);
        let back = d.invert(p).unwrap();
        // Narrow shares of dark cells lose digits in the distribution function.
        assert!((back - u).length() < 1e-4, "{u:?} came back as {back:?}");
    }
    let unit = PiecewiseConstant2::new(&func, nx, ny, UNIT);
    square_chi_square(100_000, 2, |rng| Some(unit.sample(rng.next_point2()).0), |p| unit.pdf(p), 1e-4)
        .unwrap();
}

/// Through a window that is the whole domain one sees the whole; through a part, the density of the part.
#[test]
fn windows_restrict_and_renormalise() {
    let (nx, ny) = (8, 5);
    let func = sky(nx, ny);
    let whole = PiecewiseConstant2::new(&func, nx, ny, UNIT);
    let d = WindowedPiecewiseConstant2::new(&func, nx, ny, UNIT);
    let mut rng = Rng::new(5, 5);
    for _ in 0..1000 {
        let p = rng.next_point2();
        assert!((d.pdf(p, UNIT) - whole.pdf(p)).abs() <= 1e-4 * whole.pdf(p));
    }
    for window in [
        UNIT,
        Bounds2::new(Point2::new(0.1, 0.15), Point2::new(0.77, 0.93)),
        Bounds2::new(Point2::new(0.3, 0.1), Point2::new(0.31, 0.9)),
        Bounds2::new(Point2::new(0.02, 0.62), Point2::new(0.1, 0.7)),
        Bounds2::new(Point2::new(0.05, -3.0), Point2::new(2.0, 0.41)),
    ] {
        let check = |scale: f32| {
            square_chi_square(
                100_000,
                6,
                |rng| {
                    let (p, pdf) = d.sample(rng.next_point2(), window)?;
                    assert!((pdf / d.pdf(p, window) - 1.0).abs() < 1e-4, "at {p:?}");
                    Some(p)
                },
                |p| scale * d.pdf(p, window),
                1e-4,
            )
        };
        check(1.0).unwrap_or_else(|error| panic!("{window:?}: {error}"));
        assert!(check(0.95).is_err());
    }
}

/// Behind a dark window nothing is found, and a window outside holds nothing.
#[test]
fn dark_windows_give_nothing() {
    let d = WindowedPiecewiseConstant2::new(&sky(8, 5), 8, 5, UNIT);
    let dark = Bounds2::new(Point2::new(0.1, 0.41), Point2::new(0.9, 0.59));
    assert_eq!(d.sample(Point2::new(0.5, 0.5), dark), None);
    assert_eq!(d.pdf(Point2::new(0.5, 0.5), dark), 0.0);
    assert_eq!(d.window_integral(dark), 0.0);
    let outside = Bounds2::new(Point2::new(2.0, 0.0), Point2::new(3.0, 1.0));
    assert_eq!(d.sample(Point2::new(0.5, 0.5), outside), None);
}

/// The guided search finds the cell that a search from the start would, however uneven the density.
#[test]
fn cells_are_found_by_guide() {
    let mut rng = Rng::new(7, 0);
    for n in [1, 2, 3, 100, 777] {
        let func: Vec<f32> = (0..n).map(|_| (rng.next_f32() * 8.0 - 4.0).max(0.0).powi(12)).collect();
        let d = PiecewiseConstant1::new(&func, 0.0, n as f32);
        let steps = (0..n).map(|i| i as f32 / n as f32);
        for u in steps.chain((0..2000).map(|_| rng.next_f32())).collect::<Vec<f32>>() {
            let cell = d.sample(u).2;
            let share = |c: usize| d.invert(c as f32).expect("within the interval");
            assert!(
                share(cell) <= u && (cell + 1 == n || u < share(cell + 1)),
                "{n} cells: {u} is not in {cell}"
            );
        }
    }
}
