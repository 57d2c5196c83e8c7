//! Textures from parameters.

use etendue_image::Encoding;
use etendue_math::{Transform, Vector3};
use etendue_spectrum::{ColorSpaceName, Spectrum};

use crate::diagnostics::Diagnostics;
use crate::document::{TextureEntity, TextureValue, Value};
use crate::parameters::{BuildContext, ParameterSpec, Parameters, SpectrumRole};

use super::noise::Octaves;
use super::{
    Bilerp, Channels, CheckMapping, Checkerboard, DirectionMix, Dots, Fbm, FloatTexture, FloatTextureNode,
    ImageFilter, ImageId, ImageOptions, ImageTexture, Mapping2, Mapping3, Marble, MeshAttributeTexture, Mix,
    Scale, SpectrumImageTexture, SpectrumTexture, SpectrumTextureNode, Textures, Uplift, Windy, WrapMode,
    Wrinkled,
};
use super::{
    bilerp, checkerboard, constant, dots, fractal, image_texture, marble, mesh_attribute, mix, scale,
};

/// A kind's own parameters followed by those of its mapping.
const fn mapped<const N: usize>(own: &[ParameterSpec]) -> [ParameterSpec; N] {
    let mapping = Mapping2::PARAMETERS;
    assert!(N == own.len() + mapping.len());
    let mut all = [mapping[0]; N];
    let mut i = 0;
    while i < N {
        all[i] = if i < own.len() { own[i] } else { mapping[i - own.len()] };
        i += 1;
    }
    all
}

const N_MAPPING: usize = Mapping2::PARAMETERS.len();
static BILERP: [ParameterSpec; bilerp::PARAMETERS.len() + N_MAPPING] = mapped(bilerp::PARAMETERS);
static CHECKERBOARD: [ParameterSpec; checkerboard::PARAMETERS.len() + N_MAPPING] =
    mapped(checkerboard::PARAMETERS);
static DOTS: [ParameterSpec; dots::PARAMETERS.len() + N_MAPPING] = mapped(dots::PARAMETERS);
static IMAGE: [ParameterSpec; image_texture::PARAMETERS.len() + N_MAPPING] =
    mapped(image_texture::PARAMETERS);

/// Kinds of textures that yield numbers, with their parameters.
pub static FLOAT_TEXTURES: &[(&str, &[ParameterSpec])] = &[
    ("constant", constant::PARAMETERS),
    ("scale", scale::PARAMETERS),
    ("mix", mix::PARAMETERS),
    ("directionmix", mix::DIRECTION_PARAMETERS),
    ("bilerp", &BILERP),
    ("checkerboard", &CHECKERBOARD),
    ("dots", &DOTS),
    ("imagemap", &IMAGE),
    ("fbm", fractal::PARAMETERS),
    ("wrinkled", fractal::PARAMETERS),
    ("windy", fractal::WINDY_PARAMETERS),
    ("meshattribute", mesh_attribute::PARAMETERS),
];

/// Kinds of textures that yield spectra, with their parameters.
pub static SPECTRUM_TEXTURES: &[(&str, &[ParameterSpec])] = &[
    ("constant", constant::PARAMETERS),
    ("scale", scale::PARAMETERS),
    ("mix", mix::PARAMETERS),
    ("directionmix", mix::DIRECTION_PARAMETERS),
    ("bilerp", &BILERP),
    ("checkerboard", &CHECKERBOARD),
    ("dots", &DOTS),
    ("imagemap", &IMAGE),
    ("marble", marble::PARAMETERS),
    ("meshattribute", mesh_attribute::PARAMETERS),
];

/// Levels of textures inside of each other. They are evaluated by recursion, so that there must be a limit.
const MAX_DEPTH: u32 = 100;

/// Levels of textures in this one. Too many are an error where the limit is passed, not again for those above.
fn check_depth(entity: &TextureEntity, context: &mut BuildContext<'_>) -> Result<(), ()> {
    let inner = entity.entity.parameters.iter().filter_map(|parameter| match &parameter.value {
        Value::Texture(name) => context.texture_depths.get(name).copied(),
        _ => None,
    });
    let depth = inner.max().unwrap_or(0) + 1;
    context.texture_depths.insert(entity.name.clone(), depth.min(MAX_DEPTH + 1));
    if depth == MAX_DEPTH + 1 {
        let message = format!("textures are nested in each other more than {MAX_DEPTH} deep");
        context.diagnostics.error(entity.entity.span, message);
    }
    if depth > MAX_DEPTH { Err(()) } else { Ok(()) }
}

impl Textures {
    /// Builds the texture of an entity and enters it under its name into the context. A texture that yields spectra is
    /// built for each role, since a colour becomes another spectrum as a reflectance than as light.
    pub fn define(&mut self, entity: &TextureEntity, context: &mut BuildContext<'_>) {
        let (name, placed) = (&entity.name, &entity.world_from_texture);
        if check_depth(entity, context).is_err() {
            context.float_textures.insert(name.clone(), FloatTexture::Constant(1.0));
            for role in SpectrumRole::ALL {
                let grey = SpectrumTexture::Constant(Spectrum::Constant(0.5));
                context.spectrum_textures.insert((name.clone(), role), grey);
            }
            return;
        }
        if entity.value == TextureValue::Float {
            let mut parameters = Parameters::new(&entity.entity, context);
            let texture = self.build_float(&mut parameters, placed);
            parameters.finish();
            context.float_textures.insert(name.clone(), texture);
            return;
        }
        // Every role meets the same problems: those of the first are kept. It is the one without limits.
        let mut before = std::mem::take(&mut context.diagnostics);
        for role in [SpectrumRole::Unbounded, SpectrumRole::Albedo, SpectrumRole::Illuminant] {
            context.diagnostics = Diagnostics::default();
            let mut parameters = Parameters::new(&entity.entity, context);
            let texture = self.build_spectrum(&mut parameters, placed, role);
            parameters.finish();
            context.spectrum_textures.insert((name.clone(), role), texture);
            let problems = std::mem::take(&mut context.diagnostics);
            if role == SpectrumRole::Unbounded {
                before.append(problems);
            }
        }
        context.diagnostics = before;
    }

    /// Builds a texture that yields numbers, of the kind that the entity's type names; problems are reported.
    pub fn build_float(
        &mut self,
        p: &mut Parameters<'_, '_>,
        world_from_texture: &Transform,
    ) -> FloatTexture {
        let node = match p.entity().type_name.as_str() {
            "constant" => return FloatTexture::Constant(p.float("value", 1.0)),
            "scale" => {
                let node =
                    Scale { texture: p.float_texture("tex", 1.0), scale: p.float_texture("scale", 1.0) };
                if let (Some(a), Some(b)) = (node.texture.constant(), node.scale.constant()) {
                    return FloatTexture::Constant(a * b);
                }
                FloatTextureNode::Scale(node)
            }
            "mix" => FloatTextureNode::Mix(Mix {
                a: p.float_texture("tex1", 0.0),
                b: p.float_texture("tex2", 1.0),
                amount: p.float_texture("amount", 0.5),
            }),
            "directionmix" => FloatTextureNode::DirectionMix(DirectionMix {
                a: p.float_texture("tex1", 0.0),
                b: p.float_texture("tex2", 1.0),
                direction: read_direction(p, world_from_texture),
            }),
            "bilerp" => FloatTextureNode::Bilerp(Bilerp {
                mapping: Mapping2::from_parameters(p, world_from_texture),
                corners: [p.float("v00", 0.0), p.float("v01", 1.0), p.float("v10", 0.0), p.float("v11", 1.0)],
            }),
            "checkerboard" => FloatTextureNode::Checkerboard(Checkerboard {
                mapping: read_check_mapping(p, world_from_texture),
                a: p.float_texture("tex1", 1.0),
                b: p.float_texture("tex2", 0.0),
            }),
            "dots" => FloatTextureNode::Dots(Dots {
                mapping: Mapping2::from_parameters(p, world_from_texture),
                inside: p.float_texture("inside", 1.0),
                outside: p.float_texture("outside", 0.0),
            }),
            "imagemap" => match self.read_image(p, world_from_texture) {
                Some(texture) if self.image(texture.image).lacks_alpha() => {
                    return FloatTexture::Constant(texture.number(1.0));
                }
                Some(texture) => FloatTextureNode::Image(texture),
                None => return FloatTexture::Constant(1.0),
            },
            "fbm" => FloatTextureNode::Fbm(Fbm {
                mapping: Mapping3::new(world_from_texture),
                octaves: read_octaves(p),
            }),
            "wrinkled" => FloatTextureNode::Wrinkled(Wrinkled {
                mapping: Mapping3::new(world_from_texture),
                octaves: read_octaves(p),
            }),
            "windy" => FloatTextureNode::Windy(Windy { mapping: Mapping3::new(world_from_texture) }),
            "meshattribute" => FloatTextureNode::MeshAttribute(self.read_mesh_attribute(p)),
            _ => {
                report_unknown(p, "float", FLOAT_TEXTURES);
                return FloatTexture::Constant(0.5);
            }
        };
        self.add_float(node)
    }

    /// Builds a texture that yields spectra for `role`, of the kind that the entity's type names; problems are reported.
    pub fn build_spectrum(
        &mut self,
        p: &mut Parameters<'_, '_>,
        world_from_texture: &Transform,
        role: SpectrumRole,
    ) -> SpectrumTexture {
        const BLACK: Spectrum = Spectrum::Constant(0.0);
        const WHITE: Spectrum = Spectrum::Constant(1.0);
        let node = match p.entity().type_name.as_str() {
            "constant" => return SpectrumTexture::Constant(p.spectrum("value", role).unwrap_or(WHITE)),
            "scale" => SpectrumTextureNode::Scale(Scale {
                texture: p.spectrum_texture("tex", WHITE, role),
                scale: p.float_texture("scale", 1.0),
            }),
            "mix" => SpectrumTextureNode::Mix(Mix {
                a: p.spectrum_texture("tex1", BLACK, role),
                b: p.spectrum_texture("tex2", WHITE, role),
                amount: p.float_texture("amount", 0.5),
            }),
            "directionmix" => SpectrumTextureNode::DirectionMix(DirectionMix {
                a: p.spectrum_texture("tex1", BLACK, role),
                b: p.spectrum_texture("tex2", WHITE, role),
                direction: read_direction(p, world_from_texture),
            }),
            "bilerp" => SpectrumTextureNode::Bilerp(Bilerp {
                mapping: Mapping2::from_parameters(p, world_from_texture),
                corners: [("v00", BLACK), ("v01", WHITE), ("v10", BLACK), ("v11", WHITE)]
                    .map(|(name, default)| p.spectrum(name, role).unwrap_or(default)),
            }),
            "checkerboard" => SpectrumTextureNode::Checkerboard(Checkerboard {
                mapping: read_check_mapping(p, world_from_texture),
                a: p.spectrum_texture("tex1", WHITE, role),
                b: p.spectrum_texture("tex2", BLACK, role),
            }),
            "dots" => SpectrumTextureNode::Dots(Dots {
                mapping: Mapping2::from_parameters(p, world_from_texture),
                inside: p.spectrum_texture("inside", WHITE, role),
                outside: p.spectrum_texture("outside", BLACK, role),
            }),
            "imagemap" => {
                let Some(texture) = self.read_image(p, world_from_texture) else {
                    return SpectrumTexture::Constant(Spectrum::Constant(0.5));
                };
                let uplift = Uplift::new(role, self.image(texture.image).texels(), &mut p.context.spectra);
                SpectrumTextureNode::Image(SpectrumImageTexture { texture, uplift })
            }
            "marble" => read_marble(p, world_from_texture),
            "meshattribute" => {
                let uplift = Uplift::in_color_space(role, ColorSpaceName::Srgb, &mut p.context.spectra);
                SpectrumTextureNode::MeshAttribute(self.read_mesh_attribute(p), uplift)
            }
            _ => {
                report_unknown(p, "spectrum", SPECTRUM_TEXTURES);
                return SpectrumTexture::Constant(Spectrum::Constant(0.5));
            }
        };
        self.add_spectrum(node)
    }

    fn read_mesh_attribute(&mut self, p: &mut Parameters<'_, '_>) -> MeshAttributeTexture {
        let attribute = self.mesh_attributes.name(&p.string("name", "vertex_color"));
        MeshAttributeTexture { attribute, scale: p.float("scale", 1.0) }
    }

    fn read_image(
        &mut self,
        p: &mut Parameters<'_, '_>,
        world_from_texture: &Transform,
    ) -> Option<ImageTexture> {
        let mapping = Mapping2::from_parameters(p, world_from_texture);
        let options = read_image_options(p);
        let (scale, invert) = (p.float("scale", 1.0), p.bool("invert", false));
        let tint = p.rgb("tint").unwrap_or([1.0; 3]);
        let cutoff = p.float_opt("cutoff");
        let Some(name) = p.string_opt("filename").filter(|name| !name.is_empty()) else {
            p.missing("filename", "an image texture needs a \"filename\"");
            return None;
        };
        let Some(texels) = p.context.assets.images.get(&name) else {
            if !p.context.assets.failed.contains(&name) {
                let span = p.span_of("filename");
                p.diagnostics().error(span, format!("the picture \"{name}\" was not loaded"));
            }
            return None;
        };
        let image: ImageId = self.add_image(&name, texels, options);
        Some(ImageTexture { mapping, image, scale: tint.map(|c| scale * c), invert, cutoff })
    }
}

fn read_image_options(p: &mut Parameters<'_, '_>) -> ImageOptions {
    let filters = [
        ("point", ImageFilter::Point),
        ("bilinear", ImageFilter::Bilinear),
        ("trilinear", ImageFilter::Trilinear),
        ("EWA", ImageFilter::Ewa),
        ("ewa", ImageFilter::Ewa),
    ];
    let wraps = [
        ("repeat", WrapMode::Repeat),
        ("black", WrapMode::Black),
        ("clamp", WrapMode::Clamp),
        ("mirror", WrapMode::Mirror),
        ("octahedralsphere", WrapMode::OctahedralSphere),
    ];
    let channels = [
        ("", Channels::Colors),
        ("r", Channels::Color(0)),
        ("g", Channels::Color(1)),
        ("b", Channels::Color(2)),
        ("a", Channels::Alpha),
    ];
    let wrap = p.choice("wrap", "repeat", &wraps);
    let wrap_v = if p.has("wrapv") { p.choice("wrapv", "repeat", &wraps) } else { wrap };
    let mut options = ImageOptions {
        filter: p.choice("filter", "bilinear", &filters),
        wrap: [wrap, wrap_v],
        channels: p.choice("channel", "", &channels),
        max_anisotropy: p.float("maxanisotropy", 8.0).max(1.0),
        encoding: Encoding::Srgb,
    };
    let encoding = p.string("encoding", "sRGB");
    match Encoding::parse(&encoding) {
        Some(encoding) => options.encoding = encoding,
        None => {
            let span = p.span_of("encoding");
            let error = p.diagnostics().error(span, format!("unknown encoding \"{encoding}\""));
            error.with_help("known are: sRGB, linear, gamma followed by the exponent");
        }
    }
    options
}

fn read_direction(p: &mut Parameters<'_, '_>, world_from_texture: &Transform) -> Vector3 {
    let direction = p.vector3("dir", Vector3::new(0.0, 1.0, 0.0));
    world_from_texture.vector(direction).try_normalized().unwrap_or_else(|| {
        let span = p.span_of("dir");
        p.diagnostics().error(span, "\"dir\" must not be the zero vector");
        Vector3::new(0.0, 1.0, 0.0)
    })
}

fn read_check_mapping(p: &mut Parameters<'_, '_>, world_from_texture: &Transform) -> CheckMapping {
    match p.integer("dimension", 2) {
        2 => CheckMapping::Plane(Mapping2::from_parameters(p, world_from_texture)),
        3 => CheckMapping::Space(Mapping3::new(world_from_texture)),
        dimension => {
            let span = p.span_of("dimension");
            let message = format!("a checkerboard has 2 or 3 dimensions, not {dimension}");
            p.diagnostics().error(span, message);
            CheckMapping::Plane(Mapping2::default())
        }
    }
}

fn read_marble(p: &mut Parameters<'_, '_>, world_from_texture: &Transform) -> SpectrumTextureNode {
    let node = Marble {
        mapping: Mapping3::new(world_from_texture),
        octaves: read_octaves(p),
        scale: p.float("scale", 1.0),
        variation: p.float("variation", 0.2),
    };
    // Stone is a reflectance, whatever it is used for.
    let spectra = &mut p.context.spectra;
    let uplift = Uplift::in_color_space(SpectrumRole::Albedo, ColorSpaceName::Srgb, spectra);
    SpectrumTextureNode::Marble(node, uplift)
}

fn read_octaves(p: &mut Parameters<'_, '_>) -> Octaves {
    let count = p.integer("octaves", 8);
    if !(0..=32).contains(&count) {
        let span = p.span_of("octaves");
        p.diagnostics().error(span, format!("\"octaves\" must be between 0 and 32, not {count}"));
    }
    Octaves { omega: p.float("roughness", 0.5), count: count.clamp(0, 32) as u32 }
}

fn report_unknown(p: &mut Parameters<'_, '_>, value: &str, known: &[(&str, &[ParameterSpec])]) {
    let (name, span) = (p.entity().type_name.as_str(), p.span());
    p.accept_all();
    if name == "ptex" {
        p.diagnostics()
            .warning(span, "the texture \"ptex\" is not available yet; the constant 0.5 stands in for it");
        return;
    }
    let known = known.iter().map(|(name, _)| *name);
    p.diagnostics().unknown_name(span, &format!("{value} texture"), name, known);
}
