//! Materials: metallic-roughness with its extensions as `principled`, emission as an area light, alpha as that of shapes.

use etendue_math::Transform;
use etendue_scene::document::{
    Entity, MaterialEntity, MaterialReference, TextureEntity, TextureValue, Value,
};

use super::texture::Use;
use super::{Reader, located};
use crate::json::Json;

/// The attribute of meshes that holds the colours of vertices times the base colour.
pub(super) const VERTEX_COLOR: &str = "vertex_color";

/// What shapes of a material need.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    pub(super) material: MaterialReference,
    pub(super) area_light: Option<usize>,
    /// Value of the parameter `alpha`.
    pub(super) alpha: Option<Value>,
    /// Set of texture coordinates that its textures use.
    pub(super) texcoord: usize,
    /// True if textures or directions lie on it.
    pub(super) needs_uv: bool,
    /// True if tangents of vertices matter.
    pub(super) needs_tangents: bool,
    /// The factor of the colours of vertices, if they count.
    pub(super) vertex_color: Option<[f32; 3]>,
}

/// A material in the making: its JSON, its place in the file and the entity with the parameters so far.
struct Draft<'a> {
    index: usize,
    json: &'a Json,
    entity: Entity,
    /// Sets of texture coordinates in the order met, the first being the one taken.
    texcoords: Vec<usize>,
    /// True if vertices have colours.
    is_tinted: bool,
    /// Their factor, once they are the base colour.
    vertex_color: Option<[f32; 3]>,
}

fn float(value: f32) -> Value {
    Value::Floats(vec![value])
}

fn rgb(value: [f32; 3]) -> Value {
    Value::Rgb(vec![value])
}

impl<'a> Draft<'a> {
    fn new(index: usize, json: &'a Json, is_tinted: bool) -> Self {
        let entity = Entity::new("principled");
        Self { index, json, entity, texcoords: Vec::new(), is_tinted, vertex_color: None }
    }

    /// The name of a texture of this material; one with colours of vertices is another material.
    fn texture_name(&self, parameter: &str) -> String {
        let index = self.index;
        let colors = if self.is_tinted { " with colors" } else { "" };
        if index == usize::MAX {
            return format!("default material{colors}/{parameter}");
        }
        format!("materials/{index}{colors}/{parameter}")
    }

    fn set(&mut self, name: &str, value: Value) {
        self.entity = std::mem::take(&mut self.entity).with(name, value);
    }

    fn is_named(&self, name: &str) -> bool {
        self.entity.parameters.iter().any(|p| p.name == name)
    }
}

impl<'a> Reader<'a> {
    /// What glTF draws without a material: white metal that is rough, times the colours of vertices.
    pub(super) fn default_surface(&mut self, is_tinted: bool) -> Surface {
        if let Some(known) = &self.default_surface[usize::from(is_tinted)] {
            return known.clone();
        }
        let mut draft = Draft::new(usize::MAX, self.file.root, is_tinted);
        self.set_base_color(&mut draft, None, [1.0; 3]);
        draft.set("metallic", float(1.0));
        draft.set("roughness", float(1.0));
        let surface = self.finished(&mut draft, None, None);
        self.default_surface[usize::from(is_tinted)] = Some(surface.clone());
        surface
    }

    fn add_material(&mut self, entity: Entity) -> MaterialReference {
        self.document.materials.push(MaterialEntity { name: None, entity });
        MaterialReference::Index(self.document.materials.len() - 1)
    }

    /// The material of that index, made when first asked for.
    pub(super) fn surface(&mut self, index: usize, json: &'a Json, is_tinted: bool) -> Surface {
        if let Some(known) = &self.surfaces[index][usize::from(is_tinted)] {
            return known.clone();
        }
        let mut draft = Draft::new(index, json, is_tinted);
        let surface = if self.file.extension(json, "KHR_materials_unlit").is_some() {
            self.unlit(&mut draft)
        } else {
            self.lit(&mut draft)
        };
        self.surfaces[index][usize::from(is_tinted)] = Some(surface.clone());
        surface
    }

    fn lit(&mut self, draft: &mut Draft<'a>) -> Surface {
        let json = draft.json;
        let base = match self.file.extension(json, "KHR_materials_pbrSpecularGlossiness") {
            Some(old) => self.specular_glossiness(draft, old),
            None => self.metallic_roughness(draft),
        };
        self.normal_map(draft, json, "normalTexture", ["normaltexture", "normalscale"]);
        self.layers(draft);
        self.glass(draft);
        self.reflection(draft);
        if draft.json.get("extensions").is_some_and(|e| e.get("KHR_materials_diffuse_transmission").is_some())
        {
            self.file
                .warning(json, "KHR_materials_diffuse_transmission is not available: the surface is opaque");
        }
        let alpha = self.alpha(draft, base);
        let emission = self.file.floats(json, "emissiveFactor").unwrap_or([0.0; 3]);
        let strength = self.file.extension(json, "KHR_materials_emissive_strength");
        let strength = strength.map_or(1.0, |e| self.file.float(e, "emissiveStrength", 1.0));
        let texture = self.file.object(json, "emissiveTexture");
        let area_light = self.emission(draft, emission, strength, texture);
        self.finished(draft, alpha, area_light)
    }

    /// A surface that shows its colour whatever the light: a black one that emits it, in cd/m².
    fn unlit(&mut self, draft: &mut Draft<'a>) -> Surface {
        draft.entity = Entity::new("diffuse").with("reflectance", rgb([0.0; 3]));
        if draft.is_tinted {
            let message = "colours of vertices (COLOR_0) do not tint KHR_materials_unlit; they are left out";
            self.file.warning(draft.json, message);
        }
        let none = self.file.object(draft.json, "pbrMetallicRoughness");
        let factor = none.and_then(|pbr| self.file.floats(pbr, "baseColorFactor")).unwrap_or([1.0; 4]);
        let texture = none.and_then(|pbr| self.file.object(pbr, "baseColorTexture"));
        let alpha = self.alpha(draft, (factor[3], texture));
        let area_light = self.emission(draft, [factor[0], factor[1], factor[2]], 1.0, texture);
        self.finished(draft, alpha, area_light)
    }

    fn finished(
        &mut self,
        draft: &mut Draft<'a>,
        alpha: Option<Value>,
        area_light: Option<usize>,
    ) -> Surface {
        let texcoord = draft.texcoords.first().copied().unwrap_or(0);
        if draft.texcoords.iter().any(|other| *other != texcoord) {
            let message =
                format!("textures use several sets of coordinates; TEXCOORD_{texcoord} serves for all");
            self.file.warning(draft.json, message);
        }
        let needs_tangents = draft.is_named("normaltexture")
            || draft.is_named("clearcoatnormaltexture")
            || draft.is_named("anisotropy");
        let entity = located(std::mem::take(&mut draft.entity), draft.json);
        Surface {
            material: self.add_material(entity),
            area_light,
            alpha,
            texcoord,
            needs_uv: !draft.texcoords.is_empty(),
            needs_tangents,
            vertex_color: draft.vertex_color,
        }
    }

    /// Sets a parameter to a texture, if `object` has one under that name.
    fn set_texture(
        &mut self,
        draft: &mut Draft<'a>,
        object: &'a Json,
        texture: &str,
        parameter: &str,
        how: Use,
    ) -> bool {
        let Some(info) = self.file.object(object, texture) else { return false };
        draft.texcoords.push(self.texcoord(info));
        let name = draft.texture_name(parameter);
        let Some(name) = self.texture(name, info, how) else { return false };
        draft.set(parameter, Value::Texture(name));
        true
    }

    /// A number that a channel of a texture multiplies, if there is one.
    fn set_number(
        &mut self,
        draft: &mut Draft<'a>,
        object: &'a Json,
        [factor, texture, channel]: [&'static str; 3],
        default: f32,
        parameter: &str,
    ) {
        let factor = self.file.float(object, factor, default);
        let is_textured = factor != 0.0
            && !texture.is_empty()
            && self.set_texture(draft, object, texture, parameter, Use::Channel(channel, factor));
        if !is_textured {
            draft.set(parameter, float(factor));
        }
    }

    /// A colour that a texture multiplies, if there is one.
    fn set_color(
        &mut self,
        draft: &mut Draft<'a>,
        object: &'a Json,
        texture: &str,
        factor: [f32; 3],
        parameter: &str,
    ) {
        let is_textured =
            factor != [0.0; 3] && self.set_texture(draft, object, texture, parameter, Use::Color(factor));
        if !is_textured {
            draft.set(parameter, rgb(factor));
        }
    }

    /// The base colour: a factor times a texture, if there is one, or times the colours of vertices.
    fn set_base_color(&mut self, draft: &mut Draft<'a>, texture: Option<(&'a Json, &str)>, factor: [f32; 3]) {
        let texture = texture.filter(|(object, name)| object.get(name).is_some());
        if let Some((object, name)) = texture {
            if draft.is_tinted {
                let message = "colours of vertices times a texture are not available; the texture is taken";
                self.file.warning(draft.json, message);
            }
            self.set_color(draft, object, name, factor, "basecolor");
        } else if draft.is_tinted {
            draft.vertex_color = Some(factor);
            let name = draft.texture_name("basecolor");
            let entity =
                Entity::new("meshattribute").with("name", Value::Strings(vec![VERTEX_COLOR.to_owned()]));
            self.add_texture(&name, TextureValue::Spectrum, located(entity, draft.json));
            draft.set("basecolor", Value::Texture(name));
        } else {
            draft.set("basecolor", rgb(factor));
        }
    }

    /// Gives the factor of alpha and its texture.
    fn metallic_roughness(&mut self, draft: &mut Draft<'a>) -> (f32, Option<&'a Json>) {
        let Some(pbr) = self.file.object(draft.json, "pbrMetallicRoughness") else {
            self.set_base_color(draft, None, [1.0; 3]);
            draft.set("metallic", float(1.0));
            draft.set("roughness", float(1.0));
            return (1.0, None);
        };
        let [r, g, b, a] = self.file.floats(pbr, "baseColorFactor").unwrap_or([1.0; 4]);
        self.set_base_color(draft, Some((pbr, "baseColorTexture")), [r, g, b]);
        let texture = "metallicRoughnessTexture";
        self.set_number(draft, pbr, ["metallicFactor", texture, "b"], 1.0, "metallic");
        self.set_number(draft, pbr, ["roughnessFactor", texture, "g"], 1.0, "roughness");
        (a, self.file.object(pbr, "baseColorTexture"))
    }

    /// The older model: diffuse and specular colours. The specular one is F0, which `specularcolor` multiplies.
    fn specular_glossiness(&mut self, draft: &mut Draft<'a>, old: &'a Json) -> (f32, Option<&'a Json>) {
        /// F0 of index 1.5.
        const F0: f32 = 0.04;
        let [r, g, b, a] = self.file.floats(old, "diffuseFactor").unwrap_or([1.0; 4]);
        self.set_base_color(draft, Some((old, "diffuseTexture")), [r, g, b]);
        draft.set("metallic", float(0.0));
        let specular = self.file.floats(old, "specularFactor").unwrap_or([1.0; 3]);
        let texture = "specularGlossinessTexture";
        self.set_color(draft, old, texture, specular.map(|s| s / F0), "specularcolor");
        let glossiness = self.file.float(old, "glossinessFactor", 1.0);
        if !self.set_texture(draft, old, texture, "roughness", Use::Inverted("a", glossiness)) {
            draft.set("roughness", float(1.0 - glossiness));
        }
        (a, self.file.object(old, "diffuseTexture"))
    }

    fn normal_map(
        &mut self,
        draft: &mut Draft<'a>,
        object: &'a Json,
        texture: &str,
        [parameter, strength]: [&str; 2],
    ) {
        let Some(info) = self.file.object(object, texture) else { return };
        let scale = self.file.float(info, "scale", 1.0);
        if self.set_texture(draft, object, texture, parameter, Use::Vectors) && scale != 1.0 {
            draft.set(strength, float(scale));
        }
    }

    /// Coat, sheen and film.
    fn layers(&mut self, draft: &mut Draft<'a>) {
        if let Some(coat) = self.file.extension(draft.json, "KHR_materials_clearcoat") {
            self.set_number(draft, coat, ["clearcoatFactor", "clearcoatTexture", "r"], 0.0, "clearcoat");
            let names = ["clearcoatRoughnessFactor", "clearcoatRoughnessTexture", "g"];
            self.set_number(draft, coat, names, 0.0, "clearcoatroughness");
            let parameters = ["clearcoatnormaltexture", "clearcoatnormalscale"];
            self.normal_map(draft, coat, "clearcoatNormalTexture", parameters);
        }
        if let Some(sheen) = self.file.extension(draft.json, "KHR_materials_sheen") {
            let color = self.file.floats(sheen, "sheenColorFactor").unwrap_or([0.0; 3]);
            self.set_color(draft, sheen, "sheenColorTexture", color, "sheencolor");
            let names = ["sheenRoughnessFactor", "sheenRoughnessTexture", "a"];
            self.set_number(draft, sheen, names, 0.0, "sheenroughness");
        }
        if let Some(film) = self.file.extension(draft.json, "KHR_materials_iridescence") {
            let names = ["iridescenceFactor", "iridescenceTexture", "r"];
            self.set_number(draft, film, names, 0.0, "iridescence");
            draft.set("iridescenceior", float(self.file.float(film, "iridescenceIor", 1.3)));
            self.film_thickness(draft, film);
        }
    }

    /// The texture goes from the least to the greatest thickness; without one it is the greatest.
    fn film_thickness(&mut self, draft: &mut Draft<'a>, film: &'a Json) {
        let least = self.file.float(film, "iridescenceThicknessMinimum", 100.0);
        let most = self.file.float(film, "iridescenceThicknessMaximum", 400.0);
        let parameter = "iridescencethickness";
        let share = Use::Channel("g", 1.0);
        if !self.set_texture(draft, film, "iridescenceThicknessTexture", parameter, share) {
            draft.set(parameter, float(most));
            return;
        }
        let Some(Value::Texture(amount)) = draft.entity.parameters.pop().map(|p| p.value) else { return };
        let entity = Entity::new("mix").with("tex1", float(least)).with("tex2", float(most));
        let entity = entity.with("amount", Value::Texture(amount));
        let name = draft.texture_name(&format!("{parameter} mixed"));
        self.add_texture(&name, TextureValue::Float, located(entity, film));
        draft.set(parameter, Value::Texture(name));
    }

    fn add_texture(&mut self, name: &str, value: TextureValue, entity: Entity) {
        let name = name.to_owned();
        let world_from_texture = Transform::IDENTITY;
        self.document.textures.push(TextureEntity { name, value, world_from_texture, entity });
    }

    /// Transmission, volume and dispersion.
    fn glass(&mut self, draft: &mut Draft<'a>) {
        let Some(glass) = self.file.extension(draft.json, "KHR_materials_transmission") else { return };
        self.set_number(
            draft,
            glass,
            ["transmissionFactor", "transmissionTexture", "r"],
            0.0,
            "transmission",
        );
        let Some(volume) = self.file.extension(draft.json, "KHR_materials_volume") else { return };
        let thickness = self.file.float(volume, "thicknessFactor", 0.0);
        if thickness <= 0.0 {
            return;
        }
        draft.set("thickness", float(thickness));
        let color = self.file.floats(volume, "attenuationColor").unwrap_or([1.0; 3]);
        if let Some(distance) = self.file.float_opt(volume, "attenuationDistance").filter(|d| *d > 0.0)
            && color != [1.0; 3]
        {
            draft.set("attenuationcolor", rgb(color));
            draft.set("attenuationdistance", float(distance));
        }
        if let Some(e) = self.file.extension(draft.json, "KHR_materials_dispersion") {
            let dispersion = self.file.float(e, "dispersion", 0.0);
            if dispersion > 0.0 {
                draft.set("dispersion", float(dispersion));
            }
        }
    }

    /// Index, specular and anisotropy.
    fn reflection(&mut self, draft: &mut Draft<'a>) {
        if let Some(index) = self.file.extension(draft.json, "KHR_materials_ior") {
            draft.set("ior", float(self.file.float(index, "ior", 1.5)));
        }
        if let Some(specular) = self.file.extension(draft.json, "KHR_materials_specular") {
            self.set_number(draft, specular, ["specularFactor", "specularTexture", "a"], 1.0, "specular");
            let color = self.file.floats(specular, "specularColorFactor").unwrap_or([1.0; 3]);
            self.set_color(draft, specular, "specularColorTexture", color, "specularcolor");
        }
        if let Some(brushed) = self.file.extension(draft.json, "KHR_materials_anisotropy") {
            let names = ["anisotropyStrength", "anisotropyTexture", "b"];
            self.set_number(draft, brushed, names, 0.0, "anisotropy");
            let rotation = self.file.float(brushed, "anisotropyRotation", 0.0).to_degrees();
            draft.set("anisotropyrotation", float(rotation));
            if let Some(texture) = self.file.object(brushed, "anisotropyTexture") {
                let message = "directions of \"anisotropyTexture\" are not available; its strength is taken";
                self.file.warning(texture, message);
            }
        }
    }

    /// The parameter `alpha` of shapes.
    fn alpha(&mut self, draft: &mut Draft<'a>, (factor, texture): (f32, Option<&'a Json>)) -> Option<Value> {
        let cutoff = match self.file.string(draft.json, "alphaMode").unwrap_or("OPAQUE") {
            "OPAQUE" => return None,
            "BLEND" => None,
            "MASK" => Some(self.file.float(draft.json, "alphaCutoff", 0.5)),
            other => {
                let message = format!("\"{other}\" is no mode of alpha: there are OPAQUE, MASK and BLEND");
                self.file.warning(draft.json, message);
                return None;
            }
        };
        let how = cutoff.map_or(Use::Channel("a", factor), |cutoff| Use::Cut("a", factor, cutoff));
        if let Some(info) = texture {
            draft.texcoords.push(self.texcoord(info));
            let name = draft.texture_name("alpha");
            if let Some(name) = self.texture(name, info, how) {
                return Some(Value::Texture(name));
            }
        }
        let alpha = cutoff.map_or(factor, |cutoff| f32::from(u8::from(factor >= cutoff)));
        (alpha != 1.0).then(|| float(alpha))
    }

    /// The area light of a material that emits, by its index in the document.
    fn emission(
        &mut self,
        draft: &mut Draft<'a>,
        factor: [f32; 3],
        strength: f32,
        texture: Option<&'a Json>,
    ) -> Option<usize> {
        if factor.iter().all(|f| *f <= 0.0) || strength <= 0.0 {
            return None;
        }
        let picture = texture.and_then(|info| self.picture(info));
        let mut entity = Entity::new("diffuse");
        match (texture, picture) {
            (Some(info), Some(picture)) => {
                draft.texcoords.push(self.texcoord(info));
                if self.is_placed(info) {
                    let message =
                        "KHR_texture_transform of what emits is not available; the picture stays in place";
                    self.file.warning(info, message);
                }
                let [r, g, b] = factor;
                if r != g || g != b {
                    let message = "a colour times a picture that emits is not available; its mean is taken";
                    self.file.warning(draft.json, message);
                }
                entity = entity
                    .with("filename", Value::Strings(vec![picture]))
                    .with("scale", float(strength * (r + g + b) / 3.0));
            }
            _ => entity = entity.with("L", rgb(factor)).with("scale", float(strength)),
        }
        if self.file.bool(draft.json, "doubleSided") {
            entity = entity.with("twosided", Value::Bools(vec![true]));
        }
        self.document.area_lights.push(located(entity, draft.json));
        Some(self.document.area_lights.len() - 1)
    }
}
