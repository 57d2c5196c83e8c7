//! Surfaces that emit by the table of a luminaire (SPEC EMI-8).

use std::f64::consts::PI;

use etendue_math::Point2;
use etendue_math::statistics::{integrate_sphere, sphere_chi_square};

use super::*;

/// A batwing: dim along the axis, brightest at 40 degrees, nothing from 80 degrees on, and something upwards.
fn batwing() -> Photometry {
    let vertical = vec![0.0, 20.0, 40.0, 60.0, 80.0, 120.0, 180.0];
    let candela = vec![100.0, 150.0, 400.0, 90.0, 0.0, 0.0, 60.0];
    Photometry::new(PhotometricWeb::C, vertical, vec![0.0], candela).expect("a table")
}

/// A disk that shines upwards, with `file` for a profile.
fn disk(entity: Entity) -> World {
    let mut assets = Assets::default();
    assets.luminaires.insert("file".to_owned(), Arc::new(batwing()));
    let disk =
        Shape::Disk { height: 0.0, radius: 0.1, inner_radius: 0.0, phi_max_rad: 2.0 * std::f32::consts::PI };
    World::new(&[], vec![(disk, Transform::IDENTITY, entity)], &assets)
}

fn profiled() -> Entity {
    Entity::new("diffuse").with("profile", string("file"))
}

fn towards(degrees: f32) -> Vector3 {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    Vector3::new(0.6 * sine, 0.8 * sine, cosine)
}

/// Candela seen from 1 km.
fn candela(world: &World, degrees: f32) -> f64 {
    let (context, light) = (world.context(), world.light());
    let reference = at(Point3::ORIGIN + towards(degrees) * 1000.0);
    let lux = luminance(|lambda| {
        let sample = light.sample_li(&context, &reference, Point2::new(0.3, 0.6), lambda);
        sample.map_or(Sampled::ZERO, |sample| sample.le * (1.0 / sample.pdf_w))
    });
    lux * 1e6
}

/// From afar the surface has the candela of its table, and its lumens are those in front of it.
#[test]
fn a_surface_has_the_intensity_of_its_table() {
    let (world, table) = (disk(profiled()), batwing());
    assert!(world.diagnostics.list().is_empty(), "{:?}", world.diagnostics.list());
    for degrees in [0.0, 10.0, 30.0, 40.0, 55.0, 70.0, 79.0] {
        let w = towards(degrees);
        let expected = table.intensity(Vector3::new(w.x, w.y, -w.z));
        assert_close(candela(&world, degrees), f64::from(expected), 5e-3);
    }
    assert_eq!(candela(&world, 85.0), 0.0);
    let front = integrate_sphere(|w| if w.z < 0.0 { f64::from(table.intensity(w)) } else { 0.0 }, 1e-5);
    assert_close(world.light().power(&world.context()).lumens, front, 1e-3);
}

/// `power` and `L` replace the size: L is that of a matte surface of the same flux, pi A L.
#[test]
fn the_size_of_a_profile_may_be_changed() {
    let lumens = |entity: Entity| {
        let world = disk(entity);
        world.light().power(&world.context()).lumens
    };
    assert_close(lumens(profiled().with("power", floats(&[700.0]))), 700.0, 1e-4);
    let l = rgb(50.0, 50.0, 50.0);
    assert_close(lumens(profiled().with("L", l).with("scale", floats(&[2.0]))), 100.0 * PI * PI * 0.01, 1e-2);
    let file = lumens(profiled());
    assert_close(lumens(profiled().with("scale", floats(&[0.5]))), 0.5 * file, 1e-4);
    assert_close(lumens(profiled().with("twosided", Value::Bools(vec![true]))), 2.0 * file, 1e-4);
}

/// Directions follow radiance times cosine: the density is what samples have, its integral is 1, and photons have equal power
/// but for what varies within a cell.
#[test]
fn photons_of_a_profile_have_equal_power() {
    let profile = LuminousProfile::new(&Arc::new(batwing())).expect("it has light");
    let pdf = |w: Vector3| profile.pdf_w(w.z);
    let sample = |rng: &mut Rng| Some(profile.sample(rng.next_point2()));
    sphere_chi_square(60_000, seed("profile"), sample, pdf, SIGNIFICANCE)
        .unwrap_or_else(|error| panic!("{error}"));
    assert_close(integrate_sphere(|w| f64::from(pdf(w)), 1e-4), 1.0, 3e-3);
    let flux = |w: Vector3| if w.z > 0.0 { f64::from(profile.relative(w.z) * w.z) } else { 0.0 };
    assert_close(integrate_sphere(flux, 1e-5), PI, 1e-3);
    let mut rng = rng("profile powers");
    let mut n_odd = 0;
    for _ in 0..2000 {
        let w = profile.sample(rng.next_point2());
        let power = f64::from(profile.relative(w.z) * w.z / profile.pdf_w(w.z));
        assert!(power < 1.02 * PI, "{power} at {w:?}");
        n_odd += usize::from((power / PI - 1.0).abs() > 0.03);
    }
    assert!(n_odd < 60, "{n_odd} of 2000 photons have another power");
}

/// What does not suit a profile is said.
#[test]
fn profiles_are_checked() {
    let messages = |entity: Entity| -> Vec<String> {
        disk(entity).diagnostics.list().iter().map(|problem| problem.message.clone()).collect()
    };
    let both = messages(profiled().with("exponent", floats(&[3.0])));
    assert!(both.len() == 1 && both[0].contains("\"exponent\" is ignored"), "{both:?}");
    let missing = messages(Entity::new("diffuse").with("profile", string("other")));
    assert!(missing.len() == 1 && missing[0].contains("was not loaded"), "{missing:?}");
    let dark =
        Photometry::new(PhotometricWeb::C, vec![90.0, 180.0], vec![0.0], vec![0.0, 5.0]).expect("a table");
    assert!(LuminousProfile::new(&Arc::new(dark)).is_none());
    let uneven =
        Photometry::new(PhotometricWeb::C, vec![0.0, 90.0], vec![0.0, 180.0], vec![9.0, 0.0, 9.0, 8.0]);
    assert!(uneven.expect("a table").varies_around_axis(0.05) && !batwing().varies_around_axis(0.05));
}
