"""Stage ``root-stress-history``: root stress of one tooth of either gear on its way through the mesh."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Stage
from fegear.errors import InputError
from fegear.models.pair_checks import check_relief
from fegear.models.pair_inputs import MEMBERS, gear_name
from fegear.results import forecasts
from fegear.results.loaded_pair import EFFECTS, loaded_pair, needs_pair, solve_again, spur_pairs
from fegear.results.transmission_error import roll_positions

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.case.reading import Scene
    from fegear.contact import Engagement, Loaded
    from fegear.engine.stage import Done, Progress
    from fegear.geometry.pair import Member
    from fegear.models.loaded_pair import LoadedPair

    Array = NDArray[np.float64]


@dataclass(frozen=True)
class ToothStress:
    """Largest root stresses of one tooth while its pair passes through the mesh; arrays of shape (P, L).

    Parameters
    ----------
    x : ndarray, shape (P,)
        Position of the tooth's contact [m].
    tension, compression : ndarray
        Largest tension below the loaded flank and most negative compression on the other side [Pa].
    tension_error : ndarray
        Estimated [Pa].
    """

    x: Array
    tension: Array
    compression: Array
    tension_error: Array


@dataclass(frozen=True)
class RootStressData:
    """What the stage hands to pictures."""

    pair: LoadedPair
    stress: dict[Member, ToothStress]


def _check(scene: Scene, name: str) -> None:
    check_relief(scene, name)
    source = scene.case.pair[name].compliance.source
    if source != "fe":
        raise InputError(f"pair.{name}.compliance.source", f'"{source}"', "knows no root stress", 'set source = "fe"')


def _states(e: Engagement, x: Array, loads: tuple[float, ...]) -> list[tuple[int, Loaded]]:
    """Row of each tooth and the loaded state for it: the same state unless teeth differ by their spacing errors."""
    grid = e.grid(x)
    numbers = np.concatenate([[grid.contacts.number[0] - 1], grid.contacts.number, [grid.contacts.number[-1] + 1]])
    if not (e.driver_spacing.size or e.driven_spacing.size):
        state = e.solve(grid, loads)
        return [(row, state) for row in range(numbers.size)]
    # The tooth of interest carries pair number j in base pitch number j.
    return [(row, e.solve(grid, loads, int(number))) for row, number in enumerate(numbers)]


def tooth_stress(pair: LoadedPair, member: Member) -> ToothStress:
    """Follow one tooth of a gear from a base pitch before its contact to one after it."""
    from fegear.contact import root_stress_history
    from fegear.contact.root_stress_history import root_stress_kernels

    e = pair.engagement
    states = _states(e, roll_positions(pair), pair.loads)
    contacts = states[0][1].grid.contacts
    pull, press = (root_stress_kernels(e, contacts, member, side, 1) for side in ("tension", "compression"))
    xs: list[Array] = []
    tension: list[Array] = []
    compression: list[Array] = []
    error: list[Array] = []
    known: dict[int, tuple[Array, Array, Array, Array]] = {}
    for row, state in states:
        if id(state) not in known:
            pulled = root_stress_history(e, state, member, "tension", 1, pull)
            pressed = root_stress_history(e, state, member, "compression", 1, press)
            off = np.zeros_like(pulled.stress)
            for other in pair.shifted:
                again = solve_again(other, state.grid, state)
                off = off + np.abs(root_stress_history(e, again, member, "tension", 1, pull).stress - pulled.stress)
            off[1:-1] += _own_error(pair, member, state)
            known[id(state)] = pulled.x, pulled.stress, pressed.stress, off
        for found, values in zip((xs, tension, compression, error), known[id(state)], strict=True):
            found.append(values[row])
    x = np.concatenate(xs)
    order = np.argsort(x)
    pitch = e.pair.base_pitch
    order = order[(x[order] > e.pair.x_start - pitch) & (x[order] < e.pair.x_end + pitch)]
    t, c, off = (np.concatenate(parts)[order] for parts in (tension, compression, error))
    return ToothStress(x[order], t, c, off)


def _own_error(pair: LoadedPair, member: Member, state: Loaded) -> Array:
    """What the finite elements leave in the stress of each tooth's own load, shape (n, P, L) [Pa]."""
    from fegear.contact.fe_compliance import FiniteElementCompliance

    source = pair.engagement.compliance.source(member)
    if not isinstance(source, FiniteElementCompliance):
        return np.zeros(state.loads.shape)
    contacts = state.grid.contacts
    radius = contacts.radius_driver if member == "driver" else contacts.radius_driven
    ends = source.influence.lowest_radius, source.influence.highest_radius
    few = np.linspace(max(radius.min(), ends[0]), min(radius.max(), ends[1]), 9)
    usual = source.influence.root_stress_error(0, "tension", few)
    per_load = np.interp(radius, few, usual)
    return np.asarray(per_load[:, :, None] * state.loads / pair.engagement.compliance.face_width)


def _table(name: str, gear: str, s: ToothStress, i: int, rate: float | None, loads: tuple[float, ...]) -> Table:
    columns = [
        Column("x", s.x, "mm", "position of the tooth's contact on the line of action"),
        Column("stress", s.tension[:, i], "MPa", "largest tangential tension of the fillet below the loaded flank"),
        Column("compression", s.compression[:, i], "MPa", "most negative stress of the other fillet"),
        Column("stress_error", s.tension_error[:, i], "MPa", "estimated error of stress"),
    ]
    if rate is not None:
        columns.insert(0, Column("t", (s.x - s.x[0]) / rate, "s", "from the first position"))
    for k, load in enumerate(loads):
        if k != i:
            columns.append(Column(f"stress at {load:.6g} N", s.tension[:, k], "MPa", "as stress, under this load"))
    return Table(f"root_stress_history_{name}", tuple(columns), f"Root stress of a tooth of gear {gear} in the mesh")


def table_names(scene: Scene, name: str) -> dict[Member, str]:
    """``<pair>_<gear>``; where a gear meshes with its like the driven one's name ends in ``_driven``."""
    names = {member: gear_name(scene, name, member) for member in MEMBERS}
    twins = names["driver"] == names["driven"]
    return {m: f"{name}_{g}" + ("_driven" if twins and m == "driven" else "") for m, g in names.items()}


def _run(scene: Scene, name: str, done: Done, progress: Progress) -> Outcome:
    pair = loaded_pair(done, name)
    i = pair.loads.index(pair.nominal)
    speed = scene.case.pair[name].speed
    rate = None if speed is None else speed * pair.engagement.pair.driver.base_radius
    tables, values = [], []
    stress: dict[Member, ToothStress] = {}
    for number, (member, label) in enumerate(table_names(scene, name).items()):
        s = stress[member] = tooth_stress(pair, member)
        progress((number + 1) / 2)
        gear = gear_name(scene, name, member)
        tables.append(_table(label, gear, s, i, rate, pair.loads))
        worst, least = int(np.argmax(s.tension[:, i])), int(np.argmin(s.compression[:, i]))
        values += [
            Value(
                f"{name}.{member}.largest_root_tension", float(s.tension[worst, i]), "MPa",
                float(s.tension_error[worst, i]), f"gear {gear}, contact at x = {s.x[worst] * 1e3:.5g} mm",
            ),
            Value(
                f"{name}.{member}.largest_root_compression", float(s.compression[least, i]), "MPa", None,
                f"gear {gear}, contact at x = {s.x[least] * 1e3:.5g} mm",
            ),
            Value(
                f"{name}.{member}.root_stress_range", float(np.ptp(s.tension[:, i])), "MPa", None,
                "largest less smallest stress below the loaded flank over the mesh",
            ),
        ]  # fmt: skip
    return Outcome(RootStressData(pair, stress), tuple(tables), tuple(values))


ROOT_STRESS_HISTORY = Stage(
    name="root-stress-history",
    title="Root stress through the mesh",
    results=("root-stress-history",),
    subjects=spur_pairs,
    run=_run,
    needs=needs_pair,
    check=_check,
    effects=EFFECTS,
    forecast=forecasts.root_stress_history,
)
