//! What scene files say of a real lens, with pbrt-v4's names and defaults.

use std::f32::consts::{FRAC_1_SQRT_2, FRAC_PI_2, FRAC_PI_4};
use std::sync::Arc;

use etendue_image::Encoding;

use super::super::Blades;
use super::super::realistic::{LensPrescription, LensSettings, Paraxial, Realistic, StopPicture, StopShape};
use super::lens::{positive, read_blades};
use crate::parameters::{ParameterSpec, Parameters, spec};

pub(super) const LENS_FILE: ParameterSpec =
    spec("lensfile", "string", "", "", "text file of the lens, a surface per line, from front to rear");
pub(super) const APERTURE_DIAMETER: ParameterSpec =
    spec("aperturediameter", "float", "1", "mm", "diameter of the stop, at most that of the lens file");
pub(super) const STOP_NUMBER: ParameterSpec = spec(
    "fstop",
    "float",
    "",
    "",
    "f-number, focal length over diameter of the beam that enters: in place of \"aperturediameter\"",
);
pub(super) const FOCUS_DISTANCE: ParameterSpec =
    spec("focusdistance", "float", "10", "m", "distance from the film to what is sharp");
pub(super) const APERTURE: ParameterSpec = spec(
    "aperture",
    "string",
    "circular",
    "",
    "form of the stop: circular, square, pentagon, star, gaussian, or a picture of what passes",
);
pub(super) const NORMALIZE: ParameterSpec = spec(
    "normalize",
    "bool",
    "false",
    "",
    "as bright as a pinhole in the middle of the film; else pixels are the irradiance of the film",
);

/// Reads a camera with a lens of a file; `None` after errors.
pub(super) fn read_realistic(
    p: &mut Parameters<'_, '_>,
    resolution: [f32; 2],
    diagonal_m: f32,
) -> Option<Realistic> {
    let focus_distance = positive(p, "focusdistance").unwrap_or(10.0);
    let stop_shape = read_stop_shape(p);
    let is_normalized = p.bool("normalize", false);
    let diameter_mm = positive(p, "aperturediameter");
    let f_number = positive(p, "fstop");
    let lens = read_lens_file(p)?;
    let paraxial = Paraxial::new(&lens);
    if f_number.is_some() && diameter_mm.is_some() {
        let span = p.span_of("fstop");
        let message = "\"aperturediameter\" and \"fstop\" both say how wide the stop is";
        p.diagnostics().error(span, message).with_help("remove one of them");
    }
    let wanted_m =
        f_number.and_then(|n| paraxial.stop_diameter_m(n)).unwrap_or(diameter_mm.unwrap_or(1.0) / 1000.0);
    let stop_diameter_m =
        limit_stop(p, &lens, wanted_m, if f_number.is_some() { "fstop" } else { "aperturediameter" });
    let settings = LensSettings { stop_diameter_m, stop_shape, focus_distance, is_normalized };
    let camera = Realistic::new(&lens, settings, resolution, diagonal_m);
    if camera.as_ref().is_some_and(|camera| !camera.is_open()) {
        let span = p.span_of("lensfile");
        let message = "no light gets through this lens and its stop to the film, which will be black";
        p.diagnostics().warning(span, message);
    }
    if camera.is_none() {
        let span = p.span_of("focusdistance");
        let message = format!(
            "this lens, of focal length {:.4} m, cannot focus at {focus_distance} m from the film",
            paraxial.focal_length_m()
        );
        p.diagnostics()
            .error(span, message)
            .with_help("\"focusdistance\" must be at least about four focal lengths");
    }
    camera
}

fn read_lens_file(p: &mut Parameters<'_, '_>) -> Option<Arc<LensPrescription>> {
    let name = p.string("lensfile", "");
    if name.is_empty() {
        p.missing("lensfile", "the camera \"realistic\" needs a \"lensfile\"");
        return None;
    }
    let lens = p.context.assets.lenses.get(&name).cloned();
    if lens.is_none() && !p.context.assets.failed.contains(&name) {
        let span = p.span_of("lensfile");
        p.diagnostics().error(span, format!("the lens \"{name}\" was not loaded"));
    }
    lens
}

/// A stop is no wider than its lens has room for.
fn limit_stop(p: &mut Parameters<'_, '_>, lens: &LensPrescription, wanted_m: f32, name: &'static str) -> f32 {
    let span = p.span_of(name);
    let Some(stop) = lens.stop() else {
        p.diagnostics()
            .warning(span, "the lens has no stop (a surface of radius 0): its rims alone limit the light");
        return wanted_m;
    };
    if wanted_m <= stop.diameter_m * (1.0 + 1e-4) {
        return wanted_m;
    }
    let (wanted, most) = (wanted_m * 1000.0, stop.diameter_m * 1000.0);
    let message = format!(
        "the stop would be {wanted:.3} mm wide, but the lens has room for {most:.3} mm; that is taken"
    );
    p.diagnostics().warning(span, message);
    stop.diameter_m
}

fn read_stop_shape(p: &mut Parameters<'_, '_>) -> StopShape {
    let blades = read_blades(p);
    let name = p.string("aperture", "circular");
    if blades.is_some() && p.has("aperture") {
        let span = p.span_of("blades");
        let message = "\"aperture\" and \"blades\" both give the form of the stop; \"aperture\" is taken";
        p.diagnostics().warning(span, message);
    }
    let polygon = |n, rotation_rad, scale| StopShape::Polygon(Blades { n, rotation_rad }, scale);
    match name.as_str() {
        "circular" => blades.map_or(StopShape::Disc, |blades| StopShape::Polygon(blades, 1.0)),
        "square" => polygon(4, FRAC_PI_4, FRAC_1_SQRT_2),
        "pentagon" => polygon(5, FRAC_PI_2, 0.8),
        "star" => StopShape::Star,
        "gaussian" => StopShape::Gaussian,
        file => read_stop_picture(p, file).unwrap_or_default(),
    }
}

fn read_stop_picture(p: &mut Parameters<'_, '_>, file: &str) -> Option<StopShape> {
    let Some(texels) = p.context.assets.images.get(file) else {
        if !p.context.assets.failed.contains(file) {
            let span = p.span_of("aperture");
            let error = p.diagnostics().error(span, format!("there is no aperture \"{file}\""));
            error.with_help("circular, square, pentagon, star, gaussian, or a picture file");
        }
        return None;
    };
    let (width, height) = (texels.width(), texels.height());
    let gray = texels.to_gray(Encoding::Srgb);
    let open = (0..width * height).map(|i| gray.texel(i % width, i / width, 0)).collect();
    Some(StopShape::Picture(Arc::new(StopPicture::new(width, height, open)?)))
}
