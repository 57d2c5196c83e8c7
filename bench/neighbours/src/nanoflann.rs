//! nanoflann, which is a C++ template, by way of `nanoflann.cpp`.

use std::ffi::c_void;

unsafe extern "C" {
    fn flann_build(xyz: *const f32, n: usize, leaf: usize) -> *mut c_void;
    fn flann_free(index: *mut c_void);
    fn flann_memory(index: *mut c_void) -> usize;
    fn flann_nearest(index: *mut c_void, p: *const f32, k: usize, limit_squared: f32, sum: *mut f64) -> usize;
    fn flann_within(index: *mut c_void, p: *const f32, limit_squared: f32, sum: *mut f64) -> usize;
}

/// A tree over points that it does not own.
pub(crate) struct Flann<'a> {
    index: *mut c_void,
    _points: &'a [[f32; 3]],
}

impl<'a> Flann<'a> {
    /// With so many points in a leaf.
    pub(crate) fn new(points: &'a [[f32; 3]], leaf: usize) -> Self {
        // SAFETY: the points outlive the index, which the lifetime says.
        let index = unsafe { flann_build(points.as_ptr().cast(), points.len(), leaf) };
        Self { index, _points: points }
    }

    /// Bytes on the heap, without the points.
    pub(crate) fn memory_bytes(&self) -> usize {
        // SAFETY: the index is alive.
        unsafe { flann_memory(self.index) }
    }

    /// The `k` nearest nearer than a limit: their number and the sum of their squared distances.
    pub(crate) fn nearest(&self, p: [f32; 3], k: usize, limit_squared: f32) -> (usize, f64) {
        let mut sum = 0.0;
        // SAFETY: the index is alive, `p` has three numbers, and one thread asks.
        let n = unsafe { flann_nearest(self.index, p.as_ptr(), k, limit_squared, &raw mut sum) };
        (n, sum)
    }

    /// All nearer than a limit.
    pub(crate) fn within(&self, p: [f32; 3], limit_squared: f32) -> (usize, f64) {
        let mut sum = 0.0;
        // SAFETY: as above.
        let n = unsafe { flann_within(self.index, p.as_ptr(), limit_squared, &raw mut sum) };
        (n, sum)
    }
}

impl Drop for Flann<'_> {
    fn drop(&mut self) {
        // SAFETY: it is freed once.
        unsafe { flann_free(self.index) }
    }
}
