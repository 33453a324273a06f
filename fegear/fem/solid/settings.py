"""Every choice that trades accuracy against time for teeth with a width, in modules.

Which solid gears make no sense or cannot be meshed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, Literal

from fegear.base.errors import InputError, RangeError
from fegear.base.printed import percent
from fegear.fem.plane.settings import MeshSettings

if TYPE_CHECKING:
    from fegear.geometry.involute_side import InvoluteSide


#: A section as coarse as its order allows: some 200 triangles.
_SECTION = MeshSettings(
    root_edge_length=0.2, root_fraction=0.7, flank_edge_length=0.3, tip_edge_length=0.1, junction_edge_length=0.1,
    back_edge_length=0.8, growth=0.6, tip_growth=0.5, side_growth=0.8, body_fraction=1.8, rim_fraction=0.45,
    order=3,
)  # fmt: skip


#: By how much the solution that shows the error is coarser.
_COARSER = 1.35


#: By how much the degree of its polynomials along the face is lower, if that leaves them cubic: degrees next to each
#: other differ by one function, odd or even, and two such solutions are alike under loads of the other kind.
_FEWER_DEGREES = 2


#: The lowest degree of its pieces of a face, and by how much it is lower than their length asks for: two below that of
#: every other set, for the same reason; and its layers through web and hub.
_LEAST_PIECE, _FEWER_ON_PIECES, _FEWEST_LAYERS = 3, 1, 2


#: How much less room its bands take beside the ends of the flank, where room alone decides how wide they are.
_OTHER_ROOM = 0.7


#: What the usual settings and the finer ones meet, and the power of the tolerance that edges go with.
_USUAL, _FINE, _ORDER = 1e-2, 3e-3, 0.33


@dataclass(frozen=True, slots=True)
class SolidSettings:
    """Edge lengths and order of the section, functions along the face, and the width of the pressed bands.

    Parameters
    ----------
    section : MeshSettings
        Of the section's mesh and the order of its elements.
    waves_per_module : float
        Degree of the polynomials along the face per module of width.
    least_degree : int
        Their lowest degree, for narrow gears.
    least_piece_degree, fewer_on_pieces : int
        Their lowest degree on each piece of a face that web, hub or the held part of a bore cut into pieces, and by how
        much it is lower than a piece's length asks for.
    body_layers : int
        Layers of elements through web and through hub at least.
    wave_reach, fewest_waves : float
        A node at the distance d from the loaded flank has wave_reach * width / (2 d) + fewest_waves functions along
        the face, at most all.
    band_half_width : float
        Half-width of the pressure that loads the flank.
    room_share : float
        Share of the room to the nearer end of the flank that it takes at most.
    source : {"solid", "slices"}
        The whole solid, or slices of its plane section that are coupled along the face (`slices`).
    """

    section: MeshSettings = field(default=_SECTION)
    waves_per_module: float = 1.5
    least_degree: int = 8
    least_piece_degree: int = 5
    fewer_on_pieces: int = 0
    body_layers: int = 3
    wave_reach: float = 2.5
    fewest_waves: float = 6.0
    band_half_width: float = 0.25
    room_share: float = 0.7
    source: Literal["solid", "slices"] = "solid"

    def __post_init__(self) -> None:
        """Refuse settings that make no mesh."""
        for f in fields(self):
            value = getattr(self, f.name)
            if f.name not in ("section", "source", "fewer_on_pieces") and not (math.isfinite(value) and value > 0.0):
                raise InputError(f"accuracy.{f.name}", value, "must be positive and finite")
        if self.room_share > 0.95:
            raise InputError("accuracy.room_share", self.room_share, "must be at most 0.95")
        if self.fewest_waves < 2.0:  # a rigid motion along the face takes two
            raise InputError("accuracy.fewest_waves", self.fewest_waves, "must be at least 2")
        if self.fewer_on_pieces < 0:
            raise InputError("accuracy.fewer_on_pieces", self.fewer_on_pieces, "must be at least 0")
        for name in ("least_degree", "least_piece_degree"):
            if getattr(self, name) < 3:
                raise InputError(f"accuracy.{name}", getattr(self, name), "must be at least 3")

    def degree(self, width: float) -> int:
        """Degree of the polynomials along a face [modules]."""
        return max(int(self.least_degree), whole(self.waves_per_module * width, up=True))

    def scaled(self, factor: float) -> SolidSettings:
        """Return a coarser (factor > 1) or finer set: everything that leaves an error changes."""
        return replace(
            self,
            section=self.section.scaled(factor),
            waves_per_module=self.waves_per_module / factor,
            least_degree=max(3, round(self.least_degree / factor)),
            wave_reach=self.wave_reach / factor,
            fewest_waves=self.fewest_waves / factor,
            band_half_width=min(self.band_half_width * math.sqrt(factor), 0.5),
        )

    def coarser(self, width: float) -> SolidSettings:
        """The set whose solution shows the error of this one's on a face [modules]: nothing that errs is the same."""
        other = SolidSettings() if self == _THIRD else self.scaled(_COARSER)
        degree = max(3, min(other.degree(width), self.degree(width) - _FEWER_DEGREES))
        return replace(
            other,
            room_share=_OTHER_ROOM * self.room_share,
            least_degree=degree,
            least_piece_degree=_LEAST_PIECE,
            fewer_on_pieces=_FEWER_ON_PIECES,
            body_layers=_FEWEST_LAYERS,
            waves_per_module=min(other.waves_per_module, degree / width),
        )


#: By how much what a count is made of may be off; no count hangs on so little.
_ROUND_OFF = 1e-9


def whole(number: float, *, up: bool = False) -> int:
    """Nearest whole number, or the next one above: round-off of a face of five modules makes no sixth part of it."""
    return math.ceil(number - _ROUND_OFF) if up else math.floor(number + 0.5 + _ROUND_OFF)


#: Elements of order 4, more functions along the face, narrower bands. Ends of a face need short waves wherever stress
#: is large: on the fillet that is compressed, far from the loaded flank, narrow faces have all functions.
_THIRD = SolidSettings(
    section=replace(_SECTION, order=4), waves_per_module=2.0, least_degree=11, wave_reach=3.0, fewest_waves=10.0,
    band_half_width=0.2,
)  # fmt: skip


def solid_settings(tolerance: float) -> SolidSettings:
    """Settings that usually meet a relative tolerance for contacts in reach of the usual part of the flank.

    Parameters
    ----------
    tolerance : float
        1e-2 takes elements of order 3, 3e-3 those of order 4; others make these finer or coarser, .1 to 1e-3 at most.
    """
    if not 1e-3 <= tolerance <= 0.1:
        raise InputError("accuracy.tolerance", tolerance, "must be between 1e-3 and 0.1 for 3D gears")
    if tolerance >= _USUAL:
        return SolidSettings() if tolerance == _USUAL else SolidSettings().scaled((tolerance / _USUAL) ** _ORDER)
    if tolerance >= _FINE:
        return _THIRD
    return _THIRD.scaled((tolerance / _FINE) ** _ORDER)


#: Widest and narrowest face that is solved [modules]: wider ones take polynomials of a degree and matrices of a size
#: beyond reason, on narrower ones no contact has room.
_WIDEST, _NARROWEST = 60.0, 0.2


#: Of a width that is a length over a module: .6 mm of 3 mm is .2 modules.
_LIMIT_ROUND_OFF = 1e-9


#: Steepest helix at the tip [rad]: the flank runs along the tooth no longer.
_STEEPEST = math.radians(60.0)


#: Highest degree along the face.
_HIGHEST_DEGREE = 100


#: The shortest part of the width on which a bore is held.
_SHORTEST_HELD = 0.02


def check_width(width: float, settings: SolidSettings) -> None:
    """Refuse face widths [modules] that are not solved.

    Raises
    ------
    RangeError
    """
    if not (1.0 - _LIMIT_ROUND_OFF) * _NARROWEST <= width <= (1.0 + _LIMIT_ROUND_OFF) * _WIDEST:
        raise RangeError(
            "face_width", f"{width:.12g} modules", f"must be between {_NARROWEST:g} and {_WIDEST:g} modules",
            "use the plane (2D) model for narrower gears; reduce wider ones to the loaded part",
        )  # fmt: skip
    if settings.degree(width) > _HIGHEST_DEGREE:
        raise RangeError(
            "face_width", f"{width:.6g} modules",
            f"requires polynomials of degree {settings.degree(width)} along it at {settings.waves_per_module:g} "
            f"waves per module (maximum {_HIGHEST_DEGREE})",
            f"reduce it to {percent(_HIGHEST_DEGREE / settings.degree(width))}, or increase the tolerance",
        )  # fmt: skip


def check_solid(
    section: InvoluteSide,
    tau: float,
    width: float,
    poisson_ratio: float,
    settings: SolidSettings,
    held: tuple[float, float] | None,
    reach: int,
) -> None:
    """Refuse widths, twists and held parts that cannot be meshed or make no sense; arguments as of `solid_influence`.

    Raises
    ------
    RangeError
    """
    check_width(width, settings)
    outer, where = (section.root_radius, "root") if section.internal else (section.tip_radius, "tip")
    if not abs(tau) <= math.tan(_STEEPEST) / outer:
        angle = math.degrees(math.atan(tau * outer)) if math.isfinite(tau) else tau
        raise RangeError(
            "helix_angle", f"{angle:.6g} deg at the {where}", f"must stay below {math.degrees(_STEEPEST):g} deg"
        )
    if not -1.0 < poisson_ratio < 0.5:
        raise RangeError("poisson_ratio", poisson_ratio, "must be between -1 and 0.5")
    if reach < 0:
        raise RangeError("reach", reach, "must be at least 0")
    if held is None:
        return
    low, high = held
    half = 0.5 * width * (1.0 + 1e-9)
    if not -half <= low < high <= half or high - low < _SHORTEST_HELD * width:
        raise RangeError(
            "held", f"({low:.6g}, {high:.6g}) modules",
            f"must be within the face width, {-0.5 * width:.6g} to {0.5 * width:.6g} modules, and at least "
            f"{100.0 * _SHORTEST_HELD:g} % of it",
        )  # fmt: skip
