//! Switches of artists along a path (SPEC EMI-14; [`etendue_scene::controls`] says what they mean). What a sample of a light
//! may not bring, a hit of it may not count, so that both techniques stay in balance.
//!
//! A sampled direction of a material with several lobes carries the light of all of them, and is taken for one that is drawn
//! by what each contributes over the sum of the wavelengths. Where only some of the lobes are switched off and they differ in
//! colour, what is left of such directions is right in luminance, but has the colour of the whole; samples of lights take each
//! lobe with its own colour.

use etendue_geometry::GeometryId;
use etendue_scene::bsdf::{Bsdf, Lobes};
use etendue_scene::controls::Controls;
use etendue_scene::light::LightId;

use crate::lpe::Event;

/// What the way from the camera leaves to be found.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Artist {
    /// The path has scattered diffusely.
    is_diffuse: bool,
    /// And sharply since.
    is_sharp: bool,
    no_caustic: bool,
    no_indirect: bool,
    /// The shape that it left last.
    from: Option<GeometryId>,
}

/// True for scattering that makes caustics.
const fn is_sharp(event: Event) -> bool {
    matches!(event, Event::Specular | Event::SharpGlossy)
}

impl Artist {
    /// The lobes through which light that was sampled may be seen at a shape.
    pub(crate) fn lobes(&self, controls: &Controls, id: GeometryId, bsdf: &Bsdf, sharp_alpha: f32) -> Lobes {
        let (diffuse, sharp) = (self.admits_indirect(controls, id), self.admits_caustic(controls, id));
        let glossy_is_sharp = is_sharp(Event::glossy(bsdf.glossy_roughness(), sharp_alpha));
        let glossy = if glossy_is_sharp { sharp } else { diffuse };
        match (diffuse, glossy) {
            (true, true) => Lobes::ALL,
            (true, false) => Lobes::DIFFUSE,
            (false, true) => Lobes::GLOSSY,
            (false, false) => Lobes::NONE,
        }
    }

    /// Notes that the path scatters at a shape; `false` if all that it may find from here is switched off.
    pub(crate) fn scatter(&mut self, controls: &Controls, id: GeometryId, event: Event) -> bool {
        self.from = Some(id);
        if is_sharp(event) {
            self.no_caustic = !self.admits_caustic(controls, id);
            self.is_sharp = true;
            return true;
        }
        let goes_on = self.admits_indirect(controls, id);
        let shape = controls.shape(id);
        *self = Self {
            is_diffuse: true,
            is_sharp: false,
            no_caustic: !shape.receives_caustics,
            no_indirect: !shape.receives_indirect,
            from: self.from,
        };
        goes_on
    }

    /// False if light that the path runs into is switched off.
    pub(crate) fn admits(&self, controls: &Controls, light: LightId) -> bool {
        let is_hidden = self.is_diffuse && self.is_sharp && self.no_caustic;
        !is_hidden && self.from.is_none_or(|from| controls.reaches(light, from))
    }

    /// May a diffuse lobe of the shape send light along the path?
    fn admits_indirect(&self, controls: &Controls, id: GeometryId) -> bool {
        !self.is_diffuse || !self.no_indirect && controls.shape(id).casts_indirect
    }

    /// May a sharp one?
    fn admits_caustic(&self, controls: &Controls, id: GeometryId) -> bool {
        !self.is_diffuse || !self.no_caustic && controls.shape(id).casts_caustics
    }
}
