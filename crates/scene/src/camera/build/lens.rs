//! What scene files say of a thin lens: in pbrt's units, or in those of photographers.

use super::super::photographic::DEFAULT_SENSOR_WIDTH_MM;
use super::super::{Blades, Lens, Perspective, Photographic, Screen};
use crate::parameters::{ParameterSpec, Parameters, spec};

pub(super) const LENS_RADIUS: ParameterSpec = spec(
    "lensradius",
    "float",
    "0",
    "m",
    "radius of the aperture, focal length / (2 fstop) of a photographic lens; 0 for a pinhole",
);
pub(super) const FOCAL_DISTANCE: ParameterSpec =
    spec("focaldistance", "float", "1e6", "m", "distance of the plane of focus along the optical axis");
pub(super) const FOV: ParameterSpec = spec(
    "fov",
    "float",
    "90",
    "deg",
    "full angle of view across the shorter side of the window [-1, 1]; or give \"focallength\"",
);
pub(super) const FOCAL_LENGTH: ParameterSpec =
    spec("focallength", "float", "", "mm", "focal length: with \"sensorwidth\", in place of \"fov\"");
pub(super) const SENSOR_WIDTH: ParameterSpec =
    spec("sensorwidth", "float", "36", "mm", "width of the film, for \"focallength\" and \"fstop\"");
pub(super) const FSTOP: ParameterSpec = spec(
    "fstop",
    "float",
    "",
    "",
    "f-number, focal length over diameter of the aperture: in place of \"lensradius\"; a pinhole without either",
);
pub(super) const BLADES: ParameterSpec =
    spec("blades", "integer", "0", "", "corners of the aperture, a regular polygon; 0 for a disc");
pub(super) const BLADE_ROTATION: ParameterSpec = spec(
    "bladerotation",
    "float",
    "0",
    "deg",
    "turns the polygon, whose first corner is to the right, counterclockwise as the camera looks",
);

/// Largest radius of an aperture in metres: beyond, squares of densities leave single precision.
const MOST_RADIUS: f32 = 1e6;

/// Most corners of an aperture: more look like a disc.
const MOST_BLADES: u32 = 100;

/// Reads what makes a perspective camera of a film.
pub(super) fn read_perspective(p: &mut Parameters<'_, '_>, screen: Screen) -> Perspective {
    let focal_distance = read_focal_distance(p);
    let sensor_width_m = positive(p, "sensorwidth").unwrap_or(DEFAULT_SENSOR_WIDTH_MM) / 1000.0;
    let focal_length = positive(p, "focallength");
    let fov = read_fov(p);
    let half_width = (screen.window.x[1] - screen.window.x[0]).abs() / 2.0;
    let mut lens = Photographic::from_view(tan_half(fov) * half_width, sensor_width_m, focal_distance);
    let mut tan_half_fov = tan_half(fov);
    if let Some(focal_length_mm) = focal_length {
        if p.has("fov") {
            let span = p.span_of("focallength");
            let message = "\"fov\" and \"focallength\" both say how wide the view is";
            p.diagnostics().error(span, message).with_help("remove one of them");
        }
        let given = Photographic { focal_length_m: focal_length_mm / 1000.0, ..lens };
        let view = given.tan_half_width();
        if given.focal_length_m < focal_distance && !(1e-6..1e6).contains(&view) {
            let span = p.span_of("focallength");
            let degrees = 2.0 * view.atan().to_degrees();
            let message = format!("a focal length of {focal_length_mm} mm makes a view of {degrees} degrees");
            p.diagnostics().error(span, message);
        } else if given.focal_length_m < focal_distance {
            lens = given;
            tan_half_fov = lens.tan_half_width() / half_width;
        } else {
            let span = p.span_of("focaldistance");
            let message = format!(
                "\"focaldistance\" ({focal_distance} m) must be above the focal length ({} m), or nothing can be sharp",
                given.focal_length_m
            );
            p.diagnostics().error(span, message);
        }
    }
    let radius = read_radius(p, &lens);
    if focal_length.is_none() && !p.has("fstop") && p.has("sensorwidth") {
        let span = p.span_of("sensorwidth");
        let message = "\"sensorwidth\" changes nothing without \"focallength\" or \"fstop\"";
        p.diagnostics().warning(span, message);
    }
    Perspective { screen, tan_half_fov, lens: Lens { radius, blades: read_blades(p), focal_distance } }
}

/// Reads a lens of given radius.
pub(super) fn read_lens(p: &mut Parameters<'_, '_>) -> Lens {
    let radius = read_lens_radius(p);
    Lens { radius, blades: read_blades(p), focal_distance: read_focal_distance(p) }
}

fn tan_half(angle_deg: f32) -> f32 {
    (f64::from(angle_deg).to_radians() / 2.0).tan() as f32
}

fn read_fov(p: &mut Parameters<'_, '_>) -> f32 {
    let fov = p.float("fov", 90.0);
    if fov > 0.0 && fov < 180.0 && tan_half(fov) > 0.0 {
        return fov;
    }
    let span = p.span_of("fov");
    p.diagnostics().error(span, format!("\"fov\" must be between 0 and 180 degrees, not {fov}"));
    90.0
}

/// Radius of the aperture in metres, by itself or by the f-number.
fn read_radius(p: &mut Parameters<'_, '_>, lens: &Photographic) -> f32 {
    let radius = read_lens_radius(p);
    let Some(f_number) = positive(p, "fstop") else { return radius };
    if p.has("lensradius") {
        let span = p.span_of("fstop");
        let message = "\"lensradius\" and \"fstop\" both say how wide the aperture is";
        p.diagnostics().error(span, message).with_help("remove one of them");
    }
    let by_number = lens.lens(f_number).radius;
    if by_number <= MOST_RADIUS {
        return by_number;
    }
    let span = p.span_of("fstop");
    p.diagnostics().error(span, format!("\"fstop\" {f_number} makes an aperture of {by_number} m"));
    radius
}

fn read_lens_radius(p: &mut Parameters<'_, '_>) -> f32 {
    let radius = p.float("lensradius", 0.0);
    if (0.0..=MOST_RADIUS).contains(&radius) {
        return radius;
    }
    let span = p.span_of("lensradius");
    let message = format!("\"lensradius\" must be between 0 and {MOST_RADIUS} m, but is {radius}");
    p.diagnostics().error(span, message);
    0.0
}

fn read_focal_distance(p: &mut Parameters<'_, '_>) -> f32 {
    positive(p, "focaldistance").unwrap_or(1e6)
}

/// A positive, finite number; others are reported.
pub(super) fn positive(p: &mut Parameters<'_, '_>, name: &'static str) -> Option<f32> {
    let value = p.float_opt(name)?;
    if value > 0.0 && value.is_finite() {
        return Some(value);
    }
    let span = p.span_of(name);
    p.diagnostics().error(span, format!("\"{name}\" must be positive, not {value}"));
    None
}

/// The blades of the aperture; `None` for a disc.
pub(super) fn read_blades(p: &mut Parameters<'_, '_>) -> Option<Blades> {
    let n = p.count_within("blades", 0, 0, MOST_BLADES);
    let rotation_rad = p.float("bladerotation", 0.0).to_radians();
    if n == 1 || n == 2 {
        let span = p.span_of("blades");
        let message = format!("\"blades\" must be 0 for a disc or at least 3, not {n}");
        p.diagnostics().error(span, message);
    }
    (n >= 3 && rotation_rad.is_finite()).then_some(Blades { n, rotation_rad })
}
