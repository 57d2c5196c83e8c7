//! Inks: cyan, magenta, yellow and black on white paper (SPEC SPD-3).
//!
//! An ink that covers the share c of the paper takes that share of red, so that `red = (1 - c) (1 - k)` and so on for magenta
//! and green, yellow and blue; black takes all three. Any number of inks makes the same colour: what cyan, magenta and yellow
//! have in common may be black instead ("grey component replacement"). That is the conversion without a profile, of PostScript
//! and PDF (Adobe 1999, "PostScript Language Reference", section 7.2.3): real inks are not that pure, and printers convert by
//! profiles of their own.

use crate::{ColorSpace, ColorSpaceName, Xyz};

/// Shares of the paper that inks cover, in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cmyk {
    /// Takes red.
    pub cyan: f32,
    /// Takes green.
    pub magenta: f32,
    /// Takes blue.
    pub yellow: f32,
    /// Takes all.
    pub black: f32,
}

impl Cmyk {
    /// The inks of a colour, linear or encoded as inks are to be, with as much black as there can be. What is outside [0, 1]
    /// cannot be printed and is pulled in.
    #[must_use]
    pub fn from_rgb(rgb: [f32; 3]) -> Self {
        Self::with_black(rgb, 1.0)
    }

    /// The same with a share in [0, 1] of the black that there can be: 0 prints by three inks.
    #[must_use]
    pub fn with_black(rgb: [f32; 3], share: f32) -> Self {
        let rgb = rgb.map(|c| c.clamp(0.0, 1.0));
        let black = share.clamp(0.0, 1.0) * (1.0 - rgb[0].max(rgb[1]).max(rgb[2]));
        // Where all is black, no other ink is needed.
        let ink = |c: f32| if black < 1.0 { (1.0 - c / (1.0 - black)).max(0.0) } else { 0.0 };
        let [cyan, magenta, yellow] = rgb.map(ink);
        Self { cyan, magenta, yellow, black }
    }

    /// The inks of the linear sRGB of tristimulus values, where paper has Y = 1.
    #[must_use]
    pub fn from_xyz(xyz: Xyz) -> Self {
        Self::from_rgb(ColorSpace::get(ColorSpaceName::Srgb).to_rgb(xyz))
    }

    /// The colour that the inks leave.
    #[must_use]
    pub fn to_rgb(self) -> [f32; 3] {
        [self.cyan, self.magenta, self.yellow].map(|ink| (1.0 - ink) * (1.0 - self.black))
    }

    /// The inks in their order: cyan, magenta, yellow, black.
    #[must_use]
    pub const fn to_array(self) -> [f32; 4] {
        [self.cyan, self.magenta, self.yellow, self.black]
    }
}
