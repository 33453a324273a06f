"""``material`` of ``[gear.NAME]``."""

from __future__ import annotations

import math
from bisect import bisect_left
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any, Self

from pydantic import Field, model_validator

from fegear.base.errors import shown
from fegear.case.derived import keys_of
from fegear.case.nearest import nearest
from fegear.case.part import Part, PositivePressure, Table, Temperature, refuse, spelt_also
from fegear.geometry.gear import Material
from fegear.geometry.materials import NAMES, named_material
from fegear.geometry.plausible import refuse_material

if TYPE_CHECKING:

    class _MaterialKeys(Part, Material):  # type: ignore[misc]  # frozen by pydantic
        """Keys of the spec."""

else:
    _MaterialKeys = keys_of(Material)


#: Keys that say Young's modulus of a plastic; only one can.
_MODULI = ("young_modulus", "modulus_over_temperature", "creep_modulus")


class ModulusPart(Part):
    """``modulus_over_temperature = { temperature, modulus }``: short-term modulus as a data sheet has it."""

    temperature: Annotated[list[Temperature], Field(min_length=2, max_length=200)] = Field(
        description="Temperatures, increasing."
    )
    modulus: Annotated[list[PositivePressure], Field(min_length=2, max_length=200)] = Field(
        description="Young's modulus at each temperature."
    )

    @model_validator(mode="after")
    def _one_each(self) -> Self:
        if len(self.temperature) != len(self.modulus):
            raise refuse(
                f"has {len(self.temperature)} temperatures for {len(self.modulus)} moduli",
                "specify one modulus for each temperature", key="temperature",
            )  # fmt: skip
        if any(one >= other for one, other in pairwise(self.temperature)):
            raise refuse("must be strictly increasing", "sort the points of the data sheet", key="temperature")
        return self

    def at(self, temperature: float) -> float:
        """Modulus [Pa] at a temperature [degC] within the table: its logarithm runs straight from point to point."""
        upper = max(1, bisect_left(self.temperature, temperature))
        low, high = self.temperature[upper - 1 : upper + 1]
        share = (temperature - low) / (high - low)
        return math.exp((1.0 - share) * math.log(self.modulus[upper - 1]) + share * math.log(self.modulus[upper]))


class MaterialPart(_MaterialKeys):  # type: ignore[misc]  # frozen by pydantic
    """``material = { young_modulus, poisson_ratio, density }``, or the name of a material."""

    model_config = spelt_also(lambda _table: {"type": "string", "examples": ["18CrNiMo7-6", "42CrMo4"]})

    name: str | None = Field(
        default=None,
        description="Material by name (steels, POM, PA66), for keys not specified: E = 206 GPa for steel (ISO 6336-2). "
        "Plastics require poisson_ratio.",
    )

    temperature: Temperature | None = Field(
        default=None, description="Temperature of the teeth, at which modulus_over_temperature is read."
    )
    modulus_over_temperature: Table[ModulusPart] | None = Field(
        default=None,
        description="Short-term Young's modulus of a plastic over temperature (data sheet), in place of young_modulus.",
    )
    creep_modulus: PositivePressure | None = Field(
        default=None,
        description="Creep modulus of a plastic for duration, stress and temperature of the load (data sheet), in "
        "place of young_modulus.",
    )

    @model_validator(mode="before")
    @classmethod
    def _by_name(cls, value: Any) -> Any:
        """Fill in the numbers of a named material."""
        given = {"name": value} if isinstance(value, str) else value
        if isinstance(given, dict) and len(moduli := [key for key in _MODULI if given.get(key) is not None]) > 1:
            raise refuse(f"contradicts {moduli[0]}", "specify only one modulus", key=moduli[1])
        if not isinstance(given, dict) or not isinstance(given.get("name"), str):
            return given
        name = given["name"]
        found = named_material(name)
        if found is None:
            near = nearest(name, NAMES)
            raise refuse("is not a known material", near, key="name", value=shown(name))
        numbers = {"young_modulus": f"{found.young_modulus!r} Pa", "density": f"{found.density!r} kg/m^3"}
        if found.poisson_ratio is not None:
            numbers["poisson_ratio"] = found.poisson_ratio  # type: ignore[assignment]  # texts with units, and one number
        elif "poisson_ratio" not in given:
            raise refuse(
                f"is required for {found.name}: the source of its modulus has none",
                f'set material = {{ name = "{found.name}", poisson_ratio = ... }} from the data sheet',
                key="poisson_ratio", value="(not given)",
            )  # fmt: skip
        return {**numbers, **given, "name": found.name}

    @model_validator(mode="after")
    def _at_temperature(self) -> Self:
        table, here = self.modulus_over_temperature, self.temperature
        if (table is None) != (here is None):
            key, other = ("temperature", "modulus_over_temperature")[:: 1 if here is not None else -1]
            raise refuse(f"requires {other}", f"set {other} or remove {key}", key=key)
        if table is not None and here is not None and not table.temperature[0] <= here <= table.temperature[-1]:
            first, last = table.temperature[0], table.temperature[-1]
            raise refuse(
                f"is outside modulus_over_temperature ({first:g} to {last:g} degC)", "extend the table",
                key="temperature", value=f"{here:g} degC",
            )  # fmt: skip
        return self

    @property
    def modulus(self) -> float:
        """Young's modulus that is computed with [Pa]: at the temperature, under creep, or as it is given."""
        if self.modulus_over_temperature is not None and self.temperature is not None:
            return self.modulus_over_temperature.at(self.temperature)
        return self.young_modulus if self.creep_modulus is None else self.creep_modulus

    def build(self) -> Material:
        """Make the material."""
        made = Material(self.modulus, self.poisson_ratio, self.density)
        refuse_material(made.young_modulus, made.density)
        return made
