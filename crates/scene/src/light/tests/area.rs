//! Surfaces that emit.

use std::f64::consts::PI;

use etendue_geometry::TriangleMesh;
use etendue_math::statistics::{Moments, mean_test, sphere_chi_square};
use etendue_math::{Point2, Ray};

use super::*;

fn sphere(radius: f32) -> Shape {
    Shape::Sphere { radius, z_min: -radius, z_max: radius, phi_max_rad: 2.0 * std::f32::consts::PI }
}

fn disk(radius: f32) -> Shape {
    Shape::Disk { height: 0.0, radius, inner_radius: 0.0, phi_max_rad: 2.0 * std::f32::consts::PI }
}

/// The rectangle |x| <= a, |y| <= b at z = 0 with normal +z, (u, v) from the lower left corner.
fn rectangle(a: f32, b: f32) -> Shape {
    Shape::Triangles(TriangleMesh {
        positions: vec![
            Point3::new(-a, -b, 0.0),
            Point3::new(a, -b, 0.0),
            Point3::new(a, b, 0.0),
            Point3::new(-a, b, 0.0),
        ],
        indices: vec![[0, 1, 2], [0, 2, 3]],
        uvs: vec![Point2::new(0.0, 0.0), Point2::new(1.0, 0.0), Point2::new(1.0, 1.0), Point2::new(0.0, 1.0)],
        ..TriangleMesh::default()
    })
}

fn emitter(shape: Shape, entity: Entity) -> World {
    let world = World::new(&[], vec![(shape, Transform::IDENTITY, entity)], &Assets::default());
    let _ = world.light();
    world
}

/// Value at the first wavelength of D65 of luminance 1.
fn white(world: &World) -> f64 {
    let mut spectra = world.spectra.clone();
    let table = spectra.illuminant(etendue_spectrum::ColorSpaceName::Srgb);
    f64::from(spectra.sample(table, &some_wavelengths())[0]) / luminance(|l| spectra.sample(table, l))
}

/// Illuminance at a point from all lights, unoccluded, for white lights.
fn irradiance(world: &World, reference: &Reference, n: usize, name: &str) -> Moments {
    let (context, lambda) = (world.context(), some_wavelengths());
    let mut rng = rng(name);
    let white = white(world);
    let normal = reference.n.expect("a plane has a normal");
    (0..n)
        .map(|_| {
            let light = |light: &Light, u| {
                let Some(s) = light.sample_li(&context, reference, u, &lambda) else { return 0.0 };
                f64::from(s.le[0] * normal.dot_vector(s.wi).max(0.0) / s.pdf_w) / white
            };
            world.lights.iter().map(|it| light(it, rng.next_point2())).sum::<f64>()
        })
        .collect()
}

#[test]
fn lights_of_meshes_are_small() {
    // A mesh of a hundred thousand emissive triangles is as many lights, each with its three corners and their normal.
    assert!(size_of::<Light>() <= 80, "{}", size_of::<Light>());
}

#[test]
fn a_spherical_light_is_a_point_light_from_afar() {
    // EMI-5: radiance is Phi / (4 pi^2 R^2); at distance r >> R, E = Phi / (4 pi r^2).
    let (phi, radius) = (1000.0, 0.1_f32);
    let world = emitter(sphere(radius), Entity::new("diffuse").with("power", floats(&[phi as f32])));
    let (light, context) = (world.light(), world.context());
    let n = Normal3::new(0.0, 0.0, 1.0);
    let le = luminance(|l| light.le(&context, n, Point2::splat(0.5), n.as_vector(), l));
    assert_close(le, phi / (4.0 * PI * PI * f64::from(radius).powi(2)), 1e-3);
    for distance in [0.2_f32, 1.0, 30.0] {
        // A sphere that is wholly above the horizon lights a facing plane like a point, at any distance.
        let reference = facing(Point3::new(0.0, 0.0, -distance), Vector3::new(0.0, 0.0, 1.0));
        let e = irradiance(&world, &reference, 4000, "sphere");
        let expected = phi / (4.0 * PI * f64::from(distance).powi(2));
        mean_test(&e, expected, SIGNIFICANCE)
            .or_else(|error| {
                // Seen from afar the estimate has no noise but that of rounding.
                if (e.mean() / expected - 1.0).abs() < 1e-3 { Ok(1.0) } else { Err(error) }
            })
            .expect("E = Phi / (4 pi r^2)");
    }
}

#[test]
fn a_rectangle_lights_a_facing_point_by_its_form_factor() {
    // EMI-6: E = pi L F; over the middle of a rectangle 2a x 2b at height h, F is four corner terms
    // (A/sqrt(1+A^2) atan(B/sqrt(1+A^2)) + B/sqrt(1+B^2) atan(A/sqrt(1+B^2))) / (2 pi), A = a/h, B = b/h.
    let (a, b) = (0.8_f64, 0.5_f64);
    let world = emitter(rectangle(a as f32, b as f32), Entity::new("diffuse").with("scale", floats(&[12.0])));
    for h in [0.2_f64, 0.7, 5.0] {
        let (x, y) = (a / h, b / h);
        let (rx, ry) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
        let corner = (x / rx * (y / rx).atan() + y / ry * (x / ry).atan()) / (2.0 * PI);
        let expected = PI * 12.0 * 4.0 * corner;
        let above = facing(Point3::new(0.0, 0.0, h as f32), Vector3::new(0.0, 0.0, -1.0));
        let e = irradiance(&world, &above, 20_000, "rectangle");
        mean_test(&e, expected, SIGNIFICANCE).expect("E = pi L F");
        // The back is dark.
        let below = facing(Point3::new(0.0, 0.0, -h as f32), Vector3::new(0.0, 0.0, 1.0));
        assert_eq!(irradiance(&world, &below, 100, "back").mean(), 0.0);
    }
}

#[test]
fn radiance_does_not_depend_on_distance_or_angle() {
    // RAD-7, RAD-8: a uniform emitter has the same radiance wherever it is seen from.
    let world = emitter(disk(0.3), Entity::new("diffuse").with("L", rgb(0.4, 0.5, 0.6)));
    let (light, context, lambda) = (world.light(), world.context(), some_wavelengths());
    let mut rng = rng("radiance");
    let mut first = None;
    for distance in [0.1_f32, 1.0, 100.0] {
        for angle in [0.0_f32, 0.7, 1.4] {
            let p = Point3::new(distance * angle.sin(), 0.0, distance * angle.cos());
            let s =
                light.sample_li(&context, &at(p), rng.next_point2(), &lambda).expect("the front is bright");
            assert_eq!(s.le, *first.get_or_insert(s.le));
        }
    }
}

#[test]
fn the_flux_of_a_diffuse_disk_is_pi_squared_r_squared_l() {
    // RAD-9: Phi = integral of L cos over area and solid angle = pi^2 R^2 L; both sides give twice that.
    for (two_sided, sides) in [(false, 1.0), (true, 2.0)] {
        let entity = Entity::new("diffuse")
            .with("scale", floats(&[4.0]))
            .with("twosided", Value::Bools(vec![two_sided]));
        let world = emitter(disk(0.3), entity);
        let (light, context, lambda) = (world.light(), world.context(), some_wavelengths());
        let expected = sides * PI * PI * 0.09 * 4.0;
        assert_close(light.power(&context).lumens, expected, 1e-3);
        let white = white(&world);
        let mut rng = rng("disk");
        for _ in 0..100 {
            let s = light
                .sample_le(&context, rng.next_point2(), rng.next_point2(), &lambda)
                .expect("every number gives a ray");
            let flux = f64::from(s.le[0] * s.cosine / (s.pdf_a * s.pdf_w)) / white;
            assert_close(flux, expected, 2e-3);
            let (pdf_a, pdf_w) = light.pdf_le(&context, &s.ray, s.n);
            assert_close(f64::from(pdf_a), f64::from(s.pdf_a), 1e-3);
            assert_close(f64::from(pdf_w), f64::from(s.pdf_w), 2e-3);
        }
    }
}

#[test]
fn power_of_a_mesh_is_that_of_the_whole_shape() {
    // Two triangles of different size share 600 lm by area.
    let mesh = Shape::Triangles(TriangleMesh {
        positions: vec![
            Point3::new(0.0, 0.0, 0.0),
            Point3::new(1.0, 0.0, 0.0),
            Point3::new(0.0, 1.0, 0.0),
            Point3::new(-3.0, 0.0, 0.0),
        ],
        indices: vec![[0, 1, 2], [0, 2, 3]],
        ..TriangleMesh::default()
    });
    let entity = Entity::new("diffuse").with("power", floats(&[600.0])).with("L", rgb(0.3, 0.9, 0.1));
    let world = emitter(mesh, entity);
    let powers: Vec<f64> = world.lights.iter().map(|light| light.power(&world.context()).lumens).collect();
    assert_close(powers[0], 150.0, 1e-3);
    assert_close(powers[1], 450.0, 1e-3);
}

#[test]
fn a_pictured_light_shows_its_picture_the_right_way_up() {
    // The top row of the picture is at v = 1; `power` counts the picture's mean.
    let mut assets = Assets::default();
    let picture = Texels::from_fn(2, 2, 3, |x, y, _| [[1.0, 2.0], [3.0, 4.0]][y][x]);
    assets.images.insert("map".to_owned(), Arc::new(picture));
    let entity = Entity::new("diffuse").with("filename", string("map")).with("power", floats(&[90.0]));
    let world = World::new(&[], vec![(rectangle(1.0, 1.0), Transform::IDENTITY, entity)], &assets);
    let (light, context) = (world.light(), world.context());
    let n = Normal3::new(0.0, 0.0, 1.0);
    let le = |u, v| luminance(|l| light.le(&context, n, Point2::new(u, v), n.as_vector(), l));
    let unit = 90.0 / (2.5 * PI * 4.0);
    for (u, v, value) in [(0.1, 0.9, 1.0), (0.9, 0.9, 2.0), (0.1, 0.1, 3.0), (0.9, 0.1, 4.0), (0.5, 0.5, 2.5)]
    {
        assert_close(le(u, v), value * unit, 2e-3);
    }
    let total: f64 = world.lights.iter().map(|light| light.power(&context).lumens).sum();
    assert_close(total, 90.0, 1e-3);
}

#[test]
fn directions_to_surfaces_have_the_density_they_claim() {
    // EMI-13: chi-square of sampled directions; the density of a point found by a ray is the same.
    let shapes = [
        ("triangle", rectangle(0.8, 0.5), Point3::new(0.4, -0.3, 0.6)),
        ("disk", disk(0.7), Point3::new(0.9, 0.2, 0.5)),
        ("sphere", sphere(0.5), Point3::new(0.9, 0.2, 0.5)),
    ];
    for (name, shape, p) in shapes {
        let world = emitter(shape, Entity::new("diffuse").with("twosided", Value::Bools(vec![true])));
        let (light, context, lambda) = (world.light(), world.context(), some_wavelengths());
        let reference = facing(p, Vector3::new(-0.6, 0.0, -0.8));
        let sample =
            |rng: &mut Rng| light.sample_li(&context, &reference, rng.next_point2(), &lambda).map(|s| s.wi);
        let pdf = |w: Vector3| light.pdf_li(&context, &reference, w);
        sphere_chi_square(40_000, seed(name), sample, pdf, SIGNIFICANCE)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        let mut rng = rng(name);
        for _ in 0..200 {
            let Some(s) = light.sample_li(&context, &reference, rng.next_point2(), &lambda) else { continue };
            let point = s.p_light.expect("a surface has points");
            let n = point.n.expect("a surface has normals");
            let pdf_w = light.pdf_li_at(&context, &reference, s.wi, point.p, n);
            assert!((pdf_w - s.pdf_w).abs() <= 1e-2 * s.pdf_w, "{name}: {pdf_w} and {}", s.pdf_w);
            assert!((point.p - (p + s.wi * s.distance)).length() < 1e-4);
            assert!(world.geometry.intersect(&Ray::new(p, s.wi), s.distance * 1.01, &|_| true).is_some());
        }
    }
}
