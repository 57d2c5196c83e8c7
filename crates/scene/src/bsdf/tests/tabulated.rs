//! Tables of BRDFs: what they give back, and how well they are sampled.

use etendue_spectrum::Wavelengths;

use super::*;
use crate::bsdf::classic::{Phong, PhongForm};
use crate::bsdf::laws::albedo;
use crate::bsdf::tabulated::{BrdfGrid, BrdfTable, TableSampling, Tabulated};

const UP: Lobes = Lobes::ALL;

fn radiance(kind: &BsdfKind, wo: Vector3, wi: Vector3) -> [f32; 3] {
    [kind.eval(wo, wi, TransportMode::Radiance, UP)[2]; 3]
}

fn sampled_by(sampling: TableSampling, grid: &BrdfGrid) -> BsdfKind {
    let lambda = Wavelengths::sample_visible(0.4);
    BsdfKind::Tabulated(Tabulated { table: BrdfTable::of(grid), lambda, sampling })
}

fn of_grid(grid: &BrdfGrid) -> BsdfKind {
    sampled_by(TableSampling::Cells, grid)
}

fn hemisphere(rng: &mut Rng) -> Vector3 {
    let w = uniform_sphere(rng);
    Vector3::new(w.x, w.y, w.z.abs())
}

/// Mean difference of a model and its grey table, relative to the mean of the model, at 10° and more from the horizon.
fn table_error(kind: &BsdfKind, resolution: [usize; 3]) -> f32 {
    let table = of_grid(&BrdfGrid::tabulate(resolution, |wo, wi| radiance(kind, wo, wi)).unwrap());
    let mut rng = Rng::new(seed("table", 0), 0);
    let (mut error, mut sum) = (0.0, 0.0);
    for _ in 0..4000 {
        let (wo, wi) = (hemisphere(&mut rng), hemisphere(&mut rng));
        if wo.z.min(wi.z) > 0.17 {
            let (f, from_table) = (radiance(kind, wo, wi)[0], radiance(&table, wo, wi)[0]);
            error += (f - from_table).abs();
            sum += f;
        }
    }
    error / sum
}

/// SPEC BRDF-30: a table of a model is that model but for interpolation, whose error falls with the square of the
/// distance of nodes.
#[test]
fn a_table_gives_its_model_back() {
    let models = [
        BsdfKind::Conductor(copper(0.4, 0.4)),
        BsdfKind::Classic(Classic::Phong(Phong {
            kd: Sampled::splat(0.3),
            ks: Sampled::splat(0.5),
            exponent: 20.0,
            form: PhongForm::Lewis,
        })),
    ];
    for kind in models {
        let (coarse, fine) = (table_error(&kind, [16, 16, 16]), table_error(&kind, [32, 32, 32]));
        assert!(fine < 0.02 && fine < 0.4 * coarse, "{coarse} {fine}: {kind:?}");
    }
}

/// SPEC BRDF-30: the albedo by samples is that by quadrature, whatever the table, and however it is sampled.
#[test]
fn albedo_of_a_table_is_its_integral() {
    let ring = |wo: Vector3, wi: Vector3| [0.1, 0.2, 0.4].map(|c| c * (1.0 + (20.0 * wo.dot(wi)).cos()));
    let grid = BrdfGrid::tabulate([16, 40, 8], ring).unwrap();
    for sampling in [TableSampling::Cells, TableSampling::Rejection] {
        let kind = sampled_by(sampling, &grid);
        for wo in [direction(5.0, 0.7), direction(60.0, 2.0), direction(85.0, 0.0)] {
            let sampled = albedo(&kind, wo, TransportMode::Radiance, UP)[2];
            let exact = integrate_sphere(|wi| f64::from(radiance(&kind, wo, wi)[0] * wi.z.abs()), 1e-4);
            assert!(sampled.is_near(exact, 1e-3), "{sampling:?}: {sampled:?} {exact}");
        }
    }
}

/// Exchanged directions have the same value to the last bit, from any numbers.
#[test]
fn tables_are_reciprocal() {
    let mut rng = Rng::new(seed("reciprocal", 0), 0);
    let values = (0..7 * 5 * 3).map(|_| [(); 3].map(|()| rng.next_f32())).collect();
    let grid = BrdfGrid::new([7, 5, 3], values).unwrap();
    for _ in 0..2000 {
        let (a, b) = (hemisphere(&mut rng), hemisphere(&mut rng));
        assert_eq!(grid.at(a, b), grid.at(b, a));
    }
    let up = Vector3::new(0.0, 0.0, 1.0);
    assert_eq!(grid.at(up, up), grid.at(up, up));
}

/// What a table reflects into all directions alike is diffuse, and nothing else is.
#[test]
fn constants_are_diffuse() {
    let matte = of_grid(&BrdfGrid::tabulate([4, 4, 2], |_, _| [0.2; 3]).unwrap());
    assert_eq!(matte.lobes(), Lobes::DIFFUSE_REFLECT);
    let shiny = |wo: Vector3, wi: Vector3| [0.1 + (wo + wi).normalized().z.powi(60); 3];
    let shiny = of_grid(&BrdfGrid::tabulate([24, 4, 1], shiny).unwrap());
    assert_eq!(shiny.lobes(), Lobes::DIFFUSE_REFLECT | Lobes::GLOSSY_REFLECT);
    let (wo, wi) = (direction(40.0, 0.0), direction(20.0, 2.0));
    assert!(is_near(radiance(&matte, wo, wi)[0], 0.2, 1e-4, 0.0));
    let diffuse = shiny.eval(wo, wi, TransportMode::Radiance, Lobes::DIFFUSE);
    assert!(is_near(diffuse[0], 0.1, 1e-2, 0.0), "{diffuse:?}");
}

/// One table for equal grids; unsound grids are none.
#[test]
fn grids_are_checked_and_shared() {
    let grid = BrdfGrid::tabulate([2, 2, 1], |_, _| [0.3; 3]).unwrap();
    assert!(std::ptr::eq(BrdfTable::of(&grid), BrdfTable::of(&grid.clone())));
    let any = |resolution, value| BrdfGrid::new(resolution, vec![[value; 3]; 4]);
    assert!(any([2, 2, 1], 0.3).is_some());
    assert!(any([2, 3, 1], 0.3).is_none() && any([1, 4, 1], 0.3).is_none() && any([2, 2, 0], 0.3).is_none());
    assert!(any([2, 2, 1], -0.1).is_none() && any([2, 2, 1], f32::NAN).is_none());
    assert!(any([usize::MAX, 2, 2], 0.3).is_none());
}

/// Bands get the colours of the table.
#[test]
fn bands_are_the_colors() {
    let grid = BrdfGrid::tabulate([2, 2, 1], |_, _| [0.1, 0.2, 0.3]).unwrap();
    let lambda = Wavelengths::bands(0.1);
    let sampling = TableSampling::Cells;
    let kind = BsdfKind::Tabulated(Tabulated { table: BrdfTable::of(&grid), lambda, sampling });
    let f = kind.eval(direction(10.0, 0.0), direction(50.0, 1.0), TransportMode::Radiance, UP);
    let expected = lambda.of_bands(etendue_spectrum::Bands::from_rgb([0.1, 0.2, 0.3]));
    assert!((0..3).all(|i| is_near(f[i], expected[i], 1e-5, 0.0)), "{f:?} {expected:?}");
}
