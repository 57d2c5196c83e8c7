//! An exploration as table, picture and page.

use std::fmt::Write;

use etendue_image::Image;

use super::figure::{N_COLUMNS, parts};
use super::{Curve, Exploration};
use crate::plot::{draw_rows, rasterize_rows};

impl Exploration {
    /// All curves, one value in a line: which plot, which curve, angle in degrees, value.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut text = String::from("plot,curve,angle_deg,value\n");
        let mut add = |plot: &str, curve: &str, points: &[[f64; 2]]| {
            let curve = curve.replace(',', "");
            for [angle, value] in points {
                let _ = writeln!(text, "{plot},{curve},{angle},{value:.6e}");
            }
        };
        for lobe in &self.lobes {
            let name = format!("incidence {}", lobe.incidence_deg);
            add("lobe", &name, &lobe.points);
            add("specular", &name, &lobe.spikes);
        }
        for Curve { name, points } in &self.albedo {
            add("albedo", name, points);
        }
        for interface in &self.fresnel {
            for Curve { name, points } in &interface.curves {
                add(&format!("fresnel {}", interface.place), name, points);
            }
        }
        for histogram in &self.histograms {
            for curve in [&histogram.samples, &histogram.pdf] {
                add(histogram.angle, &curve.name, &curve.points);
            }
        }
        text
    }

    /// All plots in one picture.
    #[must_use]
    pub fn svg(&self) -> String {
        draw_rows(&parts(self), N_COLUMNS)
    }

    /// The same as pixels, in linear light.
    #[must_use]
    pub fn image(&self) -> Image {
        rasterize_rows(&parts(self), N_COLUMNS)
    }

    /// The laws as lines of text.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = self.title();
        text.push('\n');
        for line in &self.laws {
            let verdict = if line.is_kept { "kept  " } else { "BROKEN" };
            let _ = writeln!(text, "  {:<12} {verdict}  {}: {}", line.law.name(), line.what, line.measured);
        }
        for remark in &self.remarks {
            let _ = writeln!(text, "  {remark}");
        }
        text
    }

    fn title(&self) -> String {
        let model = if self.name == self.model {
            self.model.clone()
        } else {
            format!("{} ({})", self.name, self.model)
        };
        let parameters: Vec<String> =
            self.parameters.iter().map(|(name, value)| format!("{name} = {value}")).collect();
        if parameters.is_empty() { model } else { format!("{model}: {}", parameters.join(", ")) }
    }

    /// One page with everything in it, that needs no other file.
    #[must_use]
    pub fn html(&self) -> String {
        let title = escaped(&self.title());
        let mut page = format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{title}</title>\n\
             <style>{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n"
        );
        page.push_str("<table>\n<tr><th>law</th><th>measured</th><th></th><th></th></tr>\n");
        for line in &self.laws {
            let (class, verdict) = if line.is_kept { ("kept", "kept") } else { ("broken", "broken") };
            let _ = writeln!(
                page,
                "<tr class=\"{class}\"><td>{}</td><td>{}</td><td>{}</td><td>{verdict}</td></tr>",
                line.law.name(),
                line.what,
                escaped(&line.measured)
            );
        }
        page.push_str("</table>\n");
        for remark in &self.remarks {
            let _ = writeln!(page, "<p>{}</p>", escaped(remark));
        }
        page.push_str(
            "<p>Lobes: light arrives along the orange line; the blue curve is f |cos| in the plane of incidence, the \
             mean over wavelengths, with the value of each ring beside it; green lines are mirror directions with \
             their share of the light.</p>\n",
        );
        page.push_str(&self.svg());
        page.push_str("\n</body>\n</html>\n");
        page
    }
}

const STYLE: &str = "body{font-family:sans-serif;max-width:1920px;margin:1em auto;padding:0 1em}\
    table{border-collapse:collapse}\
    td,th{text-align:left;padding:.3em .8em;border-bottom:1px solid #ccc}.broken td{color:#b00;font-weight:bold}\
    svg{width:100%;height:auto}";

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
