"""A designed fillet in the tables of a run, written into the text of a case: points of the gear's ``fillet``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.base.errors import InputError, shown
from fegear.results.relief.applied_design import Applied, gears_of_design

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from fegear.case.changed_text import Path as KeyPath
    from fegear.engine.table import Table


def applied_fillet(
    text: str, where: Path, document: Mapping[str, object], tables: Mapping[str, Table], source: str, pair: str = ""
) -> Applied:
    """Write the designed fillet of a run into the text of a case, which keeps its form and its comments.

    Parameters
    ----------
    text : str
        Of the case.
    where : Path
        Its file, for names beside it and for messages.
    document : mapping
        The case of the run.
    tables : mapping of str to Table
        Of the run.
    source : str
        What the run is called.
    pair : str
        By default that of the design.

    Raises
    ------
    InputError
        If the run has no designed fillet, or the case is of other gears.
    """
    from fegear.case.changed_text import REMARK, literal, value_at, with_values
    from fegear.case.reading import build_scene, parse_document
    from fegear.results.pair.fillet_design import fillet_member, fillet_pairs, named_gears

    run = build_scene(document, where.stem, where.parent)
    made_for = next(iter(fillet_pairs(run)), "")
    gear = named_gears(run, made_for)[fillet_member(run, made_for)] if made_for else ""
    name = f"designed_fillet_{made_for}_{gear}"
    keys = {"": "fillet", "_drive": "fillet", "_coast": "coast_fillet"}
    found = {key: tables[f"{name}{suffix}"] for suffix, key in keys.items() if f"{name}{suffix}" in tables}
    if not found:
        raise InputError("RESULTS", shown(source), "has no designed fillet", 'request the result "fillet-design"')
    if pair not in ("", made_for):
        raise InputError("--pair", shown(pair), f"has no designed fillet in {source}", f"set --pair {made_for}")
    before = build_scene(parse_document(text, f'"{where}"'), where.stem, where.parent)
    gears_of_design(before, document, made_for, where)
    changes: dict[KeyPath, str | None] = {}
    comments: dict[KeyPath, str] = {}
    for key, table in found.items():
        path: KeyPath = ("gear", gear, key)
        points = {axis: [f"{one:.9g} mm" for one in table[axis]] for axis in ("x", "y")}
        changes[path] = literal({"kind": "points", **points})
        comments[path] = f"{REMARK}: fillet, {source}, pair {made_for}"
        if isinstance(value_at(before.document, path), dict):  # a table under a head of its own makes room first
            text = with_values(text, {path: None})
    made = with_values(text, changes, comments)
    build_scene(parse_document(made, f'"{where}"'), where.stem, where.parent)
    count = " and ".join(f"{len(table['x'])}" for table in found.values())
    return Applied(made, f"fillet of {source} in {where}: gear {gear}, {count} points.")
