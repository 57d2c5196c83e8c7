//! Textures: numbers and spectra that vary over surfaces or through space.
//!
//! Materials, lights and shapes hold small handles, [`FloatTexture`] and [`SpectrumTexture`]. What is not constant is
//! a node in the arena [`Textures`]; nodes refer to nodes that were made before them, so there are no cycles. Names,
//! defaults and meanings of parameters are those of pbrt-v4 (Pharr, Jakob and Humphreys 2023, chapter 10), but
//! for `dots`, whose `inside` is inside here as its documentation says, and Ptex, which is missing.

mod handle;
mod mapping;

mod bilerp;
mod checkerboard;
mod constant;
mod dots;
mod fractal;
mod image_texture;
mod marble;
mod mesh_attribute;
mod mix;
mod scale;

mod image_map;
mod noise;
mod uplift;

mod build;
#[cfg(test)]
mod tests;

use etendue_spectrum::{Sampled, SpectrumTables, Wavelengths};

use crate::parameters::SpectrumRole;

pub use bilerp::Bilerp;
pub use build::{FLOAT_TEXTURES, SPECTRUM_TEXTURES};
pub use checkerboard::{CheckMapping, Checkerboard};
pub use dots::Dots;
pub use fractal::{Fbm, Windy, Wrinkled};
pub use handle::{FloatTexture, FloatTextureId, SpectrumTexture, SpectrumTextureId, TextureContext};
pub use image_map::{Channels, ImageFilter, ImageMap, ImageOptions, WrapMode};
pub use image_texture::{ImageId, ImageTexture, SpectrumImageTexture};
pub use mapping::{Coordinates2, Coordinates3, Mapping2, Mapping3};
pub use marble::Marble;
pub use mesh_attribute::{
    AttributeId, Corners, MeshAttributeTexture, MeshAttributes, ShapeAttribute, ShapePoint,
};
pub use mix::{DirectionMix, Mix};
pub use noise::{Octaves, noise};
pub use scale::Scale;
pub use uplift::Uplift;

// To add a kind of texture: a file with a plain struct and the table of its parameters, a variant here (in both enums if
// it yields numbers and spectra), its arm in `eval_float` or `eval_spectrum`, its arm and its line in the table of
// `build.rs`, a test.

/// A texture that yields numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FloatTextureNode {
    /// A texture times a number.
    Scale(Scale<FloatTexture>),
    /// A blend by an amount.
    Mix(Mix<FloatTexture>),
    /// A blend by the direction of the normal.
    DirectionMix(DirectionMix<FloatTexture>),
    /// Bilinear interpolation between constants.
    Bilerp(Bilerp<f32>),
    /// Checks in the plane or in space.
    Checkerboard(Checkerboard<FloatTexture>),
    /// Random dots.
    Dots(Dots<FloatTexture>),
    /// Sums of noise.
    Fbm(Fbm),
    /// Sums of absolute noise.
    Wrinkled(Wrinkled),
    /// Waves.
    Windy(Windy),
    /// A picture.
    Image(ImageTexture),
    /// What meshes have at their vertices or faces.
    MeshAttribute(MeshAttributeTexture),
}

/// A texture that yields spectra.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpectrumTextureNode {
    /// A texture times a number.
    Scale(Scale<SpectrumTexture>),
    /// A blend by an amount.
    Mix(Mix<SpectrumTexture>),
    /// A blend by the direction of the normal.
    DirectionMix(DirectionMix<SpectrumTexture>),
    /// Bilinear interpolation between constants.
    Bilerp(Bilerp<etendue_spectrum::Spectrum>),
    /// Checks in the plane or in space.
    Checkerboard(Checkerboard<SpectrumTexture>),
    /// Random dots.
    Dots(Dots<SpectrumTexture>),
    /// Layers of stone, with the way from their colours to reflectances.
    Marble(Marble, Uplift),
    /// A picture.
    Image(SpectrumImageTexture),
    /// What meshes have at their vertices or faces, with the way from colours to spectra.
    MeshAttribute(MeshAttributeTexture, Uplift),
}

/// A picture with the name of its file.
#[derive(Clone, Debug)]
struct NamedImage {
    name: String,
    options: ImageOptions,
    map: ImageMap,
}

/// All textures of a scene, with their pictures and tabulated spectra.
#[derive(Clone, Debug, Default)]
pub struct Textures {
    /// Tabulated spectra that any spectrum of the scene may refer to.
    pub spectra: SpectrumTables,
    /// What textures show of the vertices and faces of meshes.
    pub mesh_attributes: MeshAttributes,
    floats: Vec<FloatTextureNode>,
    spectrums: Vec<SpectrumTextureNode>,
    images: Vec<NamedImage>,
}

impl Textures {
    /// Adds a texture that yields numbers.
    pub fn add_float(&mut self, node: FloatTextureNode) -> FloatTexture {
        self.floats.push(node);
        FloatTexture::Node(FloatTextureId(self.floats.len() as u32 - 1))
    }

    /// Adds a texture that yields spectra.
    pub fn add_spectrum(&mut self, node: SpectrumTextureNode) -> SpectrumTexture {
        self.spectrums.push(node);
        SpectrumTexture::Node(SpectrumTextureId(self.spectrums.len() as u32 - 1))
    }

    /// Adds a picture, or finds it if it was added with the same options before.
    pub fn add_image(
        &mut self,
        name: &str,
        texels: &std::sync::Arc<etendue_image::Texels>,
        options: ImageOptions,
    ) -> ImageId {
        let known = self.images.iter().position(|image| image.name == name && image.options == options);
        let index = known.unwrap_or_else(|| {
            let map = ImageMap::new(texels.clone(), options);
            self.images.push(NamedImage { name: name.to_owned(), options, map });
            self.images.len() - 1
        });
        ImageId(index as u32)
    }

    /// A picture.
    #[inline]
    #[must_use]
    pub fn image(&self, id: ImageId) -> &ImageMap {
        &self.images[id.0 as usize].map
    }

    /// The node of that id.
    #[must_use]
    pub fn float_node(&self, id: FloatTextureId) -> &FloatTextureNode {
        &self.floats[id.0 as usize]
    }

    /// The node of that id.
    #[must_use]
    pub fn spectrum_node(&self, id: SpectrumTextureId) -> &SpectrumTextureNode {
        &self.spectrums[id.0 as usize]
    }

    /// What a texture's colours were lifted for, where that is known: constants and mixtures have none of their own.
    #[must_use]
    pub fn role(&self, texture: SpectrumTexture) -> Option<SpectrumRole> {
        let SpectrumTexture::Node(id) = texture else { return None };
        match self.spectrum_node(id) {
            SpectrumTextureNode::Marble(_, uplift) | SpectrumTextureNode::MeshAttribute(_, uplift) => {
                Some(uplift.role)
            }
            SpectrumTextureNode::Image(image) => Some(image.role()),
            _ => None,
        }
    }

    /// The number at a point.
    #[inline]
    #[must_use]
    pub fn eval_float(&self, texture: FloatTexture, ctx: &TextureContext) -> f32 {
        match texture {
            FloatTexture::Constant(value) => value,
            FloatTexture::Node(id) => self.eval_float_node(self.float_node(id), ctx),
        }
    }

    fn eval_float_node(&self, node: &FloatTextureNode, ctx: &TextureContext) -> f32 {
        let blend = |a: FloatTexture, b: FloatTexture, amount: f32| {
            let a = if amount == 1.0 { 0.0 } else { (1.0 - amount) * self.eval_float(a, ctx) };
            let b = if amount == 0.0 { 0.0 } else { amount * self.eval_float(b, ctx) };
            a + b
        };
        match node {
            FloatTextureNode::Scale(node) => match self.eval_float(node.scale, ctx) {
                0.0 => 0.0,
                scale => scale * self.eval_float(node.texture, ctx),
            },
            FloatTextureNode::Mix(node) => blend(node.a, node.b, self.eval_float(node.amount, ctx)),
            FloatTextureNode::DirectionMix(node) => blend(node.a, node.b, node.amount(ctx)),
            FloatTextureNode::Bilerp(node) => {
                node.weights(ctx).iter().zip(&node.corners).map(|(weight, value)| weight * value).sum()
            }
            FloatTextureNode::Checkerboard(node) => blend(node.a, node.b, node.amount(ctx)),
            FloatTextureNode::Dots(node) => self.eval_float(node.select(ctx), ctx),
            FloatTextureNode::Fbm(node) => node.eval(ctx),
            FloatTextureNode::Wrinkled(node) => node.eval(ctx),
            FloatTextureNode::Windy(node) => node.eval(ctx),
            FloatTextureNode::Image(node) => node.eval_float(self.image(node.image), ctx),
            FloatTextureNode::MeshAttribute(node) => node.eval_float(&self.mesh_attributes, ctx),
        }
    }

    /// The spectrum at a point, at the given wavelengths.
    #[inline]
    #[must_use]
    pub fn eval_spectrum(
        &self,
        texture: SpectrumTexture,
        ctx: &TextureContext,
        lambda: &Wavelengths,
    ) -> Sampled {
        match texture {
            SpectrumTexture::Constant(spectrum) => spectrum.sample(&self.spectra, lambda),
            SpectrumTexture::Node(id) => self.eval_spectrum_node(self.spectrum_node(id), ctx, lambda),
        }
    }

    fn eval_spectrum_node(
        &self,
        node: &SpectrumTextureNode,
        ctx: &TextureContext,
        lambda: &Wavelengths,
    ) -> Sampled {
        let eval = |texture: SpectrumTexture| self.eval_spectrum(texture, ctx, lambda);
        let blend = |a: SpectrumTexture, b: SpectrumTexture, amount: f32| {
            let a = if amount == 1.0 { Sampled::ZERO } else { eval(a) * (1.0 - amount) };
            let b = if amount == 0.0 { Sampled::ZERO } else { eval(b) * amount };
            a + b
        };
        match node {
            SpectrumTextureNode::Scale(node) => match self.eval_float(node.scale, ctx) {
                0.0 => Sampled::ZERO,
                scale => eval(node.texture) * scale,
            },
            SpectrumTextureNode::Mix(node) => blend(node.a, node.b, self.eval_float(node.amount, ctx)),
            SpectrumTextureNode::DirectionMix(node) => blend(node.a, node.b, node.amount(ctx)),
            SpectrumTextureNode::Bilerp(node) => {
                let weights = node.weights(ctx);
                let terms = weights.iter().zip(&node.corners);
                terms.fold(Sampled::ZERO, |sum, (weight, corner)| {
                    sum + corner.sample(&self.spectra, lambda) * *weight
                })
            }
            SpectrumTextureNode::Checkerboard(node) => blend(node.a, node.b, node.amount(ctx)),
            SpectrumTextureNode::Dots(node) => eval(node.select(ctx)),
            SpectrumTextureNode::Marble(node, uplift) => uplift.sample(node.rgb(ctx), &self.spectra, lambda),
            SpectrumTextureNode::MeshAttribute(node, uplift) => {
                uplift.sample(node.eval_rgb(&self.mesh_attributes, ctx), &self.spectra, lambda)
            }
            SpectrumTextureNode::Image(node) => {
                node.eval(self.image(node.texture.image), &self.spectra, ctx, lambda)
            }
        }
    }
}
