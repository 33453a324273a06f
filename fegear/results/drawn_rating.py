"""Figures of the result ``rating``: safeties by every method, and S-N lines with the points of operation."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Bars, Curve, Figure, Mark, Panel, Points
from fegear.geometry.pair import MEMBERS
from fegear.results.rating_methods import methods

if TYPE_CHECKING:
    from fegear.formulas.iso6336.life import Knots
    from fegear.formulas.iso6336.part6_spectrum import Bin
    from fegear.models.rated_pair import PairToRate
    from fegear.results.rating import RatingData

#: First and last load cycles that are drawn.
_FIRST, _LAST = 1e2, 1e11
_MPA = 1e-6
#: Ends of the axis of gears, with room for the word of what is required beside the bars.
_ROOM = (-0.55, 1.85)


def rating_figures(data: RatingData, asked: PairToRate) -> tuple[Figure, ...]:
    """Both figures of a pair."""
    return _safeties(data, asked), _sn_lines(data, asked)


def _safeties(data: RatingData, asked: PairToRate) -> Figure:
    names = tuple(f"{gear} ({member})" for gear, member in zip(asked.gears, MEMBERS, strict=True))
    order = [asked.of(member) for member in MEMBERS]
    required, panels = asked.conditions.required, []
    for contact, label, least in ((True, "S_H, pitting", required[0]), (False, "S_F, root", required[1])):
        items = []
        for number, method in enumerate(methods(data, asked)):
            if np.isnan((method.s_h if contact else method.s_f)[0]):
                continue
            safety, off = (method.s_h, method.s_h_error) if contact else (method.s_f, method.s_f_error)
            height, error = np.array([safety[i] for i in order]), np.array([off[i] for i in order])
            known = bool(np.isfinite(error).all())
            items.append(
                Bars(np.arange(2.0), height, method.name, f"series:{number}", error * height if known else None)
            )
        mark = Mark("y", least, f"required {least:g}")
        panels.append(Panel(Axis(categories=names, limits=_ROOM), Axis(label, zero=True), tuple(items), (mark,)))
    caption = (
        f"Safeties of pair {asked.name} against pitting and tooth breakage by every method; the dotted line is what is "
        "required."
    )
    return Figure(f"rating_{asked.name}", f"Safeties of pair {asked.name}", caption, tuple(panels))


def _line(curve: Knots) -> tuple[list[float], list[float]]:
    """Load cycles and stress [MPa] of an S-N line, drawn beyond its ends."""
    cycles = [_FIRST, *curve.cycles, _LAST]
    return cycles, [curve.at(one) * _MPA for one in cycles]


def _sn_lines(data: RatingData, asked: PairToRate) -> Figure:
    panels = []
    for contact, label in ((True, "contact stress"), (False, "root stress")):
        items: list[Curve | Points] = []
        marks: list[Points] = []
        for number, (member, gear) in enumerate(zip(MEMBERS, asked.gears, strict=True)):
            i = asked.of(member)
            curve = (data.curves.contact if contact else data.curves.bending)[i]
            stress = (data.formula.contact_stress if contact else data.formula.bending_stress)[i]
            items.append(Curve(*_line(curve), f"{gear} ({member}) bears", f"series:{number}", markers=False))
            cycles = asked.conditions.duty.cycles[i]
            if data.spectrum is None:
                shown = [(cycles, stress)]
            else:
                some = [(level.contact if contact else level.bending)[i] for level in data.spectrum.levels]
                shown = [(one.cycles, one.stress) for one in some if _drawn(one)]
            x, y = (np.array(values) for values in zip(*shown, strict=True))
            what = "load" if data.spectrum is None else "spectrum"
            marks.append(Points(x, y * _MPA, f"{gear} ({member}), {what}", f"series:{number}", size=8.0))
            if data.by_computed is not None and data.spectrum is None and (not contact or _computed_flanks(data)):
                own = (data.by_computed.contact_stress if contact else data.by_computed.bending_stress)[i]
                marks.append(
                    Points([cycles], [own * _MPA], f"{gear} ({member}), computed", f"series:{number}", "diamond", 8.0)
                )
        panels.append(Panel(Axis("load cycles", log=True), Axis(label, "MPa", log=True), (*items, *marks)))
    caption = (
        f"What flanks and roots of pair {asked.name} bear over load cycles for a safety of 1, by ISO 6336 parts 2 and "
        "3, and the points of operation."
    )
    return Figure(f"rating_sn_{asked.name}", f"S-N lines of pair {asked.name}", caption, tuple(panels))


def _computed_flanks(data: RatingData) -> bool:
    return data.computed is not None and data.computed.replacement.K_Hbeta is not None


def _drawn(one: Bin) -> bool:
    return one.stress > 0.0 and one.cycles > 0.0
