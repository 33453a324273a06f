"""Settings of the finite elements one at a time, from a fine base: how the error falls with each.

Positions, harmonics and time tolerance one at a time, with the gears of the reference.

A gear with its width: edges of its section and functions along the face, one at a time.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.fourier import FourierSeries, fourier_series
from fegear.contact.plane.transmission_error import TransmissionError, transmission_error
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.slices import solver_of
from fegear.fem.solid.table import BandNumbers, band_numbers, bands_of_table
from fegear.results.gear.load_positions import face_positions
from fegear.studies.cost.answers import (
    HARMONICS,
    FiniteElements,
    Source,
    answer,
    factor_at,
    largest_force,
    loaded,
    speed_looked_at,
    train_of,
)
from fegear.studies.cost.quantities import Quantity, miss
from fegear.studies.cost.result import Knob, make_knob, timed

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from fegear.base.arrays import Array
    from fegear.contact.plane.engagement import Engagement
    from fegear.studies.cost.asked import Asked
    from fegear.studies.cost.ladder import Configuration, Ladder
    from fegear.studies.cost.measure import Found


#: Widths in equal ratio: their successive differences fall at the order of the error itself.
_PATCHES = tuple(2.0 * MeshSettings().patch_half_width / 2.0 ** (i / 2.0) for i in range(6))


def ladder_knobs(found: Found, ladder: Ladder, best: FiniteElements) -> list[Knob]:
    """Edge length for each order, width of the pressure, teeth of a sector.

    Parameters
    ----------
    found : Found
        Answers of the ladder.
    ladder : Ladder
    best : FiniteElements
        The reference's gears; its mesh with another patch costs no new solution.

    Returns
    -------
    list of Knob
    """
    knobs: list[Knob] = []
    asked, values, rows = found.asked, found.values, found.rows
    quantities = [q for q in asked.quantities if asked.solves(q)]
    seconds = {(row.configuration, row.quantity): row.seconds.cpu for row in rows}
    for quantity in quantities:
        name = quantity.name
        fine = _by_patch(asked, quantity, best)
        for group in _edge_groups(ladder):
            settings = group[0].settings
            there = [configuration for configuration in group if (configuration, name) in values]
            if settings is None or len(there) < 2:
                continue
            exact = fine(settings.patch_half_width)
            factors = np.array([configuration.factor for configuration in there])
            edges = factors * MeshSettings().root_edge_length
            errors = [miss(name, values[configuration, name], exact).rms for configuration in there]
            at = (
                f"patch {settings.patch_half_width:g} modules, relative to the reference mesh with this patch; root "
                "mean square"
            )
            spent = [seconds[configuration, name] for configuration in there]
            knob = f"edge length, order {settings.order}"
            knobs.append(make_knob(name, knob, at, edges, factors, errors, found.mesh_floors[name], spent))
        known = [fine(a) for a in _PATCHES]
        change = [miss(name, a, b).rms for a, b in pairwise(known)]
        at = "reference mesh, change to the next narrower patch of equal ratio"
        knobs.append(make_knob(name, "patch half-width", at, _PATCHES[:-1], _PATCHES[:-1], change))
        sectors = [row for row in rows if row.configuration.family == "sector" and row.quantity == name]
        teeth = np.array([row.configuration.teeth for row in sectors], dtype=float)
        if teeth.size > 1:
            at = "relative to the full gear; root mean square"
            errors = [row.miss.rms for row in sectors]
            spent = [row.seconds.cpu for row in sectors]
            floor = found.floors[name]
            knob = "number of teeth of a sector with free sides"
            knobs.append(make_knob(name, knob, at, teeth, 1.0 / teeth, errors, floor, spent))
    return knobs


def _by_patch(asked: Asked, quantity: Quantity, best: FiniteElements) -> Callable[[float], Array]:
    """Answers of the reference's mesh under pressures of other widths, each computed once."""
    known: dict[float, Array] = {}

    def answers(patch: float) -> Array:
        if patch not in known:
            solved = {
                name: replace(one, settings=replace(one.settings, patch_half_width=patch))
                for name, one in best.solved.items()
            }
            known[patch] = answer(asked, quantity, FiniteElements(solved))
        return known[patch]

    return answers


def _edge_groups(ladder: Ladder) -> Iterable[list[Configuration]]:
    """Whole-gear configurations of one order and one patch: the narrowest that every mesh of the order has."""
    by_order: dict[int, list[tuple[Configuration, ...]]] = {}
    for group in ladder.meshes:
        settings = group[0].settings
        if settings is not None and group[0].family == "ring":
            by_order.setdefault(settings.order, []).append(group)
    for groups in by_order.values():
        widths = [{r.settings.patch_half_width: r for r in group if r.settings is not None} for group in groups]
        common = set(widths[0]).intersection(*widths[1:])
        if common:
            yield [w[min(common)] for w in widths]


#: No powers of two: two jumps may lie as many such steps apart and hide each other.
_EVEN = (8, 13, 21, 34, 55, 89, 144, 233, 377, 610)


#: Placements of evenly spaced positions in addition to the jumps: a single one may be lucky.
_PLACEMENTS = 8


_GAUSS = (2, 3, 4, 6, 8, 12, 16)


_PARTIAL_SUMS = (2, 4, 8, 16, 32, 64)


_FORCE_HARMONICS = (4, 8, 16, 32, 64, 128)


_POSITIONS = (11, 21, 41, 81, 161)


_TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5)


#: Far beyond the finest of the above.
_ALL_HARMONICS, _ALL_POSITIONS, _ALL_GAUSS, _TIGHT = 512, 401, 48, 1e-8


#: Amplitudes whose error is looked at.
_FIRST = 8


def pair_knobs(asked: Asked, source: Source) -> list[Knob]:
    """Positions, harmonics and time tolerance, with the gears of the reference.

    Parameters
    ----------
    asked : Asked
    source : Source

    Returns
    -------
    list of Knob
    """
    names = {q.name for q in asked.quantities}
    found: list[Knob] = []
    if "te-peak-to-peak" in names:
        pair = loaded(asked, source, asked.pair)
        found += _error_knobs(pair.engagement, pair.nominal)
    if asked.mesh and names & {"tooth-force", "dynamic-factor"}:
        data = train_of(asked, source)
        if "tooth-force" in names:
            best = largest_force(asked, data, _ALL_HARMONICS, _ALL_POSITIONS)

            def off(harmonics: int, positions: int) -> float:
                return abs(largest_force(asked, data, harmonics, positions) / best - 1.0)

            force = "tooth-force"
            found += [
                _counted(force, "harmonics of the force", f"{_ALL_POSITIONS} positions", _FORCE_HARMONICS,
                         lambda n: off(n, _ALL_POSITIONS)),
                _counted(force, "positions over the path", f"{_ALL_HARMONICS} harmonics; jumps come in addition",
                         _POSITIONS, lambda n: off(_ALL_HARMONICS, n)),
            ]  # fmt: skip
        if "dynamic-factor" in names:
            speed = speed_looked_at(asked)
            still = factor_at(asked, data, speed, _TIGHT)
            errors, spent = [], []
            for tolerance in _TOLERANCES:
                value, seconds = timed(partial(factor_at, asked, data, speed, tolerance))
                errors.append(abs(value / still - 1.0))
                spent.append(seconds.cpu)
            at = f"at {speed * 30.0 / math.pi:.6g} rpm, relative to {_TIGHT:g}"
            found.append(
                make_knob("dynamic-factor", "time tolerance", at, _TOLERANCES, _TOLERANCES, errors, 0.0, spent)
            )
    return found


def _counted(
    quantity: str, name: str, at: str, counts: Sequence[int], error: Callable[[int], float], floor: float = 0.0
) -> Knob:
    """A knob that is a number of things: what goes to zero is its inverse."""
    return make_knob(quantity, name, at, counts, 1.0 / np.array(counts), [error(n) for n in counts], floor)


def _error_knobs(engagement: Engagement, load: float) -> list[Knob]:
    """Transmission error and mesh stiffness: evenly spaced positions compared with Gauss points between the jumps."""
    best = transmission_error(engagement, load, HARMONICS, order=_ALL_GAUSS)
    stiffness = _stiffness(best)
    second = transmission_error(engagement, load, HARMONICS, order=_ALL_GAUSS // 2)
    floor = abs(second.peak_to_peak / best.peak_to_peak - 1.0)
    known = (
        _amplitudes(second.series.amplitude, best.series),
        _amplitudes(_stiffness(second).amplitude, stiffness),
    )

    def gauss(n: int) -> TransmissionError:
        return transmission_error(engagement, load, HARMONICS, order=n)

    even, between = "positions per base pitch, equally spaced", "Gauss points per interval between discontinuities"
    te, first = "te-peak-to-peak", f"first {_FIRST} amplitudes relative to the largest"
    placed = f"root mean square over {_PLACEMENTS} placements"
    dense = {n: _even(engagement, load, _PLACEMENTS * n) for n in _EVEN}

    def rms(n: int, which: int, off: Callable[[Array], float]) -> float:
        found = dense[n][which]
        return math.sqrt(float(np.mean([off(found[start::_PLACEMENTS]) ** 2 for start in range(_PLACEMENTS)])))

    return [
        _counted(te, even, f"as in a run without break points; {placed}", _EVEN,
                 lambda n: rms(n, 0, lambda v: float(np.ptp(v)) / best.peak_to_peak - 1.0), floor),
        _counted(te, between, "as in a run, with 16", _GAUSS,
                 lambda n: abs(gauss(n).peak_to_peak / best.peak_to_peak - 1.0), floor),
        _counted(te, "harmonics of the transmission error", "peak-to-peak of the partial sum", _PARTIAL_SUMS,
                 lambda n: _partial(best, n), floor),
        _counted("te-harmonics", even, f"{first}, trapezoidal rule; {placed}", _EVEN,
                 lambda n: rms(n, 0, lambda v: _amplitudes(_spectrum(v), best.series)), known[0]),
        _counted("te-harmonics", between, first, _GAUSS,
                 lambda n: _amplitudes(gauss(n).series.amplitude, best.series), known[0]),
        _counted("stiffness-harmonics", even, f"{first}, trapezoidal rule; {placed}", _EVEN,
                 lambda n: rms(n, 1, lambda v: _amplitudes(_spectrum(v), stiffness)), known[1]),
        _counted("stiffness-harmonics", between, first, _GAUSS,
                 lambda n: _amplitudes(_stiffness(gauss(n)).amplitude, stiffness), known[1]),
    ]  # fmt: skip


def _stiffness(found: TransmissionError) -> FourierSeries:
    """Series of the local mesh stiffness at the quadrature points of a transmission error."""
    return fourier_series(found.points, found.loaded.local_stiffness[:, 0], HARMONICS)


def _even(engagement: Engagement, load: float, n: int) -> tuple[Array, Array]:
    """Transmission error and local stiffness at n evenly spaced roll positions of one base pitch."""
    pair = engagement.pair
    x = pair.x_start + pair.base_pitch * (np.arange(n) + 0.5) / n
    state = engagement.solve(engagement.grid(x), [load])
    return state.transmission_error[:, 0], state.local_stiffness[:, 0]


def _spectrum(values: Array) -> Array:
    """Amplitudes (0-peak) of harmonics 1.. from evenly spaced values."""
    return np.asarray(2.0 * np.abs(np.fft.rfft(values))[1 : values.size // 2] / values.size)


def _amplitudes(found: Array, exact: FourierSeries) -> float:
    """Largest error of the first amplitudes that both have, over the largest amplitude."""
    n = min(_FIRST, found.size)
    amplitude = exact.amplitude
    return float(np.abs(found[:n] - amplitude[:n]).max() / amplitude.max())


def _partial(best: TransmissionError, harmonics: int) -> float:
    """Error of the peak-to-peak value of a partial sum."""
    series = best.series
    x = np.concatenate([best.points.x, np.linspace(0.0, series.period, 64 * harmonics + 1)])
    cut = type(series)(series.coefficients[: harmonics + 1], series.period)
    return abs(float(np.ptp(cut.evaluate(x))) / best.peak_to_peak - 1.0)


#: Edges over the usual ones, and functions per module of face; the last of each is what the others are compared with.
_FACTORS: tuple[float, ...] = (1.5, 1.25, 1.0, 0.8, 0.6)
_WAVES: tuple[float, ...] = (0.75, 1.0, 1.5, 2.0, 3.0)


#: The last ones of a quick study, which take half of the time and more, are left out.
_QUICK = slice(0, -1)


#: What is looked at, and what it is called.
_NAMES = {
    "c_self": "c_0 over the face width",
    "c_next": "c_1 over the face width",
    "root_tension": "root stress (tension side) over the face width",
}


def solid_knobs(asked: Asked, *, quick: bool = False) -> list[Knob]:
    """What edges of the section and functions along the face cost, for the bands of ``[stiffness] face_positions``.

    The error of root stress is that of its curve along the face where it is large, as in the table over the face.

    Parameters
    ----------
    asked : Asked
    quick : bool
        Without the finest edges and the most functions.

    Returns
    -------
    list of Knob
    """
    usual, edge = SolidSettings(), SolidSettings().section.root_edge_length
    factors, counts = (_FACTORS[_QUICK], _WAVES[_QUICK]) if quick else (_FACTORS, _WAVES)
    by_edge = [replace(usual, section=usual.section.scaled(factor)) for factor in factors]
    by_wave = [replace(usual, waves_per_module=waves, least_degree=3) for waves in counts]
    by_slice = [replace(one, source="slices") for one in by_edge[:-1]]
    gear = asked.scene.gears[asked.gear]
    # Edges of slices, then those of the solid gear that shows how far off slices are.
    of_slices = np.array([*factors[:-1], 1.0])
    # Slices know external discs, whose bore is held, only.
    sliced = gear.body is None and gear.support is None and not gear.tooth.internal
    return [
        *_varied(asked, by_edge, "edges of the section", f"{usual.waves_per_module:g} functions per module of face",
                 edge * np.array(factors), edge * np.array(factors)),
        *_varied(asked, by_wave, "functions per module of face", f"edges of {edge:g} modules", np.array(counts),
                 1.0 / np.array(counts)),
        *(_varied(asked, [*by_slice, usual], "edges of the section, slices", "coupled slices of the plane section",
                  edge * of_slices, edge * of_slices, "3D gear") if sliced else ()),
    ]  # fmt: skip


def _varied(
    asked: Asked, settings: list[SolidSettings], name: str, others: str, setting: Array, step: Array, against: str = ""
) -> list[Knob]:
    """Knobs of one setting, its last value the one that the others are compared with."""
    answers, spent = zip(*(timed(partial(_answer, asked, one), repeat=False) for one in settings), strict=True)
    seconds = [one.cpu for one in spent[:-1]]
    at = f"{others}, relative to {against or f'{setting[-1]:.3g}'}; largest of the bands"
    apart = [answers[-1].apart(one) for one in answers[:-1]]
    return [
        make_knob(quantity, name, at, setting[:-1], step[:-1], [float(one[key].max()) for one in apart], 0.0, seconds)
        for key, quantity in _NAMES.items()
    ]


def _answer(asked: Asked, settings: SolidSettings) -> BandNumbers:
    """Compliances and root stresses of the bands of the case."""
    scene, gear = asked.scene, asked.scene.gears[asked.gear]
    m = gear.module
    solution = solver_of(settings)(
        gear.tooth, gear.twist * m, gear.face_width / m, gear.material.poisson_ratio, gear.bore_radius / m, settings,
        body=gear.body_in_modules, support=gear.support_in_modules,
    )  # fmt: skip
    places = face_positions(scene, asked.gear) / m
    return band_numbers(solution, bands_of_table(solution, asked.radii / m, places, asked.half_width / m))
