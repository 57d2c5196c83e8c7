//! What light travels through between surfaces: nothing, or a clear medium that absorbs.
//!
//! Over a distance d the share `exp(-sigma_a d)` is left (Bouguer's law, also Lambert's and Beer's; SPEC FRES-11). Which
//! medium it is, surfaces tell: those of transparent materials know both of their sides ([`Interface`], SPEC FRES-12), so
//! that liquid in a glass is modelled by surfaces that each separate two things, with no gap between them.

use etendue_spectrum::{Sampled, Spectrum, SpectrumTables, Wavelengths};

/// Index of a medium in [`Media`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MediumId(u32);

/// The media on the two sides of a surface; `None` is vacuum or clear air.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Interface {
    /// Where the normal does not point.
    pub inside: Option<MediumId>,
    /// Where the normal points.
    pub outside: Option<MediumId>,
}

impl Interface {
    /// The medium on the side of a direction whose cosine with the geometric normal has this sign.
    #[inline]
    #[must_use]
    pub fn towards(&self, cosine: f32) -> Option<MediumId> {
        if cosine < 0.0 { self.inside } else { self.outside }
    }
}

/// What a medium absorbs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Absorption {
    /// By its coefficient in 1/m.
    Coefficient(Spectrum),
    /// By the share of light, in [0, 1], that is left after a distance.
    Color {
        /// That share.
        color: Spectrum,
        /// The distance in metres, positive.
        distance_m: f32,
    },
}

/// All media of a scene.
#[derive(Clone, Debug, Default)]
pub struct Media {
    absorption: Vec<Absorption>,
}

impl Media {
    /// Adds a medium. One that is there already is not added again.
    pub fn add(&mut self, absorption: Absorption) -> MediumId {
        let found = self.absorption.iter().position(|known| *known == absorption);
        let index = found.unwrap_or_else(|| {
            self.absorption.push(absorption);
            self.absorption.len() - 1
        });
        MediumId(index as u32)
    }

    /// True if there are none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.absorption.is_empty()
    }

    /// The share of light that is left after a distance in metres, which may be infinite.
    #[inline]
    #[must_use]
    pub fn transmittance(
        &self,
        medium: MediumId,
        distance: f32,
        spectra: &SpectrumTables,
        lambda: &Wavelengths,
    ) -> Sampled {
        match self.absorption[medium.0 as usize] {
            Absorption::Coefficient(spectrum) => {
                let sigma_a = spectrum.sample(spectra, lambda);
                // Nothing absorbs nothing, however far.
                sigma_a.map(|sigma_a| if sigma_a > 0.0 { (-sigma_a * distance).exp() } else { 1.0 })
            }
            Absorption::Color { color, distance_m } => {
                color.sample(spectra, lambda).clamp(0.0, 1.0).powf(distance / distance_m)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn coefficient(sigma_a: f32) -> Absorption {
        Absorption::Coefficient(Spectrum::Constant(sigma_a))
    }

    /// FRES-11: two metres absorb the square of what one metre absorbs, each wavelength by its own law.
    #[test]
    fn absorption_is_exponential() {
        let mut media = Media::default();
        let grey = media.add(coefficient(0.7));
        let clear = media.add(coefficient(0.0));
        assert_eq!(media.add(coefficient(0.7)), grey);
        let (spectra, lambda) = (SpectrumTables::default(), Wavelengths::sample_visible(0.3));
        let at = |medium, distance| media.transmittance(medium, distance, &spectra, &lambda)[0];
        assert!((at(grey, 1.0) - (-0.7_f32).exp()).abs() < 1e-6);
        assert!((at(grey, 2.0) - at(grey, 1.0) * at(grey, 1.0)).abs() < 1e-6);
        assert_eq!(at(grey, f32::INFINITY), 0.0);
        assert_eq!(at(clear, f32::INFINITY), 1.0);
        // Half of the light is left after 0.2 m: the coefficient is ln 2 / 0.2.
        let color = |c| Absorption::Color { color: Spectrum::Constant(c), distance_m: 0.2 };
        let [half, black, white] = [0.5, 0.0, 1.0].map(|c| media.add(color(c)));
        let at = |medium, distance| media.transmittance(medium, distance, &spectra, &lambda)[0];
        assert!((at(half, 0.6) - 0.125).abs() < 1e-6);
        assert_eq!([at(black, 0.0), at(black, 1.0), at(white, f32::INFINITY)], [1.0, 0.0, 1.0]);
    }

    /// Sides are told apart by the geometric normal.
    #[test]
    fn sides() {
        let mut media = Media::default();
        let (water, oil) = (media.add(coefficient(0.1)), media.add(coefficient(0.2)));
        let interface = Interface { inside: Some(water), outside: Some(oil) };
        assert_eq!(interface.towards(-0.1), Some(water));
        assert_eq!(interface.towards(0.1), Some(oil));
        assert_eq!(Interface::default().towards(-1.0), None);
    }
}
