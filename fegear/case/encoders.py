"""``[encoders.NAME]``: transmission error of a pair as two encoders measured it, at one torque or at several."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.case.part import Number, Part, PositiveSpeed, PositiveTorque, at_most, refuse
from fegear.case.trace import TracePart


class ErrorTracePart(Part):
    """``traces = [{ file, torque }, ...]``: one trace of both encoders at one torque."""

    file: str = Field(
        description="CSV file with the columns `angle [deg]` (rotation of `shaft`), or `time [s]` at a constant speed, "
        "and `te [um]`."
    )
    torque: PositiveTorque | None = Field(
        default=None,
        description="Torque on the driver at which it was measured, one of the pair's loads. Default: the levels of "
        "`torque_column`, where the file has it; otherwise the nominal load of the pair.",
    )


class ErrorTracesPart(Part):
    """Traces of a pair and what they are of: the first keys."""

    pair: str | None = Field(default=None, description="Pair. Default: the only pair.")
    traces: Annotated[list[ErrorTracePart], Field(min_length=1), at_most(100, "traces")] = Field(
        description="Traces, one for each torque."
    )
    shaft: Literal["driver", "driven"] = Field(
        default="driver", description="Shaft whose rotation is in the angle column."
    )
    te_at: Literal["line-of-action", "driver", "driven"] = Field(
        default="line-of-action",
        description="How the transmission error is given: as a length along the line of action, or as an angle of one "
        "of the shafts.",
    )
    positive: Literal["lag", "lead"] = Field(
        default="lag",
        description="Sign: positive where the driven gear lags behind (as computed) or where it leads (angle of the "
        "driven gear minus ideal angle).",
    )


class EncodersPart(TracePart, ErrorTracesPart):
    """Transmission error of a pair measured with encoders on both shafts."""

    te: str | None = Field(default=None, description="Unit of the column of the transmission error, if its head has "
                           "none: `um`, `arcsec`, `urad`.")  # fmt: skip
    te_column: str = Field(default="te", description="Name of the column of the transmission error.")
    mate_column: str | None = Field(
        default=None,
        description="Column of the rotation of the other shaft, in place of `te_column`: the transmission error is the "
        "difference of both angles, by the base radii. Requires `offset` in `fit`.",
    )
    speed: PositiveSpeed | None = Field(
        default=None,
        description="Constant speed of `shaft` during the traces, if they are over time; it is found from the period "
        "of the mesh within ±5 %. Default: that of the pair.",
    )
    fit: list[Literal["offset", "scale", "shift"]] = Field(
        default_factory=list,
        description="Parameters fitted by least squares: `offset` (zero of the encoders), `scale` and `shift` (zero of "
        "the angle, within one tooth pitch). Default: nothing.",
    )
    load_tolerance: Annotated[Number, Field(ge=0.0, le=1.0)] = Field(
        default=0.01, description="Relative uncertainty (±) of the torque."
    )

    @model_validator(mode="after")
    def _sensible(self) -> Self:
        self.check_columns(self.fit, self.te_column, "te_column", "transmission error")
        if self.mate_column is not None:
            self._check_mate()
        torques = [trace.torque for trace in self.traces if trace.torque is not None]
        if len(set(torques)) < len(torques):
            raise refuse("contains one torque twice", "specify one trace for each torque", key="traces")
        return self

    def _check_mate(self) -> None:
        """The angle of the other shaft gives the transmission error with its sign: nothing else describes it."""
        if self.mate_column in (self.angle_column, self.torque_column):
            other = "angle" if self.mate_column == self.angle_column else "torque"
            raise refuse(f"is the column of the {other}", "specify another column", key="mate_column")
        for key in ("te_column", "te_at", "te", "positive"):
            if key in self.model_fields_set:
                raise refuse("contradicts mate_column", "remove either", key=key)
        if "offset" not in self.fit:
            raise refuse(
                'requires "offset" with mate_column: two encoders have no common zero', 'add "offset"',
                value=list(self.fit), key="fit",
            )  # fmt: skip
