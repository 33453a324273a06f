"""Which colour, dash and symbol each quantity has in every figure.

Colours are names; renderers know their shades on light and on dark ground. A role is a key of `ROLES`, or

- ``series:3``, the fourth of a family without order,
- ``ramp:0.25``, a place in an ordered family (loads), from the lowest at 0 to the highest at 1,
- a colour's own name, ``grey``.
"""

from __future__ import annotations

from typing import NamedTuple

#: Distinguished by all kinds of colour vision (Okabe and Ito).
SERIES = ("blue", "orange", "green", "red", "purple", "sky")
DASHES = ("solid", "dash", "dashdot", "dot", "longdash", "longdashdot")
SYMBOLS = ("circle", "square", "triangle-up", "diamond", "triangle-down", "cross")


class Look(NamedTuple):
    """How a quantity is drawn."""

    colour: str
    dash: str = "solid"
    symbol: str = "circle"


ROLES: dict[str, Look] = {
    # one gear
    "loaded tooth": Look("blue"),
    "next tooth": Look("orange", "dash"),
    "previous tooth": Look("green", "dashdot"),
    "tension": Look("red"),
    "compression": Look("blue", "dash"),
    "finite elements": Look("ink"),
    "outline": Look("blue"),
    "tool": Look("orange"),
    # a pair
    "driver": Look("blue"),
    "driven": Look("red", "dash"),
    "driver compression": Look("purple", "dashdot"),
    "driven compression": Look("green", "dot"),
    "secant": Look("blue"),
    "local slope": Look("orange", "dash"),
    # reliefs
    "no relief": Look("ink", "dot"),
    "designed": Look("blue", "solid", "circle"),
    "diagonal only": Look("red", "dash", "square"),
    "linear tip relief": Look("orange", "dashdot", "triangle-up"),
    "parabolic tip relief": Look("green", "longdashdot", "diamond"),
    "linear tip relief for one load": Look("sky", "dashdot", "triangle-up"),
    "parabolic tip relief for one load": Look("grey", "longdash", "diamond"),
    "relief of the case": Look("purple", "dash", "triangle-down"),
    "present relief": Look("purple", "dash", "triangle-down"),
    "over map": Look("white"),
    # motion
    "static": Look("grey", "dash"),
    "own force": Look("blue"),
    "with other meshes": Look("red", "dot"),
    "mesh force": Look("green", "dash"),
    "no contact": Look("orange"),
    "back flanks": Look("purple", "dash"),
    # kinds of contact
    "surface": Look("green", "solid", "circle"),
    "gear tip": Look("blue", "solid", "triangle-up"),
    "pinion tip": Look("sky", "solid", "triangle-down"),
    "gear face end": Look("orange", "solid", "square"),
    "pinion face end": Look("red", "solid", "diamond"),
    "corner": Look("purple", "solid", "cross"),
    # effects
    "without": Look("orange", "dash"),
    "with": Look("blue"),
}


def look(role: str) -> Look:
    """How a role is drawn."""
    if role in ROLES:
        return ROLES[role]
    kind, _, place = role.partition(":")
    if kind == "series":
        k = int(place)
        return Look(SERIES[k % len(SERIES)], DASHES[k % len(DASHES)], SYMBOLS[k % len(SYMBOLS)])
    return Look(role)
