//! Densities given by tables of constant cells, sampled by inversion (SPEC MC-7): the distribution function is piecewise
//! linear; in two dimensions first the row, then the place within it. Environment maps, filters and spectra use them.
//! The absolute value of the function is taken, so that filters with negative lobes may be sampled and weighted.

mod one;
mod two;
mod windowed;

pub use one::PiecewiseConstant1;
pub use two::PiecewiseConstant2;
pub use windowed::WindowedPiecewiseConstant2;

#[cfg(test)]
mod tests;
