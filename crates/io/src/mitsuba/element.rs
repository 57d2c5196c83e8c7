//! The elements of a scene file after includes, parameters and the spelling of older versions have been resolved.

use std::cell::Cell;

use etendue_scene::Span;

/// A value of an attribute with its place.
#[derive(Clone, Debug)]
pub(super) struct Attribute {
    /// In lower case.
    pub(super) name: String,
    pub(super) value: String,
    pub(super) span: Span,
}

/// An element: a plugin (`<bsdf type="diffuse">`) or a property (`<float name="radius" value="1"/>`).
#[derive(Debug)]
pub(super) struct Element {
    /// In lower case, in the words of version 3.
    pub(super) tag: String,
    /// The name of a property in the spelling of version 3 (`to_world` for `toWorld`), else empty.
    pub(super) name: String,
    /// Where the tag stands.
    pub(super) span: Span,
    pub(super) attributes: Vec<Attribute>,
    pub(super) children: Vec<Element>,
    /// Number of the element within the scene.
    pub(super) number: usize,
    /// True once something has read it.
    pub(super) used: Cell<bool>,
}

impl Element {
    /// The attribute of that name.
    pub(super) fn attribute(&self, name: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|attribute| attribute.name == name)
    }

    /// The text of an attribute, empty if there is none.
    pub(super) fn text(&self, name: &str) -> &str {
        self.attribute(name).map_or("", |attribute| &attribute.value)
    }

    /// Number of elements: itself and all within.
    pub(super) fn n_elements(&self) -> usize {
        1 + self.children.iter().map(Self::n_elements).sum::<usize>()
    }

    /// The type of a plugin.
    pub(super) fn plugin(&self) -> &str {
        self.text("type")
    }

    /// Place of the type of a plugin, or of its tag.
    pub(super) fn plugin_span(&self) -> Span {
        self.attribute("type").map_or(self.span, |attribute| attribute.span)
    }

    /// True for an element that makes a thing rather than gives a value.
    pub(super) fn is_plugin(&self) -> bool {
        self.attribute("type").is_some() || self.tag == "ref"
    }
}

/// `toWorld`, `intIOR` and `sigmaA` of version 0.6 as `to_world`, `int_ior` and `sigma_a`.
pub(super) fn snake_case(name: &str) -> String {
    let letters: Vec<char> = name.chars().collect();
    let mut out = String::with_capacity(name.len() + 4);
    for (i, c) in letters.iter().enumerate() {
        let starts_word =
            c.is_uppercase() && i > 0 && !letters[i - 1].is_uppercase() && letters[i - 1] != '_';
        if starts_word {
            out.push('_');
        }
        out.extend(c.to_lowercase());
    }
    out
}

/// The tag of version 3 for one of any version.
pub(super) fn modern_tag(tag: &str) -> String {
    let tag = tag.to_lowercase();
    match tag.as_str() {
        "camera" => "sensor".to_owned(),
        "luminaire" => "emitter".to_owned(),
        "color" => "rgb".to_owned(),
        _ => tag,
    }
}
