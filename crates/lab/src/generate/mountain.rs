//! A mountain with forests: more than 200 million triangles by instances (SPEC SCENE-14).

use std::fmt::Write;

use etendue_geometry::{FractalHeights, HeightGrid};
use etendue_math::{Point3, Rng};
use etendue_scene::LoadedMesh;

use super::mesh::Grid;
use super::noise::fractal_noise;
use super::plants::fir;
use super::settings::{SEED, choice, count};
use super::sun;
use super::text::Frame;
use super::{Files, Generator, Settings};

/// The mountain.
pub(super) const GENERATOR: Generator = Generator {
    name: "mountain",
    id: "SCENE-14",
    doc: "a mountain with 13 000 trees, 213 million triangles by instances, at noon or at sunset",
    parameters: &[
        choice("time", "noon", &["noon", "sunset"], "where the sun is"),
        count("levels", "10", [2, 11], "steps of subdivision: the terrain has 2 * 4^levels triangles"),
        count("trees", "13000", [0, 1_000_000], "number of trees"),
        count("needles", "30", [1, 100], "bundles of needles on each of the 270 branches of a tree"),
        SEED,
    ],
    generate,
};

/// Side of the terrain, which is a square around the origin, in metres.
const SIZE: f32 = 6000.0;
/// Where the camera stands.
const EYE: [f32; 2] = [-150.0, -2550.0];

/// Heights over a grid.
struct Terrain {
    n: usize,
    heights: Vec<f32>,
}

impl Terrain {
    fn new(levels: u32, seed: u32) -> Self {
        let n = 1_usize << levels;
        let fractal = FractalHeights { levels, hurst: 0.95, amplitude: 6.0, seed: seed.into() };
        let fractal = HeightGrid::fractal(&fractal);
        let fractal = fractal.heights();
        let place = |k: usize| SIZE * (k as f32 / n as f32 - 0.5);
        let height = |index: usize| {
            let (x, z) = (place(index % (n + 1)), place(index / (n + 1)));
            let away = ((z + 2200.0) / 2500.0).clamp(0.0, 1.0);
            // Flat meadows near the camera, hills around, and the peak.
            260.0 * (0.15 + away) * fractal[index] + 350.0 * away * away + peak(x, z, seed)
        };
        Self { n, heights: (0..(n + 1) * (n + 1)).map(height).collect() }
    }

    /// By bilinear interpolation.
    fn height(&self, x: f32, z: f32) -> f32 {
        let scaled = |x: f32| ((x / SIZE + 0.5) * self.n as f32).clamp(0.0, self.n as f32 - 1e-3);
        let (u, v) = (scaled(x), scaled(z));
        let (i, j) = (u as usize, v as usize);
        let at = |i: usize, j: usize| self.heights[j * (self.n + 1) + i];
        let row = |j: usize| at(i, j) + (u - i as f32) * (at(i + 1, j) - at(i, j));
        row(j) + (v - j as f32) * (row(j + 1) - row(j))
    }

    /// Tangent of the angle of the steepest ascent.
    fn slope(&self, x: f32, z: f32) -> f32 {
        let step = 1.5 * SIZE / self.n as f32;
        let dx = self.height(x + step, z) - self.height(x - step, z);
        let dz = self.height(x, z + step) - self.height(x, z - step);
        dx.hypot(dz) / (2.0 * step)
    }

    fn mesh(&self) -> LoadedMesh {
        let index = |t: f32| (t * self.n as f32).round() as usize;
        // Normals point upwards.
        Grid::sheet([self.n as u32; 2]).mesh(|u, v| {
            let height = self.heights[index(u) * (self.n + 1) + index(v)];
            Point3::new(SIZE * (v - 0.5), height, SIZE * (u - 0.5))
        })
    }

    /// Colours by height and slope: forest floor and meadow, rock, snow.
    fn picture(&self, seed: u32) -> Vec<u8> {
        let n = self.n.min(1024);
        let mut picture = format!("P6\n{n} {n}\n255\n").into_bytes();
        // A row of the picture has one v of the mesh, which is x; the first one is v = 1.
        for (row, column) in (0..n).flat_map(|row| (0..n).map(move |column| (row, column))) {
            let place = |k: usize| SIZE * ((k as f32 + 0.5) / n as f32 - 0.5);
            let (x, z) = (-place(row), place(column));
            let noise = fractal_noise([x / 160.0, z / 160.0], 5, seed + 9);
            let (height, slope) = (self.height(x, z) + 260.0 * noise, self.slope(x, z) + 0.3 * noise);
            let shade = 1.0 + 0.5 * fractal_noise([x / 30.0, z / 30.0], 3, seed + 20);
            let color: [f32; 3] = if height > 850.0 && slope < 1.3 {
                [238.0, 242.0, 250.0]
            } else if slope > 0.85 || height > 800.0 {
                [118.0 * shade, 108.0 * shade, 98.0 * shade]
            } else {
                [82.0 * shade, 92.0 * shade, 50.0 * shade]
            };
            picture.extend(color.map(|level| level.clamp(0.0, 255.0) as u8));
        }
        picture
    }
}

/// A steep pyramid with ridges, bent at its top.
fn peak(x: f32, z: f32, seed: u32) -> f32 {
    let (x, z) = (x - 150.0, z - 700.0);
    let (sine, cosine) = 0.5_f32.sin_cos();
    let (a, b) = (cosine * x + sine * z, cosine * z - sine * x);
    let distance = (a.abs().powf(1.25) + b.abs().powf(1.25)).powf(0.8);
    let near = (1.0 - distance / 1500.0).max(0.0);
    let ridges = fractal_noise([x / 420.0, z / 420.0], 7, seed + 3).abs();
    1150.0 * near.powf(1.45) + 1100.0 * near * (1.15 - near) * (0.3 - ridges)
}

fn generate(settings: &Settings) -> Files {
    let seed = settings.count("seed");
    let terrain = Terrain::new(settings.count("levels"), seed);
    let kinds: Vec<LoadedMesh> = (0..3).map(|k| fir(settings.count("needles"), 100 + k)).collect();
    let n_trees = settings.count("trees");
    let is_noon = settings.word("time") == "noon";
    let sun = if is_noon { [-0.55, 0.8, -0.45] } else { [-0.95, 0.12, -0.25] };
    let stored: usize = kinds.iter().map(|tree| tree.triangles.len()).sum();
    let ground = terrain.mesh();
    let n_ground = ground.triangles.len();
    let total = n_ground + n_trees as usize * stored / kinds.len();
    let frame = Frame {
        name: "mountain",
        resolution: [800, 500],
        exposure_s: if is_noon { 0.00011 } else { 0.00045 },
        samples: 64,
        max_depth: 6,
    };
    let eye = terrain.height(EYE[0], EYE[1]) + 45.0;
    let text = format!(
        r#"# A mountain of the shape of the Little Matterhorn, at {time} (SPEC SCENE-14): {n_ground} triangles of terrain and {n_trees} trees,
# {total} triangles in sight, of which {all_stored} are stored.
#
# Lengths are in metres; x grows to the right, y upwards, z into the picture. The terrain is 6 km wide.

LookAt {x} {eye} {z}   120 {target} 700   0 1 0
Camera "perspective" "float fov" [ 46 ]
{frame}
WorldBegin

{light}
Texture "ground" "spectrum" "imagemap" "string filename" "mountain.ppm"
Material "diffuse" "texture reflectance" [ "ground" ]
Shape "plymesh" "string filename" "mountain-terrain.ply"

Material "diffuse" "rgb reflectance" [ 0.06 0.12 0.045 ]
{objects}
{trees}"#,
        time = settings.word("time"),
        all_stored = n_ground + stored,
        x = EYE[0],
        z = EYE[1],
        target = eye + 490.0,
        frame = frame.text(),
        light = sun::light(sun),
        objects = (1..=kinds.len())
            .map(|k| format!("ObjectBegin \"fir {k}\"\n  Shape \"plymesh\" \"string filename\" \"mountain-fir-{k}.ply\"\nObjectEnd\n"))
            .collect::<String>(),
        trees = trees(&terrain, n_trees, seed),
    );
    let picture = terrain.picture(seed);
    let files = Files::of_text("mountain", text).with_mesh("mountain-terrain", &ground);
    (1..)
        .zip(&kinds)
        .fold(files, |files, (k, tree)| files.with_mesh(&format!("mountain-fir-{k}"), tree))
        .with_bytes("mountain.ppm", picture)
}

/// Trees where a forest can stand, as many per octave of the distance from the camera.
fn trees(terrain: &Terrain, n: u32, seed: u32) -> String {
    let mut rng = Rng::new(u64::from(seed), 14);
    let mut text = String::new();
    let mut left = n;
    // Places that no tree can stand on are few; the last resort is a tree on a rock.
    let mut patience = 40 * u64::from(n);
    while left > 0 {
        let distance = 110.0 * 27.0_f32.powf(rng.next_f32());
        let angle = 1.2 * (rng.next_f32() - 0.5);
        let (x, z) = (EYE[0] + distance * angle.sin(), EYE[1] + distance * angle.cos());
        let [variation, turn, width] = [0; 3].map(|_| rng.next_f32());
        patience = patience.saturating_sub(1);
        let clearing = fractal_noise([x / 300.0, z / 300.0], 3, seed + 5)
            < -0.05 - 0.1 * (distance < 300.0) as u32 as f32;
        let height = terrain.height(x, z);
        if patience > 0 && (clearing || height > 650.0 || terrain.slope(x, z) > 0.75) {
            continue;
        }
        let size = 10.0 + 12.0 * variation;
        let width = size * (0.8 + 0.5 * width);
        let (kind, degrees, y) = (left % 3 + 1, 360.0 * turn, height - 0.3);
        let _ = write!(
            text,
            "AttributeBegin\n  Translate {x:.2} {y:.2} {z:.2}\n  Rotate {degrees:.0} 0 1 0\n  Scale {width:.2} {size:.2} {width:.2}\n  ObjectInstance \"fir {kind}\"\nAttributeEnd\n"
        );
        left -= 1;
    }
    text
}
