//! Photons of unit power in the plane z = 0 and on walls, and estimates among them.

use std::cell::RefCell;

use etendue_geometry::points::PointTree;
use etendue_math::{Point3, Rng, Vector3, warp};
use etendue_spectrum::Xyz;
use etendue_transport::photon::estimate::{DensityEstimate, EstimateScratch, Photons, irradiance};

pub(super) const UP: Vector3 = Vector3::new(0.0, 0.0, 1.0);

/// Photons.
#[derive(Default)]
pub(super) struct Field {
    pub(super) p: Vec<Point3>,
    pub(super) wi: Vec<Vector3>,
}

impl Photons for Field {
    fn position(&self, index: u32) -> Point3 {
        self.p[index as usize]
    }
    fn wi(&self, index: u32) -> Vector3 {
        self.wi[index as usize]
    }
    fn power(&self, _: u32) -> Xyz {
        Xyz::new(1.0, 1.0, 1.0)
    }
}

/// The point of a rectangle `[x, y]`.
pub(super) fn place(rng: &mut Rng, [x, y]: [[f32; 2]; 2]) -> [f32; 2] {
    [x, y].map(|[a, b]| a + (b - a) * rng.next_f32())
}

/// A direction of light from all around the normal +z.
pub(super) fn from_above(rng: &mut Rng) -> Vector3 {
    warp::sample_cosine_hemisphere(etendue_math::Point2::new(rng.next_f32(), rng.next_f32()))
}

impl Field {
    pub(super) fn add(&mut self, p: Point3, wi: Vector3) {
        self.p.push(p);
        self.wi.push(wi);
    }
}

/// A field that can be asked.
pub(super) struct Searchable {
    pub(super) field: Field,
    tree: PointTree,
}

thread_local! {
    static SCRATCH: RefCell<EstimateScratch> = RefCell::default();
}

impl Searchable {
    pub(super) fn new(field: Field) -> Self {
        let tree = PointTree::new(&field.p);
        Self { field, tree }
    }

    /// Photons per m^2 from above, by the `k` nearest.
    pub(super) fn density(&self, estimate: &DensityEstimate, (p, n): (Point3, Vector3), k: usize) -> f64 {
        let wanted = estimate.search_size(k);
        SCRATCH.with_borrow_mut(|scratch| {
            self.tree.nearest(p, wanted, f32::INFINITY, &mut scratch.found);
            f64::from(irradiance(estimate, (p, n), wanted, &self.field, scratch).0.y)
        })
    }
}
