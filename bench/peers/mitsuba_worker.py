"""Renders one scene in Mitsuba 3 and prints a line of JSON for each image; see `efficiency.py`, which calls this.

Processor seconds are those of this process around `mi.render` alone. A first image, which also compiles the kernel, is
rendered and thrown away, so that compilation is left out.
"""
import argparse
import json
import os
import time

import mitsuba as mi
import numpy as np


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scene")
    parser.add_argument("out", help="images go to OUT-SEED.npy; with --sum their mean to OUT.npy and OUT-half.npy")
    parser.add_argument("--variant", default="llvm_ad_rgb")
    parser.add_argument("--sampler", default="independent")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--depth", type=int, required=True)
    parser.add_argument("--rr-depth", type=int, default=5)
    parser.add_argument("--resolution", type=int, nargs=2, required=True)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--sum", action="store_true", help="accumulate all seeds: for references")
    return parser.parse_args()


def processor_seconds():
    times = os.times()
    return times.user + times.system


def main():
    a = arguments()
    mi.set_variant(a.variant)
    mi.set_log_level(mi.LogLevel.Error)
    import drjit as dr

    from to_mitsuba import translate

    dr.set_thread_count(2)
    settings = {"sampler": a.sampler, "depth": a.depth, "rr_depth": a.rr_depth}
    scene = mi.load_dict(translate(a.scene, a.resolution, a.spp, settings), optimize=True)
    if not a.sum:
        np.array(mi.render(scene, spp=a.spp, seed=12345))
    images = []
    for seed in a.seeds:
        wall, cpu = time.time(), processor_seconds()
        image = np.array(mi.render(scene, spp=a.spp, seed=seed), np.float64)[..., :3]
        cpu, wall = processor_seconds() - cpu, time.time() - wall
        spp = scene.sensors()[0].sampler().sample_count()
        print(json.dumps({"seed": seed, "spp": spp, "cpu_s": cpu, "wall_s": wall}), flush=True)
        if a.sum:
            images.append(image)
        else:
            np.save(f"{a.out}-{seed}.npy", image)
    if a.sum:
        halves = [np.mean(images[k::2], axis=0) for k in (0, 1)]
        np.save(f"{a.out}.npy", np.mean(halves, axis=0))
        np.save(f"{a.out}-half.npy", halves[0] - halves[1])


if __name__ == "__main__":
    main()
