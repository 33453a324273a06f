"""``tolerance_class`` of ``[gear.NAME]``, as a number or by name."""

from __future__ import annotations

import re
from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from fegear.base.errors import shown
from fegear.case.part import refuse

#: Classes by name: ISO 1328-1 6, DIN ISO 1328-1:2013 class 6, ANSI/AGMA ISO 1328-1-B14 A6.
_CLASS = re.compile(
    r"(?:DIN |ANSI/AGMA )?ISO ?1328(?:-1)?(?::2013|-B14)?[ ,]*(?:class|grade|quality)? ?A?(\d+)|(\d+)", re.IGNORECASE
)


def _class_of(value: Any) -> Any:
    """The number of a class of ISO 1328-1 that is given by name; those of other standards have other tolerances."""
    if not isinstance(value, str):
        return value
    found = _CLASS.fullmatch(" ".join(value.split()))
    if found is None:
        raise refuse(
            "is not a class of ISO 1328-1:2013",
            'set "ISO 1328-1 6"; tolerances of DIN 3962, DIN 58405 or AGMA Q numbers can be given as deviations',
            value=shown(value),
        )  # fmt: skip
    return int(found[1] or found[2])


ToleranceClass = Annotated[int, BeforeValidator(_class_of, json_schema_input_type=int | str), Field(ge=1, le=11)]
