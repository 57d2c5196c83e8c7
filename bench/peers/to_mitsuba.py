"""Translates a pbrt-v4 scene, as `pbrt_scene` reads it, to a dictionary for Mitsuba 3.

Same camera, same film, same lights. Materials have equal meaning; three have no exact twin:
`coateddiffuse` (a random walk between layers) becomes `roughplastic` with the same roughness and index, or `plastic`
where it is smooth; the colours of metals are RGB triples there and spectra here; the equal-area picture of a sky is
resampled to a latitude-longitude map. So each renderer is compared with its own reference.
"""
import os
import tempfile

import mitsuba as mi
import numpy as np

from pbrt_scene import read_scene

FLIP_X = np.diag([-1.0, 1.0, 1.0, 1.0])
# Rows of pbrt's textures are counted from the bottom, those of Mitsuba from the top.
FLIP_V = np.array([[1.0, 0, 0, 0], [0, -1, 0, 1], [0, 0, 1, 0], [0, 0, 0, 1]])


def translate(path, resolution, spp, settings):
    """The dictionary. `settings` has `sampler`, `depth` (scattering events) and `rr_depth`."""
    directives, named = read_scene(path)
    folder = os.path.dirname(os.path.abspath(path))
    textures = {d.type: d for d in directives if d.keyword == "Texture"}
    world = Materials(folder, named, textures)
    scene = {
        "type": "scene",
        # Mitsuba counts the emission that is seen directly as depth 1.
        "integrator": {"type": "path", "max_depth": settings["depth"] + 1, "rr_depth": settings["rr_depth"]},
    }
    for index, directive in enumerate(directives):
        if directive.keyword == "Camera":
            scene["sensor"] = camera(directive, resolution, spp, settings["sampler"])
        elif directive.keyword == "Shape":
            scene[f"shape{index}"] = shape(directive, folder, world)
        elif directive.keyword == "LightSource":
            scene[f"light{index}"] = light(directive, folder)
    return scene


def transform_of(matrix):
    return mi.ScalarTransform4f(np.asarray(matrix, float).tolist())


def rgb(values):
    return {"type": "rgb", "value": [float(v) for v in values]}


def camera(directive, resolution, spp, sampler):
    # pbrt's camera has x to the right, Mitsuba's to the left.
    camera_to_world = np.linalg.inv(directive.transform) @ FLIP_X
    return {
        "type": "perspective",
        "fov": directive.get("fov", 90.0),
        "fov_axis": "smaller",
        "near_clip": 1e-3,
        "far_clip": 1e5,
        "to_world": transform_of(camera_to_world),
        "film": {
            "type": "hdrfilm",
            "width": resolution[0],
            "height": resolution[1],
            "pixel_format": "rgb",
            "component_format": "float32",
            "rfilter": {"type": "box"},
        },
        "sampler": {"type": sampler, "sample_count": spp},
    }


class Materials:
    """Materials by name; one dictionary for each."""

    def __init__(self, folder, named, textures):
        self.folder, self.named, self.textures = folder, named, textures

    def of(self, material):
        """The BSDF of a material directive or of the name of one."""
        if isinstance(material, str):
            material = self.named[material]
        kind = material.get("type") if material.keyword == "MakeNamedMaterial" else material.type
        return getattr(self, kind)(material)

    def diffuse(self, m):
        return two_sided({"type": "diffuse", "reflectance": self.reflectance(m, 0.5)})

    def coateddiffuse(self, m):
        alpha = m.get("uroughness", m.get("roughness", 0.0))
        plastic = {
            "type": "roughplastic" if alpha > 1e-3 else "plastic",
            "diffuse_reflectance": self.reflectance(m, 0.5),
            "int_ior": m.get("eta", 1.5),
            "ext_ior": 1.0,
            "nonlinear": True,
        }
        if alpha > 1e-3:
            plastic |= {"alpha": alpha, "distribution": "ggx"}
        return two_sided(plastic)

    def conductor(self, m):
        if "reflectance" in m.parameters:
            r = np.array(m.get("reflectance"))
            eta, k = np.ones(3), 2 * np.sqrt(r) / np.sqrt(1 - r)
        else:
            eta, k = m.get("eta"), m.get("k")
        alpha = m.get("uroughness", m.get("roughness", 0.0))
        metal = {"type": "roughconductor" if alpha else "conductor", "eta": rgb(eta), "k": rgb(k)}
        if alpha:
            metal |= {"alpha": alpha, "distribution": "ggx"}
        return two_sided(metal)

    def dielectric(self, m):
        return {"type": "dielectric", "int_ior": m.get("eta", 1.5), "ext_ior": 1.0}

    def mix(self, m):
        first, second = (self.of(name) for name in m.get("materials"))
        amount = self.texture(m.get("amount"), raw=True)
        nested = [b["nested"] if b["type"] == "twosided" else b for b in (first, second)]
        return two_sided({"type": "blendbsdf", "weight": amount, "first": nested[0], "second": nested[1]})

    def reflectance(self, m, default):
        if "reflectance" not in m.parameters:
            return default
        parameter = m.parameters["reflectance"]
        return self.texture(parameter.values[0]) if parameter.kind == "texture" else rgb(parameter.values)

    def texture(self, name, raw=False):
        t = self.textures[name]
        if t.arguments[2] == "imagemap":
            path = os.path.join(self.folder, t.get("filename"))
            return {"type": "bitmap", "filename": path, "raw": raw, "to_uv": transform_of(FLIP_V)}
        assert t.arguments[2] == "checkerboard", t.arguments
        # One period of Mitsuba's board is two of pbrt's squares.
        scale = np.diag([t.get("uscale", 1.0) / 2, t.get("vscale", 1.0) / 2, 1.0, 1.0])
        return {
            "type": "checkerboard",
            "color0": t.get("tex1", 1.0),
            "color1": t.get("tex2", 0.0),
            "to_uv": transform_of(scale),
        }


def two_sided(bsdf):
    return {"type": "twosided", "nested": bsdf}


def shape(directive, folder, world):
    result = {"bsdf": world.of(directive.material)}
    if directive.area_light is not None:
        result["emitter"] = {"type": "area", "radiance": rgb(directive.area_light.get("L", [1.0] * 3))}
    if directive.type == "sphere":
        return result | {
            "type": "sphere",
            "to_world": transform_of(directive.transform @ np.diag([directive.get("radius", 1.0)] * 3 + [1.0])),
        }
    if directive.type == "plymesh":
        path = os.path.join(folder, directive.get("filename"))
        return result | {
            "type": "ply",
            "filename": path,
            "face_normals": not has_normals(path),
            "to_world": transform_of(directive.transform),
        }
    assert directive.type == "trianglemesh", directive.type
    return triangle_mesh(directive, result)


def has_normals(path):
    with open(path, "rb") as file:
        header = file.read(4096).split(b"end_header")[0]
    return b" nx" in header


def triangle_mesh(directive, properties):
    """A mesh that is written out in the scene file, through a temporary PLY file."""
    p = np.array(directive.get("P")).reshape(-1, 3)
    n = np.array(directive.get("N", [])).reshape(-1, 3)
    uv = np.array(directive.get("uv", [])).reshape(-1, 2)
    faces = np.array(directive.get("indices"), np.uint32).reshape(-1, 3)
    mesh = mi.Mesh("mesh", len(p), len(faces), has_vertex_normals=len(n) > 0, has_vertex_texcoords=len(uv) > 0)
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"] = p.ravel().astype(np.float32)
    parameters["faces"] = faces.ravel()
    if len(n):
        parameters["vertex_normals"] = n.ravel().astype(np.float32)
    if len(uv):
        parameters["vertex_texcoords"] = uv.ravel().astype(np.float32)
    parameters.update()
    handle, path = tempfile.mkstemp(suffix=".ply")
    os.close(handle)
    mesh.write_ply(path)
    return properties | {
        "type": "ply",
        "filename": path,
        "face_normals": len(n) == 0,
        "to_world": transform_of(directive.transform),
    }


def light(directive, folder):
    if directive.type == "distant":
        # Both give irradiance on a surface that faces the light.
        direction = np.array(directive.get("to", [0, 0, 1])) - np.array(directive.get("from", [0, 0, 0]))
        direction = directive.transform[:3, :3] @ direction
        return {"type": "directional", "direction": direction.tolist(), "irradiance": rgb(directive.get("L", [1.0] * 3))}
    assert directive.type == "infinite", directive.type
    if "filename" not in directive.parameters:
        return {"type": "constant", "radiance": rgb(directive.get("L", [1.0] * 3))}
    square = np.array(mi.Bitmap(os.path.join(folder, directive.get("filename"))).convert(
        mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, srgb_gamma=False))
    picture = latitude_longitude(square)
    return {"type": "envmap", "bitmap": mi.Bitmap(picture), "to_world": transform_of(directive.transform)}


def latitude_longitude(square):
    """Resamples an equal-area octahedral picture (Clarberg 2008) to Mitsuba's envmap; twice as wide as high."""
    size = square.shape[0]
    height, width = size, 2 * size
    theta = (np.arange(height) + 0.5) / height * np.pi
    # Mitsuba's columns: u = atan2(x, -z) / 2 pi, the poles along y.
    phi = (np.arange(width) + 0.5) / width * 2 * np.pi
    theta, phi = np.meshgrid(theta, phi, indexing="ij")
    d = np.stack([np.sin(phi) * np.sin(theta), np.cos(theta), -np.cos(phi) * np.sin(theta)], -1)
    u, v = equal_area_square(d)
    column = np.clip((u * size).astype(int), 0, size - 1)
    row = np.clip((v * size).astype(int), 0, size - 1)
    return square[row, column].astype(np.float32)


def equal_area_square(d):
    """The point of the unit square of a unit direction: the octahedral map that keeps areas (Clarberg 2008)."""
    x, y, z = np.abs(d[..., 0]), np.abs(d[..., 1]), np.abs(d[..., 2])
    radius = np.sqrt(np.maximum(0, 1 - z))
    phi = np.arctan2(np.minimum(x, y), np.maximum(x, y)) * 2 / np.pi
    phi = np.where(x < y, 1 - phi, phi)
    v = phi * radius
    u = radius - v
    u, v = np.where(d[..., 2] < 0, 1 - v, u), np.where(d[..., 2] < 0, 1 - u, v)
    u, v = np.copysign(u, d[..., 0]), np.copysign(v, d[..., 1])
    return (u + 1) / 2, (v + 1) / 2
