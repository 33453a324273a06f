"""What a gearbox comes to in sentences: whether it passes, what to change, then safeties, misalignment and lives."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

from fegear.base.printed import figures
from fegear.results.shafts.gearbox_changes import limit_of
from fegear.results.shafts.other_direction import said_of_other_direction

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fegear.engine.sheet.seen import Seen
    from fegear.results.shafts.gearbox_changes import Change
    from fegear.results.shafts.gearbox_data import GearboxData

#: Linear gap [m] that modifications change by less is that of the shafts.
_MODIFIED = 0.1e-6
#: A gap below is zero but for round-off [m].
_ZERO = 1e-12
#: Parts that the verdict names, and changes with a line each.
_NAMED, _LINES = 4, 3


def sentences(seen: Seen) -> Iterator[str]:
    """Whether it passes, then its weakest parts and what to change; what fails is changed before."""
    data: GearboxData = seen.data
    changes = list(_changes(data.changes))
    state = [f"Cannot be built: {data.changes[0].finding}."] if data.failures else []
    verdict = _verdict(data)
    rated, misaligned, weakest = _states(data, " ".join(verdict))
    turned = said_of_other_direction(data.bearings, data.required_hours, data.turned_by)
    # an answer has five sentences, fewer beside another result's: changes are lines of the second one
    first, *others = *state, *verdict, *rated, *misaligned, *weakest
    if data.failures or any(one.fails for one in data.changes):
        first, *others = *state, *verdict, *weakest, *rated, *([] if state else misaligned)
    yield first
    if changes:
        yield "\n".join(changes)
    yield from (*turned, *others)


def _verdict(data: GearboxData) -> list[str]:
    """What fails, with values and required ones; where nothing does, the weakest mesh, bearing and shaft."""
    short = [one.verdict for one in data.changes if one.fails and one.part != "assembly"]
    if short:
        more = f" and {len(short) - _NAMED} more" if len(short) > _NAMED else ""
        return [f"Fails: {', '.join(short[:_NAMED])}{more}."]
    parts, margins = [], []
    mesh = data.meshes[0]
    if math.isfinite(mesh.margin) and mesh.safety is not None:
        symbol, what, value, least, _ = limit_of(mesh, mesh.safety)
        parts.append(f"pair {mesh.pair} {what} {symbol} {value:.2f} ({figures(least)} required)")
        margins.append(mesh.margin)
    lasting = [one for one in data.bearings if math.isfinite(one.margin)]
    if lasting:
        hours, required = (figures(life / 3600.0) for life in (lasting[0].duration, data.required_hours))
        parts.append(f"bearing {lasting[0].bearing} life {hours} h ({required} h required)")
        margins.append(lasting[0].margin)
    if data.checked:
        shaft = data.checked[0]
        parts.append(f"shaft {shaft.shaft} yielding S_yield {shaft.safety:.2f} ({figures(shaft.required)} required)")
        margins.append(shaft.margin)
    if not parts or data.failures or min(margins) < 1.0:
        return []
    return [f"Passes: {', '.join(parts)}."]


def _changes(changes: Sequence[Change]) -> Iterator[str]:
    """A line for each of the first, one in short words for all others."""
    for number, one in enumerate(changes[:_LINES], 1):
        yield f"Change {number}, {one.part}: {one.beside or one.finding}; {one.told or one.remedy}."
    if others := changes[_LINES:]:
        numbers = f"Change {_LINES + 1}" if len(others) == 1 else f"Changes {_LINES + 1} to {len(changes)}"
        yield f"{numbers}: {'; '.join(f'{one.part}: {one.brief}' for one in others)}."


def _states(data: GearboxData, verdict: str) -> tuple[list[str], list[str], list[str]]:
    """Sentences on the weakest mesh, its safeties and its misalignment, and on the weakest bearing and shaft.

    What the verdict has is not said again.
    """
    safety: list[str] = []
    first = data.meshes[0]
    many = f", the weakest of {len(data.meshes)}" if len(data.meshes) > 1 else ""
    known, rated = [], first.safety is not None and math.isfinite(first.safety.face_load_factor)
    if math.isfinite(first.margin):
        known = [
            f"{symbol} {value:.2f} ({figures(minimum)} required)"
            for symbol, value, minimum in (
                ("S_H", first.contact, first.contact_required), ("S_F", first.bending, first.bending_required)
            )
            if not _has(verdict, f"pair {first.pair}", symbol)
        ]  # fmt: skip
        said = ", ".join(known)
        if rated and first.safety is not None:
            of = "ISO 6336-1, with manufacturing deviations"
            if first.safety.of_flanks:
                of = f"loaded flanks; {of}: {first.safety.formula:.2f}"
            said += f"; S_H and S_F at K_Hβ {first.safety.face_load_factor:.2f} ({of})"
        safety.append(f"Pair {first.pair}{many}: {said}.")
        known, many = [], ""
    modified = ""
    if abs(first.remaining - first.over_face) > _MODIFIED:
        left = first.remaining if abs(first.remaining) > _ZERO else 0.0
        modified = f" (linear gap with the flank modifications {figures(left * 1e6, 2)} µm)"
    known.append(f"misaligned by {figures(first.over_face * 1e6)} µm{modified}")
    if math.isfinite(first.face_load_factor):
        known.append(
            f"K_Hβ {first.face_load_factor:.2f}" + (" of the loaded flanks (without these deviations)" if rated else "")
        )
    if math.isfinite(first.te_peak_to_peak):
        known.append(f"transmission error {figures(first.te_peak_to_peak * 1e6)} µm peak to peak")
    weakest = "; ".join(one for one in (_weakest_bearing(data, verdict), _weakest_shaft(data, verdict)) if one)
    return (
        safety, [f"Pair {first.pair}{many}: {', '.join(known)}."],
        [f"{weakest[0].upper()}{weakest[1:]}."] if weakest else [],
    )  # fmt: skip


def _has(verdict: str, part: str, what: str) -> bool:
    """Whether the verdict has this value of a part."""
    return re.search(rf"\b{re.escape(part)} [^,:]*{re.escape(what)} ", verdict) is not None


def _weakest_bearing(data: GearboxData, verdict: str) -> str:
    """Of those with a life: the first in order, which has the least margin or the shortest life."""
    lives = [one for one in data.bearings if math.isfinite(one.life)]
    if not lives or _has(verdict, f"bearing {lives[0].bearing}", "life"):
        return ""
    first = lives[0]
    life = (
        f"{figures(first.duration / 3600.0)} h" if math.isfinite(first.duration)
        else f"{figures(first.life * 1e-6)} million revolutions"
    )  # fmt: skip
    required = f" (required {figures(data.required_hours / 3600.0)} h)" if math.isfinite(data.required_hours) else ""
    many = f", the weakest of {len(lives)}" if len(lives) > 1 else ""
    return f"bearing {first.bearing} of shaft {first.shaft}{many}: basic rating life {life}{required}"


def _weakest_shaft(data: GearboxData, verdict: str) -> str:
    if not data.checked or _has(verdict, f"shaft {data.checked[0].shaft}", "S_yield"):
        return ""
    one, many = data.checked[0], len(data.checked)
    of = f", the weakest of {many}" if many > 1 else ""
    stress, safety = figures(one.equivalent * 1e-6), f"S_yield {one.safety:.2f} (minimum {figures(one.required)})"
    return f"shaft {one.shaft}{of}: nominal stress {stress} MPa at {figures(one.at * 1e3)} mm, {safety}"
