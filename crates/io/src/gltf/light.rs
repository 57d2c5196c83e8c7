//! Cameras and `KHR_lights_punctual`.

use etendue_math::AnimatedTransform;
use etendue_scene::document::{CameraEntity, Entity, LightEntity, Value};

use super::matrix::Matrix;
use super::{Reader, located};
use crate::json::Json;
use etendue_math::{Point3, Transform};

/// Pixels of pictures whose shape the file states: about as many as by default.
const N_PIXELS: f32 = 1280.0 * 720.0;
/// Wider or taller pictures than this are taken for errors.
const MAX_ASPECT: f32 = 20.0;

impl<'a> Reader<'a> {
    /// Adds the camera of a node to the document.
    pub(super) fn camera(&mut self, camera: &'a Json, world_from_node: &Matrix) {
        let kind = self.file.string(camera, "type").unwrap_or("perspective");
        let made = match kind {
            "perspective" => self.perspective(camera),
            "orthographic" => self.orthographic(camera),
            other => {
                self.file.error(camera, format!("\"{other}\" is no camera: perspective or orthographic"));
                return;
            }
        };
        let Some((entity, aspect)) = made else { return };
        let Some(world_from_node) = world_from_node.rigid().and_then(|m| m.transform()) else {
            self.file.error(camera, "the node of the camera has a singular transform");
            return;
        };
        // Ours look along +z, those of glTF along -z; both have +x on the right and +y up.
        let mirror = Transform::scale(1.0, 1.0, -1.0).unwrap_or(Transform::IDENTITY);
        self.document.camera = Some(CameraEntity {
            entity: located(entity, camera),
            world_from_camera: AnimatedTransform::constant(world_from_node * mirror),
            medium: String::new(),
        });
        if let Some(aspect) = aspect {
            let height = (N_PIXELS / aspect).sqrt().round().max(1.0);
            let width = (height * aspect).round().max(1.0);
            let film = Entity::new("rgb")
                .with("xresolution", Value::Integers(vec![width as i32]))
                .with("yresolution", Value::Integers(vec![height as i32]));
            self.document.film = Some(located(film, camera));
        }
    }

    /// With the ratio of width and height, if the file states it.
    fn perspective(&self, camera: &'a Json) -> Option<(Entity, Option<f32>)> {
        let lens = self.file.object(camera, "perspective");
        let lens = lens.or_else(|| self.file.required(camera, "perspective"))?;
        let yfov = self.file.as_float(self.file.required(lens, "yfov")?)?;
        let aspect = self.aspect(lens, self.file.float_opt(lens, "aspectRatio"));
        if !(yfov > 0.0 && yfov < std::f32::consts::PI) {
            self.file.error(lens, format!("\"yfov\" must lie between 0 and π, not be {yfov}"));
            return None;
        }
        // Our angle spans the shorter side.
        let shorter = aspect.filter(|aspect| *aspect < 1.0).unwrap_or(1.0);
        let fov = 2.0 * ((yfov / 2.0).tan() * shorter).atan();
        let entity = Entity::new("perspective").with("fov", Value::Floats(vec![fov.to_degrees()]));
        Some((entity, aspect))
    }

    fn orthographic(&self, camera: &'a Json) -> Option<(Entity, Option<f32>)> {
        let lens = self.file.object(camera, "orthographic");
        let lens = lens.or_else(|| self.file.required(camera, "orthographic"))?;
        let half = |name| self.file.as_float(self.file.required(lens, name)?);
        let (x, y) = (half("xmag")?.abs(), half("ymag")?.abs());
        if x == 0.0 || y == 0.0 {
            self.file.error(lens, "\"xmag\" and \"ymag\" must not be 0");
            return None;
        }
        let aspect = self.aspect(lens, Some(x / y));
        let entity = Entity::new("orthographic").with("screenwindow", Value::Floats(vec![-x, x, -y, y]));
        Some((entity, aspect))
    }

    fn aspect(&self, lens: &Json, aspect: Option<f32>) -> Option<f32> {
        let aspect = aspect?;
        if (1.0 / MAX_ASPECT..=MAX_ASPECT).contains(&aspect) {
            return Some(aspect);
        }
        self.file.warning(
            lens,
            format!("the picture cannot be {aspect} times as wide as high; it keeps its shape"),
        );
        None
    }

    /// Adds a punctual light of a node to the document: candela and lux, times a colour.
    pub(super) fn light(&mut self, light: &'a Json, world_from_node: &Matrix) {
        let Some(world_from_light) = world_from_node.rigid().and_then(|m| m.transform()) else {
            self.file.warning(light, "the node of the light has a singular transform; the light is left out");
            return;
        };
        let color: [f32; 3] = self.file.floats(light, "color").unwrap_or([1.0; 3]);
        let intensity = self.file.float(light, "intensity", 1.0);
        if intensity <= 0.0 || color.iter().all(|c| *c <= 0.0) {
            return;
        }
        let scale = Value::Floats(vec![intensity]);
        let ahead = Value::Points3(vec![Point3::new(0.0, 0.0, -1.0)]);
        let color = Value::Rgb(vec![color]);
        let entity = match self.file.string(light, "type").unwrap_or_default() {
            "point" => Entity::new("point").with("I", color),
            "directional" => Entity::new("distant").with("L", color).with("to", ahead),
            "spot" => {
                let entity = Entity::new("spot").with("I", color).with("to", ahead);
                self.cone(light, entity)
            }
            other => {
                self.file.error(light, format!("\"{other}\" is no light: point, spot or directional"));
                return;
            }
        };
        self.document.lights.push(LightEntity {
            entity: located(entity.with("scale", scale), light),
            world_from_light: AnimatedTransform::constant(world_from_light),
            outside_medium: String::new(),
        });
    }

    /// The angles of a spot light. Between them glTF proposes the square of a ramp over the cosine; ours is smoother.
    fn cone(&self, light: &'a Json, entity: Entity) -> Entity {
        let spot = self.file.object(light, "spot");
        let angle = |name, default| spot.map_or(default, |spot| self.file.float(spot, name, default));
        let outer = angle("outerConeAngle", std::f32::consts::FRAC_PI_4);
        let inner = angle("innerConeAngle", 0.0).min(outer);
        entity
            .with("coneangle", Value::Floats(vec![outer.to_degrees()]))
            .with("conedeltaangle", Value::Floats(vec![(outer - inner).to_degrees()]))
    }
}
