//! Surfaces of revolution from parameters and files.

use etendue_math::Point2;

use super::*;
use crate::assets::Contours;

fn contour(points: &[[f32; 2]]) -> Value {
    Value::Points2(points.iter().map(|&[h, r]| Point2::new(h, r)).collect())
}

fn revolution() -> Entity {
    here(Entity::new("revolution"))
}

#[track_caller]
fn revolution_error(entity: Entity, message: &str) -> Diagnostic {
    error_here(&lit_with(vec![shape(entity)]), message)
}

/// A cone stands on its base: the ray from above meets it where the contour says.
#[test]
fn contours_are_revolved_about_z() {
    let cone = revolution().with("contour", contour(&[[0.0, 1.0], [1.0, 0.0]]));
    let scene = scene(&lit_with(vec![shape(cone)]));
    let hit = scene.intersect(&down(0.25, 0.0), f32::INFINITY).expect("the cone is below");
    let p = scene.surface(&down(0.25, 0.0), &hit).point.p;
    assert!((p.z - 0.75).abs() < 1e-3, "{p:?}");
    let bounds = scene.bounds();
    assert!(bounds.max.z == 1.0 && bounds.min.z == 0.0 && (bounds.max.x - 1.0).abs() < 1e-6, "{bounds:?}");
}

/// What is wrong with a contour stands at the contour.
#[test]
fn impossible_contours_are_errors() {
    revolution_error(revolution(), "needs a \"contour\"");
    let with = |points: &[[f32; 2]]| revolution().with("contour", contour(points));
    revolution_error(with(&[[0.0, 1.0]]), "at least two different points");
    revolution_error(with(&[[0.0, 1.0], [1.0, -2.0]]), "point 1 of the contour has the negative radius -2");
    revolution_error(with(&[[0.0, 1.0], [1.0, 2.0], [0.0, 2.0], [1.0, 1.0]]), "the contour meets itself");
    let cylinder = with(&[[0.0, 1.0], [1.0, 1.0]]);
    revolution_error(
        cylinder.clone().with("tolerance", floats(&[-1.0])),
        "\"tolerance\" must not be negative",
    );
    revolution_error(cylinder.clone().with("tolerance", floats(&[1e-30])), "triangles, which are too many");
    revolution_error(cylinder.with("crease", floats(&[f32::NAN])), "\"crease\" must lie between 0 and 180");
}

/// A file has contours by name; the only one needs none.
#[test]
fn files_hold_contours_by_name() {
    let line = |h: f32| vec![Point2::new(h, 1.0), Point2::new(h + 1.0, 1.0)];
    let one = Contours(vec![("a-b".to_owned(), line(0.0))]);
    let two = Contours(vec![("a-b".to_owned(), line(0.0)), ("b-c".to_owned(), line(5.0))]);
    let contours = HashMap::from([("one.csv".to_owned(), one), ("two.csv".to_owned(), two)]);
    let assets = Assets { contours, ..Assets::default() };
    let build = |file: &str, profile: Option<&str>| {
        let mut entity = revolution().with("filename", strings(&[file]));
        if let Some(profile) = profile {
            entity = entity.with("profile", strings(&[profile]));
        }
        build_with(&lit_with(vec![shape(entity)]), assets.clone())
    };
    for (file, profile, z) in
        [("one.csv", None, 1.0), ("two.csv", Some("a-b"), 1.0), ("two.csv", Some("b-c"), 6.0)]
    {
        let (scene, problems) = build(file, profile);
        assert!(problems.is_empty(), "{problems:?}");
        assert_eq!(scene.expect("no problem was reported").bounds().max.z, z);
    }
    assert_helps(&only_problem(&build("two.csv", None).1, Severity::Error, "must say which"), "a-b, b-c");
    assert_helps(
        &only_problem(&build("two.csv", Some("b-d")).1, Severity::Error, "no interface"),
        "did you mean",
    );
}
