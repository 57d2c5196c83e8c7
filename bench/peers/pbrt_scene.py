"""Reads the subset of pbrt-v4 scene files that the compared scenes use, as plain directives with their transforms.

Every directive becomes a `Directive`: its keyword, its quoted type, its parameters by name, and the transform in force
(object to world after `WorldBegin`, world to camera before it). `Include` and instances are not read.
"""
import re
from dataclasses import dataclass, field

import numpy as np

TOKEN = re.compile(r'#[^\n]*|"([^"]*)"|(\[)|(\])|([^\s"\[\]#]+)')


@dataclass
class Parameter:
    """The type that the file declares, such as `rgb`, and the values: numbers or strings."""

    kind: str
    values: list


@dataclass
class Directive:
    """One statement of the file."""

    keyword: str
    arguments: list
    parameters: dict = field(default_factory=dict)
    transform: np.ndarray = None
    material: object = None
    area_light: object = None

    @property
    def type(self):
        """The first quoted argument: the type, or the name of a named material or texture."""
        return self.arguments[0] if self.arguments else ""

    def get(self, name, default=None):
        """The values of a parameter; one value comes without its list."""
        if name not in self.parameters:
            return default
        values = self.parameters[name].values
        return values[0] if len(values) == 1 else values


def tokens(text):
    """Strings as ('s', text), brackets and words as ('w', text)."""
    for match in TOKEN.finditer(text):
        if match.group(0).startswith("#"):
            continue
        yield ("s", match.group(1)) if match.group(1) is not None else ("w", match.group(0))


def statements(text):
    """Directives in the order of the file, without state."""
    stream = list(tokens(text))
    i = 0
    while i < len(stream):
        kind, keyword = stream[i]
        assert kind == "w", f"a directive is expected, not the string {keyword!r}"
        i += 1
        directive = Directive(keyword, [])
        while i < len(stream):
            kind, value = stream[i]
            if kind == "w" and value not in "[]" and re.match(r"[A-Za-z]", value):
                break
            if kind == "s" and " " in value.strip() and directive.keyword not in ("Texture",) or (
                kind == "s" and len(directive.arguments) >= 3 and " " in value.strip()
            ):
                declared, name = value.split()
                values, i = value_list(stream, i + 1)
                directive.parameters[name] = Parameter(declared, values)
                continue
            if kind == "s":
                directive.arguments.append(value)
                i += 1
                continue
            values, i = value_list(stream, i)
            directive.arguments.extend(values)
        yield directive


def value_list(stream, i):
    """One value, or the values in brackets, from token `i`; and the token after them."""

    def convert(token):
        kind, value = token
        if kind == "s" or value in ("true", "false"):
            return value if kind == "s" else value == "true"
        return float(value)

    if stream[i] != ("w", "["):
        return [convert(stream[i])], i + 1
    values, i = [], i + 1
    while stream[i] != ("w", "]"):
        values.append(convert(stream[i]))
        i += 1
    return values, i + 1


def look_at(eye, at, up):
    """World to camera; x to the right, y up, z along the view: left-handed, as in pbrt."""
    eye, at, up = (np.asarray(v, float) for v in (eye, at, up))
    z = (at - eye) / np.linalg.norm(at - eye)
    x = np.cross(up / np.linalg.norm(up), z)
    x /= np.linalg.norm(x)
    camera_to_world = np.eye(4)
    camera_to_world[:3, :4] = np.stack([x, np.cross(z, x), z, eye], axis=1)
    return np.linalg.inv(camera_to_world)


def read_scene(path):
    """All directives with the transform, the material and the area light that are in force at each."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    transform, material, area_light = np.eye(4), None, None
    stack, scene, named = [], [], {}
    for directive in statements(text):
        word, arguments = directive.keyword, directive.arguments
        if word == "Transform":
            transform = np.array(arguments, float).reshape(4, 4).T
        elif word == "ConcatTransform":
            transform = transform @ np.array(arguments, float).reshape(4, 4).T
        elif word == "Scale":
            transform = transform @ np.diag([*arguments, 1.0])
        elif word == "Translate":
            shift = np.eye(4)
            shift[:3, 3] = arguments
            transform = transform @ shift
        elif word == "LookAt":
            transform = transform @ look_at(arguments[0:3], arguments[3:6], arguments[6:9])
        elif word in ("AttributeBegin", "TransformBegin"):
            stack.append((word, transform, material, area_light))
        elif word in ("AttributeEnd", "TransformEnd"):
            begin, transform, *rest = stack.pop()
            if begin == "AttributeBegin":
                material, area_light = rest
        elif word == "WorldBegin":
            transform = np.eye(4)
        elif word == "MakeNamedMaterial":
            named[directive.type] = directive
        elif word == "NamedMaterial":
            material = directive.type
        elif word == "Material":
            material = directive
        elif word == "AreaLightSource":
            area_light = directive
        directive.transform, directive.material, directive.area_light = transform, material, area_light
        scene.append(directive)
    return scene, named


def with_settings(text, sampler, spp, depth):
    """The scene's text with a box filter, this sampler and this depth in place of its own."""
    for keyword in ("Sampler", "PixelFilter", "Integrator"):
        text = re.sub(rf'^{keyword}\s+"\w+"\s*((\s*"\w+ \w+"\s*(\[[^\]]*\]|[^\s\[\]]+))*)', "", text, flags=re.M)
    head = [
        f'Integrator "path" "integer maxdepth" [ {depth} ]',
        f'Sampler "{sampler}" "integer pixelsamples" [ {spp} ]',
        'PixelFilter "box" "float xradius" [ 0.5 ] "float yradius" [ 0.5 ]',
    ]
    return "\n".join([*head, text])
