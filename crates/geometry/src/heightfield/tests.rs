use super::*;

fn fractal(hurst: f32, seed: u64) -> HeightGrid {
    HeightGrid::fractal(&FractalHeights { levels: 8, hurst, amplitude: 1.0, seed })
}

/// Mean of squared differences of heights at a distance of `step` points, along both axes.
fn variogram(grid: &HeightGrid, step: u32) -> f64 {
    let n = grid.n[0];
    let (mut sum, mut count) = (0.0, 0.0);
    for j in 0..n {
        for i in 0..n - step {
            for [a, b] in [[grid.at(i, j), grid.at(i + step, j)], [grid.at(j, i), grid.at(j, i + step)]] {
                sum += f64::from(b - a).powi(2);
                count += 1.0;
            }
        }
    }
    sum / count
}

/// What the middles of squares of side `step` differ by from the mean of their corners, in the mean square.
fn square_noise(grid: &HeightGrid, step: u32) -> (f64, u32) {
    let (mut sum, mut count) = (0.0, 0);
    let half = step / 2;
    for j in (half..grid.n[1]).step_by(step as usize) {
        for i in (half..grid.n[0]).step_by(step as usize) {
            let corners =
                [(i - half, j - half), (i + half, j - half), (i - half, j + half), (i + half, j + half)];
            let mean = corners.iter().map(|&(i, j)| f64::from(grid.at(i, j))).sum::<f64>() / 4.0;
            sum += (f64::from(grid.at(i, j)) - mean).powi(2);
            count += 1;
        }
    }
    (sum / f64::from(count), count)
}

/// The noise of each level has the variance of fractional Brownian motion: a^2 s^(2H) (2^(-H) - 1/4 - 2^H / 8). The mean square of n
/// Gaussians has a relative standard deviation of sqrt(2 / n).
#[test]
fn noise_has_the_variance_of_its_level() {
    for hurst in [0.2, 0.5, 0.8] {
        let grid = HeightGrid::fractal(&FractalHeights { levels: 9, hurst, amplitude: 3.0, seed: 4 });
        let h = f64::from(hurst);
        for step in [2, 4, 8, 16, 32] {
            let (found, n) = square_noise(&grid, step);
            let side = f64::from(step) / 512.0;
            let expected = 9.0 * side.powf(2.0 * h) * ((-h).exp2() - 0.25 - h.exp2() / 8.0);
            let error = found / expected - 1.0;
            assert!(
                error.abs() < 4.5 * (2.0 / f64::from(n)).sqrt() + 1e-4,
                "{error} at {step} for H = {hurst}"
            );
        }
    }
}

/// Differences of heights grow like distance^(2H), about: interpolation between the points of a level makes the slope smaller
/// where the surface is smooth (1.33 for 1.6), which is known of midpoint displacement.
#[test]
fn heights_differ_like_a_power_of_distance() {
    let mut last = 0.0;
    for hurst in [0.3, 0.5, 0.8] {
        let slope = |seed| {
            let grid = fractal(hurst, seed);
            (variogram(&grid, 16) / variogram(&grid, 1)).log2() / 4.0
        };
        let mean = (0..8).map(slope).sum::<f64>() / 8.0;
        assert!((mean - 2.0 * f64::from(hurst)).abs() < 0.35 && mean > last, "slope {mean} for H = {hurst}");
        last = mean;
    }
}

/// A seed means one field for ever, and another seed another one.
#[test]
fn fields_depend_on_their_seed_alone() {
    assert_eq!(fractal(0.5, 7), fractal(0.5, 7));
    assert_ne!(fractal(0.5, 7), fractal(0.5, 8));
    let heights = fractal(0.5, 7);
    let hash = heights.heights().iter().fold(0, |hash, z| etendue_math::hash64(&[hash, z.to_bits().into()]));
    assert_eq!(heights.heights().len(), 257 * 257);
    assert_ne!(hash, 0);
}

/// The mesh has two triangles for each square, and the normals of a plane are those of the plane, at borders too.
#[test]
fn planes_have_the_normals_of_planes() {
    let heights = (0..5 * 4).map(|k| 0.5 * (k % 5) as f32 / 4.0 - 0.25 * (k / 5) as f32 / 3.0).collect();
    let mesh = HeightGrid::new([5, 4], heights).expect("a grid").mesh();
    assert_eq!((mesh.positions.len(), mesh.indices.len()), (20, 24));
    assert!(mesh.validate().is_ok());
    let expected = Normal3::new(-0.5, 0.25, 1.0).normalized();
    for n in &mesh.normals {
        assert!((*n - expected).abs().max_element() < 1e-6, "{n:?}");
    }
    for [a, b, c] in mesh.indices {
        let [a, b, c] = [a, b, c].map(|i| mesh.positions[i as usize]);
        let n = (b - a).cross(c - a).normalized();
        assert!(expected.dot_vector(n) > 0.999_999, "winding");
    }
    assert_eq!(
        HeightGrid::fractal(&FractalHeights { levels: 10, hurst: 0.8, amplitude: 0.1, seed: 1 })
            .mesh()
            .indices
            .len(),
        1 << 21
    );
}

/// Grids that are none.
#[test]
fn impossible_grids_are_refused() {
    assert!(HeightGrid::new([2, 2], vec![0.0; 4]).is_some());
    assert!(HeightGrid::new([2, 2], vec![0.0; 3]).is_none());
    assert!(HeightGrid::new([1, 4], vec![0.0; 4]).is_none());
    assert!(HeightGrid::new([u32::MAX, u32::MAX], Vec::new()).is_none());
    assert!(HeightGrid::is_size([4096, 2048]) && HeightGrid::is_size([2, 1 << 22]));
    assert!(!HeightGrid::is_size([4096, 2049]) && !HeightGrid::is_size([8192, 8192]));
    assert!(HeightGrid::new([2, 2], vec![0.0, 0.0, f32::NAN, 0.0]).is_none());
    let deep = FractalHeights { levels: 4_000_000_000, hurst: 0.5, amplitude: 1.0, seed: 0 };
    assert_eq!(HeightGrid::fractal(&FractalHeights { levels: 3, ..deep }).heights().len(), 81);
}
