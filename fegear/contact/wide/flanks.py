"""From a spec to a pair of flanks with a width that is ready to be loaded: the effects that are on, and its gaps."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from fegear.contact.odd_flank import odd_flanks
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.lines import MissingPart
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.contact.odd_flank import OddFlank
    from fegear.contact.pair_spec import PairSpec
    from fegear.contact.wide.loaded import FlankPair
    from fegear.geometry.pair import GearPair, Member


def as_specified(spec: PairSpec, flanks: FlankPair) -> FlankPair:
    """The flanks with the effects of a spec that change more than what keeps them apart."""
    pair = spec.placed
    parts = tuple(
        part
        for member, flank in zip(MEMBERS, spec.both, strict=True)
        for _, odd in flank.odd
        for part in missing_parts(odd, pair, member)
    )
    return replace(flanks, pair=pair, coupling=spec.neighbour_coupling, hertz=spec.hertz, missing=parts)


def missing_parts(flank: OddFlank, pair: GearPair, member: Member) -> Iterator[MissingPart]:
    """Where pits of a gear's tooth lie in the plane of action."""
    gear, (lowest, highest) = pair.gear(member), pair.gear(member).involute_radii
    for pit in flank.pits:
        x = sorted(float(pair.x_of_radius(min(max(r, lowest), highest), member)) for r in (pit.low, pit.high))
        half, middle = 0.5 * pit.face_share * gear.face_width, pit.face_position - pair.face_height(member)
        yield MissingPart((x[0], x[1]), (middle - half, middle + half))


def open_gaps(spec: PairSpec) -> FlankGaps:
    """What keeps the flanks of teeth with a width apart, by the effects that are on."""
    apart, pair = FlankGaps(), spec.placed
    if spec.relief:
        driver, driven = (flank.profile(pair, member) for member, flank in zip(MEMBERS, spec.both, strict=True))
        first, second = (flank.surface(pair, member) for member, flank in zip(MEMBERS, spec.both, strict=True))
        apart = FlankGaps(driver, driven, driver_flank=(*first, *spec.face.cutter), driven_flank=second)
    if spec.misalignment:
        off = spec.face.errors
        apart = replace(
            apart, face_position=off.face_position, line_gap=off.line_gap, tilt=off.tilt, shafts=off.shafts,
            driver_flank=(*apart.driver_flank, *off.cutting),
        )  # fmt: skip
    if spec.spacing_errors:
        apart = replace(
            apart, driver_spacing=spec.driver.spacing, driven_spacing=spec.driven.spacing,
            base_pitch=spec.face.base_pitch,
        )  # fmt: skip
    first_odd, second_odd = (
        tuple(odd_flanks(flank.odd, flank.profiles if spec.relief else (), pair, member).items())
        for member, flank in zip(MEMBERS, spec.both, strict=True)
    )
    return replace(apart, driver_odd=first_odd, driven_odd=second_odd) if first_odd or second_odd else apart
