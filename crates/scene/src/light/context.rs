//! What lights need to know besides themselves, and what they answer.

use std::sync::Arc;

use etendue_geometry::{Geometry, Reference};
use etendue_math::{Bounds3, Frame, Motion, Normal3, Point2, Point3, Ray, Vector3, lerp, warp};
use etendue_spectrum::{Sampled, SpectrumTables};

use crate::texture::Textures;

use super::{
    AreaEmission, GoniometricLight, IesLight, InfiniteImageLight, InfinitePortalLight, LightImage,
    LightImageId, LightMotionId, LuminousProfile, LuminousProfileId, Photometry, ProjectionLight, SkyLight,
};

/// A sphere around the scene: lights at infinity shine on its cross-section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneSphere {
    /// Centre.
    pub center: Point3,
    /// Radius in metres, greater than 0.
    pub radius: f32,
}

impl Default for SceneSphere {
    fn default() -> Self {
        Self { center: Point3::ORIGIN, radius: 1.0 }
    }
}

impl SceneSphere {
    /// The sphere around a box, a little larger; of radius 1 m around an empty or flat point-like box.
    #[must_use]
    pub fn around(bounds: Bounds3) -> Self {
        let (center, radius) = bounds.bounding_sphere();
        if radius > 0.0 && radius.is_finite() {
            Self { center, radius: radius * 1.001 }
        } else {
            Self { center, radius: 1.0 }
        }
    }

    /// Area of the cross-section in square metres.
    #[must_use]
    pub fn cross_section(&self) -> f32 {
        std::f32::consts::PI * self.radius * self.radius
    }

    /// Start of a ray that enters the sphere in the direction `w`, uniform over the cross-section (SPEC EMI-7).
    pub(super) fn sample_entry(&self, w: Vector3, u: Point2) -> Ray {
        let frame = Frame::from_z(w);
        let disk = warp::sample_concentric_disk(u);
        let across = frame.x * disk.x + frame.y * disk.y;
        Ray::new(self.center + (across - w) * self.radius, w)
    }
}

/// The box around the scene. Of light that comes from infinity in a direction w, the flux through it is that through its shadow
/// across w, of area `sum |w_i| A_i` over the areas of its faces: for flat scenes much less than through the sphere around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneBox {
    bounds: Bounds3,
}

impl SceneBox {
    /// The box around what there is, a little larger; `None` around nothing, a point or what is infinite.
    #[must_use]
    pub fn around(bounds: Bounds3) -> Option<Self> {
        let size = bounds.diagonal().length();
        if bounds.is_empty() || !(size > 0.0 && size.is_finite()) {
            return None;
        }
        let margin = Vector3::splat(5e-4 * size) + bounds.min.abs().max(bounds.max.abs()).as_vector() * 1e-6;
        Some(Self { bounds: Bounds3 { min: bounds.min - margin, max: bounds.max + margin } })
    }

    /// Areas of the shadows of the faces across each axis.
    fn shadows(&self, w: Vector3) -> [f32; 3] {
        let d = self.bounds.diagonal();
        [w.x.abs() * d.y * d.z, w.y.abs() * d.z * d.x, w.z.abs() * d.x * d.y]
    }

    /// Area of the shadow across the unit direction `w`, in square metres.
    #[must_use]
    pub fn cross_section(&self, w: Vector3) -> f32 {
        self.shadows(w).iter().sum()
    }

    /// Start of a ray that enters the box in the unit direction `w`, uniform over the shadow.
    fn sample_entry(&self, w: Vector3, u: Point2) -> Ray {
        let shadows = self.shadows(w);
        let mut place = u.x * self.cross_section(w);
        let mut axis = 0;
        while axis < 2 && place >= shadows[axis] {
            place -= shadows[axis];
            axis += 1;
        }
        let t = if shadows[axis] > 0.0 { (place / shadows[axis]).min(1.0) } else { 0.5 };
        let Bounds3 { min, max } = self.bounds;
        let mut origin = if w[axis] > 0.0 { min } else { max };
        for (across, t) in [((axis + 1) % 3, t), ((axis + 2) % 3, u.y)] {
            origin[across] = lerp(t, min[across], max[across]);
        }
        Ray::new(origin, w)
    }
}

/// The arenas behind the ids that lights hold.
#[derive(Clone, Debug, Default)]
pub struct LightTables {
    /// Pictures.
    pub images: Vec<LightImage>,
    /// Point lights with a picture of intensity.
    pub goniometric: Vec<GoniometricLight>,
    /// Luminaires.
    pub luminaires: Vec<IesLight>,
    /// Projectors.
    pub projections: Vec<ProjectionLight>,
    /// Pictures of the surroundings.
    pub environments: Vec<InfiniteImageLight>,
    /// Surroundings seen through openings.
    pub portals: Vec<InfinitePortalLight>,
    /// Skies.
    pub skies: Vec<SkyLight>,
    /// What emissive surfaces emit, shared by their primitives.
    pub emissions: Vec<AreaEmission>,
    /// How the radiance of some of them depends on direction.
    pub profiles: Vec<LuminousProfile>,
    /// How emissive surfaces move, shared likewise.
    pub motions: Vec<Motion>,
    /// The sphere around the scene; to be set before any light at infinity is used.
    pub scene_sphere: SceneSphere,
    /// The box around the scene, through which such lights emit; through the sphere if `None`.
    pub scene_box: Option<SceneBox>,
}

impl LightTables {
    /// Start of a ray from infinity in the unit direction `w` (SPEC EMI-7), and its density per square metre across it.
    pub(super) fn sample_entry(&self, w: Vector3, u: Point2) -> (Ray, f32) {
        let ray = match &self.scene_box {
            Some(scene_box) => scene_box.sample_entry(w, u),
            None => self.scene_sphere.sample_entry(w, u),
        };
        (ray, self.entry_pdf(w))
    }

    /// Density of such starts per square metre.
    pub(super) fn entry_pdf(&self, w: Vector3) -> f32 {
        1.0 / self.entry_area(w)
    }

    /// Area across the unit direction `w` through which lights at infinity emit.
    #[must_use]
    pub fn entry_area(&self, w: Vector3) -> f32 {
        let of_sphere = || self.scene_sphere.cross_section();
        self.scene_box.as_ref().map_or_else(of_sphere, |scene_box| scene_box.cross_section(w))
    }

    /// Adds a picture.
    pub fn add_image(&mut self, image: LightImage) -> LightImageId {
        self.images.push(image);
        LightImageId(self.images.len() as u32 - 1)
    }

    /// Adds a profile.
    pub fn add_profile(&mut self, profile: LuminousProfile) -> LuminousProfileId {
        self.profiles.push(profile);
        LuminousProfileId(self.profiles.len() as u32 - 1)
    }

    /// The profile that was made of a table, if there is one.
    #[must_use]
    pub fn profile_of(&self, photometry: &Arc<Photometry>) -> Option<LuminousProfileId> {
        let index = self.profiles.iter().position(|profile| profile.is_of(photometry));
        index.map(|index| LuminousProfileId(index as u32))
    }

    /// The profile of that id.
    #[must_use]
    pub fn profile(&self, id: LuminousProfileId) -> &LuminousProfile {
        &self.profiles[id.0 as usize]
    }

    /// Adds a motion.
    pub fn add_motion(&mut self, motion: Motion) -> LightMotionId {
        self.motions.push(motion);
        LightMotionId(self.motions.len() as u32 - 1)
    }

    /// The picture of that id.
    #[inline]
    #[must_use]
    pub fn image(&self, id: LightImageId) -> &LightImage {
        &self.images[id.0 as usize]
    }
}

/// Everything that the methods of [`Light`](super::Light) look things up in.
#[derive(Clone, Copy, Debug)]
pub struct LightContext<'a> {
    /// Shapes of area lights.
    pub geometry: &'a Geometry,
    /// Alpha of area lights.
    pub textures: &'a Textures,
    /// Tabulated spectra.
    pub spectra: &'a SpectrumTables,
    /// Arenas of lights.
    pub tables: &'a LightTables,
    /// Time in seconds, for lights that move.
    pub time: f32,
}

/// A point on a light, from where a shadow ray may start as well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightPoint {
    /// Position.
    pub p: Point3,
    /// Bound of the absolute error of each coordinate of `p`.
    pub p_error: Vector3,
    /// Geometric normal; `None` for lights that are points.
    pub n: Option<Normal3>,
    /// Texture coordinates; zero for lights that are points.
    pub uv: Point2,
}

/// A direction towards a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// Unit direction from the reference point to the light.
    pub wi: Vector3,
    /// Radiance that arrives from there; for delta lights without a surface, irradiance where one faces the light.
    pub le: Sampled,
    /// Density per steradian; 1 for delta lights without a surface.
    pub pdf_w: f32,
    /// Distance to the light in metres; infinite for lights at infinity.
    pub distance: f32,
    /// True if no other technique can find this direction (multiple importance sampling does not apply).
    pub is_delta: bool,
    /// The point on the light; `None` for lights at infinity.
    pub p_light: Option<LightPoint>,
}

/// A ray that leaves a light. The flux it stands for is `le * cosine / (pdf_a * pdf_w)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmittedRay {
    /// Start and unit direction, away from the light. For area lights the start is on the surface: move it off with
    /// [`etendue_math::offset_ray_origin`]. For lights at infinity it lies outside the scene.
    pub ray: Ray,
    /// Bound of the absolute error of each coordinate of the start.
    pub p_error: Vector3,
    /// Geometric normal at the start for area lights; `None` for others.
    pub n: Option<Normal3>,
    /// Texture coordinates at the start; zero where there is no surface.
    pub uv: Point2,
    /// Radiance; intensity for point-like lights; irradiance for distant lights.
    pub le: Sampled,
    /// |cos| between `n` and the direction; 1 where there is no surface.
    pub cosine: f32,
    /// Density of the start per square metre; 1 where the position is certain.
    pub pdf_a: f32,
    /// Density of the direction per steradian; 1 where the direction is certain.
    pub pdf_w: f32,
}

impl EmittedRay {
    /// A ray from a light that is a point.
    pub(super) fn from_point(p: Point3, w: Vector3, intensity: Sampled, pdf_w: f32) -> Option<Self> {
        (pdf_w > 0.0).then(|| Self {
            ray: Ray::new(p, w),
            p_error: Vector3::splat(0.0),
            n: None,
            uv: Point2::splat(0.0),
            le: intensity,
            cosine: 1.0,
            pdf_a: 1.0,
            pdf_w,
        })
    }

    /// A ray from infinity that enters the scene in the direction `w`.
    pub(super) fn from_infinity(
        tables: &LightTables,
        w: Vector3,
        u_position: Point2,
        le: Sampled,
        pdf_w: f32,
    ) -> Option<Self> {
        let (ray, pdf_a) = tables.sample_entry(w, u_position);
        (pdf_w > 0.0 && pdf_a.is_finite()).then(|| Self {
            ray,
            p_error: Vector3::splat(0.0),
            n: None,
            uv: Point2::splat(0.0),
            le,
            cosine: 1.0,
            pdf_a,
            pdf_w,
        })
    }
}

/// The sample of a light that is the point `p` and sends `intensity` towards `reference`.
pub(super) fn point_sample(p: Point3, reference: &Reference, intensity: Sampled) -> Option<LightSample> {
    let to_light = p - reference.p;
    let distance_squared = to_light.length_squared();
    let wi = to_light.try_normalized()?;
    if intensity.is_black() {
        return None;
    }
    Some(LightSample {
        wi,
        le: intensity / distance_squared, // I / r^2
        pdf_w: 1.0,
        distance: distance_squared.sqrt(),
        is_delta: true,
        p_light: Some(LightPoint { p, p_error: Vector3::splat(0.0), n: None, uv: Point2::splat(0.0) }),
    })
}

/// The sample of a light at infinity in the direction `wi`; `None` if the density is 0.
pub(super) fn infinite_sample(wi: Vector3, le: Sampled, pdf_w: f32) -> Option<LightSample> {
    (pdf_w > 0.0 && !le.is_black()).then_some(LightSample {
        wi,
        le,
        pdf_w,
        distance: f32::INFINITY,
        is_delta: false,
        p_light: None,
    })
}
