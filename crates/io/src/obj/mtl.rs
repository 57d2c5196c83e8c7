//! Libraries of materials (`.mtl`): what each says, with its place. Besides the classic statements those of the PBR extension
//! (`Pr Pm Pc Pcr Ps aniso`, as exporters write them since 2015) are read.

use etendue_scene::diagnostics::FileId;
use etendue_scene::{Diagnostics, Span};

use super::parse::{name_after, rest_of};

/// Problems of a library that are reported one by one.
const MAX_PROBLEMS: usize = 100;

/// Materials of a library.
const MAX_MATERIALS: usize = 1_000_000;

/// A picture with its options.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Map {
    /// As written, with slashes.
    pub(super) file: String,
    /// `-s`: repetitions along u and v.
    pub(super) scale: [f32; 2],
    /// `-o`: shift along u and v.
    pub(super) offset: [f32; 2],
    /// `-clamp on`.
    pub(super) is_clamped: bool,
    /// `-bm`: factor of heights.
    pub(super) bump: f32,
    pub(super) span: Span,
}

/// A number or colour with its place.
pub(super) type Placed<T> = Option<(T, Span)>;

/// A material as written.
#[derive(Clone, Debug)]
pub(super) struct Mtl {
    pub(super) name: String,
    pub(super) span: Span,
    pub(super) kd: Placed<[f32; 3]>,
    pub(super) ks: Placed<[f32; 3]>,
    pub(super) ke: Placed<[f32; 3]>,
    pub(super) tf: Placed<[f32; 3]>,
    /// Numbers by keyword: `Ns Ni d illum Pr Pm Ps Pc Pcr aniso`.
    pub(super) numbers: Vec<(&'static str, f32, Span)>,
    /// Pictures by keyword in lower case, without `map_`.
    pub(super) maps: Vec<(&'static str, Map)>,
}

impl Mtl {
    /// The number of a keyword.
    pub(super) fn number(&self, keyword: &str) -> Placed<f32> {
        self.numbers.iter().rev().find(|(name, ..)| *name == keyword).map(|(_, value, span)| (*value, *span))
    }

    /// The picture of a keyword.
    pub(super) fn map(&self, keyword: &str) -> Option<&Map> {
        self.maps.iter().rev().find(|(name, _)| *name == keyword).map(|(_, map)| map)
    }
}

const NUMBERS: [&str; 10] = ["Ns", "Ni", "d", "illum", "Pr", "Pm", "Ps", "Pc", "Pcr", "aniso"];
/// Keywords of pictures with the name that they have here.
const MAPS: [(&str, &str); 18] = [
    ("map_kd", "kd"),
    ("map_ks", "ks"),
    ("map_ke", "ke"),
    ("map_ns", "ns"),
    ("map_d", "d"),
    ("map_opacity", "d"),
    ("map_pr", "pr"),
    ("map_pm", "pm"),
    ("map_bump", "bump"),
    ("bump", "bump"),
    ("norm", "norm"),
    ("map_kn", "norm"),
    ("map_ka", "unused"),
    ("map_ps", "unused"),
    ("map_aat", "unused"),
    ("map_tr", "tr"),
    ("disp", "disp"),
    ("decal", "decal"),
];
/// Statements that mean nothing here: ambient light, sharpness of reflections, orientation of brushes.
const SKIPPED: [&str; 7] = ["Ka", "Km", "sharpness", "anisor", "Pa", "map_RMA", "map_ORM"];

/// Reads a library; problems have places in `file`.
pub(super) fn parse(text: &str, file: FileId, diagnostics: &mut Diagnostics) -> Vec<Mtl> {
    let mut materials: Vec<Mtl> = Vec::new();
    let mut start = 0;
    let mut n_problems = 0;
    for line in text.split_inclusive('\n') {
        let end = start + line.trim_end().len();
        let span = Span { file, start: start as u32, end: end as u32 };
        start += line.len();
        let content = line.split('#').next().unwrap_or_default();
        let Some(keyword) = content.split_ascii_whitespace().next() else { continue };
        let is_map = || MAPS.iter().any(|(known, _)| known.eq_ignore_ascii_case(keyword));
        let is_named = keyword == "newmtl" || is_map();
        let rest = if is_named { name_after(line, keyword) } else { rest_of(content, keyword) };
        let mut problems = Diagnostics::default();
        if keyword == "newmtl" {
            if materials.len() >= MAX_MATERIALS {
                diagnostics.error(span, format!("the library has more than {MAX_MATERIALS} materials"));
                break;
            }
            materials.push(empty(rest, span));
        } else if let Some(material) = materials.last_mut() {
            statement(material, keyword, rest, span, &mut problems);
        } else {
            problems.warning(span, "this stands before any `newmtl`; it is skipped");
        }
        if problems.list().is_empty() {
            continue;
        }
        n_problems += 1;
        // An error must not go unheard, however many warnings came before it; it ends what is of use here.
        let is_error = problems.has_errors();
        if n_problems <= MAX_PROBLEMS || is_error {
            diagnostics.append(problems);
        }
        if n_problems == MAX_PROBLEMS {
            diagnostics.warning(span, "there are more problems in this library; they are not reported");
        }
        if n_problems >= MAX_PROBLEMS && is_error {
            break;
        }
    }
    materials
}

fn empty(name: &str, span: Span) -> Mtl {
    Mtl {
        name: name.to_owned(),
        span,
        kd: None,
        ks: None,
        ke: None,
        tf: None,
        numbers: Vec::new(),
        maps: Vec::new(),
    }
}

fn statement(material: &mut Mtl, keyword: &str, rest: &str, span: Span, diagnostics: &mut Diagnostics) {
    let lower = keyword.to_ascii_lowercase();
    let color = match lower.as_str() {
        "kd" => Some(&mut material.kd),
        "ks" => Some(&mut material.ks),
        "ke" => Some(&mut material.ke),
        "tf" => Some(&mut material.tf),
        _ => None,
    };
    if let Some(slot) = color {
        if let Some(value) = read_color(rest, span, diagnostics) {
            *slot = Some((value, span));
        }
    } else if let Some(known) = NUMBERS.iter().find(|known| known.eq_ignore_ascii_case(keyword)) {
        // `d -halo 0.5` depends on the angle; what it says along the normal is taken.
        let word = rest.split_ascii_whitespace().next_back();
        if let Some(value) = number(word, span, diagnostics) {
            material.numbers.push((known, value, span));
        }
    } else if lower == "tr" {
        let word = rest.split_ascii_whitespace().next_back();
        if let Some(value) = number(word, span, diagnostics) {
            material.numbers.push(("d", 1.0 - value, span));
        }
    } else if let Some((_, kind)) = MAPS.iter().find(|(known, _)| *known == lower) {
        if let Some(map) = read_map(rest, span, diagnostics) {
            material.maps.push((kind, map));
        }
    } else if !SKIPPED.iter().any(|known| known.eq_ignore_ascii_case(keyword)) {
        let shown: String = keyword.chars().take(20).collect();
        diagnostics.warning(span, format!("`{shown}` is not known in materials; it is skipped"));
    }
}

fn number(word: Option<&str>, span: Span, diagnostics: &mut Diagnostics) -> Option<f32> {
    let value = word.and_then(|word| word.parse().ok()).filter(|value: &f32| value.is_finite());
    if value.is_none() {
        diagnostics.error(span, format!("`{}` is not a number", word.unwrap_or_default()));
    }
    value
}

/// One number for all components, or three. `xyz` and `spectral` are left out.
fn read_color(rest: &str, span: Span, diagnostics: &mut Diagnostics) -> Option<[f32; 3]> {
    let words: Vec<&str> = rest.split_ascii_whitespace().collect();
    match words[..] {
        ["spectral" | "xyz", ..] => {
            diagnostics.warning(span, "colours are three numbers here; this one is skipped");
            None
        }
        [x] => number(Some(x), span, diagnostics).map(|x| [x; 3]),
        [r, g, b, ..] => {
            let mut number = |word| number(Some(word), span, diagnostics);
            Some([number(r)?, number(g)?, number(b)?])
        }
        _ => {
            diagnostics.error(span, "a colour has three numbers");
            None
        }
    }
}

/// Options, then the name of a file, which may have spaces.
fn read_map(rest: &str, span: Span, diagnostics: &mut Diagnostics) -> Option<Map> {
    let mut map =
        Map { file: String::new(), scale: [1.0; 2], offset: [0.0; 2], is_clamped: false, bump: 1.0, span };
    let mut rest = rest;
    while let Some(option) = rest.split_ascii_whitespace().next().filter(|word| word.starts_with('-')) {
        rest = rest_of(rest, option);
        let (least, most) = match option {
            "-s" | "-o" | "-t" => (1, 3),
            "-mm" => (2, 2),
            "-blendu" | "-blendv" | "-clamp" | "-cc" | "-bm" | "-boost" | "-texres" | "-imfchan"
            | "-type" => (1, 1),
            _ => {
                diagnostics
                    .warning(span, format!("the option `{option}` is not known; the picture is skipped"));
                return None;
            }
        };
        let mut words = Vec::new();
        while words.len() < most {
            let Some(word) = rest.split_ascii_whitespace().next() else { break };
            // Optional numbers end where the name of the file begins.
            if words.len() >= least && word.parse::<f32>().is_err() {
                break;
            }
            words.push(word);
            rest = rest_of(rest, word);
        }
        let numbers: Vec<f32> =
            words.iter().filter_map(|word| word.parse().ok()).filter(|x: &f32| x.is_finite()).collect();
        match (option, &numbers[..]) {
            ("-s", [u, rest @ ..]) => map.scale = [*u, rest.first().copied().unwrap_or(*u)],
            ("-o", [u, rest @ ..]) => map.offset = [*u, rest.first().copied().unwrap_or(0.0)],
            ("-bm", [bump]) => map.bump = *bump,
            ("-clamp", _) => map.is_clamped = words == ["on"],
            _ => {}
        }
    }
    map.file = rest.trim().trim_matches('"').replace('\\', "/");
    if map.file.is_empty() {
        diagnostics.error(span, "the name of a file is missing");
        return None;
    }
    Some(map)
}
