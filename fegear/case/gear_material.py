"""``material`` of ``[gear.NAME]``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pydantic import Field, model_validator

from fegear.base.errors import shown
from fegear.case.derived import keys_of
from fegear.case.nearest import nearest
from fegear.case.part import Part, refuse, spelt_also
from fegear.geometry.gear import Material
from fegear.geometry.materials import NAMES, named_material
from fegear.geometry.plausible import refuse_material

if TYPE_CHECKING:

    class _MaterialKeys(Part, Material):  # type: ignore[misc]  # frozen by pydantic
        """Keys of the spec."""

else:
    _MaterialKeys = keys_of(Material)


class MaterialPart(_MaterialKeys):  # type: ignore[misc]  # frozen by pydantic
    """``material = { young_modulus, poisson_ratio, density }``, or the name of a material."""

    model_config = spelt_also(lambda _table: {"type": "string", "examples": ["18CrNiMo7-6", "42CrMo4"]})

    name: str | None = Field(
        default=None,
        description="Material by name (steels, POM, PA66), for keys not specified: E = 206 GPa for steel (ISO 6336-2). "
        "Plastics require poisson_ratio.",
    )

    @model_validator(mode="before")
    @classmethod
    def _by_name(cls, value: Any) -> Any:
        """Fill in the numbers of a named material."""
        given = {"name": value} if isinstance(value, str) else value
        if not isinstance(given, dict) or not isinstance(given.get("name"), str):
            return given
        name = given["name"]
        found = named_material(name)
        if found is None:
            near = nearest(name, NAMES)
            raise refuse("is not a known material", near, key="name", value=shown(name))
        numbers = {"young_modulus": f"{found.young_modulus!r} Pa", "density": f"{found.density!r} kg/m^3"}
        if found.poisson_ratio is not None:
            numbers["poisson_ratio"] = found.poisson_ratio  # type: ignore[assignment]
        elif "poisson_ratio" not in given:
            raise refuse(
                f"is required for {found.name}: the source of its modulus has none",
                f'set material = {{ name = "{found.name}", poisson_ratio = ... }} from the data sheet',
                key="poisson_ratio", value="(not given)",
            )  # fmt: skip
        return {**numbers, **given, "name": found.name}

    def build(self) -> Material:
        """Make the material."""
        made = Material(self.young_modulus, self.poisson_ratio, self.density)
        refuse_material(made.young_modulus, made.density)
        return made
