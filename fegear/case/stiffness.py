"""``[stiffness]``: the compliance and root-stress table of one gear."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Discriminator, Field, Tag, model_validator

from fegear.case.part import Length, Part, PositiveLength, PositiveLineLoad, at_most, refuse, refuse_more

#: Bands of a solid gear's table that are computed, and places along its face.
_MOST_BANDS, _MOST_PLACES = 4000, 200

#: Radii of such a table where the case gives none.
_USUAL_BAND_RADII = 12


def _kind(value: object) -> str:
    return "places" if isinstance(value, (list, tuple)) else "count"


#: So many, equally spaced from one end of the face to the other, or the places themselves.
FacePositions = Annotated[
    Annotated[int, Field(ge=1, le=_MOST_PLACES), Tag("count")]
    | Annotated[list[Length], Field(min_length=1), at_most(_MOST_PLACES, "face positions"), Tag("places")],
    Discriminator(_kind),
]

#: Load positions of a plane table.
_POSITIONS = 100


class StiffnessPart(Part):
    """Which gear, at which radii, under how wide a contact; with face positions as a solid, band by band."""

    gear: str | None = Field(default=None, description="Which gear the table is of; without it every gear has one.")
    radii: Annotated[list[PositiveLength], Field(min_length=1), at_most(100_000, "load positions")] | None = Field(
        default=None, description="Radii at which the flank is loaded; give these or `positions`."
    )
    positions: Annotated[int, Field(ge=2, le=100_000)] | None = Field(
        default=None,
        description="Load positions, equally spaced in roll angle over the active profile (without a pair over the "
        "whole involute). Default: 100, with `face_positions` 12.",
    )
    contact_half_width: PositiveLength | None = Field(
        default=None, description="Half-width of the contact; without it and `load` 0.02 modules."
    )
    load: PositiveLineLoad | None = Field(
        default=None,
        description="Line load from which Hertz gives the half-width, together with a pair; give this or "
        "`contact_half_width`.",
    )
    pair: str | None = Field(
        default=None, description="The pair in which the gear is loaded, where it has several; without it the first."
    )
    face_positions: FacePositions | None = Field(
        default=None,
        description="Solve the gear with its width: places along the face from its middle, or how many from end to "
        "end; without it the table is plane.",
    )
    source: Literal["solid", "slices"] = Field(
        default="solid",
        description="With `face_positions`: solid gears, or coupled slices of the plane section, cheaper and some "
        "per cent off.",
    )

    @model_validator(mode="after")
    def _one_choice(self) -> Self:
        if self.radii is not None and self.positions is not None:
            raise refuse("contradicts radii", "give either radii or positions", key="positions")
        if self.contact_half_width is not None and self.load is not None:
            raise refuse("contradicts contact_half_width", "give either of them", key="load")
        if self.face_positions is None and self.source == "slices":
            raise refuse("has no meaning for a plane gear", "give face_positions too, or remove it", key="source")
        if self.face_positions is not None:
            self._check_bands()
        return self

    def _check_bands(self) -> None:
        """Refuse what a solid table does not know, and too many bands."""
        if self.load is not None:
            remedy = "give contact_half_width, or leave face_positions out for the table of plane strain or stress"
            raise refuse("is a load per width, which the bands of a solid gear do not have", remedy, key="load")
        found = self.face_positions
        count = found if isinstance(found, int) else len(found or ())
        refuse_more(_MOST_BANDS, "bands", self.band_radii, count, key="face_positions")

    @property
    def load_positions(self) -> int:
        """How many positions a plane table has."""
        return _POSITIONS if self.positions is None else self.positions

    @property
    def band_radii(self) -> int:
        """How many radii a solid table has: twelve where the case does not say."""
        if self.radii is not None:
            return len(self.radii)
        return _USUAL_BAND_RADII if self.positions is None else self.positions
