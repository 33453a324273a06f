"""From a spec to an engagement of plane teeth: its effects, reliefs, spacing errors, Welbourn's Delta."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.effects import RootEffects
from fegear.base.errors import InputError
from fegear.contact.plane.engagement import Engagement
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from fegear.contact.pair_spec import PairSpec


def welbourn_amount(engagement: Engagement, load: float, largest_spacing_error: float = 0.0) -> float:
    """Delta of TM-89901 after Welbourn [m]: combined tooth deflection at the HPSTC plus twice the spacing error.

    The HPSTC is the driver's: where the gears differ, so does Delta when the other one drives.

    Parameters
    ----------
    engagement : Engagement
        Its reliefs and spacing errors do not count; its contact ratio lies between 1 and 2.
    load : float
        Design load [N].
    largest_spacing_error : float
        [m].
    """
    pair = engagement.pair
    if not 1.0 <= pair.contact_ratio < 2.0:
        raise InputError(
            "relief.amount", f"contact ratio {pair.contact_ratio:.4f}", "has no highest point of single tooth contact"
        )
    perfect = Engagement(engagement.compliance)
    at = pair.x_hpstc - 1e-9 * pair.base_pitch
    return float(perfect.solve(perfect.grid([at]), [load]).transmission_error[0, 0]) + 2.0 * largest_spacing_error


def as_specified(spec: PairSpec, engagement: Engagement) -> Engagement:
    """The engagement with the effects of teeth at rest and of their roots that a spec has on."""
    compliance = replace(
        engagement.compliance, coupling=spec.neighbour_coupling, hertz=spec.hertz, roots=RootEffects.of(spec)
    )
    return replace(engagement, compliance=compliance, corner_contact=spec.corner_contact)


def spaced(spec: PairSpec, engagement: Engagement) -> Engagement:
    """The engagement with the spacing errors of its gears."""
    return replace(engagement, driver_spacing=spec.driver.spacing, driven_spacing=spec.driven.spacing)


def relieved(spec: PairSpec, engagement: Engagement) -> Engagement:
    """The engagement with the reliefs of its gears.

    Raises
    ------
    InputError
        If a relief does not fit its gear; the key is that of the gear.
    """
    pair, delta = engagement.pair, math.nan
    if any(flank.wants_delta for flank in spec.both):
        spacing = (engagement.driver_spacing, engagement.driven_spacing)
        largest = max((float(np.abs(e).max()) for e in spacing if e.size), default=0.0)
        try:
            delta = welbourn_amount(engagement, engagement.compliance.nominal_load, largest)
        except InputError as error:
            raise error.under(spec.driver.prefix, {"relief.amount": "relief.tip.amount_over_delta"}) from None
    driver, driven = (flank.profile(pair, member, delta) for member, flank in zip(MEMBERS, spec.both, strict=True))
    found = replace(engagement, driver_relief=driver, driven_relief=driven)
    if any(flank.profiles for flank in spec.both):
        from fegear.contact.odd_flank import odd_flanks  # late: few teeth are odd

        odd = (engagement.driver_odd, engagement.driven_odd)
        first, second = (
            odd_flanks(flanks.items(), flank.profiles, pair, member, delta)
            for flanks, member, flank in zip(odd, MEMBERS, spec.both, strict=True)
        )
        found = replace(found, driver_odd=first, driven_odd=second)
    return found


def with_flanks(spec: PairSpec, engagement: Engagement) -> Engagement:
    """The engagement with all that its spec says of flanks, by the effects that are on."""
    if any(flank.odd for flank in spec.both):
        engagement = replace(engagement, driver_odd=dict(spec.driver.odd), driven_odd=dict(spec.driven.odd))
    if spec.spacing_errors:
        engagement = spaced(spec, engagement)
    return relieved(spec, engagement) if spec.relief else engagement
