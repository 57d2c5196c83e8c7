//! Lights from the entities of a document.

use std::f32::consts::PI;
use std::sync::Arc;

use etendue_image::{DecodeTable, Encoding, Texels};
use etendue_math::{Point2, Transform, Vector3, warp};
use etendue_spectrum::{ColorSpace, ColorSpaceName, Spectrum, SpectrumTables, TableId, spectrum_to_xyz};

use super::emission::{LightPower, LightUnits, emitted, unit_factor};
use super::image::weighted_mean;
use super::{
    AreaEmission, AreaEmissionId, DistantLight, GoniometricLight, GoniometricLightId, IesLight, IesLightId,
    InfiniteConstantLight, InfiniteImageLight, InfiniteImageLightId, InfinitePortalLight,
    InfinitePortalLightId, Light, LightTables, Photometry, PointLight, ProjectionLight, ProjectionLightId,
    SkyLightId, SpotLight, sky::SkySettings,
};
use crate::document::{Entity, LightEntity};
use crate::parameters::{BuildContext, ParameterSpec, Parameters, SpectrumRole};
use crate::texture::FloatTexture;

pub(super) use crate::parameters::spec;

pub(super) const SCALE: ParameterSpec = spec("scale", "float", "1", "", "factor");
pub(super) const POWER: ParameterSpec =
    spec("power", "float", "", "lm", "total flux; replaces the size of the emission");
pub(super) const ILLUMINANCE: ParameterSpec = spec(
    "illuminance",
    "float",
    "",
    "lx",
    "illuminance of a plane that faces the light; replaces the size of L",
);

/// The kinds of light that a scene file can name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightKind {
    /// [`PointLight`].
    Point,
    /// [`SpotLight`].
    Spot,
    /// [`DistantLight`].
    Distant,
    /// [`GoniometricLight`].
    Goniometric,
    /// [`IesLight`].
    Ies,
    /// [`ProjectionLight`].
    Projection,
    /// [`InfiniteConstantLight`], [`InfiniteImageLight`] or [`InfinitePortalLight`].
    Infinite,
    /// [`SkyLight`](super::SkyLight).
    Sky,
    /// [`SunLight`](super::SunLight).
    Sun,
    /// Both.
    SunSky,
    /// [`AreaEmission`], of `AreaLightSource`.
    Diffuse,
}

impl LightKind {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::Point,
        Self::Spot,
        Self::Distant,
        Self::Goniometric,
        Self::Ies,
        Self::Projection,
        Self::Infinite,
        Self::Sky,
        Self::Sun,
        Self::SunSky,
        Self::Diffuse,
    ];

    /// Name in scene files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Spot => "spot",
            Self::Distant => "distant",
            Self::Goniometric => "goniometric",
            Self::Ies => "ies",
            Self::Projection => "projection",
            Self::Infinite => "infinite",
            Self::Sky => "sky",
            Self::Sun => "sun",
            Self::SunSky => "sunsky",
            Self::Diffuse => "diffuse",
        }
    }

    /// What it is, in one line.
    #[must_use]
    pub const fn doc(self) -> &'static str {
        match self {
            Self::Point => "a point that emits equally in all directions",
            Self::Spot => "a point that emits into a cone with a soft edge",
            Self::Distant => "parallel light, as from the sun",
            Self::Goniometric => "a point with a picture of intensity over the sphere",
            Self::Ies => "a luminaire with intensity measured by its maker (IES LM-63)",
            Self::Projection => "a point that projects a picture",
            Self::Infinite => "surroundings: constant, a picture, or seen through a portal",
            Self::Sky => "a clear sky by haze and the place of the sun, without the sun's disc",
            Self::Sun => "the sun's disc as seen through the air",
            Self::SunSky => "sky and sun together",
            Self::Diffuse => {
                "a surface with radiance in all directions or around its normal (AreaLightSource)"
            }
        }
    }

    /// Its parameters.
    #[must_use]
    pub const fn parameters(self) -> &'static [ParameterSpec] {
        match self {
            Self::Point => PointLight::PARAMETERS,
            Self::Spot => SpotLight::PARAMETERS,
            Self::Distant => DistantLight::PARAMETERS,
            Self::Goniometric => GoniometricLight::PARAMETERS,
            Self::Ies => IesLight::PARAMETERS,
            Self::Projection => ProjectionLight::PARAMETERS,
            Self::Infinite => InfiniteConstantLight::PARAMETERS,
            Self::Sky | Self::Sun | Self::SunSky => SkySettings::PARAMETERS,
            Self::Diffuse => AreaEmission::PARAMETERS,
        }
    }
}

impl LightTables {
    /// The lights of a `LightSource`: one, but sun and sky are two; problems go to the context's diagnostics.
    pub fn build_light(&mut self, entity: &LightEntity, context: &mut BuildContext) -> Vec<Light> {
        let kinds = LightKind::ALL.into_iter().filter(|kind| *kind != LightKind::Diffuse);
        let Some(kind) = find_kind(&entity.entity, "light", kinds, context) else { return Vec::new() };
        if entity.world_from_light.is_animated() {
            let text = "moving lights are not supported; the light stays where it starts";
            context.diagnostics.warning(entity.entity.span, text);
        }
        let transform = &entity.world_from_light.start;
        let mut p = Parameters::new(&entity.entity, context);
        let lights = match kind {
            LightKind::Sky | LightKind::Sun | LightKind::SunSky => self.build_sky(kind, &mut p, transform),
            _ => self.build_single(kind, &mut p, transform).into_iter().collect(),
        };
        p.ignore("group");
        p.finish();
        lights
    }

    fn build_single(&mut self, kind: LightKind, p: &mut Parameters, transform: &Transform) -> Option<Light> {
        match kind {
            LightKind::Point => Some(Light::Point(PointLight::build(p, transform))),
            LightKind::Spot => SpotLight::build(p, transform).map(Light::Spot),
            LightKind::Distant => DistantLight::build(p, transform).map(Light::Distant),
            LightKind::Goniometric => GoniometricLight::build(p, transform).map(|light| {
                self.goniometric.push(light);
                Light::Goniometric(GoniometricLightId(self.goniometric.len() as u32 - 1))
            }),
            LightKind::Ies => IesLight::build(p, transform).map(|light| {
                self.luminaires.push(light);
                Light::Ies(IesLightId(self.luminaires.len() as u32 - 1))
            }),
            LightKind::Projection => ProjectionLight::build(p, transform, self).map(|light| {
                self.projections.push(light);
                Light::Projection(ProjectionLightId(self.projections.len() as u32 - 1))
            }),
            LightKind::Infinite => self.build_infinite(p, transform),
            LightKind::Sky | LightKind::Sun | LightKind::SunSky | LightKind::Diffuse => {
                unreachable!("these are no single light source")
            }
        }
    }

    fn build_sky(&mut self, kind: LightKind, p: &mut Parameters, transform: &Transform) -> Vec<Light> {
        let Some(settings) = SkySettings::read(p, transform) else { return Vec::new() };
        let mut lights = Vec::new();
        if kind != LightKind::Sun
            && let Some(sky) = settings.sky(p)
        {
            self.skies.push(sky);
            lights.push(Light::Sky(SkyLightId(self.skies.len() as u32 - 1)));
        }
        if kind != LightKind::Sky {
            lights.extend(settings.sun(p).map(Light::Sun));
        }
        lights
    }

    fn build_infinite(&mut self, p: &mut Parameters, transform: &Transform) -> Option<Light> {
        if p.has("L") && p.has("filename") {
            let span = p.span_of("filename");
            p.diagnostics().error(span, "an infinite light takes \"L\" or \"filename\", not both");
            return None;
        }
        if let Some(corners) = p.points3("portal") {
            let light = InfinitePortalLight::build(p, transform, self, corners)?;
            self.portals.push(light);
            return Some(Light::InfinitePortal(InfinitePortalLightId(self.portals.len() as u32 - 1)));
        }
        if p.has("filename") {
            let light = InfiniteImageLight::build(p, transform, self)?;
            self.environments.push(light);
            return Some(Light::InfiniteImage(InfiniteImageLightId(self.environments.len() as u32 - 1)));
        }
        let source = Source::read(p, "L");
        Some(Light::InfiniteConstant(InfiniteConstantLight::build(p, &source)))
    }

    /// The emission of an `AreaLightSource` on a shape of total area `area_m2`, of which rays meet the share `alpha`.
    pub fn build_emission(
        &mut self,
        entity: &Entity,
        context: &mut BuildContext,
        area_m2: f32,
        alpha: FloatTexture,
    ) -> Option<AreaEmissionId> {
        find_kind(entity, "area light", [LightKind::Diffuse].into_iter(), context)?;
        let mut p = Parameters::new(entity, context);
        let emission = AreaEmission::build(&mut p, area_m2, self);
        p.ignore("group");
        p.finish();
        self.emissions.push(emission?.with_alpha(alpha));
        Some(AreaEmissionId(self.emissions.len() as u32 - 1))
    }
}

fn find_kind(
    entity: &Entity,
    what: &str,
    kinds: impl Iterator<Item = LightKind> + Clone,
    context: &mut BuildContext,
) -> Option<LightKind> {
    let found = kinds.clone().find(|kind| kind.name() == entity.type_name);
    if found.is_none() {
        let known = kinds.map(LightKind::name);
        context.diagnostics.unknown_name(entity.span, what, &entity.type_name, known);
    }
    found
}

/// The spectrum, size and units that a light's parameters give.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source {
    /// Emission at `scale` 1, in internal units.
    pub(super) unit: Spectrum,
    scale: f32,
    units: LightUnits,
}

impl Source {
    /// Reads the spectrum parameter `name`, `scale` and `units`.
    pub(super) fn read(p: &mut Parameters, name: &'static str) -> Self {
        let (scale, units) = read_scale(p);
        let spectrum = p.spectrum(name, SpectrumRole::Illuminant).unwrap_or_else(|| default_illuminant(p));
        Self { unit: emitted(spectrum, 1.0, units, &p.context.spectra), scale, units }
    }

    /// The emission, made so strong that its flux is `target` times `scale` if that is positive. `flux_of` turns the
    /// measures of the spectrum into those of the flux.
    pub(super) fn spectrum(
        &self,
        p: &Parameters,
        target: f32,
        flux_of: impl Fn(LightPower) -> LightPower,
    ) -> Spectrum {
        let flux = flux_of(LightPower::of(&self.unit, &p.context.spectra));
        self.unit.scaled(self.scale * super::emission::factor_for(target, flux, self.units))
    }
}

impl Source {
    /// The emission, made so strong that its luminance is `nits` times `scale`.
    pub(super) fn with_luminance(&self, p: &Parameters, nits: f64) -> Spectrum {
        let own = LightPower::of(&self.unit, &p.context.spectra).lumens;
        self.unit.scaled(if own > 0.0 { (f64::from(self.scale) * nits / own) as f32 } else { 0.0 })
    }
}

/// `scale` and `units`.
fn read_scale(p: &mut Parameters) -> (f32, LightUnits) {
    let units = p.choice("units", "photometric", &LightUnits::NAMES);
    let scale = p.float("scale", 1.0);
    if scale >= 0.0 && scale.is_finite() {
        return (scale, units);
    }
    let span = p.span_of("scale");
    p.diagnostics().error(span, format!("\"scale\" of a light must be at least 0, not {scale}"));
    (1.0, units)
}

/// The white of the colour space that was current at the light.
pub(super) fn default_illuminant(p: &mut Parameters) -> Spectrum {
    let space = p.entity().parameters.first().map_or(ColorSpaceName::Srgb, |parameter| parameter.color_space);
    let table = p.context.spectra.illuminant(space);
    Spectrum::table(table, &p.context.spectra)
}

/// The size of a pictured emission.
#[derive(Clone, Copy, Debug)]
pub(super) struct PictureScale {
    scale: f32,
    units: LightUnits,
}

impl PictureScale {
    /// Reads `scale` and `units`.
    pub(super) fn read(p: &mut Parameters) -> Self {
        let (scale, units) = read_scale(p);
        Self { scale, units }
    }

    /// What the picture's values are multiplied by. If `target` is positive, it is the flux of the light over `scale`,
    /// where the flux is `extent` times `mean`, a spectrum in terms of the picture's illuminant.
    pub(super) fn factor(
        self,
        p: &Parameters,
        picture: &Picture,
        target: f32,
        mean: Spectrum,
        extent: f32,
    ) -> f32 {
        let spectra = &p.context.spectra;
        let unit = unit_factor(picture.white_spectrum(spectra), self.units, spectra);
        let flux = LightPower::of(&mean, spectra) * (unit * f64::from(extent));
        unit as f32 * self.scale * super::emission::factor_for(target, flux, self.units)
    }
}

/// A picture in linear RGB, rows from the top.
#[derive(Clone, Debug)]
pub(super) struct Picture {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) rgb: Vec<[f32; 3]>,
    pub(super) space: ColorSpaceName,
    /// Illuminant of `space`.
    pub(super) white: TableId,
}

impl Picture {
    pub(super) fn new(
        width: usize,
        height: usize,
        rgb: Vec<[f32; 3]>,
        space: ColorSpaceName,
        spectra: &mut SpectrumTables,
    ) -> Self {
        assert_eq!(rgb.len(), width * height, "one colour per texel");
        Self { width, height, rgb, space, white: spectra.illuminant(space) }
    }

    fn white_spectrum(&self, spectra: &SpectrumTables) -> Spectrum {
        Spectrum::table(self.white, spectra)
    }

    /// Irradiance on a plane that faces +z under an equal-area picture, in terms of the picture's illuminant.
    pub(super) fn upper_irradiance(&self) -> Spectrum {
        let (nx, ny) = (self.width, self.height);
        let cosine = |i: usize| {
            let uv = Point2::new(((i % nx) as f32 + 0.5) / nx as f32, ((i / nx) as f32 + 0.5) / ny as f32);
            f64::from(warp::equal_area_square_to_sphere(uv).z.max(0.0))
        };
        let weights: Vec<f64> = (0..nx * ny).map(cosine).collect();
        if nx < 2 {
            return weighted_mean(self.rgb.iter().map(|c| (*c, 1.0)), self.space, self.white).scaled(PI);
        }
        // Cosines add up to a quarter of the texels: E = 4 pi / n * sum of L cos.
        let total: f64 = weights.iter().sum();
        let solid_angle = 4.0 * f64::from(PI) * total / weights.len() as f64;
        let pixels = self.rgb.iter().copied().zip(weights.iter().copied());
        weighted_mean(pixels, self.space, self.white).scaled(solid_angle as f32)
    }
}

/// The picture that `filename` names; problems are reported.
pub(super) fn read_picture(p: &mut Parameters) -> Option<Picture> {
    let span = p.span_of("filename");
    let Some(filename) = p.string_opt("filename").filter(|name| !name.is_empty()) else {
        p.missing("filename", format!("a {} light needs \"filename\"", p.entity().type_name));
        return None;
    };
    let assets = p.context.assets;
    let Some(texels) = assets.images.get(&filename) else {
        if !assets.failed.contains(&filename) {
            p.diagnostics().error(span, format!("the picture \"{filename}\" was not loaded"));
        }
        return None;
    };
    let table = DecodeTable::new(Encoding::Srgb);
    let (width, height) = (texels.width(), texels.height());
    let mut rgb = Vec::with_capacity(width * height);
    for y in 0..height {
        rgb.extend((0..width).map(|x| texels.linear_rgb(x, y, &table)));
    }
    if rgb.iter().flatten().any(|v| !v.is_finite()) {
        let text =
            format!("the picture \"{filename}\" has infinite or undefined values, so it cannot be a light");
        p.diagnostics().error(span, text);
        return None;
    }
    let space = color_space_of(texels);
    Some(Picture::new(width, height, rgb, space, &mut p.context.spectra))
}

/// The same where the picture must be an equal-area map of the sphere.
pub(super) fn read_square_picture(p: &mut Parameters) -> Option<Picture> {
    let picture = read_picture(p)?;
    if picture.width == picture.height {
        return Some(picture);
    }
    let span = p.span_of("filename");
    let text = format!(
        "the picture of a {} light must be square (an equal-area map of the sphere), not {} x {}",
        p.entity().type_name,
        picture.width,
        picture.height
    );
    let error = p.diagnostics().error(span, text);
    if picture.width == 2 * picture.height {
        error.with_help(
            "a picture twice as wide as high is probably a latitude-longitude map; convert it to the equal-area layout",
        );
    } else {
        error.with_help("convert it to the square equal-area layout of Clarberg 2008");
    }
    None
}

/// A picture of one texel with the colour of `L`: what a portal shows if no picture is given.
pub(super) fn constant_picture(p: &mut Parameters) -> Picture {
    let rgb = p.rgb("L");
    let space = p.find("L").map_or(ColorSpaceName::Srgb, |parameter| parameter.color_space);
    let rgb = rgb.unwrap_or_else(|| {
        let Some(spectrum) = p.spectrum("L", SpectrumRole::Illuminant) else { return [1.0; 3] };
        let spectra = &p.context.spectra;
        let xyz = spectrum_to_xyz(&spectrum, spectra);
        let [r, g, b] = ColorSpace::get(space).to_rgb(xyz);
        // One unit of any spectrum is 1 cd/m^2, so only the colour counts.
        [r / xyz.y, g / xyz.y, b / xyz.y].map(|c| if c.is_finite() { c.max(0.0) } else { 0.0 })
    });
    Picture::new(1, 1, vec![rgb], space, &mut p.context.spectra)
}

/// The colour space whose primaries the file states, sRGB if none or unknown.
fn color_space_of(texels: &Texels) -> ColorSpaceName {
    let Some(stated) = texels.color_space else { return ColorSpaceName::Srgb };
    let stated = [stated.red, stated.green, stated.blue];
    let near = |space: &ColorSpaceName| {
        let primaries = ColorSpace::get(*space).primaries_xy;
        primaries.iter().zip(&stated).all(|(a, b)| (a[0] - b[0]).abs() < 5e-3 && (a[1] - b[1]).abs() < 5e-3)
    };
    ColorSpaceName::ALL.into_iter().find(near).unwrap_or(ColorSpaceName::Srgb)
}

/// A unit vector, or an error at parameter `name` where there is none.
pub(super) fn direction(p: &mut Parameters, name: &'static str, v: Vector3) -> Option<Vector3> {
    let direction = v.try_normalized();
    if direction.is_none() {
        let span = p.span_of(name);
        p.diagnostics().error(span, "\"from\" and \"to\" of a light must differ");
    }
    direction
}

/// The luminaire that a parameter names; problems are reported.
pub(super) fn read_photometry(p: &mut Parameters, name: &'static str) -> Option<Arc<Photometry>> {
    let span = p.span_of(name);
    let Some(filename) = p.string_opt(name).filter(|name| !name.is_empty()) else {
        p.missing(name, format!("a {} light needs \"{name}\"", p.entity().type_name));
        return None;
    };
    let assets = p.context.assets;
    let found = assets.luminaires.get(&filename).cloned();
    if found.is_none() && !assets.failed.contains(&filename) {
        p.diagnostics().error(span, format!("the photometric file \"{filename}\" was not loaded"));
    }
    found
}
