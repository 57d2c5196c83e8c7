//! What a lens is made of: its surfaces from front to rear.

use std::fmt;

/// Most surfaces of a lens; zoom lenses have some 50.
const MOST_SURFACES: usize = 200;

/// A surface of rotation about the optical axis, or the stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LensSurface {
    /// Radius of the sphere in metres, positive if its centre is on the film's side; 0 for the aperture stop.
    pub radius_m: f32,
    /// Distance along the axis to the next surface, towards the film, in metres. That of the last follows from the focus.
    pub thickness_m: f32,
    /// Index of refraction between this surface and the next.
    pub eta: f32,
    /// Diameter of what is clear, in metres.
    pub diameter_m: f32,
}

impl LensSurface {
    /// True for the aperture stop.
    #[must_use]
    pub fn is_stop(&self) -> bool {
        self.radius_m == 0.0
    }
}

/// Why surfaces do not make a lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LensFault {
    /// There is none that refracts.
    Empty,
    /// There are too many.
    Many,
    /// A number that is not finite.
    Number(usize),
    /// A negative distance to the next surface.
    Thickness(usize),
    /// An index of refraction that is neither 0 (air) nor between 1 and 5.
    Eta(usize),
    /// A diameter that is not positive.
    Diameter(usize),
    /// A diameter above that of its sphere.
    Sphere(usize),
    /// A second stop.
    Stop(usize),
    /// The last surface has glass behind it.
    Immersed(usize),
    /// The lens spreads light, or does not bend it.
    Diverging,
}

impl LensFault {
    /// The surface that is at fault, by its number from 0.
    #[must_use]
    pub const fn surface(self) -> Option<usize> {
        match self {
            Self::Empty | Self::Many | Self::Diverging => None,
            Self::Number(i)
            | Self::Thickness(i)
            | Self::Eta(i)
            | Self::Diameter(i)
            | Self::Sphere(i)
            | Self::Stop(i)
            | Self::Immersed(i) => Some(i),
        }
    }
}

impl fmt::Display for LensFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Empty => "there is no surface that refracts",
            Self::Many => "there are more than 200 surfaces",
            Self::Number(_) => "a number is not finite",
            Self::Thickness(_) => "the distance to the next surface is negative",
            Self::Eta(_) => "the index of refraction should be between 1 and 5, or 0 for air",
            Self::Diameter(_) => "the diameter should be positive",
            Self::Sphere(_) => "the diameter is larger than that of the sphere, which is twice the radius",
            Self::Stop(_) => "this is a second stop (a surface of radius 0)",
            Self::Immersed(_) => "the last surface should have air behind it",
            Self::Diverging => "the lens as a whole does not gather light",
        })
    }
}

impl std::error::Error for LensFault {}

/// The surfaces of a lens from front to rear, at most one of which is a stop.
#[derive(Clone, Debug, PartialEq)]
pub struct LensPrescription {
    surfaces: Vec<LensSurface>,
}

impl LensPrescription {
    /// Checks the surfaces; an index of 0 is taken as air.
    ///
    /// # Errors
    /// If no lens has such surfaces.
    pub fn new(mut surfaces: Vec<LensSurface>) -> Result<Self, LensFault> {
        if surfaces.len() > MOST_SURFACES {
            return Err(LensFault::Many);
        }
        let mut has_stop = false;
        let last = surfaces.len().saturating_sub(1);
        for (i, surface) in surfaces.iter_mut().enumerate() {
            if surface.eta == 0.0 {
                surface.eta = 1.0;
            }
            let LensSurface { radius_m, thickness_m, eta, diameter_m } = *surface;
            let fault = if ![radius_m, thickness_m, eta, diameter_m].iter().all(|x| x.is_finite()) {
                Some(LensFault::Number(i))
            } else if thickness_m < 0.0 && i < last {
                Some(LensFault::Thickness(i))
            } else if !(1.0..=5.0).contains(&eta) {
                Some(LensFault::Eta(i))
            } else if diameter_m <= 0.0 {
                Some(LensFault::Diameter(i))
            } else if surface.is_stop() {
                std::mem::replace(&mut has_stop, true).then_some(LensFault::Stop(i))
            } else {
                (diameter_m > 2.000_001 * radius_m.abs()).then_some(LensFault::Sphere(i))
            };
            if let Some(fault) = fault {
                return Err(fault);
            }
        }
        if surfaces.iter().all(LensSurface::is_stop) {
            return Err(LensFault::Empty);
        }
        if surfaces[last].eta != 1.0 {
            return Err(LensFault::Immersed(last));
        }
        let lens = Self { surfaces };
        let focal_length = super::Paraxial::new(&lens).focal_length_m();
        if focal_length > 0.0 && focal_length < 1e4 { Ok(lens) } else { Err(LensFault::Diverging) }
    }

    /// The surfaces from front to rear.
    #[must_use]
    pub fn surfaces(&self) -> &[LensSurface] {
        &self.surfaces
    }

    /// The stop, if there is one.
    #[must_use]
    pub fn stop(&self) -> Option<&LensSurface> {
        self.surfaces.iter().find(|surface| surface.is_stop())
    }

    /// The same lens scaled by a factor: prescriptions are often for a focal length of 1.
    #[must_use]
    pub fn scaled(&self, factor: f32) -> Self {
        let scale = |s: &LensSurface| LensSurface {
            radius_m: s.radius_m * factor,
            thickness_m: s.thickness_m * factor,
            diameter_m: s.diameter_m * factor,
            eta: s.eta,
        };
        Self { surfaces: self.surfaces.iter().map(scale).collect() }
    }
}
