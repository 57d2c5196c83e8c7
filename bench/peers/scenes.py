"""The compared scenes: where they lie below the folder of scenes, their size here, and the depth of their paths."""
from dataclasses import dataclass


@dataclass(frozen=True)
class Scene:
    """A pbrt-v4 scene file, and how it is rendered by both."""

    path: str
    resolution: tuple
    # Most scattering events; the same for both.
    depth: int


SCENES = {
    "cornell": Scene("peers/cornell/cornell-path.pbrt", (256, 256), 8),
    "classroom": Scene("scenes/classroom/scene-v4.pbrt", (240, 135), 17),
    "veach-mis": Scene("scenes/veach-mis/scene-v4.pbrt", (240, 135), 1),
    "veach-ajar": Scene("scenes/veach-ajar/scene-v4.pbrt", (240, 135), 13),
    "terrain": Scene("terrain/terrain-path.pbrt", (256, 256), 8),
}
