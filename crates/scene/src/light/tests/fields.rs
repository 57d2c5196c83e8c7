//! Directions: densities, consistency of sampling and evaluation, falloff.

use etendue_math::statistics::{integrate_sphere, sphere_chi_square};
use etendue_math::{Point2, Ray, warp};

use super::*;

/// Lights at infinity, each with a place from which it is seen.
fn infinite_worlds() -> Vec<(&'static str, World, Reference)> {
    let mut assets = Assets::default();
    assets.images.insert("map".to_owned(), Arc::new(grey_picture(8)));
    let corner = |x, y| Point3::new(x, y, 2.0);
    let corners = [corner(-1.0, -0.5), corner(-1.0, 0.5), corner(1.0, 0.5), corner(1.0, -0.5)];
    let portal = |order: [usize; 4]| Value::Points3(order.map(|i: usize| corners[i]).to_vec());
    let image = Entity::new("infinite").with("filename", string("map"));
    let cases = [
        ("constant", Entity::new("infinite"), at(Point3::ORIGIN)),
        ("image", image.clone(), at(Point3::ORIGIN)),
        ("portal", image.clone().with("portal", portal([0, 1, 2, 3])), at(Point3::new(0.3, 0.1, 0.0))),
        ("other side", image.clone().with("portal", portal([3, 2, 1, 0])), at(Point3::new(0.3, 0.1, 4.0))),
        ("near portal", image.with("portal", portal([0, 1, 2, 3])), at(Point3::new(-0.4, 0.2, 1.9))),
        ("constant portal", Entity::new("infinite").with("portal", portal([0, 1, 2, 3])), at(Point3::ORIGIN)),
    ];
    cases
        .into_iter()
        .map(|(name, entity, reference)| {
            let world = World::new(&[placed(entity, tilted())], Vec::new(), &assets);
            let _ = world.light();
            (name, world, reference)
        })
        .collect()
}

#[test]
fn directions_to_lights_at_infinity_have_the_density_they_claim() {
    // Chi-square of samples against pdf_w, the integral of which is 1.
    for (name, world, reference) in infinite_worlds() {
        let (context, light, lambda) = (world.context(), world.light(), some_wavelengths());
        let sample =
            |rng: &mut Rng| light.sample_li(&context, &reference, rng.next_point2(), &lambda).map(|s| s.wi);
        let pdf = |w: Vector3| light.pdf_li(&context, &reference, w);
        sphere_chi_square(60_000, seed(name), sample, pdf, SIGNIFICANCE)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        let total = integrate_sphere(|w| f64::from(pdf(w)), 1e-4);
        assert!((total - 1.0).abs() < 3e-3, "{name}: the density integrates to {total}");
    }
}

#[test]
fn sampling_and_evaluating_an_environment_agree() {
    // Light found by sampling and by chance must be the same, or multiple importance sampling is biased.
    for (name, world, reference) in infinite_worlds() {
        let (context, light, lambda) = (world.context(), world.light(), some_wavelengths());
        let mut rng = rng(name);
        let mut n_edge = 0;
        for _ in 0..2000 {
            let Some(s) = light.sample_li(&context, &reference, rng.next_point2(), &lambda) else { continue };
            assert!(s.distance.is_infinite() && !s.is_delta && s.p_light.is_none());
            let le = light.le_infinite(&context, reference.p, s.wi, &lambda);
            let pdf_w = light.pdf_li(&context, &reference, s.wi);
            let same = (le[0] - s.le[0]).abs() <= 1e-4 * s.le[0] && (pdf_w - s.pdf_w).abs() <= 1e-3 * s.pdf_w;
            // Rounding may move a direction over the edge of a texel.
            n_edge += usize::from(!same);
        }
        assert!(n_edge <= 10, "{name}: {n_edge} of 2000 samples disagree");
    }
}

#[test]
fn a_portal_is_dark_beside_the_opening_and_the_picture_shines_through_it() {
    // Through the opening, the portal shows what the whole picture shows in that direction, up to resampling.
    let worlds = infinite_worlds();
    let (_, constant, reference) = &worlds[5];
    let (context, light, lambda) = (constant.context(), constant.light(), some_wavelengths());
    let through = Vector3::new(0.1, 0.05, 1.0).normalized();
    let beside = Vector3::new(2.0, 0.0, 1.0).normalized();
    let le = |direction| light.le_infinite(&context, reference.p, direction, &lambda);
    assert!(le(beside).is_black());
    assert!(le(-through).is_black());
    let sky = World::of(Entity::new("infinite"));
    let expected = sky.light().le_infinite(&sky.context(), reference.p, through, &lambda);
    assert_close(f64::from(le(through)[1]), f64::from(expected[1]), 1e-3);
}

#[test]
fn emitted_rays_have_the_density_they_claim() {
    // Chi-square of emitted directions against pdf_w, for every light that is not a surface.
    let picture = || Some(grey_picture(8));
    let kinds = [
        ("point", Entity::new("point"), None),
        (
            "spot",
            Entity::new("spot").with("coneangle", floats(&[60.0])).with("conedeltaangle", floats(&[40.0])),
            None,
        ),
        ("gonio", Entity::new("goniometric").with("filename", string("map")), picture()),
        ("projection", Entity::new("projection").with("filename", string("map")), picture()),
        ("sky", Entity::new("infinite"), None),
        ("map", Entity::new("infinite").with("filename", string("map")), picture()),
    ];
    for (name, entity, picture) in kinds {
        let world = World::with_picture(entity, picture);
        let (context, light, lambda) = (world.context(), world.light(), some_wavelengths());
        let sample = |rng: &mut Rng| {
            light.sample_le(&context, rng.next_point2(), rng.next_point2(), &lambda).map(|s| s.ray.direction)
        };
        let pdf = |w: Vector3| light.pdf_le(&context, &Ray::new(Point3::ORIGIN, w), None).1;
        sphere_chi_square(60_000, seed(name), sample, pdf, SIGNIFICANCE)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        let mut rng = rng(name);
        for _ in 0..200 {
            let s =
                light.sample_le(&context, rng.next_point2(), rng.next_point2(), &lambda).expect("it emits");
            let (_, pdf_w) = light.pdf_le(&context, &s.ray, None);
            assert!((pdf_w - s.pdf_w).abs() <= 2e-3 * s.pdf_w, "{name}: {pdf_w} and {}", s.pdf_w);
        }
    }
}

#[test]
fn rays_from_a_portal_carry_the_flux_of_the_opening() {
    // Phi = A pi L for a window under a uniform sky of 1 cd/m^2; the opening measures 2 m by 1 m.
    let worlds = infinite_worlds();
    let (_, world, _) = &worlds[5];
    let (context, light) = (world.context(), world.light());
    assert_close(light.power(&context).lumens, 2.0 * std::f64::consts::PI, 1e-2);
    let lambda = some_wavelengths();
    let mut rng = rng("portal flux");
    for _ in 0..100 {
        let Some(s) = light.sample_le(&context, rng.next_point2(), rng.next_point2(), &lambda) else {
            continue;
        };
        assert!(s.ray.direction.z < 0.0, "light enters downwards");
        assert!(s.ray.origin.z > 2.0, "light starts before the opening");
        let q = s.ray.origin + s.ray.direction * ((2.0 - s.ray.origin.z) / s.ray.direction.z);
        assert!(q.x.abs() <= 1.0 + 1e-5 && q.y.abs() <= 0.5 + 1e-5);
        let (pdf_a, pdf_w) = light.pdf_le(&context, &s.ray, None);
        assert_close(f64::from(pdf_a), f64::from(s.pdf_a), 1e-2);
        assert_close(f64::from(pdf_w), f64::from(s.pdf_w), 1e-2);
    }
}

#[test]
fn a_spot_is_full_within_its_cone_and_dark_outside() {
    // The edge is a cubic step of the cosine: half way between the cosines, intensity is one half.
    let entity = Entity::new("spot").with("from", point(0.0, 0.0, 0.0)).with("to", point(0.0, 0.0, -2.0));
    let world = World::of(entity);
    let (context, light, lambda) = (world.context(), world.light(), some_wavelengths());
    let at_angle = |angle: f32| {
        let reference = at(Point3::new(angle.sin(), 0.0, -angle.cos()));
        light.sample_li(&context, &reference, Point2::splat(0.5), &lambda).map_or(0.0, |s| s.le[0])
    };
    let full = at_angle(0.0);
    assert!(full > 0.0);
    assert_close(f64::from(at_angle(24.9_f32.to_radians())), f64::from(full), 1e-3);
    assert_eq!(at_angle(30.1_f32.to_radians()), 0.0);
    assert_eq!(at_angle(3.0), 0.0);
    let middle = ((30.0_f32.to_radians().cos() + 25.0_f32.to_radians().cos()) / 2.0).acos();
    assert_close(f64::from(at_angle(middle)), f64::from(full) / 2.0, 1e-3);
}

#[test]
fn a_projector_shows_its_picture_upright() {
    // 2 x 1 texels, top row in front above: fov 90 degrees spans the shorter side; +y is the top of the picture.
    let picture = Texels::from_fn(2, 2, 3, |x, y, _| [[1.0, 2.0], [3.0, 4.0]][y][x]);
    let entity = Entity::new("projection").with("filename", string("map"));
    let world = World::with_picture(entity, Some(picture));
    let (context, light, lambda) = (world.context(), world.light(), some_wavelengths());
    let value = |x: f32, y: f32| {
        let reference = at(Point3::new(x, y, 1.0));
        let r2 = x * x + y * y + 1.0;
        light.sample_li(&context, &reference, Point2::splat(0.5), &lambda).map_or(0.0, |s| s.le[0] * r2)
    };
    let unit = value(-0.5, 0.5);
    assert_close(f64::from(value(0.5, 0.5) / unit), 2.0, 1e-3);
    assert_close(f64::from(value(-0.5, -0.5) / unit), 3.0, 1e-3);
    assert_close(f64::from(value(0.99, -0.99) / unit), 4.0, 1e-3);
    assert_eq!(value(1.01, 0.0), 0.0);
    assert_eq!(value(0.0, -1.01), 0.0);
    let behind = at(Point3::new(0.0, 0.0, -1.0));
    assert!(light.sample_li(&context, &behind, Point2::splat(0.5), &lambda).is_none());
}

#[test]
fn environment_and_goniometric_pictures_follow_the_transform() {
    // Turning the light turns the picture with it.
    let mut assets = Assets::default();
    assets.images.insert("map".to_owned(), Arc::new(grey_picture(8)));
    let lambda = some_wavelengths();
    let mut rng = rng("transform");
    let sky = Entity::new("infinite").with("filename", string("map"));
    let straight = World::new(&[placed(sky.clone(), Transform::IDENTITY)], Vec::new(), &assets);
    let turned = World::new(&[placed(sky, tilted())], Vec::new(), &assets);
    let gonio = Entity::new("goniometric").with("filename", string("map"));
    let straight_gonio = World::new(&[placed(gonio.clone(), Transform::IDENTITY)], Vec::new(), &assets);
    let turned_gonio = World::new(&[placed(gonio, tilted())], Vec::new(), &assets);
    for _ in 0..100 {
        let uv = Point2::new(
            0.5 / 8.0 + (rng.next_below(8) as f32) / 8.0,
            0.5 / 8.0 + (rng.next_below(8) as f32) / 8.0,
        );
        let w = warp::equal_area_square_to_sphere(uv);
        let expected = grey_value(8, (uv.x * 8.0) as usize, (uv.y * 8.0) as usize);
        let le =
            |world: &World, w| world.light().le_infinite(&world.context(), Point3::ORIGIN, w, &lambda)[0];
        let white = le(&straight, warp::equal_area_square_to_sphere(Point2::new(0.5 / 8.0, 0.5 / 8.0))) / 0.1;
        assert!((le(&straight, w) - expected * white).abs() <= 2e-3 * white);
        assert!((le(&turned, tilted().vector(w)) - expected * white).abs() <= 2e-3 * white);
        // The goniometric picture's pole is +y: y and z change places.
        let li = |world: &World, w: Vector3| {
            let reference = at(Point3::ORIGIN + w);
            let li = world.light().sample_li(&world.context(), &reference, Point2::splat(0.5), &lambda);
            li.map_or(0.0, |s| s.le[0])
        };
        let swapped = Vector3::new(w.x, w.z, w.y);
        assert!((li(&straight_gonio, swapped) - expected * white).abs() <= 2e-3 * white);
        assert!((li(&turned_gonio, tilted().vector(swapped)) - expected * white).abs() <= 2e-3 * white);
    }
}

#[test]
fn black_pictures_emit_nothing_and_break_nothing() {
    // A light without light has no samples, zero density and zero power.
    for kind in ["infinite", "goniometric", "projection"] {
        let entity = Entity::new(kind).with("filename", string("map"));
        let black = Texels::from_fn(4, 4, 3, |_, _, _| 0.0);
        let world = World::with_picture(entity, Some(black));
        let (context, light, lambda) = (world.context(), world.light(), some_wavelengths());
        assert_eq!(light.power(&context).weight, 0.0);
        let mut rng = rng(kind);
        for _ in 0..20 {
            let (u, v) = (rng.next_point2(), rng.next_point2());
            let li = light.sample_li(&context, &at(Point3::new(0.1, 0.2, 1.0)), u, &lambda);
            assert!(li.is_none());
            let emitted = light.sample_le(&context, u, v, &lambda);
            assert!(emitted.is_none_or(|ray| ray.le.is_black() && ray.pdf_w.is_finite()));
        }
    }
}
