"""Variants as lines over their criteria and sizes: which choices lead to which numbers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.printed import figures
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve
from fegear.engine.figure.panel import Panel

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.engine.sheet.seen import Seen
    from fegear.results.sizing.sizing_data import SizedVariant

#: Lines of a group that are drawn at most, evenly chosen.
_MOST = 60
#: Criteria and what makes a variant: attribute, words, unit, size of the unit in SI.
_CRITERIA = {
    "transmission-error": ("te", "TE", "µm", 1e-6),
    "relieved-transmission-error": ("te_relieved", "TE relieved", "µm", 1e-6),
    "root-stress": ("root_stress", "root stress", "MPa", 1e6),
    "mass": ("mass", "mass", "kg", 1.0),
    "safety": ("margin", "load margin", "", 1.0),
    "loss": ("loss_factor", "loss factor", "", 1.0),
    "sliding": ("sliding", "sliding", "", 1.0),
    "contact-ratio": ("contact_ratio", "contact ratio", "", 1.0),
    "centre-distance": ("centre_distance", "distance", "mm", 1e-3),
}
_SIZES = (
    ("module", "module", "mm", 1e-3),
    ("teeth_1", "z_1", "", 1.0),
    ("helix_angle", "helix", "°", np.pi / 180.0),
    ("shift_1", "x_1", "", 1.0),
    ("face_width", "width", "mm", 1e-3),
)


def _values(variants: tuple[SizedVariant, ...], name: str, size: float) -> Array:
    return np.array([getattr(one, name) for one in variants], dtype=float) / size


def parallel_coordinates(seen: Seen) -> Iterator[Figure]:
    """Every variant a line over all quantities that differ, each from its minimum to its maximum."""
    data = seen.data
    rest = tuple(one for one in data.chosen if not one.place)
    groups = [("compared", "grey", rest), ("Pareto front", "blue", data.front)]
    if data.present is not None:
        groups.append(("present design", "orange", (data.present.design,)))
    everyone = tuple(one for _, _, group in groups for one in group)
    axes = []
    wanted = [_CRITERIA[name] for name in seen.asked.criteria if name in _CRITERIA]
    for name, words, unit, size in (*wanted, *_SIZES):
        values = _values(everyone, name, size)
        known = values[np.isfinite(values)]
        if known.size > 1 and np.ptp(known) > 1e-9 * np.abs(known).max():
            axes.append((name, words, unit, size, float(known.min()), float(known.max())))
    if len(data.chosen) < 2 or len(axes) < 2:
        return
    places = np.arange(len(axes), dtype=float)
    items = []
    for label, role, group in groups:
        chosen = group if len(group) <= _MOST else tuple(
            group[i] for i in np.unique(np.linspace(0, len(group) - 1, _MOST).round().astype(int))
        )  # fmt: skip
        for one in chosen:
            shares = [
                (float(_values((one,), name, size)[0]) - low) / (high - low) for name, _, _, size, low, high in axes
            ]
            note = f"variant {one.number}: {one.words}" if one.number else f"present: {one.words}"
            best = one.place == 1
            items.append(
                Curve(
                    places,
                    shares,
                    "best" if best else label,
                    "red" if best else role,
                    width=2.6 if best else 1.0,
                    markers=False,
                    notes=(note,) * len(axes),
                )
            )
    items.sort(key=lambda item: ("compared", "Pareto front", "present design", "best").index(item.name))
    ticks = tuple(
        (float(k), f"{words}{unit and ', '}{unit}\n{figures(low)} to\n{figures(high)}")
        for k, (_, words, unit, _, low, high) in enumerate(axes)
    )
    yield Figure(
        "sizing_parallel", "Variants over their criteria and sizes",
        "Every line is a variant; each quantity from its minimum (0) to its maximum (1); TE is the peak-to-peak "
        f"transmission error. At most {_MOST} lines of each kind, equally spaced. In the report, hover over a line for "
        "the variant.",
        (Panel(Axis(ticks=ticks), Axis("share of the range", limits=(-0.03, 1.03)), tuple(items)),),
    )  # fmt: skip
