//! `etendue list`: what scene files may name, from the tables of the code.

use std::io::Write;

use etendue::lab::generate::GENERATORS;
use etendue::scene::build::{ACCELERATORS, FILMS, SAMPLERS, SHAPES};
use etendue::scene::camera::CAMERAS;
use etendue::scene::controls::{LIGHT_CONTROLS, SHAPE_CONTROLS};
use etendue::scene::filter::FILTERS;
use etendue::scene::light::LightKind;
use etendue::scene::material::MATERIALS;
use etendue::scene::parameters::ParameterSpec;
use etendue::scene::texture::{FLOAT_TEXTURES, SPECTRUM_TEXTURES};
use etendue::spectrum::named_spectrum_names;
use etendue::transport::INTEGRATORS;
use serde_json::{Value, json};

use etendue::image::tonemap::{OPERATORS, OperatorSpec};

use crate::args::{ListArguments, ListKind};
use crate::failure::Result;

/// A line on standard output. A reader that went away, such as `head`, is no failure.
pub(crate) fn print(line: &str) {
    let _ = writeln!(std::io::stdout(), "{line}");
}

/// One thing that a scene file may name.
struct Item {
    name: String,
    doc: String,
    parameters: Vec<ParameterSpec>,
}

impl Item {
    fn new(name: &str, doc: &str, parameters: &[ParameterSpec]) -> Self {
        Self { name: name.to_owned(), doc: doc.to_owned(), parameters: parameters.to_vec() }
    }
}

/// Runs the command.
pub(crate) fn run(arguments: &ListArguments) -> Result<()> {
    let items = items(arguments.kind);
    if arguments.json {
        let list: Vec<Value> = items.iter().map(to_json).collect();
        print(&json!({ "items": list }).to_string());
        return Ok(());
    }
    if items.is_empty() {
        print("none yet");
    }
    for item in &items {
        let separator = if item.doc.is_empty() { "" } else { ": " };
        print(&format!("{}{separator}{}", item.name, item.doc));
        for p in &item.parameters {
            let default = if p.default.is_empty() { String::new() } else { format!(" = {}", p.default) };
            let unit = if p.unit.is_empty() { String::new() } else { format!(" [{}]", p.unit) };
            print(&format!("    {} {}{default}{unit}: {}", p.kind, p.name, p.doc));
        }
    }
    Ok(())
}

fn to_json(item: &Item) -> Value {
    let parameters: Vec<Value> = item
        .parameters
        .iter()
        .map(|p| json!({"name": p.name, "type": p.kind, "default": p.default, "unit": p.unit, "doc": p.doc}))
        .collect();
    json!({"name": item.name, "doc": item.doc, "parameters": parameters})
}

fn tabled(table: &'static [(&'static str, &'static [ParameterSpec])]) -> Vec<Item> {
    table.iter().map(|(name, parameters)| Item::new(name, "", parameters)).collect()
}

fn operator_item(operator: &OperatorSpec) -> Item {
    let parameter = |[name, default, doc]: &[&'static str; 3]| ParameterSpec {
        name,
        kind: "float",
        default,
        unit: "",
        doc,
    };
    let parameters: Vec<ParameterSpec> = operator.parameters.iter().map(parameter).collect();
    Item::new(operator.name, operator.doc, &parameters)
}

fn items(kind: ListKind) -> Vec<Item> {
    match kind {
        ListKind::Integrators => INTEGRATORS
            .iter()
            .map(|m| {
                let bias = match (m.unbiased, m.consistent) {
                    (true, _) => "unbiased",
                    (false, true) => "biased, consistent",
                    (false, false) => "biased",
                };
                Item::new(m.name, &format!("{} ({bias})", m.doc), m.parameters)
            })
            .collect(),
        ListKind::Materials => MATERIALS.iter().map(|m| Item::new(m.name, m.doc, m.parameters)).collect(),
        ListKind::Textures => {
            let spectra_only =
                SPECTRUM_TEXTURES.iter().filter(|(n, _)| !FLOAT_TEXTURES.iter().any(|(f, _)| f == n));
            let mut items = tabled(FLOAT_TEXTURES);
            items.extend(spectra_only.map(|(name, parameters)| Item::new(name, "spectra alone", parameters)));
            items
        }
        ListKind::Lights => {
            let kinds =
                LightKind::ALL.iter().map(|kind| Item::new(kind.name(), kind.doc(), kind.parameters()));
            kinds.chain([Item::new("every light", "", LIGHT_CONTROLS)]).collect()
        }
        ListKind::Shapes => {
            let mut items = tabled(SHAPES);
            items.push(Item::new("every shape", "", SHAPE_CONTROLS));
            items
        }
        ListKind::Media => Vec::new(),
        ListKind::Cameras => tabled(CAMERAS),
        ListKind::Films => tabled(FILMS),
        ListKind::Samplers => tabled(SAMPLERS),
        ListKind::Filters => tabled(FILTERS),
        ListKind::Accelerators => {
            ACCELERATORS.iter().map(|(name, doc, parameters)| Item::new(name, doc, parameters)).collect()
        }
        ListKind::Tonemappers => OPERATORS.iter().map(operator_item).collect(),
        ListKind::Spectra => named_spectrum_names().iter().map(|name| Item::new(name, "", &[])).collect(),
        ListKind::Scenes => GENERATORS
            .iter()
            .map(|g| {
                let parameters: Vec<ParameterSpec> = g.parameters.iter().map(|knob| knob.spec).collect();
                Item::new(g.name, &format!("{} ({})", g.doc, g.id), &parameters)
            })
            .collect(),
    }
}
