//! Pictures as what terminals understand.

use std::fmt::Write as _;

use etendue::image::Image;
use etendue::image::tonemap::{Quantization, to_u8};
use etendue::io::images::png_bytes;
use etendue::lab::plot::base64;

/// Largest piece of data in one command of kitty's protocol.
const KITTY_CHUNK: usize = 4096;
/// Levels of red, green and blue of sixels: terminals have 256 colours for them.
const LEVELS: [usize; 3] = [6, 7, 6];

/// Kitty's graphics protocol: `ESC _ G keys ; base64 ESC \`, in pieces, of which all but the last say that more follows.
pub(super) fn kitty(picture: &Image) -> Option<String> {
    let data = base64(&png_bytes(picture)?);
    let mut text = String::new();
    let mut rest = data.as_str();
    let mut keys = "a=T,f=100,q=2,";
    while !rest.is_empty() {
        let (piece, after) = rest.split_at(rest.len().min(KITTY_CHUNK));
        let more = u8::from(!after.is_empty());
        // Writing to a string cannot fail, here and below.
        let _ = write!(text, "\x1b_G{keys}m={more};{piece}\x1b\\");
        (keys, rest) = ("", after);
    }
    text.push('\n');
    Some(text)
}

/// `ESC ] 1337 ; File = keys : base64 BEL`.
pub(super) fn iterm(picture: &Image) -> Option<String> {
    let png = png_bytes(picture)?;
    let (width, height) = (picture.width, picture.height);
    let keys = format!("inline=1;size={};width={width}px;height={height}px", png.len());
    Some(format!("\x1b]1337;File={keys}:{}\x07\n", base64(&png)))
}

/// DEC's sixels: bands of six rows, each colour of a band a row of letters whose bits are its pixels, with runs counted.
pub(super) fn sixel(picture: &Image) -> Option<String> {
    let colors = indexed(picture)?;
    let (width, height) = (picture.width, picture.height);
    let mut text = format!("\x1bP0;1;0q\"1;1;{width};{height}");
    let n_colors = LEVELS.iter().product::<usize>();
    for index in 0..n_colors {
        let [r, g, b] = levels(index);
        let share = |level: usize, c: usize| (100 * level + (LEVELS[c] - 1) / 2) / (LEVELS[c] - 1);
        let _ = write!(text, "#{index};2;{};{};{}", share(r, 0), share(g, 1), share(b, 2));
    }
    for band in colors.chunks(6 * width) {
        let mut used = vec![false; n_colors];
        band.iter().for_each(|index| used[*index] = true);
        for index in (0..n_colors).filter(|index| used[*index]) {
            let _ = write!(text, "#{index}");
            push_row(&mut text, (0..width).map(|x| bits(band, width, x, index)));
            text.push('$');
        }
        text.push('-');
    }
    text.push_str("\x1b\\\n");
    Some(text)
}

/// Bits of the pixels of a colour in a column of a band, the top one lowest.
fn bits(band: &[usize], width: usize, x: usize, index: usize) -> u8 {
    let rows = band.chunks(width).enumerate();
    rows.map(|(y, row)| u8::from(row[x] == index) << y).sum()
}

/// A row of sixels; four and more alike become a count.
fn push_row(text: &mut String, row: impl Iterator<Item = u8>) {
    let mut push = |count: usize, bits: u8| {
        let letter = char::from(63 + bits);
        if count > 3 {
            let _ = write!(text, "!{count}{letter}");
        } else {
            (0..count).for_each(|_| text.push(letter));
        }
    };
    let (mut count, mut last) = (0, 0);
    for bits in row {
        if count > 0 && bits != last {
            push(count, last);
            count = 0;
        }
        (count, last) = (count + 1, bits);
    }
    push(count, last);
}

/// The nearest of the colours by level for each pixel, with errors spread by an ordered pattern.
fn indexed(picture: &Image) -> Option<Vec<usize>> {
    const BAYER: [[usize; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];
    let bytes = to_u8(picture, Quantization::default())?;
    let index = |(i, rgb): (usize, &[u8; 3])| {
        let (x, y) = (i % picture.width, i / picture.width);
        let threshold = (2 * BAYER[y % 4][x % 4] + 1) * 255 / 32;
        let level = |c: usize| (usize::from(rgb[c]) * (LEVELS[c] - 1) + threshold) / 255;
        let [r, g, b] = [0, 1, 2].map(|c| level(c).min(LEVELS[c] - 1));
        (r * LEVELS[1] + g) * LEVELS[2] + b
    };
    Some(bytes.iter().enumerate().map(index).collect())
}

/// Levels of a colour by its index.
const fn levels(index: usize) -> [usize; 3] {
    [index / (LEVELS[1] * LEVELS[2]), index / LEVELS[2] % LEVELS[1], index % LEVELS[2]]
}

/// Letters `▀`, whose upper half has the colour of one pixel and whose lower half that of the pixel below.
pub(super) fn blocks(picture: &Image) -> Option<String> {
    let bytes = to_u8(picture, Quantization::default())?;
    let rows: Vec<&[[u8; 3]]> = bytes.chunks(picture.width).collect();
    let mut text = String::new();
    for pair in rows.chunks(2) {
        for x in 0..picture.width {
            let [r, g, b] = pair[0][x];
            let _ = write!(text, "\x1b[38;2;{r};{g};{b}m");
            if let Some([r, g, b]) = pair.get(1).map(|row| row[x]) {
                let _ = write!(text, "\x1b[48;2;{r};{g};{b}m");
            }
            text.push('▀');
        }
        text.push_str("\x1b[0m\n");
    }
    Some(text)
}
