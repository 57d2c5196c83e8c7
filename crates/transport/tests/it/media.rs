//! Clear media that absorb, between surfaces that know both of their sides (SPEC FRES-11, FRES-12).

use crate::support::{Setup, expect_mean, expect_near, lit, luminance, pixel_moments};

/// Looks straight down at z = 0 from above, at a small part of it.
const DOWN: &str =
    "LookAt 0 0 20  0 0 0  0 1 0 Camera \"orthographic\" \"float screenwindow\" [-0.01 0.01 -0.01 0.01]";

/// A horizontal square whose normal points up.
fn level(z: f64) -> String {
    format!(
        "Shape \"bilinearmesh\" \"point3 P\" [-50 -50 {z}  50 -50 {z}  -50 50 {z}  50 50 {z}]
        \"integer indices\" [0 1 2 3]"
    )
}

/// Reflectance of a smooth boundary at normal incidence.
fn fresnel(eta: f64) -> f64 {
    ((eta - 1.0) / (eta + 1.0)).powi(2)
}

/// Share of light that layers send back and let through, seen from above and from below.
#[derive(Clone, Copy)]
struct Layers {
    back: [f64; 2],
    through: f64,
}

impl Layers {
    fn boundary(eta: f64) -> Self {
        Self { back: [fresnel(eta); 2], through: 1.0 - fresnel(eta) }
    }

    fn absorber(share: f64) -> Self {
        Self { back: [0.0; 2], through: share }
    }

    /// With others below: light goes to and fro between them (adding method, Stokes 1862).
    fn over(self, below: Self) -> Self {
        let to_and_fro = 1.0 / (1.0 - self.back[1] * below.back[0]);
        let through = self.through * below.through * to_and_fro;
        let above_back = self.back[0] + self.through * self.through * below.back[0] * to_and_fro;
        let below_back = below.back[1] + below.through * below.through * self.back[1] * to_and_fro;
        Self { back: [above_back, below_back], through }
    }

    /// Radiance under a sky of 1 all around.
    fn in_a_furnace(self) -> f64 {
        self.back[0] + self.through
    }
}

const DEEP: &str = "\"integer maxdepth\" 100 \"integer roulettedepth\" 100";

/// Layers under a sky of 1 all around.
#[track_caller]
fn check(name: &str, layers: &str, expected: Layers) {
    let world = format!("LightSource \"infinite\" {} {layers}", lit("L", 1.0));
    let setup = Setup { size: [32, 32], integrator: DEEP, camera: DOWN, world: &world, ..Setup::default() };
    expect_mean(name, &pixel_moments(&setup.film(name, 64)), expected.in_a_furnace(), 0.02);
}

/// FRES-11: a slab of coloured glass, with all reflections to and fro.
#[test]
fn a_slab_absorbs_by_its_thickness() {
    let glass = |sides: &str| format!("Material \"dielectric\" \"float eta\" 1.5 {sides}");
    let absorbing = "\"float absorption\" 0.4";
    let layers = format!("{} {} ReverseOrientation {}", glass(absorbing), level(0.0), level(-2.0));
    let share = Layers::absorber((-0.4_f64 * 2.0).exp());
    let (top, bottom) = (Layers::boundary(1.5), Layers::boundary(1.5));
    check("a slab of glass", &layers, top.over(share).over(bottom));
}

/// FRES-12: water on glass with no gap, each boundary once. The one between them knows what is on either side; with air in
/// between it would send back ten times as much.
#[test]
fn water_stands_on_glass() {
    let (water, glass) = (1.33, 1.5);
    let layers = format!(
        "Material \"dielectric\" \"float eta\" {water} \"float absorption\" 0.3 {}
        Material \"dielectric\" \"float eta\" {glass} \"float eta_exterior\" {water}
        \"float absorption\" 0.2 \"float absorption_exterior\" 0.3 {}
        Material \"dielectric\" \"float eta\" {glass} \"float absorption\" 0.2 ReverseOrientation {}",
        level(3.0),
        level(2.0),
        level(0.0)
    );
    let in_contact = Layers::boundary(water)
        .over(Layers::absorber((-0.3_f64).exp()))
        .over(Layers::boundary(glass / water))
        .over(Layers::absorber((-0.4_f64).exp()))
        .over(Layers::boundary(glass));
    check("water on glass", &layers, in_contact);
}

/// Lamps under water are dimmed on their way to what they light, and that on its way to the eye.
#[test]
fn light_is_dimmed_on_both_ways() {
    let brightness = |absorption: f64| {
        let world = format!(
            "AttributeBegin
            Material \"dielectric\" \"float eta\" 1 \"float absorption\" {absorption}
            Shape \"sphere\" \"float radius\" 8
            AttributeEnd
            LightSource \"point\" \"point3 from\" [0 0 3] {}
            Material \"diffuse\" Shape \"disk\" \"float radius\" 2",
            lit("I", 1.0)
        );
        let setup = Setup { size: [4, 4], camera: DOWN, world: &world, ..Setup::default() };
        luminance(&setup.film("a lamp under water", 64)).iter().sum::<f64>()
    };
    let (clear, dim) = (brightness(0.0), brightness(0.1));
    assert!(clear > 0.0);
    // 3 m from the lamp and 8 m to the surface.
    expect_near("absorption", dim / clear, (-0.1_f64 * 11.0).exp(), 1e-3);
}
