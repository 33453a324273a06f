"""Numbers of other programs, kept as they gave them: `tests/other_codes/make_*.py` make them anew by hand."""

from __future__ import annotations

import json
import tomllib
from importlib.resources import files
from typing import Any

FOLDER = files("fegear.verify").joinpath("data")


def kept(name: str) -> Any:
    """What stands in ``data/<name>.json``."""
    return json.loads(FOLDER.joinpath(f"{name}.json").read_text("utf-8"))


def examples() -> dict[str, dict[str, Any]]:
    """The published ratings, ``data/<example>.toml``, by name."""
    found = {path.name.removesuffix(".toml"): path for path in FOLDER.iterdir() if path.name.endswith(".toml")}
    return {name: tomllib.loads(found[name].read_text("utf-8")) for name in sorted(found)}
