//! From a surface point to texture coordinates, with their change per pixel by the chain rule.

use std::f32::consts::{PI, TAU};

use etendue_math::{Point2, Point3, Transform, Vector3, safe_acos};

use crate::parameters::{ParameterSpec, Parameters};

use super::TextureContext;

/// Coordinates of a texture in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinates2 {
    /// The coordinates (s, t).
    pub st: Point2,
    /// Change of s per pixel to the right.
    pub dsdx: f32,
    /// Change of s per pixel down.
    pub dsdy: f32,
    /// Change of t per pixel to the right.
    pub dtdx: f32,
    /// Change of t per pixel down.
    pub dtdy: f32,
}

/// Coordinates of a texture in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinates3 {
    /// The position in the texture's space.
    pub p: Point3,
    /// Change of `p` per pixel to the right.
    pub dpdx: Vector3,
    /// Change of `p` per pixel down.
    pub dpdy: Vector3,
}

/// How a texture in the plane is laid onto a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mapping2 {
    /// By the surface parameters: `s = su u + du`, `t = sv v + dv`.
    Uv {
        /// Factor of u.
        su: f32,
        /// Factor of v.
        sv: f32,
        /// Shift of s.
        du: f32,
        /// Shift of t.
        dv: f32,
    },
    /// By the surface parameters, scaled and turned: `s = a u + b v + du`, `t = c u + d v + dv`.
    TurnedUv {
        /// `[[a, b], [c, d]]`.
        rows: [[f32; 2]; 2],
        /// Shift of s.
        du: f32,
        /// Shift of t.
        dv: f32,
    },
    /// By direction from the origin: s is the angle from +z over pi, t the longitude over 2 pi.
    Spherical(Transform),
    /// By longitude over 2 pi (from -x) and by z.
    Cylindrical(Transform),
    /// By projection onto two vectors.
    Planar {
        /// From the world to the texture's space.
        texture_from_world: Transform,
        /// `s = ds + vs . p`.
        vs: Vector3,
        /// `t = dt + vt . p`.
        vt: Vector3,
        /// Shift of s.
        ds: f32,
        /// Shift of t.
        dt: f32,
    },
}

impl Default for Mapping2 {
    fn default() -> Self {
        Self::Uv { su: 1.0, sv: 1.0, du: 0.0, dv: 0.0 }
    }
}

/// Texture coordinates from their gradients with respect to the position in the texture's space.
fn from_gradients(st: Point2, dsdp: Vector3, dtdp: Vector3, c: &Coordinates3) -> Coordinates2 {
    Coordinates2 {
        st,
        dsdx: dsdp.dot(c.dpdx),
        dsdy: dsdp.dot(c.dpdy),
        dtdx: dtdp.dot(c.dpdx),
        dtdy: dtdp.dot(c.dpdy),
    }
}

fn spherical(c: &Coordinates3) -> Coordinates2 {
    let p = c.p;
    let rho_squared = p.x * p.x + p.y * p.y;
    let r_squared = rho_squared + p.z * p.z;
    if r_squared == 0.0 {
        return from_gradients(Point2::default(), Vector3::default(), Vector3::default(), c);
    }
    let theta = safe_acos(p.z / r_squared.sqrt());
    let phi = p.y.atan2(p.x);
    let st = Point2::new(theta / PI, if phi < 0.0 { phi / TAU + 1.0 } else { phi / TAU });
    if rho_squared == 0.0 {
        return from_gradients(st, Vector3::default(), Vector3::default(), c);
    }
    let rho = rho_squared.sqrt();
    let dtheta = Vector3::new(p.x * p.z / rho, p.y * p.z / rho, -rho) / (PI * r_squared);
    let dphi = Vector3::new(-p.y, p.x, 0.0) / (TAU * rho_squared);
    from_gradients(st, dtheta, dphi, c)
}

fn cylindrical(c: &Coordinates3) -> Coordinates2 {
    let p = c.p;
    let rho_squared = p.x * p.x + p.y * p.y;
    let st = Point2::new((PI + p.y.atan2(p.x)) / TAU, p.z);
    let dphi = if rho_squared > 0.0 {
        Vector3::new(-p.y, p.x, 0.0) / (TAU * rho_squared)
    } else {
        Vector3::default()
    };
    from_gradients(st, dphi, Vector3::new(0.0, 0.0, 1.0), c)
}

impl Mapping2 {
    /// Parameters of every texture in the plane.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        ParameterSpec {
            name: "mapping",
            kind: "string",
            default: "uv",
            unit: "",
            doc: "uv, spherical, cylindrical or planar",
        },
        ParameterSpec {
            name: "uscale",
            kind: "float",
            default: "1",
            unit: "",
            doc: "uv: repetitions along u",
        },
        ParameterSpec {
            name: "vscale",
            kind: "float",
            default: "1",
            unit: "",
            doc: "uv: repetitions along v",
        },
        ParameterSpec {
            name: "udelta",
            kind: "float",
            default: "0",
            unit: "",
            doc: "uv, planar: shift along u",
        },
        ParameterSpec {
            name: "vdelta",
            kind: "float",
            default: "0",
            unit: "",
            doc: "uv, planar: shift along v",
        },
        ParameterSpec {
            name: "uvrotation",
            kind: "float",
            default: "0",
            unit: "deg",
            doc: "uv: turns (u, v) from u towards v, after scaling and before shifting",
        },
        ParameterSpec {
            name: "v1",
            kind: "vector3",
            default: "1 0 0",
            unit: "1/m",
            doc: "planar: gradient of u in the texture's space",
        },
        ParameterSpec {
            name: "v2",
            kind: "vector3",
            default: "0 1 0",
            unit: "1/m",
            doc: "planar: gradient of v in the texture's space",
        },
    ];

    /// The texture coordinates at a surface point.
    #[must_use]
    pub fn map(&self, ctx: &TextureContext) -> Coordinates2 {
        match self {
            Self::Uv { su, sv, du, dv } => Coordinates2 {
                st: Point2::new(su * ctx.uv.x + du, sv * ctx.uv.y + dv),
                dsdx: su * ctx.dudx,
                dsdy: su * ctx.dudy,
                dtdx: sv * ctx.dvdx,
                dtdy: sv * ctx.dvdy,
            },
            Self::TurnedUv { rows: [[a, b], [c, d]], du, dv } => Coordinates2 {
                st: Point2::new(a * ctx.uv.x + b * ctx.uv.y + du, c * ctx.uv.x + d * ctx.uv.y + dv),
                dsdx: a * ctx.dudx + b * ctx.dvdx,
                dsdy: a * ctx.dudy + b * ctx.dvdy,
                dtdx: c * ctx.dudx + d * ctx.dvdx,
                dtdy: c * ctx.dudy + d * ctx.dvdy,
            },
            Self::Spherical(texture_from_world) => spherical(&map_point(texture_from_world, ctx)),
            Self::Cylindrical(texture_from_world) => cylindrical(&map_point(texture_from_world, ctx)),
            Self::Planar { texture_from_world, vs, vt, ds, dt } => {
                let c = map_point(texture_from_world, ctx);
                let p = c.p.as_vector();
                from_gradients(Point2::new(ds + p.dot(*vs), dt + p.dot(*vt)), *vs, *vt, &c)
            }
        }
    }

    /// Reads a mapping.
    pub fn from_parameters(parameters: &mut Parameters<'_, '_>, world_from_texture: &Transform) -> Self {
        #[derive(Clone, Copy)]
        enum Kind {
            Uv,
            Spherical,
            Cylindrical,
            Planar,
        }
        let choices = [
            ("uv", Kind::Uv),
            ("spherical", Kind::Spherical),
            ("cylindrical", Kind::Cylindrical),
            ("planar", Kind::Planar),
        ];
        let texture_from_world = world_from_texture.inverse();
        match parameters.choice("mapping", "uv", &choices) {
            Kind::Uv => {
                let (su, sv) = (parameters.float("uscale", 1.0), parameters.float("vscale", 1.0));
                let (du, dv) = (parameters.float("udelta", 0.0), parameters.float("vdelta", 0.0));
                let (sin, cos) = parameters.float("uvrotation", 0.0).to_radians().sin_cos();
                if sin == 0.0 && cos == 1.0 {
                    return Self::Uv { su, sv, du, dv };
                }
                Self::TurnedUv { rows: [[su * cos, -sv * sin], [su * sin, sv * cos]], du, dv }
            }
            Kind::Spherical => Self::Spherical(texture_from_world),
            Kind::Cylindrical => Self::Cylindrical(texture_from_world),
            Kind::Planar => Self::Planar {
                texture_from_world,
                vs: parameters.vector3("v1", Vector3::new(1.0, 0.0, 0.0)),
                vt: parameters.vector3("v2", Vector3::new(0.0, 1.0, 0.0)),
                ds: parameters.float("udelta", 0.0),
                dt: parameters.float("vdelta", 0.0),
            },
        }
    }
}

/// The position in the texture's space.
fn map_point(texture_from_world: &Transform, ctx: &TextureContext) -> Coordinates3 {
    Coordinates3 {
        p: texture_from_world.point(ctx.p),
        dpdx: texture_from_world.vector(ctx.dpdx),
        dpdy: texture_from_world.vector(ctx.dpdy),
    }
}

/// How a texture in space is placed in the world.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mapping3 {
    /// From the world to the texture's space.
    pub texture_from_world: Transform,
}

impl Mapping3 {
    /// The placement given where the texture is defined.
    #[must_use]
    pub const fn new(world_from_texture: &Transform) -> Self {
        Self { texture_from_world: world_from_texture.inverse() }
    }

    /// The texture coordinates at a surface point.
    #[must_use]
    pub fn map(&self, ctx: &TextureContext) -> Coordinates3 {
        map_point(&self.texture_from_world, ctx)
    }
}
