//! Pieces of work by which machines can be compared.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use etendue_geometry::Geometry;
use etendue_geometry::points::{Neighbours, PointTree};
use etendue_math::{Point3, Rng, Sampler, SamplerSettings, Vector3};
use etendue_scene::Film;
use etendue_transport::photon::estimate::{DensityEstimate, EstimateScratch, MapEstimate};
use etendue_transport::photon::{
    Onward, PhotonEmitter, PhotonMap, PhotonPattern, PhotonVertex, PhotonWalk, StoredPhoton,
    trace_photon_parts,
};
use etendue_transport::{Flow, Integrator, Observer, RayCounts, Stop, render};
use rayon::prelude::*;

use super::model::Model;
use super::rays::{RayKind, ray_sets};
use crate::estimator::{Estimator, SamplerChoice};
use crate::scenes::StudyScene;

/// Something to do again and again while a clock runs.
pub struct Task {
    /// Name for tables, such as "primary rays".
    pub name: &'static str,
    /// Name for programs, such as `primary_rays`.
    pub key: &'static str,
    work: Box<dyn Fn() -> u64 + Send + Sync>,
}

impl fmt::Debug for Task {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Task").field("name", &self.name).finish_non_exhaustive()
    }
}

impl Task {
    fn new(name: &'static str, key: &'static str, work: impl Fn() -> u64 + Send + Sync + 'static) -> Self {
        Self { name, key, work: Box::new(work) }
    }

    /// Does it once with the threads of the current rayon pool; the number of rays, triangles, paths, look-ups,
    /// photons or random numbers it took.
    pub fn run(&self) -> u64 {
        (self.work)()
    }
}

/// How much work a task is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TaskSize {
    /// Cells along a side of the terrain.
    pub terrain: u32,
    /// Rays of each kind.
    pub rays: [u32; 2],
    /// Pixels along a side of the picture of the Cornell box.
    pub picture: u32,
    /// Points to look up.
    pub points: u32,
}

impl TaskSize {
    /// What figures are quoted for: each takes a fraction of a second.
    pub const FULL: Self = Self { terrain: 900, rays: [640, 480], picture: 512, points: 1_000_000 };

    /// Nearly nothing, to see that it works.
    pub const TINY: Self = Self { terrain: 30, rays: [32, 24], picture: 16, points: 1000 };
}

/// Rays, look-ups or random numbers that a thread does before it asks for more.
const CHUNK: usize = 1 << 12;

/// All tasks, ready to run, and whether rays are traced by AVX2.
#[must_use]
pub fn tasks(size: &TaskSize) -> (Vec<Task>, bool) {
    let terrain = Model::terrain(size.terrain);
    let geometry = Arc::new(terrain.clone().into_builder().build());
    let mut tasks = ray_tasks(&terrain, &geometry, size.rays);
    tasks.push(Task::new("triangles built", "triangles_built", move || {
        std::hint::black_box(terrain.clone().into_builder().build()).counts().n_triangles as u64
    }));
    tasks.extend(path_tasks(size.picture));
    tasks.push(look_up_task(size.points));
    tasks.extend(photon_tasks(size.points / 10));
    tasks.push(Task::new("random numbers", "random_numbers", random_numbers));
    (tasks, geometry.is_traced_by_avx2())
}

fn ray_tasks(model: &Model, geometry: &Arc<Geometry>, resolution: [u32; 2]) -> Vec<Task> {
    let tasks = ray_sets(model, geometry, resolution).into_iter().map(|set| {
        let (name, key) = match set.kind {
            RayKind::Primary => ("primary rays", "primary_rays"),
            RayKind::Random => ("random rays", "random_rays"),
            RayKind::Bounce => ("bounce rays", "bounce_rays"),
            RayKind::Shadow => ("shadow rays", "shadow_rays"),
        };
        let geometry = Arc::clone(geometry);
        Task::new(name, key, move || {
            let n = set.rays.len();
            let starts: Vec<usize> = (0..n).step_by(CHUNK).collect();
            let hits = |start: &usize| set.count_hits(&geometry, *start..n.min(start + CHUNK));
            let n_hits: usize = starts.par_iter().map(hits).sum();
            std::hint::black_box(n_hits);
            n as u64
        })
    });
    tasks.collect()
}

/// One sample for each pixel of the Cornell box, of at most 8 scattering events, with independent random numbers: paths, and all
/// their rays.
fn path_tasks(width: u32) -> [Task; 2] {
    let scene = Arc::new(StudyScene::cornell_box().with_resolution([width, width]).build());
    let trace = move || {
        let mut integrator = Estimator::of_sampler(SamplerChoice::Independent).integrator(&scene);
        let mut film = Film::new(scene.film.clone(), Vec::new());
        let stop = Stop { passes: 0..1, error: None };
        let rays = RaySum::default();
        render(&scene, integrator.as_mut(), &mut film, &stop, &rays);
        rays.0.into_inner()
    };
    let rays = trace.clone();
    [
        Task::new("paths", "paths", move || {
            trace();
            u64::from(width) * u64::from(width)
        }),
        Task::new("rays of paths", "path_rays", rays),
    ]
}

/// Sums rays, those to lamps too.
#[derive(Debug, Default)]
struct RaySum(AtomicU64);

impl Observer for RaySum {
    fn tile_done(&self, _: u64, rays: RayCounts) -> Flow {
        self.0.fetch_add(rays.closest + rays.shadow, Ordering::Relaxed);
        Flow::Continue
    }

    fn pass_done(&self, _: u64, _: &Film, _: &dyn Integrator) -> Flow {
        Flow::Continue
    }
}

/// Neighbours of a look-up.
const NEIGHBOURS: usize = 50;

/// The nearest 50 of points on the walls of a cube, asked for from anywhere on these walls.
fn look_up_task(n_points: u32) -> Task {
    let mut rng = Rng::new(1, 0);
    let mut on_walls = |n: u32| -> Vec<Point3> {
        (0..n)
            .map(|k| {
                let (u, wall) = (rng.next_point2(), (k / 3 % 2) as f32);
                match k % 3 {
                    0 => Point3::new(wall, u.x, u.y),
                    1 => Point3::new(u.x, wall, u.y),
                    _ => Point3::new(u.x, u.y, wall),
                }
            })
            .collect()
    };
    let tree = PointTree::new(&on_walls(n_points));
    let mut places = on_walls(n_points / 20);
    // Neither sorted nor by walls, as paths ask.
    for k in (1..places.len()).rev() {
        places.swap(k, rng.next_below(k as u32 + 1) as usize);
    }
    Task::new("look-ups of 50 points", "look_ups", move || {
        let find = |places: &[Point3]| {
            let mut found = Neighbours::new();
            for p in places {
                tree.nearest(*p, NEIGHBOURS, f32::INFINITY, &mut found);
            }
            std::hint::black_box(&found);
        };
        places.par_chunks(CHUNK).for_each(find);
        places.len() as u64
    })
}

/// Photons of the Cornell box: their ways from surface to surface with independent random numbers, their rays, the map of those
/// that arrive, its nearest 50, and estimates of irradiance by 50 and by 200.
fn photon_tasks(n_photons: u32) -> [Task; 6] {
    let scene = Arc::new(StudyScene::cornell_box().build());
    let emitter = Arc::new(PhotonEmitter::new(&scene));
    let walk = PhotonWalk { pattern: PhotonPattern::Random, ..PhotonWalk::default() };
    let trace = move || {
        let keep = |_, vertex: &PhotonVertex<'_>, kept: &mut Vec<StoredPhoton>| {
            kept.push(StoredPhoton::of(vertex));
            Onward::Continue
        };
        trace_photon_parts(&scene, &emitter, 0..n_photons.into(), &walk, keep)
    };
    let trace_rays = trace.clone();
    let photons = trace().0.concat();
    let map = Arc::new(PhotonMap::from_photons(&photons, n_photons.into()));
    // What scatters to where photons come from faces them, so that their direction serves as a normal.
    let lit: Arc<[_]> = photons.iter().step_by(32).map(|photon| (photon.position, photon.wi)).collect();
    let estimates = [
        estimate_task(("estimates of 50 photons", "estimates_50"), &map, &lit, 50),
        estimate_task(("estimates of 200 photons", "estimates_200"), &map, &lit, 200),
    ];
    // Neither sorted nor by walls: photons arrive anywhere.
    let places: Vec<Point3> = photons.iter().step_by(8).map(|photon| photon.position).collect();
    let ask = move || {
        let find = |places: &[Point3]| {
            let mut found = Neighbours::new();
            for p in places {
                map.nearest(*p, NEIGHBOURS, f32::INFINITY, &mut found);
            }
            std::hint::black_box(&found);
        };
        places.par_chunks(CHUNK).for_each(find);
        places.len() as u64
    };
    let [by_50, by_200] = estimates;
    [
        Task::new("photons traced", "photons_traced", move || {
            std::hint::black_box(trace());
            n_photons.into()
        }),
        Task::new("rays of photons", "photon_rays", move || std::hint::black_box(trace_rays()).1.closest),
        Task::new("photons put into a map", "photons_mapped", move || {
            std::hint::black_box(PhotonMap::from_photons(&photons, n_photons.into())).len() as u64
        }),
        Task::new("look-ups of 50 photons", "photon_look_ups", ask),
        by_50,
        by_200,
    ]
}

/// Irradiance at these places, with these normals.
fn estimate_task(
    (name, key): (&'static str, &'static str),
    map: &Arc<PhotonMap>,
    places: &Arc<[(Point3, Vector3)]>,
    k: usize,
) -> Task {
    let (map, places) = (Arc::clone(map), Arc::clone(places));
    let estimate = MapEstimate { density: DensityEstimate::default(), k, max_radius: f32::INFINITY };
    Task::new(name, key, move || {
        let ask = |places: &[(Point3, Vector3)]| {
            let mut scratch = EstimateScratch::default();
            for place in places {
                std::hint::black_box(estimate.irradiance(&map, *place, &mut scratch));
            }
        };
        places.par_chunks(CHUNK).for_each(ask);
        places.len() as u64
    })
}

/// Numbers of the default sampler, in pairs: 64 for each sample of a row of pixels.
fn random_numbers() -> u64 {
    const DIMENSIONS: u32 = 64;
    const SAMPLES: u32 = 16;
    let settings = SamplerSettings { samples_per_pixel: SAMPLES, ..SamplerSettings::default() };
    let pixels = 0..CHUNK as u32;
    let n_pixels = u64::from(pixels.end);
    pixels.into_par_iter().with_min_len(64).for_each(|x| {
        for index in 0..SAMPLES {
            let mut sampler = Sampler::new(&settings, [x, 0], u64::from(index));
            for _ in 0..DIMENSIONS / 2 {
                std::hint::black_box(sampler.next_2d());
            }
        }
    });
    n_pixels * u64::from(SAMPLES * DIMENSIONS)
}
