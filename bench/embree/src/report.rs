//! Figures as tables and as JSON.

use etendue_lab::speed::{Model, RayKind, RaySet};
use serde_json::{Value, json};

use crate::contestant::Kind;
use crate::measure::{Build, Traced, median, n_different, ratio};

/// Prints a table of builds; ratios are times of Étendue over those of Embree.
pub(crate) fn print_builds(model: &Model, kinds: &[Kind], builds: &[Build]) {
    let n = model.n_triangles();
    println!("\n{}: {n} triangles, {} copies", model.name, model.copies.len());
    for (kind, build) in kinds.iter().zip(builds) {
        let seconds = median(&build.seconds);
        let bytes = build.n_bytes as f64 / n as f64;
        print!("  build {:<14} {seconds:8.4} s CPU, {bytes:6.1} bytes per triangle", kind.name());
        for (other, ratio) in ratios(kinds, builds, *kind, |build| &build.seconds) {
            print!(", {ratio:.2} of {}", other.name());
        }
        println!();
    }
}

/// Prints the lines of a set of rays; ratios are rates of Étendue over those of Embree.
pub(crate) fn print_rays(set: &RaySet, kinds: &[Kind], traced: &[Traced]) {
    for (kind, own) in kinds.iter().zip(traced) {
        print!("  {:<8} {:<14} {:7.3} Mrays/s", set.kind.name(), kind.name(), median(&own.rates) / 1e6);
        for (other, ratio) in ratios(kinds, traced, *kind, |traced| &traced.rates) {
            print!(", {ratio:.2} of {}", other.name());
        }
        if let Some(robust) = kinds.iter().position(|kind| *kind == Kind::Robust) {
            let n = n_different(&set.rays, &own.t, &traced[robust].t);
            print!(", {n} of {} rays differ from {}", own.t.len(), Kind::Robust.name());
        }
        println!();
    }
}

/// Ratios of a contestant that is not Embree to those that are.
fn ratios<'a, T>(
    kinds: &'a [Kind],
    all: &'a [T],
    own: Kind,
    values: impl Fn(&T) -> &Vec<f64> + 'a,
) -> Vec<(Kind, f64)> {
    if matches!(own, Kind::Embree | Kind::Robust) {
        return Vec::new();
    }
    let find = |kind: Kind| kinds.iter().position(|k| *k == kind).map(|index| &all[index]);
    let Some(mine) = find(own) else { return Vec::new() };
    let others = [Kind::Robust, Kind::Embree].into_iter();
    others.filter_map(|kind| Some((kind, ratio(values(mine), values(find(kind)?))))).collect()
}

/// All figures of a model.
pub(crate) fn figures(
    model: &Model,
    kinds: &[Kind],
    builds: &[Build],
    rays: &[(RayKind, Vec<Traced>)],
) -> Value {
    let n = model.n_triangles();
    let build = |(kind, build): (&Kind, &Build)| {
        let bytes = build.n_bytes as f64 / n as f64;
        json!({"contestant": kind.name(), "cpu_s": median(&build.seconds), "bytes_per_triangle": bytes})
    };
    let trace = |set: RayKind, kind: &Kind, traced: &Traced| {
        json!({
            "rays": set.name(),
            "contestant": kind.name(),
            "n": traced.t.len(),
            "rays_per_s": median(&traced.rates),
        })
    };
    let rays = rays
        .iter()
        .flat_map(|(set, traced)| kinds.iter().zip(traced).map(|(kind, traced)| trace(*set, kind, traced)));
    json!({
        "model": model.name,
        "triangles": n,
        "copies": model.copies.len(),
        "builds": kinds.iter().zip(builds).map(build).collect::<Vec<_>>(),
        "rays": rays.collect::<Vec<_>>(),
    })
}
