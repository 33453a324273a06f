"""A variant as a case of its own: what the requirement says, with the teeth of the variant."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from fegear.base.effects import CORNER_CONTACT, HERTZ, MISALIGNMENT, NEIGHBOUR_COUPLING, RELIEF
from fegear.case.text_file import toml_string

if TYPE_CHECKING:
    from fegear.design.sizing.space import Variant

#: Names of the pair and of its gears.
PAIR, GEARS = "I", ("pinion", "wheel")
#: Keys of the requirement that a pair has under the same name, and those of its gears.
OF_PAIR = ("power", "torque", "speed", "torques", "operation", "lubricant", "shafts", "iso_6336")
OF_GEARS = ("strength", "tolerance_class", "roughness", "material")


def _mm(metres: float) -> str:
    return f"{metres * 1e3:.15g} mm"


def _gear(asked: Mapping[str, Any], variant: Variant, i: int) -> dict[str, Any]:
    strength = asked.get("wheel_strength") if i else None
    helical = variant.helix_angle != 0.0
    size: dict[str, Any] = {"normal_module" if helical else "module": _mm(variant.module)}
    if helical:
        size |= {"helix_angle": f"{math.degrees(variant.helix_angle):.15g} deg", "hand": ("right", "left")[i]}
    return {
        "teeth": variant.teeth[i],
        **size,
        "pressure_angle": f"{math.degrees(variant.pressure_angle):.15g} deg",
        "profile_shift": float(f"{variant.profile_shift[i]:.15g}"),
        "rack": {
            "addendum": float(f"{variant.addendum:.12g}"), "dedendum": float(f"{variant.dedendum:.12g}"),
            "tip_radius": variant.rack_tip_radius,
        },
        "tip_diameter": _mm(variant.tip_diameter[i]),
        "face_width": _mm(variant.face_width),
        "tolerance_class": asked.get("tolerance_class", 6),
        "strength": strength or asked["strength"],
        **{key: asked[key] for key in ("roughness", "material") if key in asked},
        **_relief(variant, i),
    }  # fmt: skip


def _relief(variant: Variant, i: int) -> dict[str, Any]:
    if variant.relief is None:
        return {}
    amount, lengths = variant.relief
    return {"relief": {"tip": {"amount": f"{amount * 1e6:.6g} um", "length": _mm(lengths[i])}}}


def case_of_variant(
    asked: Mapping[str, Any],
    variant: Variant,
    results: Sequence[str],
    *,
    width: str = "",
    tolerance: float = 0.0,
    parallelism: float = 0.0,
) -> dict[str, Any]:
    """The case of a variant as plain tables.

    Parameters
    ----------
    asked : mapping
        ``[sizing]`` of the case, as it is written or with numbers in SI.
    variant : Variant
    results : sequence of str
    width : str
        Tooth model of helical pairs, and tolerance of finite elements, where they are not the usual ones.
    tolerance : float
    parallelism : float
        Deviation of the driver's shaft over the face width [m].
    """
    helical = variant.helix_angle != 0.0
    pair: dict[str, Any] = {
        "driver": GEARS[0],
        "driven": GEARS[1],
        "centre_distance": _mm(variant.centre_distance),
        **{key: asked[key] for key in OF_PAIR if key in asked},
    }
    if helical and width:
        pair["width"] = width
    effects: dict[str, Any] = {NEIGHBOUR_COUPLING.name: True, HERTZ.name: "load-dependent"}
    if variant.relief is not None:
        effects[RELIEF.name] = True
    if parallelism:
        pair["misalignment"] = {"driver": {"out_of_plane": _mm(parallelism)}}
        effects[MISALIGNMENT.name] = True
    z, beta = variant.teeth, math.degrees(variant.helix_angle)
    return {
        "title": f"{z[0]}/{z[1]} teeth, m_n {variant.module * 1e3:.4g} mm, {beta:.4g} deg",
        "results": list(results),
        "neglected": False,
        "gear": {name: _gear(asked, variant, i) for i, name in enumerate(GEARS)},
        "pair": {PAIR: pair},
        "effects": effects if helical else {CORNER_CONTACT.name: True, **effects},
        **({"accuracy": {"tolerance": tolerance}} if tolerance else {}),
    }


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return toml_string(value)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {_value(one)}" for key, one in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(one) for one in value) + "]"
    return repr(value)


def text_of_case(document: Mapping[str, Any], remark: str) -> str:
    """A case file with a remark in front."""
    lines = [f"# {remark}"]
    lines += [f"{key} = {_value(value)}" for key, value in document.items() if not isinstance(value, Mapping)]
    for kind, table in document.items():
        if not isinstance(table, Mapping):
            continue
        named = all(isinstance(one, Mapping) for one in table.values())
        for name, keys in table.items() if named else (("", table),):
            lines += ["", f"[{kind}.{name}]" if name else f"[{kind}]"]
            lines += [f"{key} = {_value(value)}" for key, value in keys.items()]
    return "\n".join(lines) + "\n"
