"""What every part of a case file shares: strict keys, quantities with units, and errors that name their key."""

from __future__ import annotations

import math
from importlib import import_module
from typing import TYPE_CHECKING, Annotated, Any, Self, TypeVar

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    ValidationInfo,
)
from pydantic_core import CoreSchema, PydanticCustomError
from pydantic_core.core_schema import definitions_schema, with_info_plain_validator_function

from fegear.base.errors import FegearError, InputError, shown
from fegear.base.units import as_text, to_si

if TYPE_CHECKING:
    from collections.abc import Callable


#: Key in the schema of a quantity: its dimension, from which `fegear.case.schema` says what it looks like.
QUANTITY = "fegear-quantity"


#: Key of the context of validation: whether numbers without a unit are SI (arguments of Python functions are).
BARE_SI = "bare_si"


T = TypeVar("T")


class Part(BaseModel):
    """A table of a case file: unknown keys are refused, values are not converted silently, nothing changes later."""

    model_config = ConfigDict(
        extra="forbid", strict=True, frozen=True, allow_inf_nan=False, arbitrary_types_allowed=True,
        defer_build=True,  # each part is compiled when the first case has it
    )  # fmt: skip

    @classmethod
    def read(cls, value: object, info: ValidationInfo) -> Self:
        """The table from what the case has for it."""
        return cls.model_validate(value, context=info.context)

    @property
    def given(self) -> set[str]:
        """Keys that say more than nothing: a default that is written out contradicts no other key."""
        fields = type(self).model_fields
        return {
            key for key in self.model_fields_set
            if getattr(self, key) != fields[key].get_default(call_default_factory=True, validated_data={})
        }  # fmt: skip


class Later:
    """Stands for a part whose module is read when the first case has it: most cases have few of all tables.

    Parameters
    ----------
    module, name : str
        Where the part is: ``fegear.case.sizing``, ``SizingPart``.
    """

    def __init__(self, module: str, name: str) -> None:
        self._place = module, name

    @property
    def part(self) -> type[Part]:
        """The part itself."""
        module, name = self._place
        found: type[Part] = getattr(import_module(module), name)
        return found

    def read(self, value: object, info: ValidationInfo) -> Part:
        """As of the part."""
        return self.part.read(value, info)

    def __call__(self) -> Part:
        """The table that says nothing; Python takes only what can be called for a type."""
        return self.part()


class OnDemand:
    """Marks a table whose rules are compiled when the first case has it, not with every case.

    Compiling the rules of all tables takes longer than reading a case.
    """

    def __get_pydantic_core_schema__(self, part: type[Part] | Later, _handler: GetCoreSchemaHandler) -> CoreSchema:
        """Let the table check itself; its errors come back under its key."""
        return with_info_plain_validator_function(part.read)

    def __get_pydantic_json_schema__(self, rules: Any, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """As if it were not marked: named, and stated once."""
        marked: type[Part] | Later = rules["function"]["function"].__self__
        part = marked.part if isinstance(marked, Later) else marked
        part.model_rebuild()
        named: Any = {**part.__pydantic_core_schema__, "ref": f"{part.__module__}.{part.__qualname__}:{id(part)}"}
        return handler(definitions_schema(named, []))


#: A part of the case that is compiled on demand.
Table = Annotated[T, OnDemand()]


def several(part: Any) -> BeforeValidator:
    """Let one table stand for a list of one."""

    def read(value: Any) -> Any:
        return [value] if isinstance(value, dict) else value

    return BeforeValidator(read, json_schema_input_type=part | list[part])


def refuse(rule: str, remedy: str = "", *, value: object = None, key: str = "") -> PydanticCustomError:
    """Make the error that a validator raises; `key` goes below the place where pydantic found it."""
    return PydanticCustomError("fegear", "{rule}", {"rule": rule, "remedy": remedy, "shown": value, "key": key})


def at_most(limit: int, what: str) -> AfterValidator:
    """Validator that refuses a list that asks for more than can be computed in a day or held in memory."""

    def check(values: list[T]) -> list[T]:
        refuse_more(limit, what, len(values))
        return values

    return AfterValidator(check)


def refuse_more(limit: int, what: str, *counts: int, key: str = "") -> None:
    """Refuse combinations of lists of these lengths when there are too many of them."""
    total = math.prod(counts)
    if total > limit:
        size = " x ".join(f"{n:,}" for n in counts) + (f" = {total:,}" if len(counts) > 1 else "")
        raise refuse(
            f"requests {size} {what}, above the limit", f"reduce to at most {limit:,}", value="(a list)", key=key
        )


#: Magnitudes that a machine can have, in SI. Beyond them products overflow, and no refusal after that would say why.
SMALLEST, LARGEST = 1e-30, 1e30


def plausible(number: float) -> bool:
    """Whether a value is zero or of a size that can be computed with."""
    return number == 0.0 or SMALLEST <= abs(number) <= LARGEST


def quantity(dimension: str, *, positive: bool = False, not_negative: bool = False) -> BeforeValidator:
    """Validator that reads a quantity of `dimension` into SI and checks its range."""

    def read(value: Any, info: ValidationInfo) -> float:
        try:
            value = as_text(value, dimension, bare_si=bool(info.context and info.context.get(BARE_SI)))
            number = to_si(value, dimension, "value")
        except InputError as error:
            raise refuse(error.rule, error.remedy, value=error.value) from None
        if not plausible(number):
            raise refuse(
                f"is {number:.3g} in SI units, outside the plausible range", "check the unit", value=shown(value)
            )
        if positive and number <= 0.0:
            raise refuse("must be greater than zero", value=shown(value))
        if not_negative and number < 0.0:
            raise refuse("must not be negative", value=shown(value))
        return number

    return BeforeValidator(read, json_schema_input_type=Annotated[str, Field(json_schema_extra={QUANTITY: dimension})])


def spelt_also(alternative: Callable[[dict[str, Any]], dict[str, Any]]) -> ConfigDict:
    """Configuration of a table that may be written in another way, for the schema that editors read.

    Parameters
    ----------
    alternative : callable
        ``alternative(schema)`` -> schema of the other way, from that of the table.
    """

    def extend(schema: dict[str, Any]) -> None:
        table = dict(schema)
        schema.clear()
        schema["anyOf"] = [alternative(table), table]

    return ConfigDict(json_schema_extra=extend)


def _number(value: object) -> object:
    """Let a whole number stand for a float, as TOML users write ``addendum = 1``, and refuse absurd sizes."""
    if isinstance(value, int) and not isinstance(value, bool):
        if abs(value) > LARGEST:
            raise refuse("is outside the plausible range", "check the number", value=shown(value))
        value = float(value)
    if isinstance(value, float) and math.isfinite(value) and not plausible(value):
        raise refuse("is outside the plausible range", "check the number")
    return value


Number = Annotated[float, BeforeValidator(_number)]


PositiveNumber = Annotated[float, BeforeValidator(_number), Field(gt=0.0)]


Length = Annotated[float, quantity("length")]


PositiveLength = Annotated[float, quantity("length", positive=True)]


LengthOrZero = Annotated[float, quantity("length", not_negative=True)]


Angle = Annotated[float, quantity("angle")]


Force = Annotated[float, quantity("force")]


PositiveForce = Annotated[float, quantity("force", positive=True)]


PositiveSpeed = Annotated[float, quantity("speed", positive=True)]


PositiveTorque = Annotated[float, quantity("torque", positive=True)]


PositivePower = Annotated[float, quantity("power", positive=True)]


PositiveLineLoad = Annotated[float, quantity("line_load", positive=True)]


TorqueOrZero = Annotated[float, quantity("torque", not_negative=True)]


PositiveTime = Annotated[float, quantity("time", positive=True)]


PositivePressure = Annotated[float, quantity("pressure", positive=True)]


PositiveDensity = Annotated[float, quantity("density", positive=True)]


PositiveInverseLength = Annotated[float, quantity("inverse_length", positive=True)]


InverseLength = Annotated[float, quantity("inverse_length")]


PositiveVoltage = Annotated[float, quantity("voltage", positive=True)]


PositiveMass = Annotated[float, quantity("mass", positive=True)]


PositiveInertia = Annotated[float, quantity("inertia", positive=True)]


PositiveStiffness = Annotated[float, quantity("stiffness", positive=True)]


PositiveViscosity = Annotated[float, quantity("viscosity", positive=True)]


PositiveKinematicViscosity = Annotated[float, quantity("kinematic_viscosity", positive=True)]


Temperature = Annotated[float, quantity("temperature")]


StiffnessOrZero = Annotated[float, quantity("stiffness", not_negative=True)]


TorsionalStiffnessOrZero = Annotated[float, quantity("torsional_stiffness", not_negative=True)]


def at(prefix: str, error: InputError, names: dict[str, str] | None = None) -> FegearError:
    """Return the error of a lower layer under the key that the user wrote.

    Parameters
    ----------
    prefix : str
        Where in the case the object stands (``gear.a``).
    error : InputError
    names : dict, optional
        Keys of the lower layer that have another name in case files.
    """
    return error.under(prefix, names)
