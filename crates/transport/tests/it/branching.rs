//! One ray for each bounce against several (SPEC PT-2, EXP-46), and walks that share their way from the camera.

use crate::strategies::{FRONT, blocks, ceiling_light, count_rays, open_box};
use crate::support::{Setup, expect_equal_pixels, expect_same_image, layer, luminance, render_layers};

fn integrator(branches: u32) -> String {
    format!("\"integer maxdepth\" 3 \"integer roulettedepth\" 100 \"integer branches\" {branches}")
}

/// EXP-46: three rays go on from every surface, nine from the second on. The image is the same in the mean and its
/// variance falls, but not by as much as the rays grow: one ray for each bounce gets more out of every ray.
#[test]
fn one_ray_for_each_bounce_pays() {
    let world = open_box(&ceiling_light(0.4));
    let render = |branches| blocks(&format!("branches {branches}"), &world, &integrator(branches), 120);
    let (one, three) = (render(1), render(3));
    expect_same_image("one and three rays", &one, &three, 0.05);
    let whole = one.len() - 1;
    let (variance_of_one, variance_of_three) = (one[whole].variance(), three[whole].variance());
    let (rays_of_one, rays_of_three) =
        (count_rays(&world, &integrator(1)), count_rays(&world, &integrator(3)));
    assert!(variance_of_three < variance_of_one, "{variance_of_three} {variance_of_one}");
    // Closest and shadow rays of a path: 1 + 3 bounces with a light sample each; of a tree: 1 + 3 + 9 + 27.
    assert!(rays_of_three > 4 * rays_of_one, "{rays_of_three} {rays_of_one}");
    let cost = |variance: f64, rays: u64| variance * rays as f64;
    assert!(cost(variance_of_one, rays_of_one) < cost(variance_of_three, rays_of_three));
}

/// Each branch finds its own way for path expressions: layers by bounce add up to the image.
#[test]
fn branches_keep_their_letters() {
    let world = open_box(&ceiling_light(0.4));
    let setup =
        Setup { size: [8, 8], integrator: &integrator(2), camera: FRONT, world: &world, ..Setup::default() };
    let expressions = [
        ("bounce0", "LE"),
        ("bounce1", "L.E"),
        ("bounce2", "L.{2}E"),
        ("bounce3", "L.{3}E"),
        ("all", "L(S|D)*E"),
    ];
    let film = render_layers(&setup.scene("letters of branches"), 0..8, &expressions);
    let image = luminance(&film);
    expect_equal_pixels("all paths", &layer(&film, "all"), &image, 1e-5);
    let bounces: Vec<Vec<f64>> = (0..4).map(|k| layer(&film, &format!("bounce{k}"))).collect();
    let sum: Vec<f64> = (0..image.len()).map(|i| bounces.iter().map(|b| b[i]).sum()).collect();
    expect_equal_pixels("sum of bounces", &sum, &image, 1e-5);
    assert!(bounces[3].iter().sum::<f64>() > 0.0);
}

/// Walks that share the way from the camera to the first surface give the same image with less variance; the first ray
/// is traced once, and roulette ends as many of them as of whole paths.
#[test]
fn walks_that_split_at_the_first_surface() {
    let world = open_box(&ceiling_light(0.4));
    let integrator = |n: u32| format!("\"integer maxdepth\" 4 \"integer splitting\" {n}");
    let render = |n| blocks(&format!("splitting {n}"), &world, &integrator(n), 120);
    let (one, four) = (render(1), render(4));
    expect_same_image("one walk and four", &one, &four, 0.05);
    let whole = one.len() - 1;
    assert!(four[whole].variance() < one[whole].variance());
    let (rays_of_one, rays_of_four) =
        (count_rays(&world, &integrator(1)), count_rays(&world, &integrator(4)));
    assert!(3 * rays_of_one < rays_of_four && rays_of_four < 4 * rays_of_one, "{rays_of_one} {rays_of_four}");
}

/// Walks may share one light sample, and light samples one walk: the mean stays, since the weights of both techniques know
/// how many there are of each.
#[test]
fn walks_and_light_samples_in_any_number() {
    let world = open_box(&ceiling_light(0.4));
    let integrator = |n: u32, m: u32| {
        format!("\"integer maxdepth\" 4 \"integer splitting\" {n} \"integer lightsamples\" {m}")
    };
    let render = |n, m| blocks(&format!("{n} walks, {m} light samples"), &world, &integrator(n, m), 120);
    let plain = render(1, 1);
    for (n, m) in [(4, 1), (1, 4), (3, 2)] {
        expect_same_image(&format!("{n} walks and {m} light samples"), &render(n, m), &plain, 0.05);
    }
    let rays = |n, m| count_rays(&world, &integrator(n, m));
    assert!(rays(1, 1) < rays(1, 4) && rays(1, 4) < rays(4, 1) && rays(4, 1) < rays(4, 4));
}

/// Walks that split find their own ways for path expressions too.
#[test]
fn walks_that_split_keep_their_letters() {
    let world = open_box(&ceiling_light(0.4));
    let integrator = "\"integer maxdepth\" 3 \"integer splitting\" 3";
    let setup = Setup { size: [8, 8], integrator, camera: FRONT, world: &world, ..Setup::default() };
    let expressions = [("direct", "L.?E"), ("indirect", "L..(S|D)*E")];
    let film = render_layers(&setup.scene("letters of walks"), 0..8, &expressions);
    let (direct, indirect) = (layer(&film, "direct"), layer(&film, "indirect"));
    let sum: Vec<f64> = direct.iter().zip(&indirect).map(|(a, b)| a + b).collect();
    expect_equal_pixels("sum of layers", &sum, &luminance(&film), 1e-5);
    assert!(indirect.iter().sum::<f64>() > 0.0);
}
