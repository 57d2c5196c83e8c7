//! Integration of Monte Carlo estimators from the crate's parts: the laws that every renderer rests on.

mod geometry;
mod monte_carlo;
