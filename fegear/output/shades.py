"""Shades of the colours by which figures call them, on light and on dark ground."""

from __future__ import annotations

from typing import NamedTuple

from fegear.engine.colours import look

#: Okabe and Ito's palette, and lighter shades of it on dark ground.
LIGHT = {
    "blue": "#0072B2", "orange": "#E69F00", "green": "#009E73", "red": "#D55E00", "purple": "#CC79A7",
    "sky": "#56B4E9", "ink": "#1C2430", "grey": "#8A94A3", "grid": "#E3E8EE", "paper": "#FFFFFF", "white": "#FEFEFE",
}  # fmt: skip

DARK = {
    "blue": "#4FA8E0", "orange": "#F0B429", "green": "#2FC79A", "red": "#F07C38", "purple": "#DC96BF",
    "sky": "#8FD0F5", "ink": "#E6EAF0", "grey": "#94A0B0", "grid": "#2F3946", "paper": "#161B22", "white": "#FEFEFE",
}  # fmt: skip

#: From the lowest to the highest of an ordered family: both ends stand out from the ground.
_LIGHT_RAMP = ("#BDDF26", "#5EC962", "#21918C", "#31688E", "#443983", "#440154")

_DARK_RAMP = ("#FDE725", "#A0DA39", "#4AC16D", "#1FA187", "#3B8FB5", "#8A86D6")

#: Scales of colour of maps, the same on any ground.
SEQUENTIAL = "viridis"

#: Stress inside teeth on light ground, as the window has it: unloaded material is pale.
STRESS = ("#E6EBF1", "#9CC3E2", "#58B59B", "#EFC455", "#E0662F", "#8C0D1C")

DIVERGING = ((0, 114, 178), (143, 193, 227), (255, 255, 255), (242, 196, 109), (230, 159, 0))


class Shade(NamedTuple):
    """One colour on light and on dark ground."""

    light: str
    dark: str


def _between(ramp: tuple[str, ...], share: float) -> str:
    place = share * (len(ramp) - 1)
    i = min(int(place), len(ramp) - 2)
    a, b = ([int(step[k : k + 2], 16) for k in (1, 3, 5)] for step in ramp[i : i + 2])
    return "#" + "".join(f"{round(x + (place - i) * (y - x)):02X}" for x, y in zip(a, b, strict=True))


def shade(role: str) -> Shade:
    """Shades of a role, or of a colour by its name."""
    colour = look(role).colour
    kind, _, share = colour.partition(":")
    if kind == "ramp":
        return Shade(_between(_LIGHT_RAMP, float(share)), _between(_DARK_RAMP, float(share)))
    return Shade(LIGHT[colour], DARK[colour])
