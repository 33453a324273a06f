"""Stage ``loaded-flanks``: a pair of gears with a width under all its loads, for the stages that report it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, cast

from fegear.base import effects
from fegear.base.notes import exceeding, failing, neglecting
from fegear.base.printed import percent
from fegear.case.built.members import gear_name
from fegear.case.built.pair_checks import check_wide_pair
from fegear.case.built.pair_notes import end_notes, odd_teeth_notes
from fegear.case.built.pair_spec import pair_spec
from fegear.case.built.shafts import on_shafts
from fegear.case.built.table_ends import table_end_notes
from fegear.case.halves import half_notes
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.geometry.plausible_flanks import heavy_load
from fegear.results.forecasts import HERTZ, INVOLUTE, RING
from fegear.results.gear.solved_gear import needs_solid_solution, solid_solution_of
from fegear.results.pair.loaded_teeth import AskedOfTeeth, wide_pairs

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.reading import Scene
    from fegear.contact.wide.loaded_pair import LoadedWidePair as LoadedWidePair  # noqa: PLC0414  (for the window)
    from fegear.contact.wide.on_shafts import LoadedShafts

#: Where the shafts of a case come from (`fegear.results.shafts.loaded_shafts`).
SHAFTS = Task("loaded-shafts", "all")
#: Share of the mean transmission error that gaps may be off by without a remark.
_UNREMARKED = 0.02
#: So many loaded places at a roll position tell too little of the load along a contact line.
_FEWEST = 3
#: Seconds of a contact line of few stations on one gear, stations of which it takes twice that, and those from which on
#: it goes with their cube.
_LINE, _STATIONS, _MANY = 0.007, 24, 46
#: Seconds of the contact at one roll position under one load, and what each square of stations there adds.
_CONTACT, _SQUARE = 0.0006, 8e-8
#: Roll positions under every load: of means and errors, and most of those at which its peaks are looked for.
_OVER_PITCH, _PEAKS = 80, 192


def needs_flanks(_scene: Scene, name: str) -> tuple[Task, ...]:
    """The task of this stage for a pair."""
    return (Task("loaded-flanks", name),)


def loaded_flanks(upstream: Upstream, name: str) -> LoadedWidePair:
    """What this stage computed for a pair."""
    return cast("LoadedWidePair", upstream[Task("loaded-flanks", name)])


def _inputs(scene: Scene, name: str) -> AskedOfTeeth:
    spec = pair_spec(scene, name, over_face=True)
    of_ends = (*table_end_notes(spec), *end_notes(scene, name))
    notes = (*half_notes(scene.case, name), *of_ends, *odd_teeth_notes(scene, name))
    return AskedOfTeeth.of(scene, spec, notes)


def _compute(asked: AskedOfTeeth, upstream: Upstream, work: Work) -> LoadedWidePair:
    from fegear.contact.wide.maker import load_wide

    spec = asked.spec
    if SHAFTS in upstream:
        spec = spec.on(cast("LoadedShafts", upstream[SHAFTS]).gaps_of(spec.name))
    solved = [solid_solution_of(upstream, gear) for gear in spec.gears]
    pair = load_wide(spec, solved, cache=work.cache, progress=work.progress, estimates=asked.estimates)
    return replace(pair, neglected=pair.neglects(asked.answers, asked.loads)) if asked.neglected else pair


def _remarks(seen: Seen) -> Iterator[str]:
    """What was assumed, what is neglected, and where the model ends."""
    name, data, asked = seen.name, seen.data, seen.asked
    yield from asked.notes
    yield from _heavy(name, data)
    yield from _sliced(name, data)
    yield from asked.neglected_notes(data)
    yield from _beside(name, data)
    yield from _short(name, data)


def _settings(seen: Seen) -> dict[str, object]:
    spec, found = seen.asked.spec, seen.data.found
    return {
        "width": spec.width, "positions": spec.face.positions, "panels": spec.panel_count,
        "stations": int(found.lines.present.sum()), "newton_steps": found.contact.steps,
        effects.HERTZ.name: spec.hertz, effects.NEIGHBOUR_COUPLING.name: spec.neighbour_coupling,
        "base_pitch": spec.face.base_pitch, "nominal_load": spec.nominal, "loads": list(spec.loads),
        "positions_of_stated": seen.data.over.found.lines.roll.size,
        "seconds": {key: round(seconds, 6) for key, seconds in found.seconds.items()},
    }  # fmt: skip


def _heavy(name: str, data: LoadedWidePair) -> tuple[str, ...]:
    """Say where no metal carries the load, spread over the face or where it stands."""
    found = data.over.found
    sentence = heavy_load(data.flanks.pair, float(found.load.max()), float(found.largest_pressure.max()))
    return (failing(f"Pair {name}: {sentence}"),) if sentence else ()


def _sliced(name: str, data: LoadedWidePair) -> tuple[str, ...]:
    """Say what slices are."""
    if not data.missed:
        return ()
    told = (
        f"Pair {name}: coupled slices used instead of 3D gears; compliance differs from 3D by up to "
        f"{percent(data.missed)}, included in the estimated errors."
    )
    return (told,)


def _beside(name: str, data: LoadedWidePair) -> tuple[str, ...]:
    """Say where modifications or errors are too steep for the contact lines of unmodified flanks."""
    mean = float(data.stated.mean[data.at])
    if data.beside <= _UNREMARKED * mean:
        return ()
    remark = neglecting(
        f"Pair {name}: steep modifications or deviations shift the contact away from the theoretical contact lines, "
        f"changing gaps by up to {data.beside * 1e6:.3g} um (mean transmission error {mean * 1e6:.4g} um). Included "
        f"in te_unloaded of load_distribution_roll_{name}, neglected in loads."
    )
    return (remark,)


def _short(name: str, data: LoadedWidePair) -> tuple[str, ...]:
    """Say where the load stands on so few places that panels are too long for it."""
    found = data.found
    fewest = (found.contact.force > 0.0).sum(axis=1).min(axis=0)
    if fewest.min() > _FEWEST:
        return ()
    i = int(fewest.argmin())
    remark = exceeding(
        f"Pair {name}: at {found.load[i]:.4g} N as few as {fewest[i]} points carry load at a roll position, too few "
        "to resolve the load distribution. Increase load_distribution.panels."
    )
    return (remark,)


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    gears = needs_solid_solution(gear_name(scene, name, "driver"), gear_name(scene, name, "driven"))
    return (*gears, SHAFTS) if scene.case.effects.misalignment and on_shafts(scene, name) else gears


def _forecast(scene: Scene, name: str) -> Forecast:
    asked = pair_spec(scene, name, over_face=True)
    pair, loads = asked.placed, 1 + len(asked.loads)
    width = min(pair.driver.face_width, pair.driven.face_width)
    stations = 1.0 + width / (asked.panel * pair.driver.module)
    lines = asked.face.positions * (1.0 + pair.total_contact_ratio)
    long = max(1.0, stations / _STATIONS * (1.0 + (stations / _MANY) ** 2))
    problem = _CONTACT + _SQUARE * (stations * math.ceil(pair.total_contact_ratio)) ** 2
    seconds = 2.0 * 2.0 * _LINE * lines * long + problem * loads * (_OVER_PITCH + min(4 * loads, _PEAKS))
    return Forecast({"positions": asked.face.positions, "panels": asked.panel_count}, seconds)


_SHEET = Sheet(remarks=(_remarks,), settings=_settings)


cites = citing(*RING, HERTZ, INVOLUTE, Citation("johnson", "half-space under the contacts", "sections 3.2 and 4.2"))


LOADED_FLANKS = Stage(
    subjects=wide_pairs,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    needs=_needs,
    check=check_wide_pair,
    cites=cites,
    forecast=_forecast,
)
