//! Time against the size of the scene (SPEC EXP-14, ACC-6, PT-7).
//!
//! A ray that meets a hierarchy over N triangles descends about log N levels, so that its cost is claimed to be
//! O(log N), and that of building O(N log N). Both are measured on a terrain of ever finer cells, which is the same
//! landscape each time, and on a fractal of copies of copies, where few triangles are stored. Two laws are fitted: the
//! claimed line `y = a + b log2 N`, for building the time per primitive, with the share r^2 of the variance that it
//! explains; and the power `y = c N^p`, whose p would be 1 without a hierarchy.
//!
//! Steps are counted: nodes whose eight children are tested, blocks of up to eight triangles that are tested, and
//! instances that are entered. They are the same on every machine. Times come from a clock that the caller brings.

use std::fmt::Write;
use std::hint::black_box;
use std::time::Duration;

use etendue_geometry::{Geometry, TraversalWork};

use crate::fit::{Line, PowerLaw};
use crate::plot::{Axes, Corner, Mark, Panel, Series, draw};
use crate::speed::{Model, RayKind, RaySet, ray_sets};

/// Settings of the study.
#[derive(Clone, Debug)]
pub struct SceneSizeSettings {
    /// Cells along a side of each terrain; each cell has two triangles.
    pub terrains: Vec<u32>,
    /// Depth of each fractal: 20 times as many triangles from one to the next.
    pub fractals: Vec<u32>,
    /// Pixels across and down: each sends a ray of each kind.
    pub resolution: [u32; 2],
    /// Repetitions, of which the fastest counts.
    pub n_rounds: u32,
}

impl SceneSizeSettings {
    /// The study as the documentation shows it: up to 2 million triangles stored, 768 million in sight.
    #[must_use]
    pub fn full() -> Self {
        Self {
            terrains: vec![8, 16, 32, 64, 128, 256, 512, 1024],
            fractals: vec![0, 1, 2, 3, 4],
            resolution: [320, 240],
            n_rounds: 20,
        }
    }

    /// A rough version that takes a tenth of the time.
    #[must_use]
    pub fn quick() -> Self {
        Self {
            terrains: vec![8, 16, 32, 64, 128, 256],
            fractals: vec![0, 1, 2],
            resolution: [160, 120],
            n_rounds: 3,
        }
    }
}

/// Result of the study.
#[derive(Clone, Debug)]
pub struct SceneSize {
    /// Each model, first the terrains.
    pub models: Vec<ModelCost>,
}

/// Laws through measurements against the size N.
#[derive(Clone, Copy, Debug)]
pub struct Laws {
    /// The claim: a line over log2 N.
    pub line: Line,
    /// The alternative: a power of N.
    pub power: PowerLaw,
}

impl Laws {
    fn fit(points: Vec<[f64; 2]>) -> Option<Self> {
        let over_logarithm: Vec<[f64; 2]> = points.iter().map(|[n, y]| [n.log2(), *y]).collect();
        Some(Self { line: Line::fit(&over_logarithm)?, power: PowerLaw::fit(&points)? })
    }
}

/// What one model costs.
#[derive(Clone, Debug)]
pub struct ModelCost {
    /// Its name.
    pub name: String,
    /// Triangles in sight: copies count.
    pub n_triangles: f64,
    /// Triangles stored.
    pub n_stored: f64,
    /// What hierarchies are built over: triangles stored and copies.
    pub n_primitives: f64,
    /// Bytes of the hierarchies.
    pub hierarchy_bytes: usize,
    /// Time to build them, in seconds.
    pub build_s: f64,
    /// What rays cost, by kind: those of [`KINDS`].
    pub rays: Vec<RayCost>,
}

impl ModelCost {
    /// Nanoseconds to build, for each primitive.
    #[must_use]
    pub fn build_ns_per_primitive(&self) -> f64 {
        1e9 * self.build_s / self.n_primitives
    }
}

/// What a ray costs in the mean.
#[derive(Clone, Copy, Debug)]
pub struct RayCost {
    /// Nodes whose children were tested.
    pub nodes: f64,
    /// Blocks of triangles that were tested.
    pub blocks: f64,
    /// Instances that were entered.
    pub instances: f64,
    /// Seconds.
    pub time_s: f64,
}

impl RayCost {
    /// Nodes and blocks, which take about as long as each other.
    #[must_use]
    pub fn steps(&self) -> f64 {
        self.nodes + self.blocks
    }
}

/// The rays that are studied: those of a path.
pub const KINDS: [RayKind; 3] = [RayKind::Primary, RayKind::Bounce, RayKind::Shadow];

/// Runs the study in the current thread. `clock` tells the processor time of the thread; `progress` hears of each model
/// before it is measured.
pub fn scene_size(
    settings: &SceneSizeSettings,
    clock: &dyn Fn() -> Duration,
    progress: &mut dyn FnMut(&str),
) -> SceneSize {
    let terrains = settings.terrains.iter().map(|n| Model::terrain(*n));
    let fractals = settings.fractals.iter().map(|depth| Model::fractal_box(*depth));
    let models = terrains.chain(fractals).map(|model| {
        progress(&format!("{} of {} triangles", model.name, n_triangles(&model)));
        measure(&model, settings, clock)
    });
    SceneSize { models: models.collect() }
}

fn n_triangles(model: &Model) -> usize {
    model.n_triangles() * model.copies.len().max(1)
}

fn measure(model: &Model, settings: &SceneSizeSettings, clock: &dyn Fn() -> Duration) -> ModelCost {
    let mut geometry = None;
    let build_s = fastest(settings.n_rounds, || {
        let builder = model.clone().into_builder();
        let start = clock();
        geometry = Some(builder.build());
        clock() - start
    });
    let geometry = geometry.unwrap_or_else(|| model.clone().into_builder().build());
    let sets = ray_sets(model, &geometry, settings.resolution);
    let sets = KINDS.iter().filter_map(|kind| sets.iter().find(|set| set.kind == *kind));
    ModelCost {
        name: model.name.clone(),
        n_triangles: n_triangles(model) as f64,
        n_stored: model.n_triangles() as f64,
        n_primitives: (model.n_triangles() + model.copies.len()) as f64,
        hierarchy_bytes: geometry.hierarchy_bytes(),
        build_s,
        rays: sets.map(|set| ray_cost(set, &geometry, settings.n_rounds, clock)).collect(),
    }
}

fn ray_cost(set: &RaySet, geometry: &Geometry, n_rounds: u32, clock: &dyn Fn() -> Duration) -> RayCost {
    let n = set.rays.len() as f64;
    let TraversalWork { nodes, blocks, instances, .. } = set.work(geometry);
    let time_s = fastest(n_rounds, || {
        let start = clock();
        black_box(set.count_hits(geometry, 0..set.rays.len()));
        clock() - start
    });
    RayCost {
        nodes: nodes as f64 / n,
        blocks: blocks as f64 / n,
        instances: instances as f64 / n,
        time_s: time_s / n,
    }
}

/// The least of several times, in seconds: the one that other programs have disturbed least.
fn fastest(n_rounds: u32, mut run: impl FnMut() -> Duration) -> f64 {
    (0..n_rounds).map(|_| run()).min().unwrap_or_default().as_secs_f64()
}

impl SceneSize {
    /// The models of a name, from small to large.
    pub fn family<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a ModelCost> + Clone {
        self.models.iter().filter(move |model| model.name == name)
    }

    /// The names of the models.
    fn names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.models.iter().map(|model| model.name.as_str()).collect();
        names.dedup();
        names
    }

    /// The laws of what a ray of one of the [`KINDS`] costs in models of a name, N being the triangles in sight.
    #[must_use]
    pub fn ray_law(&self, name: &str, kind: usize, value: &dyn Fn(&RayCost) -> f64) -> Option<Laws> {
        Laws::fit(self.family(name).map(|model| [model.n_triangles, value(&model.rays[kind])]).collect())
    }

    /// The laws of the nanoseconds to build one primitive, N being their number.
    #[must_use]
    pub fn build_law(&self, name: &str) -> Option<Laws> {
        Laws::fit(
            self.family(name).map(|model| [model.n_primitives, model.build_ns_per_primitive()]).collect(),
        )
    }

    /// All measurements: one row for each model and kind of ray.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut text = String::from(
            "model,rays,triangles,stored_triangles,hierarchy_bytes,build_seconds,nodes_per_ray,blocks_per_ray,\
             instances_per_ray,seconds_per_ray\n",
        );
        for model in &self.models {
            let ModelCost { name, n_triangles, n_stored, hierarchy_bytes, build_s, .. } = model;
            for (kind, ray) in KINDS.iter().zip(&model.rays) {
                let kind = kind.name();
                let RayCost { nodes, blocks, instances, time_s } = ray;
                let _ =
                    write!(text, "{name},{kind},{n_triangles},{n_stored},{hierarchy_bytes},{build_s:.6e}");
                let _ = writeln!(text, ",{nodes:.4},{blocks:.4},{instances:.4},{time_s:.4e}");
            }
        }
        text
    }

    /// The laws, for people.
    #[must_use]
    pub fn summary(&self) -> String {
        let mut text = String::from("y = a + b log2 N explains r^2 of the variance; y = c N^p\n");
        let mut say = |what: &str, unit: &str, laws: Option<Laws>| {
            let Some(Laws { line, power }) = laws else { return };
            let Line { offset, slope, explained } = line;
            let signed = format!("{offset:+.1} {slope:+.2} log2 N {unit}");
            let _ = writeln!(text, "{what:<26} {signed:<28} r^2 {explained:.3}, p {:.3}", power.slope);
        };
        for name in self.names() {
            for (index, kind) in KINDS.iter().enumerate() {
                let what = format!("{name}, {} rays", kind.name());
                say(&what, "steps", self.ray_law(name, index, &RayCost::steps));
                say(&what, "ns", self.ray_law(name, index, &|ray| 1e9 * ray.time_s));
            }
            say(&format!("{name}, building"), "ns", self.build_law(name));
        }
        text
    }

    /// Steps and time of a ray and the time to build a triangle, side by side.
    #[must_use]
    pub fn svg(&self) -> String {
        let rays = |value: &dyn Fn(&RayCost) -> f64| {
            let mut series = Vec::new();
            for name in self.names() {
                for (index, kind) in KINDS.iter().enumerate() {
                    let points = self.family(name).map(|m| [m.n_triangles, value(&m.rays[index])]).collect();
                    series.push(measured(format!("{name}: {}", kind.name()), points));
                }
            }
            series
        };
        let builds = self.names().into_iter().map(|name| {
            let points = self.family(name).map(|m| [m.n_primitives, m.build_ns_per_primitive()]).collect();
            measured(name.to_owned(), points)
        });
        draw(&[
            panel("steps of a ray", ["triangles", "nodes and blocks per ray"], rays(&RayCost::steps)),
            panel("time of a ray", ["triangles", "nanoseconds per ray"], rays(&|ray| 1e9 * ray.time_s)),
            panel(
                "building",
                ["triangles stored and copies", "nanoseconds for each of them"],
                builds.collect(),
            ),
        ])
    }
}

fn measured(name: String, points: Vec<[f64; 2]>) -> Series {
    Series { name, points, mark: Mark::LineAndDots }
}

fn panel(title: &str, [x_label, y_label]: [&str; 2], series: Vec<Series>) -> Panel {
    Panel {
        title: title.to_owned(),
        x_label: x_label.to_owned(),
        y_label: y_label.to_owned(),
        axes: Axes::SemiLogarithmic,
        legend: Corner::UpperLeft,
        series,
        ..Panel::default()
    }
}
