"""Small pictures of jobs for the page that one begins with: teeth are drawn true to shape, curves by hand."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.base.arrays import Array

#: Room of a picture, and margins of a diagram in it [px].
_WIDE, _HIGH, _ROOM = 240.0, 110.0, 10.0
#: Modules of height that are seen, and the pair that is drawn.
_SEEN = 5.2
#: Foot of a tooth of the driver from its middle and the pitch circle [modules].
_FOOT = (1.15, 1.2)
_DRAWN = """
results = ["geometry"]
gear.a = { teeth = 21, module = "1 mm" }
gear.b = { teeth = 34, module = "1 mm" }
pair.I = { driver = "a", driven = "b" }
"""


def _svg(*parts: str) -> str:
    return (
        f'<svg class="job-picture" viewBox="0 0 {_WIDE:g} {_HIGH:g}" aria-hidden="true" focusable="false">'
        f"{''.join(parts)}</svg>"
    )


def _path(points: Array, look: str, *, closed: bool = False) -> str:
    line = "L".join(f"{x:.1f},{y:.1f}" for x, y in points.T)
    return f'<path class="{look}" d="M{line}{"Z" if closed else ""}"/>'


def _curve(x: Array, y: Array, look: str) -> str:
    """A curve over the picture; x from 0 to 1, y from 0 (below) to 1."""
    return _path(
        np.array([_ROOM + x * (_WIDE - 2.0 * _ROOM), _HIGH - _ROOM - y * (_HIGH - 2.0 * _ROOM)]), look
    )  # fmt: skip


def _axes() -> str:
    return _path(np.array([[_ROOM, _ROOM, _WIDE - _ROOM], [_ROOM, _HIGH - _ROOM, _HIGH - _ROOM]]), "axis")


@cache
def _in_mesh() -> tuple[Array, Array]:
    """Both gears about the pitch point [mm], which is in modules."""
    from fegear.case.reading import build_scene, parse_document
    from fegear.results.gear.drawing import moving_pair

    scene = build_scene(parse_document(_DRAWN, "picture"), "picture", Path())
    drawn = moving_pair(scene.pairs["I"])
    return 1e3 * drawn.driver, 1e3 * drawn.driven


def _gears(scale: float = _HIGH / _SEEN) -> str:
    made = []
    for points, look in zip(_in_mesh(), ("driver", "driven"), strict=True):
        made.append(_path(np.array([0.5 * _WIDE + points[0] * scale, 0.5 * _HIGH - points[1] * scale]), look))
    return "".join(made)


def _pair() -> str:
    c, s = math.cos(math.radians(20.0)) * 60.0, math.sin(math.radians(20.0)) * 60.0
    x, y = 0.5 * _WIDE, 0.5 * _HIGH
    return _svg(_gears(), _path(np.array([[x - c, x + c], [y + s, y - s]]), "way"))


def _relief() -> str:
    x = np.linspace(0.0, 1.0, 61)
    wave = 0.36 * np.abs(np.sin(2.0 * math.pi * x))
    return _svg(
        _axes(), _curve(x, 0.48 + wave, "driven"), _curve(x, 0.3 + 0.12 * wave, "driver"),
        _curve(np.array([0.0, 0.62, 1.0]), np.array([0.06, 0.06, 0.24]), "way"),
    )  # fmt: skip


def _stiffness() -> str:
    """One tooth of the driver, and where its root stress is largest."""
    driver, scale = _in_mesh()[0], 30.0
    land = np.abs(driver[0]) < math.pi
    middle = float(np.mean(driver[0, land & (driver[1] > driver[1, land].max() - 0.02)]))
    x, y = 0.5 * _WIDE, 0.5 * _HIGH
    tooth = driver[:, np.abs(driver[0] - middle) < x / scale]
    return _svg(_path(np.array([x + (tooth[0] - middle) * scale, y - tooth[1] * scale]), "driver"), *(
        f'<circle class="hot" cx="{x + side * _FOOT[0] * scale:.0f}" cy="{y + _FOOT[1] * scale:.0f}" r="{r}"/>'
        for side in (-1.0, 1.0) for r in (5, 9)
    ))  # fmt: skip


def _face() -> str:
    x = np.linspace(0.0, 1.0, 41)
    parts = [_curve(0.12 + 0.76 * x, 0.12 + 0.1 * k + 0.18 * x, "axis") for k in range(5)]
    load, mean = 0.28 + 0.5 * x**1.6, _curve(np.array([0.12, 0.88]), np.full(2, 0.46), "way")
    return _svg(*parts, _curve(0.12 + 0.76 * x, load, "driven"), mean)


def _gearbox() -> str:
    def box(x: float, y: float, w: float, h: float, look: str) -> str:
        return f'<rect class="{look}" x="{x:g}" y="{y:g}" width="{w:g}" height="{h:g}"/>'

    x = np.linspace(0.0, 1.0, 31)
    bent = [_curve(0.06 + 0.88 * x, at - 0.05 * np.sin(math.pi * x), "way") for at in (0.76, 0.26)]
    bearings = [box(at, y, 9, 9, "axis") for at in (30, 200) for y in (17, 37, 62, 82)]
    return _svg(box(92, 18, 22, 26, "driver"), box(92, 45, 22, 58, "driven"), *bearings, *bent)


def _train() -> str:
    x = np.linspace(0.0, 1.0, 161)
    resonances = ((0.24, 0.012, 0.4), (0.48, 0.014, 0.75), (0.8, 0.03, 0.3))
    peaks = np.sum([height / np.hypot((x - at) / wide, 1.0) for at, wide, height in resonances], axis=0)
    return _svg(_axes(), _curve(x, 0.08 + np.minimum(peaks, 0.9), "driver"))


def _planetary() -> str:
    def ring(x: float, y: float, r: float, look: str) -> str:
        return f'<circle class="{look}" cx="{x:.1f}" cy="{y:.1f}" r="{r:g}"/>'

    x, y, apart = 0.5 * _WIDE, 0.5 * _HIGH, 32.0
    around = [math.radians(90.0 + 120.0 * k) for k in range(3)]
    planets = [ring(x + apart * math.cos(a), y - apart * math.sin(a), 15, "driven") for a in around]
    carrier = _path(np.array([[x + apart * math.cos(a) for a in around], [y - apart * math.sin(a) for a in around]]),
                    "axis", closed=True)  # fmt: skip
    return _svg(ring(x, y, 48, "axis"), ring(x, y, 52, "axis"), carrier, ring(x, y, 16, "driver"), *planets)


#: Who draws the picture of each job.
PICTURES_OF_JOBS: dict[str, Callable[[], str]] = {
    "pair": _pair, "relief": _relief, "stiffness": _stiffness, "face": _face, "gearbox": _gearbox, "train": _train,
    "planetary": _planetary,
}  # fmt: skip
