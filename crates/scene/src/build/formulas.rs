//! Shapes given by a formula: quadrics, tori and planes.

use std::f32::consts::TAU;

use etendue_geometry::{BilinearMesh, Shape};
use etendue_math::{Frame, Point3, Vector3};

use crate::parameters::{ParameterSpec, Parameters, spec};

use super::shapes::{ALPHA, PHI_MAX, phi_max, positive};

pub(super) const CONE: &[ParameterSpec] = &[
    spec("radius", "float", "1", "m", "radius at z = 0"),
    spec("height", "float", "1", "m", "z of the tip"),
    PHI_MAX,
    ALPHA,
];
pub(super) const PARABOLOID: &[ParameterSpec] = &[
    spec("radius", "float", "1", "m", "radius at zmax, where a is not given"),
    spec("a", "float", "", "√m", "in z = x²/a² + y²/b², in place of the radius"),
    spec("b", "float", "a", "√m", "the same along y"),
    spec("zmin", "float", "0", "m", "lower cut"),
    spec("zmax", "float", "1", "m", "upper end"),
    PHI_MAX,
    ALPHA,
];
pub(super) const HYPERBOLOID: &[ParameterSpec] = &[
    spec("p1", "point3", "0 0 0", "m", "start of the segment that turns about z"),
    spec("p2", "point3", "1 1 1", "m", "its end"),
    PHI_MAX,
    ALPHA,
];
pub(super) const TORUS: &[ParameterSpec] = &[
    spec("majorradius", "float", "1", "m", "from the axis to the middle of the tube"),
    spec("minorradius", "float", "0.25", "m", "radius of the tube, at most the major one"),
    spec(
        "thetamin",
        "float",
        "0",
        "degrees",
        "where the tube's circle begins, from its outermost point towards +z",
    ),
    spec("thetamax", "float", "360", "degrees", "where it ends"),
    PHI_MAX,
    ALPHA,
];
pub(super) const PLANE: &[ParameterSpec] = &[
    spec("normal", "vector3", "0 0 1", "", "n in n·p + D = 0"),
    spec("d", "float", "0", "m", "D there"),
    spec("extent", "float", "100", "m", "half the side of the square that is there"),
    ALPHA,
];

/// The cone of RenderMan and of pbrt before version 4.
pub(super) fn read_cone(p: &mut Parameters<'_, '_>) -> Shape {
    let radius = positive(p, "radius", 1.0);
    let height = p.float("height", 1.0);
    if height == 0.0 {
        let span = p.span_of("height");
        p.diagnostics().error(span, "\"height\" must not be 0").with_help("a flat cone is a \"disk\"");
    }
    Shape::Cone { radius, height, phi_max_rad: phi_max(p) }
}

/// The paraboloid, round by its radius at the end or elliptic by its two half axes (SPEC GEO-6).
pub(super) fn read_paraboloid(p: &mut Parameters<'_, '_>) -> Shape {
    let z_max = positive(p, "zmax", 1.0);
    let z_min = p.float("zmin", 0.0);
    let cut = z_min.max(0.0);
    if cut >= z_max {
        let span = p.span_of("zmin");
        p.diagnostics()
            .error(span, format!("\"zmin\" must be less than \"zmax\", but {z_min} is not below {z_max}"));
    }
    let (a, b) = if p.has("a") || p.has("b") {
        let a = positive(p, "a", 1.0);
        p.ignore("radius");
        (a, positive(p, "b", a))
    } else {
        let a = positive(p, "radius", 1.0) / z_max.sqrt();
        (a, a)
    };
    Shape::Paraboloid { a, b, z_min: cut, z_max, phi_max_rad: phi_max(p) }
}

/// The hyperboloid of RenderMan and of pbrt before version 4.
pub(super) fn read_hyperboloid(p: &mut Parameters<'_, '_>) -> Shape {
    let p1 = p.point3("p1", Point3::ORIGIN);
    let p2 = p.point3("p2", Point3::splat(1.0));
    if p1 == p2 {
        let span = p.span_of("p2");
        p.diagnostics().error(span, "\"p1\" and \"p2\" must differ");
    }
    Shape::Hyperboloid { p1, p2, phi_max_rad: phi_max(p) }
}

/// A torus that does not meet itself.
pub(super) fn read_torus(p: &mut Parameters<'_, '_>) -> Shape {
    let major_radius = positive(p, "majorradius", 1.0);
    let minor_radius = positive(p, "minorradius", 0.25);
    if minor_radius > major_radius {
        let span = p.span_of("minorradius");
        let message = format!("\"minorradius\" is {minor_radius}, more than \"majorradius\", {major_radius}");
        p.diagnostics()
            .error(span, message)
            .with_help("such a torus meets itself; an \"implicit\" shape may");
    }
    let [theta_min_rad, theta_max_rad] =
        [p.float("thetamin", 0.0), p.float("thetamax", 360.0)].map(f32::to_radians);
    if !(theta_max_rad > theta_min_rad && theta_max_rad - theta_min_rad <= TAU * (1.0 + 1e-5)) {
        let span = p.span_of("thetamax");
        p.diagnostics().error(span, "\"thetamax\" must exceed \"thetamin\" by 360 degrees at the most");
    }
    Shape::Torus { major_radius, minor_radius, theta_min_rad, theta_max_rad, phi_max_rad: phi_max(p) }
}

/// A square in the plane n·p + D = 0 (SPEC GEO-4) around the point nearest to the origin. It ends, since the hierarchy, the
/// light of distant lamps and the power of an emitter all need a finite size.
pub(super) fn read_plane(p: &mut Parameters<'_, '_>) -> Shape {
    let normal = p.vector3("normal", Vector3::new(0.0, 0.0, 1.0));
    let length = normal.length();
    if !(length > 0.0 && length.is_finite()) {
        let span = p.span_of("normal");
        p.diagnostics().error(span, "\"normal\" must have a direction");
        return Shape::Bilinear(BilinearMesh::default());
    }
    let frame = Frame::from_z(normal / length);
    let middle = Point3::ORIGIN - frame.z * (p.float("d", 0.0) / length);
    let extent = positive(p, "extent", 100.0);
    let corner = |x: f32, y: f32| middle + (frame.x * x + frame.y * y) * extent;
    Shape::Bilinear(BilinearMesh {
        positions: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0)],
        indices: vec![[0, 1, 2, 3]],
        ..BilinearMesh::default()
    })
}
