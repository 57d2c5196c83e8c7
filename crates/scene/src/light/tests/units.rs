//! Watts, lumens, candela, lux: sizes of lights.

use std::f64::consts::PI;

use etendue_geometry::Reference;
use etendue_math::statistics::{Moments, mean_test};
use etendue_math::{Point2, warp};
use etendue_spectrum::{blackbody, photometry};

use super::*;

/// Flux of a light in lumen by emission of rays: mean of L cos / (pdf_a pdf_w).
fn emitted_lumens(world: &World, light: &Light, n: usize, name: &str) -> Moments {
    let context = world.context();
    let mut rng = rng(name);
    (0..n)
        .map(|_| {
            let (u, v) = (rng.next_point2(), rng.next_point2());
            let sample = |lambda: &Wavelengths| light.sample_le(&context, u, v, lambda);
            let Some(first) = sample(&some_wavelengths()) else { return 0.0 };
            let le = luminance(|lambda| sample(lambda).map_or(Sampled::ZERO, |s| s.le));
            le * f64::from(first.cosine) / (f64::from(first.pdf_a) * f64::from(first.pdf_w))
        })
        .collect()
}

/// Illuminance at a point by sampling the light.
fn illuminance(world: &World, light: &Light, reference: &Reference, n: usize, name: &str) -> Moments {
    let context = world.context();
    let mut rng = rng(name);
    (0..n)
        .map(|_| {
            let u = rng.next_point2();
            let sample = |lambda: &Wavelengths| light.sample_li(&context, reference, u, lambda);
            let Some(first) = sample(&some_wavelengths()) else { return 0.0 };
            let cosine = reference.n.map_or(1.0, |n| n.dot_vector(first.wi).max(0.0));
            let le = luminance(|lambda| sample(lambda).map_or(Sampled::ZERO, |s| s.le));
            le * f64::from(cosine) / f64::from(first.pdf_w)
        })
        .collect()
}

#[test]
fn a_point_light_of_power_phi_gives_irradiance_phi_cos_over_four_pi_r_squared() {
    // EMI-1, RAD-6: E = Phi cos(theta) / (4 pi r^2), and it vanishes at grazing incidence.
    let world =
        World::of(Entity::new("point").with("power", floats(&[100.0])).with("from", point(1.0, 2.0, 3.0)));
    for (distance, angle) in [(0.5_f32, 0.0_f32), (2.0, 0.6), (40.0, 1.3)] {
        let p = Point3::new(1.0, 2.0, 3.0 - distance);
        let reference = facing(p, Vector3::new(angle.sin(), 0.0, angle.cos()));
        let e = illuminance(&world, world.light(), &reference, 1, "point");
        let expected = 100.0 * f64::from(angle.cos()) / (4.0 * PI * f64::from(distance).powi(2));
        assert_close(e.mean(), expected, 1e-4);
    }
    let grazing = facing(Point3::new(1.0, 2.0, 2.0), Vector3::new(1.0, 0.0, 0.0));
    assert!(illuminance(&world, world.light(), &grazing, 1, "point").mean().abs() < 1e-6);
}

#[test]
fn the_illuminance_of_a_closed_surface_around_a_lamp_adds_up_to_its_flux() {
    // RAD-4, RAD-5: the integral of E over a sphere is the flux, for every light that is a point, however it is turned.
    let picture = grey_picture(8);
    let kinds = [
        ("point", Entity::new("point"), None),
        (
            "spot",
            Entity::new("spot").with("coneangle", floats(&[40.0])).with("conedeltaangle", floats(&[25.0])),
            None,
        ),
        ("gonio", Entity::new("goniometric").with("filename", string("map")), Some(picture.clone())),
        ("projection", Entity::new("projection").with("filename", string("map")), Some(picture)),
    ];
    for (name, entity, picture) in kinds {
        let mut assets = Assets::default();
        if let Some(picture) = picture {
            assets.images.insert("map".to_owned(), Arc::new(picture));
        }
        let entity = placed(entity.with("power", floats(&[250.0])), tilted());
        let world = World::new(&[entity], Vec::new(), &assets);
        let light = world.light();
        let mut rng = rng(name);
        let e: Moments = (0..20_000)
            .map(|_| {
                let w = warp::sample_uniform_sphere(rng.next_point2());
                let reference = at(Point3::ORIGIN + w * 2.0);
                let lambda = some_wavelengths();
                let li = light.sample_li(&world.context(), &reference, Point2::splat(0.5), &lambda);
                // White light: one wavelength tells luminance.
                let white = luminance_per_value(&world, &lambda);
                li.map_or(0.0, |s| f64::from(s.le[0]) * white) * 16.0 * PI
            })
            .collect();
        mean_test(&e, 250.0, SIGNIFICANCE).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}

/// Luminance of the white D65 whose value is 1 at the first wavelength.
fn luminance_per_value(world: &World, lambda: &Wavelengths) -> f64 {
    let mut spectra = world.spectra.clone();
    let table = spectra.illuminant(etendue_spectrum::ColorSpaceName::Srgb);
    let value = spectra.sample(table, lambda)[0];
    luminance(|l| spectra.sample(table, l)) / f64::from(value)
}

#[test]
fn a_light_of_power_p_emits_p_lumens_whatever_its_colour() {
    // `power` is luminous flux: emitted rays carry it in all, and the light says so.
    let picture = || Some(grey_picture(8));
    let kinds = [
        ("point", Entity::new("point").with("I", rgb(0.9, 0.2, 0.1)), None),
        ("spot", Entity::new("spot").with("I", Value::Blackbody(vec![2700.0])), None),
        ("hard spot", Entity::new("spot").with("conedeltaangle", floats(&[0.0])), None),
        ("gonio", Entity::new("goniometric").with("filename", string("map")), picture()),
        ("projection", Entity::new("projection").with("filename", string("map")), picture()),
    ];
    for (name, entity, picture) in kinds {
        let world = World::with_picture(entity.with("power", floats(&[800.0])), picture);
        let light = world.light();
        assert_close(light.power(&world.context()).lumens, 800.0, 1e-3);
        let lumens = emitted_lumens(&world, light, 200, name);
        // Emission is sampled in proportion to intensity, so every ray carries the same power (EMI-8); within a texel
        // of a projector, solid angle changes by the cube of the cosine.
        let (mean_error, deviation) = if name == "projection" { (0.08, 100.0) } else { (2e-3, 2.0) };
        assert_close(lumens.mean(), 800.0, mean_error);
        assert!(lumens.standard_deviation() < deviation, "{name}: {}", lumens.standard_deviation());
        if name == "projection" {
            mean_test(&lumens, 800.0, SIGNIFICANCE).expect("the flux is that asked for");
        }
    }
}

#[test]
fn scale_multiplies_power() {
    // The size is set by power, then the artist turns the dimmer.
    let entity = Entity::new("point").with("power", floats(&[100.0])).with("scale", floats(&[0.25]));
    let world = World::of(entity);
    assert_close(world.light().power(&world.context()).lumens, 25.0, 1e-4);
}

#[test]
fn a_light_of_default_size_has_unit_luminance_intensity_or_illuminance() {
    // In pbrt's units, scale 1 means 1 cd, 1 lx or 1 cd/m^2; RGB multiplies.
    let cases = [
        (Entity::new("point"), 4.0 * PI),
        (Entity::new("point").with("I", rgb(2.0, 2.0, 2.0)), 8.0 * PI),
        (Entity::new("point").with("I", Value::Blackbody(vec![4000.0])), 4.0 * PI),
        (Entity::new("distant").with("scale", floats(&[3.0])), 3.0 * PI),
        (Entity::new("infinite"), 4.0 * PI * PI),
    ];
    for (entity, lumens) in cases {
        let world = World::of(entity);
        assert_close(world.light().power(&world.context()).lumens, lumens, 1e-3);
    }
}

#[test]
fn radiometric_units_keep_the_absolute_spectrum() {
    // 2 W/(sr nm) at every wavelength from 360 to 830 nm (471 samples of 1 nm) in all directions.
    let samples = Value::SpectrumSamples(vec![[300.0, 2.0], [900.0, 2.0]]);
    let entity = Entity::new("point").with("I", samples.clone()).with("units", string("radiometric"));
    let world = World::of(entity);
    let power = world.light().power(&world.context());
    assert_close(power.watts, 4.0 * PI * 2.0 * 471.0, 1e-4);
    assert_close(power.lumens, 4.0 * PI * 2.0 * 683.0 * 106.856_895, 1e-4);

    // `power` is then in watts.
    let entity = Entity::new("point").with("I", samples).with("units", string("radiometric"));
    let world = World::of(entity.with("power", floats(&[60.0])));
    assert_close(world.light().power(&world.context()).watts, 60.0, 1e-4);
}

#[test]
fn a_radiometric_blackbody_is_plancks_law() {
    // RAD-7: radiance in W/(m^2 sr nm), times K_m inside the renderer.
    let entity = Entity::new("infinite").with("L", Value::Blackbody(vec![5900.0]));
    let world = World::of(entity.with("units", string("radiometric")));
    let lambda = Wavelengths::from_parts([450.0, 491.0, 550.0, 700.0], [1.0; 4]);
    let le =
        world.light().le_infinite(&world.context(), Point3::ORIGIN, Vector3::new(0.0, 0.0, 1.0), &lambda);
    for (value, nm) in le.to_array().into_iter().zip(lambda.lambda_nm()) {
        assert_close(f64::from(value), f64::from(photometry::K_M * blackbody::radiance(nm, 5900.0)), 1e-4);
    }
}

#[test]
fn radiometric_white_carries_one_watt_per_unit_of_rgb() {
    // RGB has no absolute size: 1 is defined as 1 W/(m^2 sr) over the visible range.
    let entity = Entity::new("point").with("I", rgb(3.0, 3.0, 3.0)).with("units", string("radiometric"));
    let world = World::of(entity);
    assert_close(world.light().power(&world.context()).watts, 3.0 * 4.0 * PI, 1e-3);
}

#[test]
fn watts_and_lumens_of_photometric_lights_are_related_by_their_efficacy() {
    // RAD-13: lumens = 683 lm/W times the V-weighted share of the watts.
    let world = World::of(Entity::new("point").with("I", Value::Blackbody(vec![3000.0])));
    let power = world.light().power(&world.context());
    let spectrum = etendue_spectrum::Spectrum::blackbody(3000.0);
    let efficacy = f64::from(photometry::luminous_efficacy(&spectrum, &world.spectra));
    assert_close(power.lumens / power.watts, efficacy, 1e-4);
}

#[test]
fn distant_light_gives_the_same_irradiance_in_any_scene() {
    // EMI-7: E on a facing plane does not depend on scene size; the flux into the scene does, as the cross-section.
    let entity = Entity::new("distant").with("illuminance", floats(&[1000.0])).with("L", rgb(1.0, 0.5, 0.2));
    let entity = entity.with("from", point(0.0, 0.0, 5.0)).with("to", point(0.0, 0.0, 0.0));
    let mut world = World::of(entity);
    for radius in [0.01_f32, 1.0, 5000.0] {
        world.tables.scene_sphere = SceneSphere { center: Point3::new(3.0, 0.0, 0.0), radius };
        let up = facing(Point3::new(0.1, 0.2, 0.0), Vector3::new(0.0, 0.0, 1.0));
        assert_close(illuminance(&world, world.light(), &up, 1, "distant").mean(), 1000.0, 1e-4);
        let flux = 1000.0 * PI * f64::from(radius).powi(2);
        assert_close(world.light().power(&world.context()).lumens, flux, 1e-4);
        assert_close(emitted_lumens(&world, world.light(), 4, "distant").mean(), flux, 1e-3);
        // Photons start outside of the scene and travel with the light.
        let ray = world
            .light()
            .sample_le(&world.context(), Point2::new(0.3, 0.9), Point2::splat(0.5), &some_wavelengths())
            .expect("a distant light emits")
            .ray;
        assert!(ray.direction.z < -0.9999);
        let out = ray.origin - world.tables.scene_sphere.center;
        assert!(out.length() >= radius * 0.9999);
    }
}

#[test]
fn a_plane_under_a_constant_sky_receives_pi_l() {
    // EMI-12: E = pi L, here L = 7 cd/m^2.
    let world = World::of(Entity::new("infinite").with("scale", floats(&[7.0])));
    let up = facing(Point3::ORIGIN, Vector3::new(0.0, 0.6, 0.8));
    let e = illuminance(&world, world.light(), &up, 20_000, "sky");
    mean_test(&e, 7.0 * PI, SIGNIFICANCE).expect("E = pi L");

    // And `illuminance` sets E instead of L.
    let world = World::of(Entity::new("infinite").with("illuminance", floats(&[500.0])));
    let e = illuminance(&world, world.light(), &up, 20_000, "sky lux");
    mean_test(&e, 500.0, SIGNIFICANCE).expect("E is what was asked for");
}

#[test]
fn a_pictured_sky_gives_the_illuminance_that_was_asked_for() {
    // `illuminance` is that of a plane that faces +z of the light, whatever the picture.
    let entity =
        Entity::new("infinite").with("filename", string("map")).with("illuminance", floats(&[300.0]));
    let world = World::with_picture(entity, Some(grey_picture(64)));
    let up = facing(Point3::ORIGIN, Vector3::new(0.0, 0.0, 1.0));
    let e = illuminance(&world, world.light(), &up, 20_000, "pictured sky");
    // The cosine is taken at the middle of texels, which is off by less than their size.
    assert_close(e.mean(), 300.0, 4.5 * e.standard_error() / 300.0 + 2e-3);
}

#[test]
fn flux_through_the_scene_sphere_is_that_of_the_surroundings() {
    // Rays emitted from infinity carry 4 pi * pi R^2 times the mean radiance.
    for name in ["infinite", "map"] {
        let entity = Entity::new("infinite");
        let entity = if name == "map" { entity.with("filename", string("map")) } else { entity };
        let mut world = World::with_picture(entity, Some(grey_picture(8)));
        world.tables.scene_sphere = SceneSphere { center: Point3::new(1.0, 2.0, 3.0), radius: 10.0 };
        let lumens = emitted_lumens(&world, world.light(), 200, name);
        assert_close(lumens.mean(), world.light().power(&world.context()).lumens, 2e-3);
    }
}
