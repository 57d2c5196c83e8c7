//! Who traces rays.

use clap::ValueEnum;
use etendue_geometry::Geometry;
use etendue_lab::speed::{Model, RayKind, RaySet};

use crate::embree;

/// Which contestant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Kind {
    /// Embree at high quality
    Embree,
    /// Embree at high quality with the flag ROBUST
    Robust,
    /// Étendue as it is
    Etendue,
    /// Étendue without the instructions that only some processors have
    Portable,
}

impl Kind {
    pub(crate) const ALL: [Self; 4] = [Self::Embree, Self::Robust, Self::Etendue, Self::Portable];

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Embree => "Embree",
            Self::Robust => "Embree robust",
            Self::Etendue => "Étendue",
            Self::Portable => "portable",
        }
    }
}

/// What contestants are built from.
pub(crate) struct Builder<'a> {
    pub(crate) model: &'a Model,
    pub(crate) device: &'a embree::Device,
    pub(crate) buffers: &'a embree::Buffers,
    pub(crate) pool: &'a rayon::ThreadPool,
}

impl<'a> Builder<'a> {
    /// Builds one, and tells its bytes and the processor seconds of all threads.
    pub(crate) fn build(&self, kind: Kind) -> (Contestant<'a>, f64) {
        let model = self.model.clone();
        let build = || model.into_builder().build();
        // Threads of the last build come to rest.
        std::thread::sleep(std::time::Duration::from_millis(50));
        let start = crate::clock::process_seconds();
        let contestant = match kind {
            Kind::Embree => Contestant::Embree(embree::Scene::build(self.device, self.buffers, false)),
            Kind::Robust => Contestant::Embree(embree::Scene::build(self.device, self.buffers, true)),
            Kind::Etendue => Contestant::Etendue(self.pool.install(build)),
            Kind::Portable => Contestant::Etendue(self.pool.install(build).traced_portably()),
        };
        (contestant, crate::clock::process_seconds() - start)
    }

    /// Étendue's geometry.
    pub(crate) fn geometry(&self) -> Geometry {
        self.pool.install(|| self.model.clone().into_builder().build())
    }
}

/// A built scene of either.
pub(crate) enum Contestant<'a> {
    Embree(embree::Scene<'a>),
    Etendue(Geometry),
}

impl Contestant<'_> {
    /// Bytes of the hierarchies.
    pub(crate) fn n_bytes(&self) -> usize {
        match self {
            Self::Embree(scene) => scene.n_bytes,
            Self::Etendue(geometry) => geometry.hierarchy_bytes(),
        }
    }

    /// Traces rays; writes t of the nearest hit, or 0 where a shadow ray is stopped, else infinity. By its
    /// name callgrind counts the instructions of the rays alone.
    #[inline(never)]
    pub(crate) fn trace(&self, set: &RaySet, t: &mut [f32]) {
        match self {
            Self::Embree(scene) => scene.trace(set, t),
            Self::Etendue(geometry) => trace(geometry, set, t),
        }
    }
}

fn trace(geometry: &Geometry, set: &RaySet, t: &mut [f32]) {
    if set.kind == RayKind::Shadow {
        for (ray, t) in set.rays.iter().zip(t) {
            *t = if geometry.occluded(ray, set.t_max, &|_| true) { 0.0 } else { f32::INFINITY };
        }
        return;
    }
    for (ray, t) in set.rays.iter().zip(t) {
        *t = geometry.intersect(ray, set.t_max, &|_| true).map_or(f32::INFINITY, |hit| hit.t);
    }
}
