//! The scenes of the notebook (SPEC section 26.1), made by formulas: text in pbrt's format, and meshes.
//!
//! A generator is a function from its parameters to files in memory, the same bytes each time. The first file is the
//! scene to render. Each is what its figure shows; where the notebook states no dimensions they are ours, and stand in
//! the comments of the files. Lamps have a size wherever the figure allows it, so that paths from the camera find them.
//!
//! To add a scene: write `fn(&Settings) -> Files` in a file of its own and add a row to [`GENERATORS`].

mod mesh;
mod noise;
mod settings;
mod text;

mod plants;
mod sun;

mod analytic;
mod boxes;
mod bunnies;
mod car;
mod caustics;
mod cognac;
mod courtyard;
mod depth_of_field;
mod glass;
mod incident;
mod interior;
mod mountain;
mod plan;
mod rooms;
mod shapes;
mod shared;
mod small_box;

#[cfg(test)]
mod tests;

use etendue_scene::LoadedMesh;
use etendue_scene::diagnostics::nearest_name;

pub use settings::{Domain, Knob, SettingError, Settings};

/// A scene that can be generated.
#[derive(Clone, Copy, Debug)]
pub struct Generator {
    /// Its name, which is also the name of its first file.
    pub name: &'static str,
    /// Its requirement in the specification, such as `SCENE-2`.
    pub id: &'static str,
    /// One line.
    pub doc: &'static str,
    /// What can be chosen.
    pub parameters: &'static [Knob],
    generate: fn(&Settings) -> Files,
}

/// A file in memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneFile {
    /// Name without folder.
    pub name: String,
    /// Content.
    pub bytes: Vec<u8>,
}

/// The files of a scene; the first is the one to render.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Files(pub Vec<SceneFile>);

impl Files {
    /// A scene without meshes.
    fn of_text(name: &str, text: impl Into<String>) -> Self {
        Self::default().with_text(name, text)
    }

    /// Adds a scene file; the ending is added to its name.
    fn with_text(self, name: &str, text: impl Into<String>) -> Self {
        self.with_bytes(&format!("{name}.pbrt"), text.into().into_bytes())
    }

    /// Adds a mesh; the ending is added to its name.
    fn with_mesh(self, name: &str, mesh: &LoadedMesh) -> Self {
        self.with_bytes(&format!("{name}.ply"), etendue_io::write_ply(mesh))
    }

    fn with_bytes(mut self, name: &str, bytes: Vec<u8>) -> Self {
        self.0.push(SceneFile { name: name.to_owned(), bytes });
        self
    }
}

/// All generators in the order of the specification.
pub const GENERATORS: &[Generator] = &[
    small_box::GENERATOR,
    shared::BOX,
    shared::CORNELL,
    rooms::CEILING_LAMP,
    rooms::DOOR,
    rooms::HOLES,
    glass::WINEGLASS,
    interior::GLOSSY_BALL,
    interior::INTERIOR,
    car::GENERATOR,
    glass::WOOD_BALL,
    boxes::FRACTAL,
    boxes::WATER,
    bunnies::GENERATOR,
    mountain::GENERATOR,
    courtyard::GENERATOR,
    caustics::RING,
    caustics::PRISM,
    shared::CYLINDER,
    cognac::COGNAC,
    cognac::CLOSEUP,
    glass::LENS,
    cognac::PENUMBRA,
    incident::GENERATOR,
    shapes::GENERATOR,
    analytic::CORNER,
    analytic::FURNACE,
    depth_of_field::GENERATOR,
    plan::GENERATOR,
    shared::BALLS,
];

impl Generator {
    /// The generator of that name.
    ///
    /// # Errors
    /// If there is none: a sentence that says what may have been meant.
    pub fn find(name: &str) -> Result<&'static Self, SettingError> {
        GENERATORS.iter().find(|generator| generator.name == name).ok_or_else(|| {
            SettingError(match nearest_name(name, GENERATORS.iter().map(|g| g.name)) {
                Some(near) => format!("there is no scene \"{name}\"; did you mean \"{near}\"?"),
                None => format!("there is no scene \"{name}\"; `etendue list scenes` shows all"),
            })
        })
    }

    /// Makes the scene with these values of its parameters, the others at their defaults.
    ///
    /// # Errors
    /// If a parameter is unknown or has an impossible value.
    pub fn generate<'a>(
        &'static self,
        changes: impl IntoIterator<Item = (&'a str, &'a str)>,
    ) -> Result<Files, SettingError> {
        Ok((self.generate)(&Settings::new(self, changes)?))
    }
}
