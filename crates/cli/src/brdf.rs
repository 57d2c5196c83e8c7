//! `etendue brdf`: a look at how a material scatters light, and the laws that all models are held to.

use std::io::Write;
use std::path::Path;

use etendue::io::images::{write_atomically, write_image};
use etendue::lab::brdf::{LawRow, SubjectError, law_names, law_table, law_table_text};
use etendue::lab::{Exploration, Subject, explore};
use etendue::scene::bsdf::laws::Measures;
use serde_json::{Map, Value, json};

use crate::args::BrdfArguments;
use crate::failure::{Failure, Result};
use crate::list::print;
use crate::{outputs, report};

/// Extensions of what can be written.
const FORMATS: [&str; 4] = ["html", "svg", "png", "csv"];

/// Runs the command.
pub(crate) fn run(arguments: &BrdfArguments) -> Result<()> {
    if arguments.all {
        return print_laws(arguments.json);
    }
    for path in &arguments.outputs {
        if !FORMATS.contains(&outputs::extension(path).as_str()) {
            let message = format!("{}: this is written as .{}", path.display(), FORMATS.join(", ."));
            return Err(Failure::Usage(message));
        }
        outputs::check_file(path)?;
    }
    outputs::check_distinct(arguments.outputs.iter())?;
    let subject = subject(arguments)?;
    let exploration = explore(&subject, arguments.samples);
    let failures: Vec<String> =
        arguments.outputs.iter().filter_map(|path| write(path, &exploration).err()).collect();
    if !failures.is_empty() {
        return Err(Failure::Running(failures.join("\n")));
    }
    if arguments.json {
        print(&exploration_json(&exploration).to_string());
    } else if arguments.outputs.is_empty() {
        print(exploration.text().trim_end());
    }
    for path in &arguments.outputs {
        report::note(&path.display().to_string());
    }
    Ok(())
}

fn subject(arguments: &BrdfArguments) -> Result<Subject> {
    let found = match (&arguments.scene, &arguments.material, &arguments.model) {
        (Some(scene), Some(material), _) => Subject::of_scene(scene, material),
        (_, _, Some(model)) => Subject::of_model(model, &arguments.parameters),
        _ => return Err(Failure::Usage("name a material, or a scene with one".to_owned())),
    };
    match found {
        Ok((subject, diagnostics, sources)) => {
            report::diagnostics(&diagnostics, &sources, false);
            Ok(subject)
        }
        Err(SubjectError::Request(message)) => Err(Failure::Usage(message)),
        Err(SubjectError::Scene(diagnostics, sources)) => {
            report::diagnostics(&diagnostics, &sources, false);
            Err(Failure::Scene)
        }
    }
}

fn write(path: &Path, exploration: &Exploration) -> std::result::Result<(), String> {
    let text = match outputs::extension(path).as_str() {
        "png" => return write_image(path, &exploration.image()).map_err(|e| format!("cannot write {e}")),
        "svg" => exploration.svg(),
        "csv" => exploration.csv(),
        _ => exploration.html(),
    };
    write_atomically(path, |file| file.write_all(text.as_bytes()))
        .map_err(|error: std::io::Error| format!("cannot write {}: {error}", path.display()))
}

fn print_laws(is_json: bool) -> Result<()> {
    let rows = law_table();
    if is_json {
        print(&Value::Array(rows.iter().map(row_json).collect()).to_string());
    } else {
        print(law_table_text(&rows).trim_end());
    }
    for row in rows.iter().filter(|row| row.broken != row.configuration.breaks) {
        report::warning(&format!(
            "{}: breaks {}, but should break {}",
            row.configuration.name,
            law_names(&row.broken),
            law_names(row.configuration.breaks)
        ));
    }
    Ok(())
}

fn row_json(row: &LawRow) -> Value {
    let LawRow { configuration, measures, .. } = row;
    let parameters =
        configuration.parameters.iter().map(|(name, value)| ((*name).to_owned(), json!(value))).collect();
    let broken: Vec<&str> = row.broken.iter().map(|law| law.name()).collect();
    let mut object = laws_json(configuration.model, configuration.name, parameters, measures, &broken);
    object["is_lossless"] = json!(configuration.is_lossless);
    object
}

fn exploration_json(exploration: &Exploration) -> Value {
    let Exploration { model, name, measures, .. } = exploration;
    let parameters =
        exploration.parameters.iter().map(|(name, value)| (name.clone(), json!(value))).collect();
    let mut broken: Vec<&str> =
        exploration.laws.iter().filter(|line| !line.is_kept).map(|line| line.law.name()).collect();
    broken.dedup();
    laws_json(model, name, parameters, measures, &broken)
}

/// What is said of every model.
fn laws_json(
    model: &str,
    name: &str,
    parameters: Map<String, Value>,
    measures: &Measures,
    broken: &[&str],
) -> Value {
    json!({
        "model": model,
        "name": name,
        "parameters": parameters,
        "reciprocity_error": measures.reciprocity_error.value,
        "reciprocity_standard_error": measures.reciprocity_error.standard_error,
        "albedo_max": measures.albedo_max.value,
        "furnace": measures.furnace.value,
        "chi2_p": measures.chi2_p,
        "laws_broken": broken,
    })
}
