"""Published numbers of ISO 6336, ``data/<example>.toml``: read, rated by fegear, compared with what is printed.

A file holds what its source prints and nothing else: conditions, ``[printed]`` factors with the digits as they stand,
and ``[judgement]``, why a factor does not fall within half a unit of its last digit.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from fegear.base.units import registry
from fegear.formulas.iso6336.conditions import Conditions, Factor, Replacement
from fegear.formulas.iso6336.pair_geometry import GearShape, PairGeometry
from fegear.formulas.iso6336.part1_face_load import Alignment
from fegear.formulas.iso6336.rated import Duty, Quality, Strength
from fegear.formulas.iso6336.safety import rate_pair

#: Printed units in SI.
UNITS = {
    "": 1.0, "N": 1.0, "m/s": 1.0, "MPa": 1e6, "mm": 1e-3, "um": 1e-6, "deg": math.radians(1.0), "rpm": math.pi / 30.0,
    "N/(mm um)": 1e9, "kg/mm": 1e3, "sqrt(MPa)": 1e3,
}  # fmt: skip


@dataclass(frozen=True)
class Row:
    """A printed number, fegear's, and what is to be said of the difference."""

    symbol: str
    clause: str
    unit: str
    printed: tuple[str, ...]
    found: tuple[float, ...]
    moved: tuple[float, ...]
    reason: str
    used: bool

    @property
    def same(self) -> bool:
        """Whether every value falls within half a unit of the last printed digit."""
        return all(abs(f - float(p)) <= (0.5 + 1e-6) * digit(p) for p, f in zip(self.printed, self.found, strict=True))

    @property
    def rounded(self) -> bool:
        """Whether the rounding of the inputs, as printed, explains what lies beyond."""
        room = ((0.5 + 1e-6) * digit(p) + m for p, m in zip(self.printed, self.moved, strict=True))
        return all(abs(f - float(p)) <= r for p, f, r in zip(self.printed, self.found, room, strict=True))


def digit(printed: str) -> float:
    """A unit of the last printed digit."""
    return float(10.0 ** -len(printed.partition(".")[2]))


def _si(value: Any) -> Any:
    return float(registry().Quantity(value).to_base_units().magnitude) if isinstance(value, str) else value


def conditions(example: dict[str, Any]) -> tuple[Conditions, Replacement]:
    """What an example's source rates, and what its program put in place of formulas."""
    shapes, strengths, qualities = [], [], []
    for gear in example["gear"]:
        g = {k: v if k == "group" else _si(v) for k, v in gear.items()}
        keys = GearShape.__dataclass_fields__.keys() & g.keys()
        shapes.append(GearShape(**{k: g[k] for k in keys}))
        strengths.append(Strength(g["group"], g["contact"], g["bending"]))
        keys = Quality.__dataclass_fields__.keys() & g.keys()
        qualities.append(Quality(**{"helix_slope": 0.0, **{k: g[k] for k in keys}}))
    e = {k: v if k in {"title", "source", "kind"} else _si(v) for k, v in example.items() if not isinstance(v, dict)}
    pair = PairGeometry(
        (shapes[0], shapes[1]), e["module"], e["pressure_angle"], e["helix_angle"], e["centre_distance"]
    )
    tangential = e["tangential"] if "tangential" in e else 2.0 * e["torque"] / pair.diameters[0]
    duty = Duty(
        tangential, e["speed"], tuple(g["cycles"] for g in example["gear"]), e["viscosity"],
        e["application_factor"], e.get("mesh_load_factor", 1.0), tuple(e.get("mean_stress", (1.0, 1.0))),
        tuple(e.get("meshes", (1, 1))),
    )  # fmt: skip
    asked = Conditions(
        pair, (strengths[0], strengths[1]), (qualities[0], qualities[1]), duty,
        Alignment(face_load_factor=e["face_load_factor"]), e["edition"],
        required=tuple(e.get("required_safety", (1.0, 1.0))),
    )  # fmt: skip
    return asked, Replacement(K_v=e.get("stress_dynamic_factor"))


def factors(example: dict[str, Any]) -> dict[str, Factor]:
    """fegear's factors of an example; K_v is its own, stresses have the one that the source took."""
    asked, given = conditions(example)
    plain = {f.symbol: f for f in rate_pair(asked).factors}
    return plain | {f.symbol: f for f in rate_pair(asked, given).factors if f.symbol != "K_v"}


def _nudged(example: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """The example with one of its rounded inputs half a unit of its last digit up."""
    for key in ("tangential", "speed", "stress_dynamic_factor"):
        if isinstance(example.get(key), str):
            yield example | {key: _up(example[key])}
    for i, gear in enumerate(example["gear"]):
        for key in ("tip_diameter", "root_diameter", "bore_diameter", "profile_shift"):
            if isinstance(gear.get(key), str):
                gears = list(example["gear"])
                gears[i] = gear | {key: _up(gear[key])}
                yield example | {"gear": gears}


def _up(text: str) -> str:
    number, _, unit = text.partition(" ")
    return f"{float(number) + 0.5 * digit(number)!r} {unit}"


def rows(example: dict[str, Any]) -> list[Row]:
    """The printed factors of an example beside fegear's, in the rating's order."""
    rated, nudged = factors(example), [factors(e) for e in _nudged(example)]
    found = []
    for symbol, factor in rated.items():
        if symbol not in example["printed"]:
            continue
        entry = example["printed"][symbol]
        texts, scale = tuple(entry["values"]), UNITS[entry.get("unit", "")]
        values = tuple(v / scale for v in factor.values[: len(texts)])
        moved = tuple(
            sum(abs(other[symbol].values[i] - factor.values[i]) for other in nudged) / scale for i in range(len(texts))
        )
        reason = example["judgement"].get(symbol, "")
        used = symbol == "sigma_H" and "stress_dynamic_factor" in example
        found.append(Row(symbol, factor.clause, entry.get("unit", ""), texts, values, moved, reason, used))
    return found


def faults(name: str, example: dict[str, Any]) -> list[str]:
    """What does not hold: numbers off without a reason, reasons without need, printed symbols that nothing answers."""
    held = rows(example)
    symbols = {row.symbol for row in held}
    wrong = [f"{name}: no result for {symbol}" for symbol in example["printed"].keys() - symbols]
    wrong += [
        f"{name}: a reason for {symbol}, which is not printed" for symbol in example["judgement"].keys() - symbols
    ]
    for row in held:
        if row.rounded == bool(row.reason):
            verb = "falls on the printed digits and has a reason" if row.rounded else "is off without a reason"
            wrong.append(f"{name}: {row.symbol} {verb}: printed {row.printed}, found {row.found}")
    return wrong
