//! The laws of scattering in a table: of all configurations of all models, and of one subject.

use std::fmt::Write;

use etendue_scene::bsdf::BsdfKind;
use etendue_scene::bsdf::catalogue::{Configuration, catalogue};
use etendue_scene::bsdf::laws::{Estimate, Law, Measures};
use rayon::prelude::*;

/// A configuration with its measures.
#[derive(Clone, Debug)]
pub struct LawRow {
    /// What was measured.
    pub configuration: Configuration,
    /// How well it keeps the laws.
    pub measures: Measures,
    /// The laws that it does not keep.
    pub broken: Vec<Law>,
}

/// Measures all configurations, in the order of the catalogue.
#[must_use]
pub fn law_table() -> Vec<LawRow> {
    let row = |configuration: Configuration| {
        let measures = Measures::of(&configuration.kind);
        let broken = measures.broken(&configuration.kind, configuration.is_lossless);
        LawRow { configuration, measures, broken }
    };
    catalogue().into_par_iter().map(row).collect()
}

/// The table as text, one line for each configuration.
#[must_use]
pub fn law_table_text(rows: &[LawRow]) -> String {
    let head = ["model", "configuration", "reciprocity", "albedo max", "furnace", "chi2 p", "laws broken"];
    let lines = rows.iter().map(|row| {
        let Measures { reciprocity_error, albedo_max, furnace, chi2_p, .. } = &row.measures;
        [
            row.configuration.model.to_owned(),
            row.configuration.name.to_owned(),
            format!("{:.1e}", reciprocity_error.value),
            format!("{:.4}", albedo_max.value),
            format!("{:.4}", furnace.value),
            format!("{chi2_p:.3}"),
            law_names(&row.broken),
        ]
    });
    let lines: Vec<[String; 7]> = std::iter::once(head.map(str::to_owned)).chain(lines).collect();
    let widths: [usize; 7] =
        std::array::from_fn(|i| lines.iter().map(|line| line[i].chars().count()).max().unwrap_or(0));
    let mut text = String::new();
    for line in &lines {
        let cells: Vec<String> = line.iter().zip(widths).map(|(cell, w)| format!("{cell:<w$}")).collect();
        let _ = writeln!(text, "{}", cells.join("  ").trim_end());
    }
    text
}

/// Names of laws, separated by commas; `none` for none.
#[must_use]
pub fn law_names(laws: &[Law]) -> String {
    let names: Vec<&str> = laws.iter().map(|law| law.name()).collect();
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

/// A law of one subject: what it says, what was measured, and whether it is kept.
#[derive(Clone, Debug, PartialEq)]
pub struct LawLine {
    /// The law.
    pub law: Law,
    /// What was measured, in words.
    pub what: &'static str,
    /// The number that was found.
    pub measured: String,
    /// True if the law is kept.
    pub is_kept: bool,
}

/// The laws of a BSDF. Whether it should be lossless is not known, so that the furnace is shown without judgement.
#[must_use]
pub fn law_lines(kind: &BsdfKind, measures: &Measures) -> Vec<LawLine> {
    let broken = measures.broken(kind, false);
    let line = |law, what, measured| LawLine { law, what, measured, is_kept: !broken.contains(&law) };
    let is_stochastic = kind.is_stochastic();
    let reciprocity = if is_stochastic {
        "relative difference of the mean of f and of its reverse"
    } else {
        "greatest relative difference of f and its reverse"
    };
    let density = if is_stochastic {
        "p-value: samples carry what f integrates to"
    } else {
        "p-value: samples have the density that pdf states"
    };
    vec![
        line(Law::Reciprocity, reciprocity, estimate_text(measures.reciprocity_error, 6)),
        line(
            Law::Energy,
            "greatest albedo, over directions and both modes",
            estimate_text(measures.albedo_max, 4),
        ),
        line(
            Law::Furnace,
            "least albedo over directions: 1 if nothing is lost",
            estimate_text(measures.furnace, 4),
        ),
        line(Law::Density, density, format!("{:.4}", measures.chi2_p)),
        line(
            Law::Density,
            "relative difference of pdf and the inverse Jacobian of sampling",
            if is_stochastic { "not defined".to_owned() } else { format!("{:.1e}", measures.jacobian_error) },
        ),
        line(Law::Density, "greatest integral of pdf", format!("{:.4}", measures.pdf_integral_max)),
        line(
            Law::Weight,
            "greatest relative difference of weight and f cos / pdf",
            if is_stochastic {
                "holds in the mean".to_owned()
            } else {
                format!("{:.1e}", measures.sample_errors.weight)
            },
        ),
        line(
            Law::Soundness,
            "values are numbers, none is negative",
            measures.fault.clone().unwrap_or_else(|| "always".to_owned()),
        ),
    ]
}

fn estimate_text(estimate: Estimate, digits: usize) -> String {
    let Estimate { value, standard_error } = estimate;
    if standard_error < 0.5 * 10.0_f64.powi(-(digits as i32)) {
        format!("{value:.digits$}")
    } else {
        format!("{value:.digits$} ± {standard_error:.digits$}")
    }
}
