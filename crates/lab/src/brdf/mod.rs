//! The explorer of scattering models (SPEC BRDF-31, EXP-22, EXP-44): what a material does with light, in pictures and
//! numbers.
//!
//! A [`Subject`] is a material by name with parameters, or one of a scene. [`explore`] measures its lobe in the plane of
//! incidence, its albedo and Fresnel reflectance against the angle, samples against their density, and the laws; and
//! renders a ball of it. An [`Exploration`] knows its table, its picture and its page. [`law_table`] holds all
//! configurations of all models against the laws.

mod curves;
mod figure;
mod fresnel;
mod laws;
mod page;
mod subject;

#[cfg(test)]
mod tests;

use etendue_image::Image;
use etendue_scene::Film;
use etendue_scene::bsdf::laws::Measures;
use etendue_transport::lpe::PathExpressions;
use etendue_transport::{Stop, Unobserved, method, render};

pub use curves::{
    Curve, Histogram, INCIDENCE_DEG, Lobe, SHOWN_INCIDENCE_DEG, albedo_curves, histograms, lobes, meridians,
};
pub use fresnel::{FresnelCurves, fresnel_curves};
pub use laws::{LawLine, LawRow, law_lines, law_names, law_table, law_table_text};
pub use subject::{LAMBDA_NM, Subject, SubjectError, SubjectResult};

/// What is known of a subject.
#[derive(Clone, Debug)]
pub struct Exploration {
    /// Name of the material.
    pub name: String,
    /// Type of the material.
    pub model: String,
    /// Parameters as written.
    pub parameters: Vec<(String, String)>,
    /// What should be known of the curves.
    pub remarks: Vec<String>,
    /// The laws in numbers.
    pub measures: Measures,
    /// The same for people.
    pub laws: Vec<LawLine>,
    /// Lobes in the plane of incidence.
    pub lobes: Vec<Lobe>,
    /// The lobe in space, see [`meridians`].
    pub meridians: Vec<Vec<[f64; 3]>>,
    /// Albedo against angle.
    pub albedo: Vec<Curve>,
    /// Fresnel reflectance against angle, of each interface; empty without one.
    pub fresnel: Vec<FresnelCurves>,
    /// Samples against their density; empty for Dirac lobes.
    pub histograms: Vec<Histogram>,
    /// A lit ball, in linear sRGB.
    pub ball: Image,
}

/// Measures everything there is to see of a subject, with `n_samples` per pixel for the ball.
#[must_use]
pub fn explore(subject: &Subject, n_samples: u32) -> Exploration {
    let kind = &subject.kind;
    let measures = Measures::of(kind);
    let mut remarks = Vec::new();
    if subject.is_dispersive {
        remarks.push(format!("The material disperses light: all curves are those at {} nm.", LAMBDA_NM[0]));
    }
    if kind.is_stochastic() {
        remarks
            .push("f is an estimate: curves show its mean, and pdf is a likeness of the density.".to_owned());
    }
    Exploration {
        name: subject.name.clone(),
        model: subject.model.clone(),
        parameters: subject.parameters.clone(),
        remarks,
        laws: law_lines(kind, &measures),
        measures,
        lobes: lobes(kind),
        meridians: meridians(kind),
        albedo: albedo_curves(kind),
        fresnel: fresnel_curves(kind),
        histograms: histograms(kind),
        ball: ball(subject, n_samples),
    }
}

/// The ball of the material by path tracing, in linear sRGB.
fn ball(subject: &Subject, n_samples: u32) -> Image {
    let studio = &subject.studio;
    let none = PathExpressions::new(&[]).expect("no expression is in error");
    let mut integrator = method(&studio.integrator, none).0.expect("the studio names a method that exists");
    let mut film = Film::new(studio.film.clone(), Vec::new());
    let stop = Stop { passes: 0..u64::from(n_samples.min(studio.sampler.samples_per_pixel)), error: None };
    render(studio, integrator.as_mut(), &mut film, &stop, &Unobserved);
    film.develop()
}
