//! Measured reflection: tables of spectra in the coordinates in which a surface of facets would be even.
//!
//! For each of some directions of incidence a density of visible facets maps the unit square to facets m, and so to directions
//! `wi = 2 (wo·m) m - wo`. What was measured lies in that square, where it is smooth, relative to what facets alone would
//! reflect: `f cos_i = spectra(u) D(m) / (4 sigma(wo))`, with u the point of the square that is mapped to m, D the density
//! of facets and sigma their projected area. A second density in the square, in proportion to the luminance there, makes
//! samples follow f (Dupuy and Jakob 2018, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering",
//! doi:10.1145/3272127.3275059). Angles of facets and of wo lie in unit squares as `x = sqrt(2 theta / pi)` and
//! `y = phi / (2 pi) + 1/2`, so that `dm = 2 pi² x sin(theta) dx dy`; of isotropic materials phi counts from wo.
//!
//! Between measured directions and wavelengths everything is linear, beyond them constant. Light that bounces below the
//! surface goes both ways alike, but interpolation does not know that: tables are not quite reciprocal.

mod data;
mod maps;
mod table;
mod tabulate;

use etendue_math::{Point2, Vector3};
use etendue_spectrum::{Sampled, Wavelengths};

use super::classic::lobed::{Lobed, Shares};

pub use data::{MeasuredBrdf, MeasuredFault, MeasuredParts};
pub use maps::Maps;
pub use table::MeasuredTable;
pub use tabulate::MeasuredGrid;

/// A measured BRDF in the shading frame, at the wavelengths of a path.
#[derive(Clone, Copy, Debug)]
pub struct Measured {
    /// The measurement.
    pub table: &'static MeasuredTable,
    /// Where it is wanted.
    pub lambda: Wavelengths,
}

impl PartialEq for Measured {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.table, other.table) && self.lambda == other.lambda
    }
}

impl Lobed for Measured {
    fn glossy(&self, to: Vector3, from: Vector3) -> Sampled {
        self.table.eval(to, from, &self.lambda)
    }

    fn shares(&self, _wo: Vector3) -> Shares {
        Shares { glossy: 1.0, ..Shares::default() }
    }

    fn sample_glossy(&self, wo: Vector3, _u_choice: f32, u: Point2) -> Option<Vector3> {
        self.table.sample(wo, u)
    }

    fn glossy_pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        self.table.pdf(wo, wi)
    }

    fn alpha(&self) -> f32 {
        self.table.alpha()
    }
}
