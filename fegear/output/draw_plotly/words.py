"""Texts and arrays as plotly.js reads them."""

from __future__ import annotations

import base64
import html
import re
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.output.numbers import pretty_unit

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.engine.figure import Axis

Spec = dict[str, Any]


def typed(values: ArrayLike) -> Spec:
    """An array as plotly.js reads it."""
    array = np.ascontiguousarray(values, dtype="<f8")
    made: Spec = {"dtype": "f8", "bdata": base64.b64encode(array.tobytes()).decode()}
    if array.ndim > 1:
        made["shape"] = ", ".join(str(n) for n in array.shape)
    return made


def along(axis: Axis, values: ArrayLike) -> Spec | list[str | None]:
    """Places on an axis: numbers, or the names of its categories."""
    if not axis.categories:
        return typed(values)
    return [rich(axis.categories[round(v)]) if np.isfinite(v) else None for v in np.asarray(values).tolist()]


def rich(text: str) -> str:
    """Plain text for plotly, which takes names for HTML: escaped, with ``_{...}`` set lower."""
    return re.sub(r"_\{([^{}]*)\}", r"<sub>\1</sub>", html.escape(text, quote=False).replace("\n", "<br>"))


def titled(label: str, unit: str) -> str:
    """Label with its unit in brackets."""
    return rich(f"{label} [{pretty_unit(unit)}]" if unit else label)
