#!/usr/bin/env python3
"""Writes the CSV tables of this folder. Run by hand: python make.py REFRACTIVEINDEX_FOLDER

Needs the package colour-science (CIE tables) and a folder with the YAML files named in METALS, which come from
github.com/polyanskiy/refractiveindex.info-database (CC0).
"""
import pathlib
import sys

import colour
import numpy as np

HERE = pathlib.Path(__file__).parent
METALS = {
    "Ag": "Ag-Johnson.yml",
    "Al": "Al-Rakic-BB.yml",
    "Au": "Au-Johnson.yml",
    "Cr": "Cr-Johnson.yml",
    "Cu": "Cu-Johnson.yml",
    "CuZn": "Querry-Cu70Zn30.yml",
    "Fe": "Fe-Johnson.yml",
    "Ni": "Ni-Johnson.yml",
    "Pt": "Pt-Rakic-BB.yml",
    "Ti": "Ti-Johnson.yml",
    "W": "W-Rakic-BB.yml",
}
NM = np.arange(360, 831, 5)


def number(value):
    return "" if value is None else f"{value:.7g}"


def write(name, header, rows):
    lines = [",".join(header)] + [",".join(number(v) if not isinstance(v, str) else v for v in row) for row in rows]
    (HERE / name).write_text("\n".join(lines) + "\n")


def cie_1931():
    cmfs = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    write("cie1931.csv", ["nm", "x_bar", "y_bar", "z_bar"], [[nm, *cmfs[nm]] for nm in range(360, 831)])


def daylight_basis():
    basis = colour.colorimetry.SDS_BASIS_FUNCTIONS_CIE_ILLUMINANT_D_SERIES
    write("daylight.csv", ["nm", "s0", "s1", "s2"], [[nm, *(basis[k][nm] for k in ("S0", "S1", "S2"))] for nm in NM])


def d_series(nm, m1, m2):
    """CIE daylight; beyond 780 nm the tables of D50 and D65 follow it exactly."""
    basis = colour.colorimetry.SDS_BASIS_FUNCTIONS_CIE_ILLUMINANT_D_SERIES
    return basis["S0"][nm] + m1 * basis["S1"][nm] + m2 * basis["S2"][nm]


def illuminant_a(nm):
    return 100 * (560 / nm) ** 5 * np.expm1(1.435e7 / (2848 * 560)) / np.expm1(1.435e7 / (2848 * nm))


BEYOND = {
    "A": illuminant_a,
    "D50": lambda nm: d_series(nm, -1.0401, 0.3666),
    "D65": lambda nm: d_series(nm, -0.2940, -0.6877),
}


def illuminants():
    names = ["A", "D50", "D60", "D65"] + [f"FL{i}" for i in range(1, 13)]
    header = ["nm", "stdillum-A", "stdillum-D50", "illum-acesD60", "stdillum-D65"]
    header += [f"stdillum-F{i}" for i in range(1, 13)]

    def value(name, nm):
        table = colour.SDS_ILLUMINANTS[name]
        if nm in table.wavelengths:
            if name in BEYOND:
                assert abs(BEYOND[name](nm) - table[nm]) < 0.005 * table[nm], (name, nm, table[nm], BEYOND[name](nm))
            return table[nm]
        return BEYOND[name](nm) if name in BEYOND and nm > 780 else None

    write("illuminants.csv", header, [[nm, *(value(n, nm) for n in names)] for nm in NM])


def metals(folder):
    rows = []
    for metal, file in METALS.items():
        table = []
        for line in (folder / file).read_text().splitlines():
            try:
                numbers = [float(word) for word in line.split()]
            except ValueError:
                continue
            if len(numbers) == 3:
                table.append(numbers)
        nm = [1000 * row[0] for row in table]
        first = max(i for i, x in enumerate(nm) if x <= 360)
        last = min(i for i, x in enumerate(nm) if x >= 830)
        rows += [[metal, 1000 * row[0], row[1], row[2]] for row in table[first : last + 1]]
    write("metals.csv", ["metal", "nm", "eta", "k"], rows)


cie_1931()
daylight_basis()
illuminants()
metals(pathlib.Path(sys.argv[1]))
