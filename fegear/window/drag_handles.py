"""What of a case is changed by hand beside its form: gears in mesh, reliefs over the roll angle, loads.

Changes of a case's text by the hands on its reliefs: parts that move, gears that get a name of their own.
"""

from __future__ import annotations

import math
import re
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, Literal

from fegear.base.effects import RELIEF
from fegear.base.errors import FegearError, InputError
from fegear.base.units import unit_size
from fegear.case.changed_text import literal, value_at, with_value, with_values
from fegear.output.draw_plotly.layout import darker, plotly_json
from fegear.results.exercises.pair import exercises_of_pair
from fegear.results.relief.relief_handles import STARTS, handle_of, handled_relief, start_as_given
from fegear.window.assemblies import assemblies_of
from fegear.window.on_gears import gears_in_mesh

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.changed_text import Path
    from fegear.case.reading import Scene
    from fegear.window.document import Desk


def hands_of(scene: Scene) -> dict[str, Any]:
    """For every pair: its gears in mesh, the reliefs, and the load.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    dict
        By the pair's name: ``mesh``, ``reliefs``, ``load``, ``designs``: whether reliefs are found by theory, which is
        of plane teeth, and ``exercises``.
    """
    found: dict[str, Any] = {}
    for name in scene.pairs:
        found[name] = {
            "mesh": gears_in_mesh(scene, name), "reliefs": _reliefs(scene, name), "load": _load(scene, name),
            "designs": name in scene.plane_pairs,
            "exercises": [one._asdict() for one in exercises_of_pair(scene, name)],
        }  # fmt: skip
    return found


def drawn_at_once(desk: Desk) -> dict[str, Any]:
    """What a page draws of a case before anything is computed, by what is said with it; empty where it is refused."""
    found: dict[str, Any] = {}
    if desk.scene is None or desk.refusal is not None:
        return found
    try:
        found["hands"] = {"pairs": hands_of(desk.scene)}
        found["assemblies"] = assemblies_of(desk.scene)
    except FegearError:  # the computing process says so
        return {}
    return found


def _reliefs(scene: Scene, name: str) -> list[dict[str, Any]]:
    made: list[dict[str, Any]] = []
    for member in _MEMBERS:
        relief = handled_relief(scene, name, member)
        if any(relief.gear == other["gear"] for other in made):  # a gear that meets its like has one relief
            continue
        document = value_at(scene.document, ("gear", relief.gear, "relief")) or {}
        figure = relief.figure
        made.append({
            "gear": relief.gear, "low": relief.low, "high": relief.high, "usual": relief.usual,
            "handles": [asdict(handle) for handle in relief.handles],
            "given": sorted(document), "over_face": scene.case.gear[relief.gear].over_face,
            "on": scene.case.effects.relief,
            "figure": {"key": figure.key, "heading": figure.heading, "caption": figure.caption, **plotly_json(figure)},
            "darker": darker([figure]),
        })  # fmt: skip
    return made


def _load(scene: Scene, name: str) -> dict[str, Any] | None:
    """The key of a pair's load that the case gives, what it has, and the range of several that it runs under."""
    part = scene.case.pair[name]
    several, key, unit = (
        (part.torques.in_order.tolist(), "torque", "N*m") if part.torques is not None
        else (list(part.loads or ()), "load", "N")
    )  # fmt: skip
    for own in ("torque", "load"):
        given = value_at(scene.document, ("pair", name, own))
        if isinstance(given, str):
            if own != key or len(set(several)) < 2:
                return {"key": own, "text": given}
            return {"key": own, "text": given, "range": _ascending(several, _UNIT.sub("", given), own)}
    if not several or part.power is not None:
        return None
    found: dict[str, Any] = {"key": key, "text": f"{max(several):.6g} {unit}"}
    return found | ({"range": _ascending(several, unit, key)} if len(set(several)) > 1 else {})


def _ascending(values: list[float], unit: str, key: str) -> list[float]:
    """Each once, in a unit of forces or torques."""
    size = unit_size(unit, "force" if key == "load" else key)
    return [float(f"{one / size:.10g}") for one in sorted(set(values))]


#: The number before a unit.
_UNIT = re.compile(r"^\s*[-+]?[\d.]+(?:[eE][-+]?\d+)?\s*")
_MEMBERS: tuple[Literal["driver"], Literal["driven"]] = ("driver", "driven")


#: Keys of a gear that modify its flanks.
_MODIFIED = {"relief", "lead", "bias", "topography"}


#: A part of a relief that has moved by less than this stands where it stood [deg], [um]: so much is written.
_SAME_START, _SAME_AMOUNT = 6e-4, 6e-3


def moved_relief(desk: Desk, gear: str, end: str, start: float, amount: float, index: int = 0) -> str:
    """The text of a case with one part of a relief elsewhere, or of another size; the others stay.

    What says where it starts stays the key that it was: a length stays a length.

    Parameters
    ----------
    desk : Desk
        The case.
    gear : str
    end : str
        ``tip``, ``root`` or ``crowning``.
    start : float
        Roll angle [deg]; a crowning keeps its ends.
    amount : float
        [um].
    index : int
        Which of several.

    Raises
    ------
    InputError
        If the text cannot be changed there.
    """
    table: Path = ("gear", gear, "relief", end)
    for key, value in (("start", start), ("amount", amount)):
        if not isinstance(value, int | float) or not math.isfinite(value):  # a page without room for its axes
            raise InputError(".".join((*table, key)), str(value), "must be a finite number")
    if isinstance(value_at(desk.document, table), list):
        table = (*table, str(index))
    given = value_at(desk.document, table)
    given = given if isinstance(given, dict) else {}
    handle = None if desk.scene is None else handle_of(desk.scene, gear, end, index)
    changes: dict[Path, str | None] = {}
    if handle is None or "amount" not in given or abs(amount - handle.amount) > _SAME_AMOUNT:
        changes[(*table, "amount")] = f'"{amount:.2f} um"'
        changes[(*table, "amount_over_delta")] = None
    if end != "crowning" and (handle is None or abs(start - handle.start) > _SAME_START):
        key, text = start_as_given(given, handle, start)
        changes[(*table, key)] = text
        changes |= {(*table, other): None for other in STARTS if other != key}
    return with_values(desk.text, {**changes, ("effects", RELIEF.name): "true"})


def _tables(document: Mapping[str, Any], kind: str) -> dict[str, dict[str, Any]]:
    """The named tables of a kind, as far as the case goes: it may have faults."""
    found = document.get(kind)
    return {name: one for name, one in found.items() if isinstance(one, dict)} if isinstance(found, dict) else {}


def without_relief(text: str, document: Mapping[str, Any], gear: str) -> str:
    """The text of a case with a gear without relief, and without the effect where no flank is modified any more.

    Raises
    ------
    InputError
        If the text cannot be changed there.
    """
    gears, pairs = (_tables(document, kind) for kind in ("gear", "pair"))
    left = {name: {key for key in one if name != gear or key != "relief"} for name, one in gears.items()}
    changes: dict[Path, str | None] = {("gear", gear, "relief"): None}
    if not any(keys & _MODIFIED for keys in left.values()) and not any("modification" in one for one in pairs.values()):
        changes["effects", RELIEF.name] = None
    return with_values(text, changes)


def own_name(text: str, document: Mapping[str, Any], pair: str) -> str:
    """The text with the driven gear of a pair as a gear of its own, where it was the driver as well.

    Raises
    ------
    InputError
        If the text cannot be changed there.
    """
    gears, gear = _tables(document, "gear"), value_at(document, ("pair", pair, "driven"))
    if gear not in gears:
        raise InputError(f"pair.{pair}.driven", gear, "is not a gear of this case")
    name = next(n for n in (f"{gear}_driven", *(f"{gear}_driven_{i}" for i in range(2, 99))) if n not in gears)
    text = with_value(text, ("pair", pair, "driven"), literal(name))
    lines = [f"{key} = {literal(value)}" for key, value in gears[gear].items()]
    end = text if text.endswith("\n") else f"{text}\n"
    return "\n".join([f"{end}\n[gear.{name}]", *lines, ""])
