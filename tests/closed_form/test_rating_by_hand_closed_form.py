"""S_H and S_F of both rating cases, typed anew from ISO 6336-1, -2, -3 and ISO 1328-1 in N, mm, um, 1/min.

No formula of fegear is used: K_v (method B, subcritical), K_Hbeta (method C), K_Halpha (method B), Z and Y factors of
case-hardened steel.
The numbers of the cases are typed too, so that reading them is checked with the rest.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from math import acos, asin, atan, cos, hypot, log, pi, radians, sin, sqrt, tan
from pathlib import Path

import pytest

from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import read_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

CASES = Path(__file__).parents[2] / "cases"


@dataclass
class Drive:
    """What the case file says, in N, mm, um and 1/min."""

    z: tuple[int, int]
    m: float
    beta: float
    x: tuple[float, float]
    a: float | None
    tips: tuple[float, float] | None
    b: tuple[float, float]
    dedendum: float
    rho: float
    torque: float  # N m
    n: float
    hours: float
    grade: int
    rz_flank: float
    rz_root: float
    nu: float
    shaft: tuple[float, float, float, float]  # l, s, d_sh, K'
    relief: float
    flim: float


SPUR = Drive(
    (21, 62), 4.0, 0.0, (0.35, 0.12), None, None, (42.0, 40.0), 1.25, 0.38, 520.0, 1480.0, 20000.0, 6, 4.8, 16.0, 220.0,
    (140.0, 15.0, 50.0, 0.48), 0.0, 500.0,
)  # fmt: skip
HELICAL = Drive(
    (17, 103), 8.0, radians(15.8), (0.145, 0.0), 500.0, (159.66, 872.35), (100.0, 100.0), 1.4, 0.39, 9000.0, 360.0,
    50000.0, 5, 6.0, 20.0, 320.0, (240.0, 0.0, 120.0, 0.48), 70.0, 500.0,
)  # fmt: skip
YOUNG, POISSON, RHO, ALPHA = 206.8e3, 0.3, 7.85e-6, radians(20.0)


def stepped(value: float) -> float:
    """ISO 1328-1, 5.2.3."""
    step = 1.0 if value > 10.0 else 0.5 if value > 5.0 else 0.1
    return math.floor(value / step + 0.5) * step


def life(cycles: float, knee: float) -> float:
    """Z_NT or Y_NT beyond the knee, .85 at 1e10."""
    return 0.85 ** (log(min(cycles, 1e10) / knee) / log(1e10 / knee))


def rated(g: Drive):
    z1, z2 = g.z
    at = atan(tan(ALPHA) / cos(g.beta))
    bb = asin(sin(g.beta) * cos(ALPHA))
    d = [z * g.m / cos(g.beta) for z in g.z]
    db = [one * cos(at) for one in d]
    if g.a is None:
        target = tan(at) - at + 2.0 * sum(g.x) / (z1 + z2) * tan(ALPHA)
        awt = at
        for _ in range(50):
            awt -= (tan(awt) - awt - target) / tan(awt) ** 2
    else:
        awt = acos(0.5 * sum(db) / g.a)
    a = 0.5 * sum(db) / cos(awt)
    da = list(g.tips) if g.tips else [one + 2.0 * (1.0 + x) * g.m for one, x in zip(d, g.x, strict=True)]
    df = [one - 2.0 * (g.dedendum - x) * g.m for one, x in zip(d, g.x, strict=True)]
    b, u = min(g.b), z2 / z1
    reach = [0.5 * sqrt(one**2 - two**2) for one, two in zip(da, db, strict=True)]
    ea = (sum(reach) - a * sin(awt)) / (pi * db[0] / z1)
    eb = b * sin(g.beta) / (pi * g.m)
    eg = ea + eb
    ft = 2000.0 * g.torque / d[0]
    v = pi * d[0] * g.n / 60000.0
    # ISO 1328-1:2013
    step = sqrt(2.0) ** (g.grade - 5)
    f_pb, f_fa, f_hb = [], [], []
    for one, width in zip(d, g.b, strict=True):
        f_pb.append(stepped((0.001 * one + 0.4 * g.m + 5.0) * step) * cos(at))
        f_fa.append(stepped((0.55 * g.m + 5.0) * step))
        f_hb.append(stepped((0.05 * sqrt(one) + 0.35 * sqrt(width) + 4.0) * step))
    pitch, form = max(f_pb), max(f_fa)
    # stiffness, ISO 6336-1, 9.3
    zn = [z / (cos(bb) ** 2 * cos(g.beta)) for z in g.z]
    x1, x2 = g.x
    q = (
        0.04723 + 0.15551 / zn[0] + 0.25791 / zn[1] - 0.00635 * x1 - 0.11654 * x1 / zn[0] - 0.00193 * x2
        - 0.24188 * x2 / zn[1] + 0.00529 * x1**2 + 0.00182 * x2**2
    )  # fmt: skip
    c = 0.8 * (1.0 + 0.5 * (1.2 - g.dedendum)) * cos(g.beta) * YOUNG / 206e3 / q
    ca = c * (0.75 * ea + 0.25)
    cb = 0.85 * ca
    # K_v, method B below resonance
    dm = [0.5 * (one + two) for one, two in zip(da, df, strict=True)]
    bores = [0.5 * one for one in df]  # fegear holds gears without a bore at half the root radius
    inertia = [pi / 32.0 * RHO * (m**4 - i**4) for i, m in zip(bores, dm, strict=True)]
    one, two = (j / (0.5 * d_b) ** 2 for j, d_b in zip(inertia, db, strict=True))
    m_red = one * two / (one + two)
    n_e = 30000.0 / (pi * z1) * sqrt(ca / m_red)
    ratio = g.n / n_e
    assert ratio < 0.85
    y_p, y_f = min(0.075 * pitch, 3.0), min(0.075 * form, 3.0)
    c_a = g.relief or (1500.0 / 97.0 - 18.45) ** 2 / 18.0 + 1.5
    w = ft / b
    b_k = 1.0 if g.grade >= 6 else abs(1.0 - c * c_a / w)
    cv = (0.32, 0.34, 0.23) if eg <= 2.0 else (0.32, 0.57 / (eg - 0.3), 0.096 / (eg - 1.56))
    k_v = 1.0 + ratio * (cv[0] * c * (pitch - y_p) / w + cv[1] * c * (form - y_f) / w + cv[2] * b_k)
    # K_Hbeta, method C
    fm = w * k_v
    span, s, d_sh, k = g.shaft
    f_sh = fm * 0.023 * (abs(1.0 + k * span * s / d[0] ** 2 * (d[0] / d_sh) ** 4 - 0.3) + 0.3) * (b / d[0]) ** 2
    fx = max(1.33 * f_sh + hypot(*f_hb), 0.005 * fm, 0.5 * max(f_hb))
    fy = fx - min(0.15 * fx, 6.0)
    r = fy * cb / (2.0 * fm)
    k_hb = 1.0 + r if r <= 1.0 else 2.0 * sqrt(r)
    flat = 1.0 / max(min(width / (0.5 * (one - two)) for width, one, two in zip(g.b, da, df, strict=True)), 3.0)
    k_fb = k_hb ** (1.0 / (1.0 + flat + flat**2))
    # K_Halpha, method B
    z_eps = sqrt((4.0 - ea) / 3.0) if eb == 0.0 else sqrt(1.0 / ea)
    error = max(pitch, form)
    error -= min(0.075 * error, 3.0)
    worst = ca * error / (fm * k_hb)
    k_ha = 0.5 * eg * (0.9 + 0.4 * worst) if eg <= 2.0 else 0.9 + 0.4 * sqrt(2.0 * (eg - 1.0) / eg) * worst
    k_ha = min(max(k_ha, 1.0), eg / (ea * z_eps**2))
    ean = ea / cos(bb) ** 2
    k_fa = k_ha  # both limits lie higher
    # contact
    z_h = sqrt(2.0 * cos(bb) * cos(awt) / (cos(at) ** 2 * sin(awt)))
    z_e = sqrt(YOUNG / (2.0 * pi * (1.0 - POISSON**2)))
    h0 = z_h * z_e * z_eps / sqrt(cos(g.beta)) * sqrt(ft / (d[0] * b) * (u + 1.0) / u)
    t = [sqrt((one / two) ** 2 - 1.0) for one, two in zip(da, db, strict=True)]
    m1 = tan(awt) / sqrt((t[0] - 2.0 * pi / z1) * (t[1] - (ea - 1.0) * 2.0 * pi / z2))
    m2 = tan(awt) / sqrt((t[1] - 2.0 * pi / z2) * (t[0] - (ea - 1.0) * 2.0 * pi / z1))
    z_bd = [max(1.0, m1), max(1.0, m2)] if eb == 0.0 else [sqrt(1.07)] * 2  # 2019: tips relieved by experience
    sigma_h = [one * h0 * sqrt(k_v * k_hb * k_ha) for one in z_bd]
    rho_red = 0.5 * db[0] * tan(awt) * 0.5 * db[1] * tan(awt) / (a * sin(awt))
    z_l = 0.91 + 4.0 * 0.09 / (1.2 + 134.0 / g.nu) ** 2
    z_v = 0.93 + 2.0 * 0.07 / sqrt(0.8 + 32.0 / v)
    z_r = (3.0 / (g.rz_flank * (10.0 / rho_red) ** (1.0 / 3.0))) ** 0.08
    cycles = [60.0 * g.n * g.hours, 60.0 * g.n * g.hours / u]
    s_h = [1500.0 * life(n, 5e7) * z_l * z_v * z_r / one for n, one in zip(cycles, sigma_h, strict=True)]
    # root
    s_f = []
    for i in (0, 1):
        x, z = g.x[i], zn[i]
        e = pi / 4.0 - g.dedendum * tan(ALPHA) - (1.0 - sin(ALPHA)) * g.rho / cos(ALPHA)
        gg = g.rho - g.dedendum + x
        h = 2.0 / z * (pi / 2.0 - e) - pi / 3.0
        theta = pi / 6.0
        for _ in range(200):
            theta = 2.0 * gg / z * tan(theta) - h
        s_fn = z * sin(pi / 3.0 - theta) + sqrt(3.0) * (gg / cos(theta) - g.rho)
        rho_f = g.rho + 2.0 * gg**2 / (cos(theta) * (z * cos(theta) ** 2 - 2.0 * gg))
        dbn = z * cos(ALPHA)
        dan = z + (da[i] - d[i]) / g.m
        den = 2.0 * hypot(0.5 * sqrt(dan**2 - dbn**2) - pi * cos(ALPHA) * (ean - 1.0), 0.5 * dbn)
        ae = acos(dbn / den)
        ge = (0.5 * pi + 2.0 * x * tan(ALPHA)) / z + tan(ALPHA) - ALPHA - tan(ae) + ae
        h_fe = 0.5 * ((cos(ge) - sin(ge) * tan(ae - ge)) * den - z * cos(pi / 3.0 - theta) - gg / cos(theta) + g.rho)
        f_eps = 1.0 if eb == 0.0 else sqrt(1.0 / ean)
        y_f = 6.0 * h_fe * cos(ae - ge) / (s_fn**2 * cos(ALPHA)) * f_eps
        qs, length = s_fn / (2.0 * rho_f), s_fn / h_fe
        y_s = (1.2 + 0.13 * length) * qs ** (1.0 / (1.21 + 2.3 / length))
        y_beta = (1.0 - min(eb, 1.0) * math.degrees(g.beta) / 120.0) / cos(g.beta) ** 3
        width = min(g.b[i], b + 2.0 * g.m)
        sigma = ft / (width * g.m) * y_f * y_s * y_beta * k_v * k_fb * k_fa
        y_d = (1.0 + sqrt(0.2 * 0.003 * (1.0 + 2.0 * qs))) / (1.0 + sqrt(0.2 * 0.003 * 6.0))
        y_r = 1.674 - 0.529 * (g.rz_root + 1.0) ** 0.1
        y_x = 1.0 if g.m <= 5.0 else 1.05 - 0.01 * g.m
        s_f.append(2.0 * g.flim * life(cycles[i], 3e6) * y_d * y_r * y_x / sigma)
    return {"K_v": k_v, "K_Hbeta": k_hb, "K_Halpha": k_ha, "S_H": s_h, "S_F": s_f}


@pytest.mark.parametrize(("case", "drive"), [("rating_spur", SPUR), ("rating_helical", HELICAL)])
def test_safeties_equal_those_typed_anew(case, drive):
    operation = f"pair.I.operation={{life='{drive.hours} h'}}"
    steel = [f"gear.{gear}.material={{young_modulus='{YOUNG} MPa'}}" for gear in ("pinion", "wheel")]
    settings = ["results=['rating']", "rating.beside=[]", "pair.I.iso_6336={edition=2019}", operation, *steel]
    scene = read_scene(CASES / f"{case}.toml", settings)
    done = run_plan(scene, make_plan(scene, STAGES), cache=SolutionCache())
    values = {value.name: value.value for value in done.values}
    expected = rated(drive)
    for symbol in ("K_v", "K_Hbeta", "K_Halpha"):
        assert values[f"I.{symbol}_rated"] == pytest.approx(expected[symbol], rel=1e-6), symbol
    for i, member in enumerate(("driver", "driven")):
        for symbol in ("S_H", "S_F"):
            assert values[f"I.{member}.{symbol}"] == pytest.approx(expected[symbol][i], rel=1e-6), (member, symbol)
