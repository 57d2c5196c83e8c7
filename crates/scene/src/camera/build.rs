//! Cameras from parameters, with pbrt-v4's names and defaults.

mod lens;
mod realistic;

use etendue_math::{AnimatedTransform, Bounds2};

use crate::parameters::{ParameterSpec, Parameters, spec};

use super::{
    Camera, Fisheye, FisheyeMapping, Orthographic, Projection, Screen, ScreenWindow, Shutter, Spherical,
    SphericalMapping,
};

use lens::{
    BLADE_ROTATION, BLADES, FOCAL_DISTANCE, FOCAL_LENGTH, FOV, FSTOP, LENS_RADIUS, SENSOR_WIDTH, read_lens,
    read_perspective,
};
use realistic::{
    APERTURE, APERTURE_DIAMETER, FOCUS_DISTANCE, LENS_FILE, NORMALIZE, STOP_NUMBER, read_realistic,
};

const SHUTTER_OPEN: ParameterSpec = spec("shutteropen", "float", "0", "s", "when the film's exposure begins");
const SHUTTER_CLOSE: ParameterSpec = spec("shutterclose", "float", "1", "s", "when the film's exposure ends");
const ASPECT: ParameterSpec =
    spec("frameaspectratio", "float", "film's", "", "width over height of the screen window");
const WINDOW: ParameterSpec = spec(
    "screenwindow",
    "float[4]",
    "shorter side [-1, 1]",
    "",
    "x0 x1 y0 y1 of the image plane that the film covers",
);
const SPHERICAL_MAPPING: ParameterSpec =
    spec("mapping", "string", "equalarea", "", "equalarea or equirectangular");
const FISHEYE_MAPPING: ParameterSpec = spec(
    "mapping",
    "string",
    "equidistant",
    "",
    "equidistant, equisolid, stereographic or orthographic: how distances in the image grow with angles",
);
const FISHEYE_FOV: ParameterSpec = spec(
    "fov",
    "float",
    "180",
    "deg",
    "full angle of view across the circle of radius 1 of the window; black beyond",
);

/// Cameras with their parameters.
pub static CAMERAS: &[(&str, &[ParameterSpec])] = &[
    (
        "perspective",
        &[
            FOV,
            FOCAL_LENGTH,
            SENSOR_WIDTH,
            FSTOP,
            LENS_RADIUS,
            FOCAL_DISTANCE,
            BLADES,
            BLADE_ROTATION,
            ASPECT,
            WINDOW,
            SHUTTER_OPEN,
            SHUTTER_CLOSE,
        ],
    ),
    (
        "orthographic",
        &[LENS_RADIUS, FOCAL_DISTANCE, BLADES, BLADE_ROTATION, ASPECT, WINDOW, SHUTTER_OPEN, SHUTTER_CLOSE],
    ),
    ("spherical", &[SPHERICAL_MAPPING, SHUTTER_OPEN, SHUTTER_CLOSE]),
    (
        "realistic",
        &[
            LENS_FILE,
            APERTURE_DIAMETER,
            STOP_NUMBER,
            FOCUS_DISTANCE,
            APERTURE,
            BLADES,
            BLADE_ROTATION,
            NORMALIZE,
            SHUTTER_OPEN,
            SHUTTER_CLOSE,
        ],
    ),
    ("fisheye", &[FISHEYE_MAPPING, FISHEYE_FOV, ASPECT, WINDOW, SHUTTER_OPEN, SHUTTER_CLOSE]),
];

impl Camera {
    /// Reads a camera for a film of `resolution` pixels and a diagonal in metres, of which `lit` (pixels) lets light into the image;
    /// problems are reported.
    pub fn from_parameters(
        parameters: &mut Parameters<'_, '_>,
        world_from_camera: AnimatedTransform,
        resolution: [u32; 2],
        diagonal_m: f32,
        lit: Bounds2,
    ) -> Self {
        let shutter = read_shutter(parameters);
        let size = [resolution[0] as f32, resolution[1] as f32];
        let name = parameters.entity().type_name.as_str();
        let projection = match name {
            "orthographic" => {
                let screen = read_screen(parameters, size);
                Projection::Orthographic(Orthographic { screen, lens: read_lens(parameters) })
            }
            "spherical" => Projection::Spherical(read_spherical(parameters, size)),
            "realistic" => match read_realistic(parameters, size, diagonal_m) {
                Some(camera) => Projection::Realistic(Box::new(camera)),
                // Stands in after errors.
                None => Projection::Spherical(Spherical {
                    resolution: size,
                    mapping: SphericalMapping::EqualArea,
                }),
            },
            "fisheye" => Projection::Fisheye(read_fisheye(parameters, size)),
            _ => {
                if name != "perspective" {
                    let span = parameters.span();
                    let known = CAMERAS.iter().map(|(name, _)| *name);
                    parameters.diagnostics().unknown_name(span, "camera", name, known);
                    parameters.accept_all();
                }
                let screen = read_screen(parameters, size);
                Projection::Perspective(read_perspective(parameters, screen))
            }
        };
        Self::new(projection, world_from_camera, shutter, resolution, lit)
    }
}

fn read_spherical(parameters: &mut Parameters<'_, '_>, resolution: [f32; 2]) -> Spherical {
    let choices =
        [("equalarea", SphericalMapping::EqualArea), ("equirectangular", SphericalMapping::Equirectangular)];
    let mapping = parameters.choice("mapping", "equalarea", &choices);
    for unused in ["lensradius", "focaldistance", "frameaspectratio", "screenwindow"] {
        parameters.ignore(unused);
    }
    Spherical { resolution, mapping }
}

fn read_fisheye(parameters: &mut Parameters<'_, '_>, resolution: [f32; 2]) -> Fisheye {
    let screen = read_screen(parameters, resolution);
    let choices = [
        ("equidistant", FisheyeMapping::Equidistant),
        ("equisolid", FisheyeMapping::Equisolid),
        ("stereographic", FisheyeMapping::Stereographic),
        ("orthographic", FisheyeMapping::Orthographic),
    ];
    let mapping = parameters.choice("mapping", "equidistant", &choices);
    let mut fov = parameters.float("fov", 180.0);
    let (widest, is_included) = mapping.widest_fov_deg();
    if !(fov > 0.0 && (fov < widest || is_included && fov == widest)) {
        let span = parameters.span_of("fov");
        let limit = if is_included { "at most" } else { "below" };
        let message =
            format!("\"fov\" of this mapping must be above 0 and {limit} {widest} degrees, not {fov}");
        parameters.diagnostics().error(span, message);
        fov = 180.0;
    }
    Fisheye { screen, mapping, half_fov_rad: fov.to_radians() / 2.0 }
}

fn read_shutter(parameters: &mut Parameters<'_, '_>) -> Shutter {
    let (open, close) = (parameters.float("shutteropen", 0.0), parameters.float("shutterclose", 1.0));
    if close >= open && open.is_finite() && close.is_finite() {
        return Shutter { open, close };
    }
    let span = parameters.span_of("shutterclose");
    if !(open.is_finite() && close.is_finite()) {
        parameters.diagnostics().error(span, "the times of the shutter must be finite");
        return Shutter::default();
    }
    parameters.diagnostics().warning(span, "the shutter closes before it opens; the times are exchanged");
    Shutter { open: close, close: open }
}

fn read_screen(parameters: &mut Parameters<'_, '_>, resolution: [f32; 2]) -> Screen {
    let mut aspect = parameters.float("frameaspectratio", resolution[0] / resolution[1]);
    if !(aspect > 0.0 && aspect.is_finite()) {
        let span = parameters.span_of("frameaspectratio");
        parameters.diagnostics().error(span, "\"frameaspectratio\" must be positive");
        aspect = resolution[0] / resolution[1];
    }
    let window = ScreenWindow::from_aspect(aspect);
    let Some(values) = parameters.floats("screenwindow") else {
        return Screen { window, resolution };
    };
    if let [x0, x1, y0, y1] = *values {
        let window = ScreenWindow { x: [x0, x1], y: [y0, y1] };
        if window.area() > 0.0 && window.area().is_finite() {
            return Screen { window, resolution };
        }
    }
    let span = parameters.span_of("screenwindow");
    parameters.diagnostics().error(span, "\"screenwindow\" needs four values x0 x1 y0 y1 that span an area");
    Screen { window, resolution }
}
