"""Stage ``loaded-flanks``: a pair of gears with a width under all its loads, for the stages that report it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.errors import InputError
from fegear.case.built.loaded_flanks import FlanksToLoad, check_flanks_to_load, flanks_to_load, table_notes
from fegear.case.built.neglected_effects import neglected_remarks
from fegear.case.built.pair_inputs import gear_name
from fegear.case.built.shafts import on_shafts
from fegear.case.effects import GAPS, WIDE_EFFECTS
from fegear.contact.loaded_teeth import Change, Neglected
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.geometry.pair import MEMBERS, Member
from fegear.geometry.plausible_flanks import heavy_load
from fegear.results.forecasts import HERTZ, INVOLUTE, RING
from fegear.results.gear.solved_gear import needs_solid_solution, solid_solution_of
from fegear.results.pair.loaded_teeth import wide_pairs

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from fegear.base.solution_cache import SolutionCache
    from fegear.case.reading import Scene
    from fegear.contact.wide.gaps import FlankGaps
    from fegear.contact.wide.loaded import FlankPair, LoadedFlanks
    from fegear.contact.wide.loaded_pair import LoadedWidePair as LoadedWidePair  # noqa: PLC0414  (for the window)
    from fegear.contact.wide.on_shafts import LoadedShafts
    from fegear.contact.wide.over_pitch import OverPitch, Stated
    from fegear.fem.solid.flank_body import FlankBody

#: Where the shafts of a case come from (`fegear.results.shafts.loaded_shafts`).
_SHAFTS = Task("loaded-shafts", "all")
#: Share of the mean transmission error that gaps may be off by without a remark.
_UNREMARKED = 0.02
#: How often contact lines may be continued farther along tip edges that turn out to be loaded.
_LONGER_EDGES = 3
#: Roll positions that show what tip edges change.
_FEW = 24
#: So many loaded places at a roll position tell too little of the load along a contact line.
_FEWEST = 3
#: Seconds of a contact line of few stations on one gear, stations of which it takes twice that, and those from which on
#: it goes with their cube.
_LINE, _STATIONS, _MANY = 0.007, 24, 46
#: Seconds of the contact at one roll position under one load, and what each square of stations there adds.
_CONTACT, _SQUARE = 0.0006, 8e-8
#: Roll positions under every load: of means and errors, and most of those at which its peaks are looked for.
_OVER_PITCH, _PEAKS = 80, 192
#: Times that flanks are loaded in all, about, for the progress.
_TIMES = 6


def needs_flanks(_scene: Scene, name: str) -> tuple[Task, ...]:
    """The task of this stage for a pair."""
    return (Task("loaded-flanks", name),)


def loaded_flanks(upstream: Upstream, name: str) -> LoadedWidePair:
    """What this stage computed for a pair."""
    return cast("LoadedWidePair", upstream[Task("loaded-flanks", name)])


def load_flanks(
    asked: FlanksToLoad,
    bodies: Mapping[Member, FlankBody],
    cache: SolutionCache,
    progress: Callable[[float], None] | None = None,
) -> tuple[FlankPair, FlankGaps, LoadedFlanks]:
    """Load a pair of solved gears as its case says, along tip edges as far as these carry load.

    Parameters
    ----------
    asked : FlanksToLoad
    bodies : mapping of {"driver", "driven"} to FlankBody
    cache : SolutionCache
        Of compliances.
    progress : callable, optional
        Of each solve.

    Returns
    -------
    flanks : FlankPair
    gaps : FlankGaps
        Of the effects that are on.
    found : LoadedFlanks
        Under all loads.
    """
    from fegear.contact.wide.loaded import FlankPair
    from fegear.contact.wide.tip_edges import usual_gap

    effects = asked.effects
    flanks = FlankPair(
        asked.pair, bodies, effects.neighbour_coupling, effects.hertz, asked.panel, asked.positions,
        usual_gap(asked.pair, max(asked.loads)) if effects.corner_contact else 0.0, cache, progress,
    )  # fmt: skip
    gaps = asked.gaps(**{effect: effects.is_on(effect) for effect in GAPS})
    found = flanks.solve(asked.loads, gaps, flanks.compliance(asked.nominal))
    for _ in range(_LONGER_EDGES):
        if not found.reaches_the_last_edges:
            break
        flanks = replace(flanks, most_gap=2.0 * flanks.most_gap)
        found = flanks.solve(asked.loads, gaps, flanks.compliance(asked.nominal))
    return flanks, gaps, found


def _compute(asked: FlanksToLoad, upstream: Upstream, work: Work) -> LoadedWidePair:
    from fegear.contact.wide.error import flank_error, no_estimate, with_misses
    from fegear.contact.wide.loaded_pair import LoadedWidePair as LoadedWidePair  # noqa: PLC0414  (for the window)
    from fegear.contact.wide.over_pitch import over_pitch
    from fegear.contact.wide.rigid_flanks import beside_the_lines, unloaded_error
    from fegear.fem.solid.slice_laws import missed_by_slices

    effects = asked.effects
    if _SHAFTS in upstream:
        asked = asked.on(cast("LoadedShafts", upstream[_SHAFTS]).gaps_of(asked.name))
    solved = [solid_solution_of(upstream, gear) for gear in asked.gears]
    fine = {member: one.fine for member, one in zip(MEMBERS, solved, strict=True)}
    coarse = {member: one.coarse or one.fine for member, one in zip(MEMBERS, solved, strict=True)}
    flanks, gaps, found = load_flanks(asked, fine, work.cache, _Solves(work.progress))
    known = found.known
    missed = missed_by_slices(asked.pair.driver.twist)["contact"] if asked.width == "slices" else 0.0
    over = over_pitch(flanks, found, gaps, asked.nominal, peaks=asked.estimates)
    error = no_estimate(found)
    if asked.estimates:
        error = with_misses(flank_error(flanks, found, coarse, gaps, over, asked.nominal), found, missed)
    neglected = _neglected(asked, flanks, gaps, over) if asked.estimates else Neglected()
    unloaded, beside = np.full(found.lines.roll.size, math.nan), 0.0
    if asked.estimates:  # nothing else is found from either; while a value moves neither is looked at
        rigid = gaps.under(asked.nominal)
        unloaded = unloaded_error(asked.pair, rigid, found.lines.roll)
        beside = beside_the_lines(asked.pair, rigid, found.lines)
    apart = asked.gaps(relief=False, misalignment=effects.misalignment)
    flanks = replace(flanks, progress=None)  # which goes no farther than this stage
    return LoadedWidePair(
        flanks, asked.loads, asked.nominal, known, gaps, apart, found, over, error, neglected, unloaded,
        beside, missed,
    )  # fmt: skip


def _neglected(asked: FlanksToLoad, flanks: FlankPair, gaps: FlankGaps, over: OverPitch) -> Neglected:
    """What each effect that is off would change."""
    stated, i = over.stated, asked.loads.index(asked.nominal)
    changes: dict[str, tuple[Change, ...]] = {}
    wrong: dict[str, InputError] = {}
    for effect in WIDE_EFFECTS:
        if asked.effects.is_on(effect) or not asked.has_data(effect):
            continue
        try:
            if effect == "corner_contact":
                sizes = _with_edges(asked, flanks, gaps, stated)
            else:
                finer = replace(flanks, positions=over.found.lines.roll.size)
                sizes = _with(effect, asked, finer, over.found, gaps)
        except InputError as error:  # data that nothing uses may be wrong: the run goes on without its size
            wrong[effect] = error
            continue
        changes[effect] = _changes(sizes, stated, i, asked.nominal)
    return Neglected(changes, wrong)


def _changes(sizes: tuple[float, float], stated: Stated, i: int, load: float) -> tuple[Change, Change]:
    """What was found to change of mean transmission error and K_Hbeta under a load [N], of number `i`."""
    mean, factor = float(stated.mean[i]), float(stated.face_load_factor[i])
    return (
        Change("mean transmission error", sizes[0], mean, load, math.nan),
        Change("K_Hbeta", sizes[1], factor, load, math.nan),
    )


def _with_edges(asked: FlanksToLoad, flanks: FlankPair, gaps: FlankGaps, stated: Stated) -> tuple[float, float]:
    """What contact along tip edges changes, at no more roll positions than means over a base pitch need."""
    from fegear.contact.wide.tip_edges import usual_gap

    edged = replace(flanks, positions=_FEW, most_gap=usual_gap(asked.pair, asked.nominal))
    found, i = edged.solve([asked.nominal], gaps), asked.loads.index(asked.nominal)
    changes = found.mean_transmission_error[0] - stated.mean[i], found.face_load_factor[0] - stated.face_load_factor[i]
    return float(changes[0]), float(changes[1])


def _with(
    effect: str, asked: FlanksToLoad, flanks: FlankPair, without: LoadedFlanks, gaps: FlankGaps
) -> tuple[float, float]:
    """What an effect that is off changes of mean transmission error and K_Hbeta, at the roll positions of both."""
    known, i = without.known, asked.loads.index(asked.nominal)
    if effect == "neighbour_coupling":
        flanks = replace(flanks, coupling=True)
        known = flanks.compliance(asked.nominal)
    elif effect == "hertz":
        known = replace(known, fixed_half_width=None)
    else:
        gaps = asked.gaps(**{one: asked.effects.is_on(one) or one == effect for one in GAPS})
        if effect == "misalignment" and asked.misaligned != flanks.pair:
            flanks = replace(flanks, pair=asked.misaligned)
            known = flanks.compliance(asked.nominal)
    found = flanks.solve([asked.nominal], gaps, known)
    return (
        float(found.mean_transmission_error[0] - without.mean_transmission_error[i]),
        float(found.face_load_factor[0] - without.face_load_factor[i]),
    )


def _remarks(seen: Seen) -> Iterator[str]:
    """What was assumed, what is neglected, and where the model ends."""
    name, data, asked = seen.name, seen.data, seen.asked
    yield from table_notes(asked)
    yield from _heavy(name, data)
    yield from _sliced(name, data)
    yield from neglected_remarks(name, data.neglected, asked.effects, asked.tolerance, asked.nominal)
    yield from _beside(name, data)
    yield from _short(name, data)


def _settings(seen: Seen) -> dict[str, object]:
    asked, found = seen.asked, seen.data.found
    return {
        "width": asked.width, "positions": asked.positions, "panels": asked.panels,
        "stations": int(found.lines.present.sum()), "newton_steps": found.contact.steps,
        "hertz": asked.effects.hertz, "neighbour_coupling": asked.effects.neighbour_coupling,
        "base_pitch": asked.base_pitch, "nominal_load": asked.nominal, "loads": list(asked.loads),
        "positions_of_stated": seen.data.over.found.lines.roll.size,
        "seconds": {key: round(seconds, 6) for key, seconds in found.seconds.items()},
    }  # fmt: skip


def _heavy(name: str, data: LoadedWidePair) -> tuple[str, ...]:
    """Say where no metal carries the load, spread over the face or where it stands."""
    found = data.over.found
    sentence = heavy_load(data.flanks.pair, float(found.load.max()), float(found.largest_pressure.max()))
    return (f"Pair {name}: {sentence}",) if sentence else ()


def _sliced(name: str, data: LoadedWidePair) -> tuple[str, ...]:
    """Say what slices are."""
    if not data.missed:
        return ()
    told = (
        f"Pair {name}: coupled slices of the plane section are used instead of solid gears. Their "
        f"compliances miss those of solids by up to {data.missed:.0%}, which the estimated errors count."
    )
    return (told,)


def _beside(name: str, data: LoadedWidePair) -> tuple[str, ...]:
    """Say where modifications or errors are too steep for the contact lines of unmodified flanks."""
    mean = float(data.stated.mean[data.at])
    if data.beside <= _UNREMARKED * mean:
        return ()
    remark = (
        f"Pair {name}: where modifications or errors are steep the flanks touch beside the contact lines of "
        f"unmodified ones, which moves gaps by up to {data.beside * 1e6:.3g} um; the mean transmission error is "
        f"{mean * 1e6:.4g} um. Column te_unloaded of load_distribution_roll_{name} contains it; loads neglect it."
    )
    return (remark,)


def _short(name: str, data: LoadedWidePair) -> tuple[str, ...]:
    """Say where the load stands on so few places that panels are too long for it."""
    found = data.found
    fewest = (found.contact.force > 0.0).sum(axis=1).min(axis=0)
    if fewest.min() > _FEWEST:
        return ()
    i = int(fewest.argmin())
    remark = (
        f"Pair {name}: under {found.load[i]:.4g} N the flanks touch at {fewest[i]} places of a roll "
        "position, too few to resolve how the load spreads between them. Raise load_distribution.panels."
    )
    return (remark,)


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    gears = needs_solid_solution(gear_name(scene, name, "driver"), gear_name(scene, name, "driven"))
    return (*gears, _SHAFTS) if scene.case.effects.misalignment and on_shafts(scene, name) else gears


def _forecast(scene: Scene, name: str) -> Forecast:
    asked = flanks_to_load(scene, name)
    pair, loads = asked.pair, 1 + len(asked.loads)
    width = min(pair.driver.face_width, pair.driven.face_width)
    stations = 1.0 + width / (asked.panel * pair.driver.module)
    lines = asked.positions * (1.0 + pair.total_contact_ratio)
    long = max(1.0, stations / _STATIONS * (1.0 + (stations / _MANY) ** 2))
    problem = _CONTACT + _SQUARE * (stations * math.ceil(pair.total_contact_ratio)) ** 2
    seconds = 2.0 * 2.0 * _LINE * lines * long + problem * loads * (_OVER_PITCH + min(4 * loads, _PEAKS))
    return Forecast({"positions": asked.positions, "panels": asked.panels}, seconds)


_SHEET = Sheet(remarks=(_remarks,), settings=_settings)


class _Solves:
    """Progress over several solves, each of which reports from its own beginning to its end."""

    def __init__(self, report: Callable[[float], None]) -> None:
        self._report, self._done, self._last = report, 0, 0.0

    def __call__(self, fraction: float) -> None:
        if fraction < self._last or self._last == 1.0:
            self._done += 1
        self._last = fraction
        self._report(min(0.99, (self._done + fraction) / _TIMES))


LOADED_FLANKS = Stage(
    subjects=wide_pairs,
    inputs=flanks_to_load,
    compute=_compute,
    present=_SHEET.present,
    needs=_needs,
    check=check_flanks_to_load,
    cites=citing(*RING, HERTZ, INVOLUTE, Citation("johnson", "half-space under the contacts", "sections 3.2 and 4.2")),
    forecast=_forecast,
)
