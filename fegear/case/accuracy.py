"""``[accuracy]``: a tolerance that chooses the settings, or the settings themselves."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import AfterValidator, Field

from fegear.base.given import all_given
from fegear.case.derived import keys_of
from fegear.case.part import Number, Part, refuse
from fegear.fem.plane.settings import MeshSettings


def _tolerance(value: float) -> float:
    if not 1e-6 <= value <= 0.5:
        raise refuse("must be a relative error between 1e-6 and 0.5", "1e-3 is the default", value=value)
    return value


class _Tolerance(Part):
    """What chooses the settings that a case does not give."""

    tolerance: Annotated[Number, AfterValidator(_tolerance)] = Field(
        default=1e-3,
        description="Target relative error of compliances and root stresses, 1e-6 to 0.5. The mesh is refined until "
        "the estimated error meets it; otherwise a note is issued.",
    )
    source: Literal["solve", "atlas", "auto"] = Field(
        default="solve",
        description="Teeth of plane (2D) pairs: `solve` by finite elements, `atlas` interpolated from shipped "
        "solutions (ISO 53 A to D, 12 to 400 teeth), `auto` from the atlas where its error is within the tolerance. "
        "Sweeps over gears: `auto` unless given.",
    )


#: What settings follow from where a case does not give them.
_OTHERWISE = {
    **{key: "from the tolerance" for key in all_given(MeshSettings) if key != "solver"},
    "order": "chosen from the tolerance",
    "corner_distance": "0.006",
}

if TYPE_CHECKING:

    class _Keys(_Tolerance, MeshSettings):  # type: ignore[misc]  # frozen by pydantic
        """Of the settings all but the solver may be None."""

else:
    _Keys = keys_of(MeshSettings, base=_Tolerance, first=("solver", "order"), otherwise=_OTHERWISE)


class AccuracyPart(_Keys):  # type: ignore[misc]  # frozen by pydantic
    """Relative tolerance of the results, or explicit settings with lengths in modules (see `MeshSettings`)."""
