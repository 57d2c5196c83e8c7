//! Structures that find what rays meet, compared (SPEC EXP-37, ACC-6).
//!
//! The hierarchy and the structures of the literature are built over three kinds of models of growing size: a terrain, a cloud
//! of small triangles strewn evenly, and a small body in a large stadium, whose triangles are as uneven as they come. Counted
//! are nodes or cells that a ray looks at and primitives that it tests, which are the same on every machine; times come from a
//! clock that the caller brings. All structures but `bvh` test one primitive at a time in equally plain code, so that their
//! times may be compared with each other.

mod models;

#[cfg(test)]
mod tests;

use std::fmt::Write;
use std::hint::black_box;
use std::time::Duration;

use etendue_geometry::{Accelerator, Geometry, TraversalWork};

use crate::plot::{Axes, Corner, Mark, Panel, Part, Series, draw_rows};
use crate::speed::{Model, RayKind, RaySet, ray_sets};

/// Settings of the study.
#[derive(Clone, Debug)]
pub struct AcceleratorSettings {
    /// Roughly how many triangles.
    pub sizes: Vec<u32>,
    /// Pixels across and down: each sends a ray of each kind.
    pub resolution: [u32; 2],
    /// Repetitions, of which the fastest counts.
    pub n_rounds: u32,
    /// Larger models are not searched without a structure.
    pub max_brute: u32,
}

impl AcceleratorSettings {
    /// The study as the documentation shows it: up to a million triangles.
    #[must_use]
    pub fn full() -> Self {
        let sizes = vec![1000, 10_000, 100_000, 1_000_000];
        Self { sizes, resolution: [128, 96], n_rounds: 3, max_brute: 10_000 }
    }

    /// A rough version that takes a tenth of the time.
    #[must_use]
    pub fn quick() -> Self {
        Self { sizes: vec![1000, 10_000, 100_000], resolution: [64, 48], n_rounds: 1, max_brute: 1000 }
    }
}

/// Result of the study.
#[derive(Clone, Debug)]
pub struct AcceleratorStudy {
    /// By model, then size, then structure.
    pub costs: Vec<AcceleratorCost>,
}

/// What one structure costs over one model.
#[derive(Clone, Debug)]
pub struct AcceleratorCost {
    /// The model.
    pub model: &'static str,
    /// Its triangles.
    pub n_triangles: usize,
    /// The structure.
    pub accelerator: Accelerator,
    /// Seconds to build it.
    pub build_s: f64,
    /// Bytes that it takes, without the mesh.
    pub bytes: usize,
    /// What rays cost, by kind: those of [`KINDS`].
    pub rays: Vec<AcceleratorRayCost>,
}

/// What a ray costs in the mean.
#[derive(Clone, Copy, Debug)]
pub struct AcceleratorRayCost {
    /// Nodes or cells that it looks at.
    pub nodes: f64,
    /// Primitives that it tests.
    pub primitives: f64,
    /// Seconds.
    pub time_s: f64,
}

/// The rays that are studied: those of a path.
pub const KINDS: [RayKind; 3] = [RayKind::Primary, RayKind::Bounce, RayKind::Shadow];
/// The rays of figures and summaries: bounced ones, which go everywhere.
const TYPICAL: usize = 1;
/// The models.
const MODELS: [&str; 3] = ["terrain", "cloud", "stadium"];
/// Rays of each kind that are always traced.
const FEW_RAYS: usize = 100;
/// More are traced as long as they take no more steps, nodes and tests together, than these.
const MAX_STEPS: f64 = 2e7;
/// Larger models are built once.
const LARGE: usize = 50_000;

/// Runs the study in the current thread. `clock` tells the processor time of the thread; `progress` hears of each model
/// before it is measured.
pub fn accelerators(
    settings: &AcceleratorSettings,
    clock: &dyn Fn() -> Duration,
    progress: &mut dyn FnMut(&str),
) -> AcceleratorStudy {
    let mut costs = Vec::new();
    for name in MODELS {
        for size in &settings.sizes {
            let model = models::named(name, *size);
            progress(&format!("{name} of {} triangles", model.n_triangles()));
            costs.extend(measure(name, &model, settings, clock));
        }
    }
    AcceleratorStudy { costs }
}

fn measure(
    name: &'static str,
    model: &Model,
    settings: &AcceleratorSettings,
    clock: &dyn Fn() -> Duration,
) -> Vec<AcceleratorCost> {
    let n_triangles = model.n_triangles();
    let sets = ray_sets(model, &model.clone().into_builder().build(), settings.resolution);
    let is_small =
        |own: &Accelerator| *own != Accelerator::Brute || n_triangles <= settings.max_brute as usize;
    let n_builds = if n_triangles > LARGE { 1 } else { settings.n_rounds };
    let costs = Accelerator::ALL.into_iter().filter(is_small).map(|accelerator| {
        let mut geometry = None;
        let build_s = fastest(n_builds, || {
            let builder = model.clone().into_builder();
            let start = clock();
            geometry = Some(builder.build_with(accelerator));
            clock() - start
        });
        let geometry = geometry.unwrap_or_else(|| model.clone().into_builder().build_with(accelerator));
        let set = |kind: &RayKind| sets.iter().find(|set| set.kind == *kind);
        let cost = |set: &RaySet| ray_cost(set, &geometry, settings.n_rounds, clock);
        AcceleratorCost {
            model: name,
            n_triangles,
            accelerator,
            build_s,
            bytes: geometry.hierarchy_bytes(),
            rays: KINDS.iter().filter_map(set).map(cost).collect(),
        }
    });
    costs.collect()
}

fn ray_cost(
    set: &RaySet,
    geometry: &Geometry,
    n_rounds: u32,
    clock: &dyn Fn() -> Duration,
) -> AcceleratorRayCost {
    let few = thinned(set, FEW_RAYS);
    let TraversalWork { nodes, primitives, .. } = few.work(geometry);
    let steps = (nodes + primitives) as f64 / few.rays.len() as f64;
    let set = thinned(set, ((MAX_STEPS / steps.max(1.0)) as usize).max(FEW_RAYS));
    let n = set.rays.len() as f64;
    let TraversalWork { nodes, primitives, .. } = set.work(geometry);
    let time_s = fastest(n_rounds, || {
        let start = clock();
        black_box(set.count_hits(geometry, 0..set.rays.len()));
        clock() - start
    });
    AcceleratorRayCost { nodes: nodes as f64 / n, primitives: primitives as f64 / n, time_s: time_s / n }
}

/// Some rays of a set, as evenly as they come.
fn thinned(set: &RaySet, n_rays: usize) -> RaySet {
    let step = set.rays.len().div_ceil(n_rays).max(1);
    RaySet { rays: set.rays.iter().step_by(step).copied().collect(), ..*set }
}

/// The least of several times, in seconds: the one that other programs have disturbed least.
fn fastest(n_rounds: u32, mut run: impl FnMut() -> Duration) -> f64 {
    (0..n_rounds).map(|_| run()).min().unwrap_or_default().as_secs_f64()
}

impl AcceleratorCost {
    /// Nanoseconds to build, for each triangle.
    #[must_use]
    pub fn build_ns_per_triangle(&self) -> f64 {
        1e9 * self.build_s / self.n_triangles as f64
    }

    /// Bytes for each triangle.
    #[must_use]
    pub fn bytes_per_triangle(&self) -> f64 {
        self.bytes as f64 / self.n_triangles as f64
    }
}

impl AcceleratorStudy {
    /// The costs of a structure over models of a name, from small to large.
    pub fn of<'a>(
        &'a self,
        model: &'a str,
        accelerator: &'a str,
    ) -> impl Iterator<Item = &'a AcceleratorCost> {
        self.costs.iter().filter(move |cost| cost.model == model && cost.accelerator.name() == accelerator)
    }

    /// All measurements: one row for each model, size, structure and kind of ray.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut text = String::from(
            "model,triangles,accelerator,build_seconds,bytes,rays,nodes_per_ray,primitives_per_ray,\
             seconds_per_ray\n",
        );
        for cost in &self.costs {
            let AcceleratorCost { model, n_triangles, accelerator, build_s, bytes, rays } = cost;
            for (kind, ray) in KINDS.iter().zip(rays) {
                let AcceleratorRayCost { nodes, primitives, time_s } = ray;
                let (own, kind) = (accelerator.name(), kind.name());
                let _ = write!(text, "{model},{n_triangles},{own},{build_s:.4e},{bytes},{kind}");
                let _ = writeln!(text, ",{nodes:.3},{primitives:.3},{time_s:.4e}");
            }
        }
        text
    }

    /// What bounced rays cost in the largest model of each kind, for people.
    #[must_use]
    pub fn summary(&self) -> String {
        let mut text = String::new();
        for model in MODELS {
            let largest =
                self.costs.iter().filter(|cost| cost.model == model).map(|cost| cost.n_triangles).max();
            let _ = writeln!(
                text,
                "{model:<17} build ns, bytes a triangle; nodes, tests, ns a bounced ray ({} triangles)",
                largest.unwrap_or(0)
            );
            for accelerator in Accelerator::ALL {
                let Some(cost) = self.of(model, accelerator.name()).last() else { continue };
                let AcceleratorRayCost { nodes, primitives, time_s } = cost.rays[TYPICAL];
                let [build, bytes] = [cost.build_ns_per_triangle(), cost.bytes_per_triangle()];
                let name = accelerator.name();
                let _ = write!(text, "{name:<17} {build:8.0} {bytes:14.1}");
                let _ = write!(text, "       {nodes:6.1} {primitives:6.1} {:6.0}", 1e9 * time_s);
                let is_largest = Some(cost.n_triangles) == largest;
                let _ = if is_largest {
                    writeln!(text)
                } else {
                    writeln!(text, " ({} triangles)", cost.n_triangles)
                };
            }
        }
        text
    }

    /// Tests, nodes and time of a bounced ray, time to build and memory: a row each, a column for each kind of model. The
    /// first column names the structures.
    #[must_use]
    pub fn svg(&self) -> String {
        type Value = fn(&AcceleratorCost) -> f64;
        let rows: [(&str, &str, Value); 5] = [
            ("tests", "primitives that a bounced ray tests", |cost| cost.rays[TYPICAL].primitives),
            ("nodes", "nodes or cells that it looks at", |cost| cost.rays[TYPICAL].nodes),
            ("time", "nanoseconds of a bounced ray", |cost| 1e9 * cost.rays[TYPICAL].time_s),
            ("building", "nanoseconds for each triangle", AcceleratorCost::build_ns_per_triangle),
            ("memory", "bytes for each triangle", AcceleratorCost::bytes_per_triangle),
        ];
        let panel = |model: &str, (what, label, value): &(&str, &str, Value)| {
            let mut series = self.series(model, *value);
            if model != MODELS[0] {
                series.iter_mut().for_each(|curve| curve.name.clear());
            }
            Part::Panel(Panel {
                title: format!("{model}: {what}"),
                x_label: "triangles".to_owned(),
                y_label: (*label).to_owned(),
                axes: Axes::Logarithmic,
                legend: Corner::LowerLeft,
                series,
                ..Panel::default()
            })
        };
        let parts: Vec<Part> =
            rows.iter().flat_map(|row| MODELS.iter().map(move |model| panel(model, row))).collect();
        draw_rows(&parts, MODELS.len())
    }

    /// A curve for each structure; that without any is drawn last, since it is hardly there.
    fn series(&self, model: &str, value: fn(&AcceleratorCost) -> f64) -> Vec<Series> {
        let (brute, others): (Vec<Accelerator>, Vec<Accelerator>) =
            Accelerator::ALL.into_iter().partition(|own| *own == Accelerator::Brute);
        let curve = |own: Accelerator| Series {
            name: own.name().to_owned(),
            points: self.of(model, own.name()).map(|cost| [cost.n_triangles as f64, value(cost)]).collect(),
            mark: if own == Accelerator::Brute { Mark::Dashes } else { Mark::LineAndDots },
        };
        others.into_iter().chain(brute).map(curve).collect()
    }
}
