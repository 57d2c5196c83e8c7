//! A texture picture in the width its file had.
//!
//! A scene may hold gigabytes of textures, so a texel stays a byte, a half or a float until it is looked up.
//! Bytes and 16-bit integers are *encoded* (see [`Encoding`]); halves and floats are linear light already.
//! Channels are interleaved: gray, gray and alpha, red green blue, or red green blue alpha. Alpha is never encoded.

use half::f16;

use crate::{Channel, DecodeTable, Encoding, Image};

/// CIE 1931 xy coordinates of a picture's primaries and white.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Chromaticities {
    /// Red primary.
    pub red: [f32; 2],
    /// Green primary.
    pub green: [f32; 2],
    /// Blue primary.
    pub blue: [f32; 2],
    /// White point.
    pub white: [f32; 2],
}

impl Chromaticities {
    /// Rec. ITU-R BT.709 and sRGB, white D65.
    pub const REC709: Self =
        Self { red: [0.64, 0.33], green: [0.3, 0.6], blue: [0.15, 0.06], white: [0.3127, 0.329] };
    /// Academy ACES2065-1 (AP0).
    pub const ACES2065_1: Self =
        Self { red: [0.7347, 0.2653], green: [0.0, 1.0], blue: [0.0001, -0.077], white: [0.32168, 0.33767] };
}

/// The numbers of a texture, channels interleaved, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub enum TexelData {
    /// Encoded values times 255.
    U8(Vec<u8>),
    /// Encoded values times 65535, as in 16-bit PNG.
    U16(Vec<u16>),
    /// Linear values as IEEE half bits.
    F16(Vec<u16>),
    /// Linear values.
    F32(Vec<f32>),
}

impl TexelData {
    /// Number of stored values.
    pub fn len(&self) -> usize {
        match self {
            TexelData::U8(values) => values.len(),
            TexelData::U16(values) | TexelData::F16(values) => values.len(),
            TexelData::F32(values) => values.len(),
        }
    }

    /// Whether nothing is stored.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether values need an [`Encoding`] to become light.
    pub fn is_encoded(&self) -> bool {
        matches!(self, TexelData::U8(_) | TexelData::U16(_))
    }
}

/// A texture picture of 1 to 4 interleaved channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Texels {
    width: usize,
    height: usize,
    n_channels: usize,
    data: TexelData,
    /// Primaries that the file states; `None` means those of the scene's colour space.
    pub color_space: Option<Chromaticities>,
}

impl Texels {
    /// Takes interleaved values.
    ///
    /// # Panics
    /// When the length is not `width * height * n_channels`, a size is zero, or `n_channels` is not 1 to 4.
    pub fn new(width: usize, height: usize, n_channels: usize, data: TexelData) -> Self {
        assert!((1..=4).contains(&n_channels), "a texture has one to four channels");
        assert!(width > 0 && height > 0, "a texture has at least one texel");
        assert_eq!(data.len(), width * height * n_channels, "one value per texel and channel");
        Self { width, height, n_channels, data, color_space: None }
    }

    /// Linear floats computed from (x, y, channel).
    pub fn from_fn(
        width: usize,
        height: usize,
        n_channels: usize,
        mut value: impl FnMut(usize, usize, usize) -> f32,
    ) -> Self {
        let mut values = Vec::with_capacity(width * height * n_channels);
        for y in 0..height {
            for x in 0..width {
                values.extend((0..n_channels).map(|c| value(x, y, c)));
            }
        }
        Self::new(width, height, n_channels, TexelData::F32(values))
    }

    /// Texels in a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Interleaved channels, 1 to 4.
    pub fn n_channels(&self) -> usize {
        self.n_channels
    }

    /// The stored numbers.
    pub fn data(&self) -> &TexelData {
        &self.data
    }

    /// Whether values need an [`Encoding`] to become light.
    pub fn is_encoded(&self) -> bool {
        self.data.is_encoded()
    }

    /// Whether the last channel is alpha.
    pub fn has_alpha(&self) -> bool {
        self.n_channels == 2 || self.n_channels == 4
    }

    /// Channels without alpha: 1 or 3.
    pub fn n_colors(&self) -> usize {
        if self.has_alpha() { self.n_channels - 1 } else { self.n_channels }
    }

    /// Bytes held by the texels.
    pub fn n_bytes(&self) -> usize {
        let width = match self.data {
            TexelData::U8(_) => 1,
            TexelData::U16(_) | TexelData::F16(_) => 2,
            TexelData::F32(_) => 4,
        };
        self.data.len() * width
    }

    /// Stored value of one channel, integers scaled to [0, 1], not decoded.
    ///
    /// # Panics
    /// When the position lies outside.
    #[inline]
    pub fn texel(&self, x: usize, y: usize, channel: usize) -> f32 {
        let index = self.index(x, y, channel);
        match &self.data {
            TexelData::U8(values) => f32::from(values[index]) / 255.0,
            TexelData::U16(values) => f32::from(values[index]) / 65535.0,
            TexelData::F16(values) => f16::from_bits(values[index]).to_f32(),
            TexelData::F32(values) => values[index],
        }
    }

    /// Linear value of one channel; `table` is used where the values are encoded and the channel is not alpha.
    ///
    /// # Panics
    /// When the position lies outside.
    #[inline]
    pub fn linear(&self, x: usize, y: usize, channel: usize, table: &DecodeTable) -> f32 {
        let index = self.index(x, y, channel);
        let is_color = channel < self.n_colors();
        match &self.data {
            TexelData::U8(values) if is_color => table.byte(values[index]),
            TexelData::U16(values) if is_color => table.encoding().decode(f32::from(values[index]) / 65535.0),
            _ => self.texel(x, y, channel),
        }
    }

    /// Linear red, green, blue; gray thrice where there is one colour channel.
    #[inline]
    pub fn linear_rgb(&self, x: usize, y: usize, table: &DecodeTable) -> [f32; 3] {
        if self.n_colors() == 1 {
            return [self.linear(x, y, 0, table); 3];
        }
        std::array::from_fn(|channel| self.linear(x, y, channel, table))
    }

    /// Average of the linear colour channels of one texel.
    #[inline]
    pub fn linear_average(&self, x: usize, y: usize, table: &DecodeTable) -> f32 {
        let n_colors = self.n_colors();
        (0..n_colors).map(|channel| self.linear(x, y, channel, table)).sum::<f32>() / n_colors as f32
    }

    /// Alpha of one texel, 1 where the picture has none.
    #[inline]
    pub fn alpha(&self, x: usize, y: usize) -> f32 {
        if self.has_alpha() { self.texel(x, y, self.n_channels - 1) } else { 1.0 }
    }

    /// Average of the linear colour channels as a one-channel texture of floats.
    pub fn to_gray(&self, encoding: Encoding) -> Texels {
        let table = DecodeTable::new(encoding);
        Texels::from_fn(self.width, self.height, 1, |x, y, _| self.linear_average(x, y, &table))
    }

    /// The same picture in linear floats.
    pub fn to_linear(&self, encoding: Encoding) -> Texels {
        let table = DecodeTable::new(encoding);
        let mut linear =
            Texels::from_fn(self.width, self.height, self.n_channels, |x, y, c| self.linear(x, y, c, &table));
        linear.color_space = self.color_space;
        linear
    }

    /// The same picture in linear halves, rounded to nearest even; values beyond 65504 become infinite.
    pub fn to_half(&self, encoding: Encoding) -> Texels {
        let table = DecodeTable::new(encoding);
        let mut values = Vec::with_capacity(self.data.len());
        for y in 0..self.height {
            for x in 0..self.width {
                let texel = (0..self.n_channels).map(|c| self.linear(x, y, c, &table));
                values.extend(texel.map(|value| f16::from_f32(value).to_bits()));
            }
        }
        let data = TexelData::F16(values);
        Texels {
            width: self.width,
            height: self.height,
            n_channels: self.n_channels,
            data,
            color_space: self.color_space,
        }
    }

    /// Stores floats as halves if every one of them is exactly a half, as those of Radiance files mostly are.
    pub fn compact(self) -> Texels {
        let TexelData::F32(values) = &self.data else { return self };
        let is_half = |&value: &f32| f16::from_f32(value).to_f32().to_bits() == value.to_bits();
        if !values.iter().all(is_half) {
            return self;
        }
        self.to_half(Encoding::Linear)
    }

    /// Planes named `Y`, `R G B` and `A` with linear values.
    pub fn to_image(&self, encoding: Encoding) -> Image {
        let table = DecodeTable::new(encoding);
        let names: &[&str] = match self.n_channels {
            1 => &["Y"],
            2 => &["Y", "A"],
            3 => &["R", "G", "B"],
            _ => &["R", "G", "B", "A"],
        };
        let mut image = Image::new(self.width, self.height);
        for (channel, name) in names.iter().enumerate() {
            let at = |i: usize| self.linear(i % self.width, i / self.width, channel, &table);
            let values = (0..self.width * self.height).map(at).collect();
            image.channels.push(Channel { name: (*name).to_owned(), values });
        }
        image
    }

    #[inline]
    fn index(&self, x: usize, y: usize, channel: usize) -> usize {
        assert!(x < self.width && y < self.height && channel < self.n_channels, "texel outside the picture");
        (y * self.width + x) * self.n_channels + channel
    }
}
