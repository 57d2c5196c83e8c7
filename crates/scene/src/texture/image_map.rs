//! Pictures as textures: wrapping at the borders and filtering.
//!
//! Four filters: the nearest texel; bilinear interpolation between four; trilinear, between two levels of a pyramid of
//! averages (Williams 1983, "Pyramidal Parametrics"); and the elliptically weighted average over the footprint of a
//! pixel (Heckbert 1989, "Fundamentals of Texture Mapping and Image Warping"). Filtering is done in linear light.
//!
//! The finest level is the loaded picture itself in the width of its file; only trilinear and elliptic filters build
//! coarser levels, in half precision unless the picture has floats. Nearest and bilinear use the finest level alone:
//! with several samples per pixel the pixel filter averages what they leave (pbrt-v4 picks a coarser level).

use std::sync::Arc;

use etendue_image::{DecodeTable, Encoding, TexelData, Texels};
use etendue_math::{Point2, Vector2, lerp};

use super::mapping::Coordinates2;

/// How texels near a point are combined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ImageFilter {
    /// The nearest texel.
    Point,
    /// Between four texels.
    #[default]
    Bilinear,
    /// Between four texels of each of two levels.
    Trilinear,
    /// Elliptically weighted average.
    Ewa,
}

/// What lies beyond the borders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum WrapMode {
    /// The picture again.
    #[default]
    Repeat,
    /// Black.
    Black,
    /// The nearest texel of the border.
    Clamp,
    /// The picture again, every other time as in a mirror.
    Mirror,
    /// The neighbour on the sphere, for equal-area maps of all directions.
    OctahedralSphere,
}

impl WrapMode {
    /// The index along one side of `n` texels that stands for `i`, or `None` for black.
    fn wrap_axis(self, i: i64, n: i64) -> Option<i64> {
        match self {
            _ if (0..n).contains(&i) => Some(i),
            Self::Repeat => Some(i.rem_euclid(n)),
            Self::Black => None,
            Self::Clamp | Self::OctahedralSphere => Some(i.clamp(0, n - 1)),
            Self::Mirror => {
                let i = i.rem_euclid(2 * n);
                Some(if i < n { i } else { 2 * n - 1 - i })
            }
        }
    }
}

/// The texel that stands for the one at (x, y), or `None` for black; `modes` are those across and down.
fn wrap(modes: [WrapMode; 2], x: i64, y: i64, width: usize, height: usize) -> Option<(usize, usize)> {
    let (w, h) = (width as i64, height as i64);
    if (0..w).contains(&x) && (0..h).contains(&y) {
        return Some((x as usize, y as usize));
    }
    let (mut x, mut y) = (x, y);
    if modes[0] == WrapMode::OctahedralSphere {
        // Crossing a border comes back through the same border, mirrored about its middle.
        if !(0..w).contains(&x) {
            x = if x < 0 { -1 - x } else { 2 * w - 1 - x };
            y = h - 1 - y;
        }
        if !(0..h).contains(&y) {
            y = if y < 0 { -1 - y } else { 2 * h - 1 - y };
            x = w - 1 - x;
        }
    }
    Some((modes[0].wrap_axis(x, w)? as usize, modes[1].wrap_axis(y, h)? as usize))
}

/// Which numbers of a texel are looked up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Channels {
    /// The colours.
    #[default]
    Colors,
    /// One of red, green and blue by its number; gray where there is one colour.
    Color(u8),
    /// The alpha of a picture that has one, else its last colour.
    Alpha,
}

/// How an image is looked up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageOptions {
    /// Filter.
    pub filter: ImageFilter,
    /// What lies beyond the left and right borders, and the upper and lower ones.
    pub wrap: [WrapMode; 2],
    /// What is looked up.
    pub channels: Channels,
    /// Largest ratio of the axes of the elliptic filter; thinner ellipses are widened.
    pub max_anisotropy: f32,
    /// How stored integers relate to light.
    pub encoding: Encoding,
}

impl Default for ImageOptions {
    fn default() -> Self {
        Self {
            filter: ImageFilter::Bilinear,
            wrap: [WrapMode::Repeat; 2],
            channels: Channels::Colors,
            max_anisotropy: 8.0,
            encoding: Encoding::Srgb,
        }
    }
}

/// A picture ready for look-ups. `N` in its methods is 3 for linear red, green, blue (gray thrice) or 1 for the
/// first of the channels that are looked up.
#[derive(Clone, Debug)]
pub struct ImageMap {
    base: Arc<Texels>,
    decode: Box<DecodeTable>,
    /// Levels 1 and up, each half as large as the one before, linear; empty if the filter needs none.
    coarser: Vec<Texels>,
    /// First and last channel that is looked up.
    channels: [usize; 2],
    options: ImageOptions,
}

/// Half the size, rounded up; every texel is the average over its area of the finer level.
fn halved(fine: &Texels, decode: &DecodeTable) -> Texels {
    let (width, height) = (fine.width().div_ceil(2), fine.height().div_ceil(2));
    Texels::from_fn(width, height, fine.n_channels(), |x, y, channel| {
        let columns = overlaps(x, width, fine.width());
        let rows = overlaps(y, height, fine.height());
        let mut sum = 0.0;
        for (row, row_weight) in rows.into_iter().flatten() {
            for (column, column_weight) in columns.into_iter().flatten() {
                sum += row_weight * column_weight * fine.linear(column, row, channel, decode);
            }
        }
        sum
    })
}

/// The up to three fine texels that a coarse one covers, with their shares.
fn overlaps(index: usize, n_coarse: usize, n_fine: usize) -> [Option<(usize, f32)>; 3] {
    let ratio = n_fine as f64 / n_coarse as f64;
    let (start, end) = (index as f64 * ratio, (index + 1) as f64 * ratio);
    let first = start.floor() as usize;
    std::array::from_fn(|i| {
        let fine = first + i;
        let share = (end.min((fine + 1) as f64) - start.max(fine as f64)) / ratio;
        (fine < n_fine && share > 1e-9).then_some((fine, share as f32))
    })
}

impl ImageMap {
    /// Prepares a picture; builds coarser levels if the filter needs them.
    #[must_use]
    pub fn new(base: Arc<Texels>, options: ImageOptions) -> Self {
        let decode = Box::new(DecodeTable::new(options.encoding));
        let mut coarser: Vec<Texels> = Vec::new();
        if matches!(options.filter, ImageFilter::Trilinear | ImageFilter::Ewa) {
            let keep_floats = matches!(base.data(), TexelData::F32(_));
            let mut level = halved(&base, &decode);
            let mut previous = (base.width(), base.height());
            while (level.width(), level.height()) != previous {
                previous = (level.width(), level.height());
                let next = halved(&level, &decode);
                coarser.push(if keep_floats { level } else { level.to_half(Encoding::Linear) });
                level = next;
            }
        }
        let last_color = base.n_colors() - 1;
        let channels = match options.channels {
            Channels::Colors => [0, last_color],
            Channels::Color(index) => [usize::from(index).min(last_color); 2],
            Channels::Alpha => [base.n_channels() - 1; 2],
        };
        Self { base, decode, coarser, channels, options }
    }

    /// The loaded picture.
    #[must_use]
    pub fn texels(&self) -> &Texels {
        &self.base
    }

    /// True if the alpha is asked for that the picture does not have: it counts as 1.
    #[must_use]
    pub fn lacks_alpha(&self) -> bool {
        self.options.channels == Channels::Alpha && !self.base.has_alpha()
    }

    /// Number of levels; 1 where the filter needs no coarser ones.
    #[must_use]
    pub fn n_levels(&self) -> usize {
        1 + self.coarser.len()
    }

    fn level(&self, level: usize) -> &Texels {
        if level == 0 { &self.base } else { &self.coarser[level - 1] }
    }

    /// One texel of a level, wrapped.
    fn texel<const N: usize>(&self, level: usize, x: i64, y: i64) -> [f32; N] {
        let texels = self.level(level);
        let Some((x, y)) = wrap(self.options.wrap, x, y, texels.width(), texels.height()) else {
            return [0.0; N];
        };
        let [first, last] = self.channels;
        std::array::from_fn(|channel| texels.linear(x, y, (first + channel).min(last), &self.decode))
    }

    fn bilinear<const N: usize>(&self, level: usize, st: Point2) -> [f32; N] {
        let texels = self.level(level);
        let x = st.x * texels.width() as f32 - 0.5;
        let y = st.y * texels.height() as f32 - 0.5;
        let (x0, y0) = (x.floor() as i64, y.floor() as i64);
        let (dx, dy) = (x - x.floor(), y - y.floor());
        let corner = |i: i64, j: i64| self.texel::<N>(level, x0 + i, y0 + j);
        mix(dy, mix(dx, corner(0, 0), corner(1, 0)), mix(dx, corner(0, 1), corner(1, 1)))
    }

    /// The picture at texture coordinates whose t runs *up* from the last row, as in scene files.
    #[must_use]
    pub fn lookup<const N: usize>(&self, c: &Coordinates2) -> [f32; N] {
        let st = Point2::new(c.st.x, 1.0 - c.st.y);
        if !st.is_finite() {
            return [0.0; N];
        }
        match self.options.filter {
            ImageFilter::Point => {
                let x = st.x * self.base.width() as f32;
                let y = st.y * self.base.height() as f32;
                self.texel(0, x.floor() as i64, y.floor() as i64)
            }
            ImageFilter::Bilinear => self.bilinear(0, st),
            ImageFilter::Trilinear => self.trilinear(st, &self.footprint(c)),
            ImageFilter::Ewa => self.elliptic(st, self.footprint(c)),
        }
    }

    /// Change of the position per pixel right and down, in texels of the finest level.
    fn footprint(&self, c: &Coordinates2) -> [Vector2; 2] {
        let (w, h) = (self.base.width() as f32, self.base.height() as f32);
        let finite = |v: Vector2| if v.is_finite() { v } else { Vector2::default() };
        [finite(Vector2::new(c.dsdx * w, -c.dtdx * h)), finite(Vector2::new(c.dsdy * w, -c.dtdy * h))]
    }

    fn trilinear<const N: usize>(&self, st: Point2, footprint: &[Vector2; 2]) -> [f32; N] {
        let width = 2.0 * footprint[0].abs().max_element().max(footprint[1].abs().max_element());
        let coarsest = self.n_levels() - 1;
        let level = width.max(1e-8).log2().clamp(0.0, coarsest as f32);
        let fine = level.floor() as usize;
        if fine == coarsest {
            return self.bilinear(coarsest, st);
        }
        mix(level.fract(), self.bilinear(fine, st), self.bilinear(fine + 1, st))
    }

    fn elliptic<const N: usize>(&self, st: Point2, footprint: [Vector2; 2]) -> [f32; N] {
        let [mut major, mut minor] = footprint;
        if major.length_squared() < minor.length_squared() {
            std::mem::swap(&mut major, &mut minor);
        }
        let ratio = major.length() / (minor.length() * self.options.max_anisotropy);
        if minor.length() == 0.0 {
            return self.bilinear(0, st);
        }
        if ratio > 1.0 {
            minor *= ratio;
        }
        let coarsest = self.n_levels() - 1;
        let level = minor.length().log2().clamp(0.0, coarsest as f32);
        let fine = level.floor() as usize;
        if fine == coarsest {
            // Wider than the picture: the mean, whatever the wrap.
            return if self.options.wrap.contains(&WrapMode::Black) {
                self.elliptic_level(coarsest, st, major, minor)
            } else {
                self.bilinear(coarsest, st)
            };
        }
        let at = |level: usize| self.elliptic_level(level, st, major, minor);
        mix(level.fract(), at(fine), at(fine + 1))
    }

    /// Gaussian average over the ellipse with the given axes in one level.
    fn elliptic_level<const N: usize>(
        &self,
        level: usize,
        st: Point2,
        axis0: Vector2,
        axis1: Vector2,
    ) -> [f32; N] {
        let texels = self.level(level);
        let (w, h) = (texels.width() as f32, texels.height() as f32);
        let (shrink_x, shrink_y) = (w / self.base.width() as f32, h / self.base.height() as f32);
        let centre = Point2::new(st.x * w - 0.5, st.y * h - 0.5);
        let a = Vector2::new(axis0.x * shrink_x, axis0.y * shrink_y);
        let b = Vector2::new(axis1.x * shrink_x, axis1.y * shrink_y);
        let ellipse = Ellipse::new(a, b);
        let [reach_x, reach_y] = ellipse.reach();
        let columns = (centre.x - reach_x).ceil() as i64..=(centre.x + reach_x).floor() as i64;
        let rows = (centre.y - reach_y).ceil() as i64..=(centre.y + reach_y).floor() as i64;
        let (mut sum, mut weights) = ([0.0; N], 0.0);
        for y in rows {
            for x in columns.clone() {
                let weight = ellipse.weight(x as f32 - centre.x, y as f32 - centre.y);
                if weight > 0.0 {
                    let texel = self.texel::<N>(level, x, y);
                    sum = std::array::from_fn(|i| sum[i] + weight * texel[i]);
                    weights += weight;
                }
            }
        }
        if weights > 0.0 { sum.map(|x| x / weights) } else { self.bilinear(level, st) }
    }
}

fn mix<const N: usize>(t: f32, a: [f32; N], b: [f32; N]) -> [f32; N] {
    std::array::from_fn(|i| lerp(t, a[i], b[i]))
}

/// `A x^2 + B x y + C y^2 < 1`: the image of the pixel's disc, widened by one texel so that it holds some.
struct Ellipse {
    a: f32,
    b: f32,
    c: f32,
}

impl Ellipse {
    fn new(u: Vector2, v: Vector2) -> Self {
        let a = u.y * u.y + v.y * v.y + 1.0;
        let b = -2.0 * (u.x * u.y + v.x * v.y);
        let c = u.x * u.x + v.x * v.x + 1.0;
        let f = a * c - b * b / 4.0;
        Self { a: a / f, b: b / f, c: c / f }
    }

    /// Half the size of the box around the ellipse.
    fn reach(&self) -> [f32; 2] {
        let determinant = 4.0 * self.a * self.c - self.b * self.b;
        let half = |k: f32| 2.0 * (k / determinant).max(0.0).sqrt();
        [half(self.c), half(self.a)]
    }

    /// `exp(-2 r^2) - exp(-2)`, 0 outside of the ellipse.
    fn weight(&self, x: f32, y: f32) -> f32 {
        const FALLOFF: f32 = 2.0;
        const AT_RIM: f32 = 0.135_335_28;
        let r_squared = self.a * x * x + self.b * x * y + self.c * y * y;
        if r_squared < 1.0 { (-FALLOFF * r_squared).exp() - AT_RIM } else { 0.0 }
    }
}
