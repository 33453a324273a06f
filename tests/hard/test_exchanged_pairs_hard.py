"""Driver and driven exchanged: the transmission error is the same function read backwards, so are all its numbers."""

import numpy as np
import pytest

import fegear
from fegear.base.errors import InputError

pytestmark = pytest.mark.last_bit

#: Pairs of the ordinary run, whose compliances are formulas, of the dear and of the long one.
ORDINARY, DEAR, LONG = 5, 40, 200
#: Relative differences that the exchange may leave.
PEAK_TO_PEAK, MEAN = 2e-5, 1e-6


def gear(draw, rack, plane):
    teeth = int(draw.integers(14, 90))
    found = {
        "teeth": teeth, "module": "2 mm", "profile_shift": float(draw.uniform(-0.25, 0.5) if teeth > 20 else 0.35),
        "rack": rack, "face_width": "12 mm", "plane": plane,
        "material": {"young_modulus": f"{draw.uniform(70.0, 215.0)} GPa",
                     "poisson_ratio": float(draw.uniform(0.25, 0.35)), "density": "7800 kg/m^3"},
    }  # fmt: skip
    if draw.random() < 0.4:
        found["relief"] = {"tip": {"amount": f"{draw.uniform(2.0, 25.0)} um", "length": f"{draw.uniform(0.3, 1.5)} mm"}}
    return found


def case(number):
    """A random pair, its effects and its load; the same for the same number."""
    draw = np.random.default_rng([20261128, number])
    addendum = float(draw.uniform(0.85, 1.2))
    rack = {"addendum": addendum, "dedendum": addendum + 0.25, "tip_radius": float(draw.uniform(0.15, 0.3))}
    plane = str(draw.choice(["strain", "stress"]))
    gears = {name: gear(draw, rack, plane) for name in ("a", "b")}
    return {
        "results": ["transmission-error"],
        "gear": gears,
        "pair": {"I": {"driver": "a", "driven": "b", "load": f"{10.0 ** draw.uniform(1.5, 4.3)} N"}},
        "effects": {
            "neighbour_coupling": bool(draw.random() < 0.7), "corner_contact": bool(draw.random() < 0.7),
            "hertz": str(draw.choice(["linear", "load-dependent"])),
            "relief": any("relief" in g for g in gears.values()),
        },
        "accuracy": {"tolerance": 5e-2},
    }  # fmt: skip


def both_ways(document, cache):
    """Values of the pair, and of the same pair driven by the other gear."""
    names = dict(document["pair"]["I"], driver="b", driven="a")
    return [fegear.run(d, progress=False, cache=cache) for d in (document, document | {"pair": {"I": names}})]


def differences(document):
    """Relative differences of peak to peak and mean, and the first one over its stated error (0 where none is)."""
    from fegear.base.solution_cache import SolutionCache

    one, other = both_ways(document, SolutionCache())
    (first, first_mean), (second, second_mean) = (
        [found.values[f"I.{name}"] for name in ("te_peak_to_peak", "te_mean")] for found in (one, other)
    )
    return (
        second.value / first.value - 1.0,
        second_mean.value / first_mean.value - 1.0,
        0.0 if first.error is None else (second.value - first.value) / min(first.error, second.error),
    )


def loaded(numbers, **compliance):
    """The cases among them that can be computed, with their differences."""
    found = {}
    for number in numbers:
        document = case(number)
        if compliance:
            document["pair"]["I"]["compliance"] = compliance
            document["effects"]["neighbour_coupling"] = False
        try:
            found[number] = differences(document)
        except InputError:  # teeth that cannot be, or a contact ratio below 1
            continue
    return found


def check(numbers, **compliance):
    found = loaded(numbers, **compliance)
    assert len(found) > 0.9 * len(numbers)
    peak_to_peak, mean, over_stated = np.abs(np.array(list(found.values()))).T
    assert peak_to_peak.max() < PEAK_TO_PEAK
    assert mean.max() < MEAN
    assert over_stated.max() < 1.0


def test_a_pair_driven_by_its_other_gear_has_the_same_transmission_error():
    check(range(ORDINARY), source="weber-banaschek")


@pytest.mark.dear
def test_forty_pairs_driven_by_their_other_gears_have_the_same_transmission_error():
    check(range(DEAR))


@pytest.mark.long
def test_two_hundred_pairs_driven_by_their_other_gears_have_the_same_transmission_error():
    check(range(LONG))


@pytest.mark.dear
def test_two_changes_of_contact_within_a_hundredth_of_the_base_pitch_are_both_found():
    """They fell into one cell of the search, which kept the first: 4.69490 and 4.69003 um, by which gear drives."""
    rack = {"addendum": 1.0514098234277616, "dedendum": 1.3195400264225676, "tip_radius": 0.2961329587754551}
    shared = {"module": "2 mm", "rack": rack, "face_width": "12.525950579641727 mm", "plane": "stress"}
    steel = {"young_modulus": "184.91274855735583 GPa", "poisson_ratio": 0.33, "density": "7000 kg/m^3"}
    soft = {"young_modulus": "83.81441017650035 GPa", "poisson_ratio": 0.311153, "density": "7000 kg/m^3"}
    peak_to_peak, mean, over_stated = differences({
        "results": ["transmission-error"],
        "gear": {
            "a": shared | {"teeth": 24, "profile_shift": -0.22901883004524093, "bore_radius": "7.5866382101682435 mm",
                           "material": steel},
            "b": shared | {"teeth": 61, "profile_shift": 0.15459427603755665, "bore_radius": "41.669847598912085 mm",
                           "material": soft},
        },
        "pair": {"I": {"driver": "a", "driven": "b", "load": "1297.2098420578116 N"}},
        "effects": {"neighbour_coupling": True, "hertz": "load-dependent", "corner_contact": True},
        "accuracy": {"tolerance": 1e-2},
    })  # fmt: skip
    assert abs(peak_to_peak) < PEAK_TO_PEAK
    assert abs(mean) < MEAN
    assert abs(over_stated) < 1.0
