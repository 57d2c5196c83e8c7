//! The scenes of the studies, as the repository's `scenes` folder has them.

use std::path::Path;

use etendue_io::{load_assets, read_pbrt_str};
use etendue_scene::document::{Document, EmbeddedFile, Entity, Parameter, Value};
use etendue_scene::{Assets, Scene};

use crate::generate::Generator;

/// A scene to experiment with.
#[derive(Clone, Debug)]
pub struct StudyScene {
    /// Name for tables and figures.
    pub name: String,
    document: Document,
    assets: Assets,
}

impl StudyScene {
    /// A scene of a document; files that it names are read here, once.
    #[must_use]
    pub fn new(name: impl Into<String>, document: Document) -> Self {
        let assets = load_assets(&document).0;
        Self { name: name.into(), document, assets }
    }

    /// A floor in the penumbra of a square card below a square lamp: direct light alone.
    #[must_use]
    pub fn soft_shadow() -> Self {
        Self::of_text("soft shadow", include_str!("../../../scenes/soft-shadow.pbrt"))
    }

    /// The standard box: a room with a mirror ball, a glass ball and a lamp in the ceiling (SPEC SCENE-2).
    #[must_use]
    pub fn standard_box() -> Self {
        Self::of_text("box", include_str!("../../../scenes/box.pbrt"))
    }

    /// The classic Cornell box of 32 triangles, by which renderers compare their speed.
    #[must_use]
    pub fn cornell_box() -> Self {
        Self::of_text("Cornell box", include_str!("../../../scenes/cornell.pbrt"))
    }

    /// A scene of the notebook with these parameters, its files in memory.
    ///
    /// # Panics
    /// If there is no such scene or a parameter is in error.
    #[must_use]
    pub fn generated(name: &str, parameters: &[(&str, &str)]) -> Self {
        let files =
            Generator::find(name).and_then(|generator| generator.generate(parameters.iter().copied()));
        let mut files = files.unwrap_or_else(|error| panic!("{error}")).0.into_iter();
        let text =
            files.next().map(|main| String::from_utf8_lossy(&main.bytes).into_owned()).unwrap_or_default();
        let mut document = Self::document(name, &text);
        document.embedded.extend(files.map(|file| (file.name, EmbeddedFile::Bytes(file.bytes.into()))));
        Self::new(name, document)
    }

    /// A scene of this crate.
    pub(crate) fn of_text(name: &str, text: &str) -> Self {
        Self::new(name, Self::document(name, text))
    }

    fn document(name: &str, text: &str) -> Document {
        let (document, diagnostics) = read_pbrt_str(name, text, Path::new(""));
        assert!(!diagnostics.has_errors(), "the scene \"{name}\" is part of this crate and reads");
        document
    }

    /// What the scene says of its method.
    pub(crate) fn integrator(self) -> Entity {
        self.document.integrator.unwrap_or_else(|| Entity::new("path"))
    }

    /// The same scene in another resolution, in pixels across and down.
    #[must_use]
    pub fn with_resolution(mut self, resolution: [u32; 2]) -> Self {
        let film = self.document.film.get_or_insert_with(|| Entity::new("rgb"));
        film.parameters.retain(|p| !["xresolution", "yresolution"].contains(&p.name.as_str()));
        for (name, pixels) in ["xresolution", "yresolution"].into_iter().zip(resolution) {
            film.parameters.push(Parameter::new(name, Value::Integers(vec![pixels as i32])));
        }
        self
    }

    /// Builds the scene.
    ///
    /// # Panics
    /// If the document is in error.
    #[must_use]
    pub fn build(&self) -> Scene {
        let (scene, diagnostics) = Scene::build(&self.document, self.assets.clone());
        match scene {
            Some(scene) => scene,
            None => panic!("the scene \"{}\" builds: {:?}", self.name, diagnostics.list()),
        }
    }
}
