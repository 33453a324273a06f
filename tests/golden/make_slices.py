"""The constants of `fegear.fem.solid.slice_laws`, fitted to solid gears, and what is left on gears not in the fit.

First the shapes' compliances: what hats along the face do to each other, shape by shape, own tooth and next. Then the
root stress. Poisson's ratio .3, racks of 20 degrees, bores .3 to .93 of the root radius. Takes about ten minutes.
"""

import dataclasses
import math
import sys

import numpy as np
from scipy.optimize import least_squares

from fegear.fem.solid.bands import bands, hats, profile_moments
from fegear.fem.solid.contact import line_compliance
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.slice_laws import LAWS, Spread
from fegear.fem.solid.slices import flank_shapes, plane_compliance, plane_section, solve_slices
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack

NU, SHAPES, STATIONS = 0.3, 5, 9
#: Teeth, helix angle [deg], width [modules], bore over root radius, profile shift.
FITTED = (
    (28, 0, 8, 0.5, 0.0), (28, 20, 8, 0.5, 0.0), (60, 0, 6, 0.9, 0.0), (60, 20, 8, 0.75, 0.0), (20, 30, 7, 0.6, 0.0),
    (60, 0, 8, 0.3, 0.0), (40, 15, 6, 0.93, 0.0), (35, 25, 5, 0.4, 0.0),
)  # fmt: skip
UNSEEN = (
    (17, 0, 6, 0.6, 0.2), (28, 8, 6, 0.7, 0.0), (23, 12, 9, 0.6, 0.1), (80, 0, 7, 0.85, 0.0), (14, 0, 8, 0.5, 0.3),
    (100, 10, 8, 0.5, 0.0), (40, 0, 4, 0.7, 0.0), (28, 0, 12, 0.7, 0.0),
)  # fmt: skip
ROOT_AT = (0.35, 0.6, 0.85)


class Known:
    """A gear solved both ways."""

    def __init__(self, teeth, helix, width, bore, shift):
        self.name = f"z {teeth}, {helix} deg, width {width}, bore {bore}, x {shift}"
        self.tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25), profile_shift=shift, helix_angle=math.radians(helix))
        self.width, self.bore = float(width), bore * self.tooth.root_radius
        self.solid = solve_solid(self.tooth, self.tooth.twist, self.width, NU, self.bore, SolidSettings())
        self.plane = plane_section(self.tooth, NU, self.bore, SolidSettings(), 1)

    def slices(self, laws):
        return solve_slices(
            self.tooth, self.tooth.twist, self.width, NU, self.bore, SolidSettings(), laws=laws, plane=self.plane
        )

    def by_shapes(self):
        """Compliances of hats along the face whose pressures up the flank are the shapes', and what laws make them."""
        plane, face = plane_compliance(self.plane), self.solid.face
        shapes = flank_shapes(self.plane.flank, plane[0])
        loads = shapes.loads[:, :SHAPES]
        z, half = np.linspace(-0.5, 0.5, STATIONS) * self.width, 0.5 * self.width
        pressed = bands(1.0, z, np.minimum(0.5, half + z), 0.1, after=np.minimum(0.5, half - z))
        along = profile_moments(pressed, face)
        n, count = loads.shape[0], face.count
        solid = [
            np.einsum("am,akbl,bn,ki,lj->mnij", loads, self.solid.compliance[k].reshape(n, count, n, count), loads,
                      along, along, optimize=True)
            for k in (0, 1)
        ]  # fmt: skip
        following = loads.T @ plane[1] @ loads

        def model(laws):
            spread = Spread(
                face, NU, self.tooth.twist * self.tooth.base_radius, self.tooth.root_radius - self.bore, laws
            )
            own = np.zeros_like(solid[0])
            index = np.arange(SHAPES)
            matrices = spread.own(shapes.values[:SHAPES], following[0, 0])
            own[index, index] = np.einsum("ki,mkl,lj->mij", along, matrices, along)
            return own, np.einsum("mn,ij->mnij", following, along.T @ spread.beside() @ along)

        return solid, model

    def lines(self, share):
        """A contact line through a share of the flank, its stations off the flank's ends."""
        flank, rb = self.solid.flank, self.tooth.base_radius
        z = np.linspace(-0.5, 0.5, 2 * round(2.0 * self.width) // 2 + 1) * self.width
        length = flank.flank_end - flank.flank_start
        low, middle, high = (
            float(flank.radius_of_arc(np.array([flank.flank_start + x * length]))[0]) for x in (0.07, share, 0.93)
        )
        radius = np.hypot(rb, np.maximum(np.sqrt(middle**2 - rb**2) - self.solid.tau * rb * z, 0.0))
        on = (radius > low) & (radius < high)
        return radius[on], z[on]


def constants(laws):
    return np.concatenate([np.atleast_1d(getattr(laws, f.name)) for f in dataclasses.fields(laws)])


def laws_of(values, like=LAWS):
    found, rest = {}, list(values)
    for f in dataclasses.fields(like):
        old = getattr(like, f.name)
        count = len(old) if isinstance(old, tuple) else 1
        new, rest = [float(x) for x in rest[:count]], rest[count:]
        found[f.name] = tuple(new) if isinstance(old, tuple) else new[0]
    return type(like)(**found)


def misses(laws, seen):
    found = []
    for solid, model in seen:
        scale = sum(np.diag(solid[0][m, m])[STATIONS // 2] for m in range(SHAPES))
        own, following = model(laws)
        found += [((own - solid[0]) / scale).ravel(), 3.0 * ((following - solid[1]) / scale).ravel()]
    return np.concatenate(found)


def band(solution, radius, stations):
    return hats(radius, stations, solution.band_half_width(radius), slope=solution.line_slope(radius))


def root_stress(solution, radius, stations, places):
    """Largest root tension and compression at places along the face, shape (2, places, stations)."""
    line = band(solution, radius, stations)
    return np.stack([
        sign * solution.largest_root_stress(0, side, line, places)[0]
        for side, sign in (("tension", 1.0), ("compression", -1.0))
    ])  # fmt: skip


def root_misses(laws, gears, exact):
    found = []
    for gear, lines in zip(gears, exact, strict=True):
        solution = gear.slices(laws)
        for radius, stations, places, wanted in lines:
            got, i = root_stress(solution, radius, stations, places), len(stations) // 2
            found.append((got.max(axis=1) / wanted.max(axis=1) - 1.0)[:, [0, i, -1]].ravel())
            found.append(got.mean(axis=2).max(axis=1) / wanted.mean(axis=2).max(axis=1) - 1.0)
    return np.concatenate(found)


def fit(gears, evaluations):
    seen = [gear.by_shapes() for gear in gears]
    start, roots = constants(LAWS), len(LAWS.root)

    def first(values):
        return misses(laws_of([*values, *LAWS.root]), seen)

    scale = np.maximum(np.abs(start), 0.3)
    low = np.where(start > 0.0, 0.02 * start, -np.inf)  # what is positive stays so
    how = {"loss": "soft_l1", "ftol": 1e-3, "max_nfev": evaluations, "diff_step": 1e-3}
    found = least_squares(first, start[:-roots], x_scale=scale[:-roots], bounds=(low[:-roots], np.inf), f_scale=0.03,
                          **how).x  # fmt: skip
    exact = []
    for gear in gears:
        places = np.linspace(-0.5, 0.5, 4 * round(gear.width) + 1) * gear.width
        lines = [gear.lines(share) for share in ROOT_AT]
        exact.append([(r, z, places, root_stress(gear.solid, r, z, places)) for r, z in lines])
    second = least_squares(
        lambda x: root_misses(laws_of([*found, *x]), gears, exact), start[-roots:], x_scale=scale[-roots:],
        bounds=(low[-roots:], np.inf), f_scale=0.1, **how,
    ).x  # fmt: skip
    return laws_of([float(f"{x:.4g}") for x in (*found, *second)])


def residuals(gear, laws, half_width=0.02):
    """Relative misses over contact lines: own compliance, even load, face as stiff body, coupling, next, root."""
    solution, rows = gear.slices(laws), []
    places = np.linspace(-0.5, 0.5, 4 * round(gear.width) + 1) * gear.width
    for share in (0.25, 0.5, 0.8):
        radius, z = gear.lines(share)
        lines = [band(x, radius, z) for x in (gear.solid, solution)]
        a, b = (line_compliance(x, line, half_width) for x, line in zip((gear.solid, solution), lines, strict=True))
        i = len(z) // 2
        own = np.diag(b) / np.diag(a) - 1.0
        even = (b.sum(axis=1) / a.sum(axis=1) - 1.0)[[0, i, -1]]
        away = [int(np.argmin(np.abs(z - z[i] - d))) for d in (1.0, 2.0, 4.0)]
        coupled = (b - a)[i, away] / a[i, i]
        ahead = [x.deflection(1, line, line).sum() for x, line in zip((gear.solid, solution), lines, strict=True)]
        root = [root_stress(x, radius, z, places) for x in (gear.solid, solution)]
        alone = (root[1].max(axis=1) / root[0].max(axis=1) - 1.0)[:, [0, i, -1]]
        whole = root[1].mean(axis=2).max(axis=1) / root[0].mean(axis=2).max(axis=1) - 1.0
        stiff = np.linalg.inv(a).sum() / np.linalg.inv(b).sum() - 1.0
        rows.append([*own[[0, i, -1]], *even, stiff, *coupled, ahead[1] / ahead[0] - 1.0, *alone.ravel(), *whole])
    return np.array(rows)


if __name__ == "__main__":
    laws = LAWS
    if "--fit" in sys.argv:
        laws = fit([Known(*gear) for gear in FITTED], int(sys.argv[-1]))
        print(laws)
    print("per cent: own at -z end, middle, +z end | even load there | stiff face | coupling at 1, 2, 4 modules")
    print("| next tooth | root tension of hats -z end, middle, +z end, compression | both under even load")
    for gear in (*UNSEEN, *FITTED):
        known = Known(*gear)
        print(known.name, known.solid.seconds)
        for row in 100.0 * residuals(known, laws):
            print("  ", " ".join(f"{x:6.1f}" for x in row), flush=True)
