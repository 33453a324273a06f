"""Stage ``flank-generation``: how rack cutters generate the flanks of a helical pair, and its design parameters."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.case.reading import Scene
from fegear.contact.unloaded.pair import HelicalPair
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.number import Number, exact
from fegear.engine.sheet.rows import Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.geometry.rack_cutter import RackCutter
from fegear.results.helical.drawn_rack_cutters import rack_cutter_figures
from fegear.results.helical.drawn_tooth_contact import section_figures
from fegear.results.helical.flank_generation_shown import (
    PLACES,
    CutterSections,
    DesignedGear,
    FlankGenerationData,
    FlankRows,
    GeneratedFlank,
    ShownGeneration,
)
from fegear.results.helical.tooth_contact import check_misalignment

if TYPE_CHECKING:
    from fegear.engine.figure.figure import DeferredFigure, Figure

#: Heights (shares of the face width) at which the generation of a flank is followed.
_HEIGHTS = (-0.5, 0.0, 0.5)


@dataclass(frozen=True, slots=True)
class FlankGenerationInputs:
    """What the generation depends on: the pair, its name and those of its gears."""

    pair: HelicalPair
    name: str = field(compare=False)
    gears: tuple[str, str] = field(compare=False)


def _inputs(scene: Scene, name: str) -> FlankGenerationInputs:
    part = scene.case.pair[name]
    return FlankGenerationInputs(scene.helical_pairs[name], name, (part.driver, part.driven))


def _generate(cutter: RackCutter, deep: float, high: float) -> GeneratedFlank:
    """Follow a flank between two values of u, at three heights."""
    z = np.array(_HEIGHTS)[:, None] * cutter.gear.face_width
    u = np.broadcast_to(np.linspace(deep, high, PLACES), (len(_HEIGHTS), PLACES))
    along = cutter.along(u, z)
    psi, n = cutter.roll_angle(u, along), cutter.normals(u)
    turn = np.exp(1j * psi * (-1.0 if cutter.cuts == "pinion" else 1.0)) * (n[0] + 1j * n[1])
    return GeneratedFlank(cutter, u, along, psi, cutter.generated(u, along), np.stack([turn.real, turn.imag, n[2]]))


def _compute(asked: FlankGenerationInputs, _upstream: Upstream, _work: Work) -> FlankGenerationData:
    from fegear.geometry.rack_cutter import RackCutter, RackFlank

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


def _figures(seen: Seen) -> tuple[Figure | DeferredFigure, ...]:
    """Cutters, the flanks that they leave, sections and frames."""
    pair, gears = seen.data.pair, seen.asked.gears
    cutters = rack_cutter_figures(seen.name, gears, pair, seen.data.data.flanks)
    return (*cutters, *section_figures(seen.name, gears, pair))


_SHEET = Sheet(
    of=lambda data, asked: ShownGeneration(data, asked.gears),
    tables=(
        Rows(
            "flank_design_{name}", "Design parameters of the flanks of pair {name}",
            tuple(DesignedGear.__dataclass_fields__), of="designed",
        ),
        Rows(
            "profile_angle_error_{name}",
            "Changes of the pinion of pair {name} by a profile angle error of {d.error_minutes:.6g} arcmin",
            ("by", "transverse_angle", "base_lead_angle", "base_radius"), of="by_profile_angle",
        ),
        Rows(
            "rack_cutters_{name}", "Normal sections of the rack cutters of pair {name}",
            tuple(CutterSections.__dataclass_fields__), of="sections",
        ),
        Rows(
            "generated_flank_{name}_{one.gear}", "Flank of gear {one.gear} of pair {name} as generated",
            tuple(f"rows.{key}" for key in FlankRows.__dataclass_fields__), each="flanks",
        ),
    ),
    values=(
        Number("rack_half_width", exact),
        Number("largest_departure", exact),
        Number("generated_apart", exact),
    ),
    figures=(_figures,),
    remarks=(
        Remark(
            "Pair {name}: screw parameter and lead of a spur gear are infinite and not listed.",
            when=lambda seen: not seen.data.pair.pinion.twist,
        ),
        Remark(
            "Pair {name}: lead crowning is not part of the rack cutter and not drawn.",
            when=lambda seen: seen.data.pair.crown,
        ),
    ),
)  # fmt: skip


FLANK_GENERATION = Stage(
    subjects=lambda scene: tuple(scene.helical_pairs),
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=check_misalignment,
    cites=citing(
        Citation("litvin", "rack cutters, equation of meshing, generated flanks", "Eqs. 19 to 22, Appendices 1, 2, 5")
    ),
    forecast=lambda _scene, _name: Forecast({}, 0.02),
)
