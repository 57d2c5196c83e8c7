//! Plots with logarithmic or linear axes, and polar ones, as SVG or as pixels.

mod base64;
mod polar;
mod raster;
mod wires;

use std::cell::RefCell;

use plotters::coord::Shift;
use plotters::coord::combinators::IntoLogRange;
use plotters::coord::ranged1d::ValueFormatter;
use plotters::prelude::*;
use plotters::style::FontDesc;

use etendue_image::Image;
use etendue_io::images::png_bytes;
use raster::Raster;

pub use base64::base64;
pub use polar::Polar;
pub use wires::Wires;

/// Pixels across and down of a panel.
const PANEL_SIZE: (u32, u32) = (640, 520);

/// Colours that stay apart for colour-blind eyes (Okabe and Ito 2008).
const COLORS: [RGBColor; 7] = [
    RGBColor(0, 0, 0),
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
];
/// Blue, green, orange and red of the same set.
const WAVELENGTH_COLORS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(0, 158, 115),
    RGBColor(230, 159, 0),
    RGBColor(213, 94, 0),
    RGBColor(0, 0, 0),
    RGBColor(120, 120, 120),
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
    /// A dashed line in the colour of the series before.
    DashesAsBefore,
}

/// How numbers become places along both axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Axes {
    /// Logarithms; points that are not positive are not drawn.
    #[default]
    Logarithmic,
    /// Proportional, within a horizontal range; the vertical one begins at 0.
    Linear([f64; 2]),
    /// Logarithms across, proportional upwards from 0: a law of the logarithm is a line.
    SemiLogarithmic,
}

/// Colours of the series, in turn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Palette {
    /// Far apart from each other.
    #[default]
    Apart,
    /// Those of four wavelengths, short to long, then black and grey.
    Wavelengths,
}

/// Points of a curve.
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Corner {
    /// For curves that fall; the axis goes on below them to make room.
    #[default]
    LowerLeft,
    /// For curves that rise.
    UpperLeft,
    /// For curves that stay in the middle.
    UpperRight,
}

/// One plot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Panel {
    /// Above the plot.
    pub title: String,
    /// Below it.
    pub x_label: String,
    /// At its left.
    pub y_label: String,
    /// Range of the vertical axis; `None` for that of the points. What lies outside is not drawn.
    pub y_range: Option<[f64; 2]>,
    /// Scales.
    pub axes: Axes,
    /// Colours.
    pub palette: Palette,
    /// Where the names of the series stand.
    pub legend: Corner,
    /// What it shows.
    pub series: Vec<Series>,
}

/// A part of a figure.
#[derive(Clone, Debug, PartialEq)]
pub enum Part {
    /// Curves over an axis.
    Panel(Panel),
    /// Curves around a point.
    Polar(Polar),
    /// Lines in space.
    Wires(Wires),
    /// A picture in [0, 1], with its title.
    Picture(String, Image),
}

impl Part {
    fn height(&self) -> u32 {
        match self {
            Self::Polar(polar) if !polar.has_lower_half => PANEL_SIZE.1 * 3 / 4,
            _ => PANEL_SIZE.1,
        }
    }
}

/// An SVG document with the panels side by side.
#[must_use]
pub fn draw(panels: &[Panel]) -> String {
    let parts: Vec<Part> = panels.iter().cloned().map(Part::Panel).collect();
    draw_rows(&parts, parts.len())
}

/// An SVG document with the parts in rows of `n_columns`.
#[must_use]
pub fn draw_rows(parts: &[Part], n_columns: usize) -> String {
    let layout = Layout::of(parts, n_columns);
    let mut text = String::new();
    layout.draw(parts, &SVGBackend::with_string(&mut text, layout.size).into_drawing_area());
    for (part, corner) in parts.iter().zip(&layout.corners) {
        if let Part::Picture(_, picture) = part
            && let (Some(png), Some(end)) = (png_bytes(picture), text.rfind("</svg>"))
        {
            let [x, y] = picture_corner(*corner, picture);
            let (w, h, data) = (picture.width, picture.height, base64(&png));
            let href = format!("data:image/png;base64,{data}");
            text.insert_str(
                end,
                &format!("<image x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" href=\"{href}\"/>\n"),
            );
        }
    }
    text
}

/// The same as a picture in linear light.
#[must_use]
pub fn rasterize_rows(parts: &[Part], n_columns: usize) -> Image {
    let layout = Layout::of(parts, n_columns);
    let (width, height) = layout.size;
    let mut pixels = vec![[1.0; 3]; width as usize * height as usize];
    layout.draw(parts, &Raster::new(&mut pixels, width as usize).into_drawing_area());
    let mut image = raster::image(pixels, width as usize);
    for (part, corner) in parts.iter().zip(&layout.corners) {
        if let Part::Picture(_, picture) = part {
            raster::paste(&mut image, picture, picture_corner(*corner, picture));
        }
    }
    image
}

/// Where a picture lies in a part: below the title, in the middle.
fn picture_corner([x, y]: [u32; 2], picture: &Image) -> [u32; 2] {
    let gap = |room: u32, size: usize| room.saturating_sub(size as u32) / 2;
    [x + gap(PANEL_SIZE.0, picture.width), y + gap(PANEL_SIZE.1, picture.height)]
}

/// Where the parts of a figure lie.
struct Layout {
    n_columns: usize,
    /// Upper left corner of each part in pixels.
    corners: Vec<[u32; 2]>,
    heights: Vec<u32>,
    size: (u32, u32),
}

impl Layout {
    fn of(parts: &[Part], n_columns: usize) -> Self {
        let n_columns = n_columns.max(1);
        let heights: Vec<u32> =
            parts.chunks(n_columns).map(|row| row.iter().map(Part::height).max().unwrap_or(0)).collect();
        let top = |row: usize| heights[..row].iter().sum::<u32>();
        let corner = |i: usize| [PANEL_SIZE.0 * (i % n_columns) as u32, top(i / n_columns)];
        let size = (PANEL_SIZE.0 * n_columns as u32, heights.iter().sum::<u32>().max(1));
        Self { n_columns, corners: (0..parts.len()).map(corner).collect(), heights, size }
    }

    fn draw<B: DrawingBackend>(&self, parts: &[Part], root: &Area<B>) {
        root.fill(&WHITE).expect(IN_MEMORY);
        for (i, part) in parts.iter().enumerate() {
            let (corner, size) = (self.corners[i], (PANEL_SIZE.0, self.heights[i / self.n_columns]));
            let area = root.clone().shrink((corner[0], corner[1]), size);
            match part {
                Part::Panel(panel) => panel.draw(&area),
                Part::Polar(polar) => polar.draw(&area),
                Part::Wires(wires) => wires.draw(&area),
                Part::Picture(title, _) => {
                    area.draw(&Text::new(title.as_str(), (16, 12), font(18))).expect(IN_MEMORY);
                }
            }
        }
        root.present().expect(IN_MEMORY);
    }
}

/// Grid lines of an axis: enough for nine in each of three decades.
const MAX_LINES: usize = 40;
/// Horizontal axes that span more have powers of ten for labels: others would run into each other.
const LABELLED_RANGE: f64 = 1e4;
const SUPERSCRIPTS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
/// Height of a panel within its axes in pixels.
const CURVES_HEIGHT: f64 = 421.0;
/// Height of a legend in the lower corner in pixels: its margins, and each name.
const LEGEND_HEIGHT: (f64, f64) = (26.0, 17.5);

/// Why drawing does not fail.
const IN_MEMORY: &str = "a string takes any drawing";

type Area<B> = DrawingArea<B, Shift>;

impl Panel {
    fn draw<B: DrawingBackend>(&self, area: &Area<B>) {
        let mut builder = ChartBuilder::on(area);
        builder.caption(&self.title, font(20)).margin(12).x_label_area_size(48).y_label_area_size(72);
        match self.axes {
            Axes::Logarithmic => {
                let [x, y] = [self.range(0), self.y_range.unwrap_or_else(|| self.y_range_with_legend())];
                let x_axis = (x[0]..x[1]).log_scale();
                let chart = builder.build_cartesian_2d(x_axis, (y[0]..y[1]).log_scale());
                self.fill(chart.expect(IN_MEMORY), y, [x_label(x), label]);
            }
            Axes::Linear(x) => {
                let y = self.y_range_from_0();
                let chart = builder.build_cartesian_2d(x[0]..x[1], y[0]..y[1]);
                self.fill(chart.expect(IN_MEMORY), y, [decimal; 2]);
            }
            Axes::SemiLogarithmic => {
                let [x, y] = [self.range(0), self.y_range_from_0()];
                let chart = builder.build_cartesian_2d((x[0]..x[1]).log_scale(), y[0]..y[1]);
                self.fill(chart.expect(IN_MEMORY), y, [x_label(x), decimal]);
            }
        }
    }

    fn fill<'b, B, X, Y>(
        &self,
        mut chart: ChartContext<'b, B, Cartesian2d<X, Y>>,
        y: [f64; 2],
        [x_label, y_label]: [fn(f64) -> String; 2],
    ) where
        B: DrawingBackend + 'b,
        X: Ranged<ValueType = f64> + ValueFormatter<f64>,
        Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
    {
        let is_linear = [matches!(self.axes, Axes::Linear(_)), self.axes != Axes::Logarithmic];
        let [x_lines, y_lines] = is_linear.map(|is_linear| if is_linear { 10 } else { MAX_LINES });
        chart
            .configure_mesh()
            .x_desc(&self.x_label)
            .y_desc(&self.y_label)
            .axis_desc_style(font(16))
            .label_style(font(14))
            .bold_line_style(BLACK.mix(0.12))
            .max_light_lines(0)
            .x_labels(x_lines)
            .y_labels(y_lines)
            .x_label_formatter(&once(x_label))
            .y_label_formatter(&once(y_label))
            .draw()
            .expect(IN_MEMORY);
        let colors = if self.palette == Palette::Apart { &COLORS[..] } else { &WAVELENGTH_COLORS };
        let mut n_colored = 0;
        for series in &self.series {
            n_colored += usize::from(series.mark != Mark::DashesAsBefore);
            let is_guide = series.mark == Mark::Dashes;
            let color = if is_guide { GUIDE_COLOR } else { colors[(n_colored.max(1) - 1) % colors.len()] };
            let style = color.stroke_width(if is_guide { 1 } else { 2 });
            let is_drawn = |p: &&[f64; 2]| (is_linear[0] || p[0] > 0.0) && p[1] >= y[0] && p[1] <= y[1];
            let points: Vec<(f64, f64)> =
                series.points.iter().filter(is_drawn).map(|p| (p[0], p[1])).collect();
            if series.mark == Mark::LineAndDots {
                let dots = points.iter().map(|p| Circle::new(*p, 3, color.filled()));
                chart.draw_series(dots).expect(IN_MEMORY);
            }
            let drawn = if is_guide || series.mark == Mark::DashesAsBefore {
                chart.draw_series(DashedLineSeries::new(points, 6, 4, style)).expect(IN_MEMORY)
            } else {
                chart.draw_series(LineSeries::new(points, style)).expect(IN_MEMORY)
            };
            if !series.name.is_empty() {
                // A dashed line shows one dash.
                let end = if series.mark == Mark::DashesAsBefore { 8 } else { 22 };
                drawn
                    .label(&series.name)
                    .legend(move |(x, y)| PathElement::new([(x, y), (x + end, y)], style));
            }
        }
        if self.series.iter().all(|series| series.name.is_empty()) {
            return;
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

    fn y_range_from_0(&self) -> [f64; 2] {
        self.y_range.unwrap_or_else(|| [0.0, self.range(1)[1]])
    }

    fn y_range_with_legend(&self) -> [f64; 2] {
        let [low, high] = self.range(1);
        match self.legend {
            Corner::LowerLeft => {
                let n_names = self.series.iter().filter(|series| !series.name.is_empty()).count() as f64;
                let names = LEGEND_HEIGHT.0 + LEGEND_HEIGHT.1 * n_names;
                let share = if n_names > 0.0 { names / (CURVES_HEIGHT - names).max(1.0) } else { 0.0 };
                [low * (low / high).powf(share), high]
            }
            Corner::UpperLeft | Corner::UpperRight => [low, high],
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
            Self::UpperLeft => SeriesLabelPosition::UpperLeft,
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

/// Labels of a horizontal axis with logarithms.
fn x_label([low, high]: [f64; 2]) -> fn(f64) -> String {
    if high / low > LABELLED_RANGE { power_of_ten } else { label }
}

/// The number of a grid line if it is a power of ten.
fn power_of_ten(value: f64) -> String {
    let exponent = value.log10();
    if (exponent - exponent.round()).abs() > 1e-6 {
        return String::new();
    }
    let digits = format!("{}", exponent.round()).replace('-', "⁻");
    let raised = digits.chars().map(|c| c.to_digit(10).map_or(c, |d| SUPERSCRIPTS[d as usize]));
    std::iter::once("10".to_owned()).chain(raised.map(String::from)).collect()
}

/// A number without exponent or trailing zeros.
fn decimal(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = (1.0 - value.abs().log10().floor()).max(0.0) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
