//! All ways to find light agree in the mean, and weighting them pays (SPEC PT-1, PT-3, MC-11, MC-12, MC-15).

use std::sync::atomic::{AtomicU64, Ordering};

use etendue_math::statistics::{Moments, mean_test};
use etendue_math::{Rng, warp};
use etendue_scene::Film;
use etendue_transport::lpe::PathExpressions;
use etendue_transport::{Flow, Integrator, Observer, RayCounts, Stop, method, render};

use crate::support::{
    Setup, block_moments, expect_agreement, expect_same_image, flat, lit, luminance, seed, significance,
};

/// A box with an open front, light below the ceiling.
pub(crate) fn open_box(objects: &str) -> String {
    let wall = |albedo: f64, corners: &str| {
        format!(
            "Material \"diffuse\" {} Shape \"bilinearmesh\" \"point3 P\" [{corners}]\n",
            flat("reflectance", albedo)
        )
    };
    let walls = [
        wall(0.7, "-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1"),
        wall(0.7, "-1 1 -1  1 1 -1  -1 1 1  1 1 1"),
        wall(0.7, "-1 -1 1  1 -1 1  -1 1 1  1 1 1"),
        wall(0.2, "-1 -1 -1  -1 -1 1  -1 1 -1  -1 1 1"),
        wall(0.5, "1 -1 -1  1 -1 1  1 1 -1  1 1 1"),
    ];
    format!("{} {objects}", walls.concat())
}

pub(crate) fn ceiling_light(half_width: f64) -> String {
    let w = half_width;
    format!(
        "AttributeBegin AreaLightSource \"diffuse\" {} Material \"diffuse\" {}
        Shape \"bilinearmesh\" \"point3 P\" [-{w} 0.98 -{w}  {w} 0.98 -{w}  -{w} 0.98 {w}  {w} 0.98 {w}]
        AttributeEnd\n",
        lit("L", 5.0),
        flat("reflectance", 0.0)
    )
}

fn ball(material: &str, x: f64) -> String {
    format!(
        "AttributeBegin Translate {x} -0.6 0 Material {material} Shape \"sphere\" \"float radius\" 0.4 AttributeEnd\n"
    )
}

pub(crate) const FRONT: &str = "LookAt 0 0 -3.4  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 42";

pub(crate) fn blocks(name: &str, world: &str, integrator: &str, n_passes: u64) -> Vec<Moments> {
    let setup = Setup { size: [24, 24], integrator, camera: FRONT, world, ..Setup::default() };
    block_moments(&setup.scene(name), n_passes, 3)
}

/// PT-3, MC-12, EQ-2: sampling lights (an integral over their area), running into them (an integral over directions) and
/// both together, weighted, have one expectation.
#[test]
fn techniques_agree_among_diffuse_walls() {
    let world = open_box(&(ceiling_light(0.4) + &ball("\"diffuse\"", 0.3)));
    let render = |lights: &str, n_passes| {
        let integrator = format!("\"integer maxdepth\" 4 \"string lights\" \"{lights}\"");
        blocks(&format!("diffuse box by {lights}"), &world, &integrator, n_passes)
    };
    let (both, lights, scattering) = (render("both", 160), render("lights", 200), render("scattering", 400));
    expect_same_image("both and lights", &both, &lights, 0.03);
    expect_same_image("both and scattering", &both, &scattering, 0.06);
    // PT-3: variance is lower.
    let whole = both.len() - 1;
    assert!(scattering[whole].variance() > 3.0 * both[whole].variance());
}

/// The same where metal and glass, smooth and rough, take part.
#[test]
fn techniques_agree_among_glossy_objects() {
    let objects = [
        ceiling_light(0.6),
        ball("\"conductor\" \"float roughness\" 0.05", -0.5),
        ball("\"dielectric\" \"float eta\" 1.5", 0.5),
        "Translate 0 0.8 0.4\n".to_owned(),
        ball("\"coateddiffuse\" \"float roughness\" 0.3", 0.0),
    ]
    .concat();
    let world = open_box(&objects);
    let render = |lights: &str, n_passes| {
        let integrator = format!("\"integer maxdepth\" 5 \"string lights\" \"{lights}\"");
        blocks(&format!("glossy box by {lights}"), &world, &integrator, n_passes)
    };
    let (both, scattering) = (render("both", 150), render("scattering", 300));
    expect_same_image("both and scattering", &both, &scattering, 0.06);
    let whole = both.len() - 1;
    assert!(scattering[whole].variance() > 2.0 * both[whole].variance());
}

/// MC-12: a polished plate below a large light and a rough one below a small light. Sampling lights is bad at the one,
/// scattering at the other; weighted they are better than either.
#[test]
fn weighting_beats_each_technique() {
    let world = format!(
        "AttributeBegin Material \"conductor\" \"float roughness\" 0.05 \"bool remaproughness\" false
        Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1  0 -1 -1  -1 -1 1  0 -1 1] AttributeEnd
        AttributeBegin Material \"conductor\" \"float roughness\" 0.6 \"bool remaproughness\" false
        Shape \"bilinearmesh\" \"point3 P\" [0 -1 -1  1 -1 -1  0 -1 1  1 -1 1] AttributeEnd
        AttributeBegin Translate -0.5 0 1.2 AreaLightSource \"diffuse\" {} Shape \"sphere\" \"float radius\" 0.4 AttributeEnd
        AttributeBegin Translate 0.5 -0.2 0.6 AreaLightSource \"diffuse\" {} Shape \"sphere\" \"float radius\" 0.05
        AttributeEnd",
        lit("L", 1.0),
        lit("L", 40.0)
    );
    let camera = "LookAt 0 0.2 -2  0 -1 0.2  0 1 0 Camera \"perspective\" \"float fov\" 35";
    let render = |lights: &str, n_passes| {
        let integrator = format!("\"integer maxdepth\" 1 \"string lights\" \"{lights}\"");
        let setup =
            Setup { size: [24, 24], integrator: &integrator, camera, world: &world, ..Setup::default() };
        block_moments(&setup.scene(&format!("plates by {lights}")), n_passes, 2)
    };
    // Few scattered rays find the small light.
    let (both, lights, scattering) = (render("both", 300), render("lights", 300), render("scattering", 600));
    expect_same_image("both and lights", &both, &lights, 0.1);
    expect_same_image("both and scattering", &both, &scattering, 0.1);
    let whole = both.len() - 1;
    assert!(lights[whole].variance() > 1.5 * both[whole].variance(), "{both:?} {lights:?} {scattering:?}");
    assert!(scattering[whole].variance() > 1.5 * both[whole].variance());
}

/// EXP-25, PT-1: nothing runs into a point. Without sampling it is never found and the image is black, to the last bit.
#[test]
fn point_lights_must_be_sampled() {
    let world = open_box(&format!("LightSource \"point\" {} \"point3 from\" [0 0.5 0]", lit("I", 1.0)));
    let render = |lights: &str| {
        let integrator = format!("\"integer maxdepth\" 4 \"string lights\" \"{lights}\"");
        let setup = Setup { integrator: &integrator, camera: FRONT, world: &world, ..Setup::default() };
        luminance(&setup.film("point light", 16))
    };
    assert!(render("scattering").iter().all(|v| *v == 0.0));
    assert!(render("both").iter().all(|v| *v > 0.0));
    // What sampling alone finds is the same to the bit: the weight of a point is 1.
    assert_eq!(render("both"), render("lights"));
}

/// MC-11: where roulette starts, in depth and in throughput, changes neither the mean nor a block of it; it saves rays and
/// costs variance.
#[test]
fn roulette_keeps_the_mean() {
    let world = open_box(&(ceiling_light(0.4) + &ball("\"dielectric\"", -0.4)));
    let integrator = |depth: u32, threshold: f32| {
        format!(
            "\"integer maxdepth\" 12 \"integer roulettedepth\" {depth} \"float roulettethreshold\" {threshold}"
        )
    };
    let render = |depth, threshold| {
        blocks(
            &format!("roulette after {depth} below {threshold}"),
            &world,
            &integrator(depth, threshold),
            120,
        )
    };
    let without = render(100, 0.5);
    for (depth, threshold) in [(0, 1.0), (0, 0.5), (1, 0.5), (4, 2.0), (0, 0.0)] {
        let title = format!("roulette after {depth} below {threshold}");
        expect_same_image(&title, &render(depth, threshold), &without, 0.05);
    }
    let rays = |depth, threshold| count_rays(&world, &integrator(depth, threshold));
    assert!(rays(0, 1.0) < rays(100, 1.0) / 2);
    assert!(rays(0, 1.0) < rays(0, 0.5) && rays(0, 0.5) < rays(0, 0.0));
    assert_eq!(rays(0, 0.0), rays(100, 1.0));
}

#[derive(Debug, Default)]
struct RayCounter(AtomicU64);

impl Observer for RayCounter {
    fn tile_done(&self, _: u64, rays: RayCounts) -> Flow {
        self.0.fetch_add(rays.closest + rays.shadow, Ordering::Relaxed);
        Flow::Continue
    }

    fn pass_done(&self, _: u64, _: &Film, _: &dyn Integrator) -> Flow {
        Flow::Continue
    }
}

/// Rays of all kinds in four passes.
pub(crate) fn count_rays(world: &str, integrator: &str) -> u64 {
    let setup = Setup { size: [24, 24], integrator, camera: FRONT, world, ..Setup::default() };
    let scene = setup.scene("rays");
    let mut film = Film::new(scene.film.clone(), Vec::new());
    let (integrator, _) = method(&scene.integrator, PathExpressions::default());
    let counter = RayCounter::default();
    let stop = Stop { passes: 0..4, error: None };
    render(&scene, integrator.expect("the path tracer").as_mut(), &mut film, &stop, &counter);
    counter.0.into_inner()
}

/// However one of many lights is chosen, all are counted: points, spots, the sky, spheres and triangles.
#[test]
fn light_samplers_agree() {
    let mut lights = format!("LightSource \"infinite\" {}\n", lit("L", 0.05));
    let mut rng = Rng::new(seed("many lights"), 0);
    for index in 0..24 {
        let [x, y, z] = [0; 3].map(|_| rng.next_f32() - 0.5);
        let light = match index % 4 {
            0 => format!("LightSource \"point\" {} \"point3 from\" [{x} {y} {z}]\n", lit("I", 0.02)),
            1 => format!(
                "LightSource \"spot\" {} \"point3 from\" [{x} {y} {z}] \"point3 to\" [{z} -1 {x}] \"float coneangle\" 40\n",
                lit("I", 0.1)
            ),
            2 => format!(
                "AttributeBegin Translate {x} {y} {z} AreaLightSource \"diffuse\" {} Shape \"sphere\" \"float radius\" 0.05
                AttributeEnd\n",
                lit("L", 2.0)
            ),
            _ => format!(
                "AttributeBegin Translate {x} {y} {z} AreaLightSource \"diffuse\" {} \"bool twosided\" {}
                Shape \"trianglemesh\" \"point3 P\" [0 0 0  0.1 0 0.05  0 0.1 0.1] AttributeEnd\n",
                lit("L", 6.0),
                index % 8 == 3
            ),
        };
        lights += &light;
    }
    let world = open_box(&lights);
    let render = |sampler: &str| {
        let integrator = format!("\"integer maxdepth\" 2 \"string lightsampler\" \"{sampler}\"");
        blocks(&format!("lights by {sampler}"), &world, &integrator, 200)
    };
    let (uniform, power, tree) = (render("uniform"), render("power"), render("bvh"));
    expect_same_image("uniform and power", &uniform, &power, 0.08);
    expect_same_image("uniform and bvh", &uniform, &tree, 0.08);
}

/// A sun and a sky are both asked at every point, though one shadow ray is traced: the same image as by drawing one of
/// them blindly, and less variance.
#[test]
fn lights_at_infinity_are_all_asked() {
    let sun = format!("LightSource \"distant\" {} \"point3 from\" [0.3 0.4 -1]\n", lit("L", 3.0));
    let world = open_box(&format!("LightSource \"infinite\" {}\n{sun}", lit("L", 0.2)));
    let render = |sampler: &str| {
        let integrator = format!("\"integer maxdepth\" 2 \"string lightsampler\" \"{sampler}\"");
        blocks(&format!("sun and sky by {sampler}"), &world, &integrator, 200)
    };
    let (uniform, tree) = (render("uniform"), render("bvh"));
    expect_same_image("uniform and bvh", &uniform, &tree, 0.05);
    let whole = uniform.len() - 1;
    assert!(tree[whole].variance() < uniform[whole].variance());
}

/// Over a long floor under a row of lamps, a point is lit by those near it: choosing by place has a fraction of the
/// variance of choosing blindly, and the same mean.
#[test]
fn light_tree_knows_places() {
    let mut world =
        "Material \"diffuse\" Shape \"bilinearmesh\" \"point3 P\" [-9 0 -1  9 0 -1  -9 0 1  9 0 1]\n"
            .to_owned();
    for index in 0..32 {
        let x = 0.5 * f64::from(index) - 7.75;
        world += &format!("LightSource \"point\" {} \"point3 from\" [{x} 0.4 0]\n", lit("I", 0.3));
    }
    let camera = "LookAt 0 9 0  0 0 0  0 0 1 Camera \"orthographic\" \"float screenwindow\" [-8 8 -1 1]";
    let render = |sampler: &str| {
        let integrator = format!("\"integer maxdepth\" 1 \"string lightsampler\" \"{sampler}\"");
        let setup =
            Setup { size: [64, 8], integrator: &integrator, camera, world: &world, ..Setup::default() };
        block_moments(&setup.scene(&format!("lamps by {sampler}")), 100, 4)
    };
    let (uniform, tree) = (render("uniform"), render("bvh"));
    expect_same_image("uniform and bvh", &uniform, &tree, 0.1);
    let whole = tree.len() - 1;
    assert!(tree[whole].variance() < 0.2 * uniform[whole].variance(), "{tree:?} {uniform:?}");
}

/// MC-15: the reflected radiance of a diffuse surface estimated by uniform and by cosine-distributed directions: one mean,
/// which for L = 1 + cos is rho (1 + 2/3), and less variance with the cosine in the density.
#[test]
fn estimators_of_reflected_light() {
    let (rho, n) = (0.7, 100_000);
    let incoming = |cos: f64| 1.0 + cos;
    let mut rng = Rng::new(seed("estimators"), 0);
    let uniform: Moments = (0..n)
        .map(|_| {
            let cos = f64::from(warp::sample_uniform_hemisphere(rng.next_point2()).z);
            2.0 * rho * cos * incoming(cos)
        })
        .collect();
    let cosine: Moments = (0..n)
        .map(|_| rho * incoming(f64::from(warp::sample_cosine_hemisphere(rng.next_point2()).z)))
        .collect();
    let expected = rho * (1.0 + 2.0 / 3.0);
    mean_test(&uniform, expected, significance()).unwrap();
    mean_test(&cosine, expected, significance()).unwrap();
    expect_agreement("uniform and cosine", &uniform, &cosine, 0.02);
    assert!(cosine.variance() < 0.2 * uniform.variance());
}

/// The same through a window: the sky behind a portal is sampled through it, and met by paths that leave through it.
#[test]
fn techniques_agree_through_a_portal() {
    let room = "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]
        Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1]
        Shape \"bilinearmesh\" \"point3 P\" [-1 1 -1  1 1 -1  -1 1 1  1 1 1]
        Shape \"bilinearmesh\" \"point3 P\" [-1 -1 1  1 -1 1  -1 1 1  1 1 1]
        Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1  -1 -1 1  -1 1 -1  -1 1 1]
        Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -4  1 -1 -4  -1 1 -4  1 1 -4]
        Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -4  -1 -1 -1  -1 1 -4  -1 1 -1]
        Shape \"bilinearmesh\" \"point3 P\" [1 -1 -4  1 -1 -1  1 1 -4  1 1 -1]
        Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -4  1 -1 -4  -1 -1 -1  1 -1 -1]
        Shape \"bilinearmesh\" \"point3 P\" [-1 1 -4  1 1 -4  -1 1 -1  1 1 -1]\n";
    let sky = |portal: &str| format!("{room} LightSource \"infinite\" {} {portal}", lit("L", 1.0));
    let portal = "\"point3 portal\" [1 -1 -1  1 -1 1  1 1 1  1 1 -1]";
    let render = |world: &str, lights: &str, n_passes| {
        let integrator = format!("\"integer maxdepth\" 3 \"string lights\" \"{lights}\"");
        blocks(&format!("window by {lights}"), world, &integrator, n_passes)
    };
    let open = render(&sky(""), "scattering", 200);
    let both = render(&sky(portal), "both", 100);
    expect_same_image("portal and open sky", &both, &open, 0.05);
    expect_same_image("portal sampled", &render(&sky(portal), "lights", 100), &both, 0.05);
    expect_same_image("portal met", &render(&sky(portal), "scattering", 200), &both, 0.05);
}

/// The same on a coarse mesh with interpolated normals, where geometric and shading side may differ: both techniques must
/// draw the line in the same place.
#[test]
fn techniques_agree_on_shading_normals() {
    let octahedron = "Shape \"trianglemesh\" \"point3 P\" [1 0 0  -1 0 0  0 1 0  0 -1 0  0 0 1  0 0 -1]
        \"normal N\" [1 0 0  -1 0 0  0 1 0  0 -1 0  0 0 1  0 0 -1]
        \"integer indices\" [0 2 4  2 1 4  1 3 4  3 0 4  2 0 5  1 2 5  3 1 5  0 3 5]";
    for material in [
        "\"diffuse\"",
        "\"conductor\" \"float roughness\" 0.2",
        "\"dielectric\" \"float roughness\" 0.2",
        "\"coateddiffuse\" \"float roughness\" 0.2",
        "\"diffusetransmission\"",
    ] {
        let objects = format!(
            "AttributeBegin Rotate 30 1 2 3 Scale 0.7 0.7 0.7 Material {material} {octahedron} AttributeEnd\n"
        );
        let world = open_box(&(ceiling_light(0.6) + &objects));
        let render = |lights: &str, n_passes| {
            let integrator = format!("\"integer maxdepth\" 3 \"string lights\" \"{lights}\"");
            blocks(&format!("{material} by {lights}"), &world, &integrator, n_passes)
        };
        expect_same_image(material, &render("both", 80), &render("scattering", 160), 0.08);
    }
}
