"""Error per second of Étendue and of Mitsuba 3: 1 / (relMSE x processor seconds). See README.md.

    efficiency.py reference --scene NAME [--rounds N]      adds samples to the references of a scene
    efficiency.py measure --scene NAME --contestant C ...  renders two seeds of each contestant, in turns
    efficiency.py table                                    prints what was measured

A contestant is `etendue:WAVELENGTHS:SAMPLER` or `mitsuba:VARIANT:SAMPLER[:RR_DEPTH]`.
"""
import argparse
import json
import os
import subprocess
import sys

import numpy as np

import ours
from scenes import SCENES

SPP = 64
REFERENCE_SPP = 256
SEEDS = (1, 2)
HERE = os.path.dirname(os.path.abspath(__file__))


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("action", choices=("reference", "measure", "table"))
    parser.add_argument("--scenes", required=True, help="folder that holds the folders of scenes.py")
    parser.add_argument("--work", required=True, help="folder for references, pictures and results")
    parser.add_argument("--binary", help="the command etendue")
    parser.add_argument("--scene", action="append", choices=SCENES, help="default: all")
    parser.add_argument("--contestant", action="append", default=[])
    parser.add_argument("--model", action="append", help="of references: etendue:hero, etendue:bands, mitsuba:rgb, mitsuba:spectral")
    parser.add_argument("--rounds", type=int, default=1, help="times 256 samples per pixel that a reference gets")
    parser.add_argument("--label", default="", help="kept with each result")
    parser.add_argument("--spp", type=int, default=SPP)
    parser.add_argument("--options", default="", help="more options for etendue, such as --integrator=...")
    return parser.parse_args()


class Reference:
    """Sums over independent rounds, so that the mean and its own noise are known."""

    def __init__(self, path):
        self.path = path
        if os.path.exists(path):
            with np.load(path) as file:
                self.n, self.sum, self.squares = int(file["n"]), file["sum"], file["squares"]
        else:
            self.n, self.sum, self.squares = 0, 0.0, 0.0

    def add(self, image):
        self.n, self.sum, self.squares = self.n + 1, self.sum + image, self.squares + image**2
        temporary = self.path + ".tmp.npz"
        np.savez(temporary, n=self.n, sum=self.sum, squares=self.squares)
        os.replace(temporary, self.path)

    def mean(self):
        return self.sum / self.n

    def noise(self):
        """The relMSE of the mean itself; of a single round it is unknown."""
        if self.n < 2:
            return float("nan")
        mean = self.mean()
        variance = np.maximum(self.squares / self.n - mean**2, 0) / (self.n - 1)
        return relative(variance, mean)


def relative(squared_error, reference):
    return float(np.mean(squared_error / (reference**2 + 0.01)))


def reference_of(a, name, model):
    os.makedirs(os.path.join(a.work, "references"), exist_ok=True)
    return Reference(os.path.join(a.work, "references", f"{name}-{model.replace(':', '-')}.npz"))


def render_ours(a, name, wavelengths, sampler, spp, seeds, label):
    """(picture, processor seconds of rendering, without start-up) for each seed."""
    scene = SCENES[name]
    folder = os.path.join(a.work, "prepared", name)
    source = ours.prepare(os.path.join(a.scenes, scene.path), folder, sampler, spp, scene.depth)
    options = ["--wavelengths", wavelengths, *a.options.split()]
    out = os.path.join(a.work, f"{name}-{label}-{os.getpid()}.pfm")
    # The start-up is that of a render of one sample, of which that sample's share is taken off.
    startup, _ = ours.render(a.binary, source, out, scene.resolution, 1, 1, options=options)
    for seed in seeds:
        seconds, _ = ours.render(a.binary, source, out, scene.resolution, spp, seed, options=options)
        yield ours.read_pfm(out), (seconds - startup) * spp / (spp - 1), spp
    for path in (source, out, out + ".json"):
        os.remove(path)


def render_mitsuba(a, name, variant, sampler, rr_depth, spp, seeds, label):
    scene = SCENES[name]
    if sampler == "orthogonal":
        spp = 49  # the square of a prime is needed; 64 would become 121
    out = os.path.join(a.work, f"{name}-{label}-{os.getpid()}")
    command = [
        sys.executable, os.path.join(HERE, "mitsuba_worker.py"), os.path.join(a.scenes, scene.path), out,
        "--variant", variant, "--sampler", sampler, "--spp", str(spp), "--depth", str(scene.depth),
        "--rr-depth", str(rr_depth), "--resolution", *map(str, scene.resolution), "--seeds", *map(str, seeds),
    ]  # fmt: skip
    result = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
    for line in result.stdout.splitlines():
        row = json.loads(line)
        path = f"{out}-{row['seed']}.npy"
        yield np.load(path), row["cpu_s"], row["spp"]
        os.remove(path)


def render(a, name, contestant, spp, seeds):
    renderer, *rest = contestant.split(":")
    label = contestant.replace(":", "-")
    if renderer == "etendue":
        return render_ours(a, name, *rest, spp, seeds, label)
    variant, sampler, rr_depth = (*rest, "5")[:3]
    return render_mitsuba(a, name, variant, sampler, int(rr_depth), spp, seeds, label)


def model_of(contestant):
    """What a contestant converges to: the variants of Mitsuba in RGB to the same picture."""
    renderer, model = contestant.split(":")[:2]
    return f"{renderer}:{model.split('_')[-1]}"


def add_references(a, name):
    for model in a.model:
        reference = reference_of(a, name, model)
        contestant = f"{model}:sobol" if model.startswith("etendue") else f"mitsuba:llvm_ad_{model[8:]}:multijitter"
        seeds = range(1000 + reference.n, 1000 + reference.n + a.rounds)
        for image, _, _ in render(a, name, contestant, REFERENCE_SPP, seeds):
            reference.add(image)
            print(f"{name} {model}: {reference.n} rounds, relMSE {reference.noise():.2e}", flush=True)


def measure(a, name):
    for contestant in a.contestant:
        reference = reference_of(a, name, model_of(contestant))
        images, seconds, samples = zip(*render(a, name, contestant, a.spp, SEEDS))
        mean = reference.mean()
        errors = [relative((image - mean) ** 2, mean) for image in images]
        row = {
            "label": a.label,
            "scene": name,
            "contestant": contestant,
            "spp": samples[0],
            "relmse": float(np.mean(errors)),
            "relmse_of_seeds": errors,
            # From the two seeds alone; equal to relMSE where nothing is biased.
            "variance": relative((images[0] - images[1]) ** 2 / 2, mean),
            "cpu_s": float(np.mean(seconds)),
            "reference_noise": reference.noise(),
            "mean": np.mean(images, axis=(0, 1, 2)).tolist(),
            "reference_mean": mean.mean((0, 1)).tolist(),
        }
        row["efficiency"] = 1 / (row["relmse"] * row["cpu_s"])
        row["msps"] = 2e-6 * mean[..., 0].size * samples[0] / row["cpu_s"]
        with open(os.path.join(a.work, "results.jsonl"), "a", encoding="utf-8") as file:
            file.write(json.dumps(row) + "\n")
        show(row)


def show(row):
    means = " ".join(f"{x:.4f}" for x in np.array(row["mean"]) / np.array(row["reference_mean"]))
    print(
        f"{row['label']:<10} {row['scene']:<11} {row['contestant']:<36} {row['spp']:>4} spp  relMSE {row['relmse']:.3e}"
        f" (of seeds {row['variance']:.3e})  {row['cpu_s']:7.2f} CPU s  {row['msps']:.2f} M/s"
        f"  efficiency {row['efficiency']:8.3f}  mean/ref {means}  ref noise {row['reference_noise'] / row['relmse']:.3f}",
        flush=True,
    )


def main():
    a = arguments()
    os.makedirs(a.work, exist_ok=True)
    for name in a.scene or SCENES:
        if a.action == "reference":
            add_references(a, name)
        elif a.action == "measure":
            measure(a, name)
    if a.action == "table":
        with open(os.path.join(a.work, "results.jsonl"), encoding="utf-8") as file:
            for line in file:
                show(json.loads(line))


if __name__ == "__main__":
    main()
