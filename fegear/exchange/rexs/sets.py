"""Tables of a case for the planetary stages of a REXS model."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.exchange.case_tables import Key, Table, quantity, text
from fegear.exchange.rexs.places import distance_of
from fegear.exchange.rexs.planetary import Planetary
from fegear.exchange.rexs.set_bodies import body_keys, planet_keys, support_keys

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.exchange.rexs.flow import Flow
    from fegear.exchange.rexs.model import Component
    from fegear.exchange.rexs.places import Stage
    from fegear.exchange.rexs.said import Said


def set_name(n: int) -> str:
    """Name of a set in the case, by its number."""
    return "P" if n == 0 else f"P{n + 1}"


def set_tables(
    said: Said, one: Planetary, names: dict[int, str], n: int, flow: Flow, stages: list[Stage],
    mesh_keys: Callable[[Stage, Component], tuple[Key, ...]],
) -> list[Table]:  # fmt: skip
    """``[planetary.P]``: gears, planets, what is held and what drives, what holds them; and the pairs of its meshes.

    Parameters
    ----------
    said : Said
    one : Planetary
    names : dict
        Of its gears in the case.
    n : int
        Its number among the sets.
    flow : Flow
    stages : list of Stage
        All of the model.
    mesh_keys : callable
        Keys that the pair of a mesh has of its stage and driver.

    Raises
    ------
    InputError
        If nothing is held.
    """
    whole, held = flow.sets[n], flow.held
    members = {"sun": whole.sun, "ring": whole.ring, "carrier": whole.carrier}
    fixed = [name for name, body in members.items() if body in held]
    if len(fixed) != 1:
        raise InputError(
            one.component.said, f"{len(fixed)} members fixed", "requires exactly one of sun, ring and carrier fixed "
                                                              "to the housing",
            "connect it to the housing by a coupling",
        )  # fmt: skip
    sun, ring = whole.teeth
    on_sun = flow.driven.set_torque[n]
    torques = {"sun": on_sun, "ring": on_sun * ring / sun, "carrier": -on_sun * (sun + ring) / sun}
    speeds = {name: flow.driven.speed[body] for name, body in members.items()}
    free = [name for name in members if name != fixed[0]]
    # The planets take power from the member that drives.
    driving = next((name for name in free if torques[name] * speeds[name] < 0.0), free[0])
    keys = [
        *(Key(role, text(names[gear.id])) for role, gear in zip(("sun", "planet", "ring"), one.gears, strict=True)),
        *planet_keys(said, one, stages),
        Key("fixed", text(fixed[0]), "its coupling to the housing"),
        Key("input", text(driving)),
    ]
    for key, value, unit in (("torque", torques[driving], "N*m"), ("speed", speeds[driving], "rpm")):
        if math.isfinite(value) and value:
            keys.append(
                Key(key, quantity(abs(value), unit, 12), "from external_load, or calculated through the gearbox")
            )
        else:
            assumed = {"N*m": 1.0, "rpm": 1500.0 * math.tau / 60.0}[unit]
            keys.append(Key(key, quantity(assumed, unit), "assumed (no torque)"))
    backward = speeds[driving] if math.isfinite(speeds[driving]) and speeds[driving] else torques[driving]
    if backward < 0.0:
        keys.append(Key("clockwise", "true", "rotational_speed below zero"))
    mine = [stage for stage in stages if stage.component.id in one.stages]
    distance = distance_of(said, next(stage for stage in mine if not stage.internal))
    keys += [*support_keys(said, one, flow, n, fixed[0]), *body_keys(said, one, distance)]
    sun_drives = driving == "sun" or (driving == "carrier" and fixed[0] == "sun")
    made = [Table(f"planetary.{set_name(n)}", tuple(keys), f"{one.component.said} {one.component.name}")]
    for mesh, central in (("sun", one.sun), ("ring", one.ring)):
        planet_drives = sun_drives == (mesh == "ring")
        driver, wheel = (one.planet, central) if planet_drives else (central, one.planet)
        stage = next(stage for stage in mine if {central.id, one.planet.id} == {gear.id for gear in stage.gears})
        roles = (Key("driver", text(names[driver.id]), "from the power flow"), Key("driven", text(names[wheel.id])))
        about = f"{stage.component.said}, for all identical stages"
        made.append(Table(f"pair.{set_name(n)}_{mesh}", (*roles, *mesh_keys(stage, driver)), about))
    return made
