//! Tests of the built-in models.

use std::collections::{HashMap, HashSet};

use super::{Model, RayKind, Task, TaskSize, ray_sets, tasks};

/// The models have as many triangles as they should.
#[test]
fn sizes() {
    assert_eq!(Model::cornell_box().n_triangles(), 32);
    assert_eq!(Model::terrain(30).n_triangles(), 1800);
    let fractal = Model::fractal_box(2);
    assert_eq!((fractal.n_triangles(), fractal.copies.len()), (12 * 400, 400));
}

/// A cube is closed: each edge is used once in each direction.
#[test]
fn cubes_are_closed() {
    let model = Model::fractal_box(0);
    let mesh = &model.meshes[0];
    let corner = |i: u32| [mesh.positions[i as usize]].map(|p| [p.x, p.y, p.z].map(f32::is_sign_negative));
    let mut edges = HashMap::new();
    for [a, b, c] in &mesh.indices {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry((corner(*from), corner(*to))).or_insert(0) += 1;
        }
    }
    assert_eq!(edges.len(), 36);
    assert!(edges.iter().all(|((from, to), n)| *n == 1 && edges.contains_key(&(*to, *from))));
}

/// Rays of every kind exist for every model, and a good part of those that look for the nearest hit find one.
#[test]
fn rays_hit() {
    for model in [Model::cornell_box(), Model::terrain(60), Model::fractal_box(1)] {
        let geometry = model.clone().into_builder().build();
        for set in ray_sets(&model, &geometry, [32, 24]) {
            assert!(!set.rays.is_empty(), "{} {}", model.name, set.kind.name());
            let hits = set.count_hits(&geometry, 0..set.rays.len());
            let share = hits as f64 / set.rays.len() as f64;
            assert!(
                set.kind == RayKind::Shadow || share > 0.05,
                "{} {}: {share}",
                model.name,
                set.kind.name()
            );
        }
    }
}

/// Every task does some work, also with several threads, and no two have the same name.
#[test]
fn tasks_work() {
    let (tasks, _) = tasks(&TaskSize::TINY);
    let amounts: Vec<u64> = tasks.iter().map(Task::run).collect();
    assert!(amounts.iter().all(|n| *n > 0), "{amounts:?}");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("threads start");
    assert_eq!(pool.install(|| tasks.iter().map(Task::run).collect::<Vec<_>>()), amounts);
    let keys: HashSet<&str> = tasks.iter().map(|task| task.key).collect();
    assert_eq!(keys.len(), tasks.len());
}
