//! Looking at photons: where they lie, where they come from, and a file for other programs.
//!
//! Photons are traced as for a map, and kept whole: nothing here is packed or rounded.

mod directions;
mod picture;

#[cfg(test)]
mod tests;

use etendue_geometry::points::{Neighbours, PointTree};
use etendue_math::{Normal3, Point3, SamplerKind, SamplerSettings, Vector3};
use etendue_scene::{AttributeDomain, LoadedMesh, MeshAttribute, Scene};
use etendue_transport::RayCounts;
use etendue_transport::photon::{Onward, PhotonEmitter, PhotonVertex, PhotonWalk, Trail, trace_photons};

pub use picture::PictureSettings;

/// A photon on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenPhoton {
    /// Where it arrived.
    pub p: Point3,
    /// Geometric normal there, on the side that it arrived on.
    pub n: Normal3,
    /// Unit direction towards where it came from.
    pub wi: Vector3,
    /// Its flux in the colour space of the film, with the exposure of its sensor: a white surface with `E` of it per m^2 has the
    /// radiance `E / pi` that a picture of the scene would show.
    pub power: [f32; 3],
    /// What happened to it before.
    pub trail: Trail,
}

/// Which photons are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PhotonKind {
    /// All that arrive on surfaces that scatter widely.
    #[default]
    All,
    /// Those straight from a light.
    Direct,
    /// Those that came through mirrors and glass alone.
    Caustic,
    /// All others.
    Indirect,
}

impl PhotonKind {
    fn includes(self, trail: Trail) -> bool {
        match self {
            Self::All => true,
            Self::Direct => trail.is_empty(),
            Self::Caustic => trail.is_caustic(),
            Self::Indirect => !trail.is_empty() && !trail.is_caustic(),
        }
    }
}

/// Photons of a scene.
#[derive(Clone, Debug, Default)]
pub struct PhotonCloud {
    /// In the order in which they were emitted, and along their ways.
    pub photons: Vec<SeenPhoton>,
    /// How many left the lights.
    pub n_emitted: u64,
    /// Rays that it took.
    pub rays: RayCounts,
}

impl PhotonCloud {
    /// Emits photons and keeps those of a kind where they meet surfaces that are no mere mirrors (SPEC PHT-10).
    #[must_use]
    pub fn trace(scene: &Scene, n_emitted: u64, kind: PhotonKind, seed: u64) -> Self {
        let emitter = PhotonEmitter::new(scene);
        let sampler = SamplerSettings { kind: SamplerKind::Independent, seed, samples_per_pixel: 1 };
        let walk = PhotonWalk { sampler, ..PhotonWalk::default() };
        let share = 1.0 / n_emitted.max(1) as f32;
        let (photons, rays) = trace_photons(scene, &emitter, 0..n_emitted, &walk, |_, vertex, kept| {
            if kind.includes(vertex.trail) && vertex.bsdf.lobes().has_non_specular() {
                kept.push(seen(scene, vertex, share));
            }
            Onward::Continue
        });
        Self { photons, n_emitted, rays }
    }

    /// A tree of their places.
    #[must_use]
    pub fn tree(&self) -> PointTree {
        let places: Vec<Point3> = self.photons.iter().map(|photon| photon.p).collect();
        PointTree::new(&places)
    }

    /// The photons nearest to a point, nearest first; with a normal only those from its side.
    #[must_use]
    pub fn nearest(&self, p: Point3, n: Option<Vector3>, k: usize) -> Vec<SeenPhoton> {
        let is_wanted = |photon: &SeenPhoton| n.is_none_or(|n| photon.wi.dot(n) > 0.0);
        let wanted: Vec<SeenPhoton> = self.photons.iter().copied().filter(is_wanted).collect();
        let places: Vec<Point3> = wanted.iter().map(|photon| photon.p).collect();
        let mut found = Neighbours::new();
        PointTree::new(&places).nearest(p, k, f32::INFINITY, &mut found);
        let mut nearest: Vec<_> = found.iter().collect();
        nearest.sort_by(|a, b| a.distance_squared.total_cmp(&b.distance_squared).then(a.index.cmp(&b.index)));
        nearest.into_iter().map(|near| wanted[near.index as usize]).collect()
    }

    /// The photons as a PLY file of points: place, normal, and as further properties `wi_0..2`, `power_0..2` (red, green, blue),
    /// `bounces` and `caustic` (1 or 0).
    #[must_use]
    pub fn ply(&self) -> Vec<u8> {
        let attribute = |name: &str, n_components: usize, value: &dyn Fn(&SeenPhoton) -> [f32; 3]| {
            let values = self.photons.iter().flat_map(|p| value(p).into_iter().take(n_components)).collect();
            MeshAttribute {
                name: format!("vertex_{name}"),
                domain: AttributeDomain::Vertex,
                n_components,
                values,
            }
        };
        etendue_io::write_ply(&LoadedMesh {
            positions: self.photons.iter().map(|photon| photon.p).collect(),
            normals: self.photons.iter().map(|photon| photon.n).collect(),
            attributes: vec![
                attribute("wi", 3, &|photon| [photon.wi.x, photon.wi.y, photon.wi.z]),
                attribute("power", 3, &|photon| photon.power),
                attribute("bounces", 1, &|photon| [photon.trail.len() as f32; 3]),
                attribute("caustic", 1, &|photon| [f32::from(u8::from(photon.trail.is_caustic())); 3]),
            ],
            ..LoadedMesh::default()
        })
    }
}

fn seen(scene: &Scene, vertex: &PhotonVertex<'_>, share: f32) -> SeenPhoton {
    let surface = vertex.surface;
    SeenPhoton {
        p: surface.point.p,
        n: surface.point.ng.facing(surface.wo),
        wi: surface.wo,
        power: scene.film.sensor.sensor_rgb(vertex.flux * share, vertex.lambda),
        trail: vertex.trail,
    }
}
