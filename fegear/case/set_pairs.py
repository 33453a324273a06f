"""Pairs of planetary sets among those of a case, planet and sun, planet and ring: made unless the case has them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fegear.base.errors import InputError
from fegear.case.nearest import nearest
from fegear.case.pair import PairPart
from fegear.case.planetary import Mesh, PlanetaryPart, SetTeeth, set_pair

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.model import Case
    from fegear.case.operation import OperationPart
    from fegear.geometry.gear import Gear


def set_teeth(case: Case, part: PlanetaryPart) -> SetTeeth:
    """Numbers of teeth of a set whose gears are those of the case."""
    ring = part.ring_teeth if part.ring is None else case.gear[part.ring].teeth
    return SetTeeth(case.gear[part.sun].teeth, case.gear[part.planet].teeth, ring or 0)


def with_set_pairs(case: Case, gears: Mapping[str, Gear]) -> Case:
    """The case with the pairs of its planetary sets, each with the load of equal shares and as it runs in the set.

    Raises
    ------
    InputError
        If a set names gears that the case does not have, or a pair of its name has other gears.
    """
    pairs = dict(case.pair)
    for name, part in case.planetary.items():
        for role in ("sun", "planet", "ring"):
            gear = getattr(part, role)
            if gear is None:
                continue
            if gear not in gears:
                raise InputError(f"planetary.{name}.{role}", f'"{gear}"', "is not a gear of this case",
                                 nearest(gear, case.gear))  # fmt: skip
            if gears[gear].tooth.internal != (role == "ring"):
                rule = "must be an internal gear" if role == "ring" else "is an internal gear"
                raise InputError(f"planetary.{name}.{role}", f'"{gear}"', rule, "name another gear, or change internal")
        sun = set_pair(name, "sun")
        pairs[sun] = _set_pair(case, name, "sun", part.centre_distance)
        if part.ring is not None:
            distance = pairs[sun].build(dict(gears), f"pair.{sun}").centre_distance
            pairs[set_pair(name, "ring")] = _set_pair(case, name, "ring", distance)
    return case.model_copy(update={"pair": pairs}) if case.planetary else case


def _set_pair(case: Case, name: str, mesh: Mesh, distance: float | None) -> PairPart:
    """The pair of a planet with sun or ring: its own of the case, completed, or a new one."""
    part, teeth = case.planetary[name], set_teeth(case, case.planetary[name])
    planet_drives = part.sun_drives() == (mesh == "ring")
    central: str = getattr(part, mesh)
    roles = (part.planet, central) if planet_drives else (central, part.planet)
    driving = teeth.planet if planet_drives else getattr(teeth, mesh)
    own = set_pair(name, mesh)
    given = case.pair.get(own)
    if given is None:
        given = PairPart(driver=roles[0], driven=roles[1])
    elif (given.driver, given.driven) != roles:
        raise InputError(
            f"pair.{own}.driver", f'"{given.driver}"',
            f"is reserved for the {mesh}-planet mesh of planetary.{name}, with {roles[0]} driving {roles[1]}",
            "set driver and driven accordingly, or rename the pair",
        )  # fmt: skip
    filled: dict[str, Any] = {}
    if given.double_helical is not None:
        raise InputError(
            f"pair.{own}.double_helical", "(given)", "is a key of the planetary gear set here",
            f"remove it and set planetary.{name}.double_helical = true",
        )  # fmt: skip
    if part.double_helical:
        from fegear.case.double_helical import DoubleHelicalPart

        filled["double_helical"] = DoubleHelicalPart()
    if not (given.load or given.torque):
        filled["torque"] = teeth.sun_torque(part) / part.count * driving / teeth.sun
    if given.centre_distance is None and distance is not None:
        filled["centre_distance"] = distance
    speed = teeth.sun_speed(part)
    if given.speed is None and speed is not None:
        filled["speed"] = speed * teeth.sun / driving
    filled["operation"] = _operation(part, given, planet_drives)
    return given.model_copy(update=filled)


def _operation(part: PlanetaryPart, given: PairPart, planet_drives: bool) -> OperationPart:
    """How a mesh runs, where its pair does not say: a flank of sun or ring meets every planet in a turn.

    A planet's teeth are bent to either side, by sun and ring.
    """
    said = given.operation.model_fields_set
    filled: dict[str, Any] = {}
    if given.operation.contacts is None:
        filled["contacts"] = [1, part.count] if planet_drives else [part.count, 1]
    if not said & {"idler", "reversed_load", "mean_stress_factor"}:
        filled["idler"] = "driver" if planet_drives else "driven"
    return given.operation.model_copy(update=filled)


def set_of_pair(case: Case, pair: str) -> str | None:
    """The planetary set to which a pair belongs; None where it belongs to none."""
    return next((name for name in case.planetary if pair in (set_pair(name, "sun"), set_pair(name, "ring"))), None)


def set_that_shares(case: Case, pair: str) -> str | None:
    """The set whose load sharing gives the K_gamma of a pair: its own, unless the case gives a K_gamma, or no ring."""
    name = set_of_pair(case, pair)
    if name is None or case.pair[pair].operation.mesh_load_factor is not None:
        return None
    part = case.planetary[name]
    return None if part.ring is None and part.stiffness.ring_mesh is None else name
