//! Real lenses.

use super::*;

const SIZE: [u32; 2] = [300, 200];
/// Diagonal of a film of 36 mm by 24 mm.
const DIAGONAL_M: f32 = 0.043_266_6;

fn lens(surfaces_mm: &[[f32; 4]]) -> LensPrescription {
    let surface = |&[radius, thickness, eta, diameter]: &[f32; 4]| LensSurface {
        radius_m: radius / 1000.0,
        thickness_m: thickness / 1000.0,
        eta,
        diameter_m: diameter / 1000.0,
    };
    LensPrescription::new(surfaces_mm.iter().map(surface).collect()).expect("a lens")
}

/// Tronnier's double Gauss of scenes/lenses.
fn double_gauss() -> LensPrescription {
    lens(&[
        [29.475, 3.76, 1.67, 25.2],
        [84.83, 0.12, 1.0, 25.2],
        [19.275, 4.025, 1.67, 23.0],
        [40.77, 3.275, 1.699, 23.0],
        [12.75, 5.705, 1.0, 18.0],
        [0.0, 4.5, 1.0, 17.1],
        [-14.495, 1.18, 1.603, 17.0],
        [40.77, 6.065, 1.658, 20.0],
        [-20.385, 0.19, 1.0, 20.0],
        [437.065, 3.22, 1.717, 20.0],
        [-39.73, 0.0, 1.0, 20.0],
    ])
}

/// As thick as its curvature needs over a diameter of 14 mm.
const THICKNESS_MM: f32 = 1.0;

/// A lens so thin that its thickness counts for a per cent, with the stop before it: f = R / (2 (n - 1)) = 50 mm.
fn thin() -> LensPrescription {
    lens(&[[0.0, 0.01, 1.0, 40.0], [50.0, THICKNESS_MM, 1.5, 14.0], [-50.0, 0.0, 1.0, 14.0]])
}

fn settings(stop_diameter_m: f32, focus_distance: f32) -> LensSettings {
    LensSettings { stop_diameter_m, stop_shape: StopShape::Disc, focus_distance, is_normalized: false }
}

fn realistic(lens: &LensPrescription, settings: LensSettings) -> Camera {
    let realistic = Realistic::new(lens, settings, SIZE.map(|n| n as f32), DIAGONAL_M).expect("in focus");
    camera(Projection::Realistic(Box::new(realistic)), SIZE)
}

/// Rays of a raster position for a grid of lens points.
fn rays(camera: &Camera, p_film: Point2) -> impl Iterator<Item = Option<CameraRay>> {
    const N: usize = 128;
    let place = |i: usize| (i as f32 + 0.5) / N as f32;
    (0..N * N).map(move |i| camera.sample_ray(p_film, Point2::new(place(i % N), place(i / N)), 0.0))
}

/// Mean weight of a raster position: irradiance by radiance 1.
fn irradiance(camera: &Camera, p_film: Point2) -> f32 {
    let weights: Vec<f32> = rays(camera, p_film).map(|ray| ray.map_or(0.0, |ray| ray.weight)).collect();
    weights.iter().sum::<f32>() / weights.len() as f32
}

/// Where the rays of a raster position meet a plane at a distance from the film: the middle and the largest distance from it.
fn spot(camera: &Camera, p_film: Point2, z: f32) -> (Point2, f32) {
    let points: Vec<Point3> = rays(camera, p_film)
        .flatten()
        .map(|CameraRay { ray, .. }| ray.at((z - ray.origin.z) / ray.direction.z))
        .collect();
    assert!(points.len() > 1000, "only {} rays get through", points.len());
    let n = points.len() as f32;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.x / n, y + p.y / n));
    let largest = points.iter().map(|p| (p.x - x).hypot(p.y - y)).fold(0.0, f32::max);
    (Point2::new(x, y), largest)
}

const CENTRE: Point2 = Point2::new(150.0, 100.0);

/// The focal length of a thick lens is that of the lens maker's formula,
/// 1/f = (n - 1) (1/R1 - 1/R2 + (n - 1) d / (n R1 R2)), and that of a double Gauss that of its maker.
#[test]
fn focal_lengths_are_those_of_the_formula() {
    for (r1, r2, d, n) in [(50.0_f32, -80.0_f32, 12.0_f32, 1.6_f32), (30.0, 90.0, 20.0, 1.8)] {
        let thick = lens(&[[r1, d, n, 10.0], [r2, 0.0, 1.0, 10.0]]);
        let expected = 1e-3 / ((n - 1.0) * (1.0 / r1 - 1.0 / r2 + (n - 1.0) * d / (n * r1 * r2)));
        let found = Paraxial::new(&thick).focal_length_m();
        assert!((found / expected - 1.0).abs() < 1e-5, "{found} but {expected}");
    }
    let found = Paraxial::new(&double_gauss());
    assert!((found.focal_length_m() - 0.05).abs() < 5e-4, "{}", found.focal_length_m());
    let full = found.stop_diameter_m(2.0).expect("a stop");
    assert!((full - 0.0171).abs() < 5e-4, "wide open it is f/2: {full}");
    assert!((found.stop_diameter_m(4.0).unwrap() - full / 2.0).abs() < 1e-7);
}

/// Rays of a point of the film meet at the focus distance from it, but for the aberrations of the lens, and nowhere else.
#[test]
fn what_is_in_focus_is_sharp() {
    for distance in [0.5, 1.0, 5.0] {
        let camera = realistic(&double_gauss(), settings(0.002, distance));
        let (_, sharp) = spot(&camera, CENTRE, distance);
        let (_, before) = spot(&camera, CENTRE, 0.8 * distance);
        let (_, behind) = spot(&camera, CENTRE, 1.25 * distance);
        assert!(sharp < 0.06 * before && sharp < 0.06 * behind, "{sharp} {before} {behind} at {distance}");
    }
}

/// A thin prescription does what the thin lens does: the same points in the middle of its bundles, as wide out of focus.
#[test]
fn thin_prescriptions_agree_with_the_thin_lens() {
    let (stop, focus) = (0.004, 1.0);
    let real = realistic(&thin(), settings(stop, focus));
    let Projection::Realistic(inside) = real.projection() else { panic!("a realistic camera") };
    // To the middle of the lens.
    let film_distance = inside.film_distance() + 0.5e-3 * THICKNESS_MM;
    let tan_half_fov = 0.012 / film_distance;
    let lens = Lens { radius: stop / 2.0, blades: None, focal_distance: focus - film_distance };
    let ideal =
        camera(Projection::Perspective(Perspective { screen: screen(SIZE), tan_half_fov, lens }), SIZE);
    for (x, y) in [(150.0, 100.0), (170.0, 95.0), (120.0, 110.0)] {
        let p_film = Point2::new(x, y);
        for z in [0.5, 1.0, 3.0] {
            // The lens is before the film in one, at the origin in the other.
            let (a, wide_a) = spot(&real, p_film, z);
            let (b, wide_b) = spot(&ideal, p_film, z - film_distance);
            assert!((a - b).length() < 4e-3 * z, "{a:?} {b:?} at {z}");
            let expected = 2.0 * lens.radius * (z - focus).abs() / (focus - film_distance) / 2.0;
            assert!(
                (wide_a - wide_b).abs() < 0.1 * expected + 1e-3 * z,
                "{wide_a} {wide_b} {expected} at {z}"
            );
        }
    }
}

/// Through a small stop at the lens the film gets A cos^4 / Z^2: the law of vignetting of any thin lens. Z is measured to the
/// stop's image, two thirds of a thickness before the rear.
#[test]
fn small_stops_fall_off_as_cosine_to_the_fourth() {
    let stop = 0.002;
    let camera = realistic(&thin(), settings(stop, 10.0));
    let Projection::Realistic(inside) = camera.projection() else { panic!("a realistic camera") };
    let z = inside.film_distance() + 0.67e-3 * THICKNESS_MM;
    let axial = irradiance(&camera, CENTRE);
    let area = std::f32::consts::PI * stop * stop / 4.0;
    assert!((axial / (area / (z * z)) - 1.0).abs() < 0.03, "{axial}");
    for x in [200.0_f32, 250.0, 299.0] {
        let from_axis = (x - 150.0) / 300.0 * inside.film_size_m()[0];
        let cos2 = z * z / (z * z + from_axis * from_axis);
        let found = irradiance(&camera, Point2::new(x, 100.0)) / axial;
        assert!((found / (cos2 * cos2) - 1.0).abs() < 0.01, "at {x}: {found} but {}", cos2 * cos2);
    }
}

/// Real lenses vignette by their rims when wide open, and hardly when stopped down; four stops are four times less light.
#[test]
fn rims_vignette() {
    let at = |f_number: f32, p: Point2| {
        let stop = Paraxial::new(&double_gauss()).stop_diameter_m(f_number).unwrap();
        irradiance(&realistic(&double_gauss(), settings(stop, 10.0)), p)
    };
    let corner = Point2::new(295.0, 195.0);
    let (open, stopped) = (at(2.0, corner) / at(2.0, CENTRE), at(8.0, corner) / at(8.0, CENTRE));
    assert!(open < 0.5 * stopped && stopped < 1.0, "{open} {stopped}");
    let ratio = at(4.0, CENTRE) / at(8.0, CENTRE);
    assert!((ratio - 4.0).abs() < 0.1, "{ratio}");
    // The irradiance of a lens of f-number N focused far away: pi / (4 N^2).
    let expected = std::f32::consts::PI / (4.0 * 64.0);
    assert!((at(8.0, CENTRE) / expected - 1.0).abs() < 0.03);
}

/// The normalised camera is as bright as a pinhole in the middle, for any form of the stop; forms take their share.
#[test]
fn normalized_cameras_show_radiance() {
    let blades = Blades { n: 6, rotation_rad: 0.2 };
    let picture = StopPicture::new(2, 1, vec![1.0, 0.0]).unwrap();
    for stop_shape in [
        StopShape::Disc,
        StopShape::Polygon(blades, 1.0),
        StopShape::Star,
        StopShape::Gaussian,
        StopShape::Picture(std::sync::Arc::new(picture)),
    ] {
        let plain = LensSettings { stop_shape, ..settings(0.008, 3.0) };
        let of_disc = irradiance(&realistic(&double_gauss(), settings(0.008, 3.0)), CENTRE);
        let share = irradiance(&realistic(&double_gauss(), plain.clone()), CENTRE) / of_disc;
        let expected = match &plain.stop_shape {
            StopShape::Disc => 1.0,
            // Areas over pi: 6 / 2 sin(60 degrees); of a pentagram 1.1226; (1 - 2/e); one half.
            StopShape::Polygon(..) => 0.827,
            StopShape::Star => 0.3573,
            StopShape::Gaussian => 0.2642,
            StopShape::Picture(_) => 0.5,
        };
        assert!((share - expected).abs() < 0.015, "{:?}: {share} but {expected}", plain.stop_shape);
        let normalized = realistic(&double_gauss(), LensSettings { is_normalized: true, ..plain });
        let found = irradiance(&normalized, CENTRE);
        assert!((found - 1.0).abs() < 0.02, "{found}");
    }
}

/// The image is the right way up, and a lens behind which no light gets shows black.
#[test]
fn images_are_upright() {
    let camera = realistic(&double_gauss(), settings(0.005, 2.0));
    let (right, _) = spot(&camera, Point2::new(250.0, 100.0), 2.0);
    let (top, _) = spot(&camera, Point2::new(150.0, 20.0), 2.0);
    assert!(right.x > 0.3 && right.y.abs() < 0.01, "{right:?}");
    assert!(top.y > 0.2 && top.x.abs() < 0.01, "{top:?}");
    assert!(camera.we(&camera.sample_ray(CENTRE, MIDDLE, 0.0).unwrap().ray).is_none());
    assert!(camera.sample_wi(Point3::new(0.0, 0.0, 2.0), 0.0, MIDDLE).is_none());
}

/// Stops of any size are found: what passes a stop of a tenth of a millimetre is its area.
#[test]
fn tiny_stops_are_found() {
    let wide = irradiance(&realistic(&double_gauss(), settings(0.002, 10.0)), CENTRE);
    for p in [CENTRE, Point2::new(280.0, 20.0)] {
        let tiny = irradiance(&realistic(&double_gauss(), settings(0.0001, 10.0)), p);
        assert!(tiny > 0.2 * wide / 400.0, "{tiny} of {wide} at {p:?}");
    }
    let tiny = irradiance(&realistic(&double_gauss(), settings(0.0001, 10.0)), CENTRE);
    assert!((tiny / (wide / 400.0) - 1.0).abs() < 0.1, "{tiny} {wide}");
}

/// An opening aside of the middle of the stop lets its area of light through, wherever it is; none is dark.
#[test]
fn openings_aside_are_found() {
    let n = 16;
    let at = |column: usize, row: usize| {
        let mut open = vec![0.0; n * n];
        open[row * n + column] = 1.0;
        let picture = std::sync::Arc::new(StopPicture::new(n, n, open).unwrap());
        LensSettings { stop_shape: StopShape::Picture(picture), ..settings(0.008, 3.0) }
    };
    let of_disc = irradiance(&realistic(&double_gauss(), settings(0.008, 3.0)), CENTRE);
    // A square of an eighth of the radius in a circle.
    let expected = 4.0 / (n * n) as f32 / std::f32::consts::PI;
    for (column, row) in [(7, 7), (13, 8), (2, 4), (8, 14)] {
        let share = irradiance(&realistic(&double_gauss(), at(column, row)), CENTRE) / of_disc;
        // About 7 x 7 of the grid's points see through: a row and a column more or less are two sevenths.
        assert!((share / expected - 1.0).abs() < 0.35, "{column} {row}: {share} but {expected}");
    }
    let dark = std::sync::Arc::new(StopPicture::new(1, 1, vec![0.0]).unwrap());
    let dark = LensSettings { stop_shape: StopShape::Picture(dark), ..settings(0.008, 3.0) };
    let Projection::Realistic(camera) = realistic(&double_gauss(), dark).projection().clone() else {
        panic!("a realistic camera")
    };
    assert!(!camera.is_open());
}

/// Bounds of the pupil leave nothing out, wherever a small stop lies in the cells of the grid: behind a thin lens the film gets
/// the light of the whole stop.
#[test]
fn bounds_hold_all_of_small_pupils() {
    for diameter in [0.0007_f32, 0.0009, 0.001, 0.0012, 0.0015] {
        let camera = realistic(&thin(), settings(diameter, 10.0));
        let Projection::Realistic(inside) = camera.projection() else { panic!("a realistic camera") };
        let z = inside.film_distance() + 0.67e-3 * THICKNESS_MM;
        let area = std::f32::consts::PI * diameter * diameter / 4.0;
        for i in 0..40 {
            let x = 150.0 + 3.5 * i as f32;
            let from_axis = (x - 150.0) / 300.0 * inside.film_size_m()[0];
            let cos2 = z * z / (z * z + from_axis * from_axis);
            let share = irradiance(&camera, Point2::new(x, 100.0)) * z * z / (area * cos2 * cos2);
            // The image of the stop is larger than it by the lens before it; the grid counts to half a per cent.
            assert!((share - 1.0).abs() < 0.02, "{diameter} at {x}: {share}");
        }
    }
}

/// A lens cannot focus closer than about four focal lengths.
#[test]
fn nearness_is_limited() {
    let lens = Paraxial::new(&double_gauss());
    assert!(lens.film_distance(0.1).is_none());
    assert!(lens.film_distance(f32::NAN).is_none());
    let far = lens.film_distance(1e6).expect("infinity");
    assert!((far - lens.back_focal_distance_m()).abs() < 1e-6);
}

/// Problems of files and parameters have their error or warning.
#[test]
fn problems_of_lenses_are_reported() {
    let problems = |parameters: &[(&'static str, Value)]| {
        let mut assets = Assets::default();
        assets.lenses.insert("a.txt".to_owned(), std::sync::Arc::new(double_gauss()));
        assets.failed.insert("broken.txt".to_owned());
        let mut context = BuildContext::new(&assets);
        let entity = parameters.iter().fold(Entity::new("realistic"), |e, (name, v)| e.with(name, v.clone()));
        let mut p = Parameters::new(&entity, &mut context);
        let fixed = AnimatedTransform::constant(Transform::IDENTITY);
        let _ = Camera::from_parameters(&mut p, fixed, SIZE, 0.035, whole(SIZE));
        p.finish();
        context.diagnostics.list().len()
    };
    let file = |name: &str| ("lensfile", Value::Strings(vec![name.to_owned()]));
    let float = |name: &'static str, x: f32| (name, Value::Floats(vec![x]));
    let sound = file("a.txt");
    assert_eq!(problems(std::slice::from_ref(&sound)), 0);
    assert_eq!(problems(&[]), 1, "no file");
    assert_eq!(problems(&[file("b.txt")]), 1, "no such lens");
    assert_eq!(problems(&[file("broken.txt")]), 0, "reported where it was read");
    assert_eq!(problems(&[sound.clone(), float("focusdistance", 0.1)]), 1);
    assert_eq!(problems(&[sound.clone(), float("focusdistance", -1.0)]), 1);
    assert_eq!(problems(&[sound.clone(), float("aperturediameter", 0.0)]), 1);
    assert_eq!(problems(&[sound.clone(), float("aperturediameter", 50.0)]), 1);
    assert_eq!(problems(&[sound.clone(), float("fstop", 0.5)]), 1);
    assert_eq!(problems(&[sound.clone(), float("aperturediameter", 1e-30)]), 1, "no light");
    assert_eq!(problems(&[sound.clone(), float("fstop", 4.0), float("aperturediameter", 5.0)]), 1);
    let aperture = |name: &str| ("aperture", Value::Strings(vec![name.to_owned()]));
    assert_eq!(problems(&[sound.clone(), aperture("star")]), 0);
    assert_eq!(problems(&[sound.clone(), aperture("heart")]), 1);
    assert_eq!(problems(&[sound, aperture("star"), ("blades", Value::Integers(vec![5]))]), 1);
}
