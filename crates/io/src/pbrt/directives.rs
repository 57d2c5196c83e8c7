//! The directives of pbrt-v4 and where each may stand.

/// Part of a scene file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Before or after `WorldBegin`.
    Anywhere,
    /// Before `WorldBegin` only.
    Options,
    /// After `WorldBegin` only.
    World,
}

/// All directives, alphabetically.
pub(super) const DIRECTIVES: [(&str, Place); 45] = [
    ("Accelerator", Place::Options),
    ("ActiveTransform", Place::Anywhere),
    ("AreaLightSource", Place::World),
    ("Attribute", Place::Anywhere),
    ("AttributeBegin", Place::World),
    ("AttributeEnd", Place::World),
    ("Camera", Place::Options),
    ("ColorSpace", Place::Anywhere),
    ("ConcatTransform", Place::Anywhere),
    ("CoordSysTransform", Place::Anywhere),
    ("CoordinateSystem", Place::Anywhere),
    ("Film", Place::Options),
    ("Identity", Place::Anywhere),
    ("Import", Place::World),
    ("Include", Place::Anywhere),
    ("Integrator", Place::Options),
    ("LightSource", Place::World),
    ("LookAt", Place::Anywhere),
    ("MakeNamedMaterial", Place::World),
    ("MakeNamedMedium", Place::Anywhere),
    ("Material", Place::World),
    ("MediumInterface", Place::Anywhere),
    ("NamedMaterial", Place::World),
    ("ObjectBegin", Place::World),
    ("ObjectEnd", Place::World),
    ("ObjectInstance", Place::World),
    ("Option", Place::Anywhere),
    ("PixelFilter", Place::Options),
    ("ReverseOrientation", Place::World),
    ("Rotate", Place::Anywhere),
    ("Sampler", Place::Options),
    ("Scale", Place::Anywhere),
    ("Shape", Place::World),
    ("Texture", Place::World),
    ("Transform", Place::Anywhere),
    ("TransformBegin", Place::World),
    ("TransformEnd", Place::World),
    ("TransformTimes", Place::Options),
    ("Translate", Place::Anywhere),
    ("WorldBegin", Place::Options),
    // Directives of earlier versions, which pbrt-v4 does not know; see `help_for_old`.
    ("WorldEnd", Place::Anywhere),
    ("SurfaceIntegrator", Place::Anywhere),
    ("VolumeIntegrator", Place::Anywhere),
    ("Renderer", Place::Anywhere),
    ("Volume", Place::Anywhere),
];

/// Where the directive may stand; `None` if there is no directive of that name.
pub(super) fn place_of(name: &str) -> Option<Place> {
    DIRECTIVES.iter().find(|(known, _)| *known == name).map(|(_, place)| *place)
}

/// What to write instead of a directive that only earlier versions had.
pub(super) fn help_for_old(name: &str) -> Option<&'static str> {
    Some(match name {
        "WorldEnd" => "pbrt-v4 ends the world with the file: remove `WorldEnd`",
        "SurfaceIntegrator" | "VolumeIntegrator" | "Renderer" => {
            "pbrt-v4 has one directive for this: `Integrator`"
        }
        "Volume" => "pbrt-v4 describes media by `MakeNamedMedium` and `MediumInterface`",
        _ => return None,
    })
}

/// Names to suggest for a misspelt directive.
pub(super) fn current_names() -> impl Iterator<Item = &'static str> {
    DIRECTIVES.iter().map(|(name, _)| *name).filter(|name| help_for_old(name).is_none())
}
