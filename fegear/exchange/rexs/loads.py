"""Loads of a REXS model: which load case, what flows through the gearbox, and the bins of its load spectrum.

What a model leaves open is assumed once, at one end of a train of gears, and carried through it by the teeth.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.exchange.rexs.drive import Mesh, Torque, driven
from fegear.exchange.rexs.flow import Flow
from fegear.exchange.rexs.places import BEVEL, bodies_of, direction
from fegear.exchange.rexs.planetary import flow_through
from fegear.exchange.rexs.teeth import module_of, teeth_of

if TYPE_CHECKING:
    from fegear.exchange.rexs.drive import Driven
    from fegear.exchange.rexs.model import Component, LoadCase, Model
    from fegear.exchange.rexs.places import Stage
    from fegear.exchange.rexs.planetary import Planetary
    from fegear.exchange.rexs.said import Said

#: Of every load case: torque [N m] or part of the nominal load, speed [rad/s] and share of the time.
Bins = tuple[tuple[float, float, float], ...]
#: What a mesh gets where the model says nothing: torque per mm of face and module squared [Pa], and speed [rad/s].
_ASSUMED_LOAD, _ASSUMED_SPEED = 10e6, 1500.0 * 2.0 * math.pi / 60.0


@dataclass(frozen=True, slots=True)
class Spectrum:
    """Load spectrum of every mesh.

    Parameters
    ----------
    bins : tuple of Bins
        Of each mesh: torque on its driver, its speed, share of the time.
    life : float or None
        All of the time [s], where load cases say how long they last and not as a share.
    sets : tuple of Bins
        Of each planetary set: load over that of the nominal load case, speed of the sun relative to the carrier times
        its teeth, share.
    """

    bins: tuple[Bins, ...]
    life: float | None = None
    sets: tuple[Bins, ...] = ()


def chosen_load_case(model: Model, asked: int | None) -> LoadCase | None:
    """The load case of a number, by default the first.

    Raises
    ------
    InputError
        If the model has none of that number.
    """
    known = {one.id: one for one in model.load_cases}
    if asked is not None and asked not in known:
        listed_ones = ", ".join(map(str, known)) or "none"
        raise InputError("--load-case", asked, "is not in the model", f"it has {listed_ones}")
    return known[asked] if asked is not None else next(iter(known.values()), None)


def spectrum_of(
    said: Said, stages: list[Stage], sets: list[Planetary], on: dict[int, Component | None], nominal: Flow
) -> Spectrum:
    """The load spectrum of every mesh.

    Parameters
    ----------
    said : Said
    stages, sets, on
        As of `flow_of`.
    nominal : Flow
        Of the load case by which drivers are named.

    Raises
    ------
    InputError
        If load cases do not say how long they last, or give no torque or speed.
    """
    flows: list[Flow] = []
    times: list[float | None] = []
    in_hours: list[bool] = []
    for one in said.model.load_cases:
        under = replace(said, loaded=one.attributes, notes=[])
        time, absolute = _time(under)
        times.append(time)
        in_hours.append(absolute)
        flows.append(flow_of(under, stages, sets, on))
    whole = sum(time or 0.0 for time in times)
    if not times or None in times or min(time or 0.0 for time in times) < 0.0 or not whole or len(set(in_hours)) > 1:
        raise InputError(
            "--spectrum", f"{len(times)} load cases", "do not all have a duration",
            "specify load_duration_fraction or operating_time of gear_unit in each",
        )  # fmt: skip
    found = []
    for n, stage in enumerate(stages):
        if stage.component.type == BEVEL:
            continue
        bins = []
        for flow, time in zip(flows, times, strict=True):
            if n in flow.assumed_torque or n in flow.assumed_speed:
                raise InputError(
                    "--spectrum", stage.component.said, "has a load case without torque or speed", "complete it"
                )
            drives, torque, speed = flow.into(n)
            if drives != nominal.into(n)[0]:
                ratio = abs(flow.meshes[n].teeth[0] / flow.meshes[n].teeth[1])
                torque, speed = (torque * ratio, speed / ratio) if not drives else (torque / ratio, speed * ratio)
                said.notes.append(
                    f"{stage.component.said}: power flow reverses in the load spectrum; flanks are not distinguished."
                )
            bins.append((torque, abs(speed), (time or 0.0) / whole))
        found.append(tuple(bins))
    shares = [(time or 0.0) / whole for time in times]
    of_sets = tuple(_of_set(said, one, n, nominal, flows, shares) for n, one in enumerate(sets))
    return Spectrum(tuple(found), whole if in_hours[0] else None, of_sets)


def _of_set(
    said: Said, one: Planetary, n: int, nominal: Flow, flows: list[Flow], shares: list[float]
) -> tuple[tuple[float, float, float], ...]:
    """The bins of a set; none, and a note, where a load case gives it no torque or speed."""
    bins = []
    for flow, share in zip(flows, shares, strict=True):
        whole = flow.sets[n]
        factor = abs(flow.driven.set_torque[n] / (nominal.driven.set_torque[n] or math.nan))
        speed = abs(flow.driven.speed[whole.sun] - flow.driven.speed[whole.carrier]) * whole.teeth[0]
        if not (math.isfinite(factor) and math.isfinite(speed) and speed > 0.0):
            said.notes.append(f"{one.component.said}: no load spectrum (a load case has no torque or speed for it).")
            return ()
        bins.append((factor, speed, share))
    return tuple(bins)


def _time(said: Said) -> tuple[float | None, bool]:
    """How long a load case lasts by itself: a share, or a time [s]; None where it does not say."""
    for unit in said.model.of("gear_unit"):
        own = said.loaded.get(unit.id, {})
        for quantity, *names in (
            ("share", "load_duration_fraction", "operating_time_fraction"), ("time", "load_duration", "operating_time")
        ):  # fmt: skip
            if own.keys() & set(names):
                return said.number(unit, quantity, *(name for name in names if name in own)), quantity == "time"
    return None, False


def flow_of(said: Said, stages: list[Stage], sets: list[Planetary], on: dict[int, Component | None]) -> Flow:
    """Torques and speeds of every mesh, those that are given and those that are assumed.

    Parameters
    ----------
    said : Said
    stages : list of Stage
        Those that are no part of a set, bevel stages last.
    sets : list of Planetary
    on : dict
        The shaft of every gear.

    Raises
    ------
    InputError
        If what is given contradicts the teeth.
    """
    bodies, held = bodies_of(said, [pair for one in sets for pair in pairwise(one.carriers)])
    whole = tuple(flow_through(said, one, bodies) for one in sets)
    meshes = tuple(
        Mesh(
            tuple(bodies[on[gear.id].id] for gear in stage.gears),  # type: ignore[union-attr, arg-type]  # gears on no shaft are refused before
            _teeth(said, stage),
        )
        for stage in stages
    )
    count = max(bodies.values(), default=-1) + 1
    speeds = _speeds(said, bodies)

    def solved(torques: list[Torque]) -> Driven:
        return driven(count, meshes, whole, torques, speeds, sorted(held))

    try:
        found = solved([])
    except InputError:
        raise _contradiction(said, "rotational_speed", "rpm", "shaft", "speed") from None
    slow = [n for n, mesh in enumerate(meshes) if not math.isfinite(found.speed[mesh.bodies[0]])]
    assumed_speed = frozenset(slow)
    while slow:
        mesh = meshes[slow[0]]
        ends = _ends(meshes, [n for n in slow if n in _train(meshes, slow[0])])
        speeds[ends[0] if ends else mesh.bodies[0]] = _ASSUMED_SPEED
        found = solved([])
        left = [n for n in slow if not math.isfinite(found.speed[meshes[n].bodies[0]])]
        slow = left if len(left) < len(slow) else []
    turning = {body for mesh in meshes for body in mesh.bodies} | held
    turning |= {body for one in whole for body in (one.sun, one.ring, one.carrier)}
    torques = _torques(said, bodies, found.speed, turning)
    trains: list[list[int]] = []
    for n in range(len(meshes)):
        if not any(n in one for one in trains):
            trains.append(_train(meshes, n))
    in_sets = {body for one in whole for body in (one.sun, one.ring, one.carrier)} | held
    torques, assumed = _completed(said, stages, meshes, trains, torques, found.speed, in_sets, bodies, on)
    try:
        found = solved(torques)
    except InputError:
        torques = _torques(said, bodies, found.speed, turning, defined_alone=True)
        try:
            found = solved(torques if any(one.value for one in torques) else [])
        except InputError:
            raise _contradiction(said, "torque_around_u_axis", "N*m", "external_load", "torque") from None
    for n in sorted(found.shared):
        said.notes.append(
            f"{stages[n].component.said}: torque not determined by the model; distributed as equally as equilibrium "
            "permits."
        )
    return Flow(found, bodies, held, whole, meshes, frozenset(assumed), assumed_speed)


def _teeth(said: Said, stage: Stage) -> tuple[int, int]:
    """Teeth of both gears; of a bevel stage the second below zero where the mesh turns both the same way about own u.

    Gears whose cones point to the same ends of their own axes turn against each other about them.
    """
    one, two = (teeth_of(said, gear) for gear in stage.gears)
    if stage.component.type != BEVEL:
        return one, two
    ways = [said.word(gear, "bevel_cone_orientation") for gear in stage.gears]
    if None in ways:
        said.notes.append(
            f"{stage.component.said}: orientation of the bevel gears not specified; opposite rotation assumed."
        )
    return one, two if ways[0] == ways[1] or None in ways else -two


def _contradiction(said: Said, name: str, unit: str, kind: str, quantity: str) -> InputError:
    """What is given of torques or speeds, where the teeth do not allow it."""
    size = 1.0 if quantity == "torque" else 2.0 * math.pi / 60.0
    given = [
        f"{value / size:.6g} {unit} of {one.said}"
        for one in said.model.of(kind)
        if (value := said.number(one, quantity, name))
    ]
    rule, remedy = (
        "contradict each other (gear ratios)",
        "correct them, or specify only one",
    )
    if len(given) == 1 and quantity == "torque":
        rule = "has no output in the gear train"
        remedy = "specify an output load, or fix a member of the planetary set (a disengaged coupling does not)"
    return InputError(name, ", ".join(given) or "(powers)", rule, remedy)


def _completed(
    said: Said, stages: list[Stage], meshes: tuple[Mesh, ...], trains: list[list[int]], torques: list[Torque],
    speeds: tuple[float, ...], in_sets: set[int], bodies: dict[int, int], on: dict[int, Component | None],
) -> tuple[list[Torque], set[int]]:  # fmt: skip
    """Torques with those that are assumed where a train has none or lets none out, and the meshes of the former."""
    assumed: set[int] = set()
    for train in trains:
        among = {body for n in train for body in meshes[n].bodies}
        here = [one for one in torques if one.body in among]
        given = [one for one in here if one.value]
        if not given and not among & in_sets:
            torques = [one for one in torques if one.body not in among]
            torques += _assumed_train(said, stages, meshes, train, speeds, here)
            assumed.update(train)
        elif len(here) == 1 and not among & in_sets:
            (one,) = here
            outlets = [body for body in _ends(meshes, train) if body != one.body]
            outlets = outlets[-1:] or [max(among - {one.body})]
            torques += [Torque(body, None) for body in outlets]
            last = next(gear for n in train for gear in stages[n].gears if bodies[on[gear.id].id] == outlets[0])  # type: ignore[union-attr]  # gears on no shaft are refused before
            said.notes.append(f"Output torque assumed at {last.said} (only possible output).")
    return torques, assumed


def _speeds(said: Said, bodies: dict[int, int]) -> dict[int, float]:
    found = {}
    for shaft in said.model.of("shaft"):
        speed = said.number(shaft, "speed", "rotational_speed")
        if speed and said.yes(shaft, "defines_speed") is not False:
            found[bodies[shaft.id]] = -speed if direction(said, shaft) else speed
    return found


def _torques(
    said: Said, bodies: dict[int, int], speeds: tuple[float, ...], turning: set[int], *, defined_alone: bool = False
) -> list[Torque]:
    """Those from outside, from a power where that is given alone.

    Parameters
    ----------
    said : Said
    bodies : dict
    speeds : tuple of float
        Of every body [rad/s]; NaN where unknown.
    turning : set of int
        Bodies in meshes or sets: what stands on others does not reach the teeth.
    defined_alone : bool
        Whether values of loads that do not define their torque are left to balance.
    """
    found = []
    for shaft in said.model.of("shaft"):
        body, sign = bodies[shaft.id], -1.0 if direction(said, shaft) else 1.0
        for load in said.linked(shaft, "assembly", "assembly", "part", "external_load"):
            value = said.number(load, "torque", "torque_around_u_axis")
            through = said.yes(load, "transmits_torque")
            if value is None and math.isfinite(speeds[body]) and speeds[body]:
                power = said.number(load, "power", "power")
                if power:
                    value = sign * power / speeds[body]
                    said.notes.append(f"{load.said}: torque calculated from power, positive if driving.")
            if body not in turning:
                if value:
                    said.notes.append(f"{load.said}: torque does not act on any gear; ignored.")
                continue
            defines = said.yes(load, "defines_torque")
            left = defined_alone and through and not defines
            if left and value:
                said.notes.append(
                    f"{load.said}: torque of {value:g} N m is not in equilibrium (losses); calculated from the loads "
                    "with defines_torque instead."
                )
            if left or defines is False or (value is None and through):
                found.append(Torque(body, None))
            elif value:
                found.append(Torque(body, sign * value))
    return found


def _train(meshes: tuple[Mesh, ...], first: int) -> list[int]:
    """Meshes that are joined to one by the bodies that they have in common."""
    among, size = set(meshes[first].bodies), 0
    while size < len(among):
        size = len(among)
        for mesh in meshes:
            if among & set(mesh.bodies):
                among.update(mesh.bodies)
    return [n for n, mesh in enumerate(meshes) if among & set(mesh.bodies)]


def _ends(meshes: tuple[Mesh, ...], train: list[int]) -> list[int]:
    """Bodies with one mesh alone, in the order of the stages."""
    times = Counter(body for n in train for body in meshes[n].bodies)
    return [body for body, count in times.items() if count == 1]


def _assumed_train(
    said: Said, stages: list[Stage], meshes: tuple[Mesh, ...], train: list[int], speeds: tuple[float, ...],
    here: list[Torque],
) -> list[Torque]:  # fmt: skip
    """One torque at an end of a train, so large that no mesh gets more than is usual, and where it leaves."""
    ends = _ends(meshes, train)
    first = ends[0] if ends else meshes[train[0]].bodies[0]
    leaving = [one.body for one in here if one.body != first] or [body for body in ends if body != first]
    leaving = leaving or [body for body in meshes[train[-1]].bodies if body != first][-1:]
    unit = [Torque(first, math.copysign(1.0, speeds[first])), *(Torque(body, None) for body in leaving)]
    flow = driven(len(speeds), meshes, (), unit, {})
    sizes = []
    for n in train:
        gear = stages[n].gears[0]
        if stages[n].component.type == BEVEL:
            continue
        module = module_of(said, gear)
        usual = _ASSUMED_LOAD * said.needed(gear, "length", "face_width") * 0.5 * module**2 * abs(meshes[n].teeth[0])
        if abs(flow.mesh_torque[n]) > 1e-9:
            sizes.append(abs(usual / flow.mesh_torque[n]))
    size = float(f"{min(sizes, default=1.0):.3g}")
    said.notes.append(
        f"No torque specified for {', '.join(stages[n].component.said for n in train)}: {size:g} N m assumed at the "
        "input of the train."
    )
    return [replace(unit[0], value=math.copysign(size, speeds[first])), *unit[1:]]
