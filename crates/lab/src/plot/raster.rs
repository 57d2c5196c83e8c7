//! Drawing into pixels, with letters made of strokes: no font has to be there.

use std::convert::Infallible;

use etendue_image::Image;
use plotters::prelude::DrawingBackend;
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingErrorKind, FontTransform,
};

/// Pixels as a plot sees them: encoded values of red, green and blue in [0, 1], row by row.
pub(super) struct Raster<'p> {
    pixels: &'p mut [[f32; 3]],
    width: usize,
}

/// The picture of such pixels, in linear light.
pub(super) fn image(pixels: Vec<[f32; 3]>, width: usize) -> Image {
    let decode = |c: f32| if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
    let height = pixels.len() / width.max(1);
    Image::rgb(width, height, pixels.into_iter().map(|pixel| pixel.map(decode)).collect())
}

/// Puts a picture into another one, its upper left corner at `[x, y]`; what does not fit is cut off.
pub(super) fn paste(image: &mut Image, picture: &Image, [x, y]: [u32; 2]) {
    let (Some(mut pixels), Some(from)) = (image.rgb_pixels(), picture.rgb_pixels()) else { return };
    let (x, y) = (x as usize, y as usize);
    let n = picture.width.min(image.width.saturating_sub(x));
    for row in 0..picture.height.min(image.height.saturating_sub(y)) {
        let to = (y + row) * image.width + x;
        pixels[to..to + n].copy_from_slice(&from[row * picture.width..row * picture.width + n]);
    }
    image.set_rgb("", &pixels);
}

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

impl<'p> Raster<'p> {
    pub(super) const fn new(pixels: &'p mut [[f32; 3]], width: usize) -> Self {
        Self { pixels, width }
    }

    fn blend(&mut self, (x, y): BackendCoord, color: BackendColor, coverage: f64) {
        let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y)) else { return };
        if x >= self.width {
            return;
        }
        let Some(pixel) = self.pixels.get_mut(y * self.width + x) else { return };
        let alpha = (color.alpha * coverage) as f32;
        let (r, g, b) = color.rgb;
        for (value, target) in pixel.iter_mut().zip([r, g, b]) {
            *value += alpha * (f32::from(target) / 255.0 - *value);
        }
    }

    /// A line with round ends: each pixel is covered by its distance.
    fn segment(&mut self, a: [f64; 2], b: [f64; 2], half_width: f64, color: BackendColor) {
        let d = [b[0] - a[0], b[1] - a[1]];
        let length2 = (d[0] * d[0] + d[1] * d[1]).max(1e-12);
        let reach = half_width + 1.0;
        let range =
            |i: usize| ((a[i].min(b[i]) - reach).floor() as i32)..=((a[i].max(b[i]) + reach).ceil() as i32);
        for y in range(1) {
            for x in range(0) {
                let p = [f64::from(x) - a[0], f64::from(y) - a[1]];
                let t = ((p[0] * d[0] + p[1] * d[1]) / length2).clamp(0.0, 1.0);
                let distance = (p[0] - t * d[0]).hypot(p[1] - t * d[1]);
                let coverage = (half_width + 0.5 - distance).clamp(0.0, 1.0);
                if coverage > 0.0 {
                    self.blend((x, y), color, coverage);
                }
            }
        }
    }

    /// The strokes of a line of text, from the upper left corner of its box.
    fn strokes(&mut self, text: &str, size: f64, color: BackendColor, place: impl Fn(f64, f64) -> [f64; 2]) {
        let unit = size / 1.24 / 1.24 / 6.5;
        for (index, c) in text.chars().enumerate() {
            let left = ADVANCE * size * index as f64;
            let at = |pair: &[u8]| {
                let [x, y] = [pair[0], pair[1]].map(|digit| f64::from(digit - b'0'));
                place(left + 0.85 * unit * x, unit * (y + 0.5))
            };
            for stroke in glyph(c).split(' ') {
                let points: Vec<[f64; 2]> = stroke.as_bytes().chunks_exact(2).map(at).collect();
                for pair in points.windows(2) {
                    self.segment(pair[0], pair[1], 0.045 * size, color);
                }
            }
        }
    }
}

fn middle((x, y): BackendCoord) -> [f64; 2] {
    [f64::from(x), f64::from(y)]
}

impl DrawingBackend for Raster<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        (self.width as u32, (self.pixels.len() / self.width.max(1)) as u32)
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        Ok(())
    }

    fn draw_pixel(&mut self, point: BackendCoord, color: BackendColor) -> Drawn {
        self.blend(point, color, 1.0);
        Ok(())
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> Drawn {
        self.segment(middle(from), middle(to), 0.5 * f64::from(style.stroke_width()), style.color());
        Ok(())
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Drawn {
        let points: Vec<BackendCoord> = path.into_iter().collect();
        points.windows(2).try_for_each(|pair| self.draw_line(pair[0], pair[1], style))
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        let (width, height) = text_size(text, style.size());
        Ok((width.round() as u32, height.round() as u32))
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, pos: BackendCoord) -> Drawn {
        let (width, height) = text_size(text, style.size());
        let dx = match style.anchor().h_pos {
            HPos::Left => 0.0,
            HPos::Right => -width,
            HPos::Center => -0.5 * width,
        };
        let dy = match style.anchor().v_pos {
            VPos::Top => 0.0,
            VPos::Center => -0.5 * height,
            VPos::Bottom => -height,
        };
        let transform = style.transform();
        let [x0, y0] = middle(pos);
        let place = |x: f64, y: f64| {
            let (x, y) = (x + dx, y + dy);
            match transform {
                FontTransform::None => [x0 + x, y0 + y],
                FontTransform::Rotate90 => [x0 - y, y0 + x],
                FontTransform::Rotate180 => [x0 - x, y0 - y],
                FontTransform::Rotate270 => [x0 + y, y0 - x],
            }
        };
        self.strokes(text, style.size(), style.color(), place);
        Ok(())
    }
}

/// Width of a letter with the gap to the next, as a share of the size of the font.
const ADVANCE: f64 = 0.44;

fn text_size(text: &str, size: f64) -> (f64, f64) {
    (ADVANCE * size * text.chars().count() as f64, size / 1.24)
}

/// Strokes of a letter, as pairs of digits x and y: capitals stand between y = 0 and the base line at y = 6, and are 4
/// wide. Letters without strokes are blank.
fn glyph(c: char) -> &'static str {
    match c {
        'A' => "062046 1434",
        'B' => "00063645443303 3342413000",
        'C' => "4130100105163645",
        'D' => "00062644422000",
        'E' => "40000646 0333",
        'F' => "400006 0333",
        'G' => "41301001051636454323",
        'H' => "0006 4046 0343",
        'I' => "1030 2026 1636",
        'J' => "4045361605",
        'K' => "0006 4003 0346",
        'L' => "000646",
        'M' => "0600234046",
        'N' => "06004640",
        'O' => "100105163645413010",
        'P' => "06003041423303",
        'Q' => "100105163645413010 2446",
        'R' => "06003041423303 2346",
        'S' => "413010010213334445361605",
        'T' => "0040 2026",
        'U' => "000516364540",
        'V' => "002640",
        'W' => "0016233640",
        'X' => "0046 4006",
        'Y' => "002340 2326",
        'Z' => "00400646",
        'a' => "13334446 441405163645",
        'b' => "0006 0413334445361605",
        'c' => "4333130405163645",
        'd' => "4046 4433130405163645",
        'e' => "044433130405163645",
        'f' => "40302126 1343",
        'g' => "43473818 4433130405163645",
        'h' => "0006 0413334446",
        'i' => "2326 2122",
        'j' => "33372818 3132",
        'k' => "0006 4304 1446",
        'l' => "10202536",
        'm' => "0306 041323 2326 23334446",
        'n' => "0306 0413334446",
        'o' => "130405163645443313",
        'p' => "0308 0413334445361605",
        'q' => "4348 4433130405163645",
        'r' => "0306 04133344",
        's' => "43130434453606",
        't' => "21253646 1343",
        'u' => "0305163645 4346",
        'v' => "032643",
        'w' => "0316243643",
        'x' => "0346 4306",
        'y' => "0326 431806",
        'z' => "03430646",
        '0' => "100105163645413010 1531",
        '1' => "112026 1636",
        '2' => "0110304142060646",
        '3' => "01103041423313 334445361605",
        '4' => "36300444",
        '5' => "400003334445361605",
        '6' => "30100105163645443303",
        '7' => "004016",
        '8' => "100102133342413010 1304051636454433",
        '9' => "43130201103041453616",
        '.' => "2526",
        ',' => "251708",
        ':' => "2223 2526",
        ';' => "2223 2517",
        '-' | '–' => "1333",
        '+' => "0343 2125",
        '=' => "0242 0444",
        '/' => "4006",
        '(' => "30212536",
        ')' => "10212516",
        '[' => "30101636",
        ']' => "10303616",
        '<' => "410345",
        '>' => "014305",
        '|' => "2026",
        '_' => "0747",
        '%' => "4006 0010110100 3545463635",
        '\'' => "2022",
        '"' => "1012 3032",
        '*' => "0145 4105 2026",
        '!' => "2024 2526",
        '?' => "01103041422324 2526",
        '°' => "1001122110",
        '±' => "0343 2125 0646",
        '√' => "03142640",
        _ => "",
    }
}
