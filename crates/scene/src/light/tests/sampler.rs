//! Choice among lights.

use etendue_geometry::TriangleMesh;
use etendue_math::statistics::chi_square_test;
use etendue_math::{Point2, warp};

use super::*;

/// Many points, spots and emissive triangles at random, a sun and a sky.
fn random_world(name: &str, n: usize) -> World {
    let mut rng = rng(name);
    let mut entities = Vec::new();
    let mut shapes = Vec::new();
    for i in 0..n {
        let mut place = || Point3::new(10.0 * rng.next_f32(), 10.0 * rng.next_f32(), 10.0 * rng.next_f32());
        let (p, q, r) = (place(), place(), place());
        let scale = floats(&[10.0_f32.powf(3.0 * rng.next_f32())]);
        match i % 3 {
            0 => {
                entities.push(Entity::new("point").with("from", Value::Points3(vec![p])).with("scale", scale))
            }
            1 => {
                let cone = 5.0 + 80.0 * rng.next_f32();
                let spot = Entity::new("spot")
                    .with("from", Value::Points3(vec![p]))
                    .with("to", Value::Points3(vec![q]));
                let spot = spot
                    .with("coneangle", floats(&[cone]))
                    .with("conedeltaangle", floats(&[cone * rng.next_f32()]));
                entities.push(spot.with("scale", scale));
            }
            _ => {
                let toward = |a: Point3| p.lerp(a, 0.1);
                let mesh = TriangleMesh {
                    positions: vec![p, toward(q), toward(r)],
                    indices: vec![[0, 1, 2]],
                    ..TriangleMesh::default()
                };
                let two_sided = Value::Bools(vec![rng.next_f32() < 0.3]);
                let emission = Entity::new("diffuse").with("scale", scale).with("twosided", two_sided);
                shapes.push((Shape::Triangles(mesh), Transform::IDENTITY, emission));
            }
        }
    }
    entities.push(Entity::new("distant"));
    entities.push(Entity::new("infinite"));
    let entities: Vec<LightEntity> = entities.into_iter().map(|e| placed(e, Transform::IDENTITY)).collect();
    World::new(&entities, shapes, &Assets::default())
}

fn random_reference(rng: &mut Rng) -> Reference {
    let mut coordinate = || 14.0 * rng.next_f32() - 2.0;
    let p = Point3::new(coordinate(), coordinate(), coordinate());
    let n = warp::sample_uniform_sphere(rng.next_point2());
    if rng.next_f32() < 0.7 { facing(p, n) } else { at(p) }
}

const KINDS: [LightSamplerKind; 3] =
    [LightSamplerKind::Uniform, LightSamplerKind::Power, LightSamplerKind::Tree];

#[test]
fn probabilities_of_lights_sum_to_one() {
    // One of the lights of a group is taken, unless none can contribute (a tree may find that out on the way down). For
    // trees, the two lights at infinity are groups of their own.
    let world = random_world("sum", 100);
    let mut rng = rng("sum references");
    for kind in KINDS {
        let sampler = LightSampler::new(kind, &world.lights, &world.context());
        for _ in 0..100 {
            let reference = random_reference(&mut rng);
            let ids = (0..world.lights.len() as u32).map(LightId);
            let sum: f64 = ids.map(|id| f64::from(sampler.pmf(&reference, id))).sum();
            if kind == LightSamplerKind::Tree {
                assert_eq!(sampler.n_groups(), 3);
                assert!(sum < 3.0 + 1e-4 && sum > 2.4, "{kind:?}: {sum}");
            } else {
                assert!((sum - 1.0).abs() < 1e-4, "{kind:?}: {sum}");
            }
        }
    }
}

#[test]
fn probabilities_sum_to_one_in_a_tree_of_lamps_that_shine_everywhere() {
    // Every branch can contribute, so no way down ends without a light.
    let mut rng = rng("everywhere");
    let mut place = || Point3::new(10.0 * rng.next_f32(), 10.0 * rng.next_f32(), 10.0 * rng.next_f32());
    let mut entities: Vec<LightEntity> = (0..200)
        .map(|_| {
            placed(Entity::new("point").with("from", Value::Points3(vec![place()])), Transform::IDENTITY)
        })
        .collect();
    entities.push(placed(Entity::new("infinite"), Transform::IDENTITY));
    let world = World::new(&entities, Vec::new(), &Assets::default());
    let sampler = LightSampler::new(LightSamplerKind::Tree, &world.lights, &world.context());
    let sky = LightId(200);
    for _ in 0..50 {
        let reference = random_reference(&mut rng);
        let sum: f64 = (0..201).map(|i| f64::from(sampler.pmf(&reference, LightId(i)))).sum();
        assert!((sum - 2.0).abs() < 1e-4, "{sum}");
        assert_eq!(sampler.sample(0, &reference, 0.3), Some((sky, 1.0)));
        assert_eq!(sampler.pmf(&reference, sky), 1.0);
    }
}

#[test]
fn lights_are_taken_as_often_as_their_probability_says() {
    // The histogram of sampled lights of the last group matches pmf, and each sample carries its own pmf.
    let world = random_world("histogram", 40);
    let mut rng = rng("histogram numbers");
    for kind in KINDS {
        let sampler = LightSampler::new(kind, &world.lights, &world.context());
        for _ in 0..3 {
            let reference = random_reference(&mut rng);
            const N: usize = 50_000;
            let last = sampler.n_groups() - 1;
            let is_in_group =
                |id: &LightId| last == 0 || world.lights[id.0 as usize].bounds(&world.context()).is_some();
            let mut observed = vec![0.0; world.lights.len() + 1];
            for _ in 0..N {
                let Some((id, pmf)) = sampler.sample(last, &reference, rng.next_f32()) else {
                    observed[world.lights.len()] += 1.0;
                    continue;
                };
                observed[id.0 as usize] += 1.0;
                assert_close(f64::from(pmf), f64::from(sampler.pmf(&reference, id)), 1e-5);
            }
            let ids = (0..world.lights.len() as u32).map(LightId);
            let share = |id| if is_in_group(&id) { f64::from(sampler.pmf(&reference, id)) } else { 0.0 };
            let mut expected: Vec<f64> = ids.map(|id| N as f64 * share(id)).collect();
            let none = (N as f64 - expected.iter().sum::<f64>()).max(0.0);
            expected.push(if none < 0.5 { 0.0 } else { none });
            let outcome = chi_square_test(&observed, &expected, 5.0, SIGNIFICANCE);
            outcome.unwrap_or_else(|error| panic!("{kind:?}: {error}"));
        }
    }
}

#[test]
fn no_sampler_misses_a_light_that_contributes() {
    // Where a light sends light to a point, its probability there is not 0, or images lose energy.
    let world = random_world("miss", 150);
    let (context, lambda) = (world.context(), some_wavelengths());
    let mut rng = rng("miss references");
    for kind in KINDS {
        let sampler = LightSampler::new(kind, &world.lights, &context);
        let mut n_contributing = 0;
        for _ in 0..300 {
            let reference = random_reference(&mut rng);
            for (index, light) in world.lights.iter().enumerate() {
                let u = rng.next_point2();
                if light.sample_li(&context, &reference, u, &lambda).is_none() {
                    continue;
                }
                n_contributing += 1;
                let pmf = sampler.pmf(&reference, LightId(index as u32));
                assert!(pmf > 0.0, "{kind:?}: light {index} {light:?} is missed at {reference:?}");
            }
        }
        assert!(n_contributing > 10_000);
    }
}

#[test]
fn references_on_the_edge_of_a_spot_see_it() {
    // Rounding at the border of the cone must not hide the light.
    for cone in [0.5_f32, 10.0, 45.0, 89.0, 120.0, 179.0] {
        let entity =
            Entity::new("spot").with("coneangle", floats(&[cone])).with("conedeltaangle", floats(&[0.0]));
        // With others, so many that one is chosen.
        let mut entities = vec![placed(entity, tilted())];
        entities.extend((0..4).map(|_| placed(Entity::new("point"), Transform::IDENTITY)));
        let world = World::new(&entities, Vec::new(), &Assets::default());
        let (context, lambda) = (world.context(), some_wavelengths());
        let sampler = LightSampler::new(LightSamplerKind::Tree, &world.lights, &context);
        assert_eq!(sampler.n_groups(), 1);
        let mut rng = rng("edge");
        for _ in 0..500 {
            let theta = cone.to_radians() * (1.0 + 1e-4 * (rng.next_f32() - 0.5));
            let phi = 6.3 * rng.next_f32();
            let local = Vector3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos());
            let reference = at(Point3::ORIGIN + tilted().vector(local) * 3.0);
            let lit = world.lights[0].sample_li(&context, &reference, Point2::splat(0.5), &lambda).is_some();
            assert!(!lit || sampler.pmf(&reference, LightId(0)) > 0.0, "cone {cone}, angle {theta}");
        }
    }
}

#[test]
fn the_tree_prefers_near_lights() {
    // Of five equal lamps, one 1 m and four 10 m away, the near one gives 25 times the light of the others and most of the
    // samples.
    let entities = [1.0, -10.0, -10.0, -10.0, -10.0]
        .map(|x| placed(Entity::new("point").with("from", point(x, 0.0, 0.0)), Transform::IDENTITY));
    let world = World::new(&entities, Vec::new(), &Assets::default());
    let sampler = LightSampler::new(LightSamplerKind::Tree, &world.lights, &world.context());
    let pmf = sampler.pmf(&at(Point3::ORIGIN), LightId(0));
    assert_close(f64::from(pmf), 100.0 / 104.0, 1e-3);
}

#[test]
fn few_lamps_are_all_asked() {
    // Up to four lamps and a sky are groups of their own, taken surely, wherever they are.
    let lamps = [1.0, -10.0, 3.0, 7.0]
        .map(|x| placed(Entity::new("point").with("from", point(x, 0.0, 0.0)), Transform::IDENTITY));
    let mut entities = lamps.to_vec();
    entities.push(placed(Entity::new("infinite"), Transform::IDENTITY));
    let world = World::new(&entities, Vec::new(), &Assets::default());
    let sampler = LightSampler::new(LightSamplerKind::Tree, &world.lights, &world.context());
    let reference = at(Point3::ORIGIN);
    let mut found: Vec<u32> = (0..sampler.n_groups())
        .map(|group| {
            let (id, pmf) = sampler.sample(group, &reference, 0.5).expect("a light");
            assert_eq!((pmf, sampler.pmf(&reference, id)), (1.0, 1.0));
            id.0
        })
        .collect();
    found.sort_unstable();
    assert_eq!(found, [0, 1, 2, 3, 4]);
}

#[test]
fn the_power_sampler_follows_power() {
    // EMI-9: lights are drawn in proportion to their flux, so that photons carry equal power.
    let entities: Vec<LightEntity> = [100.0, 300.0, 0.0]
        .map(|lumens| {
            let (name, value) = if lumens > 0.0 { ("power", lumens) } else { ("scale", 0.0) };
            placed(Entity::new("point").with(name, floats(&[value])), Transform::IDENTITY)
        })
        .to_vec();
    let world = World::new(&entities, Vec::new(), &Assets::default());
    let sampler = LightSampler::new(LightSamplerKind::Power, &world.lights, &world.context());
    let pmf: Vec<f32> = (0..3).map(|i| sampler.pmf_anywhere(LightId(i))).collect();
    assert_close(f64::from(pmf[0]), 0.25, 1e-5);
    assert_close(f64::from(pmf[1]), 0.75, 1e-5);
    assert_eq!(pmf[2], 0.0);
}

#[test]
fn samplers_bear_no_lights_dark_lights_and_a_single_light() {
    // Without light nothing is sampled; a single light is always taken.
    let none = World::new(&[], Vec::new(), &Assets::default());
    let dark = World::of(Entity::new("point").with("scale", floats(&[0.0])));
    let single = World::of(Entity::new("point"));
    let sky = World::of(Entity::new("infinite"));
    let reference = at(Point3::new(1.0, 2.0, 3.0));
    for kind in KINDS {
        let sampler = |world: &World| LightSampler::new(kind, &world.lights, &world.context());
        assert!(sampler(&none).sample(0, &reference, 0.5).is_none());
        if kind != LightSamplerKind::Uniform {
            assert!(sampler(&dark).sample(0, &reference, 0.5).is_none());
            assert_eq!(sampler(&dark).pmf(&reference, LightId(0)), 0.0);
        }
        for world in [&single, &sky] {
            for u in [0.0, 0.3, 0.999_999_94] {
                assert_eq!(sampler(world).sample(0, &reference, u), Some((LightId(0), 1.0)));
            }
            assert_eq!(sampler(world).pmf(&reference, LightId(0)), 1.0);
        }
    }
}

#[test]
fn coincident_lights_share_evenly() {
    // Lights at one place cannot be told apart by a tree, which must still find each of them.
    let entities: Vec<LightEntity> =
        (0..37).map(|_| placed(Entity::new("point"), Transform::IDENTITY)).collect();
    let world = World::new(&entities, Vec::new(), &Assets::default());
    let sampler = LightSampler::new(LightSamplerKind::Tree, &world.lights, &world.context());
    for p in [Point3::ORIGIN, Point3::new(1.0, 0.0, 0.0)] {
        let sum: f64 = (0..37).map(|i| f64::from(sampler.pmf(&at(p), LightId(i)))).sum();
        assert!((sum - 1.0).abs() < 1e-4);
        assert!((0..37).all(|i| sampler.pmf(&at(p), LightId(i)) > 0.005));
    }
}
