//! Log-log plots as SVG.

use std::cell::RefCell;

use plotters::coord::Shift;
use plotters::coord::combinators::IntoLogRange;
use plotters::prelude::*;
use plotters::style::FontDesc;

/// Pixels across and down of a panel.
const PANEL_SIZE: (u32, u32) = (640, 520);

/// Colours that stay apart for colour-blind eyes (Okabe and Ito 2008).
const COLORS: [RGBColor; 6] = [
    RGBColor(0, 0, 0),
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
];
const GUIDE_COLOR: RGBColor = RGBColor(120, 120, 120);

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A line.
    Line,
    /// A line with a dot at each measurement.
    LineAndDots,
    /// A dashed grey line: theory.
    Dashes,
}

/// Points of positive coordinates; others are not drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Name in the legend; empty for none.
    pub name: String,
    /// Coordinates.
    pub points: Vec<[f64; 2]>,
    /// How it is drawn.
    pub mark: Mark,
}

/// A corner of a plot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Corner {
    /// For curves that fall; the axis goes on below them to make room.
    LowerLeft,
    /// For curves that stay in the middle.
    UpperRight,
}

/// One plot with logarithmic axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Above the plot.
    pub title: String,
    /// Below it.
    pub x_label: String,
    /// At its left.
    pub y_label: String,
    /// Range of the vertical axis; `None` for that of the points. What lies outside is not drawn.
    pub y_range: Option<[f64; 2]>,
    /// Where the names of the series stand.
    pub legend: Corner,
    /// What it shows.
    pub series: Vec<Series>,
}

/// An SVG document with the panels side by side.
#[must_use]
pub fn draw(panels: &[Panel]) -> String {
    let mut text = String::new();
    let width = PANEL_SIZE.0 * panels.len().max(1) as u32;
    {
        let root = SVGBackend::with_string(&mut text, (width, PANEL_SIZE.1)).into_drawing_area();
        root.fill(&WHITE).expect(IN_MEMORY);
        for (area, panel) in root.split_evenly((1, panels.len().max(1))).iter().zip(panels) {
            panel.draw(area);
        }
        root.present().expect(IN_MEMORY);
    }
    text
}

/// Grid lines of an axis: enough for nine in each of three decades.
const MAX_LINES: usize = 40;
/// Room for a legend in the lower corner, as a share of the height of the curves.
const LEGEND_SHARE: f64 = 0.3;

/// Why drawing does not fail.
const IN_MEMORY: &str = "a string takes any drawing";

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

impl Panel {
    fn draw(&self, area: &Area<'_>) {
        let [x, y] = [self.range(0), self.y_range.unwrap_or_else(|| self.y_range_with_legend())];
        let mut chart = ChartBuilder::on(area)
            .caption(&self.title, font(20))
            .margin(12)
            .x_label_area_size(48)
            .y_label_area_size(72)
            .build_cartesian_2d((x[0]..x[1]).log_scale(), (y[0]..y[1]).log_scale())
            .expect(IN_MEMORY);
        chart
            .configure_mesh()
            .x_desc(&self.x_label)
            .y_desc(&self.y_label)
            .axis_desc_style(font(16))
            .label_style(font(14))
            .bold_line_style(BLACK.mix(0.12))
            .max_light_lines(0)
            .x_labels(MAX_LINES)
            .y_labels(MAX_LINES)
            .x_label_formatter(&once(label))
            .y_label_formatter(&once(label))
            .draw()
            .expect(IN_MEMORY);
        for (index, series) in self.series.iter().enumerate() {
            let color = if series.mark == Mark::Dashes { GUIDE_COLOR } else { COLORS[index % COLORS.len()] };
            let style = color.stroke_width(if series.mark == Mark::Dashes { 1 } else { 2 });
            let points: Vec<(f64, f64)> = series
                .points
                .iter()
                .filter(|point| point[0] > 0.0 && point[1] >= y[0] && point[1] <= y[1])
                .map(|point| (point[0], point[1]))
                .collect();
            if series.mark == Mark::LineAndDots {
                let dots = points.iter().map(|p| Circle::new(*p, 3, color.filled()));
                chart.draw_series(dots).expect(IN_MEMORY);
            }
            let drawn = if series.mark == Mark::Dashes {
                chart.draw_series(DashedLineSeries::new(points, 6, 4, style)).expect(IN_MEMORY)
            } else {
                chart.draw_series(LineSeries::new(points, style)).expect(IN_MEMORY)
            };
            if !series.name.is_empty() {
                drawn
                    .label(&series.name)
                    .legend(move |(x, y)| PathElement::new([(x, y), (x + 22, y)], style));
            }
        }
        chart
            .configure_series_labels()
            .position(self.legend.position())
            .margin(12)
            .legend_area_size(30)
            .label_font(font(14))
            .background_style(WHITE.mix(0.85))
            .draw()
            .expect(IN_MEMORY);
    }

    fn y_range_with_legend(&self) -> [f64; 2] {
        let [low, high] = self.range(1);
        match self.legend {
            Corner::LowerLeft => [low * (low / high).powf(LEGEND_SHARE), high],
            Corner::UpperRight => [low, high],
        }
    }

    /// The range of one coordinate over all points, a little wider.
    fn range(&self, axis: usize) -> [f64; 2] {
        let values = self.series.iter().flat_map(|s| &s.points).map(|p| p[axis]).filter(|v| *v > 0.0);
        let [low, high] =
            values.fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], v| [low.min(v), high.max(v)]);
        if low > high { [1.0, 10.0] } else { [low / 1.15, high * 1.15] }
    }
}

impl Corner {
    const fn position(self) -> SeriesLabelPosition {
        match self {
            Self::LowerLeft => SeriesLabelPosition::LowerLeft,
            Self::UpperRight => SeriesLabelPosition::UpperRight,
        }
    }
}

fn font(size: u32) -> FontDesc<'static> {
    ("sans-serif", size).into_font()
}

/// A formatter that leaves out a label that repeats the one before: the library lists powers of ten twice.
fn once(format: impl Fn(f64) -> String) -> impl Fn(&f64) -> String {
    let last = RefCell::new(String::new());
    move |value| {
        let text = format(*value);
        let is_repeated = *last.borrow() == text;
        last.replace(text.clone());
        if is_repeated { String::new() } else { text }
    }
}

/// The number of a grid line if it is 1, 2 or 5 times a power of ten: more would run into each other.
fn label(value: f64) -> String {
    let leading = value / 10.0_f64.powf(value.log10().floor());
    let is_labelled = [1.0, 2.0, 5.0, 10.0].iter().any(|digit| (leading - digit).abs() < 1e-6);
    if is_labelled { decimal(value) } else { String::new() }
}

/// A number without exponent or trailing zeros.
fn decimal(value: f64) -> String {
    let digits = (1.0 - value.abs().log10().floor()).max(0.0) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
