//! Lines in space above or through a round piece of surface.

use plotters::prelude::*;

use super::{Area, COLORS, IN_MEMORY, font};

/// A drawing of lines, already projected: x to the right and y up, within the unit circle.
#[derive(Clone, Debug, PartialEq)]
pub struct Wires {
    /// Above the drawing.
    pub title: String,
    /// What is shown.
    pub lines: Vec<Vec<[f64; 2]>>,
    /// Outline of the surface.
    pub surface: Vec<[f64; 2]>,
    /// The way on which light arrives.
    pub arrival: Vec<[f64; 2]>,
}

impl Wires {
    pub(super) fn draw<B: DrawingBackend>(&self, area: &Area<B>) {
        let (width, height) = area.dim_in_pixel();
        let all = || self.lines.iter().chain([&self.surface, &self.arrival]).flatten();
        let extreme = |i: usize, sign: f64| sign * all().map(|p| sign * p[i]).fold(0.0, f64::max);
        let [x, y] = [0, 1].map(|i| [extreme(i, -1.0), extreme(i, 1.0)]);
        let (margin, title) = (24.0, 34.0);
        let room = [f64::from(width) - 2.0 * margin, f64::from(height) - title - 2.0 * margin];
        let scale = (room[0] / (x[1] - x[0]).max(1e-9)).min(room[1] / (y[1] - y[0]).max(1e-9));
        let center = [0.5 * f64::from(width), title + margin + 0.5 * room[1]];
        let place = |p: &[f64; 2]| {
            let [dx, dy] = [p[0] - 0.5 * (x[0] + x[1]), p[1] - 0.5 * (y[0] + y[1])];
            ((center[0] + scale * dx).round() as i32, (center[1] - scale * dy).round() as i32)
        };
        let draw = |points: &[[f64; 2]], style: ShapeStyle| {
            let points: Vec<(i32, i32)> = points.iter().map(place).collect();
            area.draw(&PathElement::new(points, style)).expect(IN_MEMORY);
        };
        area.draw(&Text::new(self.title.as_str(), (16, 12), font(18))).expect(IN_MEMORY);
        draw(&self.surface, BLACK.mix(0.5).stroke_width(1));
        for line in &self.lines {
            draw(line, COLORS[1].mix(0.6).stroke_width(1));
        }
        draw(&self.arrival, COLORS[2].stroke_width(2));
    }
}
