//! An image as a renderer writes it: named planes of `f32` and text attributes.
//!
//! Channels are named as in OpenEXR: `R`, `G`, `B`, `A` for the picture itself and `layer.X` for layers
//! (`direct.R`, `variance.Y`, `N.X`). Rows run from the top of the picture to its bottom.

use std::collections::BTreeMap;

/// One named plane of values, row-major, top row first.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Name as in OpenEXR, for example `R` or `direct.R`.
    pub name: String,
    /// `width * height` values.
    pub values: Vec<f32>,
}

/// Planes of one size with text attributes.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Image {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Planes in the order in which they were added; names are unique.
    pub channels: Vec<Channel>,
    /// Text attributes that travel with the image, for example the render settings.
    pub metadata: BTreeMap<String, String>,
}

impl Image {
    /// An image without channels.
    pub fn new(width: usize, height: usize) -> Self {
        Self { width, height, channels: Vec::new(), metadata: BTreeMap::new() }
    }

    /// An image with channels `R`, `G`, `B`.
    ///
    /// # Panics
    /// When `pixels` is not `width * height` long.
    pub fn rgb(width: usize, height: usize, pixels: Vec<[f32; 3]>) -> Self {
        let mut image = Self::new(width, height);
        image.set_rgb("", &pixels);
        image
    }

    /// An image with the one channel `Y`.
    ///
    /// # Panics
    /// When `values` is not `width * height` long.
    pub fn gray(width: usize, height: usize, values: Vec<f32>) -> Self {
        let mut image = Self::new(width, height);
        image.set_channel("Y", values);
        image
    }

    /// An image with channels `R`, `G`, `B` computed pixel by pixel from (x, y).
    pub fn from_fn(width: usize, height: usize, mut pixel: impl FnMut(usize, usize) -> [f32; 3]) -> Self {
        let pixels = (0..width * height).map(|i| pixel(i % width, i / width)).collect();
        Self::rgb(width, height, pixels)
    }

    /// Number of pixels.
    pub fn n_pixels(&self) -> usize {
        self.width * self.height
    }

    /// Whether no channel holds a value.
    pub fn is_empty(&self) -> bool {
        self.n_pixels() == 0 || self.channels.is_empty()
    }

    /// The channel of that name.
    pub fn channel(&self, name: &str) -> Option<&Channel> {
        self.channels.iter().find(|channel| channel.name == name)
    }

    /// The channel of that name, to change its values.
    pub fn channel_mut(&mut self, name: &str) -> Option<&mut Channel> {
        self.channels.iter_mut().find(|channel| channel.name == name)
    }

    /// Adds a channel, or replaces the values of the one that has this name.
    ///
    /// # Panics
    /// When `values` is not `width * height` long.
    pub fn set_channel(&mut self, name: &str, values: Vec<f32>) {
        assert_eq!(values.len(), self.n_pixels(), "channel `{name}` must hold one value per pixel");
        match self.channel_mut(name) {
            Some(channel) => channel.values = values,
            None => self.channels.push(Channel { name: name.to_owned(), values }),
        }
    }

    /// Sets the channels `R`, `G`, `B` of a layer; the empty name is the picture itself.
    ///
    /// # Panics
    /// When `pixels` is not `width * height` long.
    pub fn set_rgb(&mut self, layer: &str, pixels: &[[f32; 3]]) {
        for (index, letter) in ["R", "G", "B"].iter().enumerate() {
            let values = pixels.iter().map(|pixel| pixel[index]).collect();
            self.set_channel(&layered(layer, letter), values);
        }
    }

    /// Pixels of the channels `R`, `G`, `B`; a picture with `Y` alone gives gray pixels.
    pub fn rgb_pixels(&self) -> Option<Vec<[f32; 3]>> {
        self.layer_rgb("")
    }

    /// Pixels of a layer's `R`, `G`, `B`, or of its `Y` thrice.
    pub fn layer_rgb(&self, layer: &str) -> Option<Vec<[f32; 3]>> {
        let plane = |letter| Some(&self.channel(&layered(layer, letter))?.values);
        if let (Some(r), Some(g), Some(b)) = (plane("R"), plane("G"), plane("B")) {
            return Some((0..self.n_pixels()).map(|i| [r[i], g[i], b[i]]).collect());
        }
        plane("Y").map(|y| y.iter().map(|&value| [value; 3]).collect())
    }

    /// The channels `prefix.*` as an image of their own, the prefix taken off; metadata is kept. The empty prefix
    /// gives the channels that belong to no layer. `None` when there is no such channel.
    pub fn layer(&self, prefix: &str) -> Option<Image> {
        let own_name = |name: &str| match name.rsplit_once('.') {
            Some((layer, letter)) if layer == prefix => Some(letter.to_owned()),
            None if prefix.is_empty() => Some(name.to_owned()),
            _ => None,
        };
        let take = |channel: &Channel| {
            Some(Channel { name: own_name(&channel.name)?, values: channel.values.clone() })
        };
        let channels: Vec<Channel> = self.channels.iter().filter_map(take).collect();
        if channels.is_empty() {
            return None;
        }
        Some(Image { width: self.width, height: self.height, channels, metadata: self.metadata.clone() })
    }

    /// Names of the layers in order of first appearance; the picture itself is the empty name.
    pub fn layers(&self) -> Vec<&str> {
        let mut names = Vec::new();
        for channel in &self.channels {
            let layer = channel.name.rsplit_once('.').map_or("", |(layer, _)| layer);
            if !names.contains(&layer) {
                names.push(layer);
            }
        }
        names
    }

    /// Adds every channel of `other` as layer `prefix`, replacing channels of the same name.
    ///
    /// # Panics
    /// When the sizes differ.
    pub fn add_layer(&mut self, prefix: &str, other: &Image) {
        for channel in &other.channels {
            self.set_channel(&layered(prefix, &channel.name), channel.values.clone());
        }
    }
}

/// Full name of a channel in a layer.
fn layered(layer: &str, name: &str) -> String {
    if layer.is_empty() { name.to_owned() } else { format!("{layer}.{name}") }
}
