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

    gear: str | None = Field(default=None, description="Gear. Default: all gears.")
    radii: Annotated[list[PositiveLength], Field(min_length=1), at_most(100_000, "load positions")] | None = Field(
        default=None, description="Radii of the load positions; alternatively `positions`."
    )
    positions: Annotated[int, Field(ge=2, le=100_000)] | None = Field(
        default=None,
        description="Number of load positions, equally spaced in roll angle over the active profile (without a pair: "
        "over the full involute). Default: 100, with `face_positions` 12.",
    )
    contact_half_width: PositiveLength | None = Field(
        default=None, description="Contact half-width. Default: from `load`, otherwise 0.02 modules."
    )
    load: PositiveLineLoad | None = Field(
        default=None,
        description="Line load for the Hertzian contact half-width, with a pair; alternatively `contact_half_width`.",
    )
    pair: str | None = Field(default=None, description="Pair in which the gear is loaded. Default: the first.")
    face_positions: FacePositions | None = Field(
        default=None,
        description="Face positions z from mid-face, or their number: 3D gear. Default: plane (2D) gear.",
    )
    source: Literal["solid", "slices"] = Field(
        default="solid",
        description="Model used with `face_positions`: 3D gear, or coupled slices (faster, a few per cent less "
        "accurate).",
    )

    @model_validator(mode="after")
    def _one_choice(self) -> Self:
        if self.radii is not None and self.positions is not None:
            raise refuse("contradicts radii", "specify either radii or positions", key="positions")
        if self.contact_half_width is not None and self.load is not None:
            raise refuse("contradicts contact_half_width", "specify only one of them", key="load")
        if self.face_positions is None and self.source == "slices":
            raise refuse("is not used for plane (2D) gears", "set face_positions, or remove it", key="source")
        if self.face_positions is not None:
            self._check_bands()
        return self

    def _check_bands(self) -> None:
        """Refuse what a solid table does not know, and too many bands."""
        if self.load is not None:
            remedy = "specify contact_half_width, or remove face_positions for a plane (2D) table"
            raise refuse("is a load per width and is not defined for load bands on a 3D gear", remedy, key="load")
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
