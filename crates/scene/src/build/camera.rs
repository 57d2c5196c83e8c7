//! Camera and pixel filter.

use etendue_math::{AnimatedTransform, Bounds2, Point2, Transform};

use crate::camera::Camera;
use crate::document::Entity;
use crate::film::FilmSettings;
use crate::filter::Filter;
use crate::parameters::Parameters;

use super::Builder;

impl Builder<'_, '_> {
    pub(super) fn build_camera(&mut self, film: &FilmSettings, filter: &Filter) -> Camera {
        let fallback = Entity::new("perspective");
        let (entity, world_from_camera) = match &self.document.camera {
            Some(camera) => (camera.entity.clone(), camera.world_from_camera),
            None => (fallback, AnimatedTransform::constant(Transform::IDENTITY)),
        };
        let corner = |p: [u32; 2]| Point2::new(p[0] as f32, p[1] as f32);
        let reach = filter.radius();
        let lit = Bounds2::new(corner(film.crop.min) - reach, corner(film.crop.max) + reach);
        let mut p = Parameters::new(&entity, &mut self.context);
        let camera = Camera::from_parameters(
            &mut p,
            world_from_camera,
            film.resolution,
            film.diagonal_mm / 1000.0,
            lit,
        );
        p.finish();
        camera
    }

    pub(super) fn build_filter(&mut self) -> Filter {
        let fallback = Entity::new("gaussian");
        let entity = self.document.filter.as_ref().unwrap_or(&fallback);
        let mut p = Parameters::new(entity, &mut self.context);
        let filter = Filter::from_parameters(&mut p);
        p.finish();
        filter
    }
}
