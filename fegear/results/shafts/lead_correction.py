"""Result ``lead-correction``: helix slope and crowning of each mesh on its shafts, K_Hbeta before and after."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.base.printed import figures
from fegear.base.shown import shown
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Stage, Task
from fegear.results import forecasts
from fegear.results.relief.grinding import CROWNING, OF_LEADS, SLOPE, Grinding, grinding_table
from fegear.results.shafts.loaded_shafts import (
    LOADED_SHAFTS_TASK,
    LoadedShaftsInputs,
    fed_pairs,
    inputs_of_shafts,
    loaded_shafts,
    mesh_forces,
    needs_gears_of_meshes,
    shafts_of,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.design.flanks.lead_correction import LeadCorrection
    from fegear.engine.sheet.seen import Seen
    from fegear.engine.stage import Upstream, Work

#: The design with the corrected slope and the present crowning, where the correction has less.
_KEPT = "lead correction, present crowning"
#: Seconds of one search on computed flanks under one load.
_SEARCH = 5.0


@dataclass(frozen=True)
class LeadInputs:
    """What the result reads: the loaded shafts, and of every mesh the driver with its present lead [m]."""

    shafts: LoadedShaftsInputs
    drivers: tuple[str, ...]
    slopes: tuple[float, ...]
    crownings: tuple[float, ...]


@dataclass(frozen=True)
class LeadData:
    """Corrections of every mesh; None where the load stays even over the face."""

    pairs: tuple[str, ...]
    radii: tuple[float, ...]
    found: tuple[LeadCorrection | None, ...]


@dataclass(frozen=True)
class GroundLead:
    """What is to be ground on the driver of a mesh: amounts of all of the lead, present ones included."""

    torque: Array = shown("N.m", "torque of the driver", label="torque of the driver")
    before: Array = shown("", "K_Hbeta with the present lead", name="K_Hbeta_before", label="K_Hβ")
    after: Array = shown("", "K_Hbeta with the corrected lead", name="K_Hbeta_after", label="K_Hβ")
    left: Array | None = None
    kept: Array | None = None
    present: float = 0.0
    pair: str = shown("", "gear pair", default="")
    gear: str = shown("", "gear that is corrected", default="")
    slope: float = shown(
        "um", "helix slope modification C_Hbeta: zero at end I, this at end II", name="slope", default=0.0
    )
    crowning: float = shown("um", "lead crowning C_beta", name="crowning", default=0.0)

    @property
    def grinding(self) -> tuple[Grinding, ...]:
        """The whole lead as rows of the grinding table; zero, too, where the present lead is to go."""
        crownings = {"lead correction": self.crowning}
        if self.present > self.crowning:
            crownings[_KEPT] = self.present
        return tuple(
            Grinding(self.gear, "driver", design, kind, shape, amount)
            for design, crowning in crownings.items()
            for kind, shape, amount in ((SLOPE, "linear", self.slope), (CROWNING, "parabolic", crowning))
        )


def _inputs(scene: Scene, name: str) -> LeadInputs:
    shafts = inputs_of_shafts(scene, name)
    drivers = tuple(scene.case.pair[mesh.pair].driver for mesh in shafts.gearbox.meshes)
    counts = scene.case.effects.relief  # a lead that does not count is none that the correction adds to
    leads = [scene.case.gear[gear].lead if counts else None for gear in drivers]
    slopes, crownings = (
        tuple(0.0 if lead is None else float(getattr(lead, key)) for lead in leads) for key in ("slope", "crowning")
    )
    return LeadInputs(shafts, drivers, slopes, crownings)


def _compute(inputs: LeadInputs, upstream: Upstream, work: Work) -> LeadData:
    from fegear.design.flanks.lead_correction import correct_leads

    box = inputs.shafts.gearbox
    meshes = mesh_forces(inputs.shafts, upstream, work)
    leads = list(zip(inputs.slopes, inputs.crownings, strict=True))
    found = correct_leads(box, meshes, loaded_shafts(upstream), leads, work.progress)
    radii = tuple(mesh.found.driver.base_radius for mesh in box.meshes)
    return LeadData(tuple(mesh.pair for mesh in box.meshes), radii, found)


def _ground(data: LeadData, asked: LeadInputs) -> list[GroundLead]:
    """Of every corrected mesh, the one that gains most first."""
    rows = zip(data.pairs, data.radii, data.found, asked.drivers, asked.crownings, strict=True)
    made = [
        GroundLead(
            one.loads * radius, one.before, one.after, one.left, one.kept, crowning, pair, gear, one.slope, one.crowning
        )
        for pair, radius, one, gear, crowning in rows
        if one is not None
    ]
    return sorted(made, key=lambda one: float(one.after[-1] - one.before[-1]))


def _sentences(seen: Seen) -> Iterator[str]:
    for one in seen.data:
        slope, crowning = figures(one.slope * 1e6), figures(one.crowning * 1e6)
        kept = ""
        if one.kept is not None and one.present != one.crowning:
            kept = f", {one.kept[-1]:.2f} with the present crowning of {figures(one.present * 1e6)} µm"
            kept += " (for manufacturing deviations)" if one.present > one.crowning else ""
        yield (
            f"Pair {one.pair}: grind a helix slope C_Hβ of {slope} µm and a crowning C_β of {crowning} µm on gear "
            f"{one.gear}: K_Hβ {one.before[-1]:.2f} -> {one.after[-1]:.2f} at {figures(one.torque[-1])} N m{kept}."
        )


def _remarks(seen: Seen) -> Iterator[str]:
    yield (
        "Lead correction: for the deflections of shafts, bearings and housing only; the crowning is the total one, "
        "present crowning is not kept: add the crowning that manufacturing deviations require. S_H and S_F include "
        "these deviations (f_ma, ISO 6336-1) and may fall with less crowning; "
        f'fegear apply --relief "{_KEPT}" keeps the present one.'
    )
    yield (
        "Lead correction: K_Hbeta before and after is that of the loaded flanks at nominal load. Not that of S_H and "
        "S_F (K_Hbeta_rated, ISO 6336-1 with manufacturing deviations) nor K_Hbeta_iso (linear part of the gap only)."
    )
    if seen.data:
        yield (
            "Lead correction: amounts are multiples of 0.5 um, over the face of the driver; to check them use "
            f'fegear apply, or set gear.{seen.data[0].gear}.lead slope = "{seen.data[0].slope * 1e6:.3g} um" and '
            f'crowning = "{seen.data[0].crowning * 1e6:.3g} um", and effects.relief = true.'
        )
    left = max((float(one.left.max()) for one in seen.data), default=0.0)
    if left > _SETTLED:
        yield f"Lead correction: K_Hbeta still changes by {left:.2g} with the shaft deflection of the corrected flanks."


#: K_Hbeta that changes by less from one round to the next has settled.
_SETTLED = 0.02

_SHEET = Sheet(
    answer=Answer(_sentences, figure=lambda seen: f"lead_correction_{seen.data[0].pair}" if seen.data else ""),
    of=_ground,
    name=lambda _asked: "",
    tables=(
        Rows(
            "lead_correction", "Lead correction for grinding",
            ("pair", "gear", "slope", "crowning", "torque", "before", "after"), stacked="",
        ),
        grinding_table(OF_LEADS + "{one.pair}", "Lead to grind on gear {one.gear} in pair {one.pair}", "grinding", ""),
    ),
    values=(
        Number("slope", owner="{one.pair}", name="lead_slope", each=""),
        Number("crowning", owner="{one.pair}", name="lead_crowning", each=""),
    ),
    figures=(
        Chart(
            "lead_correction_{one.pair}", "K_Hβ of pair {one.pair} before and after lead correction",
            "Pair {one.pair}: K_Hβ over torque with the present and with the corrected lead of gear {one.gear}.",
            (
                Over(
                    "torque",
                    (Line("before", "present lead", "series:0"), Line("after", "corrected lead", "series:1")),
                ),
            ),
            each="",
        ),
    ),
    remarks=(_remarks,),
)  # fmt: skip


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    return (LOADED_SHAFTS_TASK, *needs_gears_of_meshes(scene, name))


def _check(scene: Scene, _name: str) -> None:
    if not fed_pairs(scene):
        raise InputError(
            "results", '"lead-correction"', "requires a pair on shafts that is loaded over the face",
            'set width = "slices" or "solid" for a pair whose gears are both on shafts',
        )  # fmt: skip


LEAD_CORRECTION = Stage(
    subjects=shafts_of,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    needs=_needs,
    check=_check,
    cites=citing(Citation("cowper", "shear coefficient of hollow circles")),
    forecast=lambda scene, _name: forecasts.constant(_SEARCH * max(1, len(fed_pairs(scene)))),
)
