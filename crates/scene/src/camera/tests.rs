//! Tests of cameras.

use etendue_math::statistics::{Moments, mean_test};
use etendue_math::{
    AnimatedTransform, Bounds2, Normal3, Point2, Point3, Ray, Rng, Transform, Vector3, hash64, warp,
};

use super::*;
use crate::assets::Assets;
use crate::document::{Entity, Value};
use crate::parameters::{BuildContext, Parameters};

mod fisheye;
mod lens;
mod realistic;

const SIGNIFICANCE: f64 = 1e-5;
const MIDDLE: Point2 = Point2::new(0.5, 0.5);

fn whole(resolution: [u32; 2]) -> Bounds2 {
    Bounds2::new(Point2::new(0.0, 0.0), Point2::new(resolution[0] as f32, resolution[1] as f32))
}

/// A camera at the origin, looking along +z.
fn camera(projection: Projection, resolution: [u32; 2]) -> Camera {
    let fixed = AnimatedTransform::constant(Transform::IDENTITY);
    Camera::new(projection, fixed, Shutter::default(), resolution, whole(resolution))
}

fn screen(resolution: [u32; 2]) -> Screen {
    let size = [resolution[0] as f32, resolution[1] as f32];
    Screen { window: ScreenWindow::from_aspect(size[0] / size[1]), resolution: size }
}

fn perspective(fov_deg: f32, lens: Lens, resolution: [u32; 2]) -> Projection {
    let tan_half_fov = (fov_deg.to_radians() / 2.0).tan();
    Projection::Perspective(Perspective { screen: screen(resolution), tan_half_fov, lens })
}

fn orthographic(lens: Lens, resolution: [u32; 2]) -> Projection {
    Projection::Orthographic(Orthographic { screen: screen(resolution), lens })
}

fn spherical(mapping: SphericalMapping, resolution: [u32; 2]) -> Projection {
    Projection::Spherical(Spherical { resolution: [resolution[0] as f32, resolution[1] as f32], mapping })
}

/// A circle that goes around the whole film, so that every raster position has a ray.
fn fisheye(mapping: FisheyeMapping, fov_deg: f32, resolution: [u32; 2]) -> Projection {
    let aspect = resolution[0] as f32 / resolution[1] as f32;
    let screen = Screen {
        window: ScreenWindow { x: [-0.55 * aspect, 0.55 * aspect], y: [-0.55, 0.55] },
        ..screen(resolution)
    };
    Projection::Fisheye(Fisheye { screen, mapping, half_fov_rad: fov_deg.to_radians() / 2.0 })
}

const PENTAGON: Lens = Lens { blades: Some(Blades { n: 5, rotation_rad: 0.3 }), ..LENS };
const LENS: Lens = Lens { radius: 0.3, blades: None, focal_distance: 3.0 };

/// Cameras that are a point, and look beyond a plane.
const fn is_point(projection: &Projection) -> bool {
    matches!(projection, Projection::Spherical(_) | Projection::Fisheye(_))
}

/// Every kind of camera, seeing the plane z = 5 within |x|, |y| < 5.
fn all_kinds(resolution: [u32; 2]) -> Vec<(&'static str, Projection)> {
    vec![
        ("pinhole", perspective(60.0, Lens::PINHOLE, resolution)),
        ("thin lens", perspective(60.0, LENS, resolution)),
        ("orthographic", orthographic(Lens::PINHOLE, resolution)),
        ("telecentric lens", orthographic(LENS, resolution)),
        ("equal area", spherical(SphericalMapping::EqualArea, resolution)),
        ("equirectangular", spherical(SphericalMapping::Equirectangular, resolution)),
        ("pentagon", perspective(60.0, PENTAGON, resolution)),
        ("telecentric pentagon", orthographic(PENTAGON, resolution)),
        ("equidistant", fisheye(FisheyeMapping::Equidistant, 170.0, resolution)),
        ("equisolid", fisheye(FisheyeMapping::Equisolid, 300.0, resolution)),
        ("stereographic", fisheye(FisheyeMapping::Stereographic, 250.0, resolution)),
        ("orthographic fisheye", fisheye(FisheyeMapping::Orthographic, 179.0, resolution)),
    ]
}

fn random_ray(camera: &Camera, resolution: [u32; 2], rng: &mut Rng) -> (Point2, Ray) {
    let u = rng.next_point2();
    let p_film = Point2::new(u.x * resolution[0] as f32, u.y * resolution[1] as f32);
    (p_film, camera.sample_ray(p_film, rng.next_point2(), 0.0).unwrap().ray)
}

fn read(entity: &Entity, resolution: [u32; 2]) -> (Camera, usize) {
    let assets = Assets::default();
    let mut context = BuildContext::new(&assets);
    let mut parameters = Parameters::new(entity, &mut context);
    let fixed = AnimatedTransform::constant(Transform::IDENTITY);
    let camera = Camera::from_parameters(&mut parameters, fixed, resolution, 0.035, whole(resolution));
    parameters.finish();
    (camera, context.diagnostics.list().len())
}

/// A thing of known angular size covers the predicted pixels: with a view of 2 a, the angle b ends tan b / tan a of the
/// way from the middle to the border (CAM-1).
#[test]
fn cam_1_known_angle_covers_predicted_pixels() {
    let camera = camera(perspective(90.0, Lens::PINHOLE, [100, 100]), [100, 100]);
    let edge = |angle_deg: f32| {
        let angle = angle_deg.to_radians();
        camera.project(Point3::new(7.0 * angle.sin(), 0.0, 7.0 * angle.cos()), 0.0).unwrap()
    };
    for angle in [-40.0_f32, -10.0, 0.0, 5.0, 30.0, 44.0] {
        let p = edge(angle);
        assert!((p.x - (50.0 + 50.0 * angle.to_radians().tan())).abs() < 1e-3, "{angle}: {p:?}");
        assert!((p.y - 50.0).abs() < 1e-3);
    }
    let corner = camera.sample_ray(Point2::new(0.0, 0.0), MIDDLE, 0.0).unwrap().ray.direction;
    let expected = Vector3::new(-1.0, 1.0, 1.0).normalized();
    assert!((corner - expected).length() < 1e-6, "x to the right, y up: {corner:?}");
}

/// The tangent is scaled, not the angle: pixels are square in wide and tall images, and fov is that of the shorter side.
#[test]
fn cam_1_pixels_are_square() {
    for resolution in [[200, 100], [100, 200], [64, 64]] {
        let camera = camera(perspective(60.0, Lens::PINHOLE, resolution), resolution);
        let on_plane = |x: f32, y: f32| {
            let d = camera.sample_ray(Point2::new(x, y), MIDDLE, 0.0).unwrap().ray.direction;
            Vector3::new(d.x / d.z, d.y / d.z, 1.0)
        };
        let (x, y) = (resolution[0] as f32 / 3.0, resolution[1] as f32 / 5.0);
        let step_x = (on_plane(x + 1.0, y) - on_plane(x, y)).length();
        let step_y = (on_plane(x, y + 1.0) - on_plane(x, y)).length();
        let shorter = resolution[0].min(resolution[1]) as f32;
        let expected = 2.0 * 30.0_f32.to_radians().tan() / shorter;
        assert!((step_x / expected - 1.0).abs() < 1e-3, "{resolution:?}: {step_x} but {expected}");
        assert!((step_y / expected - 1.0).abs() < 1e-3, "{resolution:?}: {step_y} but {expected}");
    }
}

/// Parallel rays: the image of a rod has the same size at any distance (CAM-2).
#[test]
fn cam_2_size_does_not_depend_on_distance() {
    let camera = camera(orthographic(Lens::PINHOLE, [80, 40]), [80, 40]);
    let size = |z: f32| {
        let top = camera.project(Point3::new(0.3, 0.5, z), 0.0).unwrap();
        let bottom = camera.project(Point3::new(0.3, -0.5, z), 0.0).unwrap();
        bottom.y - top.y
    };
    for z in [0.1, 1.0, 1000.0] {
        assert!((size(z) - 20.0).abs() < 1e-4, "1 m of a window 2 m high is half of 40 pixels: {}", size(z));
    }
    let mut rng = Rng::new(1, 1);
    for _ in 0..100 {
        let (_, ray) = random_ray(&camera, [80, 40], &mut rng);
        assert_eq!(ray.direction, Vector3::new(0.0, 0.0, 1.0));
    }
}

/// A point out of focus is spread over a disc of diameter A f |d - d_f| / (d (d_f - f)) on the film (CAM-3).
#[test]
fn cam_3_circle_of_confusion() {
    // 50 mm at f/2 on a film 24 mm high, focused at 2 m.
    let (focal_length, f_number, focal_distance, film) = (0.05, 2.0, 2.0, 0.024);
    let lens = Lens::from_f_number(focal_length, f_number, focal_distance);
    assert!((lens.radius - 0.0125).abs() < 1e-9);
    let fov = field_of_view(film, focal_length, focal_distance).to_degrees();
    let resolution = [600, 400];
    let camera = camera(perspective(fov, lens, resolution), resolution);
    let mut rng = Rng::new(3, 1);
    for distance in [0.7_f32, 1.5, 2.0, 3.0, 20.0] {
        let (mut min, mut max) = (f32::INFINITY, f32::NEG_INFINITY);
        for _ in 0..20_000 {
            let sample = camera.sample_wi(Point3::new(0.0, 0.0, distance), 0.0, rng.next_point2()).unwrap();
            min = min.min(sample.p_film.x);
            max = max.max(sample.p_film.x);
        }
        let found = (max - min) * film / resolution[1] as f32;
        let expected = circle_of_confusion(2.0 * lens.radius, focal_length, focal_distance, distance);
        assert!((found - expected).abs() < 0.01 * expected + 1e-7, "at {distance} m: {found} but {expected}");
    }
}

/// What lies in the plane of focus is sharp: all rays of a pixel meet there, and only there (CAM-3).
#[test]
fn cam_3_plane_of_focus_is_sharp() {
    let resolution = [64, 48];
    for projection in [perspective(50.0, LENS, resolution), orthographic(LENS, resolution)] {
        let camera = camera(projection, resolution);
        let mut rng = Rng::new(4, 1);
        let p_film = Point2::new(10.0, 40.0);
        let mut spread = [0.0_f32; 2];
        let at = |ray: &Ray, z: f32| ray.at((z - ray.origin.z) / ray.direction.z);
        let first = camera.sample_ray(p_film, Point2::new(0.1, 0.2), 0.0).unwrap().ray;
        for _ in 0..100 {
            let ray = camera.sample_ray(p_film, rng.next_point2(), 0.0).unwrap().ray;
            for (i, z) in [LENS.focal_distance, 2.0 * LENS.focal_distance].into_iter().enumerate() {
                spread[i] = spread[i].max(at(&ray, z).distance(at(&first, z)));
            }
        }
        assert!(spread[0] < 1e-5, "{spread:?}");
        assert!(spread[1] > 0.1, "{spread:?}");
    }
}

/// A small aperture becomes a pinhole, without a jump.
#[test]
fn cam_3_small_apertures_approach_the_pinhole() {
    let resolution = [64, 48];
    let narrow = Lens { radius: 1e-5, blades: None, focal_distance: 3.0 };
    for (with, without) in [
        (perspective(50.0, narrow, resolution), perspective(50.0, Lens::PINHOLE, resolution)),
        (orthographic(narrow, resolution), orthographic(Lens::PINHOLE, resolution)),
    ] {
        let mut rng = Rng::new(5, 1);
        for _ in 0..50 {
            let u = rng.next_point2();
            let p_film = Point2::new(64.0 * u.x, 48.0 * u.y);
            let a = camera(with.clone(), resolution).sample_ray(p_film, u, 0.0).unwrap().ray;
            let b = camera(without.clone(), resolution).sample_ray(p_film, u, 0.0).unwrap().ray;
            assert!(a.origin.distance(b.origin) < 2e-5);
            assert!((a.direction - b.direction).length() < 2e-5);
        }
    }
}

/// A panorama shows each direction once: direction and place on the film determine each other.
#[test]
fn spherical_round_trip() {
    let resolution = [128, 128];
    for mapping in [SphericalMapping::EqualArea, SphericalMapping::Equirectangular] {
        let camera = camera(spherical(mapping, resolution), resolution);
        let mut rng = Rng::new(6, mapping as u64);
        for _ in 0..2000 {
            let (p_film, ray) = random_ray(&camera, resolution, &mut rng);
            let back = camera.we(&ray).unwrap().p_film;
            assert!((back - p_film).length() < 2e-2, "{mapping:?}: {p_film:?} became {back:?}");
        }
    }
    let up = camera(spherical(SphericalMapping::Equirectangular, resolution), resolution);
    let top = up.sample_ray(Point2::new(64.0, 0.0), MIDDLE, 0.0).unwrap().ray.direction;
    assert!((top - Vector3::new(0.0, 1.0, 0.0)).length() < 1e-6, "the first row is straight up: {top:?}");
}

/// The density of directions is the inverse of the solid angle that a patch of random numbers is spread over, found by
/// finite differences: raster positions for a fixed point of the lens, or lens points for a fixed raster position where
/// the direction depends on the lens alone.
#[test]
fn directions_have_their_density() {
    let resolution = [40, 30];
    let step = 4e-3_f32;
    for (i, (name, projection)) in all_kinds(resolution).into_iter().enumerate() {
        if name == "orthographic" {
            continue;
        }
        let is_by_lens = matches!(projection, Projection::Orthographic(_));
        let camera = camera(projection, resolution);
        let mut rng = Rng::new(hash64(&[40, i as u64]), 1);
        for _ in 0..300 {
            let (film, lens) = (rng.next_point2(), rng.next_point2());
            let ray = |u: Point2| {
                let (film, lens) = if is_by_lens { (film, u) } else { (u, lens) };
                let p_film = Point2::new(film.x * resolution[0] as f32, film.y * resolution[1] as f32);
                camera.sample_ray(p_film, lens, 0.0).unwrap().ray
            };
            let u = if is_by_lens { lens } else { film };
            // The warps of disc and sphere have creases at the middle, the diagonals and the border, that of a pentagon
            // at its corners.
            let (x, y) = (2.0 * u.x - 1.0, 2.0 * u.y - 1.0);
            let to_crease =
                x.abs().min(y.abs()).min((x.abs() - y.abs()).abs()).min((1.0 - x.abs() - y.abs()).abs());
            let from_corner = (5.0 * u.x - (5.0 * u.x).round()).abs();
            if to_crease < 0.1 || x.abs().max(y.abs()) > 0.9 || is_by_lens && from_corner < 0.05 {
                continue;
            }
            let change = |dx: f32, dy: f32| {
                let (a, b) = (Point2::new(u.x - dx, u.y - dy), Point2::new(u.x + dx, u.y + dy));
                (ray(b).direction - ray(a).direction) / (2.0 * step)
            };
            let solid_angle = change(step, 0.0).cross(change(0.0, step)).length();
            let pdf_w = camera.pdf_we(&ray(u)).1;
            assert!((solid_angle * pdf_w - 1.0).abs() < 1e-2, "{name} at {u:?}: {}", solid_angle * pdf_w);
        }
    }
}

/// Importance is the density of camera rays in another measure: `we cos = pdf_a pdf_w`, and the raster position of a ray
/// is the one it was made for.
#[test]
fn importance_is_the_density_of_rays() {
    let resolution = [40, 30];
    for (name, projection) in all_kinds(resolution) {
        if matches!(&projection, Projection::Orthographic(o) if !o.lens.has_area()) {
            continue;
        }
        let is_point = is_point(&projection);
        let camera = camera(projection, resolution);
        let mut rng = Rng::new(9, 9);
        for _ in 0..500 {
            let (p_film, ray) = random_ray(&camera, resolution, &mut rng);
            let Some(importance) = camera.we(&ray) else {
                panic!("{name}: a camera ray at {p_film:?} is not seen by its camera");
            };
            let cos_theta = if is_point { 1.0 } else { ray.direction.z };
            let ratio = importance.we * cos_theta / (importance.pdf_a * importance.pdf_w);
            assert!((ratio - 1.0).abs() < 1e-4, "{name}: {ratio}");
            assert!((importance.p_film - p_film).length() < 2e-2, "{name}");
        }
    }
}

/// Light traced from a glowing wall of radiance 1 to the camera gives the image that camera rays give: 1 in every pixel.
#[test]
fn light_paths_and_camera_paths_agree() {
    let resolution = [4, 3];
    let n_pixels = 12;
    let n_samples = 60_000;
    let half = 5.0_f32;
    for (i, (name, projection)) in all_kinds(resolution).into_iter().enumerate() {
        let is_sphere = is_point(&projection);
        let camera = camera(projection, resolution);
        let mut rng = Rng::new(hash64(&[50, i as u64]), 1);
        let mut pixels = vec![Moments::new(); n_pixels];
        let mut film = Moments::new();
        for _ in 0..n_samples {
            // Uniform points of the square z = 5, or of a sphere of radius 2 for cameras that look everywhere.
            let u = rng.next_point2();
            let (p, n, area) = if is_sphere {
                let d = warp::sample_uniform_sphere(u);
                (Point3::ORIGIN + d * 2.0, -d, 4.0 * std::f32::consts::PI * 4.0)
            } else {
                let p = Point3::new(half * (2.0 * u.x - 1.0), half * (2.0 * u.y - 1.0), 5.0);
                (p, Vector3::new(0.0, 0.0, -1.0), 4.0 * half * half)
            };
            let sample = camera.sample_wi(p, 0.0, rng.next_point2());
            let pixel = sample.map(|s| s.p_film.y as usize * 4 + s.p_film.x as usize);
            let value = sample.map_or(0.0, |s| {
                assert!((s.wi - (s.p_lens - p).normalized()).length() < 1e-5);
                f64::from(area * n.dot(s.wi) * s.we / s.pdf_w) * n_pixels as f64
            });
            film.push(value / n_pixels as f64);
            for (i, moments) in pixels.iter_mut().enumerate() {
                moments.push(if pixel == Some(i) { value } else { 0.0 });
            }
        }
        mean_test(&film, 1.0, SIGNIFICANCE).unwrap_or_else(|message| panic!("{name}: {message}"));
        for (pixel, moments) in pixels.iter().enumerate() {
            mean_test(moments, 1.0, SIGNIFICANCE)
                .unwrap_or_else(|message| panic!("{name}, pixel {pixel}: {message}"));
        }
    }
}

/// A scaled camera is the same camera as long as lens and window are not lengths: what it sees of a glowing wall stays 1.
#[test]
fn scaled_cameras_take_the_same_light() {
    let resolution = [1, 1];
    let stretched = Transform::scale(-2.0, 3.0, 0.5).unwrap();
    for (i, (name, projection)) in all_kinds(resolution).into_iter().enumerate() {
        let is_sphere = is_point(&projection);
        let placed = AnimatedTransform::constant(stretched);
        let camera = Camera::new(projection, placed, Shutter::default(), resolution, whole(resolution));
        let mut rng = Rng::new(hash64(&[51, i as u64]), 1);
        let film: Moments = (0..40_000)
            .map(|_| {
                let u = rng.next_point2();
                let (p, n, area) = if is_sphere {
                    let d = warp::sample_uniform_sphere(u);
                    (Point3::ORIGIN + d * 2.0, -d, 16.0 * std::f32::consts::PI)
                } else {
                    let p = Point3::new(60.0 * u.x - 30.0, 60.0 * u.y - 30.0, 5.0);
                    (p, Vector3::new(0.0, 0.0, -1.0), 3600.0)
                };
                let sample = camera.sample_wi(p, 0.0, rng.next_point2());
                sample.map_or(0.0, |s| f64::from(area * n.dot(s.wi) * s.we / s.pdf_w))
            })
            .collect();
        mean_test(&film, 1.0, SIGNIFICANCE).unwrap_or_else(|message| panic!("{name}: {message}"));
    }
}

/// Light that reaches the film beside the crop counts nothing.
#[test]
fn crop_takes_no_light() {
    let resolution = [100, 100];
    let crop = Bounds2::new(Point2::new(0.0, 0.0), Point2::new(50.0, 100.0));
    let fixed = AnimatedTransform::constant(Transform::IDENTITY);
    let projection = perspective(90.0, Lens::PINHOLE, resolution);
    let camera = Camera::new(projection, fixed, Shutter::default(), resolution, crop);
    assert!(camera.sample_wi(Point3::new(-0.5, 0.0, 2.0), 0.0, MIDDLE).is_some());
    assert!(camera.sample_wi(Point3::new(0.5, 0.0, 2.0), 0.0, MIDDLE).is_none());
    assert!(camera.sample_wi(Point3::new(-0.5, 0.0, -2.0), 0.0, MIDDLE).is_none(), "behind the camera");
}

/// A panorama goes on around its border: a filter at the left edge of a crop takes light that arrives at the right edge of the film.
#[test]
fn cropped_panoramas_take_light_across_the_border() {
    let (resolution, radius) = ([40, 20], 2.0);
    let lit = Bounds2::new(Point2::splat(-radius), Point2::new(10.0 + radius, 20.0 + radius));
    let fixed = AnimatedTransform::constant(Transform::IDENTITY);
    let projection = spherical(SphericalMapping::Equirectangular, resolution);
    let camera = Camera::new(projection.clone(), fixed, Shutter::default(), resolution, lit);
    let Projection::Spherical(whole) = projection else { panic!("a panorama") };
    for (x, expected) in
        [(39.0, Some(-1.0)), (38.5, Some(-1.5)), (37.0, None), (20.0, None), (5.0, Some(5.0))]
    {
        let p = Point3::ORIGIN + whole.direction(Point2::new(x, 10.0)) * 3.0;
        let mut places = Vec::new();
        if let Some(sample) = camera.sample_wi(p, 0.0, MIDDLE) {
            camera.for_each_place(sample.p_film, |place| places.push(place.x));
        }
        assert_eq!(places.len(), usize::from(expected.is_some()), "{x}: {places:?}");
        assert!(places.iter().zip(expected).all(|(place, x)| (place - x).abs() < 1e-3), "{x}: {places:?}");
    }
}

/// Neighbouring pixels see points as far apart on a wall as their rays are; finer sampling sees finer detail.
#[test]
fn differentials_match_the_spacing_of_rays() {
    let resolution = [200, 100];
    let towards = Normal3::new(0.0, 0.0, -1.0);
    let p = Point3::new(0.0, 0.0, 5.0);
    let parallel = camera(orthographic(Lens::PINHOLE, resolution), resolution);
    let (dpdx, dpdy) = parallel.dpdx_dpdy(p, towards, 0.0, 1);
    assert!((dpdx - Vector3::new(0.02, 0.0, 0.0)).length() < 1e-5, "{dpdx:?}");
    assert!((dpdy - Vector3::new(0.0, -0.02, 0.0)).length() < 1e-5, "{dpdy:?}");
    // The smallest spacing over the film is at its corners; at 10 degrees it is within 4 % of that in the middle.
    let narrow = camera(perspective(10.0, Lens::PINHOLE, resolution), resolution);
    let (dpdx, dpdy) = narrow.dpdx_dpdy(p, towards, 0.0, 1);
    let expected = 5.0 * 2.0 * 5.0_f32.to_radians().tan() / 100.0;
    assert!(dpdx.x <= 1.001 * expected && dpdx.x > 0.95 * expected, "{dpdx:?} but {expected}");
    assert!(-dpdy.y <= 1.001 * expected && -dpdy.y > 0.95 * expected, "{dpdy:?} but {expected}");
    let (fine, _) = narrow.dpdx_dpdy(p, towards, 0.0, 16);
    assert!((fine.x / dpdx.x - 0.25).abs() < 1e-4);
    let (finest, _) = narrow.dpdx_dpdy(p, towards, 0.0, 10_000);
    assert!((finest.x / dpdx.x - 0.125).abs() < 1e-4);
}

/// A wall seen aslant is sampled more coarsely along the slant, by 1 / cos.
#[test]
fn differentials_grow_aslant() {
    let resolution = [100, 100];
    let camera = camera(perspective(5.0, Lens::PINHOLE, resolution), resolution);
    let p = Point3::new(0.0, 0.0, 5.0);
    let (facing, _) = camera.dpdx_dpdy(p, Normal3::new(0.0, 0.0, -1.0), 0.0, 1);
    let slant = 60.0_f32.to_radians();
    let (aslant, across) = camera.dpdx_dpdy(p, Normal3::new(slant.sin(), 0.0, -slant.cos()), 0.0, 1);
    assert!((aslant.length() / facing.length() - 2.0).abs() < 0.02, "{aslant:?} {facing:?}");
    assert!((across.length() / facing.length() - 1.0).abs() < 0.02);
}

/// A moving camera is where its transform says at the time of the ray; times fill the shutter interval (CAM-4).
#[test]
fn rays_follow_camera_and_shutter_in_time() {
    let moved = Transform::translate(Vector3::new(4.0, 0.0, 0.0));
    let moving = AnimatedTransform { start: Transform::IDENTITY, end: moved, start_time: 0.0, end_time: 1.0 };
    let shutter = Shutter { open: 0.25, close: 0.75 };
    let resolution = [10, 10];
    let projection = perspective(40.0, Lens::PINHOLE, resolution);
    let camera = Camera::new(projection, moving, shutter, resolution, whole(resolution));
    for (u, x) in [(0.0, 1.0), (0.5, 2.0)] {
        let ray = camera.sample_ray(Point2::new(5.0, 5.0), MIDDLE, u).unwrap().ray;
        assert!((ray.origin.x - x).abs() < 1e-5, "{ray:?}");
        assert!((ray.time - (0.25 + 0.5 * u)).abs() < 1e-6);
        assert!((ray.direction.length() - 1.0).abs() < 1e-6);
    }
}

/// Scaled camera spaces occur in scene files; rays still have unit direction.
#[test]
fn scaled_camera_has_unit_directions() {
    let scaled = AnimatedTransform::constant(Transform::scale(-2.0, 2.0, 2.0).unwrap());
    let resolution = [10, 10];
    let projection = perspective(40.0, Lens::PINHOLE, resolution);
    let camera = Camera::new(projection, scaled, Shutter::default(), resolution, whole(resolution));
    let ray = camera.sample_ray(Point2::new(1.0, 2.0), MIDDLE, 0.0).unwrap().ray;
    assert!((ray.direction.length() - 1.0).abs() < 1e-6);
    assert!(ray.direction.x > 0.0, "mirrored: the left of the image looks to +x");
}

/// A scene that names only the camera gets pbrt-v4's view: 90 degrees, a pinhole, one second.
#[test]
fn defaults_are_those_of_pbrt() {
    let (camera, n_problems) = read(&Entity::new("perspective"), [200, 100]);
    assert_eq!(n_problems, 0);
    let Projection::Perspective(p) = camera.projection() else { panic!("a perspective camera") };
    assert!((p.tan_half_fov - 1.0).abs() < 1e-6);
    assert!(!p.lens.has_area());
    assert_eq!(p.screen.window, ScreenWindow { x: [-2.0, 2.0], y: [-1.0, 1.0] });
    assert_eq!(camera.shutter(), Shutter { open: 0.0, close: 1.0 });
    let window = Entity::new("orthographic").with("screenwindow", Value::Floats(vec![0.0, 3.0, -1.0, 1.0]));
    let (camera, n_problems) = read(&window, [30, 20]);
    assert_eq!(n_problems, 0);
    let ray = camera.sample_ray(Point2::new(0.0, 0.0), MIDDLE, 0.0).unwrap().ray;
    assert!(ray.origin.distance(Point3::new(0.0, 1.0, 0.0)) < 1e-6, "{ray:?}");
}

/// Impossible cameras are reported.
#[test]
fn problems_are_reported() {
    let with = |name: &str, parameter: &str, values: &[f32]| {
        read(&Entity::new(name).with(parameter, Value::Floats(values.to_vec())), [10, 10]).1
    };
    assert_eq!(with("perspective", "fov", &[200.0]), 1);
    assert_eq!(with("perspective", "lensradius", &[-1.0]), 1);
    assert_eq!(with("perspective", "screenwindow", &[0.0, 1.0]), 1);
    assert_eq!(with("perspective", "shutterclose", &[-1.0]), 1);
    assert_eq!(with("perspective", "lensradios", &[1.0]), 1);
    assert_eq!(with("perspektive", "fov", &[20.0]), 1);
    assert_eq!(with("spherical", "lensradius", &[0.0]), 0);
}
