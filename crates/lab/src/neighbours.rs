//! Structures that find the nearest photons (SPEC EXP-13, KD-2, KD-12).
//!
//! Each structure of [`etendue_geometry::points`] holds the photons of three scenes: those on the walls and balls of a room,
//! half of them crowded towards a corner; those in a cup whose wall focuses light to a caustic on its floor; and again
//! those of the room, as a projection map emits them: cell after cell. All but the unbalanced tree are indifferent to that
//! order. Asked is for the nearest 50 among ever more photons, for ever more neighbours among as many photons, and for
//! those within a radius. Times come from a clock that the caller brings.

use std::fmt::Write;
use std::hint::black_box;
use std::time::Duration;

use etendue_geometry::points::{Neighbours, PointIndex, PointTree, Structure};
use etendue_math::{Point3, Rng, warp};

use crate::plot::{Axes, Corner, Mark, Panel, Series, draw};

/// Neighbours asked for where the number of photons changes.
const K: usize = 50;

/// Settings of the study.
#[derive(Clone, Debug)]
pub struct NeighbourSettings {
    /// Numbers of photons.
    pub sizes: Vec<usize>,
    /// Numbers of neighbours, among the last of the sizes.
    pub ks: Vec<usize>,
    /// Questions of each kind.
    pub n_questions: usize,
    /// Lists longer than this are not asked.
    pub longest_list: usize,
    /// Repetitions, of which the fastest counts.
    pub n_rounds: u32,
    /// Determines photons and questions.
    pub seed: u64,
}

impl NeighbourSettings {
    /// The study as the documentation shows it.
    #[must_use]
    pub fn full(seed: u64) -> Self {
        Self {
            sizes: (0..6).map(|i| 1000 << (2 * i)).collect(),
            ks: vec![1, 3, 10, 30, 100, 300, 1000],
            n_questions: 2000,
            longest_list: 16_000,
            n_rounds: 3,
            seed,
        }
    }

    /// A rough version that takes a tenth of the time.
    #[must_use]
    pub fn quick(seed: u64) -> Self {
        Self { sizes: vec![1000, 4000, 16_000, 64_000], n_questions: 500, n_rounds: 2, ..Self::full(seed) }
    }
}

/// Where photons are, and in which order they come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Distribution {
    /// On walls and balls, crowded towards a corner, in random order.
    Room,
    /// On the floor of a cup: half of them evenly, half on a caustic.
    Caustic,
    /// Those of the room, cell after cell of a projection map.
    Cells,
}

impl Distribution {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Room, Self::Caustic, Self::Cells];

    /// Its name in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Room => "room",
            Self::Caustic => "caustic",
            Self::Cells => "room in cells",
        }
    }

    /// So many photons.
    #[must_use]
    pub fn photons(self, n: usize, seed: u64) -> Vec<Point3> {
        let mut rng = Rng::new(seed, 0);
        let mut photons: Vec<Point3> = (0..n)
            .map(|i| match self {
                Self::Room | Self::Cells => in_room(&mut rng, i % 2 == 0),
                Self::Caustic if i % 2 == 0 => on_floor(&mut rng),
                Self::Caustic => on_caustic(&mut rng),
            })
            .collect();
        if self == Self::Cells {
            photons.sort_by_cached_key(|p| projection_cell(*p));
        }
        photons
    }

    /// So many places to ask at, all over the same surfaces.
    #[must_use]
    pub fn questions(self, n: usize, seed: u64) -> Vec<Point3> {
        let mut rng = Rng::new(seed, 1);
        let place = |rng: &mut Rng| if self == Self::Caustic { on_floor(rng) } else { in_room(rng, false) };
        (0..n).map(|_| place(&mut rng)).collect()
    }
}

/// A place on three walls of a room of side 1 or on a ball.
fn in_room(rng: &mut Rng, is_crowded: bool) -> Point3 {
    if rng.next_f32() < 0.3 {
        return Point3::new(0.5, 0.3, 0.5) + warp::sample_uniform_sphere(rng.next_point2()) * 0.3;
    }
    let [mut a, mut b] = [rng.next_f32(), rng.next_f32()];
    if is_crowded {
        (a, b) = (a.powi(3), b.powi(3));
    }
    match rng.next_below(3) {
        0 => Point3::new(a, 0.0, b),
        1 => Point3::new(0.0, a, b),
        _ => Point3::new(a, b, 0.0),
    }
}

/// A place on the floor of a cup of radius 1/2.
fn on_floor(rng: &mut Rng) -> Point3 {
    let d = warp::sample_concentric_disk(rng.next_point2());
    Point3::new(0.5 * d.x, 0.0, 0.5 * d.y)
}

/// Where light that comes along x reaches the floor after its reflection by the wall of the cup: dense along a nephroid.
fn on_caustic(rng: &mut Rng) -> Point3 {
    let y = 0.5 * (2.0 * rng.next_f32() - 1.0);
    let x = (0.25 - y * y).max(0.0).sqrt();
    // The normal is -2 (x, y); the chord of the reflected ray is as long as that of the ray that came, 2 x.
    let direction = [1.0 - 8.0 * x * x, -8.0 * x * y];
    let t = 2.0 * x * rng.next_f32();
    Point3::new(x + t * direction[0], 0.0, y + t * direction[1])
}

/// The cell, of 32 x 32, that a photon was emitted through by a lamp in the corner above.
fn projection_cell(p: Point3) -> [i32; 2] {
    let lamp = Point3::new(1.1, 1.2, 1.1);
    let d = (p - lamp).normalized();
    let cell = |angle: f32| (angle / std::f32::consts::PI * 32.0).floor() as i32;
    [cell(d.y.clamp(-1.0, 1.0).acos()), cell(d.z.atan2(d.x))]
}

/// One kind of question to one structure.
#[derive(Clone, Copy, Debug)]
pub struct Measurement {
    /// Whose photons.
    pub distribution: Distribution,
    /// How they are kept.
    pub structure: Structure,
    /// Number of photons.
    pub n_points: usize,
    /// Neighbours asked for; `None` for all within the radius.
    pub k: Option<usize>,
    /// Greatest distance in metres.
    pub radius_m: f32,
    /// Photons found, in the mean.
    pub n_found: f64,
    /// Seconds for a question.
    pub time_s: f64,
}

/// What a structure costs before the first question.
#[derive(Clone, Copy, Debug)]
pub struct Making {
    /// Whose photons.
    pub distribution: Distribution,
    /// How they are kept.
    pub structure: Structure,
    /// Number of photons.
    pub n_points: usize,
    /// Seconds to build it.
    pub build_s: f64,
    /// Bytes.
    pub bytes: usize,
    /// Levels of a tree that is not balanced.
    pub depth: Option<usize>,
}

/// Result of the study.
#[derive(Clone, Debug, Default)]
pub struct NeighbourStudy {
    /// Questions.
    pub measurements: Vec<Measurement>,
    /// Structures.
    pub makings: Vec<Making>,
}

/// Runs the study in the current thread. `clock` tells the processor time of the thread; `progress` hears of each number of
/// photons before it is measured.
pub fn neighbours(
    settings: &NeighbourSettings,
    clock: &dyn Fn() -> Duration,
    progress: &mut dyn FnMut(&str),
) -> NeighbourStudy {
    let mut study = NeighbourStudy::default();
    for distribution in Distribution::ALL {
        let questions = distribution.questions(settings.n_questions, settings.seed);
        for (i, n) in settings.sizes.iter().enumerate() {
            progress(&format!("{}, {n} photons", distribution.name()));
            let photons = distribution.photons(*n, settings.seed);
            let radius = median_reach(&photons, &questions);
            for structure in Structure::ALL {
                if structure == Structure::List && *n > settings.longest_list {
                    continue;
                }
                let mut bench = Bench { settings, clock, distribution, structure, photons: &photons, radius };
                let (index, making) = bench.make();
                study.makings.push(making);
                let is_last = i + 1 == settings.sizes.len();
                let ks = if is_last { &*settings.ks } else { &[] };
                study.measurements.push(bench.ask(&index, &questions, Some(K), f32::INFINITY));
                for k in ks.iter().filter(|k| **k != K) {
                    study.measurements.push(bench.ask(&index, &questions, Some(*k), f32::INFINITY));
                }
                study.measurements.push(bench.ask(&index, &questions, None, radius));
            }
        }
    }
    study
}

/// The radius within which half of the places have [`K`] photons.
fn median_reach(photons: &[Point3], questions: &[Point3]) -> f32 {
    let tree = PointTree::new(photons);
    let mut found = Neighbours::new();
    let mut squares: Vec<f32> = questions
        .iter()
        .take(200)
        .map(|p| {
            tree.nearest(*p, K, f32::MAX, &mut found);
            found.limit_squared()
        })
        .collect();
    squares.sort_by(f32::total_cmp);
    let reach = squares.get(squares.len() / 2).map_or(1.0, |square| square.sqrt());
    reach.clamp(1e-6, 1.0)
}

/// One structure on the bench.
struct Bench<'a> {
    settings: &'a NeighbourSettings,
    clock: &'a dyn Fn() -> Duration,
    distribution: Distribution,
    structure: Structure,
    photons: &'a [Point3],
    radius: f32,
}

impl Bench<'_> {
    fn make(&mut self) -> (PointIndex, Making) {
        let make = || PointIndex::new(self.structure, self.photons, self.radius);
        let build_s = self.fastest(|| drop(black_box(make())));
        let index = make();
        let depth = if let PointIndex::Growing(tree) = &index { Some(tree.depth()) } else { None };
        let Self { distribution, structure, photons, .. } = *self;
        let bytes = index.memory_bytes();
        (index, Making { distribution, structure, n_points: photons.len(), build_s, bytes, depth })
    }

    fn ask(
        &mut self,
        index: &PointIndex,
        questions: &[Point3],
        k: Option<usize>,
        radius_m: f32,
    ) -> Measurement {
        let mut found = Neighbours::new();
        let mut n_found = 0_u64;
        let time_s = self.fastest(|| {
            n_found = 0;
            for p in questions {
                if let Some(k) = k {
                    index.nearest(*p, k, radius_m, &mut found);
                    n_found += black_box(&found).iter().len() as u64;
                } else {
                    index.within(*p, radius_m, |neighbour| {
                        n_found += u64::from(black_box(neighbour).index < u32::MAX)
                    });
                }
            }
        });
        let n = questions.len().max(1) as f64;
        Measurement {
            distribution: self.distribution,
            structure: self.structure,
            n_points: self.photons.len(),
            k,
            radius_m,
            n_found: n_found as f64 / n,
            time_s: time_s / n,
        }
    }

    /// The least of several times: the one that other programs have disturbed least.
    fn fastest(&self, mut run: impl FnMut()) -> f64 {
        let time = |_| {
            let start = (self.clock)();
            run();
            (self.clock)() - start
        };
        (0..self.settings.n_rounds).map(time).min().unwrap_or_default().as_secs_f64()
    }
}

impl NeighbourStudy {
    /// Measurements of a structure over photons.
    fn of(&self, distribution: Distribution, structure: Structure) -> impl Iterator<Item = &Measurement> {
        self.measurements.iter().filter(move |m| m.distribution == distribution && m.structure == structure)
    }

    /// All measurements, one row for each: those of building first, whose `k` is empty and time that of one photon.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut text = String::from("what,photons,structure,n,k,radius_m,found,bytes,depth,seconds\n");
        for making in &self.makings {
            let Making { distribution, structure, n_points, build_s, bytes, depth } = making;
            let depth = depth.map(|depth| depth.to_string()).unwrap_or_default();
            let (photons, name) = (distribution.name(), structure.name());
            let time = build_s / (*n_points).max(1) as f64;
            let _ = writeln!(text, "build,{photons},{name},{n_points},,,,{bytes},{depth},{time:.4e}");
        }
        for m in &self.measurements {
            let (photons, name, n) = (m.distribution.name(), m.structure.name(), m.n_points);
            let (what, k) = m.k.map_or(("within", String::new()), |k| ("nearest", k.to_string()));
            let radius = if m.radius_m.is_finite() { format!("{:.5}", m.radius_m) } else { String::new() };
            let _ = writeln!(
                text,
                "{what},{photons},{name},{n},{k},{radius},{:.2},,,{:.4e}",
                m.n_found, m.time_s
            );
        }
        text
    }

    /// The figures of the greatest number of photons, for people.
    #[must_use]
    pub fn summary(&self) -> String {
        let mut text = String::new();
        let n = self.makings.iter().map(|making| making.n_points).max().unwrap_or(0);
        let _ = writeln!(
            text,
            "{n} photons; microseconds for a question, nanoseconds to build and bytes for a photon"
        );
        let _ = writeln!(
            text,
            "{:<14} {:<22} {:>10} {:>10} {:>8} {:>8} {:>8}",
            "photons", "structure", "nearest 50", "within", "build", "bytes", "levels"
        );
        for making in self.makings.iter().filter(|making| making.n_points == n) {
            let Making { distribution, structure, build_s, bytes, depth, .. } = making;
            let time = |k: Option<usize>| {
                let mut those = self.of(*distribution, *structure);
                those.find(|m| m.n_points == n && m.k == k).map_or(f64::NAN, |m| 1e6 * m.time_s)
            };
            let per_photon = |value: f64| value / n.max(1) as f64;
            let _ = writeln!(
                text,
                "{:<14} {:<22} {:>10.2} {:>10.2} {:>8.0} {:>8.1} {:>8}",
                distribution.name(),
                structure.name(),
                time(Some(K)),
                time(None),
                per_photon(1e9 * build_s),
                per_photon(*bytes as f64),
                depth.map(|depth| depth.to_string()).unwrap_or_default()
            );
        }
        text
    }

    /// For each scene: time against the number of photons, and against the number of neighbours.
    #[must_use]
    pub fn svg(&self) -> String {
        let n = self.makings.iter().map(|making| making.n_points).max().unwrap_or(0);
        let panels = Distribution::ALL.map(|distribution| {
            let name = distribution.name();
            let by_size = self.curves(distribution, |m| (m.k == Some(K)).then_some(m.n_points as f64));
            let by_k = self.curves(distribution, |m| m.k.filter(|_| m.n_points == n).map(|k| k as f64));
            [
                panel(format!("{name}: nearest {K}"), "photons", by_size),
                panel(format!("{name}: among {n} photons"), "neighbours", by_k),
            ]
        });
        draw(&panels.concat())
    }

    fn curves(&self, distribution: Distribution, x: impl Fn(&Measurement) -> Option<f64>) -> Vec<Series> {
        let curve = |structure: Structure| {
            let point = |m: &Measurement| Some([x(m)?, 1e6 * m.time_s]);
            let mut points: Vec<[f64; 2]> = self.of(distribution, structure).filter_map(point).collect();
            points.sort_by(|a, b| a[0].total_cmp(&b[0]));
            Series { name: structure.name().to_owned(), points, mark: Mark::LineAndDots }
        };
        Structure::ALL.map(curve).into_iter().filter(|series| !series.points.is_empty()).collect()
    }
}

fn panel(title: String, x_label: &str, series: Vec<Series>) -> Panel {
    Panel {
        title,
        x_label: x_label.to_owned(),
        y_label: "microseconds for a question".to_owned(),
        axes: Axes::Logarithmic,
        legend: Corner::UpperLeft,
        series,
        ..Panel::default()
    }
}
