//! The two-pass renderer (Jensen 1996, "Global Illumination using Photon Maps", doi:10.1007/978-3-7091-7484-5_3; Jensen 2001, chapter
//! 9; SPEC PM-2 to PM-12): photons first, then rays from the camera, which ask them.
//!
//! [`eye_walk`] tells how the image is divided. The direct term and what is seen in mirrors have no bias. Caustics are blurred by
//! the radius of their estimates, and indirect light by that of the global map, one reflection away from the eye. Both
//! vanish as photons become many; noise vanishes with the number of samples.
//!
//! The maps are functions of scene, seed and settings alone: they are made before the first pass, and passes are independent.

mod eye_walk;
mod fill;
mod lit_map;
mod map_file;
mod plan;
mod precomputed;
mod probe;
mod settings;

use std::sync::Mutex;

use etendue_scene::film::TileSamples;
use etendue_scene::{Film, Scene};
use etendue_spectrum::Sampled;

pub use map_file::{MapFile, check_map_files};
pub use plan::Content;
pub use settings::MappingSettings;

pub(crate) use eye_walk::TERM_NAMES;

pub(super) use eye_walk::{EyeMethod, Seen, follow};
pub(super) use lit_map::LitMap;
pub(super) use map_file::obtain;
pub(super) use plan::MapPlan;
pub(super) use probe::{MapNames, Probe, describe_map};
pub(super) use settings::{
    LIGHT_SAMPLER, MAX_PHOTON_DEPTH, MOST_NEIGHBOURS, MOST_PHOTONS, SHARP_ALPHA_SPEC, check_least_photons,
    file, length, n_parameters, spec, with_shared,
};

use self::fill::{Arrival, Traced};
use self::precomputed::Precomputed;
use crate::integrator::{Control, Integrator, PassEnd, Passes, ReportEntry};
use crate::lpe::PathExpressions;
use crate::path::camera_pass::{CameraPass, CameraPath, Follow, FollowedPath, Tracer};
use crate::photon::estimate::EstimateScratch;
use crate::photon::lack::Lack;

/// The two-pass renderer.
#[derive(Debug)]
pub struct PhotonMapping {
    settings: MappingSettings,
    expressions: PathExpressions,
    maps: Option<Maps>,
    /// Memory of the last pass's tiles, for the next.
    tiles: Vec<TileSamples>,
}

/// What the first pass leaves for the second.
#[derive(Debug)]
struct Maps {
    global: LitMap,
    caustic: LitMap,
    global_irradiance: Option<Precomputed>,
    caustic_irradiance: Option<Precomputed>,
    accurate_distance: f32,
    global_probe: Probe,
    caustic_probe: Probe,
    /// Why the global map is empty, if it is.
    lack: Option<Lack>,
}

impl PhotonMapping {
    /// The two-pass renderer, which fills the film's layers by these expressions and those of its terms.
    #[must_use]
    pub fn new(settings: MappingSettings, expressions: PathExpressions) -> Self {
        let expressions = if settings.layers { expressions.with_own_layers(TERM_NAMES) } else { expressions };
        Self { settings, expressions, maps: None, tiles: Vec::new() }
    }
}

impl Integrator for PhotonMapping {
    fn passes(&self) -> Passes {
        Passes::Independent
    }

    fn run_pass(&mut self, scene: &Scene, pass: u64, film: &mut Film, control: &Control<'_>) -> PassEnd {
        let settings = &self.settings;
        if self.maps.is_none() {
            self.maps = Maps::new(scene, settings, control);
        }
        let Some(maps) = &self.maps else { return PassEnd::Cancelled };
        let camera_pass = CameraPass {
            wavelengths: settings.wavelengths,
            expressions: &self.expressions,
            group_size: 1,
            adaptive: None,
        };
        let method = EyeMethod {
            global: &maps.global,
            caustic: Some(&maps.caustic),
            global_irradiance: maps.global_irradiance.as_ref(),
            caustic_irradiance: maps.caustic_irradiance.as_ref(),
            seen: Seen::Accurately,
            accurate_distance: maps.accurate_distance,
            accurate_share: settings.accurate_share,
            n_gather: settings.gather_rays,
            max_depth: settings.max_depth,
            sharp_alpha: settings.sharp_alpha,
        };
        camera_pass.run(scene, pass, film, control, &mut self.tiles, &EyePass::new(method))
    }

    fn report(&self) -> Vec<ReportEntry> {
        let Some(maps) = &self.maps else { return Vec::new() };
        let stored = maps.global.map.len() + maps.caustic.map.len();
        let advice = match maps.lack {
            Some(Lack::Unasked) => Some(self.settings.unasked_advice()),
            Some(lack) => lack.advice(),
            None => None,
        };
        let mut entries =
            vec![ReportEntry::new("photons_stored", stored as f64, "").with_advice_if_any(advice)];
        entries.extend(describe_map(&GLOBAL_NAMES, &maps.global, &maps.global_probe));
        entries.extend(describe_map(&CAUSTIC_NAMES, &maps.caustic, &maps.caustic_probe));
        entries.push(ReportEntry::new("accurate_distance", f64::from(maps.accurate_distance), "m"));
        entries
    }
}

const GLOBAL_NAMES: MapNames = MapNames {
    emitted: "global_photons_emitted",
    stored: "global_photons_stored",
    mean_radius: "global_mean_radius",
    worst_radius: "global_worst_radius",
    max_radius: "global_max_radius",
    limited: "global_estimates_limited",
    photons_parameter: "globalphotons",
    radius_parameter: "globalradius",
    expects_everywhere: true,
};

const CAUSTIC_NAMES: MapNames = MapNames {
    emitted: "caustic_photons_emitted",
    stored: "caustic_photons_stored",
    mean_radius: "caustic_mean_radius",
    worst_radius: "caustic_worst_radius",
    max_radius: "caustic_max_radius",
    limited: "caustic_estimates_limited",
    photons_parameter: "causticphotons",
    radius_parameter: "causticradius",
    expects_everywhere: false,
};

impl Maps {
    /// `None` if the render was cancelled meanwhile.
    fn new(scene: &Scene, settings: &MappingSettings, control: &Control<'_>) -> Option<Self> {
        let global = Prepared::new(scene, settings.global_plan(scene), &[], control)?;
        // Photons of the global map tell where it is dark between caustics.
        let caustic = Prepared::new(scene, settings.caustic_plan(scene), &global.arrivals, control)?;
        let (lack, global_irradiance, global) = (global.lack, global.irradiance, global.map);
        let (caustic_irradiance, caustic) = (caustic.irradiance, caustic.map);
        let global_probe = Probe::new(scene, &global, settings.sharp_alpha);
        let caustic_probe = Probe::new(scene, &caustic, settings.sharp_alpha);
        Some(Self {
            accurate_distance: settings.accurate_distance.unwrap_or(2.0 * global_probe.mean_radius),
            lack,
            global,
            caustic,
            global_irradiance,
            caustic_irradiance,
            global_probe,
            caustic_probe,
        })
    }
}

/// A map, ready to be asked.
#[derive(Debug)]
struct Prepared {
    map: LitMap,
    irradiance: Option<Precomputed>,
    /// Places where its photons arrived.
    arrivals: Vec<Arrival>,
    /// Why there are none.
    lack: Option<Lack>,
}

impl Prepared {
    /// Irradiance is computed before at places of the map's own and at these others. `None` if the render was cancelled
    /// meanwhile.
    fn new(scene: &Scene, plan: MapPlan, others: &[Arrival], control: &Control<'_>) -> Option<Self> {
        let (Traced { map, arrivals, place_step }, lack) = obtain(scene, &plan, control)?;
        let map = LitMap::new(scene, &plan, map);
        let is_wanted = plan.place_step > 0 && place_step > 0;
        let irradiance = is_wanted.then(|| {
            // Where there is no photon it is dark, which the map tells as fast.
            let others = if map.map.is_empty() { &[] } else { others };
            Precomputed::new(&map, &[&arrivals, others].concat(), control)
        });
        (!control.is_cancelled()).then_some(Self { map, irradiance, arrivals, lack })
    }
}

/// Camera paths that ask maps, with memory for each thread.
#[derive(Debug)]
pub(super) struct EyePass<'m> {
    method: EyeMethod<'m>,
    /// What is in it changes nothing.
    scratches: Vec<Mutex<EstimateScratch>>,
}

impl<'m> EyePass<'m> {
    pub(super) fn new(method: EyeMethod<'m>) -> Self {
        let n = rayon::current_num_threads().max(1);
        Self { method, scratches: (0..n).map(|_| Mutex::default()).collect() }
    }
}

impl Follow for EyePass<'_> {
    type Left = ();

    fn follow(&self, tracer: &Tracer<'_>, path: &mut CameraPath<'_, '_>) -> (Sampled, ()) {
        let place = rayon::current_thread_index().unwrap_or(0) % self.scratches.len();
        let mut scratch = self.scratches[place].lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        (follow(&self.method, tracer, path, &mut scratch), ())
    }

    fn join(&self, _: &Tracer<'_>, _: &mut [FollowedPath<()>]) {}
}
