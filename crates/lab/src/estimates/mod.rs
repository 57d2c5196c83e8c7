//! Studies of the radiance estimate: on fields of photons whose density is known, and in a room (SPEC EXP-6, EXP-8, EXP-9,
//! EXP-42, EXP-45).

mod consistency;
mod edge;
mod field;
mod gathering;
mod handle;
mod walls;

#[cfg(test)]
mod tests;

use std::fmt::Write;

use crate::plot::{Panel, draw};

pub use consistency::{ConsistencySettings, consistency};
pub use edge::{EdgeSettings, edge};
pub use gathering::{GatheringSettings, gathering};
pub use handle::{HandleSettings, handle};
pub use walls::{WallSettings, walls};

/// Curves with what they say.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CurveStudy {
    /// The figure.
    pub panels: Vec<Panel>,
    /// A few lines for people.
    pub summary: String,
}

impl CurveStudy {
    /// One row for each point of each curve.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut text = String::from("panel,curve,x,y\n");
        for panel in &self.panels {
            for series in &panel.series {
                for [x, y] in &series.points {
                    let _ = writeln!(text, "\"{}\",\"{}\",{x:.6e},{y:.6e}", panel.title, series.name);
                }
            }
        }
        text
    }

    /// The panels side by side.
    #[must_use]
    pub fn svg(&self) -> String {
        draw(&self.panels)
    }
}
