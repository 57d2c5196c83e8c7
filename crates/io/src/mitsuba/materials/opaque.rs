//! Matte, glossy and layered surfaces, and hair.

use etendue_scene::document::{Entity, Value};

use crate::mitsuba::element::Element;
use crate::mitsuba::reader::{Reader, entity, parameter};

impl<'e> Reader<'e> {
    pub(super) fn diffuse(&mut self, bsdf: &'e Element) -> Entity {
        let mut material = entity("diffuse", bsdf);
        self.pass_color(bsdf, "reflectance", &mut material, "reflectance");
        material
    }

    /// Facets of rms slope alpha / sqrt 2 as walls whose angle deviates as much.
    pub(super) fn rough_diffuse(&mut self, bsdf: &'e Element) -> Entity {
        let mut material = entity("orennayar", bsdf);
        self.pass_color(bsdf, "reflectance", &mut material, "reflectance");
        self.accept(bsdf, &["use_fast_approx"]);
        let alpha = self.float(bsdf, "alpha", 0.2);
        let sigma = (alpha / std::f32::consts::SQRT_2).atan().to_degrees();
        material.with("sigma", Value::Floats(vec![sigma]))
    }

    pub(super) fn plastic(&mut self, bsdf: &'e Element) -> Entity {
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
    pub(super) fn principled(&mut self, bsdf: &'e Element) -> Entity {
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
    pub(super) fn highlight(&mut self, bsdf: &'e Element) -> Entity {
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

    pub(super) fn diffuse_transmission(&mut self, bsdf: &'e Element) -> Entity {
        let mut material = entity("diffusetransmission", bsdf);
        if !self.pass_color(bsdf, "transmittance", &mut material, "transmittance") {
            material.parameters.push(parameter("transmittance", Value::Rgb(vec![[0.5; 3]]), bsdf.span));
        }
        material.parameters.push(parameter("reflectance", Value::Rgb(vec![[0.0; 3]]), bsdf.span));
        material
    }

    pub(super) fn measured(&mut self, bsdf: &'e Element) -> Entity {
        let mut material = entity("measured", bsdf);
        if let Some((file, span)) = self.string(bsdf, "filename") {
            let file = self.files.resolved(file);
            material.parameters.push(parameter("filename", Value::Strings(vec![file]), span));
        }
        material
    }

    pub(super) fn hair(&mut self, bsdf: &'e Element) -> Entity {
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
