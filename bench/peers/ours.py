"""Runs Étendue on a prepared copy of a scene and measures processor seconds."""
import json
import os
import subprocess
import tempfile

import numpy as np

from pbrt_scene import with_settings


def prepare(scene_path, folder, sampler, spp, depth):
    """Writes the scene with a box filter, sampler and depth of the comparison; its files are linked beside it."""
    source = os.path.dirname(os.path.abspath(scene_path))
    os.makedirs(folder, exist_ok=True)
    for name in os.listdir(source):
        link = os.path.join(folder, name)
        if not name.endswith(".pbrt") and not os.path.lexists(link):
            os.symlink(os.path.join(source, name), link)
    with open(scene_path, encoding="utf-8") as file:
        text = with_settings(file.read(), sampler, spp, depth)
    handle, path = tempfile.mkstemp(suffix=".pbrt", dir=folder)
    with os.fdopen(handle, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def render(binary, scene, out, resolution, spp, seed, threads=2, options=()):
    """Renders to `out` (.pfm); the processor seconds of the process, loading included, and the statistics."""
    command = [
        binary, "render", scene, "-o", out, "--quiet", "--spp", str(spp), "--seed", str(seed),
        "--threads", str(threads), "--resolution", f"{resolution[0]}x{resolution[1]}", "--stats", out + ".json", *options,
    ]  # fmt: skip
    process = subprocess.Popen(command)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        raise RuntimeError(f"failed: {' '.join(command)}")
    with open(out + ".json", encoding="utf-8") as file:
        statistics = json.load(file)
    return usage.ru_utime + usage.ru_stime, statistics


def read_pfm(path):
    """The picture, rows from the top."""
    with open(path, "rb") as file:
        kind, size, scale = (file.readline().decode().strip() for _ in range(3))
        assert kind == "PF", kind
        width, height = map(int, size.split())
        data = np.fromfile(file, "<f4" if float(scale) < 0 else ">f4").reshape(height, width, 3)
    return data[::-1].astype(np.float64)
