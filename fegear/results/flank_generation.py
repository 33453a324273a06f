"""Stage ``flank-generation``: how rack cutters generate the flanks of a helical pair, and its design parameters."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.citation import Citation, citing
from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Forecast, Stage
from fegear.frozen import ReadOnlyArrays
from fegear.results.drawn_rack_cutters import rack_cutter_figures
from fegear.results.drawn_sections import section_figures
from fegear.results.tooth_contact import check_misalignment

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.case.reading import Scene
    from fegear.engine.stage import Upstream, Work
    from fegear.geometry.gear import Gear
    from fegear.geometry.rack_cutter import RackCutter
    from fegear.helical.pair import HelicalPair

#: Places across a flank, and heights (shares of the face width) at which its generation is followed.
_PLACES, _HEIGHTS = 41, (-0.5, 0.0, 0.5)


@dataclass(frozen=True, slots=True)
class FlankGenerationInputs:
    """What the generation depends on: the pair, its name and those of its gears."""

    pair: HelicalPair
    name: str = field(compare=False)
    gears: tuple[str, str] = field(compare=False)


@dataclass(frozen=True, slots=True)
class GeneratedFlank(ReadOnlyArrays):
    """A flank as its cutter leaves it.

    Parameters
    ----------
    cutter : RackCutter
    u, along, psi : ndarray, shape (heights, places)
        Parameters u and l of the cutter surface [m] and roll angle [rad] at which it generates there.
    points, normals : ndarray, shape (3, heights, places)
        Of the flank, in the gear's frame [m]; normals as of `RackCutter.normals`.
    """

    cutter: RackCutter
    u: Array
    along: Array
    psi: Array
    points: Array
    normals: Array


@dataclass(frozen=True, slots=True)
class FlankGenerationData:
    """Both flanks, and how far they lie from those of tooth contact analysis [m]."""

    pair: HelicalPair
    flanks: tuple[GeneratedFlank, GeneratedFlank]
    apart: float


def _inputs(scene: Scene, name: str) -> FlankGenerationInputs:
    part = scene.case.pair[name]
    return FlankGenerationInputs(scene.helical_pairs[name], name, (part.driver, part.driven))


def _generate(cutter: RackCutter, deep: float, high: float) -> GeneratedFlank:
    """Follow a flank between two values of u, at three heights."""
    z = np.array(_HEIGHTS)[:, None] * cutter.gear.face_width
    u = np.broadcast_to(np.linspace(deep, high, _PLACES), (len(_HEIGHTS), _PLACES))
    along = cutter.along(u, z)
    psi, n = cutter.roll_angle(u, along), cutter.normals(u)
    turn = np.exp(1j * psi * (-1.0 if cutter.cuts == "pinion" else 1.0)) * (n[0] + 1j * n[1])
    return GeneratedFlank(cutter, u, along, psi, cutter.generated(u, along), np.stack([turn.real, turn.imag, n[2]]))


def _compute(asked: FlankGenerationInputs, _upstream: Upstream, _work: Work) -> FlankGenerationData:
    from fegear.geometry.rack_cutter import RackCutter
    from fegear.geometry.rack_flank import RackFlank

    pair = asked.pair
    flank, mate = RackFlank(pair.cut_pinion, pair.parabola), RackFlank(pair.gear)
    pinion = _generate(RackCutter(pair.cut_pinion, "pinion", pair.parabola), -flank.s_tip, -flank.s_form)
    gear = _generate(RackCutter(pair.gear, "gear"), mate.s_form, mate.s_tip)
    off = np.linalg.norm(pinion.points - flank.points(-pinion.u, pinion.points[2]), axis=0)
    involute = pair.mating_flank
    arm = involute.base_radius * math.cos(involute.base_helix_angle)
    out = np.hypot(gear.points[0], gear.points[1]) > involute.base_radius
    beside = np.abs(involute.separation_angle(gear.points[:, out])) * arm
    return FlankGenerationData(pair, (pinion, gear), float(max(off.max(), beside.max())))


def _thickness(gear: Gear) -> float:
    """On the pitch circle, in the transverse section [m]."""
    return 2.0 * gear.pitch_radius * float(gear.tooth.half_thickness_angle(gear.tooth.pitch_radius))


def _design_table(name: str, rows: list[tuple[str, Gear]]) -> Table:
    """Appendix 2 for each gear; for a spur gear without what is infinite."""
    gears = [gear for _, gear in rows]

    def column(key: str, values: list[float], unit: str, about: str) -> Column:
        return Column(key, np.array(values), unit, about)

    columns = [
        Column("gear", np.array([one for one, _ in rows]), "", "name"),
        column("teeth", [g.teeth for g in gears], "", "N"),
        column("alpha_n", [g.normal_pressure_angle for g in gears], "deg", "normal profile angle"),
        column("alpha_t", [g.transverse_pressure_angle for g in gears], "deg", "transverse profile angle (A.2.1)"),
        column("lambda_p", [g.lead_angle for g in gears], "deg", "lead angle on the pitch cylinder"),
        column("lambda_b", [0.5 * math.pi - g.base_helix_angle for g in gears], "deg",
               "lead angle on the base cylinder (A.2.7)"),
        column("p_t", [g.pitch_radius * g.angular_pitch for g in gears], "mm", "transverse pitch (A.2.2)"),
        column("s_t", [_thickness(g) for g in gears], "mm", "tooth thickness (A.2.4)"),
        column("w_t", [g.pitch_radius * g.angular_pitch - _thickness(g) for g in gears], "mm",
               "width of space (A.2.3)"),
        column("r_p", [g.pitch_radius for g in gears], "mm", "pitch radius (A.2.5)"),
        column("r_b", [g.base_radius for g in gears], "mm", "base radius (A.2.6)"),
        column("mu", [g.half_base_space_angle for g in gears], "deg", "half the space on the base cylinder (A.1.1)"),
        column("eta", [g.half_base_tooth_angle for g in gears], "deg", "half the tooth on it (A.1.3)"),
    ]  # fmt: skip
    if all(gear.twist for gear in gears):
        columns += [
            column("p", [1.0 / abs(g.twist) for g in gears], "mm", "screw parameter (A.2.8)"),
            column("H", [g.lead for g in gears], "mm", "lead (A.2.9)"),
        ]
    return Table(f"flank_design_{name}", tuple(columns), f"Design parameters of the flanks of pair {name}")


def _cutters_table(name: str, data: FlankGenerationData) -> Table:
    """Normal sections of both cutters over the u that both flanks need."""
    ends = np.concatenate([flank.u.ravel() for flank in data.flanks])
    u = np.linspace(ends.min(), ends.max(), 2 * _PLACES - 1)
    (x1, y1), (x2, y2) = (flank.cutter.normal_profile(u) for flank in data.flanks)
    return Table(
        f"rack_cutters_{name}",
        (
            Column("u", u, "mm", "along the straight profile from the reference line toward the pinion's root"),
            Column("x_pinion", x1, "mm", "pinion cutter in its own frame (A.5.6)"),
            Column("y_pinion", y1, "mm", "the same"),
            Column("x_gear", x2, "mm", "gear cutter in its own frame (A.5.1)"),
            Column("y_gear", y2, "mm", "the same"),
            Column("departure", data.pair.parabola * u**2, "um", "of the pinion cutter from the straight profile"),
        ),
        f"Normal sections of the rack cutters of pair {name}",
    )


def _flank_table(name: str, gear: str, flank: GeneratedFlank) -> Table:
    (x, y, z), n = flank.points, flank.normals
    columns = (
        Column("u", flank.u.ravel(), "mm", "across the cutter surface"),
        Column("l", flank.along.ravel(), "mm", "along it"),
        Column("psi", flank.psi.ravel(), "deg", "roll angle at which this place generates (A.5.14, A.5.15)"),
        *(Column(key, part.ravel(), "mm", "of the flank") for key, part in zip("xyz", (x, y, z), strict=True)),
        Column("r", np.hypot(x, y).ravel(), "mm", "radius"),
        *(Column(f"n{key}", part.ravel(), "", "unit normal") for key, part in zip("xyz", n, strict=True)),
    )
    return Table(f"generated_flank_{name}_{gear}", columns, f"Flank of gear {gear} of pair {name} as generated")


def _present(data: FlankGenerationData, asked: FlankGenerationInputs) -> Outcome:
    name, pair, gears = asked.name, data.pair, asked.gears
    rows = [(gears[0], pair.pinion), (gears[1], pair.gear)]
    if pair.cut_pinion != pair.pinion:
        rows.append((f"{gears[0]} as cut", pair.cut_pinion))
    pinion = data.flanks[0]
    values = (
        Value(f"{name}.rack_half_width", pinion.cutter.half_width, "mm", 0.0, "a_m, half the cutter on the line u = 0"),
        Value(f"{name}.largest_departure", pair.parabola * float(np.max(pinion.u**2)), "um", 0.0,
              "of the pinion cutter from the straight profile, over the flank"),
        Value(f"{name}.generated_apart", data.apart, "um", 0.0,
              "largest distance of the generated flanks from those of tooth contact analysis"),
    )  # fmt: skip
    remarks = []
    if not pair.pinion.twist:
        remarks.append(f"Pair {name}: screw parameter and lead of a spur gear are infinite and not listed.")
    if pair.crown:
        remarks.append(f"Pair {name}: the lengthwise crown is not part of the rack cutter and not drawn.")
    tables = (
        _design_table(name, rows), _cutters_table(name, data),
        *(_flank_table(name, gear, flank) for gear, flank in zip(gears, data.flanks, strict=True)),
    )  # fmt: skip
    figures = (*rack_cutter_figures(name, gears, pair, data.flanks), *section_figures(name, gears, pair))
    return Outcome(data, tables, values, {}, tuple(remarks), figures)


FLANK_GENERATION = Stage(
    subjects=lambda scene: tuple(scene.helical_pairs),
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=check_misalignment,
    effects=("misalignment",),
    cites=citing(
        Citation("litvin", "rack cutters, equation of meshing, generated flanks", "Eqs. 19 to 22, Appendices 1, 2, 5")
    ),
    forecast=lambda _scene, _name: Forecast({}, 0.02),
)
