//! Values that several commands take.

use std::time::Duration;

pub(crate) fn parse_duration(text: &str) -> Result<Duration, String> {
    let number_end = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let (number, unit) = text.split_at(number_end);
    let number: f64 = number.parse().map_err(|_| "a time is a number with a unit, such as 30s".to_owned())?;
    let seconds = match unit {
        "" | "s" => 1.0,
        "ms" => 1e-3,
        "m" | "min" => 60.0,
        "h" => 3600.0,
        _ => return Err(format!("'{unit}' is not a unit of time; use ms, s, m or h")),
    };
    Duration::try_from_secs_f64(number * seconds).map_err(|error| error.to_string())
}

pub(crate) fn parse_positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("a positive number is needed".to_owned()),
    }
}

pub(crate) fn parse_resolution(text: &str) -> Result<[i32; 2], String> {
    let malformed = || "a resolution is WIDTHxHEIGHT in pixels, such as 640x480".to_owned();
    let (width, height) = text.split_once('x').ok_or_else(malformed)?;
    let resolution = [width.parse().map_err(|_| malformed())?, height.parse().map_err(|_| malformed())?];
    if resolution.iter().any(|r| *r < 1) { Err(malformed()) } else { Ok(resolution) }
}

pub(crate) fn parse_triple(text: &str) -> Result<[f32; 3], String> {
    let numbers: Option<Vec<f32>> =
        text.split(',').map(|number| number.trim().parse().ok().filter(|v: &f32| v.is_finite())).collect();
    numbers
        .and_then(|n| <[f32; 3]>::try_from(n).ok())
        .ok_or_else(|| "write three numbers, such as 0,1.5,-2".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Times are read with their units.
    #[test]
    fn durations() {
        assert_eq!(parse_duration("30s"), Ok(Duration::from_secs(30)));
        assert_eq!(parse_duration("1.5m"), Ok(Duration::from_secs(90)));
        assert_eq!(parse_duration("250ms"), Ok(Duration::from_millis(250)));
        assert!(parse_duration("5 parsecs").is_err());
        assert!(parse_duration("s").is_err());
    }

    /// Resolutions that mean nothing are refused.
    #[test]
    fn malformed_values() {
        assert_eq!(parse_resolution("64x48"), Ok([64, 48]));
        assert!(parse_resolution("64x0").is_err());
    }
}
