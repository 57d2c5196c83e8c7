//! Emitters and media.
//!
//! Colours are in our units as they are: where an emitter of colour 1 gives a picture of 1, ours of 1 cd/m^2 does. Spectra
//! are absolute there, in W/(m^2 sr nm), and [`FROM_RADIOMETRIC`] makes their pictures agree.

use etendue_math::{AnimatedTransform, Point3, Transform, Vector3};
use etendue_scene::Span;
use etendue_scene::document::{EmbeddedFile, Entity, LightEntity, MediumEntity, TextureValue, Value};

use super::element::Element;
use super::environment::{equal_area_of_latitude_longitude, y_is_up};
use super::reader::{FROM_RADIOMETRIC, Reader, entity, parameter};
use super::textures::ConstantSpectrum;
use super::values::{self, SpectrumValue};
use crate::images::read_texels;

const KNOWN: &[&str] =
    &["area", "point", "spot", "directional", "constant", "envmap", "projector", "sun", "sky", "sunsky"];
const MISSING: &[&str] = &["directionalarea", "collimated", "timedsunsky", "vmf", "volumelight"];

impl<'e> Reader<'e> {
    /// Index of the emission of a shape.
    pub(super) fn area_light(&mut self, emitter: &'e Element) -> Option<usize> {
        if emitter.plugin() != "area" {
            let missing = ["directionalarea"];
            self.unknown_plugin(emitter, &missing, &["area"], "the shape does not emit");
            return None;
        }
        let mut light = entity("diffuse", emitter);
        self.emission(emitter, "radiance", &mut light, "L", 1.0);
        self.accept(emitter, &["sampling_weight"]);
        self.finish(emitter);
        self.document.area_lights.push(light);
        Some(self.document.area_lights.len() - 1)
    }

    /// A light that is no shape.
    pub(super) fn emitter(&mut self, emitter: &'e Element) {
        let light = match emitter.plugin() {
            "point" => self.point(emitter),
            "spot" => self.spot(emitter),
            "directional" => self.directional(emitter),
            "constant" => {
                let mut light = entity("infinite", emitter);
                self.emission(emitter, "radiance", &mut light, "L", 1.0);
                Some((light, AnimatedTransform::constant(Transform::IDENTITY)))
            }
            "envmap" => self.environment(emitter),
            "projector" => self.projector(emitter),
            "sun" | "sky" | "sunsky" => self.sun_and_sky(emitter),
            "area" => {
                self.diagnostics.error(emitter.plugin_span(), "an `area` emitter belongs inside of a shape");
                None
            }
            _ => {
                self.unknown_plugin(emitter, MISSING, KNOWN, "it is left out");
                return;
            }
        };
        self.accept(emitter, &["sampling_weight", "medium"]);
        self.finish(emitter);
        if let Some((entity, world_from_light)) = light {
            self.push_light(entity, world_from_light);
        }
    }

    fn push_light(&mut self, entity: Entity, world_from_light: AnimatedTransform) {
        self.document.lights.push(LightEntity { entity, world_from_light, outside_medium: String::new() });
    }

    /// Gives a light its emission: colour or spectrum, units and factor.
    fn emission(
        &mut self,
        emitter: &'e Element,
        theirs: &'static str,
        light: &mut Entity,
        ours: &str,
        factor: f32,
    ) {
        let Some(property) = self.property(emitter, theirs) else {
            light.parameters.push(parameter(ours, Value::Rgb(vec![[factor; 3]]), emitter.span));
            return;
        };
        let spectrum = match property.tag.as_str() {
            "float" | "rgb" | "srgb" if !property.is_plugin() => {
                values::color(property, &mut self.diagnostics).map(ConstantSpectrum::Rgb)
            }
            "blackbody" => {
                let number = |reader: &mut Self, name: &str, default: f32| {
                    property
                        .attribute(name)
                        .map_or(Some(default), |a| values::number(a, &mut reader.diagnostics))
                };
                let (kelvin, scale) = (number(self, "temperature", 5000.0), number(self, "scale", 1.0));
                Some(ConstantSpectrum::Blackbody(kelvin.unwrap_or(5000.0), scale.unwrap_or(1.0)))
            }
            "spectrum" if !property.is_plugin() => self.spectrum_of(property).map(ConstantSpectrum::Spectrum),
            _ => self.emission_of_plugin(property, light, factor),
        };
        let Some(spectrum) = spectrum else { return };
        let (value, scale) = match spectrum {
            ConstantSpectrum::Rgb(rgb) => (Value::Rgb(vec![rgb]), factor),
            ConstantSpectrum::Blackbody(kelvin, scale) => {
                (Value::Blackbody(vec![kelvin]), factor * scale * FROM_RADIOMETRIC)
            }
            ConstantSpectrum::Spectrum(SpectrumValue::Constant(x)) => {
                (Value::SpectrumSamples(vec![[360.0, x], [830.0, x]]), factor * FROM_RADIOMETRIC)
            }
            ConstantSpectrum::Spectrum(spectrum) => (spectrum.into_value(), factor * FROM_RADIOMETRIC),
        };
        if !matches!(value, Value::Rgb(_)) {
            let units = Value::Strings(vec!["radiometric".to_owned()]);
            light.parameters.push(parameter("units", units, property.span));
        }
        light.parameters.push(parameter(ours, value, property.span));
        if scale != 1.0 {
            light.parameters.push(parameter("scale", Value::Floats(vec![scale]), property.span));
        }
    }

    /// Emission by a plugin: a constant, or a picture, which is handed to the light.
    fn emission_of_plugin(
        &mut self,
        property: &'e Element,
        light: &mut Entity,
        factor: f32,
    ) -> Option<ConstantSpectrum> {
        let texture = self.resolved(property)?;
        if let Some(constant) = self.constant_spectrum(texture) {
            self.finish(texture);
            return Some(constant);
        }
        if texture.plugin() == "bitmap" && matches!(light.type_name.as_str(), "diffuse" | "projection") {
            let (file, span) = self.string(texture, "filename")?;
            let file = self.files.resolved(file);
            self.accept(texture, &["raw", "filter_type", "wrap_mode"]);
            self.ignore(texture, &["to_uv"], "pictures of lights cover them once");
            self.finish(texture);
            light.parameters.push(parameter("filename", Value::Strings(vec![file]), span));
            if factor != 1.0 {
                light.parameters.push(parameter("scale", Value::Floats(vec![factor]), span));
            }
            return None;
        }
        // Whatever it is, its problems are named.
        self.texture(texture, TextureValue::Spectrum);
        let message = format!("the texture `{}` cannot emit; white stands in for it", texture.plugin());
        self.diagnostics.warning(texture.plugin_span(), message);
        Some(ConstantSpectrum::Rgb([1.0; 3]))
    }

    fn point(&mut self, emitter: &'e Element) -> Option<(Entity, AnimatedTransform)> {
        let mut light = entity("point", emitter);
        self.emission(emitter, "intensity", &mut light, "I", 1.0);
        let to_world = self.transform(emitter, "to_world");
        if let Some(property) = self.property(emitter, "position") {
            let [x, y, z] = values::triple(property, 0.0, &mut self.diagnostics)?;
            let position = Value::Points3(vec![Point3::new(x, y, z)]);
            light.parameters.push(parameter("from", position, property.span));
        }
        Some((light, to_world))
    }

    /// Full within `beam_width`, falling to 0 at `cutoff_angle`; the edge is linear in the angle there and smooth here.
    fn spot(&mut self, emitter: &'e Element) -> Option<(Entity, AnimatedTransform)> {
        let mut light = entity("spot", emitter);
        self.emission(emitter, "intensity", &mut light, "I", 1.0);
        let cutoff = self.float(emitter, "cutoff_angle", 20.0);
        let beam = self.float(emitter, "beam_width", cutoff * 0.75);
        self.ignore(emitter, &["texture"], "spots have no picture here");
        let span = emitter.span;
        light.parameters.push(parameter("coneangle", Value::Floats(vec![cutoff]), span));
        light.parameters.push(parameter("conedeltaangle", Value::Floats(vec![cutoff - beam]), span));
        Some((light, self.transform(emitter, "to_world")))
    }

    fn directional(&mut self, emitter: &'e Element) -> Option<(Entity, AnimatedTransform)> {
        let mut light = entity("distant", emitter);
        self.emission(emitter, "irradiance", &mut light, "L", 1.0);
        let to_world = self.transform(emitter, "to_world");
        if let Some(property) = self.property(emitter, "direction") {
            let [x, y, z] = values::triple(property, 0.0, &mut self.diagnostics)?;
            light.parameters.push(parameter("to", Value::Points3(vec![Point3::new(x, y, z)]), property.span));
            return Some((light, AnimatedTransform::constant(Transform::IDENTITY)));
        }
        Some((light, to_world))
    }

    fn projector(&mut self, emitter: &'e Element) -> Option<(Entity, AnimatedTransform)> {
        let mut light = entity("projection", emitter);
        let scale = self.float(emitter, "scale", 1.0);
        self.emission(emitter, "irradiance", &mut light, "I", scale);
        let fov = self.float(emitter, "fov", 90.0);
        self.ignore(emitter, &["fov_axis"], "the angle spans the shorter side");
        light.parameters.push(parameter("fov", Value::Floats(vec![fov]), emitter.span));
        let to_world = self.transform(emitter, "to_world");
        Some((light, mirrored(&to_world)))
    }

    /// A picture by longitude and latitude becomes an equal-area one.
    fn environment(&mut self, emitter: &'e Element) -> Option<(Entity, AnimatedTransform)> {
        let Some((file, span)) = self.string(emitter, "filename") else {
            self.diagnostics.error(emitter.plugin_span(), "an `envmap` needs a `filename`");
            return None;
        };
        let scale = self.float(emitter, "scale", 1.0);
        self.accept(emitter, &["raw", "mis_compensation", "gamma", "cache"]);
        let to_world = self.transform(emitter, "to_world");
        let name = self.equal_area_picture(file, span)?;
        let mut light = entity("infinite", emitter);
        light.parameters.push(parameter("filename", Value::Strings(vec![name]), span));
        light.parameters.push(parameter("scale", Value::Floats(vec![scale]), span));
        Some((light, to_world))
    }

    fn equal_area_picture(&mut self, file: &str, span: Span) -> Option<String> {
        let file = self.files.resolved(file);
        match read_texels(self.files.base_directory.join(&file)) {
            Ok(texels) => {
                let square = equal_area_of_latitude_longitude(&texels, &y_is_up);
                let picture = EmbeddedFile::Image(square.into());
                Some(self.document.embed(&format!("{file} (equal areas)"), picture))
            }
            Err(error) => {
                self.diagnostics.error(span, error.to_string());
                None
            }
        }
    }

    /// Our own model of the air in place of Preetham's or Hosek's. What it gives is absolute, so that only the factor of
    /// spectra is between us.
    fn sun_and_sky(&mut self, emitter: &'e Element) -> Option<(Entity, AnimatedTransform)> {
        let scale = self.float(emitter, "scale", 1.0) * FROM_RADIOMETRIC;
        let [sun, sky] = ["sun_scale", "sky_scale"].map(|name| self.float(emitter, name, 1.0));
        let kind = match emitter.plugin() {
            "sunsky" if sky == 0.0 => "sun",
            "sunsky" if sun == 0.0 => "sky",
            other => other,
        };
        let mut light = entity(kind, emitter);
        let factor = scale * if kind == "sun" { sun } else { sky };
        light = light.with("scale", Value::Floats(vec![factor]));
        if kind == "sunsky" && sun != sky {
            light = light.with("sunscale", Value::Floats(vec![sun / sky]));
        }
        self.pass_number(emitter, "turbidity", &mut light, "turbidity");
        if let Some((Value::Floats(albedo), span)) = self.number_opt(emitter, "albedo") {
            light.parameters.push(parameter("groundalbedo", Value::Floats(albedo), span));
        }
        self.sun_position(emitter, &mut light);
        if self.is_legacy {
            light = light.with("up", Value::Vectors3(vec![Vector3::new(0.0, 1.0, 0.0)]));
        }
        self.accept(
            emitter,
            &[
                "stretch",
                "resolution",
                "sun_radius_scale",
                "sun_aperture",
                "complex_sun",
                "extend",
                "samples_count",
            ],
        );
        Some((light, self.transform(emitter, "to_world")))
    }

    /// A direction, or place and time, whose defaults are those of Mitsuba: Tokyo, 10 July 2010, three in the afternoon.
    fn sun_position(&mut self, emitter: &'e Element, light: &mut Entity) {
        if Self::has(emitter, "sun_direction") {
            let [x, y, z] = self.triple(emitter, "sun_direction", [0.0, 0.0, 1.0]);
            *light = std::mem::take(light).with("sundirection", Value::Vectors3(vec![Vector3::new(x, y, z)]));
            return;
        }
        let [year, month, day] = [("year", 2010), ("month", 7), ("day", 10)]
            .map(|(name, default)| self.integer(emitter, name, default));
        let [hour, minute, second] = [("hour", 15.0), ("minute", 0.0), ("second", 0.0)]
            .map(|(name, default)| self.float(emitter, name, default));
        let date = format!("{year:04}-{month:02}-{day:02}");
        *light = std::mem::take(light).with("date", Value::Strings(vec![date]));
        let numbers = [
            ("time", hour + minute / 60.0 + second / 3600.0),
            ("latitude", self.float(emitter, "latitude", 35.6894)),
            ("longitude", self.float(emitter, "longitude", 139.6917)),
            ("timezone", self.float(emitter, "timezone", 9.0)),
        ];
        for (name, value) in numbers {
            *light = std::mem::take(light).with(name, Value::Floats(vec![value]));
        }
    }

    /// The name of a medium, which enters the document at its first use.
    pub(super) fn medium(&mut self, medium: &'e Element) -> String {
        let name = Self::name_of(medium);
        if self.document.media.iter().any(|known| known.name == name) {
            return name;
        }
        let mut made = entity(medium.plugin(), medium);
        match medium.plugin() {
            "homogeneous" | "heterogeneous" => {}
            _ => self.unknown_plugin(medium, &[], &["homogeneous", "heterogeneous"], ""),
        }
        self.coefficients(medium, &mut made);
        let world_from_medium = self.transform(medium, "to_world");
        self.accept(
            medium,
            &["method", "strategy", "step_size", "has_spectral_extinction", "sample_emitters", "grid"],
        );
        for phase in self.nested(medium, "phase") {
            if phase.plugin() == "hg"
                && let Some((g, span)) = self.number_opt(phase, "g")
            {
                made.parameters.push(parameter("g", g, span));
            }
        }
        for child in &medium.children {
            child.used.set(true);
        }
        self.document.media.push(MediumEntity { name: name.clone(), world_from_medium, entity: made });
        name
    }

    /// Absorption and scattering, which may be given by extinction and albedo.
    fn coefficients(&mut self, medium: &'e Element, made: &mut Entity) {
        self.pass_color(medium, "sigma_a", made, "sigma_a");
        self.pass_color(medium, "sigma_s", made, "sigma_s");
        self.pass_number(medium, "scale", made, "scale");
        let sigma_t = self.color_opt(medium, "sigma_t");
        let albedo = self.color_opt(medium, "albedo");
        if let (Some((Value::Rgb(sigma_t), span)), Some((Value::Rgb(albedo), _))) = (sigma_t, albedo) {
            let (t, a) = (sigma_t[0], albedo[0]);
            let sigma_s: [f32; 3] = std::array::from_fn(|c| t[c] * a[c]);
            let sigma_a: [f32; 3] = std::array::from_fn(|c| (t[c] - sigma_s[c]).max(0.0));
            made.parameters.push(parameter("sigma_a", Value::Rgb(vec![sigma_a]), span));
            made.parameters.push(parameter("sigma_s", Value::Rgb(vec![sigma_s]), span));
        }
    }
}

/// With x the other way: Mitsuba's cameras and projectors have +x to the left.
pub(super) fn mirrored(transform: &AnimatedTransform) -> AnimatedTransform {
    let Some(mirror) = Transform::scale(-1.0, 1.0, 1.0) else { return *transform };
    AnimatedTransform { start: transform.start * mirror, end: transform.end * mirror, ..*transform }
}
