//! The directions in which a light sends flux, wherever on it the flux starts: what projection maps divide into cells
//! (SPEC EMI-10).

use etendue_math::Vector3;

use super::{Light, LightContext};

/// All directions in which a light sends flux, and roughly in what proportion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Directions {
    /// All of them, evenly or by a picture.
    Sphere,
    /// A cone.
    Cone {
        /// Unit axis.
        axis: Vector3,
        /// Cosine of the half angle.
        cos_max: f32,
    },
    /// Those on one or both sides of a plane, in proportion to the cosine to its normal.
    Cosine {
        /// Unit normal.
        axis: Vector3,
        /// Cosine of the largest angle to it.
        cos_max: f32,
        /// True if both sides emit.
        two_sided: bool,
    },
    /// One: the light comes from infinity.
    Parallel(Vector3),
    /// They depend on the place.
    Varied,
}

impl Light {
    /// In which directions the light sends flux.
    #[must_use]
    pub fn directions(&self, context: &LightContext) -> Directions {
        match self {
            Self::Point(_) | Self::Goniometric(_) | Self::Ies(_) => Directions::Sphere,
            Self::Spot(light) => Directions::Cone { axis: light.axis, cos_max: light.cos_end },
            Self::Projection(_) => self.bounds(context).map_or(Directions::Varied, |bounds| {
                // The picture's corners are the edge of the cone but for rounding.
                Directions::Cone { axis: bounds.w, cos_max: bounds.cos_theta_o - 1e-4 }
            }),
            Self::Distant(light) => Directions::Parallel(-light.to_light),
            Self::Area(light) => light.directions(context),
            Self::InfiniteConstant(_)
            | Self::InfiniteImage(_)
            | Self::InfinitePortal(_)
            | Self::Sky(_)
            | Self::Sun(_)
            | Self::MovingArea(_) => Directions::Varied,
        }
    }

    /// True if all rays of [`sample_le`](Self::sample_le) carry the same flux per wavelength, but for rounding.
    #[must_use]
    pub fn is_even(&self, context: &LightContext) -> bool {
        match self {
            Self::Point(_) | Self::Spot(_) | Self::Distant(_) => true,
            Self::Area(light) => light.is_even(context),
            _ => false,
        }
    }
}
