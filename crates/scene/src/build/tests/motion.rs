//! Meshes that deform while the shutter is open.

use super::*;

fn lifted() -> Entity {
    here(
        square()
            .with("P1", points(&[[-1.0, -1.0, 4.0], [1.0, -1.0, 4.0], [1.0, 1.0, 4.0], [-1.0, 1.0, 4.0]])),
    )
}

/// The square of the tests rises by 4 m in the time from 0 to 1.
#[test]
fn vertices_go_to_their_second_place() {
    let scene = scene(&lit_with(vec![shape(lifted())]));
    let height = |time: f32| {
        let ray = Ray { time, ..down(0.1, 0.2) };
        let hit = scene.intersect(&ray, f32::INFINITY).expect("the square is below");
        scene.surface(&ray, &hit).point.p.z
    };
    let start = height(0.0);
    for time in [0.25, 0.5, 1.0] {
        assert!((height(time) - (start * (1.0 - time) + 4.0 * time)).abs() < 1e-5, "{time}");
    }
    assert!(scene.bounds().max.z >= 4.0);
}

/// What does not fit is an error, and what cannot be is a warning.
#[test]
fn impossible_motions_are_reported() {
    let few = here(square().with("P1", points(&[[0.0; 3]; 3])));
    error_here(&lit_with(vec![shape(few)]), "3 entries instead of 4");
    let nan = here(square().with("P1", points(&[[f32::NAN; 3]; 4])));
    error_here(&lit_with(vec![shape(nan)]), "is not finite");
    let displaced = here(lifted().with("displacement", floats(&[0.5])));
    warning_here(&lit_with(vec![shape(displaced)]), "a displaced mesh cannot move");
    let mut document = lit_with(vec![shape(lifted())]);
    document.area_lights.push(Entity::new("diffuse"));
    document.shapes[0].area_light = Some(0);
    warning_here(&document, "meshes that deform");
}
