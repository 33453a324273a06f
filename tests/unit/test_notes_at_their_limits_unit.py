"""Notes begin at their limits: just inside one nothing is said, just beyond it is, whichever gear is there."""

import math
from types import SimpleNamespace

import pytest

from fegear.results.pair import flank_surface


# ---- flank-surface ---------------------------------------------------------------------------------------------------
def surface_notes(**changes):
    """Notes of a pair of which there is nothing to say but for what is changed."""
    of = {
        "contact_ratio": 1.6, "helix_angle": 0.0, "internal": False, "overlap_ratio": 0.0, "reach": (0.5, 0.5),
        "scuffing": 300.0, "film": 0.2, "why_not": "", "outside": 0.0, "wide": False, "product": 1.0, "stage": None,
        "oil": 90.0,
    } | changes  # fmt: skip
    gears = {
        member: SimpleNamespace(base_radius=10e-3, helix_angle=of["helix_angle"]) for member in ("driver", "driven")
    }
    reach = dict(zip(("driver", "driven"), of["reach"], strict=True))
    pair = SimpleNamespace(
        contact_ratio=of["contact_ratio"], driver=gears["driver"], internal=of["internal"], gear=gears.get,
        overlap_ratio=of["overlap_ratio"], x_start=-2e-3, x_end=3e-3,
        # least at the end of the path of the driven gear, at the start of that of the driver
        flank_curvature_radius=lambda x, member: 10e-3 * reach[member]
        + (x + 2e-3 if member == "driver" else 3e-3 - x),
    )  # fmt: skip
    data = SimpleNamespace(
        pair=pair, scuffing=of["scuffing"], permissible_film=of["film"], why_not=of["why_not"],
        share_outside=of["outside"], wide=of["wide"],
    )  # fmt: skip
    rated = SimpleNamespace(
        pair=pair, surface=SimpleNamespace(temperature=of["oil"]), factors=SimpleNamespace(product=of["product"])
    )
    tests = SimpleNamespace(micropitting_stage=of["stage"])
    return [str(one) for one in flank_surface._remarks("I", data, SimpleNamespace(rated=rated, tests=tests))]


@pytest.mark.parametrize(
    ("inside", "beyond", "said"),
    [
        ({"reach": (0.0201, 0.5)}, {"reach": (0.0199, 0.5)}, "close to the base circle of the driver"),
        ({"reach": (0.5, 0.0201)}, {"reach": (0.5, 0.0199)}, "close to the base circle of the driven gear"),
        ({"contact_ratio": 1.999}, {"contact_ratio": 2.0}, "defined for contact ratios below 2"),
        ({"helix_angle": 0.1, "overlap_ratio": 1.2, "contact_ratio": 2.2}, {"contact_ratio": 2.2}, "ratios below 2"),
        ({"scuffing": 90.1}, {"scuffing": 90.0}, "is not below the scuffing temperature of 90 degC"),
        ({}, {"scuffing": math.nan}, "safety factor for scuffing not computed"),
        ({}, {"film": math.nan}, "safety factor for micropitting not computed"),
        ({}, {"why_not": "no teeth."}, "no integral temperature: no teeth."),
        ({}, {"internal": True}, "applies to external gears"),
        ({}, {"outside": 0.07}, "carries up to 7.0 % of the load"),
        ({}, {"stage": 9}, "scaled with torque for lambda_GFP"),
        ({}, {"product": 1.3}, "replaces K_Halpha."),
        ({}, {"product": 1.3, "wide": True}, "replaces K_Hbeta and K_Halpha."),
        (
            {"helix_angle": 0.2, "overlap_ratio": 1.2}, {"helix_angle": 0.2, "overlap_ratio": 1.19},
            "X_Y of ISO/TS 6336-22 for overlap ratio 1.19",
        ),
        ({"overlap_ratio": 0.5}, {"helix_angle": 0.2, "overlap_ratio": 0.5}, "overlap ratio 0.5"),
    ],
)  # fmt: skip
def test_notes_on_flanks_begin_at_their_limits(inside, beyond, said):
    assert surface_notes(**inside) == []
    (note,) = surface_notes(**beyond)
    assert said in note
