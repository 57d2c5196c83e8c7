//! RGB colour spaces.

/// The RGB colour spaces that scene files may name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ColorSpaceName {
    /// sRGB and Rec. 709 primaries, white D65.
    #[default]
    Srgb,
    /// Display P3 primaries, white D65 (`dci-p3` in pbrt).
    DciP3,
    /// ITU-R BT.2020 primaries, white D65.
    Rec2020,
    /// ACES 2065-1 (AP0) primaries, white about D60.
    Aces2065_1,
}

impl ColorSpaceName {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Srgb, Self::DciP3, Self::Rec2020, Self::Aces2065_1];

    /// The name in scene files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Srgb => "srgb",
            Self::DciP3 => "dci-p3",
            Self::Rec2020 => "rec2020",
            Self::Aces2065_1 => "aces2065-1",
        }
    }

    /// The colour space of that name in a scene file.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|space| space.name() == name)
    }
}
