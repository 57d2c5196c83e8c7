//! Searches by AVX2, chosen at run time: the same operations in the same order on eight points at a time, and so the same bits.

#![allow(
    unsafe_code,
    reason = "vectors are loaded by pointers, and instructions need a processor that has them"
)]

use super::packed::{PackedPoints, Search};

/// Searches and says true, if the processor has AVX2.
#[inline]
pub(super) fn search(points: &PackedPoints, p: [f32; 3], search: &mut impl Search) -> bool {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("bmi1") {
        // SAFETY: the processor has the instructions.
        unsafe { avx2::search(points, p, search) };
        return true;
    }
    let _ = (points, p, search);
    false
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use std::arch::x86_64::*;

    use crate::points::packed::{BUCKET, Bucket, PackedPoints, Search};

    #[target_feature(enable = "avx2,bmi1")]
    pub(super) fn search(points: &PackedPoints, p: [f32; 3], search: &mut impl Search) {
        points.search_by(p, search, |bucket, p, limit, distances| measure(bucket, p, limit, distances));
    }

    /// As [`Bucket::measure`].
    #[inline]
    #[target_feature(enable = "avx2,bmi1")]
    fn measure(bucket: &Bucket, p: [f32; 3], limit_squared: f32, distances: &mut [f32; BUCKET]) -> u32 {
        let (p, limit_squared) = (p.map(|v| _mm256_set1_ps(v)), _mm256_set1_ps(limit_squared));
        let mut is_near = 0;
        for first in (0..BUCKET).step_by(8) {
            let square = |axis: usize| {
                let coordinates: &[f32] = &bucket.0[axis][first..first + 8];
                // SAFETY: the slice has eight numbers.
                let d = _mm256_sub_ps(unsafe { _mm256_loadu_ps(coordinates.as_ptr()) }, p[axis]);
                _mm256_mul_ps(d, d)
            };
            let sum = _mm256_add_ps(_mm256_add_ps(square(0), square(1)), square(2));
            // SAFETY: the slice has eight numbers.
            unsafe { _mm256_storeu_ps(distances[first..first + 8].as_mut_ptr(), sum) };
            let bits = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(sum, limit_squared));
            is_near |= (bits as u32) << first;
        }
        is_near
    }

    #[cfg(test)]
    mod tests {
        use etendue_math::{Point3, Rng};

        use super::*;
        use crate::points::found::Neighbours;
        use crate::points::packed::Nearest;
        use crate::test_support::point_in_cube;

        /// Both find the same bits, also where a bucket is not full and for places that are not finite.
        #[test]
        fn both_searches_find_the_same_points() {
            if !is_x86_feature_detected!("avx2") || !is_x86_feature_detected!("bmi1") {
                return;
            }
            let mut rng = Rng::new(31, 0);
            for n in [1, 7, 16, 17, 100, 3000] {
                let points: Vec<Point3> = (0..n).map(|_| point_in_cube(&mut rng, 1.0)).collect();
                let (packed, _) = PackedPoints::new(&points);
                let mut found = [Neighbours::new(), Neighbours::new()];
                let odd = [f32::NAN, f32::INFINITY, 1e30].map(Point3::splat);
                let places: Vec<Point3> = (0..50).map(|_| point_in_cube(&mut rng, 1.2)).chain(odd).collect();
                for p in places {
                    for (k, radius) in [(1, f32::INFINITY), (20, 0.4), (200, f32::INFINITY)] {
                        let p = [p.x, p.y, p.z];
                        let [a, b] = &mut found;
                        a.start(k, radius);
                        b.start(k, radius);
                        packed.search_by(p, &mut Nearest { found: a, name: |i| i }, Bucket::measure);
                        // SAFETY: the processor has the instructions.
                        unsafe { search(&packed, p, &mut Nearest { found: b, name: |i| i }) };
                        assert!(
                            found[0].iter().eq(found[1].iter()),
                            "{n} points, {k} within {radius} of {p:?}"
                        );
                    }
                }
            }
        }
    }
}
