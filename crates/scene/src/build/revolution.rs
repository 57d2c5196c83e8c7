//! Surfaces of revolution: from parameters or a loaded file of contours to a mesh.

use etendue_geometry::{Revolution, Shape};
use etendue_math::Point2;

use crate::assets::Contours;
use crate::diagnostics::nearest_name;
use crate::parameters::{ParameterSpec, Parameters, spec};

use super::shapes::{ALPHA, PHI_MAX};

/// Parameters of `revolution`.
pub(super) const REVOLUTION: &[ParameterSpec] = &[
    spec("contour", "point2", "", "m", "points (height, radius), in order; z is the axis"),
    spec("filename", "string", "", "", "CSV file with lines interface,height,radius in place of \"contour\""),
    spec("profile", "string", "", "", "which interface of the file; may be left out if there is one"),
    spec("crease", "float", "80", "degrees", "the contour is smooth where it turns by less"),
    spec("tolerance", "float", "0", "m", "distance of the mesh from the surface; 0 is 1e-4 of its extent"),
    PHI_MAX,
    ALPHA,
];

pub(super) fn read_revolution(p: &mut Parameters<'_, '_>) -> Option<Shape> {
    let crease = p.float("crease", 80.0);
    let tolerance = p.float("tolerance", 0.0);
    let phi_max_rad = super::shapes::phi_max(p);
    let contour = read_contour(p)?;
    if !(0.0..=180.0).contains(&crease) {
        let span = p.span_of("crease");
        p.diagnostics().error(span, format!("\"crease\" must lie between 0 and 180 degrees, not {crease}"));
        return None;
    }
    if !(tolerance >= 0.0 && tolerance.is_finite()) {
        let span = p.span_of("tolerance");
        p.diagnostics().error(span, format!("\"tolerance\" must not be negative, but is {tolerance}"));
        return None;
    }
    let revolution = Revolution { crease_rad: crease.to_radians(), tolerance, phi_max_rad };
    match revolution.mesh(&contour) {
        Ok(mesh) => Some(Shape::Triangles(mesh)),
        Err(error) => {
            let name = if p.has("contour") { "contour" } else { "filename" };
            let span = p.span_of(name);
            p.diagnostics().error(span, error.to_string());
            None
        }
    }
}

fn read_contour(p: &mut Parameters<'_, '_>) -> Option<Vec<Point2>> {
    if p.has("contour") {
        for name in ["filename", "profile"] {
            if p.has(name) {
                let span = p.span_of(name);
                p.diagnostics().warning(span, format!("\"{name}\" is ignored, since there is a \"contour\""));
            }
        }
        return p.points2("contour").map(<[Point2]>::to_vec);
    }
    let Some(file) = p.string_opt("filename").filter(|name| !name.is_empty()) else {
        p.missing("contour", "a \"revolution\" needs a \"contour\", or a \"filename\" with one");
        return None;
    };
    let profile = p.string_opt("profile");
    let assets = p.context.assets;
    let Some(contours) = assets.contours.get(&file) else {
        if !assets.failed.contains(&file) {
            let span = p.span_of("filename");
            p.diagnostics().error(span, format!("the contours \"{file}\" were not loaded"));
        }
        return None;
    };
    choose(p, contours, profile.as_deref())
}

/// The contour of that name, or the only one.
fn choose(p: &mut Parameters<'_, '_>, contours: &Contours, name: Option<&str>) -> Option<Vec<Point2>> {
    let found = match (name, contours.0.as_slice()) {
        (None, [(_, only)]) => Some(only),
        (None, _) => None,
        (Some(name), all) => all.iter().find(|(key, _)| key == name).map(|(_, contour)| contour),
    };
    if found.is_none() {
        let known: Vec<&str> = contours.0.iter().map(|(key, _)| key.as_str()).collect();
        let list = format!("the file has {}", known.join(", "));
        let message = match name {
            Some(name) => format!("there is no interface \"{name}\""),
            None => "\"profile\" must say which interface is meant".to_owned(),
        };
        let near =
            name.and_then(|name| nearest_name(name, known)).map(|near| format!("; did you mean \"{near}\"?"));
        let span = p.span_of("profile");
        p.diagnostics().error(span, message).with_help(list + &near.unwrap_or_default());
    }
    found.cloned()
}
