//! Switches of artists along a path from a light (SPEC EMI-14; [`etendue_scene::controls`] says what they mean): the same paths
//! are left out as by paths from the camera.

use etendue_geometry::GeometryId;
use etendue_scene::bsdf::{Bsdf, Lobes};
use etendue_scene::controls::Controls;

use crate::lpe::Event;

/// What the way from the light forbids to follow.
#[derive(Clone, Copy, Debug, Default)]
pub struct Switches {
    /// The last shape that scattered diffusely.
    diffuse: Option<GeometryId>,
    /// The path has scattered sharply since.
    is_sharp: bool,
    /// And some shape that did so casts no caustics.
    no_caustic: bool,
}

/// True for scattering that makes caustics.
const fn is_sharp(event: Event) -> bool {
    matches!(event, Event::Specular | Event::SharpGlossy)
}

impl Switches {
    /// Notes that the path scatters at a shape; `false` if no light goes on that way.
    #[must_use]
    pub fn scatter(&mut self, controls: &Controls, id: GeometryId, event: Event) -> bool {
        if is_sharp(event) {
            self.is_sharp = true;
            self.no_caustic |= !controls.shape(id).casts_caustics;
            return true;
        }
        let goes_on = self.admits_diffuse(controls, id);
        *self = Self { diffuse: Some(id), ..Self::default() };
        goes_on
    }

    /// The lobes through which a shape shows the light that has come.
    #[must_use]
    pub fn lobes(&self, controls: &Controls, id: GeometryId, bsdf: &Bsdf, sharp_alpha: f32) -> Lobes {
        if self.admits_diffuse(controls, id) {
            Lobes::ALL
        } else if is_sharp(Event::glossy(bsdf.glossy_roughness(), sharp_alpha)) {
            Lobes::GLOSSY
        } else {
            Lobes::NONE
        }
    }

    /// May a diffuse lobe of the shape send the light on?
    fn admits_diffuse(&self, controls: &Controls, id: GeometryId) -> bool {
        let shape = controls.shape(id);
        match self.diffuse {
            Some(from) => shape.receives_indirect && controls.shape(from).casts_indirect,
            None => !self.is_sharp || shape.receives_caustics && !self.no_caustic,
        }
    }
}
