//! Choice among many weights in constant time (Walker 1977, "An Efficient Method for Generating Discrete Random Variables
//! with General Distributions"; Vose 1991 builds the table in linear time): n columns of equal width hold at most two
//! entries each, so that one number picks the column and the entry.

use crate::ONE_MINUS_EPSILON;

#[derive(Clone, Copy, Debug)]
struct Column {
    /// Share of the column that belongs to its own entry.
    own: f32,
    /// Who has the rest.
    alias: u32,
    /// Probability of the column's own entry over all columns.
    pmf: f32,
}

/// A table to draw indices in proportion to weights.
#[derive(Clone, Debug)]
pub struct AliasTable {
    columns: Vec<Column>,
}

impl AliasTable {
    /// A table of weights of at least 0; without weights above 0 all probabilities are 0 and any index may be drawn.
    #[must_use]
    pub fn new(weights: &[f32]) -> Self {
        let sum: f64 = weights.iter().map(|w| f64::from(*w)).sum();
        let n = weights.len() as f64;
        let pmf: Vec<f64> =
            weights.iter().map(|w| if sum > 0.0 { f64::from(*w) / sum } else { 0.0 }).collect();
        let mut columns: Vec<Column> = (0_u32..)
            .zip(&pmf)
            .map(|(index, pmf)| Column { own: 1.0, alias: index, pmf: *pmf as f32 })
            .collect();
        if sum <= 0.0 {
            return Self { columns };
        }
        let mut heights: Vec<f64> = pmf.iter().map(|p| p * n).collect();
        let (mut under, mut over): (Vec<usize>, Vec<usize>) =
            (0..columns.len()).partition(|index| heights[*index] < 1.0);
        while let (Some(&low), Some(&high)) = (under.last(), over.last()) {
            under.pop();
            columns[low].own = heights[low] as f32;
            columns[low].alias = high as u32;
            heights[high] -= 1.0 - heights[low];
            if heights[high] < 1.0 {
                over.pop();
                under.push(high);
            }
        }
        // What is left differs from 1 by rounding, but for entries of weight 0, which must never be drawn.
        let likeliest =
            (0..columns.len()).max_by(|a, b| pmf[*a].total_cmp(&pmf[*b])).expect("the sum is above 0");
        for index in under {
            if pmf[index] == 0.0 {
                columns[index].own = 0.0;
                columns[index].alias = likeliest as u32;
            }
        }
        Self { columns }
    }

    /// Number of weights.
    #[must_use]
    pub fn len(&self) -> usize {
        self.columns.len()
    }

    /// True if there are no weights.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.columns.is_empty()
    }

    /// An index, its probability, and `u` remapped to a fresh number in [0, 1).
    ///
    /// # Panics
    /// If the table is empty.
    #[inline]
    #[must_use]
    pub fn sample(&self, u: f32) -> (usize, f32, f32) {
        // In double precision: a float has too few digits to choose among a million columns and then within one.
        let position = f64::from(u) * self.columns.len() as f64;
        let index = (position as usize).min(self.columns.len() - 1);
        let place = ((position - index as f64) as f32).min(ONE_MINUS_EPSILON);
        let column = &self.columns[index];
        if place < column.own {
            return (index, column.pmf, (place / column.own).min(ONE_MINUS_EPSILON));
        }
        let alias = column.alias as usize;
        let remapped = ((place - column.own) / (1.0 - column.own)).min(ONE_MINUS_EPSILON);
        (alias, self.columns[alias].pmf, remapped)
    }

    /// Probability of an index.
    #[inline]
    #[must_use]
    pub fn pmf(&self, index: usize) -> f32 {
        self.columns[index].pmf
    }
}

#[cfg(test)]
mod tests;
