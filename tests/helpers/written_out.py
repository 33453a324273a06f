"""All that a thing holds, as a text: what it shows of itself leaves most of that out."""

from collections.abc import Mapping
from dataclasses import fields, is_dataclass

import numpy as np


def written_out(value):
    """Every field, entry and digit."""
    if isinstance(value, np.ndarray):
        return f"array({written_out(value.tolist())})"
    if is_dataclass(value) and not isinstance(value, type):
        inner = (f"{one.name}={written_out(getattr(value, one.name))}" for one in fields(value) if one.repr)
        return f"{type(value).__qualname__}({', '.join(inner)})"
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{written_out(key)}: {written_out(one)}" for key, one in value.items()) + "}"
    if isinstance(value, (tuple, list)):
        return f"{type(value).__qualname__}({', '.join(map(written_out, value))})"
    return repr(value)
