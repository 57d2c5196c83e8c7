//! Any isotropic BRDF, given by a table (SPEC BRDF-30).
//!
//! f is interpolated in a [`BrdfGrid`] over half and difference angles, in which exchanging the two directions changes
//! nothing, so that the model is reciprocal whatever the numbers (Rusinkiewicz 1998, "A New Change of Variables for
//! Efficient BRDF Representation"). What f has everywhere is its diffuse lobe, the rest the glossy one. That is
//! sampled by half vectors from tables of constant cells, one table for each of [`BrdfTable::N_VIEWS`] ranges of the
//! angle of view, mixed with a tenth of even scattering for what falls between the cells; or by [rejection].
//!
//! Colours are linear sRGB; each interpolated value becomes a spectrum of its own, as a texel does.
//!
//! Tables live as long as the process: [`BrdfTable::of`] keeps one for each different grid.

mod grid;
mod rejection;
mod table;

use etendue_math::{Point2, Vector3};
use etendue_spectrum::{ColorSpace, ColorSpaceName, Sampled, Wavelengths};

use super::classic::lobed::{Lobed, Shares};

pub use grid::BrdfGrid;
pub(super) use grid::place;
pub use table::BrdfTable;
pub(super) use table::alpha_of_half_width;

/// A table in the shading frame, at the wavelengths of a path.
#[derive(Clone, Copy, Debug)]
pub struct Tabulated {
    /// The values.
    pub table: &'static BrdfTable,
    /// Where they are wanted.
    pub lambda: Wavelengths,
    /// How directions of the glossy lobe are found.
    pub sampling: TableSampling,
}

/// How the glossy lobe of a table is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableSampling {
    /// By cells of half vectors.
    Cells,
    /// By rejection of directions spread by the cosine.
    Rejection,
}

impl PartialEq for Tabulated {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.table, other.table)
            && self.lambda == other.lambda
            && self.sampling == other.sampling
    }
}

/// The smooth spectrum of a linear sRGB colour, not negative and without upper limit, at the wavelengths of a path.
pub(crate) fn spectrum_of_color(rgb: [f32; 3], lambda: &Wavelengths) -> Sampled {
    if rgb == [0.0; 3] {
        return Sampled::ZERO;
    }
    let space = ColorSpace::get(ColorSpaceName::Srgb);
    if lambda.is_bands() {
        return lambda.of_bands(space.reflectance_bands(rgb));
    }
    let (scale, shape) = space.uplift_unbounded(rgb);
    shape.sample(lambda) * scale
}

impl Lobed for Tabulated {
    fn diffuse(&self, _to: Vector3, _from: Vector3) -> Sampled {
        spectrum_of_color(self.table.diffuse(), &self.lambda)
    }

    fn glossy(&self, to: Vector3, from: Vector3) -> Sampled {
        spectrum_of_color(self.table.glossy(to, from), &self.lambda)
    }

    fn shares(&self, _wo: Vector3) -> Shares {
        let [diffuse, glossy] = self.table.shares();
        Shares { diffuse, glossy, mirror: 0.0 }
    }

    fn sample_glossy(&self, wo: Vector3, u_choice: f32, u: Point2) -> Option<Vector3> {
        self.table.sample_glossy(self.sampling, wo, u_choice, u)
    }

    fn glossy_pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        self.table.glossy_pdf(self.sampling, wo, wi)
    }

    fn alpha(&self) -> f32 {
        self.table.alpha()
    }
}
