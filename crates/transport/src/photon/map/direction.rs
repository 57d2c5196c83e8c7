//! A direction in two bytes: its angles in 256 steps each, and tables to read them (SPEC KD-4).
//!
//! The first byte counts `theta`, the angle to the z axis, in steps of pi/256, the second `phi`, that around it, in steps of
//! 2 pi/256. A direction is read as the centre of its cell, less than 0.79 degrees away; the corner that the book's tables
//! have is up to 1.58 degrees away.

use std::f32::consts::{PI, TAU};
use std::sync::LazyLock;

use etendue_math::Vector3;
use etendue_math::approx::{acos, atan2};

/// Steps of an angle.
const N: usize = 256;

/// Cosine and sine of the middle of each step.
struct Tables {
    theta: [(f32, f32); N],
    phi: [(f32, f32); N],
}

static TABLES: LazyLock<Tables> = LazyLock::new(|| {
    let middles = |range: f64| {
        std::array::from_fn(|i| {
            let (sin, cos) = ((i as f64 + 0.5) * range / N as f64).sin_cos();
            (cos as f32, sin as f32)
        })
    };
    Tables { theta: middles(std::f64::consts::PI), phi: middles(std::f64::consts::TAU) }
});

/// The bytes of a unit vector: theta and phi.
#[must_use]
pub(super) fn encode(d: Vector3) -> [u8; 2] {
    let step = |angle: f32, range: f32| (angle * (N as f32 / range)).floor();
    let theta = step(acos(d.z.clamp(-1.0, 1.0)), PI).min(255.0);
    let phi = step(atan2(d.y, d.x), TAU) as i32;
    [theta as u8, phi.rem_euclid(N as i32) as u8]
}

/// The unit vector in the middle of a cell.
#[inline]
#[must_use]
pub(super) fn decode([theta, phi]: [u8; 2]) -> Vector3 {
    let tables = &*TABLES;
    let (cos_theta, sin_theta) = tables.theta[usize::from(theta)];
    let (cos_phi, sin_phi) = tables.phi[usize::from(phi)];
    Vector3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta)
}

#[cfg(test)]
mod tests {
    use etendue_math::{Rng, warp};

    use super::*;

    /// A direction is read less than half the diagonal of a cell away, and has length 1.
    #[test]
    fn error_is_below_four_fifths_of_a_degree() {
        let mut rng = Rng::new(1, 0);
        let mut greatest = 0.0_f32;
        for _ in 0..100_000 {
            let d = warp::sample_uniform_sphere(rng.next_point2());
            let read = decode(encode(d));
            assert!((read.length() - 1.0).abs() < 1e-6);
            greatest = greatest.max(read.angle_between(d).to_degrees());
        }
        assert!((0.75..0.79).contains(&greatest), "{greatest}");
    }

    /// Every cell is read as a direction of that cell, and both ends of the axes have one.
    #[test]
    fn cells() {
        for theta in 0..=255 {
            for phi in 0..=255 {
                assert_eq!(encode(decode([theta, phi])), [theta, phi]);
            }
        }
        let signs = [-1.0, -0.0, 0.0, 1.0];
        for x in signs {
            for y in signs {
                for z in signs {
                    if let Some(d) = Vector3::new(x, y, z).try_normalized() {
                        assert!(decode(encode(d)).angle_between(d).to_degrees() < 0.79, "{d:?}");
                    }
                }
            }
        }
    }
}
