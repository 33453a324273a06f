"""Root stress of helical pairs by ISO 6336-3 and AGMA 908 against solid gears: docs/studies/helical_root_stress.csv.

Run as ``python benchmarks/helical_root_stress_study.py`` (a minute a pair) to make the table anew; rows that it has
stay, unless ``--anew`` is given. The pairs fill a box evenly (a scrambled Sobol sequence): see `LOW` and `HIGH`.
"""

from __future__ import annotations

import csv
import math
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from scipy.stats import qmc

from fegear.base.errors import FegearError
from fegear.contact.wide.loaded import FlankPair
from fegear.contact.wide.root_stress import rooted_lines
from fegear.fem.solid.settings import solid_settings
from fegear.fem.solid.solution import solve_solid
from fegear.formulas.agma.agma908 import bending_factor
from fegear.formulas.iso6336.part3_pair import RatingChoice, ToothLoad, rate_helical, virtual_contact_ratio
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

if TYPE_CHECKING:
    from fegear.contact.wide.lines import ContactLines
    from fegear.geometry.pair import Member

TABLE = Path(__file__).resolve().parents[1] / "docs" / "studies" / "helical_root_stress.csv"
COMMAND = "# python benchmarks/helical_root_stress_study.py"
KEYS = ("teeth", "mate_teeth", "profile_shift", "helix_angle [deg]", "face_width [modules]", "rack_tip_radius")
HEAD = (
    "pair", "member", *KEYS, "overlap_ratio", "contact_ratio", "tolerance", "fe", "fe_even", "fe_transverse",
    "iso_2006", "iso_2019", "agma", "seconds",
)  # fmt: skip
#: The box: pinion's teeth (evenly in the logarithm), ratio, pinion's shift, helix [deg], face [modules], tip radius.
LOW = (17.0, 1.0, 0.0, 8.0, 4.0, 0.2)
HIGH = (45.0, 3.0, 0.5, 30.0, 10.0, 0.38)
#: Normal module [m], load per face width along the line of action [N/m], dedendum; the wheel has no profile shift.
MODULE, LOAD, DEDENDUM = 3e-3, 300e3, 1.25
COUNT, SEED, TOLERANCE, FINE, POSITIONS = 48, 6336, 2e-2, 7e-3, 12
#: Every so many pairs are solved by FINE settings too, whose difference is the estimated error of all.
CHECKED = 8
_PER_MODULE = 4
#: Within this of the end faces [modules] no root stress is looked for: a mesh begins and ends there at a point.
_FREE_END = 0.5


def population(count: int = COUNT) -> list[tuple[int, int, float, float, float, float]]:
    """Teeth, teeth of the mate, profile shift, helix angle [deg], face width and rack tip radius of the pairs."""
    unit = qmc.Sobol(len(LOW), seed=SEED).random(2 ** math.ceil(math.log2(count)))[:count]
    found = []
    for u in unit:
        low, high = np.array(LOW), np.array(HIGH)
        low[0], high[0] = math.log(low[0]), math.log(high[0])
        v = low + u * (high - low)
        z = round(math.exp(v[0]))
        found.append((z, round(z * v[1]), *(round(float(x), 3) for x in v[2:])))
    return found


def the_pair(one: tuple[int, int, float, float, float, float]) -> GearPair:
    """A pair of the population."""
    z, mate, shift, helix, face, tip = one
    gears = []
    for teeth, x, hand in ((z, shift, "right"), (mate, 0.0, "left")):
        tooth = Tooth(teeth, BasicRack(1.0, DEDENDUM, tip), x, helix_angle=math.radians(helix))
        gears.append(Gear(tooth, MODULE, 0.5 * tooth.root_radius * MODULE, face * MODULE, hand=hand))
    return GearPair(*gears)


def even(lines: ContactLines, load: float) -> np.ndarray:
    """The load spread evenly over all contact lines of a roll position, as both standards take it."""
    support = np.where(lines.present, lines.support, 0.0)
    return load * support / support.sum(axis=1, keepdims=True)


def stresses(pair: GearPair, tolerance: float) -> dict[str, tuple[float, float, float]]:
    """Largest root tension of both gears [Pa]: across the root of solved loads and of even ones; transverse, solved."""
    bodies, settings = {}, solid_settings(tolerance)
    for member in ("driver", "driven"):
        gear = pair.gear(member)
        size = gear.twist * MODULE, gear.face_width / MODULE, gear.material.poisson_ratio, gear.bore_radius / MODULE
        bodies[member] = solve_solid(gear.tooth, *size, settings, reach=1)
    load = LOAD * pair.face_width
    found = FlankPair(pair, bodies, positions=POSITIONS).solve(load)
    lines = found.lines
    end = _FREE_END * MODULE
    z = np.linspace(lines.low + end, lines.high - end, 2 * round(0.5 * _PER_MODULE * pair.face_width / MODULE) + 1)
    answers = {}
    for member, body in bodies.items():
        rooted = rooted_lines(pair, member, lines, body, coupling=True)
        solved, spread = found.contact.force[:, :, 0], even(lines, load)
        answers[member] = (
            rooted.largest("tension", solved, z, across=True), rooted.largest("tension", spread, z, across=True),
            rooted.largest("tension", solved, z),
        )  # fmt: skip
    return answers


def formulas(pair: GearPair, member: Member) -> tuple[float, float, float]:
    """Root stress [Pa] by ISO 6336-3 of 2006 and of 2019, and by AGMA 908; NaN where a formula refuses."""
    gear = pair.gear(member)
    tangential = LOAD * gear.base_radius / gear.pitch_radius
    shared = virtual_contact_ratio(gear, pair.contact_ratio)
    found = []
    for edition in (2006, 2019):
        try:
            load = ToothLoad(tangential, shared, pair.overlap_ratio, gear.helix_angle)
            found.append(rate_helical(gear, load, RatingChoice(edition)).stress)
        except FegearError:
            found.append(math.nan)
    try:
        at_work = LOAD * math.cos(pair.working_pressure_angle)
        module = 2.0 * gear.pitch_radius / gear.teeth
        found.append(at_work / (module * bending_factor(pair, member).J))
    except FegearError:
        found.append(math.nan)
    return found[0], found[1], found[2]


def rows(number: int, tolerance: float) -> list[list[str]]:
    """Both gears of a pair."""
    one = population()[number]
    pair, started = the_pair(one), time.process_time()
    fe = stresses(pair, tolerance)
    seconds, found = time.process_time() - started, []
    for member in ("driver", "driven"):
        z, mate, shift, helix, face, tip = one
        own = (z, mate, shift, helix, face, tip) if member == "driver" else (mate, z, 0.0, helix, face, tip)
        cells = (*own, pair.overlap_ratio, pair.contact_ratio, tolerance, *fe[member], *formulas(pair, member), seconds)
        found.append([str(number), member, *(f"{c:.6g}" for c in cells)])
    return found


def table() -> list[dict[str, str]]:
    """The committed table."""
    with TABLE.open(encoding="utf-8", newline="") as file:
        if file.readline().strip() != COMMAND:
            raise ValueError(f"{TABLE} does not start with its command")
        return list(csv.DictReader(file))


def main() -> None:
    """Make the rows that are missing."""
    if "--anew" in sys.argv or not TABLE.is_file():
        TABLE.write_text(f"{COMMAND}\n{','.join(HEAD)}\n", encoding="utf-8")
    done = {(int(r["pair"]), float(r["tolerance"])) for r in table()}
    wanted = [(n, t) for n in range(COUNT) for t in ((TOLERANCE, FINE) if n % CHECKED == 0 else (TOLERANCE,))]
    for number, tolerance in wanted:
        if (number, tolerance) in done:
            continue
        made = rows(number, tolerance)
        with TABLE.open("a", encoding="utf-8") as file:
            file.writelines(",".join(row) + "\n" for row in made)
        print("\n".join(",".join(row) for row in made), flush=True)


if __name__ == "__main__":
    main()
