//! Estimators under study: a sampler and a way to find the lights, on a scene, from a seed.

use etendue_image::Image;
use etendue_math::{SamplerKind, SamplerSettings};
use etendue_scene::document::{Entity, Parameter, Value};
use etendue_scene::{Film, Scene};
use etendue_transport::lpe::PathExpressions;
use etendue_transport::{Integrator, Stop, Unobserved, method, render};

use crate::scenes::StudyScene;

/// Who deals the random numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SamplerChoice {
    /// Independent random numbers.
    Independent,
    /// One number in each of as many strata as there are samples.
    Stratified,
    /// Scrambled Halton points.
    Halton,
    /// Owen-scrambled Sobol points.
    Sobol,
}

impl SamplerChoice {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Independent, Self::Stratified, Self::Halton, Self::Sobol];

    /// Name for tables and figures.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Independent => "independent",
            Self::Stratified => "stratified",
            Self::Halton => "Halton",
            Self::Sobol => "Sobol",
        }
    }

    /// The sampler for `n` samples per pixel.
    #[must_use]
    pub const fn kind(self, n: u32) -> SamplerKind {
        match self {
            Self::Independent => SamplerKind::Independent,
            Self::Stratified => {
                let [x, y] = most_square(n);
                SamplerKind::Stratified { x, y, jitter: true }
            }
            Self::Halton => SamplerKind::Halton,
            Self::Sobol => SamplerKind::Sobol,
        }
    }

    /// True if the first samples are the same, however many follow.
    #[must_use]
    pub const fn is_extensible(self) -> bool {
        !matches!(self, Self::Stratified)
    }
}

/// The factors of `n` that are closest to each other, the larger first.
const fn most_square(n: u32) -> [u32; 2] {
    let mut y = n.isqrt();
    while !n.is_multiple_of(y) {
        y -= 1;
    }
    [n / y, y]
}

/// How the path tracer finds lights: the parameter `lights` of the scene's integrator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightChoice {
    /// As the scene says.
    #[default]
    AsInScene,
    /// By sampling them and by running into them.
    Both,
    /// By sampling them alone.
    Lights,
    /// By running into them alone.
    Scattering,
}

impl LightChoice {
    /// The value of the parameter.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::AsInScene => "as in the scene",
            Self::Both => "both",
            Self::Lights => "lights",
            Self::Scattering => "scattering",
        }
    }
}

/// An estimator of the image of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Estimator {
    /// Who deals the random numbers.
    pub sampler: SamplerChoice,
    /// How lights are found.
    pub lights: LightChoice,
}

impl Estimator {
    /// The scene's own method with this sampler.
    #[must_use]
    pub const fn of_sampler(sampler: SamplerChoice) -> Self {
        Self { sampler, lights: LightChoice::AsInScene }
    }

    /// Name for tables and figures.
    #[must_use]
    pub fn name(&self) -> String {
        let sampler = self.sampler.name();
        match self.lights {
            LightChoice::AsInScene | LightChoice::Both | LightChoice::Lights => sampler.to_owned(),
            LightChoice::Scattering => format!("{sampler} without light sampling"),
        }
    }

    /// The images of the first n samples per pixel, for each n of the ascending `counts`, of one seed.
    #[must_use]
    pub fn images(&self, scene: &StudyScene, seed: u64, counts: &[u32]) -> Vec<Image> {
        let mut scene = scene.build();
        let mut integrator = self.integrator(&scene);
        if self.sampler.is_extensible() {
            return self.run(&mut scene, integrator.as_mut(), seed, counts);
        }
        counts.iter().flat_map(|n| self.run(&mut scene, integrator.as_mut(), seed, &[*n])).collect()
    }

    /// The images of a run that is developed each time it has enough samples.
    pub(crate) fn run(
        &self,
        scene: &mut Scene,
        integrator: &mut dyn Integrator,
        seed: u64,
        counts: &[u32],
    ) -> Vec<Image> {
        let last = counts.last().copied().unwrap_or(0);
        scene.sampler =
            SamplerSettings { kind: self.sampler.kind(last.max(1)), seed, samples_per_pixel: last.max(1) };
        let mut film = Film::new(scene.film.clone(), Vec::new());
        let develop = |n: &u32| {
            // Passes that the film already holds are skipped.
            let stop = Stop { passes: 0..u64::from(*n), error: None };
            render(scene, integrator, &mut film, &stop, &Unobserved);
            film.develop()
        };
        counts.iter().map(develop).collect()
    }

    /// The scene's integrator, with the wanted way to find lights.
    ///
    /// # Panics
    /// If the scene names an integrator that does not exist.
    pub(crate) fn integrator(&self, scene: &Scene) -> Box<dyn Integrator> {
        let mut entity: Entity = scene.integrator.clone();
        if self.lights != LightChoice::AsInScene {
            entity.parameters.retain(|p| p.name != "lights");
            let word = self.lights.name().to_owned();
            entity.parameters.push(Parameter::new("lights", Value::Strings(vec![word])));
        }
        let none = PathExpressions::new(&[]).expect("no expression is in error");
        method(&entity, none).0.expect("the scene names an integrator that exists")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Strata are as square as the count allows, and all of them are used.
    #[test]
    fn strata_fill_the_count() {
        assert_eq!(most_square(1), [1, 1]);
        assert_eq!(most_square(8), [4, 2]);
        assert_eq!(most_square(256), [16, 16]);
        assert_eq!(most_square(10), [5, 2]);
        assert_eq!(most_square(7), [7, 1]);
    }
}
