//! Normals of points that have none, from the plane through their neighbours (Hoppe et al. 1992, "Surface Reconstruction from
//! Unorganized Points", doi:10.1145/133994.134011).
//!
//! The normal is the direction in which neighbours spread least. Its side is carried from point to point, first where normals
//! are most alike; it begins at the highest point of each part, whose normal points upwards.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use etendue_math::{Normal3, Point3};
use glam::{DMat3, DVec3};
use rayon::prelude::*;

use crate::double;
use crate::points::{Neighbours, PointTree};

/// Unit normals of points by their `n_neighbours` nearest others; the zero vector where points give none.
#[must_use]
pub fn estimate_normals(positions: &[Point3], n_neighbours: u32) -> Vec<Normal3> {
    let tree = PointTree::new(positions);
    let fit = |found: &mut Neighbours, p: &Point3| {
        tree.nearest(*p, n_neighbours as usize + 1, f32::MAX, found);
        let mut near: Vec<u32> = found.iter().map(|neighbour| neighbour.index).collect();
        near.sort_unstable();
        let n = plane_normal(near.iter().map(|&i| double::point(positions[i as usize])));
        (near, n)
    };
    let (near, mut normals): (Vec<Vec<u32>>, Vec<DVec3>) =
        positions.par_iter().map_init(Neighbours::new, fit).unzip();
    orient(positions, &near, &mut normals);
    normals.into_iter().map(double::to_normal).collect()
}

/// The eigenvector of the least eigenvalue of the covariance, by inverse iteration.
fn plane_normal(points: impl Iterator<Item = DVec3> + Clone) -> DVec3 {
    let n = points.clone().count() as f64;
    let mean = points.clone().sum::<DVec3>() / n;
    let mut covariance = DMat3::ZERO;
    for p in points {
        let d = p - mean;
        covariance += DMat3::from_cols(d * d.x, d * d.y, d * d.z);
    }
    let trace = covariance.x_axis.x + covariance.y_axis.y + covariance.z_axis.z;
    if trace <= 0.0 || !trace.is_finite() {
        return DVec3::ZERO;
    }
    // Scaled, and moved a little so that it can be inverted where the points are in one plane.
    let inverse = (covariance * (1.0 / trace) + DMat3::IDENTITY * 1e-9).inverse();
    let columns = [inverse.x_axis, inverse.y_axis, inverse.z_axis];
    let mut axis = columns
        .into_iter()
        .fold(DVec3::ZERO, |a, b| if b.length_squared() > a.length_squared() { b } else { a });
    for _ in 0..40 {
        axis = (inverse * axis).normalize_or_zero();
    }
    axis
}

/// Turns normals to one side of each connected part.
fn orient(positions: &[Point3], near: &[Vec<u32>], normals: &mut [DVec3]) {
    let mut highest_first: Vec<u32> = (0..positions.len() as u32).collect();
    highest_first.sort_by(|a, b| positions[*b as usize].z.total_cmp(&positions[*a as usize].z));
    let mut is_done = vec![false; positions.len()];
    let mut queue = BinaryHeap::new();
    for seed in highest_first {
        if is_done[seed as usize] {
            continue;
        }
        if normals[seed as usize].z < 0.0 {
            normals[seed as usize] = -normals[seed as usize];
        }
        queue.push(Reverse((0_u32, seed, seed)));
        while let Some(Reverse((_, point, from))) = queue.pop() {
            let i = point as usize;
            if std::mem::replace(&mut is_done[i], true) {
                continue;
            }
            if normals[i].dot(normals[from as usize]) < 0.0 {
                normals[i] = -normals[i];
            }
            for &next in near[i].iter().filter(|&&next| !is_done[next as usize]) {
                let unlike = 1.0 - normals[i].dot(normals[next as usize]).abs() as f32;
                queue.push(Reverse((unlike.max(0.0).to_bits(), next, point)));
            }
        }
    }
}
