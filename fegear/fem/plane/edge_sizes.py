"""How long the edges along a tooth's sides are: graded toward fillets, corners and the loads on the flank."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from fegear.base.arrays import Array
from fegear.fem.plane.settings import MeshSettings
from fegear.geometry.curves import Curve, arc_length
from fegear.geometry.involute_side import InvoluteSide
from fegear.geometry.tooth_side import ToothSide

Law = Callable[[Array], Array]

#: A fillet turns by up to 70 degrees however short it is: elements with fewer edges along it may turn inside out.
_FEWEST_FILLET_EDGES = 4
#: Shorter fillets [modules] are all curvature: so many edges at the default fraction of its radius, and in proportion
#: to the root of that fraction at others, so that no two levels have the same few edges and err alike.
SHORT_FILLET, _SHORT_FILLET_EDGES, _USUAL_FRACTION = 0.1, 8, 0.2
#: Edges where flank and a short fillet meet go with its length, down to this share of the usual ones.
_SHORTEST_JOINT = 0.03
#: Edges on a rounding are made to turn by no more than this where those of the flank are as short, for their whole
#: number may lengthen them.
_TURN = 0.22
#: The shortest edges on a sharp fillet, as a share of the usual ones: what keeps edges above nothing where a sharp rack
#: tip all but reaches the flank. Short edges cost little: a fillet that turns by 70 degrees takes as many of them
#: however small its radius. With a tenth, two levels missed root tension alike (a radius of .005 modules: 3 %).
_SHARPEST = 1e-3
#: Edges below a pressure that the mesh is to resolve, as a share of its half-width.
_RESOLVED = 0.35


def graded(length: float, size: Law, *, fewest: int = 1, at: Array | None = None) -> Array:
    """Arc lengths of nodes whose spacing follows `size`, from 0 to `length`, shape (n + 1,).

    Parameters
    ----------
    length : float
    size : callable
    fewest : int
        Least number of edges.
    at : ndarray, optional
        Where to sample `size`, from 0 to `length`; by default evenly, which is not enough for one that nearly vanishes.
    """
    s = np.linspace(0.0, length, 513) if at is None else at
    density = 1.0 / size(s)
    count = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(s))])
    edges = max(fewest, round(float(count[-1])))
    nodes = np.interp(np.linspace(0.0, count[-1], edges + 1), count, s)
    nodes[0], nodes[-1] = 0.0, length
    return nodes


def length_of(curve: Curve) -> float:
    """Arc length of a curve [modules]."""
    return float(arc_length(curve)[1][-1])


def land_size(tooth: ToothSide, settings: MeshSettings) -> Law:
    """Edges on the root land grow away from the fillet."""
    length = tooth.root_land_length
    first = float(fillet_size(tooth, settings)(np.zeros(1))[0])
    return lambda s: first + settings.growth * (length - s)


def fewest_edges(tooth: ToothSide, settings: MeshSettings) -> int:
    """Least number of edges along a fillet."""
    if length_of(tooth.fillet) >= SHORT_FILLET:
        return _FEWEST_FILLET_EDGES
    graded_by_level = _SHORT_FILLET_EDGES * math.sqrt(_USUAL_FRACTION / settings.root_fraction)
    return max(_FEWEST_FILLET_EDGES, round(graded_by_level))


def fillet_edges(tooth: InvoluteSide, settings: MeshSettings) -> float:
    """How many edges a fillet would have if all were as long as along most of it: those graded to its ends count less.

    Errors of root stress go with them; they are known before anything is meshed.
    """
    length = length_of(tooth.fillet)
    nodes = graded(length, front_sizes(tooth, settings)["fillet"], fewest=fewest_edges(tooth, settings))
    edges = np.diff(nodes)
    return float(edges.sum() ** 2 / (edges**2).sum())


def fillet_size(tooth: ToothSide, settings: MeshSettings) -> Law:
    """Edges on a fillet follow its curvature: their shape is quadratic, and what that misses is a notch."""
    parameter, length = arc_length(tooth.fillet)
    radius = 1.0 / np.maximum(np.abs(tooth.fillet.curvatures(parameter)), 1e-9)
    finest = _SHARPEST * settings.root_edge_length
    sizes = np.clip(settings.root_fraction * radius, finest, settings.root_edge_length)
    # No faster than edges may grow, from the sharpest place on to either side.
    grown = settings.growth * length
    upward = np.minimum.accumulate(sizes - grown) + grown
    downward = np.minimum.accumulate((sizes + grown)[::-1])[::-1] - grown
    sizes = np.minimum(upward, downward)
    return lambda s: np.interp(s, length, sizes)


def back_sizes(tooth: ToothSide, settings: MeshSettings) -> dict[str, Law]:
    """Edge lengths along the other side from its fillet to the middle of the tip land.

    Nothing is loaded there: edges grow away from the fillet, from that middle, where they are as long as the loaded
    side's, and from a rounded tip, which they must follow.
    """
    grow, longest, back = settings.growth, settings.back_edge_length, tooth.back
    flank, land = length_of(back.involute), length_of(back.outline["tip_land"])
    edge = length_of(back.tip_edge) if back.tip_edge else 0.0
    last = float(fillet_size(back, settings)(np.array([length_of(back.fillet)]))[0])
    middle = float(front_sizes(tooth, settings)["tip_land"](np.array([length_of(tooth.outline["tip_land"])]))[0])
    # a rounding that turns sharper than an edge can follow is drawn straight, as on the loaded side
    round_ = _longest_on_rounding(tooth, settings, longest)

    def size(s: Array) -> Array:
        """By the distance from the start of the flank."""
        by_ends = np.minimum(last + grow * s, middle + grow * np.abs(flank + edge + land - s))
        off_tip = np.maximum(np.maximum(flank - s, s - flank - edge), 0.0)
        return np.minimum(np.minimum(by_ends, round_ + grow * off_tip), longest)

    return {
        "flank": size,
        "tip_edge": lambda s: size(s + flank),
        "tip_land": lambda s: size(s + flank + edge),
    }


def front_sizes(
    tooth: ToothSide, settings: MeshSettings, contacts: Sequence[tuple[float, float]] = ()
) -> dict[str, Law]:
    """Edge lengths along the loaded side, from the fillet to the tooth's centre line."""
    grow, root, corner = settings.growth, fillet_size(tooth, settings), settings.tip_edge_length
    fillet, flank = length_of(tooth.fillet), length_of(tooth.involute)
    edge = length_of(tooth.tip_edge) if tooth.tip_edge else 0.0
    # Root tension is looked for down from half of a short fillet: as near to a contact at the flank's start as that.
    joint = settings.junction_edge_length * min(max(fillet / SHORT_FILLET, _SHORTEST_JOINT), 1.0)
    joint = min(joint, float(root(np.array([fillet]))[0]))
    # All orders would have a rounding of straight edges in common beside a contact at the end of the flank.
    on_edge = _longest_on_rounding(tooth, settings, 0.5 * settings.flank_edge_length)

    def flank_size(s: Array) -> Array:
        by_ends = np.minimum(joint + settings.tip_growth * s, corner + settings.tip_growth * (flank - s))
        for place, half_width in contacts:
            off = np.maximum(np.abs(s - place) - 1.2 * half_width, 0.0)
            by_ends = np.minimum(by_ends, _RESOLVED * half_width + grow * off)
        return np.minimum(settings.flank_edge_length, by_ends)

    return {
        "fillet": lambda s: np.minimum(root(s), joint + grow * (fillet - s)),
        "flank": flank_size,
        "tip_edge": lambda s: np.minimum(corner + grow * s, on_edge),
        "tip_land": lambda s: np.minimum(corner + grow * (s + edge), settings.back_edge_length),
    }


def _longest_on_rounding(tooth: ToothSide, settings: MeshSettings, longest: float) -> float:
    """Longest edge on a tip's edge [modules]: one that follows a rounding, if edges beside it are as short."""
    if tooth.tip_rounding == 0.0:
        return longest
    return min(max(_TURN * tooth.tip_rounding, settings.tip_edge_length), longest)
