//! Scenes whose pictures are known in advance (SPEC SCENE-37), and the corner that tests estimates (SPEC SCENE-36).

use super::text::{Frame, quad, sphere};
use super::{Files, Generator, Settings};

/// A corner of walls (SPEC SCENE-36).
pub(super) const CORNER: Generator = Generator {
    name: "corner",
    id: "SCENE-36",
    doc: "a corner of three walls with a hard shadow: where estimates from photons reach around edges",
    parameters: &[],
    generate: corner,
};

/// Furnace, plane and slabs (SPEC SCENE-37).
pub(super) const FURNACE: Generator = Generator {
    name: "furnace",
    id: "SCENE-37",
    doc: "scenes with known results: furnace, furnace-glass, sky-plane, slab-clear, slab-absorbing",
    parameters: &[],
    generate: furnace,
};

fn corner(_: &Settings) -> Files {
    let frame =
        Frame { name: "corner", resolution: [512, 512], exposure_s: 0.03, samples: 256, max_depth: 8 };
    let text = format!(
        r#"# A corner of three walls, one of them black, lit by a small lamp, with a thin plate before one wall (SPEC SCENE-36).
#
# Estimates of light from the nearest photons go wrong here: a sphere around a point near the edge holds photons of the
# other wall, a flat disk too few of its own, and near the border of the shadow the light of both sides is mixed.
#
# Lengths are in metres; x grows to the right, y upwards, z into the picture.
#   walls   x = -1 (white), y = 0 (grey), z = 1 (black but for 2 %)
#   plate   0.5 x 0.5 and of no thickness, 0.25 above the floor
#   lamp    a ball of radius 0.04 at (0.5, 1.9, -0.4), 1200 lumen

LookAt 1.7 1.5 -2.3   -0.25 0.4 0.3   0 1 0
Camera "perspective" "float fov" [ 40 ]
{frame}
WorldBegin

Material "diffuse" "rgb reflectance" [ 0.8 0.8 0.8 ]
{white}Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
{grey}Material "diffuse" "rgb reflectance" [ 0.02 0.02 0.02 ]
{black}
Material "diffuse" "rgb reflectance" [ 0.6 0.3 0.1 ]
{plate}
AttributeBegin
  Material "diffuse" "rgb reflectance" [ 0 0 0 ]
  AreaLightSource "diffuse" "float power" [ 1200 ]
  {lamp}AttributeEnd
"#,
        frame = frame.text(),
        white = quad([-1.0, 0.0, -3.0], [-1.0, 0.0, 1.0], [-1.0, 2.5, -3.0], [-1.0, 2.5, 1.0]),
        grey = quad([-1.0, 0.0, -3.0], [3.0, 0.0, -3.0], [-1.0, 0.0, 1.0], [3.0, 0.0, 1.0]),
        black = quad([-1.0, 0.0, 1.0], [3.0, 0.0, 1.0], [-1.0, 2.5, 1.0], [3.0, 2.5, 1.0]),
        plate = quad([-0.6, 0.25, -0.2], [-0.1, 0.25, -0.2], [-0.6, 0.25, 0.3], [-0.1, 0.25, 0.3]),
        lamp = sphere([0.5, 1.9, -0.4], 0.04),
    );
    Files::of_text("corner", text)
}

fn furnace(_: &Settings) -> Files {
    Files::of_text(
        "furnace",
        scene(
            "furnace",
            "# A matte ball of reflectance 0.6 in a sky of luminance 1: its luminance is 0.6 everywhere.",
            "LookAt 0 0 -3   0 0 0   0 1 0\nCamera \"perspective\" \"float fov\" [ 45 ]",
            &format!("{SKY}Material \"diffuse\" \"rgb reflectance\" [ 0.6 0.6 0.6 ]\n{}", sphere([0.0; 3], 1.0)),
        ),
    )
    .with_text(
        "furnace-glass",
        scene(
            "furnace-glass",
            "# A ball of clear glass in a sky of luminance 1: what reflects and what passes adds up, and the ball cannot be seen.",
            "LookAt 0 0 -3   0 0 0   0 1 0\nCamera \"perspective\" \"float fov\" [ 45 ]",
            &format!("{SKY}Material \"dielectric\" \"float eta\" [ 1.5 ]\n{}", sphere([0.0; 3], 1.0)),
        ),
    )
    .with_text(
        "sky-plane",
        scene(
            "sky-plane",
            "# A matte plane of reflectance 0.5 under a sky of luminance 1: it receives pi lux and has luminance 0.5 everywhere.",
            "LookAt 0 2 -3   0 0 0   0 1 0\nCamera \"perspective\" \"float fov\" [ 40 ]",
            &format!(
                "{SKY}Material \"diffuse\" \"rgb reflectance\" [ 0.5 0.5 0.5 ]\n{}",
                quad([-1e3, 0.0, -1e3], [1e3, 0.0, -1e3], [-1e3, 0.0, 1e3], [1e3, 0.0, 1e3])
            ),
        ),
    )
    .with_text(
        "slab-clear",
        scene(
            "slab-clear",
            "# A clear slab of index 1.5, met at right angles, before a wall of luminance 1. Each face reflects R = 0.04; all bounces\n\
             # together pass (1 - R) / (1 + R) = 0.923077 of the light. Nothing comes from behind the camera.",
            SLAB_CAMERA,
            &slab(""),
        ),
    )
    .with_text(
        "slab-absorbing",
        scene(
            "slab-absorbing",
            "# A slab of index 1.5 whose inside absorbs 1 / m, 1 m thick, met at right angles, before a wall of luminance 1. With\n\
             # R = 0.04 and t = exp(-1) it passes (1 - R)^2 t / (1 - R^2 t^2) = 0.339110.",
            SLAB_CAMERA,
            &slab(" \"float absorption\" [ 1 ]"),
        ),
    )
}

const SKY: &str = "LightSource \"infinite\" \"spectrum L\" [ 300 1 900 1 ]\n";

/// Parallel rays at right angles to the slab.
const SLAB_CAMERA: &str =
    "LookAt 0 0 -3   0 0 0   0 1 0\nCamera \"orthographic\" \"float screenwindow\" [ -0.5 0.5 -0.5 0.5 ]";

fn scene(name: &str, comment: &str, camera: &str, world: &str) -> String {
    // An exposure of one second keeps values in cd/m^2.
    let frame = Frame { name, resolution: [64, 64], exposure_s: 1.0, samples: 256, max_depth: 64 };
    format!(
        "# Known in advance (SPEC SCENE-37).\n#\n{comment}\n\n{camera}\n{}\nWorldBegin\n\n{world}",
        frame.text()
    )
}

/// Two faces from z = -0.5 to z = 0.5, so wide that light from the sides plays no role, and the lamp behind.
fn slab(absorption: &str) -> String {
    let face = |z: f32, s: f32| {
        quad([-s * 50.0, -50.0, z], [s * 50.0, -50.0, z], [-s * 50.0, 50.0, z], [s * 50.0, 50.0, z])
    };
    format!(
        "Material \"dielectric\" \"float eta\" [ 1.5 ]{absorption}\n{front}{back}\n\
         AttributeBegin\n  Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n  \
         AreaLightSource \"diffuse\" \"spectrum L\" [ 300 1 900 1 ]\n  {lamp}AttributeEnd\n",
        // Normals look out of the slab; the lamp shines towards the camera.
        front = face(-0.5, -1.0),
        back = face(0.5, 1.0),
        lamp = face(2.0, -1.0),
    )
}
