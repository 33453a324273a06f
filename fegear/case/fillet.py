"""``gear.NAME.fillet``: the fillet of the teeth in place of the one that the tool generates."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.base.errors import InputError
from fegear.case.part import Length, Part, PositiveLength, refuse

if TYPE_CHECKING:
    from fegear.geometry.fillet_shapes import FilletShape
    from fegear.geometry.involute_side import InvoluteSide

#: Fewest and most points: more are of a measuring machine that should filter them.
_FEWEST_POINTS, _MOST_POINTS = 4, 5000
#: Largest scatter [modules]: ten times what a drawing that was scanned has.
_MOST_SCATTER = 0.1
#: Finds the file of a name that a case gives under a key.
FindFile = Callable[[str, str], Path]
#: Keys by the kinds that they belong to, and what they are for.
_OF_KINDS = {
    "x": (("points", "spline"), "points"),
    "y": (("points", "spline"), "points"),
    "file": (("points", "spline"), "points"),
    "frame": (("points", "spline"), "points"),
    "scatter": (("points",), "points"),
    "form_diameter": (("points", "ellipse", "arcs"), "points, ellipses and arcs"),
    "root_diameter": (("ellipse", "arcs"), "ellipses and arcs"),
    "radii": (("arcs",), "arcs"),
}


class FilletPart(Part):
    """``fillet = { kind, x, y | file, frame, scatter, form_diameter, root_diameter, radii }``."""

    kind: Literal["points", "spline", "ellipse", "arcs"] = Field(
        description="`points`: smooth curve through points; `spline`: B-spline by control points; `ellipse`: across "
        "the tooth space; `arcs`: one or two circular arcs. Tangent to flank and root circle."
    )
    x: Annotated[list[Length], Field(min_length=_FEWEST_POINTS, max_length=_MOST_POINTS)] | None = Field(
        default=None, description="Points from root circle to flank: distance from the centre line (either side)."
    )
    y: Annotated[list[Length], Field(min_length=_FEWEST_POINTS, max_length=_MOST_POINTS)] | None = Field(
        default=None, description="Distance of the points from the gear axis, along the centre line."
    )
    file: str | None = Field(
        default=None, description="CSV file of the points, columns `x [mm]` and `y [mm]`; alternatively `x` and `y`."
    )
    frame: Literal["tooth", "space"] = Field(
        default="tooth", description="Centre line of the points: of the tooth, or of the tooth space (gap)."
    )
    scatter: PositiveLength | None = Field(
        default=None,
        description="Accuracy of measured or rounded points: the curve is smoothed within this distance, at most 0.1 "
        "modules. Default: curve through all points.",
    )
    form_diameter: PositiveLength | None = Field(
        default=None,
        description="Root form diameter, where the involute starts; points beyond are ignored. Default: last point, "
        "otherwise that of the tool.",
    )
    root_diameter: PositiveLength | None = Field(
        default=None, description="Root diameter of an ellipse or of arcs. Default: that of the tool."
    )
    radii: Annotated[list[PositiveLength], Field(min_length=1, max_length=2)] | None = Field(
        default=None,
        description="Radii of the arcs from flank to root circle, one or two (two require `form_diameter`). None: "
        "one arc that starts at the form circle.",
    )

    @model_validator(mode="after")
    def _complete(self) -> Self:
        for key, (kinds, what) in _OF_KINDS.items():
            if key in self.given and self.kind not in kinds:
                raise refuse(f"applies only to fillets by {what}", f'set kind = "{kinds[0]}", or remove it', key=key)
        if self.kind in ("points", "spline"):
            self._check_points()
        if self.radii is not None:
            if len(self.radii) == 2 and self.form_diameter is None:
                raise refuse(
                    "is required for two arcs", 'set form_diameter = "57 mm", or one radius', key="form_diameter"
                )
            if len(self.radii) == 1 and self.form_diameter is not None:
                raise refuse(
                    "contradicts a single radius (one follows from the other)", "remove radii or form_diameter",
                    key="form_diameter",
                )  # fmt: skip
        return self

    def _check_points(self) -> None:
        if self.file is not None:
            if self.x is not None or self.y is not None:
                raise refuse("contradicts x and y", "specify either the file or the points", key="file")
            return
        for key in ("x", "y"):
            if getattr(self, key) is None:
                raise refuse(f"is required for a fillet by {self.kind}, or file", 'set file = "fillet.csv"', key=key)
        if len(self.x or ()) != len(self.y or ()):
            raise refuse(
                f"must have as many values as x, {len(self.x or ())}", "check the points", key="y",
                value=f"{len(self.y or ())} values",
            )  # fmt: skip

    def shape(self, module: float, find: FindFile | None) -> FilletShape | None:
        """The fillet in modules; None of a file that cannot be looked for.

        Parameters
        ----------
        module : float
            [m].
        find : callable, optional
            Finds a file of the case.

        Raises
        ------
        InputError
            If the file is no table of points.
        """
        from fegear.geometry.fillet_shapes import ArcFillet, ControlFillet, EllipseOnSpace, PointsFillet

        form = None if self.form_diameter is None else 0.5 * self.form_diameter / module
        root = None if self.root_diameter is None else 0.5 * self.root_diameter / module
        if self.kind == "ellipse":
            return EllipseOnSpace(form, root)
        if self.kind == "arcs":
            return ArcFillet(tuple(radius / module for radius in self.radii or ()), form, root)
        points = self._points(find)
        if points is None:
            return None
        places = tuple((x / module, y / module) for x, y in points)
        if self.kind == "spline":
            return ControlFillet(places, self.frame == "space")
        scatter = (self.scatter or 0.0) / module
        if scatter > _MOST_SCATTER:
            raise InputError(
                "fillet.scatter", f"{scatter * module * 1e3:.4g} mm", f"must be at most {_MOST_SCATTER:g} modules: the "
                "curve would not follow the points", "specify how far measured points scatter about the profile",
            )  # fmt: skip
        return PointsFillet(places, self.frame == "space", form, scatter)

    def _points(self, find: FindFile | None) -> list[tuple[float, float]] | None:
        if self.file is None:
            return list(zip(self.x or (), self.y or (), strict=True))
        if find is None:
            return None
        from fegear.case.csv_file import read_columns

        key = "fillet.file"
        columns = read_columns(find(self.file, key), key, {"x": "length", "y": "length"})
        if not {"x", "y"} <= set(columns):
            raise InputError(key, f'"{self.file}"', f"requires the columns x and y; it has {columns.has}")
        x, y = columns["x"].tolist(), columns["y"].tolist()
        if not _FEWEST_POINTS <= len(x) <= _MOST_POINTS:
            raise InputError(
                key, f'"{self.file}"', f"has {len(x):,} points; {_FEWEST_POINTS} to {_MOST_POINTS:,} are supported"
            )
        return list(zip(x, y, strict=True))


def with_fillets_of_case(
    tooth: InvoluteSide, module: float, find: FindFile | None, fillet: FilletPart | None, coast: FilletPart | None
) -> InvoluteSide:
    """A tooth with the fillets that a case gives; as its tool makes it where their files cannot be looked for.

    Parameters
    ----------
    tooth : InvoluteSide
    module : float
        [m].
    find : callable, optional
        Finds a file of the case.
    fillet, coast : FilletPart, optional
        Of both sides of equal flanks, or of the drive side, and of the coast side.

    Raises
    ------
    InputError
        If a file is no table of points, or the tooth cannot have a fillet.
    """
    from fegear.geometry.external_tooth import Tooth
    from fegear.geometry.internal_tooth import InternalTooth

    shape = None if fillet is None else fillet.shape(module, find)
    if isinstance(tooth, (Tooth, InternalTooth)):
        from fegear.geometry.custom_fillet_tooth import with_fillet

        return tooth if shape is None else with_fillet(tooth, shape)
    from fegear.geometry.asymmetric_fillets import with_fillets
    from fegear.geometry.asymmetric_internal_tooth import AsymmetricInternalSide
    from fegear.geometry.asymmetric_tooth import AsymmetricSide

    try:
        beside = None if coast is None else coast.shape(module, find)
    except InputError as error:
        raise InputError(f"coast_{error.key}", error.value, error.rule, error.remedy) from None
    if (shape is None and beside is None) or not isinstance(tooth, (AsymmetricSide, AsymmetricInternalSide)):
        return tooth
    return with_fillets(tooth, drive=shape, coast=beside)
