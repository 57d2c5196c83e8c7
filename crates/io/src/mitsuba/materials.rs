//! BSDFs as our materials.
//!
//! Widths of microfacets (`alpha`) are taken as they are: `remaproughness` is off. Where Mitsuba's BSDFs without
//! `twosided` are black from behind, our opaque materials scatter on both sides.

use etendue_scene::Span;
use etendue_scene::document::{Entity, MaterialEntity, MaterialReference, TextureValue, Value};

use super::element::Element;
use super::reader::{Reader, entity, parameter};

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

/// Indices of refraction by the names that Mitsuba gives them, for sodium light.
const INDICES: &[(&str, f32)] = &[
    ("vacuum", 1.0),
    ("helium", 1.000_036),
    ("hydrogen", 1.000_132),
    ("air", 1.000_277),
    ("carbon dioxide", 1.000_45),
    ("water", 1.333),
    ("acetone", 1.36),
    ("ethanol", 1.361),
    ("carbon tetrachloride", 1.461),
    ("glycerol", 1.4729),
    ("benzene", 1.501),
    ("silicone oil", 1.520_45),
    ("bromine", 1.661),
    ("water ice", 1.31),
    ("fused quartz", 1.458),
    ("pyrex", 1.47),
    ("acrylic glass", 1.49),
    ("polypropylene", 1.49),
    ("bk7", 1.5046),
    ("sodium chloride", 1.544),
    ("amber", 1.55),
    ("pet", 1.575),
    ("diamond", 2.419),
];

/// Metals that both know, by Mitsuba's name and ours.
const METALS: &[(&str, &str)] = &[
    ("Ag", "Ag"),
    ("Al", "Al"),
    ("Au", "Au"),
    ("Cr", "Cr"),
    ("Cu", "Cu"),
    ("Cu_palik", "Cu"),
    ("CuZn", "CuZn"),
    ("MgO", "MgO"),
    ("Ni_palik", "Ni"),
    ("TiO2", "TiO2"),
    ("W", "W"),
];
/// Materials of conductors that Mitsuba knows and we do not measure.
const MISSING_METALS: &[&str] = &[
    "a-C",
    "AlAs",
    "AlAs_palik",
    "AlSb",
    "AlSb_palik",
    "Be",
    "CsI",
    "Cu2O",
    "CuO",
    "d-C",
    "Hg",
    "HgTe",
    "Ir",
    "K",
    "Li",
    "Mo",
    "Na_palik",
    "Nb",
    "Rh",
    "Se",
    "SiC",
    "SnTe",
    "Ta",
    "Te",
    "Te_palik",
    "ThF4",
    "TiC",
    "TiN",
    "V_palik",
    "VC",
    "VN",
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

    fn diffuse(&mut self, bsdf: &'e Element) -> Entity {
        let mut material = entity("diffuse", bsdf);
        self.pass_color(bsdf, "reflectance", &mut material, "reflectance");
        material
    }

    /// Facets of rms slope alpha / sqrt 2 as walls whose angle deviates as much.
    fn rough_diffuse(&mut self, bsdf: &'e Element) -> Entity {
        let mut material = entity("orennayar", bsdf);
        self.pass_color(bsdf, "reflectance", &mut material, "reflectance");
        self.accept(bsdf, &["use_fast_approx"]);
        let alpha = self.float(bsdf, "alpha", 0.2);
        let sigma = (alpha / std::f32::consts::SQRT_2).atan().to_degrees();
        material.with("sigma", Value::Floats(vec![sigma]))
    }

    /// Index inside relative to that outside.
    fn relative_index(&mut self, bsdf: &'e Element, default: f32) -> (f32, Span) {
        let span = bsdf.children.iter().find(|child| child.name == "int_ior").map_or(bsdf.span, |c| c.span);
        let inside = self.index(bsdf, "int_ior", default);
        let outside = self.index(bsdf, "ext_ior", 1.000_277);
        (inside / outside, span)
    }

    fn index(&mut self, bsdf: &'e Element, name: &'static str, default: f32) -> f32 {
        let Some(property) = self.property(bsdf, name) else { return default };
        let Some(value) = property.attribute("value") else { return default };
        let text = value.value.trim();
        let number = match text.parse::<f32>() {
            Ok(number) => Some(number),
            Err(_) => {
                INDICES.iter().find(|(known, _)| *known == text.to_lowercase()).map(|(_, index)| *index)
            }
        };
        match number {
            Some(number) if number > 0.0 && number.is_finite() => number,
            Some(number) => {
                let message = format!("an index of refraction is positive, not {number}");
                self.diagnostics.error(value.span, message);
                default
            }
            None => {
                let known = INDICES.iter().map(|(name, _)| *name);
                self.diagnostics.unknown_name(value.span, "material", text, known);
                default
            }
        }
    }

    fn pass_index(&mut self, bsdf: &'e Element, default: f32, material: &mut Entity, name: &str) {
        let (eta, span) = self.relative_index(bsdf, default);
        material.parameters.push(parameter(name, Value::Floats(vec![eta]), span));
    }

    /// `alpha`, or `alpha_u` and `alpha_v`; widths of facets without any remapping.
    fn pass_alpha(&mut self, bsdf: &'e Element, material: &mut Entity, prefix: &str, default: f32) {
        let name = |ours: &str| format!("{prefix}{ours}");
        let both = self.pass_number(bsdf, "alpha", material, &name("roughness"));
        let u = self.pass_number(bsdf, "alpha_u", material, &name("uroughness"));
        let v = self.pass_number(bsdf, "alpha_v", material, &name("vroughness"));
        if !(both || u && v) {
            material.parameters.push(parameter(&name("roughness"), Value::Floats(vec![default]), bsdf.span));
        }
        material.parameters.push(parameter("remaproughness", Value::Bools(vec![false]), bsdf.span));
    }

    /// The distribution of facets; Mitsuba's default is Beckmann's.
    fn pass_distribution(&mut self, bsdf: &'e Element, material: &mut Entity) {
        self.accept(bsdf, &["sample_visible"]);
        let (name, span) = self.string(bsdf, "distribution").unwrap_or(("beckmann", bsdf.span));
        let ours = match name {
            "beckmann" | "ggx" => name,
            "as" | "phong" => {
                let message =
                    format!("the distribution `{name}` is not available; `beckmann` stands in for it");
                self.diagnostics.warning(span, message);
                "beckmann"
            }
            _ => {
                self.diagnostics.unknown_name(span, "distribution", name, ["beckmann", "ggx"]);
                "beckmann"
            }
        };
        material.parameters.push(parameter("distribution", Value::Strings(vec![ours.to_owned()]), span));
    }

    /// Takes factors of the physical reflection, which are 1 for anything real.
    fn ignore_factors(&mut self, bsdf: &'e Element) {
        for name in ["specular_reflectance", "specular_transmittance", "specular_sampling_weight"] {
            let Some(property) = self.property(bsdf, name) else { continue };
            let is_white = property.attribute("value").is_some_and(|value| {
                value.value.split([' ', ',']).all(|x| x.is_empty() || x.parse() == Ok(1.0))
            });
            if !is_white && name != "specular_sampling_weight" {
                let message =
                    format!("`{name}` of `{}` is ignored: reflection follows from the index", bsdf.plugin());
                self.diagnostics.warning(property.span, message);
            }
        }
    }

    fn dielectric(&mut self, bsdf: &'e Element) -> Entity {
        let mut material = entity("dielectric", bsdf);
        self.pass_index(bsdf, 1.5046, &mut material, "eta");
        if bsdf.plugin() == "roughdielectric" {
            self.pass_alpha(bsdf, &mut material, "", 0.1);
            self.pass_distribution(bsdf, &mut material);
        }
        self.ignore_factors(bsdf);
        material
    }

    fn thin_dielectric(&mut self, bsdf: &'e Element) -> Entity {
        let mut material = entity("thindielectric", bsdf);
        self.pass_index(bsdf, 1.5046, &mut material, "eta");
        self.ignore_factors(bsdf);
        material
    }

    fn conductor(&mut self, bsdf: &'e Element) -> Entity {
        let mut material = entity("conductor", bsdf);
        if bsdf.plugin() == "roughconductor" {
            self.pass_alpha(bsdf, &mut material, "", 0.1);
            self.pass_distribution(bsdf, &mut material);
        }
        let eta = self.pass_color(bsdf, "eta", &mut material, "eta");
        let k = self.pass_color(bsdf, "k", &mut material, "k");
        let (name, span) = self.string(bsdf, "material").unwrap_or(("none", bsdf.span));
        // Without any, version 3 means a mirror and those before it copper.
        let is_mirror = name == "none" && (!self.is_legacy || Self::has(bsdf, "material"));
        if eta && k {
            // Given by numbers.
        } else if is_mirror {
            if !self.pass_color(bsdf, "specular_reflectance", &mut material, "reflectance") {
                material.parameters.push(parameter("reflectance", Value::Rgb(vec![[1.0; 3]]), span));
            }
        } else {
            self.pass_metal(if name == "none" { "Cu" } else { name }, span, &mut material);
        }
        self.ignore(bsdf, &["ext_eta"], "the metal is taken to be in air");
        self.ignore_factors(bsdf);
        material
    }

    fn pass_metal(&mut self, name: &str, span: Span, material: &mut Entity) {
        let known =
            METALS.iter().find(|(theirs, _)| theirs.eq_ignore_ascii_case(name)).map(|(_, ours)| *ours);
        let ours = known.unwrap_or_else(|| {
            if MISSING_METALS.contains(&name) {
                let message = format!("the material `{name}` is not available; chromium stands in for it");
                self.diagnostics.warning(span, message);
            } else {
                let names = METALS.iter().map(|(name, _)| *name).chain(MISSING_METALS.iter().copied());
                self.diagnostics.unknown_name(span, "material", name, names);
            }
            "Cr"
        });
        for part in ["eta", "k"] {
            let value = Value::SpectrumNames(vec![format!("metal-{ours}-{part}")]);
            material.parameters.push(parameter(part, value, span));
        }
    }

    fn plastic(&mut self, bsdf: &'e Element) -> Entity {
        let mut material = entity("coateddiffuse", bsdf);
        self.pass_color(bsdf, "diffuse_reflectance", &mut material, "reflectance");
        self.pass_index(bsdf, 1.49, &mut material, "eta");
        if bsdf.plugin() == "roughplastic" {
            self.pass_alpha(bsdf, &mut material, "", 0.1);
            if let Some(("beckmann" | "as" | "phong", span)) = self.string(bsdf, "distribution") {
                let message = "the coat of plastics has facets `ggx` here";
                self.diagnostics.warning(span, message);
            }
            self.accept(bsdf, &["sample_visible"]);
        }
        // The walk between coat and base is what `nonlinear` approximates.
        self.accept(bsdf, &["nonlinear"]);
        self.ignore_factors(bsdf);
        material
    }

    /// Disney's model by the parameters of glTF's, which have the same meaning but for `specular` and the tints.
    fn principled(&mut self, bsdf: &'e Element) -> Entity {
        let mut material = entity("principled", bsdf);
        if !self.pass_color(bsdf, "base_color", &mut material, "basecolor") {
            material.parameters.push(parameter("basecolor", Value::Rgb(vec![[0.5; 3]]), bsdf.span));
        }
        self.pass_number(bsdf, "metallic", &mut material, "metallic");
        self.pass_number(bsdf, "roughness", &mut material, "roughness");
        self.pass_number(bsdf, "anisotropic", &mut material, "anisotropy");
        let has_coat = self.pass_number(bsdf, "clearcoat", &mut material, "clearcoat");
        let is_thin = bsdf.plugin() == "principledthin";
        let has_glass = self.pass_number(bsdf, "spec_trans", &mut material, "transmission");
        if has_glass && !is_thin {
            // A solid of glass, however thick.
            material.parameters.push(parameter("thickness", Value::Floats(vec![1.0]), bsdf.span));
        }
        let gloss = self.float_opt(bsdf, "clearcoat_gloss").or(has_coat.then_some(0.0));
        if let Some(gloss) = gloss {
            // The coat's alpha goes from 0.1 to 0.001; ours is given by its square root.
            let alpha = 0.1 + (0.001 - 0.1) * gloss.clamp(0.0, 1.0);
            material = material.with("clearcoatroughness", Value::Floats(vec![alpha.sqrt()]));
        }
        if let Some(eta) = self.float_opt(bsdf, "eta") {
            material = material.with("ior", Value::Floats(vec![eta.clamp(1.0, 4.0)]));
        } else if let Some(specular) = self.float_opt(bsdf, "specular") {
            // F0 = 0.08 specular, and F0 = ((ior - 1) / (ior + 1))^2.
            let root = (0.08 * specular.clamp(0.0, 1.0)).sqrt();
            material = material.with("ior", Value::Floats(vec![(1.0 + root) / (1.0 - root)]));
        }
        if let Some(sheen) = self.float_opt(bsdf, "sheen").filter(|sheen| *sheen > 0.0) {
            material = material.with("sheencolor", Value::Rgb(vec![[sheen.min(1.0); 3]]));
        }
        let why = "the material `principled` has no counterpart of it";
        self.ignore(bsdf, &["spec_tint", "sheen_tint", "flatness", "diff_trans"], why);
        self.accept(
            bsdf,
            &[
                "diffuse_reflectance_sampling_rate",
                "specular_reflectance_sampling_rate",
                "main_specular_sampling_rate",
                "clearcoat_sampling_rate",
                "spec_tint",
                "diffuse_sampling_rate",
                "specular_sampling_rate",
            ],
        );
        material
    }

    /// The models of Phong and Ward of version 0.6.
    fn highlight(&mut self, bsdf: &'e Element) -> Entity {
        let mut material = entity(bsdf.plugin(), bsdf);
        self.pass_color(bsdf, "diffuse_reflectance", &mut material, "kd");
        self.pass_color(bsdf, "specular_reflectance", &mut material, "ks");
        self.accept(bsdf, &["variant"]);
        if bsdf.plugin() == "phong" {
            self.pass_number(bsdf, "exponent", &mut material, "exponent");
        } else {
            self.pass_number(bsdf, "alpha_u", &mut material, "uroughness");
            self.pass_number(bsdf, "alpha_v", &mut material, "vroughness");
            if !self.pass_number(bsdf, "alpha", &mut material, "roughness") {
                material = material.with("roughness", Value::Floats(vec![0.1]));
            }
        }
        material
    }

    fn diffuse_transmission(&mut self, bsdf: &'e Element) -> Entity {
        let mut material = entity("diffusetransmission", bsdf);
        if !self.pass_color(bsdf, "transmittance", &mut material, "transmittance") {
            material.parameters.push(parameter("transmittance", Value::Rgb(vec![[0.5; 3]]), bsdf.span));
        }
        material.parameters.push(parameter("reflectance", Value::Rgb(vec![[0.0; 3]]), bsdf.span));
        material
    }

    fn measured(&mut self, bsdf: &'e Element) -> Entity {
        let mut material = entity("measured", bsdf);
        if let Some((file, span)) = self.string(bsdf, "filename") {
            let file = self.files.resolved(file);
            material.parameters.push(parameter("filename", Value::Strings(vec![file]), span));
        }
        material
    }

    fn hair(&mut self, bsdf: &'e Element) -> Entity {
        let mut material = entity("hair", bsdf);
        self.pass_color(bsdf, "sigma_a", &mut material, "sigma_a");
        let names = [
            ("eumelanin", "eumelanin"),
            ("pheomelanin", "pheomelanin"),
            ("longitudinal_roughness", "beta_m"),
            ("azimuthal_roughness", "beta_n"),
            ("scale_tilt", "alpha"),
        ];
        for (theirs, ours) in names {
            self.pass_number(bsdf, theirs, &mut material, ours);
        }
        self.pass_index(bsdf, 1.55, &mut material, "eta");
        material
    }
}

/// BSDFs around others.
impl<'e> Reader<'e> {
    /// The nested BSDF of that index.
    fn inner(&mut self, bsdf: &'e Element) -> Option<&'e Element> {
        let nested = self.nested(bsdf, "bsdf");
        if nested.is_empty() {
            let message = format!("`{}` needs a BSDF inside", bsdf.plugin());
            self.diagnostics.error(bsdf.plugin_span(), message);
        }
        nested.first().copied()
    }

    fn inner_surface(&mut self, bsdf: &'e Element) -> Surface {
        let inner = self.inner(bsdf).and_then(|inner| self.surface(inner));
        inner.unwrap_or_else(|| Surface::new(entity("diffuse", bsdf)))
    }

    fn two_sided(&mut self, bsdf: &'e Element) -> Surface {
        if let [_, second, ..] = self.nested(bsdf, "bsdf").as_slice() {
            let message = "both sides have the same material here; the second is ignored";
            self.diagnostics.warning(second.plugin_span(), message);
        }
        self.inner_surface(bsdf)
    }

    fn mask(&mut self, bsdf: &'e Element) -> Surface {
        let opacity = self.number_opt(bsdf, "opacity").map_or(Value::Floats(vec![0.5]), |(value, _)| value);
        let inner = self.inner_surface(bsdf);
        if inner.alpha.is_some() {
            self.diagnostics.warning(bsdf.plugin_span(), "a mask inside of a mask is ignored");
        }
        Surface { alpha: Some(opacity), ..inner }
    }

    /// The name of the nested material; masks within blends are reported.
    fn part(&mut self, bsdf: &'e Element) -> String {
        match self.material(bsdf) {
            (MaterialReference::Name(name, _), alpha) => {
                if alpha.is_some() {
                    let message = "a mask inside of a blend is ignored";
                    self.diagnostics.warning(bsdf.plugin_span(), message);
                }
                name
            }
            (MaterialReference::Index(_), _) => String::new(),
        }
    }

    fn blend(&mut self, bsdf: &'e Element) -> Entity {
        let weight = self.number_opt(bsdf, "weight");
        let nested = self.nested(bsdf, "bsdf");
        let [first, second] = nested.as_slice() else {
            let message = format!("a blend has two BSDFs, not {}", nested.len());
            self.diagnostics.error(bsdf.plugin_span(), message);
            return entity("diffuse", bsdf);
        };
        let names = vec![self.part(first), self.part(second)];
        let mut material = entity("mix", bsdf).with("materials", Value::Strings(names));
        material.parameters.extend(weight.map(|(value, span)| parameter("amount", value, span)));
        material
    }

    /// Any number of BSDFs by constant weights: blends of two inside of each other.
    fn mixture(&mut self, bsdf: &'e Element) -> Entity {
        let mut weights = Vec::new();
        if let Some(property) = self.property(bsdf, "weights") {
            let value = property.attribute("value");
            weights =
                value.and_then(|v| super::values::numbers(v, &mut self.diagnostics)).unwrap_or_default();
        }
        let nested = self.nested(bsdf, "bsdf");
        if nested.is_empty() || weights.len() != nested.len() || weights.iter().any(|w| *w < 0.0) {
            let message = "a mixture needs BSDFs and one weight, not negative, for each";
            self.diagnostics.error(bsdf.plugin_span(), message);
            return entity("diffuse", bsdf);
        }
        if weights.iter().sum::<f32>() < 0.999 {
            let message =
                "weights that add up to less than 1 absorb light in Mitsuba; here they are scaled up to 1";
            self.diagnostics.warning(bsdf.plugin_span(), message);
        }
        let mut sum = weights[0];
        let mut name = self.part(nested[0]);
        let mut material = self.surface(nested[0]).map_or(entity("diffuse", bsdf), |surface| surface.entity);
        for (index, (part, weight)) in nested.iter().zip(&weights).enumerate().skip(1) {
            sum += weight;
            let amount = if sum > 0.0 { weight / sum } else { 0.5 };
            let names = vec![name.clone(), self.part(part)];
            material = entity("mix", bsdf)
                .with("materials", Value::Strings(names))
                .with("amount", Value::Floats(vec![amount]));
            if index + 1 < nested.len() {
                name = format!("{} part {index}", Self::name_of(bsdf));
                let material = MaterialEntity { name: Some(name.clone()), entity: material.clone() };
                self.document.materials.push(material);
            }
        }
        material
    }

    fn bump_map(&mut self, bsdf: &'e Element) -> Surface {
        let mut surface = self.inner_surface(bsdf);
        let scale = self.float(bsdf, "scale", 1.0);
        let textures = self.nested(bsdf, "texture");
        let Some(texture) = textures.first() else {
            self.diagnostics.error(bsdf.plugin_span(), "a bump map needs a texture inside");
            return surface;
        };
        let Some(height) = self.texture(texture, TextureValue::Float) else { return surface };
        let name = format!("{} height", Self::name_of(bsdf));
        let height = self.scaled_texture(name, height, scale, texture);
        surface.entity.parameters.push(parameter("displacement", height, texture.plugin_span()));
        surface
    }

    fn normal_map(&mut self, bsdf: &'e Element) -> Surface {
        let mut surface = self.inner_surface(bsdf);
        let textures = self.nested(bsdf, "texture");
        let Some(texture) = textures.first().copied() else {
            self.diagnostics.error(bsdf.plugin_span(), "a normal map needs a texture inside");
            return surface;
        };
        let Some((file, span)) = self.string(texture, "filename") else {
            let message = "normal maps are pictures here: a `bitmap` with a `filename`";
            self.diagnostics.warning(texture.plugin_span(), message);
            return surface;
        };
        self.accept(texture, &["raw", "filter_type", "wrap_mode", "gamma", "format"]);
        self.ignore(texture, &["to_uv"], "normal maps follow the coordinates of the shape");
        self.finish(texture);
        let file = self.files.resolved(file);
        surface.entity.parameters.push(parameter("normalmap", Value::Strings(vec![file]), span));
        surface
    }

    /// A coat over a diffuse or metallic base.
    fn coating(&mut self, bsdf: &'e Element) -> Surface {
        let mut surface = self.inner_surface(bsdf);
        self.ignore(bsdf, &["sigma_a"], "coats are clear here");
        self.accept(bsdf, &["thickness"]);
        self.ignore_factors(bsdf);
        let prefix = match surface.entity.type_name.as_str() {
            "diffuse" => "",
            "conductor" => "interface.",
            other => {
                let message = format!("a coat over `{other}` is not available; it is left out");
                self.diagnostics.warning(bsdf.plugin_span(), message);
                self.relative_index(bsdf, 1.5046);
                self.accept(bsdf, &["alpha", "distribution", "sample_visible"]);
                return surface;
            }
        };
        let material = &mut surface.entity;
        material.type_name = format!("coated{}", material.type_name);
        if prefix.is_empty() {
            material.parameters.retain(|p| p.name != "remaproughness");
        } else {
            material.parameters.retain(|p| !matches!(p.name.as_str(), "remaproughness" | "distribution"));
            for p in &mut material.parameters {
                if matches!(p.name.as_str(), "eta" | "k" | "roughness" | "uroughness" | "vroughness") {
                    p.name = format!("conductor.{}", p.name);
                }
            }
        }
        self.pass_index(bsdf, 1.5046, material, &format!("{prefix}eta"));
        let alpha = if bsdf.plugin() == "roughcoating" { 0.1 } else { 0.0 };
        self.pass_alpha(bsdf, material, prefix, alpha);
        self.accept(bsdf, &["distribution", "sample_visible"]);
        surface
    }
}
