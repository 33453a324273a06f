"""Result ``lead-correction``: helix slope and crowning of each mesh on its shafts, K_Hbeta and safety factors."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.base.printed import figures
from fegear.base.shown import shown
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Stage, Task
from fegear.results import forecasts
from fegear.results.relief.grinding import CROWNING, OF_LEADS, SLOPE, Grinding, grinding_table
from fegear.results.shafts.gearbox_changes import end_of_slope
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
from fegear.results.shafts.rated_lead import SafetyOfLead, present_lead, rated_lead, rated_with

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.design.flanks.lead_correction import LeadCorrection
    from fegear.engine.sheet.seen import Seen
    from fegear.engine.stage import Upstream, Work
    from fegear.results.shafts.rated_lead import RatedLead

#: The design with the corrected slope and the present crowning, where the correction has less.
_KEPT = "lead correction, present crowning"
#: Seconds of one search on computed flanks under one load.
_SEARCH = 5.0
#: The present lead and the correction; a third one keeps the present crowning.
_LEADS = 2


@dataclass(frozen=True)
class LeadInputs:
    """What the result reads: the loaded shafts, and of every mesh the driver with its present lead [m]."""

    shafts: LoadedShaftsInputs
    drivers: tuple[str, ...]
    slopes: tuple[float, ...]
    crownings: tuple[float, ...]
    rated: tuple[RatedLead | None, ...]


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
    present: float = 0.0
    pair: str = shown("", "gear pair", default="")
    gear: str = shown("", "gear that is corrected", default="")
    slope: float = shown(
        "um", "helix slope modification C_Hbeta: zero at end I, this at end II", name="slope", default=0.0
    )
    crowning: float = shown(
        "um", "lead crowning C_beta", name="crowning", default=0.0
    )  # fmt: skip

    leads: tuple[SafetyOfLead, ...] = ()

    @property
    def grinding(self) -> tuple[Grinding, ...]:
        """The whole lead as rows of the grinding table; zero, too, where the present lead is to go."""
        return tuple(
            Grinding(self.gear, "driver", lead.design, kind, shape, amount)
            for lead in self.leads[1:]
            for kind, shape, amount in ((SLOPE, "linear", lead.slope), (CROWNING, "parabolic", lead.crowning))
        )

    @property
    def best(self) -> SafetyOfLead:
        """The lead to grind."""
        return self.leads[1]


def _inputs(scene: Scene, name: str) -> LeadInputs:
    shafts = inputs_of_shafts(scene, name)
    drivers = tuple(scene.case.pair[mesh.pair].driver for mesh in shafts.gearbox.meshes)
    leads = [present_lead(scene, mesh.pair) for mesh in shafts.gearbox.meshes]
    slopes, crownings = tuple(slope for slope, _ in leads), tuple(crowning for _, crowning in leads)
    rows = tuple(rated_lead(scene, mesh.pair) for mesh in shafts.gearbox.meshes)
    return LeadInputs(shafts, drivers, slopes, crownings, rows)


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
    rows = zip(
        data.pairs, data.radii, data.found, asked.drivers, asked.slopes, asked.crownings, asked.rated, strict=True
    )
    made = [
        _ground_lead(pair, radius, one, gear, crowning, _leads(pair, one, (slope, crowning), lead))
        for pair, radius, one, gear, slope, crowning, lead in rows
        if one is not None
    ]
    return sorted(made, key=lambda one: float(one.after[-1] - one.before[-1]))


def _ground_lead(
    pair: str, radius: float, one: LeadCorrection, gear: str, present: float, leads: tuple[SafetyOfLead, ...]
) -> GroundLead:  # fmt: skip
    """With the amounts and factors of the lead to grind."""
    best = leads[1]
    after = one.kept if best.design == _KEPT else one.after
    return GroundLead(
        one.loads * radius, one.before, after, one.left, present, pair, gear, best.slope, best.crowning, leads
    )


def _leads(
    pair: str, found: LeadCorrection, present: tuple[float, float], rated: RatedLead | None
) -> tuple[SafetyOfLead, ...]:
    """The present lead and those that can be ground, the one with the higher safety factor for pitting first."""
    rows = [
        SafetyOfLead(pair, "present", *present, float(found.before[-1])),
        SafetyOfLead(pair, "lead correction", found.slope, found.crowning, float(found.after[-1])),
    ]
    if present[1] > found.crowning:
        rows.append(SafetyOfLead(pair, _KEPT, found.slope, present[1], float(found.kept[-1])))
    if rated is not None:
        rows = [rated_with(rated, row) for row in rows]
    if len(rows) > _LEADS and rows[2].contact > rows[1].contact:
        rows[1:] = rows[2], rows[1]
    return tuple(rows)


def _sentences(seen: Seen) -> Iterator[str]:
    for one in seen.data:
        slope, best = figures(one.slope * 1e6), one.best
        end = f" ({end_of_slope(one.slope)})" if one.slope else ""
        kept = " (the present one)" if best.crowning and best.crowning == one.present else ""
        yield (
            f"Pair {one.pair}: grind a helix slope C_Hβ of {slope} µm{end} and a crowning C_β of "
            f"{figures(best.crowning * 1e6)} µm{kept} on gear {one.gear}: K_Hβ of the loaded flanks "
            f"{one.before[-1]:.2f} -> {best.flanks:.2f} at {figures(one.torque[-1])} N m"
            f"{_safeties(best, one.leads[0])}."
        )


def _safeties(after: SafetyOfLead, before: SafetyOfLead | None = None) -> str:
    """S_H and S_F, those before first where they are given; empty where the mesh is not rated."""
    said = ""
    for symbol, key in (("S_H", "contact"), ("S_F", "bending")):
        value = getattr(after, key)
        if math.isfinite(value):
            said += f", {symbol} {'' if before is None else f'{getattr(before, key):.2f} -> '}{value:.2f}"
    return said


def _remarks(seen: Seen) -> Iterator[str]:
    yield (
        "Lead correction: slope and crowning are the total ones, for the deflections of shafts, bearings and housing "
        "only. S_H and S_F include manufacturing deviations (f_ma, ISO 6336-1) and fall without crowning. "
        'fegear apply writes the first design of the grinding table, that with the higher S_H; --relief "NAME" another.'
    )
    yield (
        "Lead correction: K_Hbeta before and after is that of the loaded flanks at nominal load. Not that of S_H and "
        "S_F (K_Hbeta_rated, ISO 6336-1 with manufacturing deviations) nor K_Hbeta_iso (linear part of the gap only)."
    )
    for one in seen.data:
        for rest in one.leads[_LEADS:]:
            kept = " (the present one, for manufacturing deviations)" if rest.design == _KEPT else ""
            what = f"K_Hβ of the loaded flanks {rest.flanks:.2f}{_safeties(rest)}"
            yield (
                f"Lead correction, pair {one.pair}: not recommended is {rest.design}, with a crowning of "
                f"{figures(rest.crowning * 1e6)} µm{kept}: {what}."
            )
    if seen.data:
        best = seen.data[0].best
        yield (
            "Lead correction: amounts are multiples of 0.5 um, over the face of the driver; to check them use "
            f'fegear apply, or set gear.{seen.data[0].gear}.lead slope = "{best.slope * 1e6:.3g} um" and '
            f'crowning = "{best.crowning * 1e6:.3g} um", and effects.relief = true.'
        )
    left = max((float(one.left.max()) for one in seen.data), default=0.0)
    if left > _SETTLED:
        yield f"Lead correction: K_Hbeta still changes by {left:.2g} with the shaft deflection of the corrected flanks."


#: K_Hbeta that changes by less from one round to the next has settled.
_SETTLED = 0.02


def _known(key: str) -> Cell:
    """A column that is there where one of its numbers is known."""

    def numbers(seen: Seen) -> list[float] | None:
        found = [float(getattr(lead, key)) for one in seen.data for lead in one.leads]
        return found if any(map(math.isfinite, found)) else None

    return Cell(key, numbers)


_SHEET = Sheet(
    answer=Answer(_sentences, figure=lambda seen: f"lead_correction_{seen.data[0].pair}" if seen.data else ""),
    of=_ground,
    name=lambda _asked: "",
    tables=(
        Rows(
            "lead_correction", "Lead correction for grinding",
            ("pair", "gear", "slope", "crowning", "torque", "before", "after"), stacked="",
        ),
        Rows(
            "lead_safety", "Safety factors before and after lead correction",
            ("pair", "design", "slope", "crowning", "flanks", *map(_known, ("factor", "contact", "bending"))),
            of=lambda seen: [lead for one in seen.data for lead in one.leads],
            when=lambda seen: any(math.isfinite(lead.contact) for one in seen.data for lead in one.leads),
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
