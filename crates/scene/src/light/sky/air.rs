//! The clear air around the earth: molecules, haze and ozone by height, and how much of each a ray goes through.
//!
//! All three are spread over spherical shells, so that a low sun is still seen through air of the right length (Chapman
//! 1931): exponentially for molecules (scale height 8.4 km) and haze (1.2 km, as in Bruneton and Neyret 2008,
//! "Precomputed Atmospheric Scattering"), as a triangle around 25 km for ozone. Rays are straight.

use etendue_spectrum::atmosphere;

/// Radius of the earth in km.
const EARTH_KM: f64 = 6371.0;
/// Height above which there is no air, in km; 7e-5 of the molecules would be there.
pub(super) const TOP_KM: f64 = 80.0;
/// Scale height of the molecules in km.
const MOLECULES_KM: f64 = 8.4;
/// Scale height of haze in km.
const HAZE_KM: f64 = 1.2;
/// Middle and half width of the ozone in km.
const OZONE_KM: (f64, f64) = (25.0, 15.0);

/// Amounts of molecules, haze and ozone: the share per km at a height, or along a ray in multiples of the whole of a
/// vertical path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Amounts(pub(super) [f64; 3]);

impl Amounts {
    /// At a height in km, per km.
    pub(super) fn at(height_km: f64) -> Self {
        let h = height_km.max(0.0);
        let (middle, half_width) = OZONE_KM;
        let ozone = (1.0 - (h - middle).abs() / half_width).max(0.0) / half_width;
        Self([(-h / MOLECULES_KM).exp() / MOLECULES_KM, (-h / HAZE_KM).exp() / HAZE_KM, ozone])
    }

    /// Between two heights in km on a vertical path.
    pub(super) fn between(low_km: f64, high_km: f64) -> Self {
        // Four panels are exact to 1e-4 for the layers of at most 20 km that are asked for.
        const N: usize = 4;
        let step = (high_km - low_km) / N as f64;
        (0..N).fold(Self::default(), |sum, i| {
            let low = low_km + i as f64 * step;
            let simpson = Self::at(low).plus(Self::at(low + step / 2.0), 4.0).plus(Self::at(low + step), 1.0);
            sum.plus(simpson, step / 6.0)
        })
    }

    pub(super) fn plus(self, other: Self, factor: f64) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + factor * other.0[i]))
    }

    /// From a point at a height in km to space, in a direction with that cosine to the vertical; `None` if the earth is
    /// in the way.
    pub(super) fn to_space(height_km: f64, cosine: f64) -> Option<Self> {
        let r = EARTH_KM + height_km;
        let nearest = r * (1.0 - cosine * cosine).max(0.0).sqrt();
        if cosine < 0.0 && nearest < EARTH_KM {
            return None;
        }
        let end = (EARTH_KM + TOP_KM).powi(2) - nearest * nearest;
        if end <= 0.0 {
            return Some(Self::default());
        }
        // Along the ray from where it is nearest to the earth.
        let (start, end) = (r * cosine, end.sqrt());
        if start >= 0.0 {
            return Some(Self::along(nearest, start, end));
        }
        Some(Self::along(nearest, 0.0, end).plus(Self::along(nearest, 0.0, -start), 1.0))
    }

    /// Along a straight line that passes the centre of the earth at a distance, between distances from its nearest point.
    fn along(nearest_km: f64, start: f64, end: f64) -> Self {
        const N: usize = 32;
        // Points are dense at the start, where the air is: s = start + (end - start) x^2.
        (0..N).fold(Self::default(), |sum, i| {
            let x = (i as f64 + 0.5) / N as f64;
            let s = start + (end - start) * x * x;
            let height = nearest_km.hypot(s) - EARTH_KM;
            sum.plus(Self::at(height), 2.0 * x * (end - start) / N as f64)
        })
    }
}

/// A point on a ray from the ground.
#[derive(Clone, Copy, Debug)]
pub(super) struct RayPoint {
    /// Height in km.
    pub(super) height_km: f64,
    /// Cosine of the ray's direction to the vertical of this point.
    pub(super) cosine: f64,
    /// Cosine of the sun's direction to the vertical of this point.
    pub(super) sun_cosine: f64,
}

impl RayPoint {
    /// At a distance in km along a ray from sea level with that cosine to the vertical, where `sun_cosine` is the sun's
    /// cosine at the start and `between` that of the angle between ray and sun.
    pub(super) fn at(distance_km: f64, cosine: f64, sun_cosine: f64, between: f64) -> Self {
        let r2 = EARTH_KM * EARTH_KM + distance_km * (distance_km + 2.0 * EARTH_KM * cosine);
        let r = r2.sqrt();
        Self {
            height_km: r - EARTH_KM,
            cosine: (EARTH_KM * cosine + distance_km) / r,
            sun_cosine: ((EARTH_KM * sun_cosine + distance_km * between) / r).clamp(-1.0, 1.0),
        }
    }
}

/// Distance in km from sea level to where the air ends, in a direction of that cosine to the vertical, at least 0.
pub(super) fn distance_to_top(cosine: f64) -> f64 {
    let b = EARTH_KM * cosine;
    (b * b + TOP_KM * (TOP_KM + 2.0 * EARTH_KM)).sqrt() - b
}

/// What the air does to light of one wavelength.
#[derive(Clone, Copy, Debug)]
pub(super) struct Optics {
    /// Optical depths of molecules, haze and ozone on a vertical path.
    pub(super) depths: [f64; 3],
}

/// Share of the light that haze takes which it scatters: rural haze (Shettle and Fenn 1979, "Models for the Aerosols of
/// the Lower Atmosphere").
pub(super) const HAZE_ALBEDO: f64 = 0.94;
/// Mean cosine of scattering by haze, of the same models at middle humidity.
pub(super) const HAZE_ASYMMETRY: f64 = 0.7;

impl Optics {
    pub(super) fn new(nm: f64, turbidity: f64, ozone_du: f64) -> Self {
        let depths = [
            atmosphere::rayleigh_optical_depth(nm),
            atmosphere::aerosol_optical_depth(nm, turbidity),
            atmosphere::ozone_optical_depth(nm, ozone_du),
        ];
        Self { depths }
    }

    /// Optical depth of so much air.
    pub(super) fn depth(&self, amounts: Amounts) -> f64 {
        (0..3).map(|i| self.depths[i] * amounts.0[i]).sum()
    }

    /// What molecules and haze scatter, of amounts along or per length.
    pub(super) fn scattering(&self, amounts: Amounts) -> [f64; 2] {
        [self.depths[0] * amounts.0[0], HAZE_ALBEDO * self.depths[1] * amounts.0[1]]
    }
}

/// Phase functions of molecules and haze, per steradian, by the cosine of the angle of deflection: Rayleigh's, and that of
/// Henyey and Greenstein 1941.
pub(super) fn phase(cosine: f64) -> [f64; 2] {
    use std::f64::consts::PI;
    let g = HAZE_ASYMMETRY;
    let rayleigh = 3.0 / (16.0 * PI) * (1.0 + cosine * cosine);
    [rayleigh, (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * cosine).powf(1.5))]
}
