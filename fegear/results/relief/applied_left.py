"""What a design written into a case leaves at each torque, for which it is, and which comments are no longer true."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.results.relief.answer_numbers import microns, torque_words

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.engine.table import Table

#: Torques that are named at most: more than these leave out what lies between, but for where a design leaves more.
_NAMED = 4
#: Torques are the same within this of each other.
_SAME = 1e-6
#: Comments of drafted cases that a relief makes untrue, and what takes their place.
_STALE = (
    (re.compile(r"(?m)^(\s*\"transmission-error\",.*# transmission error) without relief[ \t]*$"),
     r"\1 with the relief of the gears"),
    (re.compile(r"(?m)^# relief = true\b.*# off: .*\n"), ""),
)  # fmt: skip
_STALE_TIP = re.compile(r"(?m)^# relief = \{ tip = \{ amount = \"15 um\", length = \"4 mm\" \} \}[ \t]*\n")


@dataclass(frozen=True)
class LeftByDesign:
    """What a design leaves at each torque; arrays of shape (T,).

    Parameters
    ----------
    torque, none, left : ndarray
        Of the driver [N m], peak-to-peak transmission error without relief and with the design [m].
    only : float or None
        The torque that it is for, where it is for one of several [N m].
    """

    torque: Array
    none: Array
    left: Array
    only: float | None

    @property
    def remark(self) -> str:
        """For a comment in the case; empty for a design for all torques."""
        return "" if self.only is None else f"for {torque_words(self.only)} only"

    @property
    def sentence(self) -> str:
        """For which torque it is, and what it leaves at each."""
        order = np.argsort(-self.torque)
        worse = [int(i) for i in order if self.left[i] > self.none[i]]
        named = order.tolist() if order.size <= _NAMED else [order[0], *worse[: _NAMED - 2], order[-1]]
        said = [self._at(i) for i in dict.fromkeys(map(int, named))]
        of = "Transmission error"
        if self.only is not None:
            of = f"It is for {torque_words(self.only)} only: transmission error"
        return f"{of} {', '.join(said)}, peak to peak."

    def _at(self, i: int) -> str:
        more = " (more than without relief)" if self.left[i] > self.none[i] else ""
        return f"{microns(self.none[i])} -> {microns(self.left[i], 3)} µm at {torque_words(self.torque[i])}{more}"


def left_by_design(
    scene: Scene, tables: Mapping[str, Table], pair: str, design: str, *, exact: bool
) -> LeftByDesign | None:
    """What the tables of a run say of a design; None where they say nothing of it.

    Parameters
    ----------
    scene : Scene
        Of the run.
    tables : mapping of str to Table
    pair, design : str
    exact : bool
        Whether it is the relief by theory, which is for the design load only.
    """
    table = tables.get(f"relief_over_torque_{pair}")
    if table is None:
        return None
    key = "designed" if exact else re.sub("[ -]", "_", design)
    names = [f"te_peak_to_peak_rounded_{key}", f"te_peak_to_peak_{key}", "te_peak_to_peak_no_relief", "torque"]
    known = {column.name for column in table.columns}
    found = [np.asarray(table.column(name).si, dtype=float) for name in names if name in known]
    if not {names[1], *names[2:]} <= known:
        return None
    torque, none, left = found[-1], found[-2], found[0]
    return LeftByDesign(torque, none, left, _only(scene, table, pair, torque, exact=exact))


def _only(scene: Scene, table: Table, pair: str, torque: Array, *, exact: bool) -> float | None:
    """The torque that a design is for; None where it is for all that there are."""
    if torque.size < 2:
        return None
    weight = np.asarray(table.column("weight").si, dtype=float)
    if not exact:
        return float(torque[weight > 0.0][0]) if (weight > 0.0).sum() == 1 else None
    design, part, gears = scene.case.design, scene.case.pair[pair], scene.pairs[pair]
    load = (design and design.load) or part.normal_load(gears)
    return None if load is None else float(load * gears.driver.base_radius)


def without_stale_comments(text: str, gears: tuple[str, ...]) -> str:
    """The text of a drafted case without comments that are not true of gears with a relief.

    Parameters
    ----------
    text : str
    gears : tuple of str
        Names of those that have one.
    """
    for pattern, instead in _STALE:
        text = pattern.sub(instead, text)
    for gear in gears:
        head = re.search(rf"(?m)^\[gear\.{re.escape(gear)}\][ \t]*$", text)
        if head is None:
            continue
        following = re.compile(r"(?m)^\[").search(text, head.end())
        end = len(text) if following is None else following.start()
        text = text[: head.end()] + _STALE_TIP.sub("", text[head.end() : end]) + text[end:]
    return text
