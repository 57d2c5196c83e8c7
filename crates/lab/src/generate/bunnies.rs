//! Two bodies given by points alone (SPEC SCENE-13, GEO-9).

use etendue_math::{Point3, Rng, Vector3};

use super::settings::{SEED, count};
use super::text::{Frame, numbers, quad, sphere};
use super::{Files, Generator, Settings};

/// The bodies.
pub(super) const GENERATOR: Generator = Generator {
    name: "bunnies",
    id: "SCENE-13",
    doc: "two rabbits of up to 35 000 points each, of glass and of wood",
    parameters: &[count("points", "34000", [100, 35_000], "points of each"), SEED],
    generate,
};

/// An ellipsoid: centre, half axes, and by how much it leans in the plane of x and y, in radians.
type Blob = ([f32; 3], [f32; 3], f32);

/// A sitting rabbit of height 1 that looks along x; y points up.
const RABBIT: [Blob; 10] = [
    // Body, chest, head, muzzle.
    ([-0.08, 0.3, 0.0], [0.36, 0.27, 0.25], 0.25),
    ([0.16, 0.38, 0.0], [0.19, 0.24, 0.19], 0.0),
    ([0.27, 0.62, 0.0], [0.17, 0.14, 0.14], -0.2),
    ([0.4, 0.58, 0.0], [0.09, 0.08, 0.08], 0.0),
    // Ears, lying back.
    ([0.13, 0.84, 0.075], [0.055, 0.21, 0.035], 0.45),
    ([0.13, 0.84, -0.075], [0.055, 0.21, 0.035], 0.45),
    // Haunches, forefeet and tail.
    ([-0.18, 0.2, 0.0], [0.22, 0.2, 0.29], 0.0),
    ([0.28, 0.07, 0.0], [0.13, 0.06, 0.16], 0.0),
    ([0.02, 0.06, 0.0], [0.22, 0.06, 0.24], 0.0),
    ([-0.46, 0.28, 0.0], [0.08, 0.08, 0.08], 0.0),
];

/// About the area of the body.
const AREA: f32 = 1.9;

/// How sharply blobs are joined: the larger the less they melt.
const SHARPNESS: f32 = 14.0;

/// A function that is 0 on the surface of the body and positive outside: `-ln(sum of exp(-k d)) / k` over the blobs, d
/// being nearly the distance from each (a smooth minimum; Quilez 2013).
fn field(p: Vector3) -> f32 {
    let sum: f32 = RABBIT.iter().map(|blob| (-SHARPNESS * distance(p, blob)).exp()).sum();
    -sum.ln() / SHARPNESS
}

/// About the distance from an ellipsoid: `(|q| - 1) |q| / |grad|`, where q is p in half axes, exact to first order.
fn distance(p: Vector3, &(centre, axes, lean): &Blob) -> f32 {
    let [x, y, z] = [p.x - centre[0], p.y - centre[1], p.z - centre[2]];
    let (sine, cosine) = lean.sin_cos();
    let local = [cosine * x - sine * y, sine * x + cosine * y, z];
    let length = |power: i32| -> f32 {
        local.iter().zip(axes).map(|(x, a)| (x / a.powi(power)).powi(2)).sum::<f32>().sqrt()
    };
    let (k0, k1) = (length(1), length(2));
    if k1 > 0.0 { k0 * (k0 - 1.0) / k1 } else { -axes[0].min(axes[1]).min(axes[2]) }
}

/// The gradient of [`field`], by differences.
fn gradient(p: Vector3) -> Vector3 {
    let h = 1e-3;
    let along = |step: Vector3| (field(p + step) - field(p - step)) / (2.0 * h);
    Vector3::new(
        along(Vector3::new(h, 0.0, 0.0)),
        along(Vector3::new(0.0, h, 0.0)),
        along(Vector3::new(0.0, 0.0, h)),
    )
}

/// Points of the surface with their normals, evenly: candidates are projected from places within a thin shell, whose
/// density on the surface is even, and taken if none is near (Cook 1986, dart throwing), from coarse to fine.
fn surface_points(n: usize, seed: u32) -> Vec<(Point3, Vector3)> {
    let mut rng = Rng::new(u64::from(seed), 13);
    // Disks of half this radius cover 0.38 of the area, where darts still find gaps soon; they end at 0.55.
    let mut radius = 0.7 * (AREA / n as f32).sqrt();
    let mut points: Vec<(Point3, Vector3)> = Vec::with_capacity(n);
    let mut grid = Near::new(radius);
    let mut misses = 0;
    while points.len() < n {
        let p = Vector3::new(
            1.2 * rng.next_f32() - 0.6,
            1.1 * rng.next_f32() - 0.02,
            0.7 * rng.next_f32() - 0.35,
        );
        if field(p).abs() > 0.02 {
            continue;
        }
        let (p, normal) = project(p);
        if grid.holds(p, radius) {
            misses += 1;
            // Hardly any gap is left for disks of this size.
            if misses > 6 * n {
                radius *= 0.93;
                misses = 0;
            }
            continue;
        }
        grid.add(p);
        points.push((Point3::splat(0.0) + p, normal));
    }
    points
}

/// The nearest point of the surface, by Newton's steps along the gradient, and its normal.
fn project(mut p: Vector3) -> (Vector3, Vector3) {
    for _ in 0..3 {
        let g = gradient(p);
        p = p - g * (field(p) / g.dot(g).max(1e-6));
    }
    let g = gradient(p);
    (p, g / g.length().max(1e-6))
}

/// Points in cells, to look for near ones.
struct Near {
    cell: f32,
    cells: std::collections::HashMap<[i32; 3], Vec<Vector3>>,
}

impl Near {
    fn new(cell: f32) -> Self {
        Self { cell, cells: std::collections::HashMap::new() }
    }

    fn key(&self, p: Vector3) -> [i32; 3] {
        [p.x, p.y, p.z].map(|x| (x / self.cell).floor() as i32)
    }

    fn add(&mut self, p: Vector3) {
        self.cells.entry(self.key(p)).or_default().push(p);
    }

    /// Whether a point lies within a distance, which is at most the size of a cell.
    fn holds(&self, p: Vector3, distance: f32) -> bool {
        let [x, y, z] = self.key(p);
        let near = (0..27).map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
        near.filter_map(|key| self.cells.get(&key)).flatten().any(|q| (*q - p).length() < distance)
    }
}

fn generate(settings: &Settings) -> Files {
    let n = settings.count("points") as usize;
    let points = surface_points(n, settings.count("seed"));
    let positions: Vec<f32> = points.iter().flat_map(|(p, _)| [p.x, p.y, p.z]).collect();
    let normals: Vec<f32> = points.iter().flat_map(|(_, n)| [n.x, n.y, n.z]).collect();
    let frame =
        Frame { name: "bunnies", resolution: [640, 480], exposure_s: 0.006, samples: 1024, max_depth: 16 };
    // Disks that overlap their neighbours.
    let radius = 2.0 * (AREA / n as f32).sqrt();
    let text = format!(
        r#"# A rabbit of glass and one of wood, {n} points each (SPEC SCENE-13). There are no triangles: a ray meets the disks
# around the points, and position and normal are means over those that it crosses (Schaufler and Jensen 2000). The glass
# throws a caustic onto the wood.
#
# The body is ten ellipsoids that melt into each other, sampled evenly; it is ours, and only as large as the notebook's
# rabbit. Lengths are in metres; x grows to the right, y upwards, z into the picture.

LookAt 0.5 1.05 -3.1   0.05 0.42 0   0 1 0
Camera "perspective" "float fov" [ 34 ]
{frame}
WorldBegin

LightSource "infinite" "float illuminance" [ 60 ]

Material "diffuse" "rgb reflectance" [ 0.6 0.6 0.58 ]
{floor}
AttributeBegin
  Translate -0.62 0 -0.12
  Rotate -18 0 1 0
  Material "dielectric" "float eta" [ 1.5 ]
  Include "bunnies-points.pbrt"
AttributeEnd

AttributeBegin
  Translate 0.62 0 0.16
  Rotate 200 0 1 0
  Material "coateddiffuse" "rgb reflectance" [ 0.45 0.24 0.1 ] "float roughness" [ 0.3 ]
  Include "bunnies-points.pbrt"
AttributeEnd

AttributeBegin
  Material "diffuse" "rgb reflectance" [ 0 0 0 ]
  AreaLightSource "diffuse" "float power" [ 6000 ]
  {lamp}AttributeEnd
"#,
        frame = frame.text(),
        floor = quad([-6.0, 0.0, -6.0], [6.0, 0.0, -6.0], [-6.0, 0.0, 6.0], [6.0, 0.0, 6.0]),
        lamp = sphere([-2.1, 2.2, -0.5], 0.25),
    );
    let body = format!(
        "# Points of the body with their normals.\nShape \"points\" \"float radius\" [ {radius} ]\n  \"point3 P\" [ {} ]\n  \
         \"normal N\" [ {} ]\n",
        numbers(&positions),
        numbers(&normals)
    );
    Files::of_text("bunnies", text).with_bytes("bunnies-points.pbrt", body.into_bytes())
}
