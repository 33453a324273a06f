"""A crack's tip that is dragged: the text of a case whose crack ends elsewhere."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.case.changed_text import value_at, with_values
from fegear.results.gear.crack_handles import share_of_way

if TYPE_CHECKING:
    from fegear.case.changed_text import Path
    from fegear.window.document import Desk


def moved_crack(desk: Desk, gear: str, place: int, depth: float, angle: float) -> str:
    """The text of a case with a straight crack of another length, under another angle; its start stays.

    What says how long it is stays the key that it was, as far as the new direction has a way through the tooth.

    Parameters
    ----------
    desk : Desk
        The case.
    gear : str
    place : int
        Which of the gear's `odd_tooth` it is.
    depth : float
        [mm].
    angle : float
        To the tooth's centre line [deg].

    Raises
    ------
    InputError
        If the text cannot be changed there, or the crack is given by its corners.
    """
    table: Path = ("gear", gear, "odd_tooth")
    if isinstance(value_at(desk.document, table), list):
        table = (*table, str(place))
    table = (*table, "crack")
    given = value_at(desk.document, table)
    if not isinstance(given, dict) or "path" in given:
        raise InputError(
            ".".join(table), "(given)", "is not a straight crack: its tip cannot be moved",
            "change its path in the form or the text",
        )  # fmt: skip
    changes: dict[Path, str | None] = {(*table, "angle"): f'"{angle:.2f} deg"'}
    scene = desk.scene if "depth_ratio" in given else None
    ratio = None if scene is None else share_of_way(scene, gear, place, depth * 1e-3, math.radians(angle))
    if ratio is not None:
        return with_values(desk.text, {**changes, (*table, "depth_ratio"): f"{ratio:.4f}"})
    return with_values(desk.text, {**changes, (*table, "depth"): f'"{depth:.4g} mm"', (*table, "depth_ratio"): None})
