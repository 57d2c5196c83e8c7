//! Gradient noise and sums of it (Perlin 1985, "An Image Synthesizer"; Perlin 2002, "Improving Noise").
//!
//! Noise is 0 at all points of the integer lattice and varies over about one unit. Fractal sums
//! `sum_i omega^i noise(1.99^i p)` add finer octaves; octaves finer than two pixels are left out, since they
//! would only alias.

use etendue_math::{Point3, Vector3, lerp};

/// Perlin's permutation of 0..256.
#[rustfmt::skip]
static PERMUTATION: [u8; 256] = [
    151, 160, 137, 91, 90, 15, 131, 13, 201, 95, 96, 53, 194, 233, 7, 225, 140, 36, 103, 30, 69, 142, 8, 99, 37, 240,
    21, 10, 23, 190, 6, 148, 247, 120, 234, 75, 0, 26, 197, 62, 94, 252, 219, 203, 117, 35, 11, 32, 57, 177, 33, 88,
    237, 149, 56, 87, 174, 20, 125, 136, 171, 168, 68, 175, 74, 165, 71, 134, 139, 48, 27, 166, 77, 146, 158, 231, 83,
    111, 229, 122, 60, 211, 133, 230, 220, 105, 92, 41, 55, 46, 245, 40, 244, 102, 143, 54, 65, 25, 63, 161, 1, 216,
    80, 73, 209, 76, 132, 187, 208, 89, 18, 169, 200, 196, 135, 130, 116, 188, 159, 86, 164, 100, 109, 198, 173, 186,
    3, 64, 52, 217, 226, 250, 124, 123, 5, 202, 38, 147, 118, 126, 255, 82, 85, 212, 207, 206, 59, 227, 47, 16, 58, 17,
    182, 189, 28, 42, 223, 183, 170, 213, 119, 248, 152, 2, 44, 154, 163, 70, 221, 153, 101, 155, 167, 43, 172, 9, 129,
    22, 39, 253, 19, 98, 108, 110, 79, 113, 224, 232, 178, 185, 112, 104, 218, 246, 97, 228, 251, 34, 242, 193, 238,
    210, 144, 12, 191, 179, 162, 241, 81, 51, 145, 235, 249, 14, 239, 107, 49, 192, 214, 31, 181, 199, 106, 157, 184,
    84, 204, 176, 115, 121, 50, 45, 127, 4, 150, 254, 138, 236, 205, 93, 222, 114, 67, 29, 24, 72, 243, 141, 128, 195,
    78, 66, 215, 61, 156, 180,
];

fn permute(i: i64) -> i64 {
    i64::from(PERMUTATION[(i & 255) as usize])
}

/// Scalar product of the offset with one of twelve gradients to the edges of a cube, chosen by the lattice point.
fn gradient(cell: [i64; 3], d: Vector3) -> f32 {
    let hash = permute(permute(permute(cell[0]) + cell[1]) + cell[2]) & 15;
    let u = if hash < 8 || hash == 12 || hash == 13 { d.x } else { d.y };
    let v = if hash < 4 || hash == 12 || hash == 13 { d.y } else { d.z };
    (if hash & 1 != 0 { -u } else { u }) + (if hash & 2 != 0 { -v } else { v })
}

/// `6 t^5 - 15 t^4 + 10 t^3`: first and second derivative are 0 at both ends.
fn fade(t: f32) -> f32 {
    t * t * t * (t * (6.0 * t - 15.0) + 10.0)
}

/// Gradient noise in about [-1, 1] with mean 0.
#[must_use]
pub fn noise(p: Point3) -> f32 {
    // Beyond 2^30 an f32 has no fraction; the remainder keeps the cell representable.
    let wrap = |x: f32| x % (1u32 << 30) as f32;
    let p = Point3::new(wrap(p.x), wrap(p.y), wrap(p.z));
    let cell = [p.x.floor() as i64, p.y.floor() as i64, p.z.floor() as i64];
    let d = Vector3::new(p.x - cell[0] as f32, p.y - cell[1] as f32, p.z - cell[2] as f32);
    let corner = |x: i64, y: i64, z: i64| {
        gradient([cell[0] + x, cell[1] + y, cell[2] + z], d - Vector3::new(x as f32, y as f32, z as f32))
    };
    let wx = fade(d.x);
    let edge = |y: i64, z: i64| lerp(wx, corner(0, y, z), corner(1, y, z));
    let wy = fade(d.y);
    let face = |z: i64| lerp(wy, edge(0, z), edge(1, z));
    lerp(fade(d.z), face(0), face(1))
}

/// Hermite step from 0 at `a` to 1 at `b`.
fn smooth_step(x: f32, a: f32, b: f32) -> f32 {
    let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Frequency ratio of octaves: not 2, so that their lattices do not coincide.
const LACUNARITY: f32 = 1.99;

/// A sum of octaves of noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Octaves {
    /// Factor of the amplitude from one octave to the next (`roughness` in scene files).
    pub omega: f32,
    /// Number of octaves.
    pub count: u32,
}

impl Octaves {
    /// Octaves that are not finer than two pixels, with a fraction for the last.
    fn resolved(self, dpdx: Vector3, dpdy: Vector3) -> f32 {
        let length_squared = dpdx.length_squared().max(dpdy.length_squared());
        (-1.0 - 0.5 * length_squared.log2()).clamp(0.0, self.count as f32)
    }

    /// Fractional Brownian motion: mean 0.
    #[must_use]
    pub fn fbm(self, p: Point3, dpdx: Vector3, dpdy: Vector3) -> f32 {
        let n = self.resolved(dpdx, dpdy);
        let (mut sum, mut frequency, mut amplitude) = (0.0, 1.0, 1.0);
        let at = |frequency: f32| noise(Point3::new(p.x * frequency, p.y * frequency, p.z * frequency));
        for _ in 0..n.floor() as u32 {
            sum += amplitude * at(frequency);
            frequency *= LACUNARITY;
            amplitude *= self.omega;
        }
        sum + amplitude * smooth_step(n.fract(), 0.3, 0.7) * at(frequency)
    }

    /// Turbulence: the sum of absolute values, with creases. Octaves that are left out count with their mean, 0.2;
    /// as in pbrt-v4 the octave that is partly resolved is counted in both ways.
    #[must_use]
    pub fn turbulence(self, p: Point3, dpdx: Vector3, dpdy: Vector3) -> f32 {
        const MEAN_ABSOLUTE_NOISE: f32 = 0.2;
        let n = self.resolved(dpdx, dpdy);
        let n_whole = n.floor() as u32;
        let (mut sum, mut frequency, mut amplitude) = (0.0, 1.0, 1.0);
        let at = |frequency: f32| noise(Point3::new(p.x * frequency, p.y * frequency, p.z * frequency)).abs();
        for _ in 0..n_whole {
            sum += amplitude * at(frequency);
            frequency *= LACUNARITY;
            amplitude *= self.omega;
        }
        sum += amplitude * lerp(smooth_step(n.fract(), 0.3, 0.7), MEAN_ABSOLUTE_NOISE, at(frequency));
        for _ in n_whole..self.count {
            sum += amplitude * MEAN_ABSOLUTE_NOISE;
            amplitude *= self.omega;
        }
        sum
    }
}
