//! Surfaces given by formulas (SPEC SCENE-32).

use super::text::{Frame, quad, sphere};
use super::{Files, Generator, Settings};

/// The gallery.
pub(super) const GENERATOR: Generator = Generator {
    name: "formulas",
    id: "SCENE-32",
    doc: "implicit and parametric surfaces, quadrics, and a paraboloid mirror that burns at its focus",
    parameters: &[],
    generate,
};

fn generate(_: &Settings) -> Files {
    let frame =
        Frame { name: "formulas", resolution: [800, 400], exposure_s: 0.008, samples: 256, max_depth: 12 };
    let text = format!(
        r#"# Surfaces given by formulas (SPEC SCENE-32): quadrics and a torus, an implicit surface, a parametric one, and a mirror.
#
# Lengths are in metres; z points up, x to the left of the picture.
#   mirror   the paraboloid z = (x^2 + y^2) / 4 f with f = 0.25, and a white target of radius 0.03 at its focus: all light
#            that comes along the axis meets there (SPEC GEO-6). The lamp is a small ball on the axis, 20 m away.

LookAt 0 -6.2 2.6   0 0 0.45   0 0 1
Camera "perspective" "float fov" [ 26 ]
{frame}
WorldBegin

LightSource "infinite" "float illuminance" [ 160 ]
AttributeBegin
  AreaLightSource "diffuse" "float power" [ 4500 ]
  {lamp}AttributeEnd

Texture "tiles" "spectrum" "checkerboard" "float uscale" [ 20 ] "float vscale" [ 20 ]
  "rgb tex1" [ 0.55 0.55 0.55 ] "rgb tex2" [ 0.35 0.35 0.35 ]
Material "diffuse" "texture reflectance" [ "tiles" ]
{floor}
# Quadrics: cone, hyperboloid, paraboloid; and a torus.
Material "coateddiffuse" "rgb reflectance" [ 0.7 0.25 0.1 ] "float roughness" [ 0.05 ]
AttributeBegin
  Translate -2.1 -0.6 0
  Shape "cone" "float radius" [ 0.32 ] "float height" [ 0.8 ]
AttributeEnd
Material "coateddiffuse" "rgb reflectance" [ 0.6 0.5 0.1 ] "float roughness" [ 0.05 ]
AttributeBegin
  Translate -1.25 -0.6 0.4
  Shape "hyperboloid" "point3 p1" [ 0.32 0 -0.4 ] "point3 p2" [ -0.05 0.32 0.4 ]
AttributeEnd
Material "conductor" "spectrum eta" "metal-Cu-eta" "spectrum k" "metal-Cu-k" "float roughness" [ 0.05 ]
AttributeBegin
  Translate -1.7 0.7 0.2
  Rotate 20 1 0 0
  Shape "torus" "float majorradius" [ 0.4 ] "float minorradius" [ 0.15 ]
AttributeEnd
Material "coateddiffuse" "rgb reflectance" [ 0.2 0.5 0.25 ] "float roughness" [ 0.05 ]
AttributeBegin
  Translate -0.45 -0.7 0
  Shape "paraboloid" "float radius" [ 0.3 ] "float zmin" [ 0 ] "float zmax" [ 0.6 ]
AttributeEnd

# Implicit: a blob of three balls that melt into each other.
Material "coateddiffuse" "rgb reflectance" [ 0.25 0.3 0.65 ] "float roughness" [ 0.05 ]
AttributeBegin
  Translate 0.45 -0.6 0.36
  Shape "implicit" "point3 bounds" [ -0.6 -0.6 -0.6  0.6 0.6 0.6 ]
    "string function" "0.35 - exp(-14*((x-0.16)^2+y^2+z^2)) - exp(-14*((x+0.16)^2+y^2+(z-0.1)^2)) - exp(-18*(x^2+(y+0.1)^2+(z-0.34)^2))"
AttributeEnd
# Parametric: the shell of a snail.
Material "coateddiffuse" "rgb reflectance" [ 0.65 0.35 0.45 ] "float roughness" [ 0.05 ]
AttributeBegin
  Translate 0.3 0.8 0.35
  Shape "parametric" "float tolerance" [ 0.001 ]
    "string x" "0.32*(1 - v/(2*pi))*cos(3*v)*(1 + cos(u)) + 0.08*cos(3*v)"
    "string y" "0.32*(1 - v/(2*pi))*sin(3*v)*(1 + cos(u)) + 0.08*sin(3*v)"
    "string z" "0.9*v/(2*pi) + 0.32*(1 - v/(2*pi))*sin(u)"
    "float urange" [ 0 6.2831853 ] "float vrange" [ 0 6.2831853 ]
AttributeEnd

# The mirror looks at the lamp: its axis leans by 30 degrees to the right.
AttributeBegin
  Translate 1.7 0 0.12
  Rotate -30 1 0 0
  Material "conductor" "spectrum eta" "metal-Ag-eta" "spectrum k" "metal-Ag-k"
  Shape "paraboloid" "float radius" [ 0.6 ] "float zmin" [ 0 ] "float zmax" [ 0.36 ]
  Material "diffuse" "rgb reflectance" [ 0.8 0.8 0.8 ]
  Translate 0 0 0.25
  Shape "sphere" "float radius" [ 0.03 ]
AttributeEnd
"#,
        frame = frame.text(),
        lamp = sphere([1.7, 10.0, 17.440_508], 0.5),
        floor = quad([-8.0, -8.0, 0.0], [8.0, -8.0, 0.0], [-8.0, 8.0, 0.0], [8.0, 8.0, 0.0]),
    );
    Files::of_text("formulas", text)
}
