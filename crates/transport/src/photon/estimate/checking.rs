//! Differential checking: stop taking photons where the estimate begins to drift (Jensen and Christensen 1995, "Photon maps in
//! bidirectional Monte Carlo ray tracing of complex objects"; SPEC EST-10).
//!
//! Photons are added one by one, nearest first. Within an evenly lit area the estimate goes up and down; across an edge of the light it
//! goes one way. Where the last several changes have all one sign the radius is taken as it is then.
//!
//! Chance alone makes such runs too: at a new photon the estimate rises unless its ring of the disc is larger than the mean, so
//! with probability `1 - 1/e`. A run of 10 rises comes once in 100 photons, and stopping there takes too small a radius just because
//! it is bright. So long runs are needed, and edges blur by as many photons; filters usually do better.

/// When drift is noticed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DifferentialChecking {
    /// Photons that are always taken.
    pub min_photons: u32,
    /// Changes in one direction that are drift.
    pub run: u32,
}

/// The squared distance to stop at, if there is drift before the last photon: `photons` are squared distances in ascending order,
/// with the brightness of what each adds.
pub(super) fn drift_radius_squared(checking: DifferentialChecking, photons: &[(f32, f32)]) -> Option<f32> {
    let (mut sum, mut before, mut run, mut was_rising) = (0.0, 0.0, 0, false);
    for (n, &(distance_squared, brightness)) in photons.iter().enumerate() {
        // The photon at the rim defines the area; those within it count.
        let density = sum / distance_squared;
        sum += brightness;
        if n > checking.min_photons as usize {
            let is_rising = density > before;
            run = if is_rising == was_rising { run + 1 } else { 1 };
            was_rising = is_rising;
            if run >= checking.run {
                return Some(distance_squared);
            }
        }
        before = density;
    }
    None
}
