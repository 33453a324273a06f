"""Which pairs of a case are rated, and K_gamma of a pair from the sharing of its planetary set or of its halves."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, cast

from fegear.case.halves import halves_share
from fegear.case.planetary import MESHES, set_pair
from fegear.case.set_pairs import set_of_pair, set_that_shares
from fegear.engine.stage import Task, Upstream

if TYPE_CHECKING:
    from fegear.case.built.rated_pair import PairToRate
    from fegear.case.reading import Scene
    from fegear.dynamics.planetary.planet_loads import PlanetLoads
    from fegear.results.helical.double_helical_data import DoubleHelicalData
    from fegear.results.planetary.planet_root_stress import PlanetStress
    from fegear.results.rating.rating_data import RatingInputs

#: Stage of a double helical pair.
_DOUBLE = "double-helical"
#: Where annex B of ISO 6336-3 ends: lowest over highest stress.
_MOST = -1.2


@dataclass(frozen=True)
class NotRated:
    """A pair beyond what a formula is made for, and the remark that says so; other pairs of the case are rated."""

    remark: str


def rated_pairs(scene: Scene) -> tuple[str, ...]:
    """All pairs but that of planet and ring of a set whose ring has no strength, of which the sun's mesh remarks."""

    def of_a_bare_ring(name: str) -> bool:
        found = set_of_pair(scene.case, name) if scene.pairs[name].internal else None
        ring = None if found is None else scene.case.planetary[found].ring
        return ring is not None and scene.case.gear[ring].strength is None

    return tuple(name for name in scene.pairs if not of_a_bare_ring(name))


def external_rated_pairs(scene: Scene) -> tuple[str, ...]:
    """All pairs but those of planets and ring of a set: what is not for internal teeth is found at the sun alone."""
    return tuple(name for name, pair in scene.pairs.items() if not (pair.internal and set_of_pair(scene.case, name)))


def needs_shares(scene: Scene, name: str) -> tuple[Task, ...]:
    """The load sharing of planets, or of both halves, that gives the K_gamma of a pair; none for most pairs."""
    if halves_share(scene.case, name):
        return (Task(_DOUBLE, name),)
    found = set_that_shares(scene.case, name)
    return () if found is None else (Task("planet-load-sharing", found),)


def with_shares(asked: PairToRate, upstream: Upstream) -> PairToRate:
    """The pair with the K_gamma of its planetary set or of its halves, where the case does not give it."""
    if asked.uneven:
        factor = cast("DoubleHelicalData", upstream[Task(_DOUBLE, asked.name)]).load_factor
    elif asked.shares:
        factor = cast("PlanetLoads", upstream[Task("planet-load-sharing", asked.shares)]).mesh_load_factor
    else:
        return asked
    duty = replace(asked.conditions.duty, mesh_load_factor=max(factor, 1.0))
    return replace(asked, conditions=replace(asked.conditions, duty=duty))


def inputs_with_shares(inputs: RatingInputs, upstream: Upstream) -> RatingInputs:
    """The same with K_gamma of the pair's planetary set or halves, for AGMA 2101 as well."""
    asked, agma = with_shares(inputs.asked, upstream), inputs.agma
    if agma is not None and asked is not inputs.asked:
        more = asked.conditions.duty.mesh_load_factor / inputs.asked.conditions.duty.mesh_load_factor
        agma = replace(agma, service=replace(agma.service, overload=agma.service.overload * more))
    return replace(inputs, asked=asked, agma=agma)


def needs_bending(scene: Scene, name: str) -> tuple[Task, ...]:
    """Root stress of the planets over a turn, where the computed rating of a pair of a set can take R from it."""
    found, operation = set_of_pair(scene.case, name), scene.case.pair[name].operation
    if found is None or operation.idler is None or operation.mean_stress_factor is not None:
        return ()
    pairs = [set_pair(found, mesh) for mesh in MESHES]
    plane = all(pair in scene.plane_pairs for pair in pairs)
    solved = plane and all(scene.case.pair[pair].root_stress.source[0] == "fe" for pair in pairs)
    return (Task("planet-root-stress", found),) if solved else ()


def bent_ratio(asked: PairToRate, upstream: Upstream) -> tuple[float, float] | None:
    """Computed R of the gears of a pair of a set, those of formulas where a gear is no planet; None without it."""
    for task, data in upstream.items():
        if task.stage == "planet-root-stress":
            side = "sun" if asked.name == set_pair(task.subject, "sun") else "ring"
            ratio = cast("PlanetStress", data).found[f"planet_{side}_side"].ratio
            one, other = (ratio if of else 0.0 for of in asked.stress_ratio)
            return one, other
    return None


def bent_so(asked: PairToRate, ratio: tuple[float, float]) -> PairToRate:
    """The pair with these R, as far as annex B of ISO 6336-3 goes."""
    return replace(asked, stress_ratio=(max(ratio[0], _MOST), max(ratio[1], _MOST)))


def bending_said(name: str, ratio: tuple[float, float], factors: tuple[float, ...]) -> str:
    """Which Y_M follow from the computed R, in words."""
    least, values = min(ratio), ", ".join(f"{value:.3g}" for value in factors)
    beyond = f"; limited to R = {_MOST} (annex B)" if least < _MOST else ""
    return (
        f"Pair {name}: Y_M of the FE rating is {values} (pinion, wheel) with R = {least:.4g} of the planet from "
        f"planet-root-stress, instead of -1.2{beyond}."
    )
