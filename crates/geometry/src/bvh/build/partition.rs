//! Reordering in place.

use rayon::prelude::*;

use super::{CHUNK, PARALLEL_BINNING};

/// Moves what satisfies a condition to the front and returns how much that is. The order of the result depends on
/// the input alone.
pub(super) fn partition<T: Copy + Send>(values: &mut [T], is_left: &(impl Fn(&T) -> bool + Sync)) -> usize {
    if values.len() < PARALLEL_BINNING {
        return partition_serially(values, is_left);
    }
    // Each chunk by itself; then runs that lie on the wrong side of the middle change places.
    let counts: Vec<usize> =
        values.par_chunks_mut(CHUNK).map(|chunk| partition_serially(chunk, is_left)).collect();
    let middle = counts.iter().sum();
    let (front, back) = values.split_at_mut(middle);
    let wrong_in_front = runs(front, 0, &counts, |start, n| start + n..start + CHUNK);
    let wrong_in_back = runs(back, middle, &counts, |start, n| start..start + n);
    exchange(wrong_in_front, wrong_in_back);
    middle
}

/// Without branches that depend on the values: each goes to the boundary, which moves on if it belongs to the left.
fn partition_serially<T: Copy>(values: &mut [T], is_left: &impl Fn(&T) -> bool) -> usize {
    let mut n_left = 0;
    for i in 0..values.len() {
        let value = values[i];
        values.swap(i, n_left);
        n_left += usize::from(is_left(&value));
    }
    n_left
}

/// The parts of a slice that `run` names for each chunk by its start and its number of values for the left;
/// `values` begin at `offset` among the values of all chunks.
fn runs<'v, T>(
    values: &'v mut [T],
    offset: usize,
    counts: &[usize],
    run: impl Fn(usize, usize) -> std::ops::Range<usize>,
) -> Vec<&'v mut [T]> {
    let end = offset + values.len();
    let mut rest = values;
    let mut taken = offset;
    let mut result = Vec::new();
    for (chunk, n) in counts.iter().enumerate() {
        let range = run(chunk * CHUNK, *n);
        let (start, stop) = (range.start.max(offset), range.end.min(end));
        if start < stop {
            let (_, tail) = rest.split_at_mut(start - taken);
            let (own, tail) = tail.split_at_mut(stop - start);
            result.push(own);
            rest = tail;
            taken = stop;
        }
    }
    result
}

/// Exchanges two lists of runs that are equally long in all.
fn exchange<T: Send>(a: Vec<&mut [T]>, b: Vec<&mut [T]>) {
    let (mut a, mut b) = (a.into_iter(), b.into_iter());
    let mut pairs = Vec::new();
    let (mut own, mut other) = (a.next(), b.next());
    while let (Some(x), Some(y)) = (own, other) {
        let n = x.len().min(y.len());
        let (x, x_rest) = x.split_at_mut(n);
        let (y, y_rest) = y.split_at_mut(n);
        pairs.push((x, y));
        own = if x_rest.is_empty() { a.next() } else { Some(x_rest) };
        other = if y_rest.is_empty() { b.next() } else { Some(y_rest) };
    }
    pairs.into_par_iter().for_each(|(x, y)| x.swap_with_slice(y));
}
