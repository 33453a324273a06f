"""Strain gauges in the root fillets of one tooth against CalculiX: the whole gear on a finer mesh, plane strain."""

import math
import re
import subprocess
from dataclasses import replace

import numpy as np
import pytest

from fegear.fem.plane.gauge import FilletProfile, GaugesOnFillet, Grid
from fegear.fem.plane.loaded_gear import loaded_gear
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack
from fegear.output.plane_mesh_files import write_inp

GEAR = Gear(Tooth(17, BasicRack(1.0, 1.25, 0.25), profile_shift=0.2), 3.175e-3, 9e-3, 20e-3)
#: Fillet, place, length of the grid [m].
PLACES = (
    ("tension", "tangent_angle", math.radians(30.0), 0.4e-3),
    ("tension", "arc", 0.7e-3, 0.6e-3),
    ("tension", "height", 0.35e-3, 0.2e-3),
    ("compression", "tangent_angle", math.radians(30.0), 0.4e-3),
    ("compression", "diameter", 2 * 25.05e-3, 0.6e-3),
)
_EDGES = {"tension": "fillet_0", "compression": "back_fillet_0"}


def _along(points, moved, edges, start):
    """Arc length and tangential strain in three points of each quadratic edge of a fillet, from the root up."""
    ends, middle = edges[:2].T, edges[2]
    chain, at, left = [], start, list(range(len(middle)))
    while left:
        e = next(e for e in left if at in ends[e])
        last = int(ends[e][0] if ends[e][1] == at else ends[e][1])
        chain.append((at, int(middle[e]), last))
        left.remove(e)
        at = last
    arc, strain, length = [], [], 0.0
    node, weight = np.polynomial.legendre.leggauss(2)
    for three in chain:
        xy, u = points[:, three], moved[:, three]
        t = node  # from -1 to 1; nodes at -1, 0, 1
        slope = np.stack([t - 0.5, -2.0 * t, t + 0.5])
        dx, du = xy @ slope, u @ slope
        speed = np.hypot(*dx)
        arc += [length + 0.5 * (1.0 + one) * float(weight @ speed) for one in t]
        strain += list((dx * du).sum(axis=0) / speed**2)
        length += float(weight @ speed)
    return np.array(arc), np.array(strain)


@pytest.mark.dear
def test_mean_strain_under_five_grids(tmp_path, program):
    ccx = program("ccx")
    whole, field = loaded_gear(GEAR, replace(MeshSettings().scaled(0.8), order=2))
    write_inp(tmp_path / "g.inp", GEAR, whole, field.forces)
    text = (tmp_path / "g.inp").read_text()
    asked = "".join(f"*NODE PRINT, NSET={name.upper()}\nU\n" for name in _EDGES.values())
    (tmp_path / "g.inp").write_text(text.replace("*NODE PRINT, NSET=FLANK_0\nU\n", asked))
    subprocess.run([ccx, "g"], cwd=tmp_path, check=True, capture_output=True, timeout=300)
    moved = np.zeros_like(whole.points)
    for line in (tmp_path / "g.dat").read_text().splitlines():
        if re.fullmatch(r"\s*\d+(\s+\S+){3}\s*", line):
            number, ux, uy, _ = line.split()
            moved[:, int(number) - 1] = float(ux), float(uy)
    moved *= 1e-3  # mm, under 1 N/mm
    points, solved = whole.points * GEAR.module, solve_gear(GEAR)
    load = 1e3
    radius = GEAR.pitch_radius
    off = []
    for side, key, value, long in PLACES:
        grid = Grid(long, 0.0, 0.0)
        middle = FilletProfile.of_mesh(solved.fine.fillets[side], GEAR).place(key, value, grid)
        gauge = GaugesOnFillet(solved, side, grid, np.array([middle]))
        mine = float(gauge.stress(0, radius)[0, 0]) * gauge.strain_per_stress * load
        edges = whole.boundaries[_EDGES[side]]
        nodes = np.unique(edges[:2])
        start = int(nodes[np.argmin(np.hypot(*points[:, nodes]))])
        arc, strain = _along(points, moved, edges, start)
        places = np.linspace(middle - 0.5 * long, middle + 0.5 * long, 2001)
        theirs = float(np.trapezoid(np.interp(places, arc, strain), places) / long)
        off.append(mine / theirs - 1.0)
    assert np.abs(off).max() < 3e-3, off
