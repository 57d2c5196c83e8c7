//! What a scene file says of sun and sky.

use etendue_math::{Frame, Transform, Vector3};
use etendue_spectrum::atmosphere::SUN_RADIUS_DEGREES;

use super::dome::Atmosphere;
use super::{Date, Place, SkyLight, SunLight, SunPosition};
use crate::light::build::{self, spec};
use crate::parameters::{ParameterSpec, Parameters};

/// Elevation in degrees of the sun below which the sky is black: the end of nautical twilight.
const DARKEST_DEGREES: f64 = -12.0;
/// Largest factor: radiance of the sun's disc is 1e10 cd/m^2, and numbers end at 3e38.
const MAX_FACTOR: f32 = 1e20;
/// Ways to say where the sun stands, by the parameters that stand for them.
const WAYS: [&[&str]; 3] =
    [&["sundirection"], &["elevation", "azimuth"], &["latitude", "longitude", "date", "time", "timezone"]];

/// Sun, sky or both.
#[derive(Clone, Copy, Debug)]
pub(in crate::light) struct SkySettings {
    air: Atmosphere,
    /// Of the world; z is up, x the sun's side.
    frame: Frame,
    to_sun: Vector3,
    scale: f32,
    sun_scale: f32,
    has_ground: bool,
}

impl SkySettings {
    /// Parameters of `sun`, `sky` and `sunsky`.
    pub(in crate::light) const PARAMETERS: &[ParameterSpec] = &[
        spec("turbidity", "float", "3", "", "haze, from 1 (none) over 2 to 3 (a clear day) to 10"),
        spec("sundirection", "vector3", "", "", "direction to the sun"),
        spec("elevation", "float", "45", "degrees", "height of the sun above the horizon"),
        spec("azimuth", "float", "180", "degrees", "of the sun, from north over east"),
        spec(
            "latitude",
            "float",
            "",
            "degrees",
            "of the place, north positive; with date and time it says where the sun stands",
        ),
        spec("longitude", "float", "0", "degrees", "of the place, east positive"),
        spec("date", "string", "", "", "day as in \"2026-06-21\""),
        spec("time", "float", "12", "h", "time of the day by the clock"),
        spec("timezone", "float", "0", "h", "by how much the clock is ahead of universal time"),
        spec("groundalbedo", "float", "0.2", "", "share of light that the ground reflects"),
        spec("ground", "bool", "true", "", "false if below the horizon there is nothing to be seen"),
        spec("ozone", "float", "300", "DU", "amount of ozone"),
        spec("up", "vector3", "0 0 1", "", "direction to the zenith"),
        spec("north", "vector3", "0 1 0", "", "direction to the north; 0 0 -1 if up is along y"),
        build::SCALE,
        spec("sunscale", "float", "1", "", "further factor for the sun's disc"),
    ];

    pub(in crate::light) fn read(p: &mut Parameters, world_from_light: &Transform) -> Option<Self> {
        let turbidity = within(p, "turbidity", 3.0, 1.0, 10.0);
        let ozone_du = within(p, "ozone", 300.0, 0.0, 1000.0);
        let ground_albedo = within(p, "groundalbedo", 0.2, 0.0, 1.0);
        let (scale, mut sun_scale) = (factor(p, "scale"), factor(p, "sunscale"));
        if scale * sun_scale > MAX_FACTOR {
            let span = p.span_of("sunscale");
            let text = format!("\"scale\" times \"sunscale\" must be at most {MAX_FACTOR:e}");
            p.diagnostics().error(span, text);
            sun_scale = 1.0;
        }
        let has_ground = p.bool("ground", true);
        let compass = read_compass(p)?;
        let to_sun = read_sun(p, &compass)?;
        let elevation = to_sun.dot(compass.z).clamp(-1.0, 1.0).asin();
        let side = to_sun - compass.z * to_sun.dot(compass.z);
        let side = side.try_normalized().unwrap_or(compass.y);
        let to_world = |w: Vector3| world_from_light.vector(w).try_normalized();
        let (Some(up), Some(side), Some(to_sun)) = (to_world(compass.z), to_world(side), to_world(to_sun))
        else {
            let span = p.span();
            p.diagnostics().error(span, "the transform of the light leaves no directions");
            return None;
        };
        Some(Self {
            air: Atmosphere { turbidity, ozone_du, ground_albedo, elevation: f64::from(elevation) },
            frame: Frame::from_zx(up, side),
            to_sun,
            scale,
            sun_scale,
            has_ground,
        })
    }

    /// The sky; `None` with a warning where it is night.
    pub(in crate::light) fn sky(&self, p: &mut Parameters) -> Option<SkyLight> {
        let degrees = self.air.elevation.to_degrees();
        if degrees < DARKEST_DEGREES {
            let text = format!("the sun is {:.1} degrees below the horizon; the sky is black", -degrees);
            let span = p.span();
            p.diagnostics().warning(span, text);
            return None;
        }
        let spectra = &mut p.context.spectra;
        Some(SkyLight::new(self.frame, &self.air, self.scale, self.has_ground, spectra))
    }

    /// The sun's disc; `None` where it has set.
    pub(in crate::light) fn sun(&self, p: &mut Parameters) -> Option<SunLight> {
        if self.air.elevation.to_degrees() < -SUN_RADIUS_DEGREES {
            let span = p.span();
            p.diagnostics().warning(span, "the sun is below the horizon; it does not shine");
            return None;
        }
        let scale = self.scale * self.sun_scale;
        Some(SunLight::new(self.to_sun, &self.air, scale, &mut p.context.spectra))
    }
}

/// East, north and up in the space of the light.
fn read_compass(p: &mut Parameters) -> Option<Frame> {
    let up = p.vector3("up", Vector3::new(0.0, 0.0, 1.0));
    let default = if up.y.abs() > 0.9 * up.length() {
        Vector3::new(0.0, 0.0, -1.0)
    } else {
        Vector3::new(0.0, 1.0, 0.0)
    };
    let north = p.vector3("north", default);
    let frame = up.try_normalized().and_then(|up| {
        let north = (north - up * north.dot(up)).try_normalized()?;
        Some(Frame { x: north.cross(up), y: north, z: up })
    });
    if frame.is_none() {
        let span = p.span_of("up");
        p.diagnostics().error(span, "\"up\" and \"north\" must be two directions that differ");
    }
    frame
}

/// Direction to the sun in the space of the light.
fn read_sun(p: &mut Parameters, compass: &Frame) -> Option<Vector3> {
    let given = WAYS.map(|names| p.entity().parameters.iter().any(|q| names.contains(&q.name.as_str())));
    if given.iter().filter(|given| **given).count() > 1 {
        let span = p.span();
        p.diagnostics()
            .error(span, "there is more than one answer to where the sun stands")
            .with_help("give \"sundirection\", or \"elevation\" and \"azimuth\", or place, date and time");
        p.accept_all();
        return None;
    }
    if let Some(direction) = p.vector3_opt("sundirection") {
        let unit = direction.try_normalized();
        if unit.is_none() {
            let span = p.span_of("sundirection");
            p.diagnostics().error(span, "\"sundirection\" must not be zero");
        }
        return unit;
    }
    let (elevation, azimuth) = if given[2] {
        read_place(p)?
    } else {
        (within(p, "elevation", 45.0, -90.0, 90.0), within(p, "azimuth", 180.0, -360.0, 360.0))
    };
    let ((sine, cosine), (east, north)) = (elevation.to_radians().sin_cos(), azimuth.to_radians().sin_cos());
    let local = [cosine * east, cosine * north, sine].map(|c| c as f32);
    Some(compass.to_world(Vector3::new(local[0], local[1], local[2])))
}

/// Elevation and azimuth in degrees at a place and a time.
fn read_place(p: &mut Parameters) -> Option<(f64, f64)> {
    let latitude = within(p, "latitude", 0.0, -90.0, 90.0);
    let longitude = within(p, "longitude", 0.0, -180.0, 180.0);
    let (time, zone) = (within(p, "time", 12.0, 0.0, 24.0), within(p, "timezone", 0.0, -14.0, 14.0));
    for name in ["latitude", "date"] {
        if !p.has(name) {
            p.missing(
                name,
                format!("where the sun stands follows from \"latitude\" and \"date\"; \"{name}\" is missing"),
            );
            return None;
        }
    }
    let text = p.string("date", "");
    let Some(date) = Date::parse(&text) else {
        let span = p.span_of("date");
        p.diagnostics()
            .error(span, format!("\"{text}\" is no day from 1900 to 2100"))
            .with_help("write it as \"2026-06-21\"");
        return None;
    };
    let sun = SunPosition::at(Place { latitude, longitude }, date, time - zone);
    Some((sun.apparent_elevation(), sun.azimuth))
}

/// A number between two limits; one beyond is reported and clamped.
fn within(p: &mut Parameters, name: &'static str, default: f32, least: f32, most: f32) -> f64 {
    let value = p.float(name, default);
    let taken = if value.is_nan() { default } else { value.clamp(least, most) };
    if taken != value {
        let span = p.span_of(name);
        let text = format!("\"{name}\" must be between {least} and {most}, but is {value}; {taken} is taken");
        p.diagnostics().warning(span, text);
    }
    f64::from(taken)
}

/// A factor of at least 0.
fn factor(p: &mut Parameters, name: &'static str) -> f32 {
    let value = p.float(name, 1.0);
    if (0.0..=MAX_FACTOR).contains(&value) {
        return value;
    }
    let span = p.span_of(name);
    p.diagnostics()
        .error(span, format!("\"{name}\" must be at least 0 and at most {MAX_FACTOR:e}, not {value}"));
    1.0
}
