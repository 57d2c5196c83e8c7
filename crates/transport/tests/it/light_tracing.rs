//! Light tracing against path tracing: the same image but for what the camera sees in mirrors and through glass (SPEC BDPT-7,
//! LPE-3, LPE-4).

use etendue_math::statistics::Moments;
use etendue_scene::document::{Entity, Value};
use etendue_scene::{Film, Scene};

use crate::support::{
    Setup, block_means, expect_agreement, expect_equal_pixels, expect_mean, flat, layer, lit, luminance,
    render_layers, render_passes,
};

/// What light tracing finds: the camera sees light, or a surface that scatters in more than single directions.
const FOUND: &str = "L[SDG]*[DG]E|LE";
/// Blocks along a side of the picture.
const N_BLOCKS: usize = 6;
const SIZE: u32 = 48;
const FLOOR: &str =
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1] \"integer indices\" [0 1 2 3]";
/// Floor, back wall and a ball, coloured.
pub(crate) const THINGS: &str = "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0.7 0.6 0.4]
    Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1]
    Material \"diffuse\" \"rgb reflectance\" [0.3 0.5 0.8]
    Shape \"bilinearmesh\" \"point3 P\" [-1 -1 1  1 -1 1  -1 1 1  1 1 1]
    Material \"coateddiffuse\" \"float roughness\" 0.3 Translate 0.2 -0.6 0.1 Shape \"sphere\" \"float radius\" 0.4 AttributeEnd";
const LOOK: &str = "LookAt 0 0.2 -3.5  0 0 0  0 1 0";

pub(crate) fn pinhole() -> String {
    format!("{LOOK} Camera \"perspective\" \"float fov\" 40")
}

/// The method `light` with these depth and switches.
fn light(max_depth: i32) -> Entity {
    Entity::new("light").with("maxdepth", Value::Integers(vec![max_depth]))
}

/// The same scene by light tracing.
fn by_light(setup: &Setup<'_>, name: &str, max_depth: i32) -> Scene {
    let mut scene = setup.scene(&format!("{name} by light"));
    scene.integrator = light(max_depth);
    scene
}

/// Moments over passes of the blocks of what `values` takes from a film, and last of the whole.
fn moments(
    scene: &Scene,
    n_passes: u64,
    layers: &[(&str, &str)],
    values: impl Fn(&Film) -> Vec<f64>,
) -> Vec<Moments> {
    let mut blocks = vec![Moments::new(); N_BLOCKS * N_BLOCKS + 1];
    for pass in 0..n_passes {
        let values = values(&render_layers(scene, pass..pass + 1, layers));
        let mut means = block_means(&values, scene.film.resolution[0] as usize, N_BLOCKS);
        means.push(values.iter().sum::<f64>() / values.len() as f64);
        for (moments, mean) in blocks.iter_mut().zip(means) {
            moments.push(mean);
        }
    }
    blocks
}

/// Demands agreement of the whole, and of the blocks that are not dark: in those the one method sees a rare path where the other saw
/// none, of which its variance does not tell.
#[track_caller]
fn expect_same(what: &str, a: &[Moments], b: &[Moments], resolution: f64) {
    let (blocks, whole) = (a.len() - 1, a.len() - 1);
    let brightest = b[..blocks].iter().map(Moments::mean).fold(0.0, f64::max);
    for block in (0..blocks).filter(|block| a[*block].mean() + b[*block].mean() > 0.2 * brightest) {
        expect_agreement(&format!("{what}, block {block}"), &a[block], &b[block], f64::INFINITY);
    }
    expect_agreement(what, &a[whole], &b[whole], resolution);
}

/// Demands that light tracing gives what path tracing does but for what it cannot find.
#[track_caller]
pub(crate) fn check_with(name: &str, setup: &Setup<'_>, max_depth: i32, n_passes: u64, resolution: f64) {
    let integrator = format!("\"integer maxdepth\" {max_depth}");
    let setup = Setup { integrator: &integrator, size: [SIZE, SIZE], ..*setup };
    let path = moments(&setup.scene(name), n_passes, &[("found", FOUND)], |film| layer(film, "found"));
    let light = moments(&by_light(&setup, name, max_depth), n_passes, &[], luminance);
    expect_same(name, &light, &path, resolution);
}

#[track_caller]
fn check(name: &str, world: &str) {
    check_with(name, &Setup { camera: &pinhole(), world, ..Setup::default() }, 4, 32, 0.1);
}

/// Every kind of light shows the same things the same.
#[test]
fn all_lights_agree() {
    let from_above = "Translate 0.3 0.9 -0.5 Rotate 90 1 0 0";
    let lights = [
        ("point", format!("LightSource \"point\" {} \"point3 from\" [0.4 0.8 -0.7]", lit("I", 2.0))),
        ("spot", format!("LightSource \"spot\" {} \"point3 from\" [-0.5 1 -1] \"point3 to\" [0 -0.8 0]", lit("I", 6.0))),
        ("distant", format!("LightSource \"distant\" {} \"point3 from\" [1 2 -1] \"point3 to\" [0 0 0]", lit("L", 3.0))),
        (
            "lamp",
            format!(
                "AttributeBegin AreaLightSource \"diffuse\" {} {from_above} Shape \"disk\" \"float radius\" 0.3 AttributeEnd",
                lit("L", 9.0)
            ),
        ),
        (
            "two-sided lamps",
            format!(
                "AttributeBegin AreaLightSource \"diffuse\" {} \"bool twosided\" true
                Shape \"trianglemesh\" \"point3 P\" [-0.9 0.5 0  -0.4 0.9 0.2  -0.8 0.9 -0.3  -0.2 0.1 -0.4] \"integer indices\" [0 1 2 1 2 3]
                AttributeEnd",
                lit("L", 9.0)
            ),
        ),
        (
            "glowing ball",
            format!(
                "AttributeBegin AreaLightSource \"diffuse\" {} Translate -0.5 0.3 -0.3 Shape \"sphere\" \"float radius\" 0.2 AttributeEnd",
                lit("L", 9.0)
            ),
        ),
        ("sky", format!("LightSource \"infinite\" {}", lit("L", 1.0))),
    ];
    for (name, light) in lights {
        check(&format!("light from {name}"), &format!("{THINGS}\n{light}"));
    }
}

/// Caustics of glass and mirrors on a floor, from a lamp large enough for path tracing to find; the glass itself stays black.
#[test]
fn caustics_agree() {
    let lamp = format!(
        "AttributeBegin AreaLightSource \"diffuse\" {} Translate 0 0.99 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 0.8 AttributeEnd",
        lit("L", 4.0)
    );
    for (name, material) in [
        ("glass", "Material \"dielectric\""),
        ("tinted glass", "Material \"dielectric\" \"spectrum absorption\" [400 2 550 0.5 700 0.2]"),
        ("prism glass", "Material \"dielectric\" \"spectrum eta\" \"glass-SF11\""),
        ("rough glass", "Material \"dielectric\" \"float roughness\" 0.3"),
        ("mirror", "Material \"conductor\""),
        ("thin glass", "Material \"thindielectric\""),
    ] {
        let world = format!(
            "{THINGS} {lamp} AttributeBegin Translate -0.5 -0.5 -0.3 {material} Shape \"sphere\" \"float radius\" 0.35 AttributeEnd"
        );
        let setup = Setup { camera: &pinhole(), world: &world, ..Setup::default() };
        check_with(&format!("caustic of {name}"), &setup, 6, 32, 0.06);
    }
}

/// What is between lamp, surface and camera: holes, interfaces, instances, motion; and what surfaces do to normals.
#[test]
fn all_ways_agree() {
    let lamp = format!(
        "AttributeBegin AreaLightSource \"diffuse\" {} Translate 0 0.99 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 0.6 AttributeEnd",
        lit("L", 6.0)
    );
    for (name, things) in [
        ("holes", format!("{THINGS} Translate 0 0 -0.7 Material \"diffuse\" Shape \"sphere\" \"float radius\" 0.6 \"float alpha\" 0.4")),
        ("interfaces", format!("{THINGS} Translate 0 0 -0.7 Material \"interface\" Shape \"sphere\" \"float radius\" 0.7")),
        (
            "instances",
            format!("{THINGS} ObjectBegin \"ball\" Material \"diffuse\" Shape \"sphere\" \"float radius\" 0.2 ObjectEnd
            AttributeBegin Translate -0.5 -0.8 -0.4 ObjectInstance \"ball\" AttributeEnd
            AttributeBegin Translate -0.5 0.2 0.4 Scale 2 1 1 ObjectInstance \"ball\" AttributeEnd"),
        ),
        (
            "motion",
            format!("{THINGS} AttributeBegin ActiveTransform EndTime Translate 0.8 0.3 0 ActiveTransform All
            Translate -0.5 -0.3 -0.5 Shape \"sphere\" \"float radius\" 0.3 AttributeEnd"),
        ),
        (
            "bent normals",
            "Material \"diffuse\" Shape \"trianglemesh\" \"point3 P\" [-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1] \"integer indices\" [0 1 2 1 3 2]
            \"normal N\" [-0.5 1 0.3  0.5 1 0.3  -0.2 1 -0.6  0.6 1 0.6]".to_owned(),
        ),
        (
            "texture",
            format!("Texture \"squares\" \"spectrum\" \"checkerboard\" \"float uscale\" 5 \"float vscale\" 5 Material \"diffuse\" \"texture reflectance\" \"squares\" {FLOOR}"),
        ),
    ] {
        check(name, &format!("{lamp}\n{things}"));
    }
}

/// Every camera to which light can be traced gives the same picture by both methods.
#[test]
fn all_cameras_agree() {
    let world = format!(
        "{THINGS} LightSource \"infinite\" {}
        AttributeBegin AreaLightSource \"diffuse\" {} Translate -0.4 0.9 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 0.3 AttributeEnd",
        lit("L", 0.1), lit("L", 9.0)
    );
    let moving = "ActiveTransform EndTime Translate 0.3 0.1 0 ActiveTransform All";
    for (name, camera) in [
        (
            "thin lens",
            format!(
                "{LOOK} Camera \"perspective\" \"float fov\" 40 \"float lensradius\" 0.2 \"float focaldistance\" 3"
            ),
        ),
        (
            "blades",
            format!(
                "{LOOK} Camera \"perspective\" \"float fov\" 40 \"float lensradius\" 0.2 \"float focaldistance\" 3 \"integer blades\" 5"
            ),
        ),
        (
            "wide window",
            format!(
                "{LOOK} Camera \"perspective\" \"float fov\" 80 \"float screenwindow\" [-0.5 0.7 -1 0.4]"
            ),
        ),
        ("parallel", format!("{LOOK} Camera \"orthographic\" \"float screenwindow\" [-1.2 1.2 -1.2 1.2]")),
        (
            "telecentric",
            format!(
                "{LOOK} Camera \"orthographic\" \"float screenwindow\" [-1.2 1.2 -1.2 1.2] \"float lensradius\" 0.2 \"float focaldistance\" 3"
            ),
        ),
        ("panorama", "LookAt 0 0 -0.6  0 0 0  0 1 0 Camera \"spherical\"".to_owned()),
        (
            "longitude and latitude",
            "LookAt 0 0 -0.6  0 0 0  0 1 0 Camera \"spherical\" \"string mapping\" \"equirectangular\""
                .to_owned(),
        ),
        ("fisheye", "LookAt 0 0 -0.6  0 0 0  0 1 0 Camera \"fisheye\" \"float fov\" 200".to_owned()),
        ("moving", format!("{moving} {}", pinhole())),
        ("mirrored", format!("Scale -2 2 2 {}", pinhole())),
    ] {
        let setup = Setup { camera: &camera, world: &world, ..Setup::default() };
        check_with(&format!("camera {name}"), &setup, 4, 32, 0.1);
    }
}

/// Wide filters mix pixels as they do for paths from the camera, up to the border of film and crop.
#[test]
fn all_filters_agree() {
    let world = format!("{THINGS} LightSource \"point\" {} \"point3 from\" [0.4 0.8 -0.7]", lit("I", 2.0));
    let panorama = "LookAt 0 0 -0.6  0 0 0  0 1 0 Camera \"spherical\"";
    let tall = "LookAt 0 0 -0.6  0 0 0  0 1 0 Camera \"spherical\" \"string mapping\" \"equirectangular\"";
    let crop = "\"rgb\" \"float cropwindow\" [0.25 0.75 0.125 0.875]";
    for (name, filter, camera, film) in [
        ("gaussian", "\"gaussian\"", pinhole().as_str(), "\"rgb\""),
        ("wide box", "\"box\" \"float xradius\" 3.2 \"float yradius\" 0.7", &pinhole(), "\"rgb\""),
        ("triangle", "\"triangle\" \"float xradius\" 5", &pinhole(), crop),
        ("mitchell", "\"mitchell\"", &pinhole(), "\"rgb\""),
        ("folded", "\"triangle\" \"float xradius\" 6 \"float yradius\" 6", panorama, "\"rgb\""),
        ("rolled", "\"triangle\" \"float xradius\" 6 \"float yradius\" 6", tall, "\"rgb\""),
    ] {
        let setup = Setup { filter, camera, film, world: &world, ..Setup::default() };
        check_with(&format!("filter {name}"), &setup, 3, 32, 0.2);
    }
}

/// A lamp that fills the view, and a grey wall in a furnace: exact values without any reference.
#[test]
fn furnace_is_filled() {
    let world = format!(
        "Material \"diffuse\" {} AreaLightSource \"diffuse\" {} ReverseOrientation Shape \"sphere\"",
        flat("reflectance", 0.5),
        lit("L", 1.0)
    );
    let camera = "LookAt 0.1 0.2 -0.3  0.4 -0.1 1  0 1 0 Camera \"perspective\"";
    let setup = Setup { size: [16, 16], camera, world: &world, ..Setup::default() };
    for (max_depth, expected) in [(0, 1.0), (1, 1.5), (2, 1.75), (5, 1.96875)] {
        let name = format!("furnace of {max_depth}");
        let scene = by_light(&setup, &name, max_depth);
        let means = (0..64).map(|pass| {
            let values = luminance(&render_passes(&scene, pass..pass + 1));
            values.iter().sum::<f64>() / values.len() as f64
        });
        let means: Moments = means.collect();
        if max_depth == 0 {
            assert!((means.mean() - 1.0).abs() < 1e-5);
        } else {
            expect_mean(&name, &means, expected, 0.05);
        }
    }
}

/// LPE-4: layers are those of path tracing, and disjoint ones add up to the image.
#[test]
fn layers_agree() {
    let world = format!(
        "{THINGS} AttributeBegin Translate -0.5 -0.5 -0.3 Material \"dielectric\" Shape \"sphere\" \"float radius\" 0.35 AttributeEnd
        AttributeBegin AreaLightSource \"diffuse\" {} Translate 0 0.99 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 0.6 AttributeEnd",
        lit("L", 6.0)
    );
    let setup = Setup {
        camera: &pinhole(),
        world: &world,
        size: [SIZE, SIZE],
        integrator: "\"integer maxdepth\" 5",
        ..Setup::default()
    };
    let light = by_light(&setup, "layers", 5);
    for (name, expression) in [("caustic", "LS+DE"), ("indirect", "L(S|D)*D[DG]E"), ("gloss", "L(S|D|G)*GE")]
    {
        let of = |film: &Film| layer(film, name);
        let path = moments(&setup.scene("layers"), 128, &[(name, expression)], of);
        expect_same(name, &moments(&light, 48, &[(name, expression)], of), &path, 0.25);
    }
    let parts = [("emitted", "LE"), ("direct", "L[DG]E"), ("rest", "L[SDG]+[DG]E")];
    let film = render_layers(&light, 0..4, &parts);
    let mut sum = vec![0.0; (SIZE * SIZE) as usize];
    for (name, _) in parts {
        sum.iter_mut().zip(layer(&film, name)).for_each(|(sum, value)| *sum += value);
    }
    expect_equal_pixels("sum of layers", &sum, &luminance(&film), 1e-4);
}

/// With `mirrors`, the image is that of path tracing, whole.
#[test]
fn mirrors_complete_the_image() {
    let world = format!(
        "{THINGS} AttributeBegin Translate -0.5 -0.5 -0.3 Material \"dielectric\" Shape \"sphere\" \"float radius\" 0.35 AttributeEnd
        AttributeBegin Translate 0.6 0.4 0.3 Material \"coateddiffuse\" \"float roughness\" 0 Shape \"sphere\" \"float radius\" 0.35 AttributeEnd
        AttributeBegin AreaLightSource \"diffuse\" {} Translate 0 0.99 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 0.6 AttributeEnd
        LightSource \"infinite\" {}",
        lit("L", 6.0), lit("L", 0.3)
    );
    let setup = Setup {
        camera: &pinhole(),
        world: &world,
        size: [SIZE, SIZE],
        integrator: "\"integer maxdepth\" 6",
        ..Setup::default()
    };
    let path = moments(&setup.scene("mirrors"), 48, &[], luminance);
    let mut scene = by_light(&setup, "mirrors", 6);
    scene.integrator = light(6).with("mirrors", Value::Bools(vec![true]));
    expect_same("mirrors", &moments(&scene, 48, &[], luminance), &path, 0.05);
}

/// More paths than pixels change nothing but the noise.
#[test]
fn any_number_of_paths_has_the_same_mean() {
    let world = format!("{THINGS} LightSource \"point\" {} \"point3 from\" [0.4 0.8 -0.7]", lit("I", 2.0));
    let setup = Setup { camera: &pinhole(), world: &world, size: [SIZE, SIZE], ..Setup::default() };
    let few = by_light(&setup, "few paths", 3);
    let mut many = by_light(&setup, "many paths", 3);
    many.integrator = light(3).with("lightpaths", Value::Integers(vec![10_000]));
    let (few, many) = (moments(&few, 64, &[], luminance), moments(&many, 32, &[], luminance));
    expect_same("more paths", &many, &few, 0.05);
    let variance = |moments: &[Moments]| moments[N_BLOCKS * N_BLOCKS].variance();
    assert!(
        variance(&many) < 0.5 * variance(&few),
        "four times as many paths have a quarter of the variance"
    );
}

/// ARCH-4, PAR-1: threads change no bit, and passes add up however they are split.
#[test]
fn threads_and_splits_change_nothing() {
    let world = format!(
        "{THINGS} LightSource \"infinite\" {} AttributeBegin Translate -0.5 -0.5 -0.3 Material \"dielectric\"
        Shape \"sphere\" \"float radius\" 0.35 AttributeEnd LightSource \"point\" {} \"point3 from\" [0.4 0.8 -0.7]",
        lit("L", 0.3),
        lit("I", 2.0)
    );
    let camera = format!(
        "{LOOK} Camera \"perspective\" \"float fov\" 40 \"float lensradius\" 0.1 \"float focaldistance\" 3"
    );
    for (sampler, filter) in [("\"sobol\"", "\"gaussian\""), ("\"zsobol\"", "\"mitchell\"")] {
        let setup =
            Setup { size: [70, 40], sampler, filter, camera: &camera, world: &world, ..Setup::default() };
        let mut scene = setup.scene("threads of light");
        scene.integrator = light(5).with("mirrors", Value::Bools(vec![true]));
        let layers = [("caustic", "LS+DE")];
        let in_threads = |n: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads");
            pool.install(|| render_layers(&scene, 0..3, &layers))
        };
        let alone = in_threads(1);
        assert_eq!(in_threads(2).sums(), alone.sums());
        let mut joined = render_layers(&scene, 2..3, &layers);
        joined.sums_mut().merge(render_layers(&scene, 0..2, &layers).sums()).expect("parts of one render");
        assert_eq!(joined.sums(), alone.sums());
    }
}
