//! The immutable scene: everything that a method of light transport may ask.

use std::collections::HashMap;
use std::sync::Arc;

use etendue_geometry::{Geometry, Hit, Reference, SurfaceDerivatives, SurfacePoint};
use etendue_math::{Bounds3, Point3, Ray, SamplerSettings, Vector3, hash64, offset_ray_origin};
use etendue_spectrum::{Sampled, Wavelengths};

use crate::bsdf::{Bsdf, BsdfKind, Diffuse};
use crate::camera::Camera;
use crate::controls::Controls;
use crate::document::Entity;
use crate::film::FilmSettings;
use crate::filter::Filter;
use crate::light::{Light, LightContext, LightId, LightPoint, LightSampler, LightTables};
use crate::material::{MaterialContext, MaterialId, Materials};
use crate::medium::MediumId;
use crate::texture::{FloatTexture, ShapePoint, TextureContext, Textures};

/// What a scene knows of a shape beyond its geometry.
#[derive(Clone, Copy, Debug)]
pub struct ShapeAttributes {
    /// Its material.
    pub material: MaterialId,
    /// Share of rays that meet it; `None` for all.
    pub alpha: Option<FloatTexture>,
    /// Its lights, if it emits.
    pub lights: Option<ShapeLights>,
}

/// The lights of an emissive shape: one for each primitive, or one for the whole of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShapeLights {
    first: LightId,
    /// From the light of a primitive to that of the next.
    step: u32,
}

impl ShapeLights {
    /// A light for each primitive, of which this is the first.
    #[must_use]
    pub const fn each(first: LightId) -> Self {
        Self { first, step: 1 }
    }

    /// One light for all primitives.
    #[must_use]
    pub const fn whole(light: LightId) -> Self {
        Self { first: light, step: 0 }
    }

    /// The light that a primitive belongs to.
    #[inline]
    #[must_use]
    pub const fn of(self, primitive: u32) -> LightId {
        LightId(self.first.0 + self.step * primitive)
    }
}

/// A point on a surface as a path finds it.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// Position and normals.
    pub point: SurfacePoint,
    /// How the ray met it.
    pub hit: Hit,
    /// Where the ray came from.
    pub ray_origin: Point3,
    /// Unit direction back to where the path came from.
    pub wo: Vector3,
    /// Time in seconds.
    pub time: f32,
    /// Material.
    pub material: MaterialId,
    /// The light that it is, if it emits.
    pub light: Option<LightId>,
}

impl Surface {
    /// A ray that leaves the surface in the unit direction `w`.
    #[inline]
    #[must_use]
    pub fn spawn_ray(&self, w: Vector3) -> Ray {
        let origin = offset_ray_origin(self.point.p, self.point.p_error, self.point.ng, w);
        Ray { origin, direction: w, time: self.time }
    }

    /// What lights are asked about.
    #[inline]
    #[must_use]
    pub const fn reference(&self) -> Reference {
        Reference { p: self.point.p, n: Some(self.point.ns) }
    }
}

/// The part of a segment that shadow rays test: the rest is rounding at the light.
const SHADOW_END: f32 = 1.0 - 1e-4;

/// Everything there is, immutable.
#[derive(Debug)]
pub struct Scene {
    /// Shapes.
    pub geometry: Geometry,
    /// Material, alpha and light of each shape, by its id.
    pub attributes: Vec<ShapeAttributes>,
    /// Textures, images and tabulated spectra.
    pub textures: Textures,
    /// Materials and normal maps.
    pub materials: Materials,
    /// Lights by id.
    pub lights: Vec<Light>,
    /// Arenas behind the ids that lights hold.
    pub light_tables: LightTables,
    /// The lights that rays meet when they leave the scene.
    pub infinite_lights: Vec<LightId>,
    /// How a light is chosen.
    pub light_sampler: LightSampler,
    /// The camera.
    pub camera: Camera,
    /// The film's setup.
    pub film: FilmSettings,
    /// The pixel filter.
    pub filter: Filter,
    /// The sampler's setup.
    pub sampler: SamplerSettings,
    /// The method that the document asks for, with its parameters.
    pub integrator: Entity,
    /// Contents of the files that its parameters name, by file name.
    pub integrator_files: HashMap<String, Arc<[u8]>>,
    /// What artists have switched off; `None` for nothing.
    pub controls: Option<Box<Controls>>,
    /// True if some shape has an alpha texture.
    pub has_alpha: bool,
    /// True if light passes some shapes: by alpha, or because they are interfaces.
    pub has_passable: bool,
}

impl Scene {
    /// The box around everything.
    #[must_use]
    pub fn bounds(&self) -> Bounds3 {
        self.geometry.bounds()
    }

    /// What lights need of the scene, where time does not matter: for their power, or if none moves.
    #[inline]
    #[must_use]
    pub const fn light_context(&self) -> LightContext<'_> {
        self.light_context_at(0.0)
    }

    /// What lights need of the scene at a time in seconds.
    #[inline]
    #[must_use]
    pub const fn light_context_at(&self, time: f32) -> LightContext<'_> {
        LightContext {
            geometry: &self.geometry,
            textures: &self.textures,
            spectra: &self.textures.spectra,
            tables: &self.light_tables,
            time,
        }
    }

    /// The light of that id.
    #[inline]
    #[must_use]
    pub fn light(&self, id: LightId) -> &Light {
        &self.lights[id.0 as usize]
    }

    /// The nearest surface that the ray meets before `t_max`.
    #[inline]
    #[must_use]
    pub fn intersect(&self, ray: &Ray, t_max: f32) -> Option<Hit> {
        if self.has_alpha {
            self.geometry.intersect(ray, t_max, &|hit| self.is_opaque(ray, hit))
        } else {
            self.geometry.intersect(ray, t_max, &|_| true)
        }
    }

    /// The alpha test: a ray meets a surface of alpha a with probability a, decided by a hash of the ray and the
    /// shape, so that the same ray always finds the same.
    fn is_opaque(&self, ray: &Ray, hit: &Hit) -> bool {
        let Some(alpha) = self.attributes[hit.geometry.0 as usize].alpha else {
            return true;
        };
        let alpha = match alpha {
            FloatTexture::Constant(alpha) => alpha,
            FloatTexture::Node(_) => {
                let point = self.geometry.surface_point(ray, hit);
                self.textures.eval_float(alpha, &texture_context(&point, hit))
            }
        };
        if alpha >= 1.0 {
            return true;
        }
        if alpha <= 0.0 {
            return false;
        }
        let bits = |x: f32, y: f32| u64::from(x.to_bits()) << 32 | u64::from(y.to_bits());
        let shape = u64::from(hit.geometry.0) << 32 | u64::from(hit.primitive);
        let (o, d) = (ray.origin, ray.direction);
        let hash = hash64(&[bits(o.x, o.y), bits(o.z, d.x), bits(d.y, d.z), shape]);
        (hash >> 40) as f32 / (1_u64 << 24) as f32 <= alpha
    }

    /// True if the surface at a hit is that of a light.
    #[inline]
    #[must_use]
    pub fn emits(&self, hit: &Hit) -> bool {
        self.attributes[hit.geometry.0 as usize].lights.is_some()
    }

    /// False if light certainly does not pass the surface at a hit as if it were not there.
    #[inline]
    #[must_use]
    pub fn may_pass(&self, hit: &Hit) -> bool {
        self.has_passable || self.materials.is_mixture(self.attributes[hit.geometry.0 as usize].material)
    }

    /// The surface at a hit of the ray, whose direction has length 1.
    #[inline]
    #[must_use]
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let attributes = &self.attributes[hit.geometry.0 as usize];
        Surface {
            point: self.geometry.surface_point(ray, hit),
            hit: *hit,
            ray_origin: ray.origin,
            wo: -ray.direction,
            time: ray.time,
            material: attributes.material,
            light: attributes.lights.map(|lights| lights.of(hit.primitive)),
        }
    }

    /// How the surface scatters light; `None` where light passes it as if it were not there.
    ///
    /// Materials that disperse reduce `lambda` to its first wavelength.
    #[inline]
    #[must_use]
    pub fn bsdf(&self, surface: &Surface, lambda: &mut Wavelengths) -> Option<Bsdf> {
        if let Some(reflectance) = self.materials.uniform_diffuse(surface.material) {
            let diffuse = Diffuse::new(reflectance.sample(&self.textures.spectra, lambda));
            return Some(Bsdf::isotropic(surface.point.ns, surface.point.ng, BsdfKind::Diffuse(diffuse)));
        }
        let context = if self.materials.is_uniform(surface.material) {
            MaterialContext::uniform(&surface.point, surface.wo)
        } else {
            self.material_context(surface)
        };
        self.materials.bsdf(surface.material, &self.textures, &context, lambda)
    }

    fn material_context(&self, surface: &Surface) -> MaterialContext {
        let point = &surface.point;
        let ray = Ray { origin: surface.ray_origin, direction: -surface.wo, time: surface.time };
        let derivatives = self.geometry.surface_derivatives(&ray, &surface.hit);
        let (dpdx, dpdy) =
            self.camera.dpdx_dpdy(point.p, point.ng, surface.time, self.sampler.samples_per_pixel);
        let [dudx, dudy, dvdx, dvdy] = uv_differentials(&derivatives, dpdx, dpdy);
        let texture =
            TextureContext { dpdx, dpdy, dudx, dudy, dvdx, dvdy, ..texture_context(point, &surface.hit) };
        MaterialContext::new(texture, point, &derivatives, surface.wo)
    }

    /// The medium that light is in which leaves the surface in the direction `w`, where it was in `current`. Opaque surfaces
    /// and mixtures leave it as it is.
    #[inline]
    #[must_use]
    pub fn medium_towards(
        &self,
        surface: &Surface,
        w: Vector3,
        current: Option<MediumId>,
    ) -> Option<MediumId> {
        match self.materials.interface(surface.material) {
            Some(interface) => interface.towards(surface.point.ng.dot_vector(w)),
            None => current,
        }
    }

    /// The share of light that a medium leaves after a distance in metres.
    #[inline]
    #[must_use]
    pub fn transmittance_of(&self, medium: MediumId, distance: f32, lambda: &Wavelengths) -> Sampled {
        self.materials.media().transmittance(medium, distance, &self.textures.spectra, lambda)
    }

    /// Radiance in W/(m^2 sr nm) that a surface emits back along the path.
    #[inline]
    #[must_use]
    pub fn emitted(&self, surface: &Surface, lambda: &Wavelengths) -> Sampled {
        let Some(light) = surface.light else {
            return Sampled::ZERO;
        };
        let point = &surface.point;
        self.light(light).le(&self.light_context(), point.ng, point.uv, surface.wo, lambda)
    }

    /// Radiance in W/(m^2 sr nm) of the ambient term: what the surface shows the eye whatever falls on it. It lights nothing,
    /// so that only rays from the camera may ask for it (SPEC BRDF-10).
    #[inline]
    #[must_use]
    pub fn ambient(&self, surface: &Surface, lambda: &Wavelengths) -> Sampled {
        self.materials
            .ambient(surface.material)
            .map_or(Sampled::ZERO, |ambient| ambient.sample(&self.textures.spectra, lambda))
    }

    /// The share of light that gets from a point of a light to a surface: 0 or 1 without media. `interface` surfaces
    /// let it pass.
    #[inline]
    #[must_use]
    pub fn transmittance(&self, from: &Surface, to: &LightPoint) -> f32 {
        let origin = offset_ray_origin(from.point.p, from.point.p_error, from.point.ng, to.p - from.point.p);
        let target = match to.n {
            Some(n) => offset_ray_origin(to.p, to.p_error, n, origin - to.p),
            None => to.p,
        };
        self.transmittance_along(&Ray { origin, direction: target - origin, time: from.time }, SHADOW_END)
    }

    /// The share of light that gets from a surface to infinity in the unit direction `wi`.
    #[must_use]
    pub fn transmittance_to_infinity(&self, from: &Surface, wi: Vector3) -> f32 {
        self.transmittance_along(&from.spawn_ray(wi), f32::INFINITY)
    }

    #[inline]
    fn transmittance_along(&self, ray: &Ray, t_max: f32) -> f32 {
        let blocked = if self.has_passable {
            self.geometry.occluded(ray, t_max, &|hit: &Hit| {
                let material = self.attributes[hit.geometry.0 as usize].material;
                !self.materials.is_interface(material) && self.is_opaque(ray, hit)
            })
        } else {
            self.geometry.occluded(ray, t_max, &|_| true)
        };
        if blocked { 0.0 } else { 1.0 }
    }
}

/// Where textures are evaluated, without changes per pixel.
fn texture_context(point: &SurfacePoint, hit: &Hit) -> TextureContext {
    let shape_point = ShapePoint { geometry: hit.geometry.0, primitive: hit.primitive, uv: hit.uv };
    TextureContext { shape_point: Some(shape_point), ..TextureContext::at(point) }
}

/// Changes of u and v per pixel, from those of the position: the least-squares solution of
/// dp = dpdu du + dpdv dv (Pharr et al. 2023, section 10.1.1). Zero where the surface has no parameters.
fn uv_differentials(derivatives: &SurfaceDerivatives, dpdx: Vector3, dpdy: Vector3) -> [f32; 4] {
    let (dpdu, dpdv) = (derivatives.dpdu, derivatives.dpdv);
    let (uu, uv, vv) = (dpdu.dot(dpdu), dpdu.dot(dpdv), dpdv.dot(dpdv));
    let inverse = 1.0 / (f64::from(uu) * f64::from(vv) - f64::from(uv) * f64::from(uv)) as f32;
    if !inverse.is_finite() {
        return [0.0; 4];
    }
    let solve = |dp: Vector3| {
        let (u, v) = (dpdu.dot(dp), dpdv.dot(dp));
        [(vv * u - uv * v) * inverse, (uu * v - uv * u) * inverse]
    };
    let ([dudx, dvdx], [dudy, dvdy]) = (solve(dpdx), solve(dpdy));
    let clamp = |x: f32| if x.is_finite() { x.clamp(-1e8, 1e8) } else { 0.0 };
    [dudx, dudy, dvdx, dvdy].map(clamp)
}
