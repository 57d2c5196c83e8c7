//! From where a path of light arrives to the camera.
//!
//! At a surface that flux Phi reaches from `wo`, the camera sees through its pixel at p, of all N pixels of the whole film,
//!
//! ```text
//! N Phi f(wo -> wi) |cos_i| W_e V / pdf_w                                      [Veach 1997, section 10.2.2, s = k, t = 1]
//! ```
//!
//! in the mean over the pixel, where `wi` leads to a point of the lens, drawn with the density `pdf_w`, W_e is the camera's
//! importance, V the visibility, and f the scattering function of importance.

use etendue_geometry::GeometryId;
use etendue_math::{Point2, Sampler, Vector3};
use etendue_scene::bsdf::{Lobes, TransportMode};
use etendue_scene::camera::CameraWiSample;
use etendue_scene::film::Splats;
use etendue_scene::light::LightPoint;
use etendue_spectrum::Sampled;

use crate::lpe::{Event, LayerRecorder, PathPosition};
use crate::path::camera_pass::Tracer;
use crate::photon::{Onward, PhotonVertex, Switches};

/// Connects the surfaces of one path after the other.
#[derive(Debug)]
pub(super) struct Connector<'c, 'f, 'e> {
    pub(super) tracer: &'c Tracer<'f>,
    pub(super) splats: &'c mut Splats<'f>,
    pub(super) layers: &'c mut LayerRecorder<'e>,
    /// At the eye, with an empty path.
    pub(super) eye: &'c PathPosition,
    pub(super) sharp_alpha: f32,
    /// Numbers that choose points of the lens.
    pub(super) numbers: Sampler,
    /// Events of the path so far.
    pub(super) events: &'c mut Vec<Event>,
    /// The shape that it scattered at last.
    pub(super) last: Option<GeometryId>,
    pub(super) switches: Switches,
    /// Set where the camera may look at a mirror or clear glass.
    pub(super) met_mirrors: &'c mut bool,
}

impl Connector<'_, '_, '_> {
    /// Sees a path arrive at a surface.
    pub(super) fn visit(&mut self, vertex: &PhotonVertex<'_>) -> Onward {
        self.numbers.start_vertex();
        let u_lens = self.numbers.next_2d();
        self.events.extend(vertex.last_event);
        let admitted = self.admitted(vertex);
        self.last = Some(vertex.surface.hit.geometry);
        let Some(admitted) = admitted else { return Onward::Stop };
        self.connect(vertex, admitted, u_lens);
        Onward::Continue
    }

    /// The lobes through which the camera may see what has come; `None` if nothing may go on.
    fn admitted(&mut self, vertex: &PhotonVertex<'_>) -> Option<Lobes> {
        let Some(controls) = &self.tracer.scene.controls else { return Some(Lobes::ALL) };
        let id = vertex.surface.hit.geometry;
        let goes_on = match (self.last, vertex.last_event) {
            (Some(last), Some(event)) => self.switches.scatter(controls, last, event),
            _ => controls.reaches(vertex.light, id),
        };
        goes_on.then(|| self.switches.lobes(controls, id, vertex.bsdf, self.sharp_alpha))
    }

    /// Brings the camera what it sees of the path at this surface.
    fn connect(&mut self, vertex: &PhotonVertex<'_>, admitted: Lobes, u_lens: Point2) {
        let PhotonVertex { surface, bsdf, .. } = vertex;
        let scene = self.tracer.scene;
        let is_mirror = !bsdf.lobes().has_non_specular();
        if is_mirror && *self.met_mirrors {
            return;
        }
        let Some(camera) = scene.camera.sample_wi(surface.point.p, surface.time, u_lens) else { return };
        if is_mirror {
            *self.met_mirrors = true;
            return;
        }
        let f = bsdf.eval(surface.wo, camera.wi, TransportMode::Importance, admitted);
        let scale = bsdf.abs_cos(camera.wi) * camera.we / camera.pdf_w;
        if f.is_black() || scale <= 0.0 || !scale.is_finite() {
            return;
        }
        let visible = self.visibility(vertex, &camera);
        if visible.is_black() {
            return;
        }
        let through = vertex.flux * visible * scale;
        let seen = through * f;
        if !self.layers.is_idle() {
            self.record(vertex, &camera, through, admitted);
        }
        scene.camera.for_each_place(camera.p_film, |p_film| {
            self.splats.add(p_film, seen, vertex.lambda, self.layers.radiance());
        });
    }

    /// The share of light that gets to the camera.
    fn visibility(&self, vertex: &PhotonVertex<'_>, camera: &CameraWiSample) -> Sampled {
        let (scene, surface) = (self.tracer.scene, vertex.surface);
        self.tracer.count_shadow_ray();
        let lens =
            LightPoint { p: camera.p_lens, p_error: Vector3::splat(0.0), n: None, uv: Point2::splat(0.0) };
        let share = scene.transmittance(surface, &lens);
        match scene.medium_towards(surface, camera.wi, vertex.medium) {
            Some(medium) if share > 0.0 => {
                scene.transmittance_of(medium, camera.distance, vertex.lambda) * share
            }
            _ => Sampled::splat(share),
        }
    }

    /// Notes what each layer sees: the word is known now.
    fn record(
        &mut self,
        vertex: &PhotonVertex<'_>,
        camera: &CameraWiSample,
        through: Sampled,
        admitted: Lobes,
    ) {
        let (bsdf, wo) = (vertex.bsdf, vertex.surface.wo);
        self.layers.restart();
        let glossy = Event::glossy(bsdf.glossy_roughness(), self.sharp_alpha);
        for (event, lobes) in [(glossy, Lobes::GLOSSY), (Event::Diffuse, Lobes::DIFFUSE)] {
            let f = bsdf.eval(wo, camera.wi, TransportMode::Importance, lobes & admitted);
            if f.is_black() {
                continue;
            }
            self.layers.return_to(self.eye);
            self.layers.scatter(event);
            self.events.iter().rev().for_each(|event| self.layers.scatter(*event));
            self.layers.emit(through * f);
        }
    }
}
