//! Transforms as a scene file can say them: by a matrix of single precision, to which the inverse belongs. A product of
//! transforms has the product of their inverses instead, which is rounded otherwise; a scene that is written and read again
//! would differ from itself in the last bits.

use etendue_math::{AnimatedTransform, Transform};
use etendue_scene::Document;

/// Gives every transform of the document the inverse of its own matrix.
pub(crate) fn make_transforms_exact(document: &mut Document) {
    let shapes = document.objects.iter_mut().flat_map(|object| &mut object.shapes);
    for shape in shapes.chain(&mut document.shapes) {
        each_end(&mut shape.world_from_object, exact);
    }
    for instance in &mut document.instances {
        each_end(&mut instance.world_from_instance, exact);
    }
    for light in &mut document.lights {
        each_end(&mut light.world_from_light, exact);
    }
    for medium in &mut document.media {
        each_end(&mut medium.world_from_medium, exact);
    }
    for texture in &mut document.textures {
        texture.world_from_texture = exact(texture.world_from_texture);
    }
    if let Some(camera) = &mut document.camera {
        // Scene files have the other direction.
        each_end(&mut camera.world_from_camera, |t| exact(t.inverse()).inverse());
    }
}

fn each_end(transform: &mut AnimatedTransform, change: impl Fn(Transform) -> Transform) {
    transform.start = change(transform.start);
    transform.end = change(transform.end);
}

fn exact(transform: Transform) -> Transform {
    Transform::from_rows(*transform.rows()).unwrap_or(transform)
}
