"""What is shown on the gears in mesh, small enough to be sent: colours of fillets, deformed teeth, pressed flanks.

The gears in mesh for the page: outlines and how they turn, and what is switched on at them.
"""

from __future__ import annotations

import base64
import math
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.errors import FegearError
from fegear.engine.plan import make_plan
from fegear.engine.stage import Task
from fegear.results.catalogue import STAGES
from fegear.results.gear.drawing import moving_pair, tool_envelope, undercut_in_mesh, undercut_limits

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.results.gear.crack_shown import CracksShownData
    from fegear.results.pair.deformed_in_mesh import DeformedInMeshData
    from fegear.results.pair.loaded_flanks import LoadedWidePair
    from fegear.results.pair.stress_in_mesh import StressInMeshData
    from fegear.results.pair.stress_inside import ToothStress


#: Points along a fillet that are coloured.
_POINTS = 25


#: The scale of root stress ends at this times the largest tension: where a path of contact begins at a root form circle
#: the end of the fillet has the stress below the load.
_BEYOND = 2.0


#: Largest number of sixteen bits.
_MOST = 32767


#: What stands for no number.
_NONE = -32768


#: The largest displacement is drawn so large, about, where nobody says otherwise [modules].
_DRAWN = 0.1


#: That of a cracked tooth, which is drawn larger [modules].
_OPENED = 0.25


def on_the_gears(task: Task, data: Any) -> dict[str, Any] | None:
    """What a task found, if it is shown at the gears of a pair.

    Parameters
    ----------
    task : Task
    data : object
        As the stage computed it.
    """
    if task.stage == "stress-in-mesh":
        return {"pair": task.subject, "kind": "stress", **_stress(data)}
    if task.stage == "deformed-in-mesh":
        return {"pair": task.subject, "kind": "deformed", **_deformed(data)}
    if task.stage == "stress-inside":
        return {"pair": task.subject, "kind": "field", "gears": {m: _inside(one) for m, one in data.gears.items()}}
    if task.stage == "crack-shown":
        return {"pair": task.subject, "kind": "crack", **_cracks(data)}
    if task.stage == "loaded-flanks":
        return {"pair": task.subject, "kind": "pressure", **_pressure(data)}
    return None


def _stress(data: StressInMeshData) -> dict[str, Any]:
    pitch, largest, start = data.pair.base_pitch, data.largest, data.pair.x_start
    fillets = []
    for member, gear in data.gears.items():
        for side, places in gear.places.items():
            # Points of a section of a gear with a width are few.
            at, values = (places, gear.stress[side]) if data.z.size else _along(places, gear.stress[side])
            fillets.append({"member": member, "places": millimetres(at), "stress": packed(values * 1e-6)})
    limit = max(float(np.nanmax(np.abs(s))) for gear in data.gears.values() for s in gear.stress.values())
    if largest.value > 0.0:
        limit = min(limit, _BEYOND * largest.value)
    return {
        "roll": _rolled(data.roll, start, pitch), "pairs": data.pairs.tolist(), "fillets": fillets,
        "limit": limit * 1e-6, "z": millimetres(data.z),
        "largest": {
            "value": largest.value * 1e-6, "member": largest.member, "pair": largest.pair, "roll": largest.roll * 1e3,
            "x": (largest.roll + largest.pair * pitch) * 1e3, "place": millimetres(largest.place),
            "radius": largest.radius * 1e3, "z": largest.z * 1e3,
            "at": _rolled(np.array([largest.roll]), start, pitch)[0],
        },
    }  # fmt: skip


def _inside(gear: ToothStress) -> dict[str, Any]:
    table = gear.table
    return {
        "places": millimetres(gear.places), "triangles": table.triangles.ravel().tolist(),
        "fillet": np.flatnonzero(table.fillet).tolist(), "roll": millimetres(gear.roll), "reach": table.reach,
        "stress": packed(table.stress), "per_load": gear.per_load * 1e-6, "across": table.across,
    }  # fmt: skip


def _deformed(data: DeformedInMeshData) -> dict[str, Any]:
    module = data.pair.driver.module
    return {
        "roll": _rolled(data.roll, data.pair.x_start, data.pair.base_pitch),
        "pairs": data.pairs.tolist(),
        "ahead": np.round(data.transmission_error * 1e3, 8).tolist(),
        "largest": data.largest * 1e6,
        "factor": round_factor(_DRAWN * module / data.largest) if data.largest > 0.0 else 1.0,
        "gears": {
            member: {"places": millimetres(data.places[member]), "moved": packed(data.moved[member] * 1e3)}
            for member in data.places
        },
    }


def _cracks(data: CracksShownData) -> dict[str, Any]:
    module = data.gear.module
    cracks = []
    for one in data.cracks:
        largest = float(np.hypot(*one.moved).max())
        # In colour up to what a fillet has; beside the tip and the load it is more.
        limit = float(one.mises[one.fillets].max())
        cracks.append({
            "tooth": one.tooth, "place": one.place, "ends": one.ends, "back": one.back,
            "path": millimetres(one.path), "outline": millimetres(one.outline), "points": millimetres(one.points),
            "moved": packed(one.moved * 1e3), "triangles": one.triangles.ravel().tolist(),
            "mises": packed(np.minimum(one.mises, 20.0 * limit) * 1e-6), "limit": limit * 1e-6,
            "faces": [one.left.tolist(), one.right.tolist()], "contact": millimetres(one.contact),
            "opening": float(np.hypot(*(one.moved[:, one.left[0]] - one.moved[:, one.right[0]]))) * 1e6,
            "factor": round_factor(_OPENED * module / largest) if largest > 0.0 else 1.0,
            "k": [_with_error(*one.k_1), _with_error(*one.k_2)], "loss": one.loss, "closed": one.closed,
        })  # fmt: skip
    return {
        "module": module * 1e3, "side": data.gear.tooth.side, "radius": data.radius * 1e3, "load": data.load * 1e-3,
        "of": data.pair, "cracks": cracks,
    }  # fmt: skip


def _with_error(value: float, error: float) -> dict[str, float | None]:
    """In MPa.m^(1/2), with its error if there is one."""
    return {"value": value * 1e-6, "error": error * 1e-6 if np.isfinite(error) else None}


def _pressure(data: LoadedWidePair) -> dict[str, Any]:
    found, i = data.found, data.at
    lines, pair = found.lines, found.pair
    pressure = found.pressure[:, :, i] * 1e-6
    inner = found.smooth_pressure[:, :, i] * 1e-6
    places = lines.z, lines.radius(pair, "driver"), lines.radius(pair, "driven")
    positions = [
        [
            [
                int(lines.pair[p, one.start]),
                *(millimetres(v[p, one]) for v in places),
                np.round(pressure[p, one], 2).tolist(),
            ]
            for one in lines.at(p)
        ]
        for p in range(lines.roll.size)
    ]
    ends = {
        member: [gear.form_radius * 1e3, gear.tip_radius * 1e3, gear.pitch_radius * 1e3]
        for member, gear in (("driver", pair.driver), ("driven", pair.driven))
    }
    return {
        "roll": _rolled(lines.roll, pair.x_start, pair.base_pitch), "positions": positions, "ends": ends,
        "pairs": found.pair_numbers.tolist(), "load": np.round(found.share[:, :, i] * found.load[i], 3).tolist(),
        "low": lines.low * 1e3, "high": lines.high * 1e3, "limit": float(inner.max()),
    }  # fmt: skip


def packed(values: NDArray[np.floating[Any]]) -> dict[str, Any]:
    """Numbers as sixteen-bit steps of their largest, in base 64: 1.5e-5 of it is a step; NaN is `_NONE`."""
    step = float(np.nanmax(np.abs(values))) / _MOST or 1.0
    data = np.nan_to_num(np.round(values / step), nan=_NONE).astype("<i2").tobytes()
    return {"step": step, "shape": list(values.shape), "data": base64.b64encode(data).decode()}


def millimetres(values: Array) -> list[Any]:
    """To 0.1 um."""
    found: list[Any] = np.round(values * 1e3, 4).tolist()
    return found


def _rolled(roll: Array, start: float, pitch: float) -> list[float]:
    """Roll positions as parts of the base pitch."""
    found: list[float] = np.round((roll - start) / pitch, 8).tolist()
    return found


def _along(places: Array, stress: Array) -> tuple[Array, Array]:
    """Fewer points along fillets of shape (T, 2, n), and the stress (P, T, n) there."""
    step = np.hypot(*np.diff(places[0], axis=1))
    arc = np.concatenate([[0.0], np.cumsum(step)])
    wanted = np.linspace(0.0, arc[-1], _POINTS)
    after = np.clip(np.searchsorted(arc, wanted), 1, arc.size - 1)
    share = (wanted - arc[after - 1]) / (arc[after] - arc[after - 1])
    at, values = (v[..., after - 1] * (1.0 - share) + v[..., after] * share for v in (places, stress))
    return at, values


def round_factor(value: float, most: float = 1000.0) -> float:
    """1, 2 or 5 times a power of ten, no larger than a value, within 1 and `most`."""
    power = 10.0 ** np.floor(np.log10(max(value, 1.0)))
    return float(min(most, power * max(step for step in (1.0, 2.0, 5.0) if step * power <= max(value, 1.0))))


#: What is switched on at the gears, and the stage that computes it.
_STAGES = {"stress": "stress-in-mesh", "deformed": "deformed-in-mesh"}


#: Kinds that are shown whenever they are computed: on flanks, of planets, of shafts.
UNASKED = ("pressure", "loads", "bent", "field", "crack")


#: Teeth that are drawn on either side of those that touch at the pitch point: enough for a turn over the whole path.
_BESIDE = 6


#: Why deformed teeth are not shown of gears with a width.
_NOT_PLANE = (
    "Available for plane (2D) tooth pairs only: for 3D gears the displacement of tips and non-working flanks is not "
    "computed."
)


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return np.round(value, 9).tolist()  # to a nanometre
    return value


def gears_in_mesh(scene: Scene, name: str) -> dict[str, Any]:
    """Outlines of both gears and how they turn, for the page to draw, and what can be switched on in vain.

    Of each gear the tooth that touches at the pitch point, and in ``rows`` how many stand on either side and the angle
    from each to the next [rad], counterclockwise about its centre: teeth are alike, and all of them would be 200 kB.

    Parameters
    ----------
    scene : Scene
    name : str
        Of the pair.
    """
    pair = scene.pairs[name]
    found = {key: _plain(value) for key, value in asdict(moving_pair(pair, 0)).items()}
    ways = {"driver": (pair.driver.teeth, -1.0), "driven": (pair.driven.teeth, -float(pair.side))}
    rows = {
        member: [min(_BESIDE, (teeth - 1) // 2), way * 2.0 * math.pi / teeth] for member, (teeth, way) in ways.items()
    }
    ratios = {"transverse": pair.contact_ratio} | ({"overlap": pair.overlap_ratio} if pair.driver.helix_angle else {})
    return found | {
        "rows": rows,
        "ratios": ratios,
        "undercut": [
            {
                "member": member,
                "lost": one.lost * 1e3,
                "shift": one.profile_shift,
                "enough": one.enough,
                "straight": one.straight,
            }
            for member, one in undercut_in_mesh(pair).items()
        ],
        "enough": undercut_limits(pair),
        "wide": name in scene.wide_pairs,
        "refused": {kind: _NOT_PLANE for kind in _STAGES if kind not in _stages(scene, name)},
    }


def _stages(scene: Scene, name: str) -> dict[str, str]:
    """The stages that compute what is switched on at the gears of a pair."""
    return {kind: stage for kind, stage in _STAGES.items() if kind != "deformed" or name in scene.plane_pairs}


def wanted_on_gears(scene: Scene, shows: Iterable[tuple[str, str]]) -> tuple[list[Task], list[dict[str, Any]]]:
    """What is switched on at the gears: tasks that compute it, and what can be told of it at once.

    Parameters
    ----------
    scene : Scene
    shows : iterable of (str, str)
        Pair and kind: ``stress``, ``deformed`` or ``tool``.

    Returns
    -------
    tasks : list of Task
    told : list of dict
        For the page: the tool's positions, and why a kind cannot be had.
    """
    tasks: list[Task] = []
    told: list[dict[str, Any]] = []
    for pair, kind in shows:
        if pair not in scene.pairs:
            continue
        if kind == "tool":
            gears = scene.pairs[pair]
            lines = {member: millimetres(at) for member, at in tool_envelope(gears).items()}
            tips = {member: gears.gear(member).tip_radius * 1e3 for member in lines}
            told.append({"pair": pair, "kind": kind, "lines": lines, "tips": tips})
        elif kind not in (stages := _stages(scene, pair)):
            told.append({"pair": pair, "kind": kind, "refused": _NOT_PLANE})
        else:
            task = Task(stages[kind], pair)
            try:
                make_plan(scene, STAGES, [task])
                tasks.append(task)
            except FegearError as error:
                told.append({"pair": pair, "kind": kind, "refused": str(error)})
    return tasks, told
