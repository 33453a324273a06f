"""Loads that the reliefs of a pair are designed for together: ``torques``, ``loads`` and ``weights``, or a spectrum."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.case.design import DesignPart
from fegear.design.load_range import LoadRange, of_spectrum

if TYPE_CHECKING:
    from fegear.case.pair import PairPart
    from fegear.case.reading import Scene
    from fegear.geometry.pair import GearPair


def design_range(scene: Scene, name: str) -> LoadRange | None:
    """Loads and weights of a pair's design range; None where its reliefs are for the design load only.

    One torque that is the design load too is no range.

    Raises
    ------
    InputError
        If a range is asked for and the pair has none.
    """
    part, pair = scene.case.pair[name], scene.pairs[name]
    design = scene.case.design or DesignPart()
    asked = design.over or ("torques" if part.torques is not None else "spectrum")
    if asked == "load":
        return None
    over = _over_torques(part, pair) if asked == "torques" else _over_spectrum(part, pair)
    if over is None and design.over == "torques":
        raise InputError(
            "design.over", '"torques"', f"requires pair.{name}.torques",
            f'set pair.{name}.torques = ["150 N*m", "300 N*m"]',
        )  # fmt: skip
    if over is None and design.over == "spectrum":
        raise InputError(
            "design.over", '"spectrum"', f"requires pair.{name}.operation.spectrum with a torque above zero",
            f'set pair.{name}.operation.spectrum = [{{ torque = "300 N*m", share = 0.2 }}, '
            '{ torque = "150 N*m", share = 0.8 }]',
        )  # fmt: skip
    return None if over is None or set(over.loads) == {design.load or part.normal_load(pair)} else over


def _over_torques(part: PairPart, pair: GearPair) -> LoadRange | None:
    """What ``torques`` or ``loads`` and ``weights`` say."""
    loads = part.several_loads(pair)
    if not loads:
        return None
    given = dict(zip(loads, part.weights or [1.0] * len(loads), strict=True))
    ordered = tuple(sorted(given))
    alike = len(set(given.values())) == 1
    return LoadRange(ordered, None if alike else tuple(given[load] for load in ordered))


def _over_spectrum(part: PairPart, pair: GearPair) -> LoadRange | None:
    """Loads of ``operation.spectrum``, weighted by their shares of time."""
    bins = part.operation.spectrum or []
    nominal, lever = part.normal_load(pair) or 0.0, pair.driver.base_radius * part.halves
    loads = [(one.load_factor or 0.0) * nominal if one.torque is None else one.torque / lever for one in bins]
    shares = [(one.share if one.time is None else one.time) or 0.0 for one in bins]
    return of_spectrum(loads, shares)
