//! Histograms: flux counted in cells of a mesh or a picture, the older way to density (Heckbert 1990, "Adaptive Radiosity
//! Textures for Bidirectional Ray Tracing"; SPEC EST-11). To compare with: the radiance estimate needs no cells.
//!
//! `E = Φ_cell / A_cell`. The size of the cells has to be chosen before: large ones blur, small ones are noisy, and where a
//! mesh has far more triangles than photons fall on it most of them stay black.

use etendue_spectrum::Xyz;

/// Cells that count flux.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FluxHistogram {
    cells: Vec<Cell>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Cell {
    area: f64,
    n_photons: u64,
    flux: [f64; 3],
}

impl FluxHistogram {
    /// Empty cells of these areas in m^2.
    #[must_use]
    pub fn new(areas: impl IntoIterator<Item = f64>) -> Self {
        Self { cells: areas.into_iter().map(|area| Cell { area, ..Cell::default() }).collect() }
    }

    /// Number of cells.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.cells.len()
    }

    /// True if there are no cells.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// Counts a photon; nothing happens if there is no such cell.
    pub fn add(&mut self, cell: usize, power: Xyz) {
        if let Some(cell) = self.cells.get_mut(cell) {
            cell.n_photons += 1;
            for (sum, value) in cell.flux.iter_mut().zip(power.to_array()) {
                *sum += f64::from(value);
            }
        }
    }

    /// Irradiance of a cell, in flux per m^2; black for cells without area or photons.
    #[must_use]
    pub fn irradiance(&self, cell: usize) -> Xyz {
        let Some(cell) = self.cells.get(cell).filter(|cell| cell.area > 0.0) else { return Xyz::default() };
        let [x, y, z] = cell.flux.map(|flux| (flux / cell.area) as f32);
        Xyz::new(x, y, z)
    }

    /// Cells with area that no photon has met.
    #[must_use]
    pub fn n_black(&self) -> usize {
        self.cells.iter().filter(|cell| cell.area > 0.0 && cell.n_photons == 0).count()
    }
}
