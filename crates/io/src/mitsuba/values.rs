//! Values of properties: numbers, colours, spectra, transforms.

use etendue_math::{Point3, Transform, Vector3};
use etendue_scene::Diagnostics;
use etendue_scene::document::Value;

use super::element::{Attribute, Element};

/// Numbers between commas or white space; what is none, or not finite, is reported.
pub(super) fn numbers(attribute: &Attribute, diagnostics: &mut Diagnostics) -> Option<Vec<f32>> {
    let words = attribute.value.split([' ', ',', '\t', '\n', '\r']).filter(|word| !word.is_empty());
    let mut numbers = Vec::new();
    for word in words {
        match word.parse::<f32>() {
            Ok(number) if number.is_finite() => numbers.push(number),
            _ => {
                diagnostics.error(attribute.span, format!("`{word}` is not a number"));
                return None;
            }
        }
    }
    Some(numbers)
}

/// The one number of an attribute.
pub(super) fn number(attribute: &Attribute, diagnostics: &mut Diagnostics) -> Option<f32> {
    match numbers(attribute, diagnostics)?.as_slice() {
        [number] => Some(*number),
        list => {
            let message = format!("this should be one number, not {}", list.len());
            diagnostics.error(attribute.span, message);
            None
        }
    }
}

/// Three numbers from `value="1 2 3"`, one number for all of them, or `x`, `y` and `z`, which are `default` if absent.
pub(super) fn triple(element: &Element, default: f32, diagnostics: &mut Diagnostics) -> Option<[f32; 3]> {
    if let Some(value) = element.attribute("value") {
        return triple_of(value, diagnostics);
    }
    let mut triple = [default; 3];
    for (slot, axis) in triple.iter_mut().zip(["x", "y", "z"]) {
        if let Some(attribute) = element.attribute(axis) {
            *slot = number(attribute, diagnostics)?;
        }
    }
    Some(triple)
}

/// Three numbers, or one for all three.
pub(super) fn triple_of(attribute: &Attribute, diagnostics: &mut Diagnostics) -> Option<[f32; 3]> {
    match numbers(attribute, diagnostics)?.as_slice() {
        [x] => Some([*x; 3]),
        [x, y, z] => Some([*x, *y, *z]),
        list => {
            let message = format!("this should be three numbers, not {}", list.len());
            diagnostics.error(attribute.span, message);
            None
        }
    }
}

/// A colour: three numbers, one, or `#rrggbb`, whose digits are encoded as in sRGB, as is all of `<srgb>`.
pub(super) fn color(element: &Element, diagnostics: &mut Diagnostics) -> Option<[f32; 3]> {
    let Some(value) = element.attribute("value") else {
        diagnostics.error(element.span, "this colour has no `value`");
        return None;
    };
    let Some(digits) = value.value.trim().strip_prefix('#') else {
        let rgb = triple_of(value, diagnostics)?;
        return Some(if element.tag == "srgb" { rgb.map(linear) } else { rgb });
    };
    let bits = u32::from_str_radix(digits, 16).ok().filter(|_| digits.len() == 6);
    if bits.is_none() {
        diagnostics.error(value.span, "a colour with `#` has six hexadecimal digits");
    }
    let bits = bits?;
    Some([16, 8, 0].map(|shift| linear((bits >> shift & 0xff) as f32 / 255.0)))
}

/// The linear value of one that is encoded as in sRGB.
fn linear(encoded: f32) -> f32 {
    etendue_image::srgb_decode(encoded)
}

/// A spectrum from `value` or `filename`.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum SpectrumValue {
    /// The same at all wavelengths.
    Constant(f32),
    /// Wavelengths in nanometres with values.
    Samples(Vec<[f32; 2]>),
    /// A file of measurements.
    File(String),
}

impl SpectrumValue {
    /// As the value of a reflectance or a coefficient.
    pub(super) fn into_value(self) -> Value {
        match self {
            Self::Constant(value) => Value::Rgb(vec![[value; 3]]),
            Self::Samples(samples) => Value::SpectrumSamples(samples),
            Self::File(name) => Value::SpectrumNames(vec![name]),
        }
    }
}

/// The spectrum of `value="400:0.1, 500:0.2"` or of one number.
pub(super) fn spectrum(attribute: &Attribute, diagnostics: &mut Diagnostics) -> Option<SpectrumValue> {
    if !attribute.value.contains(':') {
        return number(attribute, diagnostics).map(SpectrumValue::Constant);
    }
    let mut samples: Vec<[f32; 2]> = Vec::new();
    for pair in attribute.value.split([' ', ',', '\t', '\n', '\r']).filter(|word| !word.is_empty()) {
        let numbers = pair.split_once(':').and_then(|(lambda, value)| {
            let pair = [lambda.trim().parse::<f32>().ok()?, value.trim().parse::<f32>().ok()?];
            pair.iter().all(|x| x.is_finite()).then_some(pair)
        });
        let Some(numbers) = numbers else {
            let message = format!("`{pair}` is not a wavelength and a value as in `500:0.2`");
            diagnostics.error(attribute.span, message);
            return None;
        };
        if samples.last().is_some_and(|last| last[0] >= numbers[0]) {
            let message = format!("the wavelength {} is not above the one before", numbers[0]);
            diagnostics.error(attribute.span, message);
            return None;
        }
        samples.push(numbers);
    }
    Some(SpectrumValue::Samples(samples))
}

/// The product of all steps of a `<transform>`: each acts after those before it.
pub(super) fn transform(element: &Element, diagnostics: &mut Diagnostics) -> Transform {
    let mut product = Transform::IDENTITY;
    for step in &element.children {
        if let Some(step) = transform_step(step, diagnostics) {
            product = step * product;
        }
    }
    product
}

fn transform_step(step: &Element, diagnostics: &mut Diagnostics) -> Option<Transform> {
    let transform = match step.tag.as_str() {
        "translate" => Some(Transform::translate(vector(triple(step, 0.0, diagnostics)?))),
        "scale" => {
            let [x, y, z] = triple(step, 1.0, diagnostics)?;
            Transform::scale(x, y, z)
        }
        "rotate" => {
            let axis = vector(triple(step, 0.0, diagnostics)?);
            let angle = step.attribute("angle").map_or(Some(0.0), |angle| number(angle, diagnostics))?;
            Transform::rotate(angle.to_radians(), axis)
        }
        "lookat" => return look_at(step, diagnostics),
        "matrix" => return matrix(step, diagnostics),
        other => {
            let known = ["translate", "scale", "rotate", "lookat", "matrix"];
            diagnostics.unknown_name(step.span, "step of a transform", other, known);
            return None;
        }
    };
    if transform.is_none() {
        diagnostics.error(step.span, format!("this `{}` has no inverse", step.tag));
    }
    transform
}

/// The view of Mitsuba's cameras and lights: +z ahead, +y up, +x to the left.
fn look_at(step: &Element, diagnostics: &mut Diagnostics) -> Option<Transform> {
    let mut read = |name: &str, default: [f32; 3]| {
        step.attribute(name).map_or(Some(default), |attribute| triple_of(attribute, diagnostics))
    };
    let origin = read("origin", [0.0; 3])?;
    let target = read("target", [0.0, 0.0, 1.0])?;
    let [x, y, z] = read("up", [0.0, 1.0, 0.0])?;
    let [origin, target] = [origin, target].map(|[x, y, z]| Point3::new(x, y, z));
    let ahead = (target - origin).try_normalized();
    // Without a usable `up` any will do.
    let up = match ahead {
        Some(ahead) if Vector3::new(x, y, z).cross(ahead).length_squared() <= 1e-12 => {
            let other =
                if ahead.x.abs() < 0.9 { Vector3::new(1.0, 0.0, 0.0) } else { Vector3::new(0.0, 1.0, 0.0) };
            if step.attribute("up").is_some() {
                diagnostics.warning(step.span, "`up` is along the view; another direction is taken");
            }
            other
        }
        _ => Vector3::new(x, y, z),
    };
    let camera_from_world = Transform::look_at(origin, target, up);
    if camera_from_world.is_none() {
        diagnostics.error(step.span, "`origin` and `target` must differ");
    }
    Some(camera_from_world?.inverse())
}

fn matrix(step: &Element, diagnostics: &mut Diagnostics) -> Option<Transform> {
    let Some(value) = step.attribute("value") else {
        diagnostics.error(step.span, "this matrix has no `value`");
        return None;
    };
    let m = numbers(value, diagnostics)?;
    let rows: [[f32; 4]; 4] = match m.len() {
        16 => std::array::from_fn(|row| std::array::from_fn(|column| m[4 * row + column])),
        9 => {
            let affine = |row: usize, column: usize| match (row, column) {
                (0..3, 0..3) => m[3 * row + column],
                (3, 3) => 1.0,
                _ => 0.0,
            };
            std::array::from_fn(|row| std::array::from_fn(|column| affine(row, column)))
        }
        n => {
            diagnostics.error(value.span, format!("a matrix has 16 or 9 numbers, not {n}"));
            return None;
        }
    };
    let transform = Transform::from_rows(rows);
    if transform.is_none() {
        diagnostics.error(value.span, "this matrix has no inverse");
    }
    transform
}

pub(super) fn vector([x, y, z]: [f32; 3]) -> Vector3 {
    Vector3::new(x, y, z)
}
