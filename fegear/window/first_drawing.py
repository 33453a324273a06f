"""The gears of the case as they stand in the page that is served: drawn before any of its scripts has run.

The page's own drawing takes its place as soon as it is there; until then nothing can be done with this one.
"""

from __future__ import annotations

import math
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.window.glance import View

#: Half the height of the picture, and half its width at least [modules], as of the page's own (gears.js).
_TALL, _WIDE = 3.2, 6.0
#: How far beyond the ends of the path of contact it reaches.
_BESIDE = 1.3


def first_drawing(pairs: Mapping[str, Mapping[str, Any]], view: View, title: str = "") -> str:
    """The drawing of a pair as HTML, where the page's own will stand, or the title only where there is none.

    Parameters
    ----------
    pairs : mapping of str to mapping
        As `drag_handles.hands_of`.
    view : View
        How the page was left.
    title : str
        Of the case; says what is being computed.
    """
    told = f"<p>{escape(title)}: computing …</p>" if title and not view.report else ""
    mesh = next((one["mesh"] for name, one in pairs.items() if view.middle in ("", name)), None)
    if mesh is None or view.report:
        return f'<div id="first-gears">{told}</div>' if told else ""
    m = mesh["module"] * 1e3
    tall, wide = _TALL * m, max(_WIDE * m, _BESIDE * 1e3 * max(-mesh["start"], mesh["end"]))
    paths = "".join(
        f'<path class="{member}" d="{_line(mesh, member, sign)}" transform="rotate({_turned(mesh, member, sign):.4f} 0 '
        f'{sign * mesh[f"{member}_radius"] * 1e3:.4f})"/>'
        for member, sign in (("driver", -1.0), ("driven", 1.0))
    )
    box = f"{-wide:.4f} {-tall:.4f} {2.0 * wide:.4f} {2.0 * tall:.4f}"
    return (
        f'<div id="first-gears" class="{"folded" if view.folded else ""}" aria-hidden="true">{told}'
        f'<svg class="mesh" viewBox="{box}"><g transform="scale(1,-1)">{paths}</g></svg></div>'
    )


def _turned(mesh: Mapping[str, Any], member: str, sign: float) -> float:
    """How far a gear stands from the pitch point where a pair comes into contact [deg], the first position."""
    return sign * math.degrees(float(mesh["start"]) / float(mesh[f"{member}_base"]))


def _line(mesh: Mapping[str, Any], member: str, sign: float) -> str:
    """A gear's row of teeth [m] as a path, to a micrometre."""
    count, turn = mesh["rows"][member]
    x, y = 1e3 * np.array(mesh[member])
    centre = sign * mesh[f"{member}_radius"] * 1e3
    angle = turn * np.arange(-count, count + 1)[:, None]
    c, s = np.cos(angle), np.sin(angle)
    row = np.stack([c * x - s * (y - centre), s * x + c * (y - centre) + centre])
    return "M" + "L".join(f"{px:.3f},{py:.3f}" for px, py in row.reshape(2, -1).T.tolist())
