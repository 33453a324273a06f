"""Strain gauges: mean over a grid by own quadrature, strain of a free surface by Hooke's law, and fitted traces."""

import math

import numpy as np
import pytest

from fegear.contact.curve_fit import NothingToCompareError, fit_curve
from fegear.contact.fitted_line import FITTED, standard_errors
from fegear.fem.plane.gauge import FilletProfile, GaugesOnFillet, Grid, grid_weights
from fegear.fem.plane.root_stress import smooth_curve
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.rack import BasicRack

#: Gauss points of 12 uneven edges.
_EDGES = np.cumsum(np.concatenate([[0.0], 0.05 + 0.02 * np.sin(np.arange(12))]))
_NODE = np.polynomial.legendre.leggauss(4)[0]
POINTS = (0.5 * (_EDGES[1:] + _EDGES[:-1])[:, None] + 0.5 * np.diff(_EDGES)[:, None] * _NODE).ravel()


def rectangle_mean(curve, middle, length, width, direction, count=4001):
    """Mean of a function of the arc over a rectangle that lies askew, strip by strip along the profile."""
    a, b = length * abs(math.cos(direction)), width * abs(math.sin(direction))
    if max(a, b) == 0.0:
        return float(curve(np.array([middle]))[0])
    u, across = ((np.arange(n) + 0.5) / n - 0.5 for n in (count, 500))
    means = [curve(middle + a * u + b * v).mean() for v in (across if b else [0.0])]
    return float(np.mean(means))


def smoothed(values):
    """The smooth curve itself, by the cubics between its points."""
    height, rise = (one @ values for one in smooth_curve(POINTS))

    def at(s):
        i = np.clip(np.searchsorted(POINTS, s) - 1, 0, POINTS.size - 2)
        h = POINTS[i + 1] - POINTS[i]
        t = (s - POINTS[i]) / h
        return (
            height[i] * (1 + 2 * t) * (1 - t) ** 2 + height[i + 1] * t**2 * (3 - 2 * t)
            + h * (rise[i] * t * (1 - t) ** 2 + rise[i + 1] * t**2 * (t - 1))
        )  # fmt: skip

    return at


@pytest.mark.parametrize(
    ("length", "width", "direction"),
    [(0.0, 0.0, 0.0), (0.2, 0.0, 0.0), (0.2, 0.3, 0.0), (0.2, 0.3, 0.4), (0.1, 0.3, 1.2), (0.25, 0.25, 0.25 * math.pi)],
)
def test_mean_under_a_grid_is_the_integral(length, width, direction):
    values = np.exp(-((POINTS - 0.3) ** 2) / 0.02) + 0.3 * np.sin(9.0 * POINTS)
    weights = grid_weights(POINTS, [0.31], Grid(length, width, direction).along)[0]
    assert weights @ values == pytest.approx(rectangle_mean(smoothed(values), 0.31, length, width, direction), abs=2e-6)
    assert weights.sum() == pytest.approx(1.0, abs=1e-12)
    assert weights @ POINTS == pytest.approx(0.31, abs=1e-12)  # of what is linear the middle counts


def test_mean_of_a_parabola_has_the_grids_second_moment():
    length, width, direction = 0.2, 0.1, 0.7
    a, b = Grid(length, width, direction).along
    weights = grid_weights(POINTS, [0.35], (a, b))[0]
    assert weights @ (POINTS - 0.35) ** 2 == pytest.approx((a**2 + b**2) / 12.0, rel=1e-9)


@pytest.mark.parametrize("plane", ["strain", "stress"])
@pytest.mark.parametrize("degrees", [0.0, 30.0, -50.0, 90.0])
def test_strain_of_a_free_surface_by_hooke(plane, degrees):
    e, nu, sigma = 200e9, 0.29, 150e6
    # strains of a surface with the normal stress sigma along the profile and, in plane strain, nu sigma along the face
    across = nu * sigma if plane == "strain" else 0.0
    strains = np.array([sigma - nu * across, across - nu * sigma]) / e
    phi = math.radians(degrees)
    wanted = strains @ [math.cos(phi) ** 2, math.sin(phi) ** 2]
    found = Grid(0.0, 0.0, phi).strain_per_stress(Material(e, nu), plane) * sigma
    assert found == pytest.approx(wanted, rel=1e-12, abs=1e-18)


@pytest.fixture(scope="module")
def solved():
    tooth = Tooth(20, BasicRack(1.0, 1.25, 0.3), 0.1)
    return solve_gear(Gear(tooth, 2e-3, 8e-3, 10e-3), MeshSettings().scaled(2.0))


def test_a_point_where_stress_is_largest_sees_that_stress(solved):
    radius = np.array([solved.gear.pitch_radius])
    for side in ("tension", "compression"):
        value, arc = solved.largest_root_stress(0, side, radius)
        gauge = GaugesOnFillet(solved, side, Grid(0.0, 0.0, 0.0), arc)
        assert gauge.stress(0, radius)[0, 0] == pytest.approx(value[0], rel=1e-9)


def test_stated_errors_cover_what_a_finer_mesh_gives(solved):
    finer = solve_gear(solved.gear, MeshSettings().scaled(0.7), estimate_error=False)
    low, high = solved.gear.involute_radii
    radius, length = np.linspace(low + 0.15 * 2e-3, high - 0.02 * 2e-3, 9), 2e-3 * solved.fine.fillets["tension"].length
    generous = []
    for side in ("tension", "compression"):
        for half in (0.0, 0.1e-3):
            grid, arc = Grid(2.0 * half, 0.0, 0.0), np.array([0.25, 0.4, 0.55, 0.7]) * length
            mine, theirs = (GaugesOnFillet(one, side, grid, arc) for one in (solved, finer))
            for k in (0, 1, -1):
                off, stated = np.abs(mine.stress(k, radius) - theirs.stress(k, radius)), mine.stress_error(k, radius)
                assert (off < stated).all(), (side, half, k)
                generous += list(np.sqrt(np.mean(stated**2, axis=1) / np.mean(off**2, axis=1)))
            assert stated.max() < 0.02 * np.abs(theirs.stress(0, radius)).max()
    assert np.median(generous) < 10.0  # 7.5; as the largest stress errs: 14


def test_places_of_the_drawn_and_the_meshed_fillet_agree(solved):
    gear, point = solved.gear, Grid(0.0, 0.0, 0.0)
    drawn = FilletProfile.of_tooth(gear.tooth, gear.module)
    meshed = FilletProfile.of_mesh(solved.fine.fillets["tension"], gear)
    for key, value in (
        ("tangent_angle", math.radians(30.0)), ("centre_angle", math.radians(6.0)), ("arc", 0.7e-3),
        ("diameter", 2.0 * gear.root_radius + 0.9e-3), ("height", 0.3e-3),
    ):  # fmt: skip
        one, other = drawn.place(key, value, point), meshed.place(key, value, point)
        assert one == pytest.approx(other, abs=2e-3 * gear.module), key
    at_tangent = drawn.place("tangent_angle", math.radians(30.0), point)
    diameter = 2.0 * drawn.at(at_tangent)["radius"]
    assert drawn.place("diameter", diameter, point) == pytest.approx(at_tangent, rel=1e-6)


def _curve():
    """A tooth's strain by hand: up, two levels, down, and its neighbours' loads beside it."""
    angle = np.linspace(-0.35, 0.4, 1500)
    return angle, 8e-4 * (
        np.exp(-((angle / 0.06) ** 2)) + 0.5 * (np.tanh((angle + 0.15) / 0.02) - np.tanh((angle - 0.18) / 0.02))
    ) - 3e-5 * np.exp(-(((angle + 0.25) / 0.05) ** 2))


@pytest.mark.parametrize(
    "fit", [FITTED, FITTED[:3], ("scale", "shift"), ("offset", "shift"), ("shift",), ("offset", "scale"), ()]
)
def test_a_trace_made_of_known_numbers_gives_these(fit):
    rng, (angle, curve), found = np.random.default_rng(7), _curve(), []
    for _ in range(40):
        known = {"offset": rng.normal(0, 1e-4), "scale": rng.uniform(0.8, 1.2), "shift": rng.uniform(-3.1, 3.1)}
        known["drift"] = rng.normal(0, 2e-4)
        known |= {key: (1.0 if key == "scale" else 0.0) for key in FITTED if key not in fit}
        at = np.arange(0.0, 4.0 * math.pi, 0.005) + (rng.uniform(0, 9) if "shift" in fit else 0.0)
        place = np.mod(at - known["shift"] + math.pi, 2.0 * math.pi) - math.pi
        strain = known["offset"] + known["scale"] * np.interp(place, angle, curve, left=0, right=0)
        strain += known["drift"] * (at - at[0]) / (2.0 * math.pi)
        made = fit_curve(at, strain + rng.normal(0.0, 1e-5, at.size), angle, curve, fit)
        if "drift" in fit:  # offsets are those half-way through the trace
            known["offset"] += known["drift"] * 0.5 * (at[-1] - at[0]) / (2.0 * math.pi)
        off = {key: getattr(made, key) - known[key] for key in FITTED}
        off["shift"] = (off["shift"] + math.pi) % (2.0 * math.pi) - math.pi
        assert made.rms * made.scale == pytest.approx(1e-5, rel=0.2)
        assert [off[key] for key in FITTED if key not in fit] == [0.0] * (len(FITTED) - len(fit))
        found.append([off[key] / made.errors[key] for key in fit])
    if fit:
        assert np.sqrt(np.mean(np.square(found), axis=0)) == pytest.approx(1.0, abs=0.35)  # of 40: 1 +- 0.11
        assert np.abs(found).max() < 4.0


def _drifting(turns, drift, noise=1e-5):
    """A trace that drifts by so much per turn, its angle from zero in each turn, and the curve."""
    angle, curve = _curve()
    at = np.arange(0.0, 2.0 * math.pi * turns, 0.004)
    place = np.mod(at - 1.3 + math.pi, 2.0 * math.pi) - math.pi
    strain = 5e-5 + drift * at / (2.0 * math.pi) + 1.1 * np.interp(place, angle, curve, left=0.0, right=0.0)
    strain += np.random.default_rng(2).normal(0.0, noise, at.size)
    return np.mod(at, 2.0 * math.pi), strain, angle, curve


@pytest.mark.parametrize(("turns", "drift"), [(5, 2e-5), (3, -2e-4), (40, 5e-5)])
def test_a_drift_is_named_and_fitted_whether_or_not_the_angle_begins_at_zero_in_each_turn(turns, drift):
    """20 um/m per turn over 5 turns are 50 um/m of offset; the largest exceeds the strain of the tooth itself."""
    at, strain, angle, curve = _drifting(turns, drift)
    fitted = fit_curve(at, strain, angle, curve, FITTED)
    assert fitted.drift == pytest.approx(drift, abs=4.0 * fitted.drift_error)
    assert fitted.drift_error < 0.02 * abs(drift)
    assert fitted.shift == pytest.approx(1.3, abs=1e-3)
    assert fitted.scale == pytest.approx(1.1, abs=4.0 * fitted.scale_error)
    assert fitted.rms * fitted.scale == pytest.approx(1e-5, rel=0.1)
    assert fitted.unfitted_drift is None
    assert fit_curve(np.unwrap(at), strain, angle, curve, FITTED).drift == pytest.approx(fitted.drift, rel=1e-9)
    assert fit_curve(-at, strain, -angle[::-1], curve[::-1], FITTED).drift == pytest.approx(fitted.drift, rel=1e-6)
    plain = fit_curve(at, strain, angle, curve, ("offset", "scale"))
    assert plain.drift == plain.drift_error == 0.0
    if abs(drift) < 1e-4:
        shifted = fit_curve(at, strain, angle, curve, FITTED[:3])
        assert shifted.unfitted_drift == pytest.approx(drift, rel=0.05)
        assert shifted.rms > 1.5 * fitted.rms


def test_no_drift_is_named_where_there_is_none_or_one_engagement():
    for noise in (1e-6, 1e-5, 1e-4):
        assert fit_curve(*_drifting(6, 0.0, noise), FITTED[:3]).unfitted_drift is None
    at, strain, angle, curve = _drifting(1, 2e-5)
    once = fit_curve(at, strain, angle, curve, FITTED[:3])
    assert once.trend is once.unfitted_drift is None
    follows = np.convolve(np.random.default_rng(4).normal(0.0, 1e-4, 9500), np.ones(60) / 60.0, "same")
    at, strain, angle, curve = _drifting(6, 0.0)
    assert fit_curve(at, strain + follows[: at.size], angle, curve, FITTED[:3]).unfitted_drift is None


def test_noise_is_what_does_not_repeat_at_the_same_place():
    """Of samples so few that the curve itself changes from one to the next: its change is no noise."""
    angle, curve = _curve()
    at = np.sort(np.random.default_rng(6).uniform(-0.3, 0.35, 60))
    clean = 1.3 * np.interp(at, angle, curve) + 2e-4
    assert fit_curve(at, clean, angle, curve, ("offset", "scale")).noise < 1e-9 * np.ptp(curve)
    noisy = clean + np.random.default_rng(8).normal(0.0, 2e-5, at.size)
    made = fit_curve(at, noisy, angle, curve, ("offset", "scale"))
    assert made.noise * made.scale == pytest.approx(2e-5, rel=0.35)


def test_noise_that_goes_together_widens_the_standard_errors():
    rng, (angle, curve), ratios = np.random.default_rng(3), _curve(), []
    at = np.arange(-0.3, 0.35, 0.0005)
    for _ in range(60):
        noise = np.convolve(rng.normal(0.0, 3e-5, at.size + 40), np.ones(41) / 41.0, "valid")
        made = fit_curve(at, 1.1 * np.interp(at, angle, curve) + noise, angle, curve, ("scale",))
        ratios.append((made.scale - 1.1) / made.errors["scale"])
    assert 0.6 < np.std(ratios) < 1.6


def test_a_trace_elsewhere_has_nothing_to_compare():
    angle, curve = _curve()
    with pytest.raises(NothingToCompareError):
        fit_curve(np.linspace(1.0, 2.0, 400), np.zeros(400), angle, curve)


def test_a_trace_upside_down_has_a_negative_gain():
    angle, curve = _curve()
    made = fit_curve(angle, -0.9 * curve + 2e-5, angle, curve, ("offset",))
    assert made.gain == pytest.approx(-0.9, rel=1e-9)
    assert made.correlation == pytest.approx(-1.0, abs=1e-9)


@pytest.mark.parametrize("count", [40, 400])
def test_standard_errors_are_those_of_linear_regression_and_grow_where_residuals_follow_each_other(count):
    """Of offset, scale and shift by the inverse of X'X, of samples that count for less by (1 - r)/(1 + r)."""
    random = np.random.default_rng(3)
    turn = 2.0 * np.pi * np.arange(count) / count
    curve, slope, scale = 30.0 + 7.0 * np.sin(turn), 7.0 * np.cos(turn), 1.3
    residual = random.standard_normal(count)
    follows = max(float(residual[1:] @ residual[:-1] / (residual @ residual)), 0.0)
    columns = {"offset": np.ones(count), "scale": curve, "shift": -scale * slope}
    for asked in (("offset",), ("scale",), ("offset", "scale"), ("offset", "scale", "shift")):
        X = np.stack([columns[one] for one in asked], axis=1)
        variance = float(residual @ residual) / (count - len(asked)) * (1.0 + follows) / (1.0 - follows)
        wanted = np.sqrt(np.diag(np.linalg.inv(X.T @ X)) * variance)
        found = standard_errors(curve, slope, scale, residual, asked)
        assert list(found) == list(asked)
        assert list(found.values()) == pytest.approx(wanted.tolist(), rel=1e-6)
    smooth = np.convolve(residual, np.ones(5) / 5.0, mode="same")
    smooth *= np.linalg.norm(residual) / np.linalg.norm(smooth)
    wider = standard_errors(curve, slope, scale, smooth, ("offset",))["offset"]
    assert wider > 1.5 * standard_errors(curve, slope, scale, residual, ("offset",))["offset"]
    assert standard_errors(curve, slope, scale, residual, ()) == {}
    assert standard_errors(curve, slope, scale, 0.0 * residual, ("offset",)) == {"offset": 0.0}
