//! Cameras from parameters, with pbrt-v4's names and defaults.

use etendue_math::{AnimatedTransform, Bounds2};

use crate::parameters::{ParameterSpec, Parameters};

use super::{
    Camera, Lens, Orthographic, Perspective, Projection, Screen, ScreenWindow, Shutter, Spherical,
    SphericalMapping,
};

const SHUTTER_OPEN: ParameterSpec = ParameterSpec {
    name: "shutteropen",
    kind: "float",
    default: "0",
    unit: "s",
    doc: "when the film's exposure begins",
};
const SHUTTER_CLOSE: ParameterSpec = ParameterSpec {
    name: "shutterclose",
    kind: "float",
    default: "1",
    unit: "s",
    doc: "when the film's exposure ends",
};
const ASPECT: ParameterSpec = ParameterSpec {
    name: "frameaspectratio",
    kind: "float",
    default: "film's",
    unit: "",
    doc: "width over height of the screen window",
};
const WINDOW: ParameterSpec = ParameterSpec {
    name: "screenwindow",
    kind: "float[4]",
    default: "shorter side [-1, 1]",
    unit: "",
    doc: "x0 x1 y0 y1 of the image plane that the film covers",
};
const LENS_RADIUS: ParameterSpec = ParameterSpec {
    name: "lensradius",
    kind: "float",
    default: "0",
    unit: "m",
    doc: "radius of the aperture; focal length / (2 f-number) of a photographic lens; 0 for a pinhole",
};
const FOCAL_DISTANCE: ParameterSpec = ParameterSpec {
    name: "focaldistance",
    kind: "float",
    default: "1e6",
    unit: "m",
    doc: "distance of the plane of focus along the optical axis",
};
const FOV: ParameterSpec = ParameterSpec {
    name: "fov",
    kind: "float",
    default: "90",
    unit: "deg",
    doc: "full angle of view across the shorter side of the window [-1, 1]",
};
const MAPPING: ParameterSpec = ParameterSpec {
    name: "mapping",
    kind: "string",
    default: "equalarea",
    unit: "",
    doc: "equalarea or equirectangular",
};

/// Cameras with their parameters.
pub static CAMERAS: &[(&str, &[ParameterSpec])] = &[
    ("perspective", &[FOV, LENS_RADIUS, FOCAL_DISTANCE, ASPECT, WINDOW, SHUTTER_OPEN, SHUTTER_CLOSE]),
    ("orthographic", &[LENS_RADIUS, FOCAL_DISTANCE, ASPECT, WINDOW, SHUTTER_OPEN, SHUTTER_CLOSE]),
    ("spherical", &[MAPPING, SHUTTER_OPEN, SHUTTER_CLOSE]),
];

impl Camera {
    /// Reads a camera for a film of `resolution` pixels of which `crop` (pixels) is rendered; problems are reported.
    pub fn from_parameters(
        parameters: &mut Parameters<'_, '_>,
        world_from_camera: AnimatedTransform,
        resolution: [u32; 2],
        crop: Bounds2,
    ) -> Self {
        let shutter = read_shutter(parameters);
        let size = [resolution[0] as f32, resolution[1] as f32];
        let name = parameters.entity().type_name.as_str();
        let projection = match name {
            "orthographic" => {
                let screen = read_screen(parameters, size);
                Projection::Orthographic(Orthographic { screen, lens: read_lens(parameters) })
            }
            "spherical" => {
                let choices = [
                    ("equalarea", SphericalMapping::EqualArea),
                    ("equirectangular", SphericalMapping::Equirectangular),
                ];
                let mapping = parameters.choice("mapping", "equalarea", &choices);
                for unused in ["lensradius", "focaldistance", "frameaspectratio", "screenwindow"] {
                    parameters.ignore(unused);
                }
                Projection::Spherical(Spherical { resolution: size, mapping })
            }
            _ => {
                if name != "perspective" {
                    let span = parameters.span();
                    let known = CAMERAS.iter().map(|(name, _)| *name);
                    parameters.diagnostics().unknown_name(span, "camera", name, known);
                    parameters.accept_all();
                }
                Projection::Perspective(read_perspective(parameters, size))
            }
        };
        Self::new(projection, world_from_camera, shutter, resolution, crop)
    }
}

fn read_perspective(parameters: &mut Parameters<'_, '_>, size: [f32; 2]) -> Perspective {
    let screen = read_screen(parameters, size);
    let mut fov = parameters.float("fov", 90.0);
    if !(fov > 0.0 && fov < 180.0) {
        let span = parameters.span_of("fov");
        parameters.diagnostics().error(span, format!("\"fov\" must be between 0 and 180 degrees, not {fov}"));
        fov = 90.0;
    }
    let tan_half_fov = (f64::from(fov).to_radians() / 2.0).tan() as f32;
    Perspective { screen, tan_half_fov, lens: read_lens(parameters) }
}

fn read_shutter(parameters: &mut Parameters<'_, '_>) -> Shutter {
    let (open, close) = (parameters.float("shutteropen", 0.0), parameters.float("shutterclose", 1.0));
    if close >= open {
        return Shutter { open, close };
    }
    let span = parameters.span_of("shutterclose");
    parameters.diagnostics().warning(span, "the shutter closes before it opens; the times are exchanged");
    Shutter { open: close, close: open }
}

fn read_lens(parameters: &mut Parameters<'_, '_>) -> Lens {
    let lens = Lens {
        radius: parameters.float("lensradius", 0.0),
        focal_distance: parameters.float("focaldistance", 1e6),
    };
    if lens.radius >= 0.0 && lens.focal_distance > 0.0 {
        return lens;
    }
    let span = parameters.span_of("lensradius");
    parameters
        .diagnostics()
        .error(span, "\"lensradius\" must not be negative and \"focaldistance\" must be positive");
    Lens::PINHOLE
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
    if let [x0, x1, y0, y1] = *values
        && x0 != x1
        && y0 != y1
    {
        return Screen { window: ScreenWindow { x: [x0, x1], y: [y0, y1] }, resolution };
    }
    let span = parameters.span_of("screenwindow");
    parameters.diagnostics().error(span, "\"screenwindow\" needs four values x0 x1 y0 y1 that span an area");
    Screen { window, resolution }
}
