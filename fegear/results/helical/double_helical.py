"""Result ``double-helical``: how both halves of a double helical pair share the load, and how the pinion floats."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.base.notes import assuming, exceeding, failing, neglecting
from fegear.base.printed import figures
from fegear.case.built.double_helical import (
    DoubleToLoad,
    check_double,
    double_helical_pairs,
    double_part,
    double_to_load,
)
from fegear.case.built.members import gear_name
from fegear.case.built.solid_influence import solve_solid_influence
from fegear.engine.citation import citing
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.seen import itself
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.geometry.pair import MEMBERS, Member
from fegear.results.forecasts import HERTZ, INVOLUTE, RING
from fegear.results.gear.solved_gear import needs_solid_solution, solid_solution_of
from fegear.results.helical.double_helical_data import DoubleHelicalData, ShownDouble

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.base.arrays import Array
    from fegear.case.built.solid_influence import SolidGearToSolve
    from fegear.case.reading import Scene
    from fegear.contact.double_helical.double_stress import LargestTension
    from fegear.engine.sheet.seen import Seen
    from fegear.fem.solid.influence import SolidInfluence

#: Shares nearer to a half are even.
_EVEN = 1e-9
#: Seconds of both halves at one mesh position under one load, about.
_SECONDS = 0.25


def _gears(asked: DoubleToLoad, upstream: Upstream, work: Work) -> list[list[SolidInfluence]]:
    """Solved gears of both halves: those at end II mirror those at end I where they have no name."""
    first = [solid_solution_of(upstream, gear) for gear in asked.gears]
    second = []
    for one, other in zip(first, asked.second, strict=True):
        if isinstance(other, str):
            second.append(solid_solution_of(upstream, other))
        else:
            second.append(_mirror(one, other, work))
    return [first, second]


def _mirror(solved: SolidInfluence, other: SolidGearToSolve, work: Work) -> SolidInfluence:
    from fegear.fem.solid.mirrored import can_be_mirrored, mirrored_influence

    if can_be_mirrored(solved.fine):
        return mirrored_influence(solved)
    return solve_solid_influence(other, work.cache)


def _compute(asked: DoubleToLoad, upstream: Upstream, work: Work) -> DoubleHelicalData:
    from fegear.contact.double_helical.double_stress import largest_tension
    from fegear.contact.double_helical.load_double import load_double

    gears = _gears(asked, upstream, work)
    pair = load_double(asked.spec, gears, cache=work.cache, estimates=asked.estimates)
    work.progress(0.8)
    at = asked.spec.loads.index(asked.nominal)

    def largest(number: int, member: Member) -> LargestTension:
        return largest_tension(pair, number, member, gears[number][MEMBERS.index(member)], at, work.cache)

    stress = tuple((largest(number, "driver"), largest(number, "driven")) for number in range(2))
    return DoubleHelicalData(pair, at, stress)


def _remarks(seen: Seen) -> Iterator[str]:
    """What was assumed of the float, and where the model ends."""
    name, shown, asked = seen.name, seen.data, seen.asked
    if asked.assumed:
        yield assuming(f"Pair {name}: {shown.floating} floats (gear with fewer teeth; double_helical.floating).")
    if shown.floating:
        yield neglecting(
            f"Pair {name}: axial motion is quasi-static, without mass and friction of the floating member; valid below "
            "its axial resonance."
        )
    if shown.at_stop:
        yield exceeding(
            f"Pair {name}: the {shown.floating} touches a stop of its axial play: axial forces do not balance."
        )
    for end in shown.idle:
        where = " at some mesh positions" if shown.halves[end].share_max else ""
        yield failing(f"Pair {name}: the half at end {end} carries no load{where}.")
    if shown.back:
        yield failing(
            f"Pair {name}: the non-working flanks of the unloaded half touch (backlash closed), which is not included; "
            "reduce apex_offset or increase the backlash."
        )
    if asked.rigid:
        yield neglecting(
            f"Pair {name}: torsion of the shafts between the halves is not included (set double_helical.torque_in "
            "and torque_out)."
        )


def _floats(seen: Seen) -> str:
    """What the floating member does, or what both bearings carry, as a sentence."""
    shown = seen.data
    offset = shown.pair.spec.apex_offset
    if shown.floating is None:
        return seen.said(
            "Both members are located: the apex offset of "
            f"{figures(offset * 1e6, 3)} µm results in an axial force of {{v[axial_force_mean]}}."
        )
    taken = f" and takes up the apex offset of {figures(offset * 1e6, 3)} µm" if offset and not shown.at_stop else ""
    limit = ", limited by its axial play" if shown.at_stop else ""
    moves = "moves {v[axial_motion_peak_to_peak]} peak-to-peak" if shown.axial_motion_peak_to_peak else "does not move"
    return seen.said(f"The {shown.floating} floats{taken}{limit}: it {moves} over the base pitch.")


def _more(seen: Seen) -> str:
    """The half that carries more."""
    halves = seen.data.halves
    return "I" if halves["I"].share >= halves["II"].share else "II"


def _carries(seen: Seen) -> str:
    more, halves = _more(seen), seen.data.halves
    if halves[more].share_max - 0.5 < _EVEN:
        return seen.said("Pair {name}: both halves carry half of the load each: K_gamma = {v[K_gamma]}.")
    return seen.said(
        f"Pair {{name}}: the half at end {more} carries {{v[share_{more}]:%}} of the load (at most "
        f"{{v[share_max_{more}]:%}}); K_gamma = {{v[K_gamma]}}."
    )


def _each(*keys: str) -> tuple[Number, ...]:
    """Numbers of either half, with their errors."""
    return tuple(
        Number(key, f"{key}_error", each="halves", of=itself, ending="_{key}", further=", half at end {key}")
        for key in keys
    )


def _of_halves(key: str) -> Cell:
    """A column of the table of both halves, with its errors."""

    def errors(seen: Seen) -> Array | None:
        found = [getattr(half, f"{key}_error") for half in seen.data.halves.values()]
        return None if None in found else np.array(found)

    return Cell(key, error=errors)


_TABLES = (
    Rows(
        "double_helical_{name}", "Both halves of pair {name} over the base pitch",
        (
            "x", Cell("te", error="over_pitch.te_error"), Cell("first_share", error="over_pitch.share_error"),
            "second_share",
            Cell("axial_motion", error="over_pitch.motion_error"), Cell("axial_force", error="over_pitch.force_error"),
            "mesh_stiffness",
        ),
        of="over_pitch",
    ),
    Rows(
        "double_helical_halves_{name}", "Halves of pair {name}",
        (
            "end", _of_halves("share"), "share_max", "share_min", "load",
            *(_of_halves(key) for key in ("face_load_factor", "driver_tension", "driven_tension")),
        ),
        of=lambda seen: list(seen.data.halves.values()), printed=True,
    ),
    Rows(
        "double_helical_harmonics_{name}", "Excitation by pair {name}: harmonics",
        ("n", "frequency", "te", "axial_motion", "axial_force", "axial_acceleration"), of="harmonics",
    ),
    Rows(
        "double_helical_face_{name}", "Load over both faces of pair {name}",
        ("end", "z", "load"), stacked="faces",
    ),
    Rows(
        "double_helical_loads_{name}", "Pair {name} for every load",
        (
            "load", "load_factor", "te_mean", "te_peak_to_peak", "K_Hbeta_I", "K_Hbeta_II", "motion_mean",
            "motion_peak_to_peak", "force_mean",
        ),
        of="over_loads", when=lambda seen: len(seen.loads) > 1,
    ),
)  # fmt: skip
_VALUES = (
    Number("load_factor", "error.load_factor"),
    *_each("share", "share_max", "face_load_factor", "driver_tension", "driven_tension"),
    Number("te_mean", "error.mean"),
    Number("te_peak_to_peak", "error.peak_to_peak"),
    Number("axial_motion_mean", "motion_error"),
    Number("axial_motion_peak_to_peak", "motion_swing_error"),
    Number("apex_distance", "motion_error"),
    Number("axial_force_mean", "force_error"),
    Number("axial_force_peak_to_peak", "force_swing_error"),
    Number("axial_stiffness"),
)
_FIGURES = (
    Chart(
        "double_helical_face_{name}", "Load over both faces of pair {name}",
        "Pair {name}: mean load per face width over a base pitch, ends I (left) and II (right) with the gap between "
        "them; dashed: equal load. K_gamma = {d.load_factor:.4g}.",
        (
            Over(
                "z",
                (
                    Line("load", x="z", each=Family("faces", "half at end {key}"), look={"markers": False}),
                    Line("even", x="z", each=Family("faces", "", "grey"), look={"dash": "dash", "markers": False}),
                ),
                "load", options={"zero": True},
            ),
        ),
        of="face_of_first", under="{load:said}",
    ),
    Chart(
        "double_helical_{name}", "Load sharing and axial motion of pair {name} over a base pitch",
        "Pair {name}: shares of both halves, transmission error and axial displacement of the floating member; bands "
        "are estimated errors.",
        (
            Over(
                "x",
                (Line("first_share", "half at end I", "series:0"), Line("second_share", "half at end II", "series:1")),
            ),
            Over("x", (Line("te", error="over_pitch.te_error"),)),
            Over(
                "x", (Line("axial_motion", error="over_pitch.motion_error"),), when=lambda seen: seen.data.floating,
            ),
            Over("x", (Line("axial_force", error="over_pitch.force_error"),), when=lambda seen: not seen.data.floating),
        ),
        of="over_pitch", under="{load:said}",
    ),
)  # fmt: skip


_SHEET = Sheet(
    of=lambda data, asked: ShownDouble(data, asked.frequency),
    loads="loads",
    nominal="at",
    tables=_TABLES,
    values=_VALUES,
    figures=_FIGURES,
    remarks=(_remarks,),
    settings={
        "positions": "over_pitch.x.size", "gap": "pair.spec.gap", "floating": "floating",
        "balance_steps": "pair.balance.steps",
    },
    answer=Answer(
        lambda seen: [_carries(seen)],
        lambda seen: [_floats(seen)],
        "K_Hbeta = {v[K_Hbeta_I]} at end I and {v[K_Hbeta_II]} at end II; transmission error {v[te_peak_to_peak]} "
        "peak-to-peak.",
        "Maximum root stress {v[root_tension_driver_I]} and {v[root_tension_driver_II]} (driver, ends I and II), "
        "{v[root_tension_driven_I]} and {v[root_tension_driven_II]} (driven).",
        figure="double_helical_face_{name}",
    ),
)  # fmt: skip


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    others = double_part(scene, name).others.values()
    gears = (gear_name(scene, name, "driver"), gear_name(scene, name, "driven"), *(one for one in others if one))
    return needs_solid_solution(*gears)


def _forecast(scene: Scene, name: str) -> Forecast:
    asked = double_to_load(scene, name)
    positions = asked.spec.halves[0].face.positions
    return Forecast({"positions": positions}, _SECONDS * positions * (1.0 + 0.3 * len(asked.spec.loads)))


DOUBLE_HELICAL = Stage(
    subjects=double_helical_pairs,
    inputs=double_to_load,
    compute=_compute,
    present=_SHEET.present,
    needs=_needs,
    check=check_double,
    cites=citing(*RING, HERTZ, INVOLUTE),
    forecast=_forecast,
)
