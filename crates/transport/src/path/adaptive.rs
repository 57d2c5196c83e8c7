//! Adaptive interpolation of pixels (SPEC CAM-6; Mitchell 1987, "Generating Antialiased Images at Low Sampling Densities",
//! https://doi.org/10.1145/37401.37410): paths for some pixels of a pass, and means of these where they hardly differ.
//!
//! In each pass a lattice of pixels is traced. Where the corners of one of its cells agree, in every wavelength, to a contrast
//!
//! ```text
//! (I_max - I_min) / (I_max + I_min)    of at most 0.4 (red), 0.3 (green), 0.6 (blue)
//! ```
//!
//! the pixels between get the bilinear mean; other cells are divided until there is nothing between. The paths of all pixels
//! of a pass have the same random numbers, so that their noise is the same and contrast is that of the scene; it averages out
//! from pass to pass as ever, but as one pattern over the image. The lattice shifts from pass to pass.
//!
//! Interpolation is biased: edges and textures of less than the threshold are blurred, and what is thinner than a cell is
//! found only in passes in which it covers a corner of the lattice, or of a cell that something else has divided. More passes
//! do not mend this. The variance of a pixel is that of what it was given, without this bias. Tiles are filled by themselves, so
//! that any number of threads makes the same image; passes depend on their index alone.

use etendue_math::hash64;
use etendue_scene::film::{Features, PixelBounds};
use etendue_scene::parameters::{ParameterSpec, Parameters};
use etendue_spectrum::{N_LAMBDA, Sampled, Wavelengths};

/// Largest distance between neighbours of the lattice.
const MAX_BLOCK: u32 = 8;
/// Mitchell's thresholds for red, green and blue.
const CONTRAST: [f32; 3] = [0.4, 0.3, 0.6];
/// Wavelengths in nm from which light counts as green, and as red.
const GREEN_NM: f32 = 490.0;
const RED_NM: f32 = 580.0;

/// How pixels are interpolated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdaptivePixels {
    /// Pixels from one corner of the lattice to the next, at least 2.
    pub block_size: u32,
    /// Contrast of red, green and blue below which pixels are interpolated.
    pub contrast: [f32; 3],
}

/// A pixel of a pass.
#[derive(Clone, Debug)]
pub(super) struct PassPixel {
    /// Radiance, times the camera's weight.
    pub(super) radiance: Sampled,
    pub(super) lambda: Wavelengths,
    pub(super) features: Option<Features>,
}

impl AdaptivePixels {
    /// `pixels` in scene files.
    pub const PIXELS: ParameterSpec = ParameterSpec {
        name: "pixels",
        kind: "string",
        default: "all",
        unit: "",
        doc: "pixels that a pass traces: all, or adaptive (interpolates where neighbours hardly differ; biased)",
    };
    /// `contrast` in scene files.
    pub const CONTRAST: ParameterSpec = ParameterSpec {
        name: "contrast",
        kind: "float[3]",
        default: "0.4 0.3 0.6",
        unit: "",
        doc: "of adaptive pixels: contrast of red, green and blue below which they are interpolated",
    };
    /// `blocksize` in scene files.
    pub const BLOCK_SIZE: ParameterSpec = ParameterSpec {
        name: "blocksize",
        kind: "integer",
        default: "8",
        unit: "pixel",
        doc: "of adaptive pixels: distance of those that are always traced, 2 to 8",
    };

    /// Reads whether and how pixels are interpolated.
    pub fn from_parameters(p: &mut Parameters<'_, '_>) -> Option<Self> {
        let is_adaptive = p.choice("pixels", "all", &[("all", false), ("adaptive", true)]);
        let block_size = p.count_within("blocksize", MAX_BLOCK, 2, MAX_BLOCK);
        let contrast = match p.floats("contrast") {
            None => CONTRAST,
            Some(&[all]) if all >= 0.0 => [all; 3],
            Some(&[r, g, b]) if r >= 0.0 && g >= 0.0 && b >= 0.0 => [r, g, b],
            Some(_) => {
                let span = p.span_of("contrast");
                let message = "\"contrast\" takes one value or three (red, green, blue), none below 0";
                p.diagnostics().error(span, message);
                CONTRAST
            }
        };
        is_adaptive.then_some(Self { block_size, contrast })
    }

    /// The pixels of a rectangle, row by row, and the number of those that were interpolated. `trace` follows a path.
    pub(super) fn fill(
        &self,
        bounds: PixelBounds,
        pass: u64,
        trace: impl FnMut([u32; 2]) -> PassPixel,
    ) -> (Vec<PassPixel>, u64) {
        let mut tile =
            Tile { settings: self, bounds, pixels: vec![None; bounds.n_pixels()], trace, smooth: Vec::new() };
        let shift = hash64(&[pass, u64::from(self.block_size)]);
        let xs = self.lattice(bounds.min[0], bounds.max[0], shift as u32);
        let ys = self.lattice(bounds.min[1], bounds.max[1], (shift >> 32) as u32);
        for y in ys.windows(2) {
            for x in xs.windows(2) {
                tile.divide(Cell { min: [x[0], y[0]], max: [x[1], y[1]] });
            }
        }
        tile.finish()
    }

    /// Places of the lattice along an axis, from the first pixel to the last; a single one stands twice.
    fn lattice(&self, min: u32, max: u32, shift: u32) -> Vec<u32> {
        let last = max - 1;
        let first_inner = min
            + 1
            + (shift % self.block_size + self.block_size - (min + 1) % self.block_size) % self.block_size;
        let inner = (first_inner..last).step_by(self.block_size as usize);
        std::iter::once(min).chain(inner).chain(std::iter::once(last)).collect()
    }

    /// True if four pixels agree.
    fn agree(&self, corners: [&PassPixel; 4]) -> bool {
        let lambda = &corners[0].lambda;
        if corners.iter().any(|corner| corner.lambda != *lambda) {
            // Dispersion has taken some wavelengths from some of them.
            return false;
        }
        let (mut low, mut high) = (corners[0].radiance, corners[0].radiance);
        for corner in &corners[1..] {
            low = low.min(corner.radiance);
            high = high.max(corner.radiance);
        }
        (0..N_LAMBDA).filter(|&i| lambda.pdf()[i] > 0.0).all(|i| {
            let nm = lambda.lambda_nm()[i];
            let [red, green, blue] = self.contrast;
            let threshold = if nm >= RED_NM {
                red
            } else if nm >= GREEN_NM {
                green
            } else {
                blue
            };
            high[i] - low[i] <= threshold * (high[i] + low[i])
        })
    }
}

/// A rectangle between four pixels, which belong to it.
#[derive(Clone, Copy, Debug)]
struct Cell {
    min: [u32; 2],
    max: [u32; 2],
}

impl Cell {
    fn corners(self) -> [[u32; 2]; 4] {
        let Self { min, max } = self;
        [min, [max[0], min[1]], [min[0], max[1]], max]
    }

    fn size(self) -> [u32; 2] {
        [self.max[0] - self.min[0], self.max[1] - self.min[1]]
    }

    /// The parts along an axis.
    fn halves(self, axis: usize) -> Vec<[u32; 2]> {
        let (a, b) = (self.min[axis], self.max[axis]);
        if b - a <= 1 { vec![[a, b]] } else { vec![[a, (a + b) / 2], [(a + b) / 2, b]] }
    }

    /// Shares of the corners in a pixel.
    fn weights(self, pixel: [u32; 2]) -> [f32; 4] {
        let [u, v] = [0, 1].map(|axis| {
            let size = self.size()[axis];
            if size == 0 { 0.0 } else { (pixel[axis] - self.min[axis]) as f32 / size as f32 }
        });
        [(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v]
    }
}

/// A tile that is being filled.
struct Tile<'s, T> {
    settings: &'s AdaptivePixels,
    bounds: PixelBounds,
    pixels: Vec<Option<PassPixel>>,
    trace: T,
    /// Cells to interpolate.
    smooth: Vec<Cell>,
}

impl<T: FnMut([u32; 2]) -> PassPixel> Tile<'_, T> {
    /// Traces the corners of a cell and, if they do not agree, of its parts.
    fn divide(&mut self, cell: Cell) {
        for corner in cell.corners() {
            let index = self.bounds.index(corner);
            if self.pixels[index].is_none() {
                self.pixels[index] = Some((self.trace)(corner));
            }
        }
        if cell.size().iter().all(|&size| size <= 1) {
            return;
        }
        if self.corners(cell).is_some_and(|corners| self.settings.agree(corners)) {
            self.smooth.push(cell);
            return;
        }
        for y in cell.halves(1) {
            for x in cell.halves(0) {
                self.divide(Cell { min: [x[0], y[0]], max: [x[1], y[1]] });
            }
        }
    }

    fn corners(&self, cell: Cell) -> Option<[&PassPixel; 4]> {
        let [a, b, c, d] = cell.corners().map(|corner| self.pixels[self.bounds.index(corner)].as_ref());
        Some([a?, b?, c?, d?])
    }

    /// Interpolates what was not traced: on the border of two cells, the first one's value.
    fn finish(mut self) -> (Vec<PassPixel>, u64) {
        let mut n_interpolated = 0;
        for cell in std::mem::take(&mut self.smooth) {
            let Some(corners) = self.corners(cell).map(|corners| corners.map(PassPixel::clone)) else {
                continue;
            };
            for pixel in (PixelBounds { min: cell.min, max: cell.max.map(|x| x + 1) }).pixels() {
                let index = self.bounds.index(pixel);
                if self.pixels[index].is_none() {
                    self.pixels[index] = Some(mean(&corners, cell.weights(pixel)));
                    n_interpolated += 1;
                }
            }
        }
        (self.pixels.into_iter().flatten().collect(), n_interpolated)
    }
}

fn mean(corners: &[PassPixel; 4], weights: [f32; 4]) -> PassPixel {
    let parts = || corners.iter().zip(weights);
    let radiance = parts().fold(Sampled::ZERO, |sum, (corner, weight)| sum + corner.radiance * weight);
    let features = corners.iter().map(|corner| corner.features).collect::<Option<Vec<_>>>();
    let features = features.map(|features| Features::mean(&features, &weights));
    PassPixel { radiance, lambda: corners[0].lambda, features }
}

#[cfg(test)]
mod tests;
