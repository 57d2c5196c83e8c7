//! Errors, their places, and how reading goes on after them.

use super::{check_problem, problems};

/// A misspelt directive is reported with what was probably meant.
#[test]
fn unknown_directives() {
    check_problem(
        "WorldBegin\n  Shpae \"sphere\" \"float radius\" 1\nShape \"sphere\"",
        "2:3: error: unknown directive `Shpae` (did you mean `Shape`?)",
    );
    check_problem("Zzzzzzzzzzzzz WorldBegin", "1:1: error: unknown directive `Zzzzzzzzzzzzz`");
    check_problem(
        "WorldBegin WorldEnd",
        "1:12: error: pbrt-v4 has no directive `WorldEnd` (pbrt-v4 ends the world with the file: remove `WorldEnd`)",
    );
}

/// One run reports all errors, each at its line and column.
#[test]
fn all_errors_at_once() {
    let text = "Film \"rgb\" \"integer xresolution\" 10.5
Samplr \"halton\"
LookAt 0 0 x  0 0 0  0 1 0
WorldBegin
Translate 1 2
Material diffuse
AttributeBegin
Shape \"sphere\" \"float radius\" [ 1
Texture \"t\" \"color\" \"constant\"
ObjectEnd
\"stray\"
Rotate 1 0 0 0
# für Umlaute zählt die Spalte Zeichen
Shape \"ü\" \"strin g\" 1";
    let expected = [
        "1:34: error: `10.5` should be an integer",
        "2:1: error: unknown directive `Samplr` (did you mean `Sampler`?)",
        "3:12: error: `LookAt` needs 9 numbers: `x` is none",
        "5:1: error: `Translate` needs 3 numbers, but `Material` follows",
        "6:10: error: `Material` needs a type in quotes, not `diffuse`",
        "8:31: error: this `[` is not closed before `Texture`",
        "9:13: error: textures yield \"float\" or \"spectrum\", not \"color\" (write \"spectrum\")",
        "10:1: error: `ObjectEnd` inside of an open `AttributeBegin`",
        "11:1: error: a directive should stand here, not `\"stray\"`",
        "12:1: error: the transform of this `Rotate` has no inverse",
        "14:11: error: there is no type `strin` (did you mean `string`?)",
        "7:1: error: this `AttributeBegin` has no `AttributeEnd`",
    ];
    assert_eq!(problems(text), expected);
}

/// Options come before the world and its contents after `WorldBegin`.
#[test]
fn directives_in_the_wrong_place() {
    for directive in ["Camera", "Film", "Sampler", "PixelFilter", "Integrator", "Accelerator"] {
        let expected = format!("1:12: error: `{directive}` must stand before `WorldBegin`");
        check_problem(&format!("WorldBegin {directive} \"x\""), &expected);
    }
    check_problem("WorldBegin WorldBegin", "1:12: error: there is a `WorldBegin` before this one");
    check_problem(
        "WorldBegin TransformTimes 0 1",
        "1:12: error: `TransformTimes` must stand before `WorldBegin`",
    );
    let world = [
        "Shape",
        "Material",
        "LightSource",
        "AreaLightSource",
        "NamedMaterial",
        "MakeNamedMaterial",
        "ObjectInstance",
        "ObjectBegin",
        "Texture",
        "Import",
    ];
    for directive in world {
        let expected = format!("1:1: error: `{directive}` must stand after `WorldBegin`");
        check_problem(&format!("{directive} \"x\" WorldBegin"), &expected);
    }
    for directive in ["ReverseOrientation", "AttributeBegin", "AttributeEnd", "ObjectEnd", "TransformBegin"] {
        let expected = format!("1:1: error: `{directive}` must stand after `WorldBegin`");
        check_problem(&format!("{directive} WorldBegin"), &expected);
    }
}

/// Without `WorldBegin` there is one error, not one for each shape.
#[test]
fn missing_world_begin() {
    check_problem("Film \"rgb\"\n", "2:1: error: the file ends before `WorldBegin`");
    check_problem("", "1:1: error: the file ends before `WorldBegin`");
    check_problem("Shape \"a\" Shape \"b\"", "1:1: error: `Shape` must stand after `WorldBegin`");
}

/// Blocks must nest.
#[test]
fn blocks_must_nest() {
    check_problem(
        "WorldBegin\nAttributeEnd",
        "2:1: error: `AttributeEnd` without a matching `AttributeBegin`",
    );
    check_problem(
        "WorldBegin\nTransformEnd",
        "2:1: error: `TransformEnd` without a matching `AttributeBegin`",
    );
    check_problem("WorldBegin\nObjectEnd", "2:1: error: `ObjectEnd` without a matching `ObjectBegin`");
    check_problem("WorldBegin ObjectBegin \"o\"", "1:12: error: this `ObjectBegin` has no `ObjectEnd`");
    check_problem(
        "WorldBegin AttributeBegin ObjectBegin \"o\" AttributeEnd Shape \"s\"",
        "1:43: error: `AttributeEnd` inside of an open `ObjectBegin`",
    );
    check_problem(
        "WorldBegin ObjectBegin \"o\" ObjectBegin \"p\" ObjectEnd ObjectEnd",
        "1:28: error: `ObjectBegin` inside of an object definition",
    );
    check_problem(
        "WorldBegin ObjectBegin \"o\" ObjectInstance \"p\" ObjectEnd",
        "1:43: error: `ObjectInstance` inside of an object definition",
    );
}

/// Names are defined once.
#[test]
fn names_are_defined_once() {
    check_problem(
        "WorldBegin ObjectBegin \"o\" ObjectEnd ObjectBegin \"o\" ObjectEnd",
        "1:50: error: the object `o` is defined twice",
    );
    let material = "MakeNamedMaterial \"m\" \"string type\" \"diffuse\"";
    check_problem(
        &format!("WorldBegin {material}\n{material}"),
        "2:19: error: the material `m` is defined twice",
    );
    let medium = "MakeNamedMedium \"m\" \"string type\" \"homogeneous\"";
    check_problem(&format!("WorldBegin {medium}\n{medium}"), "2:17: error: the medium `m` is defined twice");
    let texture = "Texture \"t\" \"float\" \"constant\"";
    check_problem(
        &format!("WorldBegin {texture}\n{texture}"),
        "2:9: error: the texture `t` is defined twice",
    );
}

/// Arguments of directives are checked.
#[test]
fn wrong_arguments() {
    check_problem("Scale 1 0 1 WorldBegin", "1:1: error: the transform of this `Scale` has no inverse");
    check_problem(
        "LookAt 0 0 0 0 0 0 0 1 0 WorldBegin",
        "1:1: error: the transform of this `LookAt` has no inverse",
    );
    let zero = "0 ".repeat(16);
    check_problem(
        &format!("Transform [ {zero} ] WorldBegin"),
        "1:1: error: the transform of this `Transform` has no inverse",
    );
    check_problem(
        "Transform 1 WorldBegin",
        "1:11: error: `Transform` needs `[` before its 16 numbers, not `1`",
    );
    check_problem("Transform [ 1 ] WorldBegin", "1:15: error: `Transform` needs 16 numbers: `]` is none");
    let many = "1 ".repeat(17);
    check_problem(
        &format!("Transform [ {many} ] WorldBegin"),
        "1:45: error: `Transform` needs `]` after its 16 numbers, not `1`",
    );
    check_problem(
        "ActiveTransform Endtime WorldBegin",
        "1:17: error: `ActiveTransform` has no choice `Endtime` (did you mean `EndTime`?)",
    );
    check_problem("TransformTimes 1 1 WorldBegin", "1:1: error: the end time must be after the start time");
    check_problem(
        "WorldBegin Attribute \"lamp\" \"float x\" 1",
        "1:22: error: `Attribute` has no target `lamp` (the targets are: shape, light, material, medium, texture)",
    );
    check_problem(
        "WorldBegin MakeNamedMaterial \"m\" \"float eta\" 1",
        "1:30: error: `m` has no parameter \"string type\"",
    );
    check_problem(
        "WorldBegin MakeNamedMaterial \"m\" \"string type\" [ \"a\" \"b\" ]",
        "1:34: error: the parameter `type` must be one string",
    );
    check_problem("Option \"seed\" foo WorldBegin", "1:15: error: `foo` is no value of an option");
    check_problem(
        "Option \"seed\" WorldBegin",
        "1:1: error: `Option` needs a value, but `WorldBegin` follows",
    );
    check_problem("WorldBegin Shape", "1:12: error: `Shape` needs a type, but the end of the file follows");
}

/// A string ends on its line.
#[test]
fn unterminated_strings() {
    check_problem(
        "WorldBegin Shape \"sphere\nShape \"disk\"",
        "1:18: error: this string has no closing quote",
    );
    check_problem("WorldBegin Shape \"a\" \"float x", "1:22: error: this string has no closing quote");
    check_problem("WorldBegin \"abc", "1:12: error: this string has no closing quote");
    check_problem("WorldBegin Shape \"a\\", "1:18: error: this string has no closing quote");
}

/// Garbage does not make millions of messages.
#[test]
fn garbage_ends_soon() {
    let found = problems(&"Xabcdef ".repeat(10_000));
    assert_eq!(found.len(), 201);
    assert!(found[200].ends_with("too many problems: the rest is not read"), "{}", found[200]);
}
