//! Statistics for tests: is a mean what theory says, do samples have the density they claim, how fast does an error fall?
//!
//! All in double precision. Tests state a significance: the probability to fail although all is right. A suite of n tests
//! of total significance alpha gives each 1 - (1 - alpha)^(1/n) ([`sidak`]).

mod chi_square;
mod cubature;
mod distributions;
mod moments;
mod regression;
mod sampling;

pub use chi_square::{ChiSquare, chi_square_test};
pub use cubature::{Rectangle, integrate_rectangle};
pub use distributions::{
    chi_square_sf, combined_p_value, erf, erfc, ln_gamma, normal_cdf, normal_quantile, regularized_beta,
    regularized_gamma_p, regularized_gamma_q, sidak, student_t_cdf,
};
pub use moments::{Moments, mean_test, means_agree};
pub use regression::{linear_fit, log_log_slope};
pub use sampling::{
    Grid, chi_square_cells, integrate_sphere, interval_chi_square, sphere_chi_square, sphere_p_value,
    square_chi_square,
};

#[cfg(test)]
mod tests;
