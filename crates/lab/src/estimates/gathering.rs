//! Photon gathering against density estimation (SPEC EXP-45, EST-12): the indirect light of the Cornell box, by photons as small lights
//! and by their density, against path tracing.
//!
//! As a light, a photon reaches all that it sees: few give a smooth picture, if each estimate can have that many shadow rays. Density
//! needs many more photons, which cost next to nothing to look up. A choice by importance needs the contributions of all photons,
//! but few rays.

use etendue_geometry::points::PointTree;
use etendue_math::{Point2, Point3, Rng, SamplerKind, SamplerSettings, Vector3, hash64};
use etendue_scene::bsdf::Lobes;
use etendue_scene::scene::Surface;
use etendue_scene::{Film, Scene};
use etendue_spectrum::{Sampled, Wavelengths, Xyz, flux_to_xyz};
use etendue_transport::lpe::PathExpressions;
use etendue_transport::path::camera_pass::Tracer;
use etendue_transport::photon::estimate::gathering::{
    GatherChoice, GatherScratch, GatherSettings, PhotonLight, gather,
};
use etendue_transport::photon::estimate::radiance::LitPlace;
use etendue_transport::photon::estimate::{DensityEstimate, EstimateScratch, Photons, radiance};
use etendue_transport::photon::{Onward, PhotonEmitter, PhotonWalk, trace_photons};
use etendue_transport::{Stop, Unobserved, method, render};
use rayon::prelude::*;

use super::CurveStudy;
use crate::plot::{Corner, Mark, Panel, Series};
use crate::scenes::StudyScene;

/// Settings of the study.
#[derive(Clone, Debug, PartialEq)]
pub struct GatheringSettings {
    /// Pixels across and down.
    pub resolution: [u32; 2],
    /// Samples per pixel of the reference.
    pub reference_samples: u32,
    /// Places in each pixel at which light is gathered.
    pub n_places: u32,
    /// Photons that leave the lamp: for lights.
    pub light_counts: Vec<u64>,
    /// The same for densities.
    pub density_counts: Vec<u64>,
    /// Shadow rays where not all photons have one.
    pub n_rays: u32,
    /// Determines all random numbers.
    pub seed: u64,
}

impl GatheringSettings {
    /// As the documentation shows it.
    #[must_use]
    pub fn full(seed: u64) -> Self {
        Self {
            resolution: [24, 24],
            reference_samples: 4096,
            n_places: 8,
            light_counts: vec![30, 100, 300, 1000, 3000],
            density_counts: vec![300, 1000, 3000, 10_000, 100_000, 1_000_000],
            n_rays: 32,
            seed,
        }
    }

    /// A rough version.
    #[must_use]
    pub fn quick(seed: u64) -> Self {
        Self {
            resolution: [12, 12],
            reference_samples: 512,
            n_places: 4,
            light_counts: vec![100, 1000],
            density_counts: vec![1000, 30_000],
            ..Self::full(seed)
        }
    }
}

/// Most scattering events of a path, in all methods.
const MAX_DEPTH: u32 = 5;

/// Photons as a map holds them.
#[derive(Default)]
struct Stored(Vec<(Point3, Vector3, Xyz)>);

impl Photons for Stored {
    fn position(&self, index: u32) -> Point3 {
        self.0[index as usize].0
    }
    fn wi(&self, index: u32) -> Vector3 {
        self.0[index as usize].1
    }
    fn power(&self, index: u32) -> Xyz {
        self.0[index as usize].2
    }
}

/// Runs the study. `progress` hears what is being done.
pub fn gathering(settings: &GatheringSettings, progress: &mut dyn FnMut(&str)) -> CurveStudy {
    let mut scene = StudyScene::cornell_box().with_resolution(settings.resolution).build();
    progress("reference");
    let reference = reference(&mut scene, settings);
    let mut summary = String::from("way, photons emitted: relative error, mean over that of the reference\n");
    let mut note = |name: &str, n: u64, image: &[[f64; 3]]| {
        let (error, mean) = compare(image, &reference);
        summary += &format!("{name}, {n}: {error:.4}, {mean:.4}\n");
        [n as f64, error]
    };
    let rays = settings.n_rays;
    let choices = [
        ("a ray for each photon", GatherChoice::All),
        ("rays by importance", GatherChoice::Important(rays)),
        ("rays at random", GatherChoice::Random(rays)),
    ];
    let mut series = Vec::new();
    for (name, choice) in choices {
        let mut points = Vec::new();
        for &n in &settings.light_counts {
            progress(&format!("{name}: {n} photons"));
            points.push(note(name, n, &gathered(&scene, n, choice, settings)));
        }
        series.push(Series { name: name.to_owned(), points, mark: Mark::LineAndDots });
    }
    let mut points = Vec::new();
    for &n in &settings.density_counts {
        progress(&format!("density: {n} photons"));
        points.push(note("density, k = 50", n, &by_density(&scene, n, settings)));
    }
    series.push(Series { name: "density, k = 50".to_owned(), points, mark: Mark::LineAndDots });
    let panel = Panel {
        title: format!("indirect light of the Cornell box; {rays} rays where not all"),
        x_label: "photons emitted".to_owned(),
        y_label: "relative error of a pixel (RMS)".to_owned(),
        legend: Corner::LowerLeft,
        series,
        ..Panel::default()
    };
    CurveStudy { panels: vec![panel], summary }
}

/// Indirect light by path tracing.
fn reference(scene: &mut Scene, settings: &GatheringSettings) -> Vec<[f64; 3]> {
    let n = settings.reference_samples;
    scene.sampler = SamplerSettings { kind: SamplerKind::Sobol, seed: settings.seed, samples_per_pixel: n };
    let mut entity = scene.integrator.clone();
    entity.parameters.retain(|parameter| parameter.name != "maxdepth");
    let depth = etendue_scene::document::Value::Integers(vec![MAX_DEPTH as i32]);
    entity.parameters.push(etendue_scene::document::Parameter::new("maxdepth", depth));
    let expressions = PathExpressions::new(&[("indirect".to_owned(), "LDD+E".to_owned())]);
    let expressions = expressions.expect("the expression is in order");
    let mut film = Film::new(scene.film.clone(), expressions.names().to_vec());
    let mut integrator = method(&entity, expressions).0.expect("the scene names an integrator that exists");
    render(
        scene,
        integrator.as_mut(),
        &mut film,
        &Stop { passes: 0..u64::from(n), error: None },
        &Unobserved,
    );
    let pixels = film.develop().layer_rgb("indirect").unwrap_or_default();
    pixels.into_iter().map(|rgb| rgb.map(f64::from)).collect()
}

/// Root mean square of the difference over the mean of the reference, and the ratio of means.
fn compare(image: &[[f64; 3]], reference: &[[f64; 3]]) -> (f64, f64) {
    let mean = |pixels: &[[f64; 3]]| pixels.iter().flatten().sum::<f64>() / (3 * pixels.len()) as f64;
    let squares = image.iter().flatten().zip(reference.iter().flatten()).map(|(a, b)| (a - b).powi(2));
    let square = squares.sum::<f64>() / (3 * image.len()) as f64;
    (square.sqrt() / mean(reference), mean(image) / mean(reference))
}

fn walk(settings: &GatheringSettings, n: u64, max_depth: u32) -> PhotonWalk {
    let seed = hash64(&[settings.seed, n]);
    let sampler = SamplerSettings { kind: SamplerKind::Independent, seed, samples_per_pixel: 1 };
    PhotonWalk { max_depth, sampler, ..PhotonWalk::default() }
}

fn gathered(scene: &Scene, n: u64, choice: GatherChoice, settings: &GatheringSettings) -> Vec<[f64; 3]> {
    let emitter = PhotonEmitter::new(scene);
    // The photon's surface and the one it lights scatter too.
    let walk = walk(settings, n, MAX_DEPTH - 2);
    let (lights, _) = trace_photons(scene, &emitter, 0..n, &walk, |_, vertex, lights| {
        lights.extend(PhotonLight::new(vertex, n));
        Onward::Continue
    });
    let settings_of_gather = GatherSettings { choice, min_distance: 0.0 };
    image(scene, settings, |surface, lambda, rng, (_, scratch)| {
        let Some(bsdf) = scene.bsdf(surface, lambda) else { return Sampled::ZERO };
        let tracer = Tracer::new(scene);
        let u = rng.next_f32();
        gather(&tracer, (surface, &bsdf, lambda), &lights, settings_of_gather, u, scratch)
    })
}

fn by_density(scene: &Scene, n: u64, settings: &GatheringSettings) -> Vec<[f64; 3]> {
    let emitter = PhotonEmitter::new(scene);
    let walk = walk(settings, n, MAX_DEPTH - 1);
    let (stored, _) = trace_photons(scene, &emitter, 0..n, &walk, |_, vertex, stored| {
        if !vertex.trail.is_empty() && vertex.bsdf.lobes().has_non_specular() {
            let power = flux_to_xyz(vertex.flux / n as f32, vertex.lambda);
            stored.push((vertex.surface.point.p, vertex.surface.wo, power));
        }
        Onward::Continue
    });
    let stored = Stored(stored);
    let places: Vec<Point3> = stored.0.iter().map(|photon| photon.0).collect();
    let tree = PointTree::new(&places);
    let estimate = DensityEstimate::default();
    let wanted = estimate.search_size(50);
    image(scene, settings, |surface, lambda, _, (scratch, _)| {
        let Some(bsdf) = scene.bsdf(surface, lambda) else { return Sampled::ZERO };
        tree.nearest(surface.point.p, wanted, f32::INFINITY, &mut scratch.found);
        let place = LitPlace { p: surface.point.p, wo: surface.wo, bsdf: &bsdf, lobes: Lobes::ALL, lambda };
        radiance(&estimate, &place, wanted, &stored, scratch).radiance
    })
}

/// Means over places of each pixel.
fn image(
    scene: &Scene,
    settings: &GatheringSettings,
    light: impl Fn(&Surface, &mut Wavelengths, &mut Rng, &mut (EstimateScratch, GatherScratch)) -> Sampled + Sync,
) -> Vec<[f64; 3]> {
    let [width, height] = settings.resolution;
    let n = settings.n_places;
    let pixel = |scratch: &mut (EstimateScratch, GatherScratch), index: u32| {
        let mut rng = Rng::new(hash64(&[settings.seed, u64::from(index)]), 7);
        let mut sum = [0.0; 3];
        for place in 0..n {
            let at =
                Point2::new((index % width) as f32 + rng.next_f32(), (index / width) as f32 + rng.next_f32());
            let mut lambda = Wavelengths::sample_visible((place as f32 + rng.next_f32()) / n as f32);
            let Some(ray) = scene.camera.sample_ray(at, Point2::new(0.5, 0.5), 0.5) else { continue };
            let Some(hit) = scene.intersect(&ray.ray, f32::INFINITY) else { continue };
            let surface = scene.surface(&ray.ray, &hit);
            let radiance = light(&surface, &mut lambda, &mut rng, scratch) * ray.weight;
            let rgb = scene.film.sensor.sensor_rgb(radiance, &lambda);
            (0..3).for_each(|c| sum[c] += f64::from(rgb[c]) / f64::from(n));
        }
        sum
    };
    (0..width * height).into_par_iter().map_init(Default::default, pixel).collect()
}
