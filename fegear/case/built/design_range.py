"""The loads that the reliefs of a pair are designed for together: what ``torques``, ``loads`` and ``weights`` say."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.case.design import DesignPart
from fegear.design.load_range import LoadRange

if TYPE_CHECKING:
    from fegear.case.reading import Scene


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
    if (design.over or ("torques" if part.torques is not None else "load")) == "load":
        return None
    loads = part.several_loads(pair)
    if not loads:
        raise InputError(
            "design.over", '"torques"', f"requires pair.{name}.torques",
            f'set pair.{name}.torques = ["150 N*m", "300 N*m"]',
        )  # fmt: skip
    given = dict(zip(loads, part.weights or [1.0] * len(loads), strict=True))
    if set(given) == {design.load or part.normal_load(pair)}:
        return None
    ordered = tuple(sorted(given))
    alike = len(set(given.values())) == 1
    return LoadRange(ordered, None if alike else tuple(given[load] for load in ordered))


def unused_spectrum(scene: Scene, name: str) -> tuple[float, ...]:
    """Driver torques [N m] of the load spectrum of a pair whose reliefs are designed for another load only.

    In ascending order; empty without a spectrum, where all of it is the design load, where a range is given, and where
    ``over = "load"`` says that one load is meant.
    """
    part, pair = scene.case.pair[name], scene.pairs[name]
    design = scene.case.design or DesignPart()
    bins = part.operation.spectrum
    if not bins or design.over == "load" or design_range(scene, name) is not None:
        return ()
    lever = pair.driver.base_radius * part.halves
    nominal, designed = ((load or 0.0) * lever for load in (part.normal_load(pair), design.load))
    found = ((one.load_factor or 0.0) * nominal if one.torque is None else one.torque for one in bins)
    torques = tuple(sorted({float(f"{torque:.4g}") for torque in found if torque > 0.0}))
    return () if torques == (float(f"{designed or nominal:.4g}"),) else torques
