"""What ``flank-fracture`` shows: exposure, stress and strength over depth, case depths with their limits, its notes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.notes import assuming, failing, neglecting
from fegear.base.shown import shown
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Every, Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.formulas.iso6336.part4_flank_fracture import CALIBRATION, HARDNESS_FACTOR, PERMISSIBLE
from fegear.formulas.iso6336.part5_materials import recommended
from fegear.geometry.pair import MEMBER_WORDS, MEMBERS, Member
from fegear.results.rating.flank_fracture_data import (
    DEPTHS,
    Below,
    FlankFractureData,
    FlankFractureInputs,
    GearExposure,
)

if TYPE_CHECKING:
    from fegear.engine.sheet.seen import Seen


def fracture_remarks(data: FlankFractureData, inputs: FlankFractureInputs) -> tuple[str, ...]:
    """What falls short, then what is assumed and what is not verified against the standard."""
    name = inputs.asked.name
    told: list[str] = []
    for i, (member, gear) in enumerate(zip(MEMBERS, inputs.asked.gears, strict=True)):
        found, case = data.gears[member], inputs.cases[i]
        if found.most > PERMISSIBLE:
            told.append(
                failing(
                    f"Pair {name}: A_FF = {found.most:.4g} of gear {gear} ({member}) at a depth of "
                    f"{found.at_depth * 1e3:.3g} mm is above the permissible {PERMISSIBLE:g}."
                )
            )
        largest = recommended(inputs.asked.pair.gear(member).module)[2]
        needed = float(np.nanmax([found.crushing, found.least_agma, 0.0]))
        if case.case_depth < needed:
            told.append(
                failing(
                    f"Gear {gear}: the case depth of {case.case_depth * 1e3:.3g} mm is below the {needed * 1e3:.3g} mm "
                    "required against case crushing."
                )
            )
        if case.case_depth > largest:
            told.append(
                failing(
                    f"Gear {gear}: the case depth of {case.case_depth * 1e3:.3g} mm exceeds {largest * 1e3:.3g} mm "
                    "(0.4 m_n, at most 6 mm)."
                )
            )
        if inputs.materials[i] != "case-hardened-steel":
            covers = "ISO/TS 6336-4 covers case-carburized steel only"
            told.append(assuming(f"Gear {gear}: {covers}; the exposure for {inputs.materials[i]} is an extrapolation."))
        for what, measured, rule in (
            ("hardness over depth", case.measured, "hardness_profile"),
            ("residual stress", case.residual, "residual_stress"),
        ):
            if measured is None:
                told.append(
                    assuming(f"Gear {gear}: {what} by Lang, not verified against a printed source (strength.{rule}).")
                )
    if inputs.asked.levels:
        told.append(
            neglecting(
                f"Pair {name}: exposure and case depths are for the maximum level of the load spectrum, "
                f"{data.load / inputs.asked.load:.4g} times the load."
            )
        )
    told += inputs.said
    told.append(
        assuming(
            f"Pair {name}: structure, symbols and scope of A_FF (case-carburized external gears) are those that "
            f"printed sources give of ISO/TS 6336-4. Not verified against a source: K_tau,per = "
            f"{HARDNESS_FACTOR * 1e-6:g} MPa per HV, c_1 = {CALIBRATION:g}, "
            f"permissible A_FF = {PERMISSIBLE:g}, and that A_FF counts from the "
            f"half-width on; K_material = {inputs.material_factor:g} (flank_fracture_material_factor of iso_6336). "
            "tau_eff is the mean shear over all planes below a Hertzian contact without friction, instead of the "
            "standard's fitted formulas. "
            "Residual stress reduces the exposure in the case; A_FF_load excludes it."
        )
    )
    limits = assuming(
        f"Pair {name}: limits of the case depth are not verified against a printed source: 0.15 to 0.25 and 0.4 "
        "m_n, U_H of ISO 6336-5 (66,000 N/mm^2 of MQ and ME, 44,000 of ML) and of AGMA 2101 (44,000 carburized, "
        "30,000 induction-hardened)."
    )
    return tuple(dict.fromkeys((*told, limits)))


@dataclass(frozen=True)
class Flank:
    """A gear of the pair as it is shown: its exposure over depth below A to E and where it is largest, and its case."""

    found: GearExposure
    points: tuple[Below, ...]
    worst: Below
    gear: str = shown("", "driver, driven", table="depths")
    case_depth: float = shown("mm", "CHD at 550 HV (case)", table="depths")
    usual_from: float = shown("mm", "usual minimum, 0.15 m_n", table="depths")
    usual_to: float = shown("mm", "usual maximum, 0.25 m_n", table="depths")
    largest: float = shown("mm", "upper limit: 0.4 m_n, at most 6 mm", table="depths")

    @property
    def rows(self) -> list[Below]:
        """Depths of the points that stand in a table."""
        return [one.every(_EVERY) for one in self.points]


def _flanks(seen: Seen) -> dict[Member, Flank]:
    data, inputs, gears = seen.data, seen.asked, {}
    for member, gear, case in zip(MEMBERS, inputs.asked.gears, inputs.cases, strict=True):
        found = data.gears[member]
        points = tuple(found.below(k, letter) for letter, k in data.points.items())
        worst = found.below(int(abs(data.x - found.place).argmin()))
        limits = recommended(inputs.asked.pair.gear(member).module)
        gears[member] = Flank(found, points, worst, gear, case.case_depth, *limits)
    return gears


def _case(seen: Seen) -> tuple[Mark, ...]:
    depth = seen.one.case_depth
    return (Mark("x", depth * 1e3, "CHD"),) if depth == depth else ()


def _limits(seen: Seen) -> tuple[Mark, ...]:
    largest = Mark("x", seen.one.found.at_depth * 1e3, "largest")
    return *_case(seen), Mark("y", PERMISSIBLE, f"{PERMISSIBLE:g}"), largest


def _value(quantity: str, of: str = "found", name: str = "", meaning: str = "") -> Number:
    return Number(quantity, of=of, owner="{name}.{key}", name=name, meaning=meaning, finite=True)


#: Depths in a table by point and depth: every so manyth.
_EVERY = 4
_PLAIN = {"markers": False}
FRACTURE_SHEET = Sheet(
    name=lambda inputs: inputs.asked.name,
    tables=(
        Rows(
            "flank_fracture_{name}", "Flank fracture of pair {name} over the path of contact",
            (
                "x", "sharing", "radius", "pressure", "half_width",
                Cell(
                    "over_path", each="gears", name="exposure_{key}", further=lambda seen: f", {MEMBER_WORDS[seen.key]}"
                ),
            ),
        ),
        Rows(
            "flank_fracture_{name}_{key}", "Below the flanks of gear {one.gear} ({key}) of pair {name}",
            (
                "depth", "hardness", "residual", "strength",
                Each("rows", *(
                    Cell(one, name=f"{one}_{{one.key}}", further=" below {one.letter}")
                    for one in ("load_stress", "stress", "exposure")
                )),
            ),
            of=lambda seen: seen.one.rows[0], each=_flanks,
        ),
        Rows(
            "case_depth_{name}", "Case depths of pair {name} and limits",
            (Every("depths"), "found.crushing", "found.least_agma"),
            of=lambda seen: list(_flanks(seen).values()), printed=True,
        ),
    ),
    values=(
        Each(
            _flanks,
            _value("most"),
            _value("safety"),
            _value("most_load"),
            _value("at_depth"),
            _value("case_depth", of="", meaning="at 550 HV (case)"),
            _value("crushing", name="case_depth_crushing", meaning="minimum against case crushing, ISO 6336-5"),
            _value("least_agma", name="case_depth_agma", meaning="minimum of AGMA 2101, with sigma_H of ISO"),
        ),
    ),
    figures=(
        Chart(
            "flank_fracture_{name}_{key}", "Flank fracture of gear {one.gear}",
            f"Gear {{one.gear}} ({{key}}) of pair {{name}}: material exposure A_FF over depth below points A to E "
            f"(permissible {PERMISSIBLE:g}); equivalent shear stress at the maximum exposure, {{one.found.place:.3g}} "
            "from the pitch point, with local strength; hardness.",
            (
                Over(
                    "depth",
                    (Line("exposure", each=Family("points", "at {one.letter}", most=None), look=_PLAIN),),
                    options={"zero": True}, x_options={"zero": True}, marks=_limits,
                ),
                Over(
                    "depth",
                    (
                        Line("load_stress", "load only", "series:1", look={"dash": "dash", **_PLAIN}),
                        Line("stress", "with residual stress", "series:0", look=_PLAIN),
                        Line("strength", "strength", "ink", look=_PLAIN),
                    ),
                    options={"zero": True}, x_options={"zero": True}, marks=_case,
                ),
                Over(
                    "depth", (Line("hardness", "hardness", "ink", look=_PLAIN),), x_options={"zero": True}, marks=_case
                ),
            ),
            of="worst", each=_flanks,
        ),
    ),
    remarks=(lambda seen: fracture_remarks(seen.data, seen.asked),),
    settings={"places": "x.size", "depths": lambda _seen: DEPTHS},
)  # fmt: skip
