"""Stiffness of a cracked tooth by potential energy and by finite elements: docs/studies/cracked_stiffness.csv.

Run as ``python benchmarks/cracked_stiffness_study.py`` (two minutes) to make table and picture anew; ``--picture``
draws the committed table.
"""

from __future__ import annotations

import csv
import functools
import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve
from fegear.engine.figure.panel import Panel
from fegear.fem.plane.odd.crack import Crack, mouth_at_tangent, straight_crack
from fegear.fem.plane.odd.odd_solution import solve_cracked_gear
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.formulas import potential_energy
from fegear.formulas.hertz import line_contact
from fegear.formulas.potential_energy_crack import cracked_tooth_compliance
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.output.draw_png import draw_pictures

if TYPE_CHECKING:
    from fegear.fem.plane.gear import GearInfluence

TABLE = Path(__file__).resolve().parents[1] / "docs" / "studies" / "cracked_stiffness.csv"
IMAGES = Path(__file__).resolve().parents[1] / "docs" / "images"
PICTURE = "cracked_stiffness_study"
#: The first line of the table.
COMMAND = "# python benchmarks/cracked_stiffness_study.py"
HEAD = ("angle [deg]", "depth", "finite_elements [%]", "potential_energy [%]")
#: 25 teeth of module 2 mm in mesh with a like gear, face 20 mm, bores half of the roots, 60 N m.
TEETH, MODULE, WIDTH, TORQUE, STEEL = 25, 2e-3, 20e-3, 60.0, Material(206e9)
ANGLES, DEPTHS = (90, 70, 45), (0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8)
LEVEL = -3


def gear() -> Gear:
    """Both gears of the pair, in plane stress as the literature has beams."""
    tooth = Tooth(TEETH, BasicRack(1.0, 1.25, 0.25))
    return Gear(tooth, MODULE, 0.5 * tooth.root_radius * MODULE, WIDTH, STEEL, "stress")


def crack(angle: float, depth: float) -> Crack:
    """From the 30 degree tangent of the loaded flank's fillet, a share of the way through."""
    tooth = gear().tooth
    return straight_crack(tooth, mouth_at_tangent(tooth, math.radians(30.0)), math.radians(angle), share=depth)


def by_potential_energy(angle: float, depth: float) -> float:
    """By which share the stiffness of a single pair at the pitch point falls, contact by Yang and Sun."""
    one = gear()
    radius = np.array([one.pitch_radius])
    whole = float(potential_energy.tooth_compliance(one, radius).total[0])
    cracked = float(cracked_tooth_compliance(one, radius, crack(angle, depth).corners[-1]).total[0])
    contact = 2.0 * float(potential_energy.contact_approach(one, radius, 1.0, 1e-4)[0])
    return 1.0 - (2.0 * whole + contact) / (whole + cracked + contact)


@functools.cache
def ordinary(level: float) -> GearInfluence:
    """The gear without a crack."""
    return solve_gear(gear(), settings_at(level), reach=2, estimate_error=False)


def by_finite_elements(angle: float, depth: float, level: float = LEVEL) -> float:
    """The same with the whole gear's own deflection and Hertzian contact."""
    one = gear()
    pair, radius = GearPair(one, one), np.array([one.pitch_radius])
    plain = ordinary(level)
    known = solve_cracked_gear(plain, {0: crack(angle, depth)})
    line_load = TORQUE / one.base_radius / WIDTH
    rho = 0.5 * one.pitch_radius * math.sin(pair.working_pressure_angle)
    modulus = 0.5 * one.plane_modulus
    wide = np.array([float(line_contact(line_load, 1.0 / rho, modulus).half_width)])
    whole, cracked = (float(c[0]) for c in (plain.self_compliance(radius, wide), known.own(0, radius, wide)))
    return 1.0 - 2.0 * whole / (whole + cracked)


def rows() -> list[tuple[float, ...]]:
    """All of the table."""
    return [
        (angle, depth, 100.0 * by_finite_elements(angle, depth), 100.0 * by_potential_energy(angle, depth))
        for angle in ANGLES
        for depth in DEPTHS
    ]


def table() -> list[dict[str, str]]:
    """The committed table."""
    with TABLE.open(encoding="utf-8", newline="") as file:
        if file.readline().strip() != COMMAND:
            raise ValueError(f"{TABLE} does not start with its command")
        return list(csv.DictReader(file))


def figure() -> Figure:
    """Loss of stiffness over depth, and the beam's over that of the finite elements."""
    known = table()

    def values(angle: int, column: str) -> np.ndarray:
        return np.array([float(row[column]) for row in known if int(row["angle [deg]"]) == angle])

    depth = 100.0 * np.array(DEPTHS)
    losses = [
        Curve(depth, values(angle, "finite_elements [%]"), f"finite elements, {angle}°", f"series:{k}", markers=True)
        for k, angle in enumerate(ANGLES)
    ]
    losses += [
        Curve(depth, values(angle, "potential_energy [%]"), f"potential energy, {angle}°", f"series:{k + 3}")
        for k, angle in enumerate(ANGLES)
    ]
    ratios = [
        Curve(
            depth, values(angle, "potential_energy [%]") / values(angle, "finite_elements [%]"), f"ratio, {angle}°",
            f"series:{k}", markers=True,
        )
        for k, angle in enumerate(ANGLES)
    ]  # fmt: skip
    x = Axis("depth of the crack by the way through the tooth", "%")
    return Figure(
        PICTURE, "Cracked tooth: potential energy and finite elements",
        "Loss of stiffness of a single tooth pair at the pitch point over the depth of the crack, 25 teeth with a like "
        "gear, by the angle of the crack to the centre line; and the beam's loss over that of the finite elements.",
        (
            Panel(x, Axis("loss of stiffness", "%", zero=True), tuple(losses)),
            Panel(x, Axis("potential energy / finite elements", zero=True), tuple(ratios)),
        ),
    )  # fmt: skip


def main() -> None:
    """Make the table, and draw it."""
    if "--picture" not in sys.argv[1:]:
        found = rows()
        with TABLE.open("w", encoding="utf-8", newline="") as file:
            file.write(f"{COMMAND}\n")
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(HEAD)
            writer.writerows([f"{value:.4g}" for value in row] for row in found)
    for _ in draw_pictures(figure(), IMAGES):
        pass


if __name__ == "__main__":
    main()
