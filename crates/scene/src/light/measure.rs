//! What a light is known by, for people: intensity, irradiance or radiance.

use super::{Light, LightContext, LightPower};

/// A quantity of light with its units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightMeasure {
    /// Which, and where it is taken.
    pub name: &'static str,
    /// Unit of the radiant and of the luminous quantity.
    pub units: [&'static str; 2],
    /// Its values in those units, as watts and lumens.
    pub value: LightPower,
}

const INTENSITY: [&str; 2] = ["W/sr", "cd"];
const IRRADIANCE: [&str; 2] = ["W/m^2", "lx"];
const RADIANCE: [&str; 2] = ["W/(m^2 sr)", "cd/m^2"];

impl Light {
    /// What the light is known by; `None` where no single number says it.
    #[must_use]
    pub fn measure(&self, context: &LightContext) -> Option<LightMeasure> {
        let tables = context.tables;
        let of = |spectrum| LightPower::of(spectrum, context.spectra);
        let sphere = 4.0 * std::f64::consts::PI;
        let (name, units, value) = match self {
            Self::Point(light) => ("intensity", INTENSITY, of(&light.intensity)),
            Self::Spot(light) => ("intensity on the axis", INTENSITY, of(&light.intensity)),
            Self::Goniometric(_) => ("mean intensity", INTENSITY, self.power(context) * (1.0 / sphere)),
            Self::Ies(id) => {
                ("peak intensity", INTENSITY, tables.luminaires[id.0 as usize].peak_intensity(context))
            }
            Self::Distant(light) => ("irradiance of a facing plane", IRRADIANCE, of(&light.irradiance)),
            Self::Sun(light) => {
                ("irradiance of a facing plane", IRRADIANCE, light.normal_irradiance(context))
            }
            Self::Sky(id) => {
                ("irradiance of the ground", IRRADIANCE, tables.skies[id.0 as usize].horizontal_irradiance())
            }
            Self::InfiniteConstant(light) => ("radiance", RADIANCE, of(&light.radiance)),
            Self::InfiniteImage(_) => {
                let area = f64::from(tables.scene_sphere.cross_section());
                ("mean radiance", RADIANCE, self.power(context) * (1.0 / (sphere * area)))
            }
            Self::Area(light) => ("mean radiance along the normal", RADIANCE, light.mean_radiance(context)),
            Self::MovingArea(light) => {
                ("mean radiance along the normal", RADIANCE, light.mean_radiance(context))
            }
            Self::Projection(_) | Self::InfinitePortal(_) => return None,
        };
        Some(LightMeasure { name, units, value })
    }
}
