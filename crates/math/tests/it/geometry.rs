//! Frames, transforms, boxes and ray offsets on random input.

use std::f32::consts::{FRAC_PI_2, PI};

use etendue_math::{
    AnimatedTransform, Bounds2, Bounds3, Frame, Normal3, Point2, Point3, Ray, Rng, Transform, Vector3,
    offset_ray_origin, warp,
};

fn random_vector(rng: &mut Rng, scale: f32) -> Vector3 {
    let mut coordinate = || scale * (2.0 * rng.next_f32() - 1.0);
    Vector3::new(coordinate(), coordinate(), coordinate())
}

fn random_point(rng: &mut Rng, scale: f32) -> Point3 {
    Point3::ORIGIN + random_vector(rng, scale)
}

/// Rotations, scales (also mirrors) and translations in random order.
fn random_transform(rng: &mut Rng) -> Transform {
    let axis = warp::sample_uniform_sphere(rng.next_point2());
    let mut factor = || (0.3 + 2.0 * rng.next_f32()) * if rng.next_f32() < 0.3 { -1.0 } else { 1.0 };
    let scale = Transform::scale(factor(), factor(), factor()).unwrap();
    let rotation = Transform::rotate(6.0 * rng.next_f32(), axis).unwrap();
    Transform::translate(random_vector(rng, 3.0)) * rotation * scale * Transform::rotate(1.0, axis).unwrap()
}

#[track_caller]
fn near(actual: Vector3, expected: Vector3, tolerance: f32) {
    assert!((actual - expected).length() <= tolerance, "{actual:?} instead of {expected:?}");
}

/// RAD-12: the frame of every normal, along the axes too, is orthonormal and right-handed, and coordinates round-trip.
#[test]
fn frames_are_orthonormal() {
    let mut rng = Rng::new(1, 12);
    let mut normals: Vec<Vector3> =
        (0..2000).map(|_| warp::sample_uniform_sphere(rng.next_point2())).collect();
    for axis in 0..3 {
        for sign in [1.0, -1.0] {
            let mut n = Vector3::default();
            n[axis] = sign;
            normals.push(n);
        }
    }
    normals.push(Vector3::new(-0.0, -0.0, -1.0));
    normals.push(Vector3::new(1e-4, 1e-4, -1.0).normalized());
    for n in normals {
        for frame in
            [Frame::from_z(n), Frame::from_zx(n, random_vector(&mut rng, 2.0)), Frame::from_zx(n, n * 3.0)]
        {
            near(frame.z, n, 1e-6);
            for v in [frame.x, frame.y, frame.z] {
                assert!((v.length() - 1.0).abs() < 1e-5, "{frame:?}");
            }
            near(frame.x.cross(frame.y), frame.z, 1e-5);
            let v = random_vector(&mut rng, 2.0);
            near(frame.to_world(frame.to_local(v)), v, 1e-5);
            near(frame.to_local(n), Vector3::new(0.0, 0.0, 1.0), 1e-5);
        }
    }
}

/// RAD-12: sin(theta) cos(phi) t_x + sin(theta) sin(phi) t_y + cos(theta) n has these angles.
#[test]
fn directions_have_their_spherical_angles() {
    let mut rng = Rng::new(2, 12);
    for _ in 0..1000 {
        let frame = Frame::from_z(warp::sample_uniform_sphere(rng.next_point2()));
        let (theta, phi) = (PI * rng.next_f32(), PI * (2.0 * rng.next_f32() - 1.0));
        let local = Vector3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos());
        let w = frame.to_world(local);
        assert!((w.length() - 1.0).abs() < 1e-5);
        assert!((w.angle_between(frame.z) - theta).abs() < 1e-3);
        let azimuth = w.dot(frame.y).atan2(w.dot(frame.x));
        let difference = (azimuth - phi).abs();
        assert!(difference.min(2.0 * PI - difference) * theta.sin() < 1e-4, "{azimuth} instead of {phi}");
    }
    // Tangents given by a surface keep their direction.
    let frame = Frame::from_zx(Vector3::new(0.0, 1.0, 0.0), Vector3::new(2.0, 5.0, 0.0));
    near(frame.x, Vector3::new(1.0, 0.0, 0.0), 1e-6);
}

/// There and back again: points, vectors and rays.
#[test]
fn inverse_transforms_undo() {
    let mut rng = Rng::new(3, 12);
    for _ in 0..500 {
        let world_from_object = random_transform(&mut rng);
        let object_from_world = world_from_object.inverse();
        let (p, v) = (random_point(&mut rng, 5.0), random_vector(&mut rng, 1.0));
        near(object_from_world.point(world_from_object.point(p)) - p, Vector3::default(), 1e-4);
        near(object_from_world.vector(world_from_object.vector(v)), v, 1e-4);
        let identity = object_from_world * world_from_object;
        near(identity.point(p) - p, Vector3::default(), 1e-4);
        // A ray keeps the parameter of its points.
        let ray = Ray::new(p, v);
        near(
            world_from_object.ray(&ray).at(2.5) - world_from_object.point(ray.at(2.5)),
            Vector3::default(),
            1e-4,
        );
        // Products apply the right factor first.
        let other = random_transform(&mut rng);
        near(
            (other * world_from_object).point(p) - other.point(world_from_object.point(p)),
            Vector3::default(),
            1e-3,
        );
    }
    assert!(Transform::IDENTITY.is_identity());
    assert!(Transform::scale(1.0, 0.0, 1.0).is_none());
    assert!(Transform::rotate(1.0, Vector3::default()).is_none());
}

/// Normals stay perpendicular to the surface, though they do not transform as the vectors in it.
#[test]
fn normals_stay_perpendicular() {
    let mut rng = Rng::new(4, 12);
    for _ in 0..500 {
        let t = random_transform(&mut rng);
        let frame = Frame::from_z(warp::sample_uniform_sphere(rng.next_point2()));
        let n = t.normal(frame.z.as_normal());
        for tangent in [t.vector(frame.x), t.vector(frame.y)] {
            assert!(n.dot_vector(tangent).abs() < 1e-4 * n.length() * tangent.length());
        }
        // As a vector it would not be, unless the scale is uniform.
        assert!(n.dot_vector(t.vector(frame.z)) > 0.0);
    }
    let stretch = Transform::scale(1.0, 4.0, 1.0).unwrap();
    let n = stretch.normal(Normal3::new(1.0, 1.0, 0.0));
    near(n.as_vector(), Vector3::new(1.0, 0.25, 0.0), 1e-6);
}

/// Mirrors swap handedness, rotations and even numbers of mirrors do not.
#[test]
fn handedness_is_the_sign_of_the_determinant() {
    let scale = |x, y, z| Transform::scale(x, y, z).unwrap();
    assert!(!Transform::IDENTITY.swaps_handedness());
    assert!(scale(-1.0, 1.0, 1.0).swaps_handedness());
    assert!(!scale(-1.0, -1.0, 1.0).swaps_handedness());
    assert!(scale(-1.0, -2.0, -3.0).swaps_handedness());
    let rotation = Transform::rotate(2.0, Vector3::new(1.0, 2.0, 3.0)).unwrap();
    assert!(!rotation.swaps_handedness());
    assert!((rotation * scale(1.0, -1.0, 1.0) * rotation).swaps_handedness());
}

/// A quarter turn about z takes x to y; the viewer sees the target ahead on +z and up on +y.
#[test]
fn rotation_and_look_at_have_their_sense() {
    let quarter = Transform::rotate(FRAC_PI_2, Vector3::new(0.0, 0.0, 2.0)).unwrap();
    near(quarter.vector(Vector3::new(1.0, 0.0, 0.0)), Vector3::new(0.0, 1.0, 0.0), 1e-6);
    let eye = Point3::new(1.0, 2.0, 3.0);
    let target = Point3::new(4.0, 6.0, 3.0);
    let camera_from_world = Transform::look_at(eye, target, Vector3::new(0.0, 0.0, 1.0)).unwrap();
    near(camera_from_world.point(eye).as_vector(), Vector3::default(), 1e-5);
    near(camera_from_world.point(target).as_vector(), Vector3::new(0.0, 0.0, 5.0), 1e-5);
    let above = camera_from_world.vector(Vector3::new(0.0, 0.0, 1.0));
    near(above, Vector3::new(0.0, 1.0, 0.0), 1e-5);
    // Left-handed cameras in the worlds of pbrt: looking along +y with z up, +x is on the right.
    let ahead =
        Transform::look_at(Point3::ORIGIN, Point3::new(0.0, 1.0, 0.0), Vector3::new(0.0, 0.0, 1.0)).unwrap();
    near(ahead.vector(Vector3::new(-1.0, 0.0, 0.0)), Vector3::new(1.0, 0.0, 0.0), 1e-6);
    // pbrt's default camera: nothing to do.
    let default =
        Transform::look_at(Point3::ORIGIN, Point3::new(0.0, 0.0, 1.0), Vector3::new(0.0, 1.0, 0.0)).unwrap();
    near(default.vector(Vector3::new(1.0, 2.0, 3.0)), Vector3::new(1.0, 2.0, 3.0), 1e-6);
    assert!(Transform::look_at(eye, eye, Vector3::new(0.0, 0.0, 1.0)).is_none());
    assert!(Transform::look_at(eye, target, target - eye).is_none());
}

/// Perspective takes the edges of the view to 1 and the depth range to [0, 1].
#[test]
fn perspective_maps_the_view_cone() {
    let project = Transform::perspective(FRAC_PI_2, 0.5, 10.0);
    let (near_by, far_off) =
        (project.point(Point3::new(1.0, -1.0, 1.0)), project.point(Point3::new(3.0, -3.0, 3.0)));
    assert!((near_by.x - far_off.x).abs() < 1e-6 && (near_by.y - far_off.y).abs() < 1e-6);
    assert!(near_by.z < far_off.z);
    assert!((project.point(Point3::new(2.0, 0.0, 2.0)).x - 1.0).abs() < 1e-6);
    assert!(project.point(Point3::new(0.0, 0.0, 0.5)).z.abs() < 1e-6);
    assert!((project.point(Point3::new(0.0, 0.0, 10.0)).z - 1.0).abs() < 1e-6);
}

/// The bound of rounding holds against the same product in double precision.
#[test]
fn point_errors_bound_rounding() {
    let mut rng = Rng::new(5, 12);
    for _ in 0..2000 {
        let t = random_transform(&mut rng);
        let p = random_point(&mut rng, 100.0);
        let (q, bound) = (t.point(p), t.point_error(p, Vector3::default()));
        for row in 0..3 {
            let m = t.rows()[row].map(f64::from);
            let exact = m[0] * f64::from(p.x) + m[1] * f64::from(p.y) + m[2] * f64::from(p.z) + m[3];
            assert!((f64::from(q[row]) - exact).abs() <= f64::from(bound[row]), "{q:?} {bound:?}");
        }
    }
}

/// Motion: the ends are exact; half of a half turn is a quarter turn; translation and stretch are linear; lengths stay.
#[test]
fn animation_interpolates_rotation() {
    let start = Transform::translate(Vector3::new(2.0, 0.0, 0.0));
    let turn = Transform::rotate(0.9 * PI, Vector3::new(0.0, 0.0, 1.0)).unwrap();
    let end =
        Transform::translate(Vector3::new(4.0, 2.0, 0.0)) * turn * Transform::scale(3.0, 3.0, 3.0).unwrap();
    let motion = AnimatedTransform { start, end, start_time: 1.0, end_time: 3.0 };
    assert!(motion.is_animated());
    assert_eq!(motion.at(0.0), start);
    assert_eq!(motion.at(3.5), end);
    let half = motion.at(2.0);
    near(half.point(Point3::ORIGIN).as_vector(), Vector3::new(3.0, 1.0, 0.0), 1e-5);
    let (sin, cos) = (0.45 * PI).sin_cos();
    near(half.vector(Vector3::new(1.0, 0.0, 0.0)), Vector3::new(2.0 * cos, 2.0 * sin, 0.0), 1e-5);
    let still = AnimatedTransform::constant(end);
    assert!(!still.is_animated());
    assert_eq!(still.at(0.3), end);
}

/// A mirrored object turns without passing through flatness.
#[test]
fn animation_keeps_mirrors() {
    let mirror = Transform::scale(-1.0, 1.0, 1.0).unwrap();
    let end = Transform::rotate(1.0, Vector3::new(0.3, 1.0, 0.2)).unwrap() * mirror;
    let motion = AnimatedTransform { start: mirror, end, start_time: 0.0, end_time: 1.0 };
    for step in 0..=10 {
        let t = motion.at(step as f32 / 10.0);
        assert!(t.swaps_handedness());
        for axis in 0..3 {
            let mut v = Vector3::default();
            v[axis] = 1.0;
            assert!((t.vector(v).length() - 1.0).abs() < 1e-5);
        }
    }
}

/// Boxes of moving things hold them at all times.
#[test]
fn motion_bounds_hold_all_times() {
    let mut rng = Rng::new(6, 12);
    for _ in 0..20 {
        let motion = AnimatedTransform {
            start: Transform::rotate(3.0 * rng.next_f32(), random_vector(&mut rng, 1.0)).unwrap(),
            end: Transform::translate(random_vector(&mut rng, 3.0))
                * Transform::rotate(3.0 * rng.next_f32(), random_vector(&mut rng, 1.0)).unwrap(),
            start_time: 0.0,
            end_time: 1.0,
        };
        let object = Bounds3::new(random_point(&mut rng, 2.0), random_point(&mut rng, 2.0));
        let bounds = motion.motion_bounds(object);
        for step in 0..=333 {
            let t = motion.at(step as f32 / 333.0);
            assert!(object.corners().iter().all(|p| bounds.contains(t.point(*p))));
        }
    }
}

/// The unit cube: area 6, radius sqrt(3)/2; empty boxes are neutral.
#[test]
fn bounds_have_their_measures() {
    let cube = Bounds3::new(Point3::splat(1.0), Point3::ORIGIN);
    assert_eq!(cube.surface_area(), 6.0);
    assert_eq!(cube.bounding_sphere(), (Point3::splat(0.5), 3.0_f32.sqrt() / 2.0));
    assert_eq!(cube.centroid(), Point3::splat(0.5));
    assert!(Bounds3::EMPTY.is_empty() && !cube.is_empty());
    assert_eq!(Bounds3::EMPTY.union(cube), cube);
    assert_eq!(Bounds3::EMPTY.surface_area(), 0.0);
    assert_eq!(Bounds3::default(), Bounds3::EMPTY);
    assert!(cube.contains(Point3::new(0.0, 1.0, 0.5)) && !cube.contains(Point3::new(0.0, 1.1, 0.5)));
    let corners = cube.corners();
    assert!((0..8).all(|i| (0..i).all(|j| corners[i] != corners[j])));
    assert_eq!(Bounds3::from_points(corners), cube);
    assert_eq!(Bounds2::new(Point2::new(3.0, 1.0), Point2::new(1.0, 2.0)).area(), 2.0);
    // A rotated box holds the rotated points.
    let turn = Transform::rotate(0.7, Vector3::new(1.0, 1.0, 0.0)).unwrap();
    assert!(corners.iter().all(|p| turn.bounds(cube).contains(turn.point(*p))));
}

/// A ray that leaves a plane starts strictly on its own side, however the point on the plane was rounded.
#[test]
fn offset_origins_leave_the_surface() {
    let mut rng = Rng::new(7, 12);
    for scale in [1e-3, 1.0, 1e4] {
        for _ in 0..1000 {
            let frame = Frame::from_z(warp::sample_uniform_sphere(rng.next_point2()));
            let n = frame.z.as_normal();
            let height = scale * f64::from(rng.next_f32());
            // A point of the plane n . p = height, rounded; its distance from the plane in double precision.
            let (a, b) = (scale as f32 * rng.next_f32(), scale as f32 * rng.next_f32());
            let exact = |axis: usize| {
                let f = |v: Vector3| f64::from(v[axis]);
                f(frame.x) * f64::from(a) + f(frame.y) * f64::from(b) + f(frame.z) * height
            };
            let p = Point3::new(exact(0) as f32, exact(1) as f32, exact(2) as f32);
            let distance = |q: Point3| -> f64 {
                (0..3).map(|axis| (f64::from(q[axis]) - exact(axis)) * f64::from(n[axis])).sum()
            };
            let p_error = p.as_vector().abs() * f32::EPSILON;
            let w = warp::sample_uniform_sphere(rng.next_point2());
            let side = f64::from(n.dot_vector(w).signum());
            let moved = offset_ray_origin(p, p_error, n, w);
            assert!(side * distance(moved) > 0.0, "{:e} at {p:?}", distance(moved));
            assert!(moved.distance(p) <= 1e-5 * scale as f32, "moved too far");
        }
    }
}
