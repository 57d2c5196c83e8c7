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

/// Sun and sky for a sun in that direction, on a clear day.
pub(super) fn light([x, y, z]: [f32; 3]) -> String {
    format!(
        "LightSource \"sunsky\" \"float turbidity\" [ 2.6 ] \"vector3 up\" [ 0 1 0 ] \"vector3 sundirection\" [ {x} {y} {z} ]\n"
    )
}
