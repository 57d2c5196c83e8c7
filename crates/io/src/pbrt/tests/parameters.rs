//! Parameter lists.

use etendue_math::{Normal3, Point2, Point3, Vector2, Vector3};
use etendue_scene::document::Value;
use etendue_spectrum::ColorSpaceName;

use super::{check_problem, problems, read, read_world, value};

#[track_caller]
fn check_value(written: &str, expected: &Value) {
    let document = read_world(&format!("Shape \"s\" {written}"));
    assert_eq!(value(&document.shapes[0].entity, "x"), expected, "{written}");
}

#[track_caller]
fn check_value_problem(written: &str, expected: &str) {
    check_problem(&format!("WorldBegin Shape \"s\"\n{written}\nShape \"t\""), expected);
}

/// Every declared type has its kind of value.
#[test]
fn all_types() {
    check_value("\"integer x\" 3", &Value::Integers(vec![3]));
    check_value("\"integer x\" [ -3 +4 ]", &Value::Integers(vec![-3, 4]));
    check_value("\"float x\" 3", &Value::Floats(vec![3.0]));
    check_value("\"float x\" [.5 -1e-3 5.]", &Value::Floats(vec![0.5, -1e-3, 5.0]));
    check_value(
        "\"point2 x\" [1 2 3 4]",
        &Value::Points2(vec![Point2::new(1.0, 2.0), Point2::new(3.0, 4.0)]),
    );
    check_value("\"vector2 x\" [1 2]", &Value::Vectors2(vec![Vector2::new(1.0, 2.0)]));
    let p = Value::Points3(vec![Point3::new(1.0, 2.0, 3.0)]);
    check_value("\"point3 x\" [1 2 3]", &p);
    check_value("\"point x\" [1 2 3]", &p);
    let v = Value::Vectors3(vec![Vector3::new(1.0, 2.0, 3.0)]);
    check_value("\"vector3 x\" [1 2 3]", &v);
    check_value("\"vector x\" [1 2 3]", &v);
    let n = Value::Normals3(vec![Normal3::new(1.0, 2.0, 3.0)]);
    check_value("\"normal x\" [1 2 3]", &n);
    check_value("\"normal3 x\" [1 2 3]", &n);
    check_value("\"bool x\" true", &Value::Bools(vec![true]));
    check_value("\"bool x\" [ false true ]", &Value::Bools(vec![false, true]));
    check_value("\"string x\" \"a b\"", &Value::Strings(vec!["a b".into()]));
    check_value("\"string x\" [ \"a\" \"b\" ]", &Value::Strings(vec!["a".into(), "b".into()]));
    check_value("\"rgb x\" [ .1 .2 .3 ]", &Value::Rgb(vec![[0.1, 0.2, 0.3]]));
    check_value("\"blackbody x\" 6500", &Value::Blackbody(vec![6500.0]));
    check_value("\"spectrum x\" \"metal-Au-eta\"", &Value::SpectrumNames(vec!["metal-Au-eta".into()]));
    check_value("\"spectrum x\" [ \"a.spd\" ]", &Value::SpectrumNames(vec!["a.spd".into()]));
    check_value("\"spectrum x\" [400 1 700 .5]", &Value::SpectrumSamples(vec![[400.0, 1.0], [700.0, 0.5]]));
    check_value("\"texture x\" \"wood\"", &Value::Texture("wood".into()));
    check_value("\"  float \t x \" 3", &Value::Floats(vec![3.0]));
    check_value("\"float x\" [ 1 # one\n 2 ]", &Value::Floats(vec![1.0, 2.0]));
}

/// Brackets may touch what stands beside them, and comments end with their line.
#[test]
fn no_blanks_are_needed() {
    let document = read_world("Shape\"s\"\"float x\"[1 2]\"bool y\"[true]#end\nShape \"t\"");
    assert_eq!(document.shapes.len(), 2);
    assert_eq!(document.shapes[0].entity.parameters.len(), 2);
}

/// Numbers of the wrong count are errors at the declaration.
#[test]
fn wrong_counts() {
    check_value_problem("\"rgb x\" [1 2]", "2:1: error: `x` has 2 numbers, which is no multiple of 3");
    check_value_problem("\"point3 x\" [1 2 3 4]", "2:1: error: `x` has 4 numbers, which is no multiple of 3");
    check_value_problem("\"point2 x\" [1 2 3]", "2:1: error: `x` has 3 numbers, which is no multiple of 2");
    check_value_problem(
        "\"spectrum x\" [400 1 500]",
        "2:1: error: `x` has 3 numbers, which is no multiple of 2",
    );
    check_value_problem("\"texture x\" [\"a\" \"b\"]", "2:1: error: `x` must name one texture, not 2");
    check_value_problem("\"float x\" [ ]", "2:1: error: this parameter has no values");
    check_value_problem(
        "\"spectrum x\" [500 1 400 2]",
        "2:1: error: the wavelengths of `x` must increase, but 400 follows 500",
    );
}

/// Values of the wrong kind are errors at the value.
#[test]
fn wrong_kinds() {
    check_value_problem("\"integer x\" 3.0", "2:13: error: `3.0` should be an integer (write 3)");
    check_value_problem("\"integer x\" [1 2.5]", "2:16: error: `2.5` should be an integer");
    check_value_problem(
        "\"integer x\" 3000000000",
        "2:13: error: `3000000000` does not fit an integer of 32 bits",
    );
    check_value_problem("\"float x\" true", "2:11: error: `true` should be a number");
    check_value_problem("\"float x\" [1 \"2\" 3]", "2:14: error: `\"2\"` should be a number");
    check_value_problem("\"float x\" 1e40", "2:11: error: `1e40` does not fit single precision");
    check_value_problem("\"bool x\" 1", "2:10: error: `1` should be `true` or `false`");
    check_value_problem("\"bool x\" \"true\"", "2:10: warning: write true without quotes");
    check_value_problem("\"string x\" 1", "2:12: error: `1` should be a string in quotes");
    check_value_problem("\"string x\" \"a\\qb\"", "2:12: error: `\\q` is no escape sequence");
}

/// Declarations are a known type and one name.
#[test]
fn wrong_declarations() {
    check_value_problem("\"flaot x\" 1", "2:1: error: there is no type `flaot` (did you mean `float`?)");
    check_value_problem("\"color x\" [1 1 1]", "2:1: error: there is no type `color` (did you mean `rgb`?)");
    check_value_problem("\"float x y\" 1", "2:1: error: \"float x y\" has more words than type and name");
    check_value_problem(
        "\"radius\" 1",
        "2:1: error: \"radius\" should be a type and the name of a parameter (for example \"float radius\")",
    );
    check_value_problem("\"float x\" 1 \"float x\" 2", "2:13: error: the parameter `x` is given twice");
    check_value_problem(
        "\"rgb x\" [1 1 1] \"texture x\" \"t\"",
        "2:17: warning: `x` is given as rgb and as texture: the last one counts",
    );
}

/// A value that was forgotten does not take the next declaration or directive with it.
#[test]
fn missing_values() {
    check_value_problem("\"float x\"", "2:1: error: this parameter has no value: `Shape` follows");
    check_value_problem(
        "\"float x\" \"float y\" 2",
        "2:1: error: this parameter has no value: `\"float y\"` follows",
    );
    check_value_problem("\"point3 x\" [1 2 3", "2:12: error: this `[` is not closed before `Shape`");
    check_value_problem(
        "\"float x\" [1 2 \"float y\" 2",
        "2:11: error: this `[` is not closed before `\"float y\"`",
    );
    check_problem(
        "WorldBegin Shape \"s\" \"float x\" [1",
        "1:32: error: this `[` is not closed before the end of the file",
    );
    check_value_problem(
        "\"float x\" 1 2",
        "2:13: error: a directive should stand here, not `2` (several values of a parameter need brackets)",
    );
}

/// One wrong parameter costs neither the others nor the shape.
#[test]
fn other_parameters_survive() {
    let text = "WorldBegin Shape \"s\" \"float a\" 1 \"foo b\" [1 2] \"float c\" x \"float d\" 4";
    let (document, _) = super::super::read_pbrt_str("t", text, std::path::Path::new(""));
    let names: Vec<_> = document.shapes[0].entity.parameters.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["a", "d"]);
    assert_eq!(problems(text).len(), 2);
}

/// Colours belong to the colour space that is current at their directive.
#[test]
fn color_spaces() {
    let document = read(
        "ColorSpace \"rec2020\" Film \"rgb\"
         WorldBegin Material \"diffuse\" \"rgb reflectance\" [1 0 0]
         AttributeBegin ColorSpace \"aces2065-1\" Attribute \"light\" \"rgb L\" [1 1 1]
         ColorSpace \"dci-p3\" LightSource \"point\" \"rgb I\" [1 1 1] AttributeEnd
         LightSource \"point\" \"rgb I\" [1 1 1]",
    );
    assert_eq!(document.film_color_space, ColorSpaceName::Rec2020);
    assert_eq!(document.materials[1].entity.parameters[0].color_space, ColorSpaceName::Rec2020);
    let spaces: Vec<_> = document.lights[0].entity.parameters.iter().map(|p| p.color_space).collect();
    assert_eq!(spaces, [ColorSpaceName::DciP3, ColorSpaceName::Aces2065_1]);
    assert_eq!(document.lights[1].entity.parameters[0].color_space, ColorSpaceName::Rec2020);
    check_problem(
        "ColorSpace \"cmyk\" WorldBegin",
        "1:12: error: there is no colour space `cmyk` (there are: srgb, dci-p3, rec2020, aces2065-1)",
    );
}
