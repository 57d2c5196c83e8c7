//! One sample for every pixel, in tiles, in parallel: the frame of every method whose paths start at the camera.

use std::cell::Cell;

use etendue_geometry::Hit;
use etendue_math::{Point2, Ray, Sampler, SamplerSettings, hash64};
use etendue_scene::camera::CameraRay;
use etendue_scene::film::{Features, FilmTile, PixelSample, TileSamples};
use etendue_scene::medium::MediumId;
use etendue_scene::parameters::ParameterSpec;
use etendue_scene::{Film, Scene};
use etendue_spectrum::{Sampled, Wavelengths};
use rayon::prelude::*;

use super::adaptive::{AdaptivePixels, PassPixel};
use super::medium::camera_medium;
use crate::integrator::{Control, PassEnd, RayCounts};
use crate::lpe::{LayerRecorder, PathExpressions};

/// Pixels across and down of a tile: small enough to balance threads, large enough to amortise the merge.
const TILE_SIZE: u32 = 32;

/// How wavelengths are chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WavelengthMode {
    /// Four wavelengths for each path, rotated copies of a hero.
    #[default]
    Hero,
    /// One random wavelength for each path (SPEC SPD-2), to compare with.
    Single,
    /// Red, green and blue in place of wavelengths (SPEC SPD-4), as renderers without spectra compute.
    Bands,
}

impl WavelengthMode {
    /// The parameter of scene files that tells it.
    pub const PARAMETER: ParameterSpec = ParameterSpec {
        name: "wavelengths",
        kind: "string",
        default: "hero",
        unit: "",
        doc: "wavelengths of a path: hero (four), single, or bands (linear sRGB, as renderers without spectra)",
    };

    /// Their names in scene files.
    pub const CHOICES: &'static [(&'static str, Self)] =
        &[("hero", Self::Hero), ("single", Self::Single), ("bands", Self::Bands)];

    /// Wavelengths for a random number in [0, 1).
    #[inline]
    #[must_use]
    pub fn sample(self, u: f32) -> Wavelengths {
        match self {
            Self::Hero => Wavelengths::sample_visible(u),
            Self::Single => Wavelengths::sample_single(u),
            Self::Bands => Wavelengths::bands(u),
        }
    }
}

/// The scene as one thread sees it during one tile: counts the rays that are traced.
#[derive(Debug)]
pub struct Tracer<'s> {
    /// The scene.
    pub scene: &'s Scene,
    /// What the camera stands in.
    camera_medium: Option<MediumId>,
    closest: Cell<u64>,
    shadow: Cell<u64>,
    interpolated: Cell<u64>,
}

impl<'s> Tracer<'s> {
    /// Starts counting.
    #[must_use]
    pub const fn new(scene: &'s Scene) -> Self {
        Self {
            scene,
            camera_medium: None,
            closest: Cell::new(0),
            shadow: Cell::new(0),
            interpolated: Cell::new(0),
        }
    }

    /// The nearest surface along the ray.
    #[inline]
    #[must_use]
    pub fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.closest.set(self.closest.get() + 1);
        self.scene.intersect(ray, f32::INFINITY)
    }

    /// The nearest surface along the ray before `t_max`.
    #[inline]
    #[must_use]
    pub fn intersect_within(&self, ray: &Ray, t_max: f32) -> Option<Hit> {
        self.count_shadow_ray();
        self.scene.intersect(ray, t_max)
    }

    /// Counts a shadow ray.
    #[inline]
    pub fn count_shadow_ray(&self) {
        self.shadow.set(self.shadow.get() + 1);
    }

    /// Rays so far.
    #[must_use]
    pub fn counts(&self) -> RayCounts {
        RayCounts {
            closest: self.closest.get(),
            shadow: self.shadow.get(),
            interpolated: self.interpolated.get(),
        }
    }
}

/// What stays the same over a pass.
#[derive(Clone, Copy, Debug)]
pub struct CameraPass<'p> {
    /// Choice of wavelengths.
    pub wavelengths: WavelengthMode,
    /// Layers by path expression, in the film's order; only groups of one pixel can fill any.
    pub expressions: &'p PathExpressions,
    /// Pixels across and down of a group, whose paths have wavelengths and time in common.
    pub group_size: u32,
    /// Interpolates pixels; each is then a group of its own, and there are no layers.
    pub adaptive: Option<AdaptivePixels>,
}

/// How a method follows the paths of a group of pixels.
pub trait Follow: Sync {
    /// What a path leaves for the others of its group.
    type Left: Default;

    /// Follows one path, and gives the radiance that it brings by itself.
    fn follow(&self, tracer: &Tracer<'_>, path: &mut CameraPath<'_, '_>) -> (Sampled, Self::Left);

    /// What paths have in common beyond their groups; `own` is what a path would have.
    #[inline]
    fn common(&self, own: Common) -> Common {
        own
    }

    /// Samples of the image that a tile of so many paths is: a method may take several paths for one.
    #[inline]
    fn n_samples(&self, n_paths: u64) -> u64 {
        n_paths
    }

    /// Adds what the paths of a group bring each other.
    fn join(&self, tracer: &Tracer<'_>, group: &mut [FollowedPath<Self::Left>]);
}

/// A path that was followed, and waits for the others of its group.
#[derive(Debug)]
pub struct FollowedPath<L> {
    /// Its radiance at the camera, before the camera's weight.
    pub radiance: Sampled,
    /// Its wavelengths.
    pub lambda: Wavelengths,
    /// What it leaves for the others.
    pub left: L,
    pixel: [u32; 2],
    camera_weight: f32,
    filter_weight: f32,
    features: Option<Features>,
}

/// What the paths of a group have in common: random numbers of the first.
#[derive(Clone, Copy, Debug)]
pub struct Common {
    /// Chooses the wavelengths, in [0, 1).
    pub u_lambda: f32,
    /// Chooses the time, in [0, 1).
    pub u_time: f32,
}

impl CameraPass<'_> {
    /// Adds one sample to every pixel. `memory` is what tiles are gathered in; passes that share it spare the system the
    /// work.
    pub fn run<F: Follow>(
        &self,
        scene: &Scene,
        pass: u64,
        film: &mut Film,
        control: &Control<'_>,
        memory: &mut Vec<TileSamples>,
        method: &F,
    ) -> PassEnd {
        let end = self.gather(scene, pass, film, control, memory, method);
        // Whole passes only, but for the very first: better a part of a picture than none.
        if end == PassEnd::Complete || film.n_passes() == 0 {
            film.add_tiles(memory);
        }
        end
    }

    /// Gathers one sample for every pixel in `memory`, and leaves the film as it is. A cancelled pass lacks some of the tiles.
    pub fn gather<F: Follow>(
        &self,
        scene: &Scene,
        pass: u64,
        film: &Film,
        control: &Control<'_>,
        memory: &mut Vec<TileSamples>,
        method: &F,
    ) -> PassEnd {
        let tiles = film.tiles(TILE_SIZE);
        let camera_medium = camera_medium(scene);
        memory.resize_with(tiles.len(), TileSamples::default);
        let finished: Vec<Option<TileSamples>> = tiles
            .into_par_iter()
            .zip(memory.par_drain(..))
            .map(|(bounds, memory)| {
                if control.is_cancelled() {
                    return None;
                }
                let tracer = Tracer { camera_medium, ..Tracer::new(scene) };
                let tile = film.start_tile(bounds, memory).of_pass(pass);
                let samples = self.run_tile(&tracer, pass, tile, method);
                control.tile_done(method.n_samples(bounds.n_pixels() as u64), tracer.counts());
                Some(samples)
            })
            .collect();
        let complete = finished.iter().all(Option::is_some);
        memory.extend(finished.into_iter().flatten());
        if complete { PassEnd::Complete } else { PassEnd::Cancelled }
    }

    fn run_tile<F: Follow>(
        &self,
        tracer: &Tracer<'_>,
        pass: u64,
        mut tile: FilmTile<'_>,
        method: &F,
    ) -> TileSamples {
        let mut layers = self.expressions.recorder();
        if let Some(adaptive) = &self.adaptive {
            self.run_adaptive(tracer, pass, &mut tile, method, adaptive);
            return tile.finish();
        }
        let mut group = Vec::with_capacity((self.group_size * self.group_size) as usize);
        for bounds in tile.bounds().tiles(self.group_size) {
            let mut common = None;
            for pixel in bounds.pixels() {
                let start = CameraSample::new(tracer.scene, pixel, pixel, pass, &mut common);
                let features = tile.wants_features().then(Features::default);
                layers.restart();
                group.push(self.follow(tracer, start, features, &mut layers, method));
            }
            method.join(tracer, &mut group);
            for path in group.drain(..) {
                let sample = PixelSample {
                    radiance: path.radiance * path.camera_weight,
                    lambda: &path.lambda,
                    filter_weight: path.filter_weight,
                    features: path.features,
                    layers: layers.radiance(),
                };
                tile.add(path.pixel, &sample);
            }
        }
        tile.finish()
    }

    /// Fills a tile by paths for some of its pixels, which all have the same random numbers.
    fn run_adaptive<F: Follow>(
        &self,
        tracer: &Tracer<'_>,
        pass: u64,
        tile: &mut FilmTile<'_>,
        method: &F,
        adaptive: &AdaptivePixels,
    ) {
        let (bounds, wants_features) = (tile.bounds(), tile.wants_features());
        let mut layers = self.expressions.recorder();
        let mut filter_weight = 1.0;
        let (pixels, n_interpolated) = adaptive.fill(bounds, pass, |pixel| {
            let start = CameraSample::new(tracer.scene, pixel, [0, 0], pass, &mut None);
            let features = wants_features.then(Features::default);
            layers.restart();
            let path = self.follow(tracer, start, features, &mut layers, method);
            filter_weight = path.filter_weight;
            PassPixel {
                radiance: path.radiance * path.camera_weight,
                lambda: path.lambda,
                features: path.features,
            }
        });
        tracer.interpolated.set(tracer.interpolated.get() + n_interpolated);
        for (pixel, PassPixel { radiance, lambda, features }) in bounds.pixels().zip(pixels) {
            let sample = PixelSample { radiance, lambda: &lambda, filter_weight, features, layers: &[] };
            tile.add(pixel, &sample);
        }
    }

    fn follow<F: Follow>(
        &self,
        tracer: &Tracer<'_>,
        start: CameraSample,
        mut features: Option<Features>,
        layers: &mut LayerRecorder<'_>,
        method: &F,
    ) -> FollowedPath<F::Left> {
        let CameraSample { pixel, numbers_of, pass, mut sampler, common, p_film, u_lens, filter_weight } =
            start;
        let common = method.common(common);
        let mut lambda = self.wavelengths.sample(common.u_lambda);
        let (mut radiance, mut left, mut camera_weight) = (Sampled::ZERO, F::Left::default(), 0.0);
        if let Some(CameraRay { ray, weight }) = tracer.scene.camera.sample_ray(p_film, u_lens, common.u_time)
        {
            let mut path = CameraPath {
                ray,
                medium: tracer.camera_medium,
                numbers_of,
                pass,
                lambda: &mut lambda,
                sampler: &mut sampler,
                layers,
                features: features.as_mut(),
            };
            (radiance, left) = method.follow(tracer, &mut path);
            layers.scale(weight);
            camera_weight = weight;
        }
        FollowedPath { radiance, lambda, left, pixel, camera_weight, filter_weight, features }
    }
}

/// Where a path starts, with everything random about it.
#[derive(Debug)]
struct CameraSample {
    pixel: [u32; 2],
    /// The pixel whose random numbers it has.
    numbers_of: [u32; 2],
    pass: u64,
    /// The numbers of the path from here on.
    sampler: Sampler,
    common: Common,
    p_film: Point2,
    u_lens: Point2,
    filter_weight: f32,
}

impl CameraSample {
    /// A sample of a pixel by the random numbers of one, with what its group has in common; the first of a group decides that.
    fn new(
        scene: &Scene,
        pixel: [u32; 2],
        numbers_of: [u32; 2],
        pass: u64,
        common: &mut Option<Common>,
    ) -> Self {
        let mut sampler = Sampler::new(&scene.sampler, numbers_of, pass);
        let u_lambda = sampler.next_1d();
        let filter = scene.filter.sample(sampler.next_2d());
        let own = Common { u_lambda, u_time: sampler.next_1d() };
        Self {
            pixel,
            numbers_of,
            pass,
            common: *common.get_or_insert(own),
            p_film: Point2::new(pixel[0] as f32 + 0.5, pixel[1] as f32 + 0.5) + filter.offset,
            u_lens: sampler.next_2d(),
            filter_weight: filter.weight,
            sampler,
        }
    }
}

/// A camera path that is about to start, with everything random about it.
#[derive(Debug)]
pub struct CameraPath<'p, 'e> {
    /// The ray from the camera.
    pub ray: Ray,
    /// What it starts in.
    pub medium: Option<MediumId>,
    /// The pixel whose random numbers it has: its own, but where pixels are interpolated.
    pub numbers_of: [u32; 2],
    /// Its number among the pixel's samples.
    pub pass: u64,
    /// Its wavelengths; dispersion reduces them.
    pub lambda: &'p mut Wavelengths,
    /// The numbers of this sample.
    pub sampler: &'p mut Sampler,
    /// Layers by path expression.
    pub layers: &'p mut LayerRecorder<'e>,
    /// Features of the first surface, if the film wants them.
    pub features: Option<&'p mut Features>,
}

impl CameraPath<'_, '_> {
    /// Does something with the numbers of one of `n` parts into which every path of the image splits: those of all parts of
    /// all passes of a pixel are a pattern of their own, as evenly spread as so many samples. A single part has the path's
    /// own numbers.
    pub fn with_sampler_of_part<T>(
        &mut self,
        settings: &SamplerSettings,
        part: u32,
        n: u32,
        work: impl FnOnce(&mut Self) -> T,
    ) -> T {
        let own = if n == 1 {
            self.sampler.clone()
        } else {
            let seed = hash64(&[settings.seed, u64::from(n)]);
            let samples_per_pixel = settings.samples_per_pixel.saturating_mul(n);
            let settings = SamplerSettings { seed, samples_per_pixel, ..*settings };
            Sampler::new(&settings, self.numbers_of, self.pass * u64::from(n) + u64::from(part))
        };
        let whole = std::mem::replace(self.sampler, own);
        let result = work(self);
        *self.sampler = whole;
        result
    }
}
