"""Tables that have their keys from a spec: type, unit, bounds, default, help and order, and what is not derived."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import pytest
from pydantic import Field, ValidationError

from fegear.base.given import all_given, given
from fegear.case.derived import keys_of
from fegear.case.part import Length, Part


@dataclass(frozen=True)
class Pin:
    length: float = given("length", "Length of the pin.", above=0.0)
    play: float = given("length", "Play of the pin.", default=1e-6, at_least=0.0)
    friction: float = given(meaning="Coefficient of friction.", default=0.1, at_least=0.0, at_most=0.5)
    count: int = given(meaning="Number of pins.", default=3, at_least=2)
    kind: Literal["plain", "stepped"] = given(meaning="Shape of the pin.", default="plain")
    end: float | None = given("length", "Diameter of its end.", default=None, above=0.0)
    name: str = ""


class PinPart(keys_of(Pin)):
    """A pin."""


def test_keys_are_read_with_unit_and_default_in_the_order_of_the_spec():
    assert list(PinPart.model_fields) == ["length", "play", "friction", "count", "kind", "end"]
    assert PinPart.model_validate({"length": "3 mm"}).model_dump() == {
        "length": 3e-3, "play": 1e-6, "friction": 0.1, "count": 3, "kind": "plain", "end": None,
    }  # fmt: skip
    assert PinPart.model_fields["length"].is_required()
    assert {key: field.description for key, field in PinPart.model_fields.items()} == {
        key: how.meaning for key, how in all_given(Pin).items()
    }


@pytest.mark.parametrize(
    ("key", "value", "rule"),
    [
        ("length", "0 mm", "must be greater than zero"),
        ("length", "3 N", "is not a length"),
        ("length", 3, "has no unit"),
        ("play", "-1 um", "must not be negative"),
        ("end", "0 mm", "must be greater than zero"),
        ("friction", -0.1, "greater than or equal to 0"),
        ("friction", 0.6, "less than or equal to 0.5"),
        ("count", 1, "greater than or equal to 2"),
        ("count", 2.5, "valid integer"),
        ("kind", "round", "'plain' or 'stepped'"),
        ("name", "a", "Extra inputs"),
    ],
)
def test_what_lies_outside_of_the_bounds_is_refused(key, value, rule):
    with pytest.raises(ValidationError, match=rule) as caught:
        PinPart.model_validate({"length": "3 mm", key: value})
    assert [error["loc"][0] for error in caught.value.errors()] == [key]


def test_a_key_may_follow_from_something_else():
    keys = keys_of(Pin, otherwise={"count": "from the torque"})
    assert keys.model_validate({"length": "3 mm"}).count is None
    assert keys.model_fields["count"].description == "Number of pins. Default: from the torque."
    with pytest.raises(ValidationError, match="greater than or equal to 2"):
        keys.model_validate({"length": "3 mm", "count": 1})


def test_keys_of_its_own_stand_first_and_one_that_is_written_out_keeps_its_place():
    class Own(Part):
        body: str = Field(description="Body.")

    class Written(keys_of(Pin, base=Own, first=("kind",))):
        play: Length | Literal["none"] = Field(default="none", description="Another play.")

    assert list(Written.model_fields) == ["body", "kind", "length", "play", "friction", "count", "end"]
    assert Written.model_validate({"body": "a", "length": "3 mm"}).play == "none"


def test_a_bound_of_a_quantity_that_no_reader_of_quantities_has_is_a_fault_of_the_program():
    @dataclass(frozen=True)
    class Odd:
        length: float = given("length", "Length.", at_most=1.0)

    with pytest.raises(TypeError, match="no bound but zero"):
        keys_of(Odd)
