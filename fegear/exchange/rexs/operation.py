"""``lubricant`` and ``operation`` of a pair: oil, its temperature, application factor, life and load spectrum."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from fegear.exchange.case_tables import Key, inline, listed, number, quantity, text

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.exchange.rexs.model import Component
    from fegear.exchange.rexs.said import Said

#: Oil where a model names none: ISO VG 220.
_GRADE, _TEMPERATURE, _LIFE = 220.0, 70.0, 20_000.0 * 3600.0
#: Viscosity grades of ISO 3448 [mm^2/s at 40 degC] that a name may say.
_GRADES = (10, 15, 22, 32, 46, 68, 100, 150, 220, 320, 460, 680, 1000, 1500)
#: What ``lubricant_type_iso_6336`` says, in the words of a case.
OILS = {
    "mineral_oil": "mineral",
    "polyalfaolefin": "polyalphaolefin",
    "non_water_soluble_polyglycol": "polyglycol",
    "water_soluble_polyglycol": "water-soluble-polyglycol",
    "traction_fluid": "traction-fluid",
    "phosphate_ester": "phosphate-ester",
}


def lubricant_key(said: Said, stage: Component) -> Key:
    """The oil of a stage: its own, else that of the casing, else the one that the model has."""
    casings = said.model.of("gear_casing")
    linked = [
        oil for one in (stage, *casings) for oil in said.linked(one, "origin", "reference", "referenced", "lubricant")
    ]
    found = (linked or said.model.of("lubricant"))[:1]
    keys: dict[str, str | None] = {"viscosity_40": quantity(_GRADE * 1e-6, "mm^2/s")}
    where = f"assumed: mineral oil ISO VG {_GRADE:g}"
    for oil in found:
        named = said.word(oil, "name") or oil.name
        thick, thin = (said.number(oil, "viscosity", f"viscosity_at_{at}_degree_celsius") for at in (40, 100))
        grade = _grade(named) if not thick else None
        kind = OILS.get(said.word(oil, "lubricant_type_iso_6336_2019", "lubricant_type_iso_6336_2006") or "")
        density = said.number(oil, "density", "density_at_15_degree_celsius")
        where = f"{oil.said} {named}".strip()
        where += "" if thick else f"; ISO VG {grade:g} from its name" if grade else f"; ISO VG {_GRADE:g} assumed"
        keys["viscosity_40"] = quantity(thick or (grade or _GRADE) * 1e-6, "mm^2/s")
        keys["viscosity_100"] = quantity(thin, "mm^2/s") if thin and thick else None
        keys["density_15"] = quantity(density, "kg/m^3") if density else None
        keys["kind"] = text(kind) if kind and kind != "mineral" else None
    told = [one for one in (stage, *casings) if "temperature_lubricant" in said.attributes_of(one)]
    heat = said.number(told[0], "temperature", "temperature_lubricant") if told else None
    keys["temperature"] = quantity(_TEMPERATURE if heat is None else heat, "degC")
    warm = f"temperature_lubricant of {told[0].said}" if told else f"{_TEMPERATURE:g} degC assumed"
    return Key("lubricant", inline(**keys), f"{where}; {warm}")


def _grade(name: str) -> float | None:
    """The viscosity grade that an oil's name holds: ``ISO VG 220``, else the last number that is one."""
    marked = re.findall(r"VG[ _-]*(\d+)", name, re.IGNORECASE)
    numbers = [int(one) for one in marked or re.findall(r"(?<!\d)\d{2,4}(?!\d)", name)]
    return next((float(one) for one in reversed(numbers) if one in _GRADES), None)


def operation_key(
    said: Said, stage: Component, bins: Sequence[tuple[float, float, float]] = (), life: float | None = None,
    *, of_nominal: bool = False,
) -> Key:  # fmt: skip
    """Application factor, life and spectrum of a pair.

    Parameters
    ----------
    said : Said
    stage : Component
    bins : sequence of (float, float, float)
        Torque of the driver [N m], its speed [rad/s] and share of the time; none without a spectrum.
    life : float, optional
        That of the spectrum [s]; without it that of the gear unit.
    of_nominal : bool
        Whether bins give a part of the nominal load in place of a torque.
    """
    factor = said.number(
        stage, "number", "application_factor_iso_6336_2019", "application_factor_iso_6336_2006", "application_factor"
    )  # fmt: skip
    for unit in said.model.of("gear_unit"):
        life = life or said.number(unit, "time", "operating_time", "load_duration")
    spectrum = listed(
        inline(
            **({"load_factor": number(load)} if of_nominal else {"torque": quantity(load, "N*m", 12)}),
            speed=quantity(speed, "rpm", 12),
            share=number(share),
        )
        for load, speed, share in bins
    )
    value = inline(
        application_factor=number(1.0 if bins else factor or 1.0), life=quantity(life or _LIFE, "h"),
        spectrum=spectrum if bins else None,
    )  # fmt: skip
    about = "K_A of 1 with a spectrum" if bins else "application_factor_iso_6336" if factor else "K_A assumed"
    about += "; operating time of gear_unit" if life else "; life assumed"
    return Key("operation", value, about + ("; all load cases" if bins else ""))
