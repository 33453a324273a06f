"""``fegear check``: gears solved a second time, whole and by scikit-fem alone, compared with their stated errors."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.base.units import from_si
from fegear.case.built.tooth_influence import gear_to_solve, solve_influence_functions
from fegear.fem.plane.influence import SIDES
from fegear.fem.plane.settings import SOLVERS
from fegear.fem.plane.tooth_on_pins import tooth_on_pins
from fegear.results.gear.load_positions import chosen_gears

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.fem.plane.gear import GearInfluence
    from fegear.fem.plane.scikit_fem_alone import WholeGearAlone

#: What the whole gear by scikit-fem is itself good to, relative to c_self: it says nothing of errors below.
OWN_ERROR = 2e-5
#: Contacts keep so many half-widths off the ends of the flank.
_ROOM = 2.0
_COMPLIANCE, _STRESS = "um.mm/N", "MPa.mm/N"


@dataclass(frozen=True)
class Compared:
    """One quantity at one position.

    Attributes
    ----------
    quantity : str
        c_self, c_next, c_prev, root_tension or root_compression, as in the table of ``stiffness``.
    radius : float
        Of the contact [mm].
    fegear, scikit_fem : float
    unit : str
        Of both.
    difference, stated_error : float
        Relative to fegear's value; of neighbours to c_self, which they are added to.
    """

    quantity: str
    radius: float
    fegear: float
    scikit_fem: float
    unit: str
    difference: float
    stated_error: float

    @property
    def covered(self) -> bool:
        """Whether the stated error and that of the check itself are together no smaller than the difference."""
        return self.difference <= self.stated_error + OWN_ERROR


@dataclass(frozen=True)
class Solvers:
    """One gear solved by either `accuracy.solver` on the same mesh.

    Attributes
    ----------
    difference : float
        Largest difference of influence functions and root stresses over the largest of their kind.
    condensed, scikit_fem : float
        CPU time of each [s], without the mesh.
    """

    difference: float
    condensed: float
    scikit_fem: float

    @property
    def ratio(self) -> float:
        """How many times as long scikit-fem's assembly and elimination take."""
        return self.scikit_fem / self.condensed


@dataclass(frozen=True)
class Checked:
    """One gear: what was compared, how many unknowns the whole gear had, its seconds, and both solvers."""

    gear: str
    compared: tuple[Compared, ...]
    unknowns: int
    seconds: float
    solvers: Solvers


def gears_to_check(scene: Scene) -> tuple[str, ...]:
    """Gears that finite elements of the plane solve: spur gears of which the case names one, or all.

    Raises
    ------
    InputError
        If there are none, or one has a mesh of its own.
    """
    names = chosen_gears(scene)
    if not names:
        raise InputError(
            "gear", ", ".join(scene.gears) or "(none)", "has no spur gear to check",
            "use a case with a spur gear",
        )  # fmt: skip
    for name in names:
        own = scene.case.gear[name].tooth_mesh
        if own is not None:
            raise InputError(
                f"gear.{name}.tooth_mesh", str(own), "replaces the outline required for the check mesh",
                "check the gear without it",
            )  # fmt: skip
    return names


def check_gear(scene: Scene, name: str, positions: int) -> Checked:
    """Solve a gear by fegear and by scikit-fem alone, and compare them at positions evenly spaced in roll angle.

    Of a ring on pins it is tooth 0 that is compared.
    """
    from fegear.fem.plane.scikit_fem_alone import solve_alone

    known = solve_influence_functions(gear_to_solve(scene, name))
    gear, flank = known.gear, known.fine.flank
    started = time.perf_counter()
    module, half_width = gear.module, known.reference_half_width / gear.module
    first, last = gear.tooth.roll(
        np.array([max(gear.form_radius, gear.base_radius), gear.involute_tip_radius]) / module
    )
    rolls = first + (last - first) * (np.arange(positions) + 0.5) / positions
    arc = flank.arc_of_radius(gear.tooth.radius_of_roll(rolls))
    room = min(_ROOM * half_width, 0.5 * (flank.flank_end - flank.flank_start))
    radius = flank.radius_of_arc(np.clip(arc, flank.flank_start + room, flank.flank_end - room))
    found = solve_alone(
        gear.tooth, gear.bore_radius / module, gear.material.poisson_ratio, gear.plane_assumption, known.settings,
        radius, half_width, gear.support_in_modules,
    )  # fmt: skip
    compared, solvers = tuple(_compared(known, found, radius * module)), compare_solvers(known)
    return Checked(name, compared, found.unknowns, time.perf_counter() - started, solvers)


def compare_solvers(known: GearInfluence) -> Solvers:
    """Solve a gear on its own mesh by nested dissection and by scikit-fem (`accuracy.solver`)."""
    from fegear.fem.plane.solved_ring import solve_influence

    fine, settings = known.fine, known.settings
    found, seconds = [], []
    for solver in SOLVERS:
        started = time.process_time()
        found.append(
            solve_influence(
                fine.tooth, fine.mesh, fine.poisson_ratio, fine.plane,
                order=settings.order, reach=fine.reach, support=fine.support, solver=solver,
            )
        )  # fmt: skip
        seconds.append(time.process_time() - started)
    one, other = found
    pairs = [[(one.compliance[k], other.compliance[k]) for k in one.compliance]]
    pairs += [[(one.stress[k, side], other.stress[k, side]) for k in one.compliance] for side in SIDES]
    difference = max(
        max(np.abs(a - b).max() for a, b in kind) / max(np.abs(a).max() for a, _ in kind) for kind in pairs
    )
    return Solvers(float(difference), *seconds)


def _compared(known: GearInfluence, found: WholeGearAlone, radius: Array) -> list[Compared]:
    b, modulus, module = known.reference_half_width, known.gear.material.young_modulus, known.gear.module
    tooth = replace(
        known, fine=tooth_on_pins(known.fine, 0)
    )  # of a ring on pins, whose numbers are means over its teeth
    own = tooth.self_compliance(radius, b)
    rows = [("c_self", own, found.c_self / modulus, known.self_error(radius, b), own, _COMPLIANCE)]
    for name, k, other in (("c_next", 1, found.c_next), ("c_prev", -1, found.c_prev)):
        value, error = (np.diagonal(f(k, radius, radius)) for f in (tooth.neighbour, known.neighbour_error))
        rows.append((name, value, other / modulus, error, own, _COMPLIANCE))
    tension, compression = (tooth.largest_root_stress(0, side, radius)[0] for side in ("tension", "compression"))
    for name, value, other, error in (
        ("root_tension", tension, found.root_tension, known.root_stress_error(0, "tension", radius)),
        ("root_compression", compression, found.root_compression, known.root_stress_error(0, "compression", radius)),
    ):
        rows.append((name, value, other / module, error, np.abs(value), _STRESS))
    return [
        Compared(name, r * 1e3, v * from_si(unit), o * from_si(unit), unit, abs(o - v) / s, e / s)
        for name, value, other, error, scale, unit in rows
        for r, v, o, e, s in zip(*(x.tolist() for x in (radius, value, other, error, scale)), strict=True)
    ]
