"""A design in the tables of a run, written into the text of a case: keys of both gears, by the grinding table."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.effects import RELIEF
from fegear.base.errors import InputError, shown
from fegear.base.printed import figures
from fegear.case.nearest import nearest
from fegear.results.relief.applied_left import left_by_design, without_stale_comments
from fegear.results.relief.grinding import BIAS, CROWNING, END, NOTHING, OF_FLANKS, OF_LEADS, SLOPE, TIP

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from fegear.case.changed_text import Path as KeyPath
    from fegear.case.reading import Scene
    from fegear.engine.table import Table

#: Name of the relief by theory, which a case holds as a table.
EXACT = "exact"
#: Points of it: straight lines between them stay within its own error.
_POINTS = 61
#: Grinding tables: the best design is in the first that there is.
_GRINDING = (OF_FLANKS, OF_LEADS)
#: Keys of a gear that a lead in the grinding table becomes.
_LEAD = {SLOPE: "slope", CROWNING: "crowning"}
#: Flank modifications of a gear.
MODIFIED = ("relief", "lead", "bias", "topography")
#: Decimals of an amount that is not rounded.
_ALL = 9
#: Sizes of gears are the same within this of themselves.
_SAME = 1e-6

Keys = dict[str, dict[str, Any]]


@dataclass(frozen=True)
class Applied:
    """A case with a design.

    Parameters
    ----------
    text : str
        Of the case.
    said : str
        What was written, in a sentence.
    """

    text: str
    said: str


def designs_of(tables: Mapping[str, Table], pair: str) -> list[str]:
    """Designs of a pair that can be applied, the best first."""
    ground, leads = (list(dict.fromkeys(str(row["design"]) for row in _rows(tables, of, pair))) for of in _GRINDING)
    return [*ground, *([EXACT] if any(_is_exact(name, pair) for name in tables) else []), *leads]


def _rows(tables: Mapping[str, Table], of: str, pair: str) -> list[dict[str, Any]]:
    """Rows of a grinding table of a pair; none without one."""
    table = tables.get(of + pair)
    if table is None:
        return []
    return [{column.name: column.si[n] for column in table.columns} for n in range(len(table["design"]))]


def _is_exact(name: str, pair: str) -> bool:
    return name.startswith(f"relief_{pair}_")


def keys_of_design(tables: Mapping[str, Table], pair: str, gears: tuple[str, str], design: str = "") -> Keys:
    """Flank modifications of the gears of a pair, by gear and key as plain data; a gear that has none is there, too.

    Parameters
    ----------
    tables : mapping of str to Table
        Of a run.
    pair : str
    gears : tuple of str
        Names of driver and driven gear.
    design : str
        Of the grinding table, the best by default; `EXACT` for the relief by theory.
    """
    if design == EXACT:
        return {gear: {"relief": {"table": _exact(tables[f"relief_{pair}_{gear}"])}} for gear in gears}
    rows = [row for of in _GRINDING for row in _rows(tables, of, pair)]
    chosen = design or str(rows[0]["design"])
    found: Keys = {gear: {} for gear in gears}
    rows = [row for row in rows if str(row["design"]) == chosen]
    decimals = _decimals(rows)
    for row in rows:
        kind, keys, amount = str(row["modification"]), found[str(row["gear"])], float(row["amount"])
        if abs(amount) <= NOTHING:
            continue
        if kind == TIP:
            keys["relief"] = {"tip": _tip(row, decimals)}
        elif kind in _LEAD:
            keys.setdefault("lead", {})[_LEAD[kind]] = _um(amount, decimals)
        elif kind == END:
            length = _mm(row["face_length"], decimals)
            keys.setdefault("lead", {})["end_relief"] = {"amount": _um(amount, decimals), "length": length}
        elif kind == BIAS:
            keys["bias"] = _um(amount, decimals)
    return found


def _tip(row: Mapping[str, Any], decimals: int) -> dict[str, str]:
    """Radii have a decimal more than lengths: a length on the path of contact grows by several times as much."""
    shape = str(row["shape"])
    return {
        "amount": _um(row["amount"], decimals), "start_radius": _mm(0.5 * row["start_diameter"], decimals + 1),
        "at_radius": _mm(0.5 * row["end_diameter"], decimals + 1), **({} if shape == "linear" else {"shape": shape}),
    }  # fmt: skip


def _exact(table: Table) -> dict[str, list[str]]:
    roll, removal = (np.asarray(table[name], dtype=float) for name in ("roll_angle", "relief"))
    order = np.argsort(roll)
    places = np.linspace(roll.min(), roll.max(), _POINTS)
    taken = np.interp(places, roll[order], removal[order])
    return {
        "roll_angles": [f"{one:.6g} deg" for one in places],
        "removals": [f"{one:.4g} um" for one in taken],
    }


def _decimals(rows: list[dict[str, Any]]) -> int:
    """Decimals of the amounts of a design [um]: two from 1 um on, so that rounding stays below the error of 3D pairs.

    Designs of plane pairs, whose amounts have errors of their own, keep all.
    """
    most = max((abs(float(row["amount"])) for row in rows), default=0.0)
    if most <= NOTHING or any(np.isfinite(row.get("amount_error", math.nan)) for row in rows):
        return _ALL
    return max(2, 2 - math.floor(math.log10(most * 1e6)))


def _um(value: float, decimals: int) -> str:
    return f"{round(value * 1e6, decimals):.7g} um"


def _mm(value: float, decimals: int) -> str:
    return f"{round(value * 1e3, decimals):.9g} mm"


def applied_design(
    text: str, where: Path, document: Mapping[str, object], tables: Mapping[str, Table], source: str,
    design: str = "", pair: str = "",
) -> Applied:  # fmt: skip
    """Write a design of a run into the text of a case, which keeps its form and its comments.

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
    design : str
        Name of a design of the grinding table or its beginning (``linear``); the best by default.
    pair : str
        By default the only pair with a design.

    Raises
    ------
    InputError
        If the run has no such design, or the case is of other gears.
    """
    from fegear.case.changed_text import REMARK, literal, value_at, with_values
    from fegear.case.reading import build_scene, parse_document

    pair = _pair(tables, source, pair)
    chosen = _chosen(designs_of(tables, pair), design, source)
    before = build_scene(parse_document(text, f'"{where}"'), where.stem, where.parent)
    gears = gears_of_design(before, document, pair, where)
    keys = keys_of_design(tables, pair, gears, chosen)
    of_lead = any(str(row["design"]) == chosen for row in _rows(tables, OF_LEADS, pair))
    modified = MODIFIED if any("lead" in one or "bias" in one for one in keys.values()) else ("relief",)
    if of_lead and before.case.effects.relief:  # on flanks that count: all but slope and crowning stays
        keys, modified = _leads(before, tables, pair, keys), ("lead",)
    run = build_scene(document, where.stem, where.parent)
    left = None if of_lead else left_by_design(run, tables, pair, chosen, exact=chosen == EXACT)
    of_one = f", {left.remark}" if left and left.remark else ""
    remark = f"{REMARK}: {chosen}, {source}, pair {pair}{of_one}"
    changes: dict[KeyPath, str | None] = {("effects", RELIEF.name): "true"}
    comments: dict[KeyPath, str] = {}
    for gear in keys:
        for key in modified:
            path, given = ("gear", gear, key), keys[gear].get(key)
            held = value_at(before.document, path)
            if given is None and held is not None:
                changes[path] = None
            elif given is not None:
                changes[path], comments[path] = literal(short_keys(before, gear, given)), remark
    try:
        made = with_values(text, changes, comments)
    except InputError:  # tables under heads of their own make room first
        room: dict[KeyPath, str | None] = dict.fromkeys(comments, None)
        made = with_values(with_values(text, room), changes, comments)
    if made != text:
        made = without_stale_comments(made, tuple(gear for gear in keys if keys[gear].get("relief")))
    build_scene(parse_document(made, f'"{where}"'), where.stem, where.parent)
    then = f" {left.sentence}" if left else ""
    named = "exact relief" if chosen == EXACT else chosen
    return Applied(made, f"{named} of {source} in {where}: {_in_words(keys)}.{then}")


def _leads(scene: Scene, tables: Mapping[str, Table], pair: str, keys: Keys) -> Keys:
    """Of the gears with a corrected lead: slope and crowning in place of those of the case, whose other keys stay."""
    from fegear.case.changed_text import value_at

    found: Keys = {}
    for gear in dict.fromkeys(str(row["gear"]) for row in _rows(tables, OF_LEADS, pair)):
        held = value_at(scene.document, ("gear", gear, "lead")) or {}
        other = {key: value for key, value in held.items() if key not in _LEAD.values()}
        lead = {**keys[gear].get("lead", {}), **other}
        found[gear] = {"lead": lead} if lead else {}
    return found


def short_keys(scene: Scene, gear: str, keys: Any) -> Any:
    """Without the radius at which the amount of a tip relief applies, where it is the end of the involute."""
    tip = keys.get("tip") if isinstance(keys, dict) else None
    if tip is None:
        return keys
    written = tip["at_radius"].split()[0]
    if tip["at_radius"] != _mm(scene.gears[gear].involute_tip_radius, max(len(written.partition(".")[2]), 3)):
        return keys
    return {"tip": {key: value for key, value in tip.items() if key != "at_radius"}}


def _pair(tables: Mapping[str, Table], source: str, wanted: str) -> str:
    named = [name.removeprefix(of) for of in _GRINDING for name in tables if name.startswith(of)]
    names = list(dict.fromkeys([*named, *_of_exact(tables)]))
    if not names:
        raise InputError(
            "RESULTS", shown(source), "has no relief design",
            'request the result "relief", "flank-design" (3D pairs) or "lead-correction" (pairs on shafts)',
        )  # fmt: skip
    if wanted and wanted not in names:
        raise InputError("--pair", shown(wanted), f"has no relief design in {source}", nearest(wanted, names))
    if not wanted and len(names) > 1:
        raise InputError("--pair", "(not given)", "is required with several designs", f"choose from {', '.join(names)}")
    return wanted or names[0]


def _of_exact(tables: Mapping[str, Table]) -> list[str]:
    """Pairs of whose reliefs only those by theory were designed."""
    return [name.removeprefix("relief_over_torque_") for name in tables if name.startswith("relief_over_torque_")]


def _chosen(designs: list[str], wanted: str, source: str) -> str:
    if not wanted:
        return designs[0]
    fitting = [one for one in designs if one == wanted] or [one for one in designs if one.startswith(wanted)]
    if not fitting:
        raise InputError("--relief", shown(wanted), f"is not a design of {source}", f"choose from {', '.join(designs)}")
    return fitting[0]


def gears_of_design(scene: Scene, document: Mapping[str, object], pair: str, where: Path) -> tuple[str, str]:
    """Driver and driven gear of the case, if they are those of the run."""
    from fegear.case.reading import build_scene

    part = scene.case.pair.get(pair)
    if part is None:
        raise InputError("--case", shown(str(where)), f"has no pair {pair}", "use the case of the results")
    if part.driver == part.driven:
        rule = "is also the driver; a design needs separate gears"
        raise InputError(f"pair.{pair}.driven", shown(part.driven), rule, "use a separate name for the driven gear")
    run = build_scene(document, where.stem, where.parent)
    of_run = run.case.pair[pair]
    for name, designed in ((part.driver, of_run.driver), (part.driven, of_run.driven)):
        if name != designed:
            rule = f"differs from that of the results, {shown(designed)}"
            raise InputError(f"pair.{pair}", shown(name), rule, "use the case of the results")
        now, then = (_sizes(one, name) for one in (scene, run))
        for key, value in now.items():
            if not math.isclose(value, then[key], rel_tol=_SAME, abs_tol=1e-9):
                rule = f"differs from that of the results, {then[key]:.6g}"
                raise InputError(f"gear.{name}.{key}", f"{value:.6g}", rule, "run the design for this case")
    return part.driver, part.driven


def _sizes(scene: Scene, name: str) -> dict[str, float]:
    """What a relief depends on, as a gear has it."""
    gear = scene.gears[name]
    return {
        "teeth": float(gear.teeth), "module": gear.module * 1e3, "profile_shift": gear.tooth.profile_shift,
        "helix_angle": math.degrees(gear.helix_angle), "pressure_angle": math.degrees(gear.transverse_pressure_angle),
        "tip_diameter": 2e3 * gear.involute_tip_radius,
    }  # fmt: skip


def _in_words(keys: Keys) -> str:
    """What gears were given."""
    parts = []
    for gear, given in keys.items():
        tip = given.get("relief", {}).get("tip")
        words = [f"{figures(float(tip['amount'].split()[0]))} um tip relief"] if tip else []
        words += ["relief table"] if "table" in given.get("relief", {}) else []
        words += [f"lead ({_lead_in_words(given['lead'])})"] if "lead" in given else []
        words += ["bias"] if "bias" in given else []
        parts.append(f"gear {gear} {' and '.join(words) or 'no modification'}")
    return ", ".join(parts)


def _lead_in_words(lead: Mapping[str, Any]) -> str:
    words = {"slope": "helix slope", "crowning": "crowning", "end_relief": "end relief", "file": "file"}
    return ", ".join(f"{words[key]} {lead[key]}" if key in _LEAD.values() else words[key] for key in lead)
