"""Figures of the result ``flank-fracture``: exposure, stress and strength, and hardness over depth, for either gear."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.engine.figure import Axis, Curve, Figure, Mark, Panel
from fegear.formulas.iso6336.part4_flank_fracture import PERMISSIBLE
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from fegear.geometry.pair import Member
    from fegear.results.flank_fracture import FlankFractureData, FlankFractureInputs

_MPA = 1e-6


def fracture_figures(data: FlankFractureData, inputs: FlankFractureInputs) -> tuple[Figure, ...]:
    """One figure a gear."""
    return tuple(_figure(member, data, inputs) for member in MEMBERS)


def _figure(member: Member, data: FlankFractureData, inputs: FlankFractureInputs) -> Figure:
    name, i, gear = inputs.asked.name, MEMBERS.index(member), data.gears[member]
    depth, case = gear.depth * 1e3, inputs.cases[i]
    abscissa = Axis("depth below the flank", "mm", zero=True)
    marks = (Mark("x", case.case_depth * 1e3, "CHD"),) if case.case_depth == case.case_depth else ()
    worst = int(abs(data.x - gear.place).argmin())
    exposures = [
        Curve(depth, gear.found.exposure[k], f"at {letter}", f"series:{n}", markers=False)
        for n, (letter, k) in enumerate(data.points.items())
    ]
    stresses = [
        Curve(depth, gear.found.load_stress[worst] * _MPA, "load alone", "series:1", dash="dash", markers=False),
        Curve(depth, gear.found.stress[worst] * _MPA, "with residual stress", "series:0", markers=False),
        Curve(depth, gear.found.strength * _MPA, "strength", "ink", markers=False),
    ]
    hardness = [Curve(depth, gear.hardness, "hardness", "ink", markers=False)]
    caption = (
        f"Gear {inputs.asked.gears[i]} ({member}) of pair {name}: material exposure A_FF over the depth below points "
        f"A to E, {PERMISSIBLE:g} at most; equivalent shear stress where the exposure is largest, "
        f"at {gear.place * 1e3:.3g} mm from the pitch point, with the local strength; and hardness."
    )
    return Figure(
        f"flank_fracture_{name}_{member}", f"Flank fracture of gear {inputs.asked.gears[i]}", caption,
        (
            Panel(abscissa, Axis("material exposure A_FF", zero=True), tuple(exposures),
                  (*marks, Mark("y", PERMISSIBLE, f"{PERMISSIBLE:g}"), Mark("x", gear.at_depth * 1e3, "largest"))),
            Panel(abscissa, Axis("shear stress", "MPa", zero=True), tuple(stresses), marks),
            Panel(abscissa, Axis("hardness HV"), tuple(hardness), marks),
        ),
    )  # fmt: skip
