//! BSDFs as our materials.
//!
//! Widths of microfacets (`alpha`) are taken as they are: `remaproughness` is off. Where Mitsuba's BSDFs without
//! `twosided` are black from behind, our opaque materials scatter on both sides.

mod nested;
mod opaque;
mod properties;
mod specular;

use etendue_scene::document::{Entity, MaterialEntity, MaterialReference, Value};

use super::element::Element;
use super::reader::{Reader, entity};

/// A material, and the share of rays that meet it.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    pub(super) entity: Entity,
    /// Value of the parameter `alpha` of shapes, from `mask`.
    pub(super) alpha: Option<Value>,
}

impl Surface {
    fn new(entity: Entity) -> Self {
        Self { entity, alpha: None }
    }
}

const KNOWN: &[&str] = &[
    "diffuse",
    "roughdiffuse",
    "dielectric",
    "thindielectric",
    "roughdielectric",
    "conductor",
    "roughconductor",
    "plastic",
    "roughplastic",
    "principled",
    "principledthin",
    "mask",
    "twosided",
    "blendbsdf",
    "mixturebsdf",
    "bumpmap",
    "bump",
    "normalmap",
    "phong",
    "ward",
    "coating",
    "roughcoating",
    "null",
    "difftrans",
    "measured",
    "hair",
];
const MISSING: &[&str] = &[
    "irawan",
    "hk",
    "sssbrdf",
    "dipole",
    "rmbrdf",
    "polarizer",
    "retarder",
    "circular",
    "pplastic",
    "merl",
    "microfacet",
];

impl<'e> Reader<'e> {
    /// The material of a shape and the alpha that shapes of it have.
    pub(super) fn material(&mut self, bsdf: &'e Element) -> (MaterialReference, Option<Value>) {
        let Some(surface) = self.surface(bsdf) else { return (MaterialReference::Index(0), None) };
        let name = Self::name_of(bsdf);
        if self.materials.insert(bsdf.number) {
            let material = MaterialEntity { name: Some(name.clone()), entity: surface.entity };
            self.document.materials.push(material);
        }
        (MaterialReference::Name(name, Some(bsdf.span)), surface.alpha)
    }

    /// What a BSDF is here. What cannot be had is reported and grey.
    fn surface(&mut self, bsdf: &'e Element) -> Option<Surface> {
        if let Some(known) = self.surfaces.get(&bsdf.number) {
            return Some(known.clone());
        }
        let surface = self.guarded(bsdf, |reader| Some(reader.convert(bsdf)))?;
        self.finish(bsdf);
        self.surfaces.insert(bsdf.number, surface.clone());
        Some(surface)
    }

    fn convert(&mut self, bsdf: &'e Element) -> Surface {
        let entity = match bsdf.plugin() {
            "diffuse" => self.diffuse(bsdf),
            "roughdiffuse" => self.rough_diffuse(bsdf),
            "dielectric" | "roughdielectric" => self.dielectric(bsdf),
            "thindielectric" => self.thin_dielectric(bsdf),
            "conductor" | "roughconductor" => self.conductor(bsdf),
            "plastic" | "roughplastic" => self.plastic(bsdf),
            "principled" | "principledthin" => self.principled(bsdf),
            "phong" | "ward" => self.highlight(bsdf),
            "null" => entity("interface", bsdf),
            "difftrans" => self.diffuse_transmission(bsdf),
            "measured" => self.measured(bsdf),
            "hair" => self.hair(bsdf),
            "mask" => return self.mask(bsdf),
            "twosided" => return self.two_sided(bsdf),
            "blendbsdf" => return Surface::new(self.blend(bsdf)),
            "mixturebsdf" => return Surface::new(self.mixture(bsdf)),
            "bumpmap" | "bump" => return self.bump_map(bsdf),
            "normalmap" => return self.normal_map(bsdf),
            "coating" | "roughcoating" => return self.coating(bsdf),
            _ => {
                self.unknown_plugin(bsdf, MISSING, KNOWN, "a grey `diffuse` stands in for it");
                entity("diffuse", bsdf)
            }
        };
        Surface::new(entity)
    }
}
