//! Curves around a point: angles from the upward axis, clockwise.

use plotters::prelude::*;

use super::{Area, COLORS, IN_MEMORY, font};

/// A polar plot. Directions that point up leave the surface, which is drawn as a line.
#[derive(Clone, Debug, PartialEq)]
pub struct Polar {
    /// Above the plot.
    pub title: String,
    /// Angle in degrees and radius, at most 1.
    pub points: Vec<[f64; 2]>,
    /// Angle and radius of straight lines from the centre, each with a text.
    pub spikes: Vec<([f64; 2], String)>,
    /// Angle in degrees from which light arrives.
    pub arrival_deg: f64,
    /// Radius and name of circles around the centre.
    pub rings: Vec<(f64, String)>,
    /// True to show the lower half.
    pub has_lower_half: bool,
}

impl Polar {
    pub(super) fn draw<B: DrawingBackend>(&self, area: &Area<B>) {
        let (width, height) = area.dim_in_pixel();
        // Equal scales: the title takes the top.
        let (margin, title) = (14.0, 34.0);
        let (w, h) = (f64::from(width), f64::from(height) - title);
        let low = if self.has_lower_half { -1.08 } else { -0.12 };
        let scale = ((w - 2.0 * margin) / 2.16).min((h - 2.0 * margin) / (1.08 - low));
        let center = [0.5 * w, title + margin + 1.08 * scale];
        let place = |angle_deg: f64, radius: f64| {
            let (sin, cos) = angle_deg.to_radians().sin_cos();
            let [x, y] = [center[0] + scale * radius * sin, center[1] - scale * radius * cos];
            (x.round() as i32, y.round() as i32)
        };
        let draw = |points: Vec<(i32, i32)>, style: ShapeStyle| {
            area.draw(&PathElement::new(points, style)).expect(IN_MEMORY);
        };
        area.draw(&Text::new(self.title.as_str(), (16, 12), font(18))).expect(IN_MEMORY);
        let end = if self.has_lower_half { 180 } else { 90 };
        let grid = BLACK.mix(0.15).stroke_width(1);
        for (radius, name) in &self.rings {
            draw((-end..=end).step_by(2).map(|a| place(f64::from(a), *radius)).collect(), grid);
            let (x, y) = place(90.0, *radius);
            area.draw(&Text::new(name.as_str(), (x - 34, y + 4), font(12))).expect(IN_MEMORY);
        }
        for angle in (-end..=end).step_by(30) {
            draw(vec![place(0.0, 0.0), place(f64::from(angle), 1.0)], grid);
        }
        draw(vec![place(-90.0, 1.06), place(90.0, 1.06)], BLACK.stroke_width(2));
        let arrival = [place(self.arrival_deg, 1.06), place(self.arrival_deg, 0.0)];
        draw(arrival.to_vec(), COLORS[2].stroke_width(2));
        for ([angle, radius], name) in &self.spikes {
            draw(vec![place(*angle, 0.0), place(*angle, *radius)], COLORS[3].stroke_width(3));
            let (x, y) = place(*angle, radius.max(0.3));
            area.draw(&Text::new(name.as_str(), (x + 6, y - 6), font(14))).expect(IN_MEMORY);
        }
        let curve = self.points.iter().map(|p| place(p[0], p[1])).collect();
        draw(curve, COLORS[1].stroke_width(2));
    }
}
