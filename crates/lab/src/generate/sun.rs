//! Sun and sky of outdoor scenes.

/// Latitude, and declination of the sun on the longest day, in degrees.
const LATITUDE: f32 = 52.0;
const DECLINATION: f32 = 23.44;

/// Towards the sun at an hour of solar time: x to the east, y upwards, z to the north.
pub(super) fn direction(hour: f32) -> [f32; 3] {
    let (sin_latitude, cos_latitude) = LATITUDE.to_radians().sin_cos();
    let (sin_declination, cos_declination) = DECLINATION.to_radians().sin_cos();
    let (sin_angle, cos_angle) = (15.0 * (hour - 12.0)).to_radians().sin_cos();
    let up = sin_latitude * sin_declination + cos_latitude * cos_declination * cos_angle;
    let north = cos_latitude * sin_declination - sin_latitude * cos_declination * cos_angle;
    [-cos_declination * sin_angle, up, north]
}

/// Sun and sky for a sun in that direction. The sun's light weakens and reddens as its way through the air gets longer.
pub(super) fn light([x, y, z]: [f32; 3]) -> String {
    let y = y.max(0.02);
    // Relative optical path of a flat atmosphere, with Kasten and Young's bound of 38 at the horizon; one sixth of the light is lost overhead, more of blue.
    let path = (1.0 / y).min(38.0);
    let illuminance = 128_000.0 * (-0.21 * path).exp();
    let red = [0.95, 1.0, 1.05].map(|k: f32| (-0.12 * (k - 0.9) * 8.0 * (path - 1.0) * 0.25).exp());
    let [r, g, b] = red;
    let sky = 2000.0 + 16_000.0 * y;
    format!(
        "LightSource \"infinite\" \"float illuminance\" [ {sky} ] \"rgb L\" [ 0.45 0.65 1 ]\nLightSource \"distant\" \"point3 from\" [ {x} {y} {z} ] \"point3 to\" [ 0 0 0 ]\n  \"float illuminance\" [ {illuminance} ] \"rgb L\" [ {r} {g} {b} ]\n"
    )
}
