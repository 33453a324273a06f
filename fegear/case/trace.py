"""Columns of a measured trace, the same of gauges and of encoders: angle or time, torque, and what is fitted."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from pydantic import Field

from fegear.case.part import Number, Part, refuse

if TYPE_CHECKING:
    from collections.abc import Sequence


class TracePart(Part):
    """Columns of files with a trace over the rotation of a shaft, or over time at a constant speed."""

    angle: str | None = Field(default=None, description="Unit of the angle column, if its head has none.")
    angle_column: str = Field(default="angle", description="Name of the angle column.")
    reverse: bool = Field(
        default=False, description="The measured angle is counted against the direction of rotation of the shaft."
    )
    time: str | None = Field(default=None, description="Unit of the column of the time, if its head has none.")
    time_column: str = Field(
        default="time",
        description="Column of the time, of files without the angle: the rotation is that at a constant `speed`.",
    )
    torque: str | None = Field(default=None, description="Unit of the column of the torque, if its head has none.")
    torque_column: str = Field(
        default="torque",
        description="Column of the torque on the driver, if there is one: each torque of the pair takes the longest "
        "run of samples within `torque_band` (by the mean over a tooth pitch), the rest (run-up) is left out.",
    )
    torque_band: Annotated[Number, Field(gt=0.0, le=0.5)] = Field(
        default=0.05, description="Relative deviation (±) from a torque of the pair within which samples belong to it."
    )

    def check_columns(self, fit: Sequence[str], column: str, column_key: str, what: str) -> None:
        """Refuse a quantity that is fitted twice, and one column for two quantities.

        Parameters
        ----------
        fit : sequence of str
        column, column_key, what : str
            Of what was measured: its column, the key of that, and how it is called.
        """
        if len(set(fit)) < len(fit):
            raise refuse("contains a quantity twice", "specify each once", value=list(fit), key="fit")
        if self.angle_column == column:
            key = column_key if column_key in self.model_fields_set else "angle_column"
            of = "angle" if key == column_key else what
            raise refuse(f"is the column of the {of}", "specify another column", key=key)
        known = {self.angle_column: "angle", column: what}
        for key, other in (("torque_column", self.torque_column), ("time_column", self.time_column)):
            if other in known:
                raise refuse(f"is the column of the {known[other]}", "specify another column", key=key)
            known[other] = key.removesuffix("_column")
