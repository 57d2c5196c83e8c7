//! Measured luminaires, and emission by direction.

use std::f64::consts::PI;

use etendue_math::statistics::{integrate_sphere, sphere_chi_square};
use etendue_math::{Point2, Ray, warp};

use super::*;

/// Candela that fall from the nadir: 100 (1 + cos v) / 2 with a part that depends on the plane.
fn table(web: PhotometricWeb, vertical: &[f32], horizontal: &[f32]) -> Photometry {
    let candela = horizontal
        .iter()
        .flat_map(|h| vertical.iter().map(move |v| 50.0 * (1.0 + v.to_radians().cos()) + h))
        .collect();
    Photometry::new(web, vertical.to_vec(), horizontal.to_vec(), candela).expect("the table is right")
}

fn world(photometry: Photometry, entity: Entity, transform: Transform) -> World {
    let mut assets = Assets::default();
    assets.luminaires.insert("lamp.ies".to_owned(), Arc::new(photometry));
    World::new(&[placed(entity.with("filename", string("lamp.ies")), transform)], Vec::new(), &assets)
}

/// Direction of type C from degrees.
fn type_c(v: f32, h: f32) -> Vector3 {
    let ((sin_v, cos_v), (sin_h, cos_h)) = (v.to_radians().sin_cos(), h.to_radians().sin_cos());
    Vector3::new(sin_v * cos_h, sin_v * sin_h, -cos_v)
}

#[test]
fn a_luminaire_shines_with_the_candela_of_its_table() {
    // I = E r^2 at 3 m in every direction of the table, in a tilted light.
    let (vertical, horizontal) =
        ([0.0, 20.0, 55.0, 90.0, 130.0, 180.0], [0.0, 45.0, 100.0, 180.0, 300.0, 360.0]);
    let photometry = table(PhotometricWeb::C, &vertical, &horizontal);
    let colour = Entity::new("ies").with("I", rgb(0.9, 0.2, 0.1));
    let world = world(photometry, colour, tilted());
    let (context, light) = (world.context(), world.light());
    for v in &vertical[1..5] {
        for h in &horizontal[1..5] {
            let reference = at(Point3::ORIGIN + tilted().vector(type_c(*v, *h)) * 3.0);
            let lux = luminance(|lambda| {
                light.sample_li(&context, &reference, Point2::splat(0.5), lambda).expect("it shines").le
            });
            assert_close(lux * 9.0, f64::from(50.0 * (1.0 + v.to_radians().cos()) + h), 1e-3);
        }
    }
}

#[test]
fn tables_of_a_part_are_mirrored_by_their_web() {
    #[track_caller]
    fn check(photometry: &Photometry, w: Vector3, v: f32, h: f32) {
        let expected = 50.0 * (1.0 + v.to_radians().cos()) + h;
        assert!((photometry.intensity(w.normalized()) - expected).abs() < 1e-2, "{w:?}");
    }
    let vertical: Vec<f32> = (0..=180).map(|v| v as f32).collect();
    let axial = table(PhotometricWeb::C, &vertical, &[0.0]);
    check(&axial, type_c(30.0, 217.0), 30.0, 0.0);
    let quarter = table(PhotometricWeb::C, &vertical, &[0.0, 90.0]);
    for h in [20.0, 160.0, 200.0, 340.0] {
        check(&quarter, type_c(30.0, h), 30.0, 20.0);
    }
    let half = table(PhotometricWeb::C, &vertical, &[0.0, 180.0]);
    check(&half, type_c(120.0, 290.0), 120.0, 70.0);
    let across = table(PhotometricWeb::C, &vertical, &[90.0, 270.0]);
    check(&across, type_c(120.0, 40.0), 120.0, 140.0);
    check(&across, type_c(120.0, 320.0), 120.0, 220.0);
    let open = Photometry::new(
        PhotometricWeb::C,
        vec![0.0, 180.0],
        vec![0.0, 120.0, 240.0],
        vec![1.0, 1.0, 2.0, 2.0, 4.0, 4.0],
    );
    let open = open.expect("the last plane is the first");
    assert!((open.intensity(type_c(90.0, 300.0)) - 2.5).abs() < 1e-3);
    // Nothing beyond the angles.
    let down = table(PhotometricWeb::C, &[0.0, 90.0], &[0.0]);
    assert_eq!(down.intensity(type_c(91.0, 0.0)), 0.0);
    // A and B look along +x, +z above; a quarter of the web mirrors both angles.
    let ahead: Vec<f32> = (0..=90).map(|v| v as f32).collect();
    let a = table(PhotometricWeb::A, &ahead, &ahead);
    let b = table(PhotometricWeb::B, &ahead, &ahead);
    let (sin_v, cos_v) = 20.0_f32.to_radians().sin_cos();
    let (sin_h, cos_h) = 50.0_f32.to_radians().sin_cos();
    for (up, side) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
        check(&a, Vector3::new(cos_v * cos_h, side * cos_v * sin_h, up * sin_v), 20.0, 50.0);
        check(&b, Vector3::new(cos_h * cos_v, side * sin_h, up * cos_h * sin_v), 20.0, 50.0);
    }
    assert_eq!(a.intensity(Vector3::new(-1.0, 0.0, 0.0)), 0.0);
}

#[test]
fn impossible_tables_are_refused() {
    let refuse = |web, vertical: &[f32], horizontal: &[f32], candela: &[f32]| {
        Photometry::new(web, vertical.to_vec(), horizontal.to_vec(), candela.to_vec()).is_err()
    };
    use PhotometricWeb::{B, C};
    assert!(refuse(C, &[0.0], &[0.0], &[1.0]));
    assert!(refuse(C, &[0.0, 0.0], &[0.0], &[1.0, 1.0]));
    assert!(refuse(C, &[0.0, f32::NAN], &[0.0], &[1.0, 1.0]));
    assert!(refuse(C, &[0.0, 90.0], &[], &[]));
    assert!(refuse(C, &[0.0, 90.0], &[0.0], &[1.0]));
    assert!(refuse(C, &[0.0, 90.0], &[0.0], &[1.0, -1.0]));
    assert!(refuse(C, &[0.0, 190.0], &[0.0], &[1.0, 1.0]));
    assert!(refuse(C, &[0.0, 90.0], &[30.0], &[1.0, 1.0]));
    assert!(refuse(B, &[-100.0, 90.0], &[0.0], &[1.0, 1.0]));
}

#[test]
fn the_flux_of_a_luminaire_is_the_integral_of_its_table() {
    // I = 100 cos v below the horizon has pi 100 lm.
    let vertical: Vec<f32> = (0..=90).map(|v| v as f32).collect();
    let candela = vertical.iter().map(|v| (100.0 * v.to_radians().cos()).max(0.0)).collect();
    let cosine =
        Photometry::new(PhotometricWeb::C, vertical, vec![0.0], candela).expect("the table is right");
    let plain = world(cosine.clone(), Entity::new("ies"), Transform::IDENTITY);
    assert_close(plain.light().power(&plain.context()).lumens, 100.0 * PI, 1e-3);
    let Light::Ies(id) = plain.light() else { panic!("it is a luminaire") };
    assert_close(plain.tables.luminaires[id.0 as usize].peak_intensity(&plain.context()).lumens, 100.0, 1e-3);
    let scaled = Entity::new("ies").with("power", floats(&[500.0])).with("scale", floats(&[2.0]));
    let scaled = world(cosine, scaled, Transform::IDENTITY);
    assert_close(scaled.light().power(&scaled.context()).lumens, 1000.0, 1e-3);
}

#[test]
fn narrow_beams_keep_their_flux_and_their_photons() {
    // I falls linearly from 1e6 cd to 0 over a small angle a: Phi = pi a^2 I / 3. Such a beam, and a ring between the cells.
    #[track_caller]
    fn check(vertical: &[f32], candela: &[f32], lumens: f64) {
        let photometry =
            Photometry::new(PhotometricWeb::C, vertical.to_vec(), vec![0.0], candela.to_vec()).unwrap();
        let world = world(photometry, Entity::new("ies"), Transform::IDENTITY);
        let (context, light, lambda) = (world.context(), world.light(), some_wavelengths());
        assert_close(light.power(&context).lumens, lumens, 1e-3);
        let Light::Ies(id) = light else { panic!("it is a luminaire") };
        let peak = world.tables.luminaires[id.0 as usize].peak_intensity(&context);
        assert_close(peak.lumens, 1e6, 1e-3);
        assert_close(f64::from(light.bounds(&context).unwrap().intensity), peak.weight, 1e-3);
        for (v, cd) in vertical.iter().zip(candela).filter(|(_, cd)| **cd > 0.0) {
            let ray = Ray::new(Point3::ORIGIN, type_c(v.max(0.01), 33.0));
            assert!(light.pdf_le(&context, &ray, None).1 > 0.0, "{cd} cd at {v} are never sampled");
        }
        let mut rng = rng("beam");
        let n_found = (0..1000)
            .filter(|_| light.sample_le(&context, rng.next_point2(), rng.next_point2(), &lambda).is_some());
        assert!(n_found.count() > 100);
    }
    check(&[0.0, 0.2, 90.0], &[1e6, 0.0, 0.0], PI * 0.2_f64.to_radians().powi(2) / 3.0 * 1e6);
    // A hat of 0.1 degrees at 10.1 degrees: 2 pi sin(10.1) times half its width in radians.
    let ring = 2.0 * PI * 10.1_f64.to_radians().sin() * 0.1_f64.to_radians() * 1e6;
    check(&[0.0, 10.05, 10.1, 10.15], &[0.0, 0.0, 1e6, 0.0], 0.5 * ring);
}

#[test]
fn the_flux_of_any_web_is_that_of_its_directions() {
    // By midpoints over the sphere, for whole tables, halves and quarters.
    use PhotometricWeb::{A, B, C};
    let (half, quarter): (&[f32], &[f32]) = (&[-90.0, -20.0, 10.0, 90.0], &[0.0, 15.0, 60.0, 90.0]);
    for (web, vertical, horizontal) in [
        (A, half, &[-180.0, -30.0, 70.0, 180.0][..]),
        (A, quarter, quarter),
        (A, half, &[0.0]),
        (B, half, half),
        (B, quarter, quarter),
        (B, half, &[0.0]),
        (C, quarter, &[0.0]),
        (C, quarter, quarter),
        (C, quarter, &[0.0, 60.0, 180.0]),
        (C, quarter, &[90.0, 150.0, 270.0]),
        (C, quarter, &[0.0, 60.0, 200.0, 360.0]),
        (C, quarter, &[0.0, 120.0, 240.0]),
    ] {
        let candela = (0..vertical.len() * horizontal.len()).map(|i| (i * i % 7) as f32 + 1.0).collect();
        let photometry = Photometry::new(web, vertical.to_vec(), horizontal.to_vec(), candela)
            .expect("the table is right");
        let expected = integrate_sphere(|w| f64::from(photometry.intensity(w)), 1e-4);
        assert_close(photometry.lumens(), expected, 3e-3);
    }
}

#[test]
fn photons_of_a_luminaire_follow_its_table_with_equal_power() {
    let photometry = table(PhotometricWeb::C, &[0.0, 40.0, 90.0, 120.0], &[0.0, 70.0, 180.0]);
    let world = world(photometry.clone(), Entity::new("ies"), tilted());
    let (context, light, lambda) = (world.context(), world.light(), some_wavelengths());
    let sample = |rng: &mut Rng| {
        light.sample_le(&context, rng.next_point2(), rng.next_point2(), &lambda).map(|s| s.ray.direction)
    };
    let pdf = |w: Vector3| light.pdf_le(&context, &Ray::new(Point3::ORIGIN, w), None).1;
    sphere_chi_square(60_000, seed("luminaire"), sample, pdf, SIGNIFICANCE)
        .unwrap_or_else(|error| panic!("{error}"));
    assert_close(integrate_sphere(|w| f64::from(pdf(w)), 1e-4), 1.0, 3e-3);
    let mut rng = rng("equal power");
    let mut powers = Vec::new();
    for _ in 0..2000 {
        let Some(s) = light.sample_le(&context, rng.next_point2(), rng.next_point2(), &lambda) else {
            continue;
        };
        let (_, pdf_w) = light.pdf_le(&context, &s.ray, None);
        assert!((pdf_w - s.pdf_w).abs() <= 2e-2 * s.pdf_w);
        powers.push(f64::from(s.le[0] / s.pdf_w));
    }
    // But for what varies within a cell of half a degree by two: at the edges of the table and at its poles.
    let mean = powers.iter().sum::<f64>() / powers.len() as f64;
    let n_odd = powers.iter().filter(|power| (*power / mean - 1.0).abs() > 0.03).count();
    assert!(n_odd < 60, "{n_odd} of 2000 photons have another power");
}

#[test]
fn a_spreading_surface_emits_by_its_profile_with_equal_power() {
    // L = cos^n up to an angle: density, its integral, and the same power for every photon.
    for (name, exponent, angle) in [("cosine", 3.0, 90.0_f32), ("cone", 0.0, 25.0), ("both", 40.0, 10.0)] {
        let profile = Profile::new(exponent, angle.to_radians());
        let sample = |rng: &mut Rng| Some(profile.sample(rng.next_point2()));
        let pdf = |w: Vector3| profile.pdf_w(w.z.max(-1.0));
        sphere_chi_square(40_000, seed(name), sample, pdf, SIGNIFICANCE)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        // The integral over cos theta, by so many midpoints that the edge of the cone counts for 1e-4.
        let n = 200_000;
        let cosines = (0..n).map(|i| (i as f32 + 0.5) / n as f32);
        let flux: f64 =
            cosines.map(|c| f64::from(profile.relative(c) * c)).sum::<f64>() * 2.0 * PI / f64::from(n);
        assert_close(f64::from(profile.projected_solid_angle()), flux, 1e-3);
        let mut rng = rng(name);
        for _ in 0..200 {
            let w = profile.sample(rng.next_point2());
            let power = f64::from(profile.relative(w.z) * w.z / profile.pdf_w(w.z));
            assert_close(power, f64::from(profile.projected_solid_angle()), 1e-3);
        }
    }
}

#[test]
fn rejection_follows_any_profile_and_takes_the_mean_over_the_maximum() {
    // SPEC EMI-8 (b): the table over its peak; the share of candidates that are taken is the mean over the peak.
    let photometry = table(PhotometricWeb::C, &[0.0, 60.0, 180.0], &[0.0, 180.0]);
    let peak = 100.0 + 180.0;
    let relative = |w: Vector3| photometry.intensity(w) / peak;
    let candidate = |rng: &mut Rng| warp::sample_uniform_sphere(rng.next_point2());
    let mean = integrate_sphere(|w| f64::from(relative(w)), 1e-5) / (4.0 * PI);
    let sample = |rng: &mut Rng| sample_by_rejection(rng, candidate, relative).map(|(w, _)| w);
    let pdf = |w: Vector3| relative(w) / (4.0 * PI * mean) as f32;
    sphere_chi_square(60_000, seed("rejection"), sample, pdf, SIGNIFICANCE)
        .unwrap_or_else(|error| panic!("{error}"));
    let (n, mut rng) = (20_000, rng("acceptance"));
    let tries =
        |rng: &mut Rng| sample_by_rejection(rng, candidate, relative).map_or(0, |(_, n_tries)| n_tries);
    let n_tries: u32 = (0..n).map(|_| tries(&mut rng)).sum();
    // Tries are geometric: their mean has the standard error sqrt(1 - p) / (p sqrt(n)).
    let error = (1.0 - mean).sqrt() / (mean * f64::from(n).sqrt());
    assert!((f64::from(n_tries) / f64::from(n) - 1.0 / mean).abs() < 4.5 * error);
    assert!(sample_by_rejection(&mut rng, candidate, |_| 0.0).is_none());
}

#[test]
fn a_spreading_area_light_has_the_power_that_was_asked() {
    // 700 lm from a disk, whatever the profile; far away the intensity on its axis is Phi (n + 2) / (2 pi (1 - c^(n + 2))).
    let disk = || Shape::Disk {
        height: 0.0,
        radius: 0.1,
        inner_radius: 0.0,
        phi_max_rad: 2.0 * std::f32::consts::PI,
    };
    let entity = Entity::new("diffuse")
        .with("power", floats(&[700.0]))
        .with("exponent", floats(&[2.0]))
        .with("spreadangle", floats(&[60.0]));
    let world = World::new(&[], vec![(disk(), Transform::IDENTITY, entity)], &Assets::default());
    let (context, light) = (world.context(), world.light());
    assert_close(light.power(&context).lumens, 700.0, 1e-4);
    let lux_at = |w: Vector3| {
        let reference = at(Point3::ORIGIN + w * 50.0);
        luminance(|lambda| {
            light
                .sample_li(&context, &reference, Point2::new(0.3, 0.6), lambda)
                .map_or(Sampled::ZERO, |s| s.le * (1.0 / s.pdf_w))
        })
    };
    let up = Vector3::new(0.0, 0.0, 1.0);
    assert_close(lux_at(up) * 2500.0, 700.0 * 4.0 / (2.0 * PI * (1.0 - 0.5_f64.powi(4))), 0.01);
    assert_eq!(lux_at(Vector3::new(0.9, 0.0, 0.4).normalized()), 0.0);
}
