//! Writes the table of sRGB reflectances: `cargo run --release --example make_rgb_table -- data/srgb_polynomials.f32`.

use etendue_spectrum::{ColorSpace, ColorSpaceName, RgbToSpectrum};

fn main() -> std::io::Result<()> {
    let path = std::env::args().nth(1).expect("usage: make_rgb_table FILE");
    let space = ColorSpace::get(ColorSpaceName::Srgb);
    let [low, high] = RgbToSpectrum::LIMITS;
    let bytes: Vec<u8> = RgbToSpectrum::node_colors()
        .into_iter()
        .map(|rgb| rgb.map(|c| c.clamp(low, high)))
        .flat_map(|rgb| space.fit_albedo(rgb).coefficients)
        .flat_map(f32::to_le_bytes)
        .collect();
    std::fs::write(path, bytes)
}
