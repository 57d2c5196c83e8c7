//! Where the sun stands at a place and a time: the low-precision theory of Meeus 1998 ("Astronomical Algorithms", 2nd ed.,
//! chapters 7, 12, 13, 16 and 25), good to 0.01 degree from 1900 to 2100. Universal and dynamical time are taken as one,
//! which costs less than 0.001 degree.

/// A day of the Gregorian calendar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Date {
    /// Year, from 1900 to 2100.
    pub year: i32,
    /// Month from 1.
    pub month: u32,
    /// Day of the month from 1.
    pub day: u32,
}

impl Date {
    /// From `2026-06-21`; `None` if there is no such day, or it is before 1900 or after 2100.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let mut parts = text.split('-');
        let (year, month, day) = (parts.next()?, parts.next()?, parts.next()?);
        let digits = |part: &str, n: usize| part.len() == n && part.bytes().all(|b| b.is_ascii_digit());
        if parts.next().is_some() || !digits(year, 4) || !digits(month, 2) || !digits(day, 2) {
            return None;
        }
        let date = Self { year: year.parse().ok()?, month: month.parse().ok()?, day: day.parse().ok()? };
        date.exists().then_some(date)
    }

    fn exists(self) -> bool {
        let is_leap = self.year % 4 == 0 && (self.year % 100 != 0 || self.year % 400 == 0);
        let days = match self.month {
            2 => 28 + u32::from(is_leap),
            4 | 6 | 9 | 11 => 30,
            1..=12 => 31,
            _ => return false,
        };
        (1900..=2100).contains(&self.year) && (1..=days).contains(&self.day)
    }

    /// Days since noon of 1 January 2000 at the start of the day.
    fn days_since_2000(self) -> f64 {
        // Meeus (7.1), with January and February counted to the year before.
        let (y, m) = if self.month > 2 { (self.year, self.month) } else { (self.year - 1, self.month + 12) };
        let century = y.div_euclid(100);
        let leap = 2 - century + century.div_euclid(4);
        let days = (365.25 * f64::from(y + 4716)).floor() + (30.6001 * f64::from(m + 1)).floor();
        days + f64::from(self.day) + f64::from(leap) - 1524.5 - 2_451_545.0
    }
}

/// A place on the earth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Degrees north.
    pub latitude: f64,
    /// Degrees east.
    pub longitude: f64,
}

/// Where the sun's centre stands, in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunPosition {
    /// Angle above the horizon without refraction.
    pub elevation: f64,
    /// Angle from north over east.
    pub azimuth: f64,
}

impl SunPosition {
    /// The position at so many hours after midnight of universal time.
    #[must_use]
    pub fn at(place: Place, date: Date, universal_hours: f64) -> Self {
        let days = date.days_since_2000() + universal_hours / 24.0;
        let (right_ascension, declination) = equatorial(days);
        let t = days / 36525.0;
        let greenwich = 280.460_618_37 + 360.985_647_366_29 * days + 0.000_387_933 * t * t; // Meeus (12.4)
        let hour_angle = (greenwich + place.longitude).to_radians() - right_ascension;
        let latitude = place.latitude.to_radians();
        let (sin_h, cos_h) = hour_angle.sin_cos();
        // Meeus (13.5) and (13.6), with azimuths from north.
        let azimuth = sin_h.atan2(cos_h * latitude.sin() - declination.tan() * latitude.cos());
        let sine = latitude.sin() * declination.sin() + latitude.cos() * declination.cos() * cos_h;
        let elevation =
            sine.clamp(-1.0, 1.0).asin().to_degrees() - PARALLAX * sine.clamp(-1.0, 1.0).acos().sin();
        Self { elevation, azimuth: (azimuth.to_degrees() + 180.0).rem_euclid(360.0) }
    }

    /// The elevation at which the sun is seen through air of 1010 mbar and 10 °C (Sæmundsson 1986, "Atmospheric
    /// Refraction"; Meeus (16.4)). Below -1 degree, where the sun is not seen, the true one.
    #[must_use]
    pub fn apparent_elevation(self) -> f64 {
        let h = self.elevation;
        if h < -1.0 {
            return h;
        }
        let minutes = 1.02 / (h + 10.3 / (h + 5.11)).to_radians().tan();
        h + minutes.max(0.0) / 60.0
    }
}

/// By how much the sun stands lower at the horizon of a place than seen from the centre of the earth, in degrees.
const PARALLAX: f64 = 8.794 / 3600.0;

/// Apparent right ascension and declination of the sun in radians (Meeus, chapter 25).
fn equatorial(days: f64) -> (f64, f64) {
    let t = days / 36525.0;
    let mean_longitude = 280.466_46 + 36_000.769_83 * t + 0.000_303_2 * t * t;
    let anomaly = (357.529_11 + 35_999.050_29 * t - 0.000_153_7 * t * t).to_radians();
    let center = (1.914_602 - 0.004_817 * t - 0.000_014 * t * t) * anomaly.sin()
        + (0.019_993 - 0.000_101 * t) * (2.0 * anomaly).sin()
        + 0.000_289 * (3.0 * anomaly).sin();
    let node = (125.04 - 1934.136 * t).to_radians();
    let longitude = (mean_longitude + center - 0.005_69 - 0.004_78 * node.sin()).to_radians();
    let obliquity = (23.439_291 - 0.013_004_2 * t + 0.002_56 * node.cos()).to_radians();
    let right_ascension = (obliquity.cos() * longitude.sin()).atan2(longitude.cos());
    (right_ascension, (obliquity.sin() * longitude.sin()).asin())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn assert_near(value: f64, expected: f64, tolerance: f64) {
        assert!((value - expected).abs() <= tolerance, "{value} is not near {expected}");
    }

    #[test]
    fn the_sun_stands_where_published_examples_say() {
        // Meeus, example 25.a: 13 October 1992, 0 h TD: right ascension 198.38083, declination -7.78507 degrees.
        let date = Date::parse("1992-10-13").expect("it is a date");
        let (right_ascension, declination) = equatorial(date.days_since_2000());
        assert_near(right_ascension.to_degrees().rem_euclid(360.0), 198.380_83, 1e-3);
        assert_near(declination.to_degrees(), -7.785_07, 1e-3);
        // Reda and Andreas 2008 (NREL/TP-560-34302), appendix A.5: zenith 50.11162, azimuth 194.34024 degrees, with
        // refraction at 820 mbar.
        let place = Place { latitude: 39.742_476, longitude: -105.178_6 };
        let date = Date::parse("2003-10-17").expect("it is a date");
        let sun = SunPosition::at(place, date, 12.0 + 30.5 / 60.0 + 7.0);
        assert_near(90.0 - sun.apparent_elevation(), 50.1116, 0.01);
        assert_near(sun.azimuth, 194.3402, 0.01);
    }

    #[test]
    fn the_sun_culminates_as_the_seasons_say() {
        // At the solstice the sun stands in the zenith of the tropic; at the pole it circles at 23.44 degrees.
        let date = Date::parse("2026-06-21").expect("it is a date");
        let noon = SunPosition::at(Place { latitude: 23.44, longitude: 0.0 }, date, 12.03);
        assert_near(noon.elevation, 90.0, 0.1);
        for hour in [0.0, 7.0, 18.5] {
            let pole = SunPosition::at(Place { latitude: 90.0, longitude: 0.0 }, date, hour);
            assert_near(pole.elevation, 23.44, 0.01);
        }
        // South of the tropics the noon sun stands in the north.
        let south = SunPosition::at(Place { latitude: -33.9, longitude: 18.4 }, date, 12.0 - 18.4 / 15.0);
        assert!(south.azimuth < 2.0 || south.azimuth > 358.0, "{}", south.azimuth);
    }

    #[test]
    fn refraction_lifts_the_setting_sun() {
        // 28.98 arc minutes at the true elevation 0 by (16.4); Meeus, example 16.a: 24.618 at 33.205.
        let at = |elevation| SunPosition { elevation, azimuth: 0.0 }.apparent_elevation();
        assert_near((at(0.0) - 0.0) * 60.0, 28.98, 0.05);
        assert_near((at(33.2052 / 60.0) - 33.2052 / 60.0) * 60.0, 24.618, 0.02);
        assert_near(at(90.0), 90.0, 1e-3);
        assert_near(at(-5.0), -5.0, 0.0);
    }

    #[test]
    fn only_days_that_exist_are_dates() {
        assert!(Date::parse("2024-02-29").is_some());
        for text in
            ["2026-02-29", "2026-13-01", "2026-00-10", "2026-6-21", "1800-01-01", "2026-06-21-1", "x", ""]
        {
            assert_eq!(Date::parse(text), None, "{text}");
        }
    }
}
