"""Rows of what fegear hands on: files that other programs, or a few lines by hand, read and compute with."""

from __future__ import annotations

import math
import shutil
import tempfile
import warnings
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from fegear.base.effects import CONTACT_LOSS, HERTZ, PARAMETRIC, switched_on
from fegear.base.errors import MissingLibraryError
from fegear.verify.row import Compared, Rows, near

ROWS = Rows()
LOAD, COS = 500.0, math.cos(math.radians(20.0))
#: Two gears by a closed form: what is compared here is what leaves fegear, not what teeth do.
_CASE: dict[str, Any] = {
    "title": "A mesh for other programs",
    "results": ["natural-modes", "transmission-error"],
    "gear": {
        name: {"teeth": z, "module": "3 mm", "face_width": "10 mm", "bore_radius": "15 mm"}
        for name, z in (("a", 23), ("b", 41))
    },
    "pair": {
        "I": {"driver": "a", "driven": "b", "load": f"{LOAD} N", "compliance": {"source": "weber-banaschek"}},
    },
    "train": {
        "body": {"motor": {"gears": ["a"]}, "brake": {"gears": ["b"]}},
        "mesh": {"I": {"driver": "motor", "driven": "brake", "damping_ratio": 0.05}},
        "torque": {"motor": f"{LOAD * 1.5e-3 * 23 * COS:.12g} N*m"},
        "balance": "brake",
    },
    "transmission_error": {"even_positions": 500},
    "effects": switched_on(CONTACT_LOSS.name, PARAMETRIC.name, HERTZ.name),
}


@ROWS.add("transmission error and mesh stiffness as .mat", "program", "scipy.io.loadmat, numpy's FFT of the columns")
def mat_file() -> Iterator[Compared]:
    """Mean, peak to peak and first harmonic of 500 even positions; a jump stands at most half a step from its place."""
    from scipy.io import loadmat

    import fegear

    results = fegear.run(_CASE, progress=False)
    with tempfile.TemporaryDirectory() as folder:
        results.save(Path(folder) / "run", plots=False)
        read = loadmat(Path(folder) / "run" / "tables" / "mesh_table_I.mat", simplify_cells=True)
    te, slope = read["te"], read["local_stiffness"]
    first = 2.0 * abs(np.fft.rfft(te)[1]) / te.size
    for name, wanted in (
        ("te_mean", te.mean()), ("te_peak_to_peak", np.ptp(te)), ("te_first_harmonic", first),
        ("local_stiffness_mean", slope.mean()),
    ):  # fmt: skip
        yield from near(results.values[f"I.{name}"].value, wanted, 5e-3)


@ROWS.add("a mesh as an FMU", "program", "fmpy runs the exported FMU (FMI 3.0)")
def fmu() -> Iterator[Compared]:
    """Mesh force at 41 angles where the driven gear lags by the static transmission error: the load, of itself."""
    import fegear
    from fegear.engine.stage import Task

    try:
        import fmpy
    except ModuleNotFoundError:
        raise MissingLibraryError("fmpy is not installed: pip install fmpy") from None
    if not any(map(shutil.which, ("cc", "gcc", "clang"))):
        raise MissingLibraryError("exporting an FMU requires a C compiler.")
    results = fegear.run({**_CASE, "results": ["natural-modes"]}, progress=False)
    data: Any = results.outcomes[Task("gear-train", "")].data
    mesh = data.meshes[0]
    r1, r2, time = mesh.pair.driver.base_radius, mesh.pair.driven.base_radius, np.linspace(0.0, 1.0, 41)
    turned = 0.3 * time  # more than a pitch
    lag = mesh.excitation.approach(LOAD, 23.0 * turned / (2.0 * math.pi))
    given = {
        "time": time, "driver_angle": turned, "driven_angle": (r1 * turned - lag) / r2, "driver_speed": 0.0 * time,
        "driven_speed": 0.0 * time, "load": LOAD + 0.0 * time,
    }  # fmt: skip
    inputs = np.array(list(zip(*given.values(), strict=True)), dtype=[(name, float) for name in given])
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # what an FMU neglects is no news here
        (path,) = results.export(Path(folder), "fmu")
        found = fmpy.simulate_fmu(
            str(path), fmi_type="ModelExchange", stop_time=1.0, output_interval=0.025, input=inputs,
            start_values={"damping": 0.0}, output=["mesh_force"],
        )  # fmt: skip
    at = np.searchsorted(found["time"], time - 1e-9)
    yield from near(LOAD, found["mesh_force"][at], 1e-6)


@ROWS.add("gearboxes exported to and imported from REXS", "own", "the XML's attributes, contact ratios by hand")
def rexs() -> Iterator[Compared]:
    """Pitch diameters, base diameters and contact ratios of both stages, after writing and reading."""
    import tomllib

    from fegear.case.reading import build_scene
    from fegear.exchange.rexs.model_to_case import case_of
    from fegear.exchange.rexs.reading import model_of
    from fegear.exchange.rexs.written_gearbox import model_text

    document: dict[str, Any] = {
        "results": ["geometry"],
        "gear": {
            name: {"teeth": z, "normal_module": f"{m} mm", "helix_angle": f"{beta} deg", "hand": hand,
                   "face_width": f"{b} mm", "bore_radius": "10 mm"}
            for name, z, m, beta, hand, b in (
                ("p", 21, 2.5, 18.0, "right", 22.0), ("w", 53, 2.5, 18.0, "left", 20.0),
                ("q", 19, 4.0, 11.0, "left", 34.0), ("v", 61, 4.0, 11.0, "right", 32.0),
            )
        },
        "pair": {"I": {"driver": "p", "driven": "w", "torque": "80 N*m"},
                 "II": {"driver": "q", "driven": "v", "torque": "200 N*m"}},
    }  # fmt: skip
    text, _ = model_text(build_scene(document, "box", Path()), "2026-01-01T00:00:00")
    again = build_scene(tomllib.loads(case_of(model_of(text, Path("box.rexs")))), "box", Path())
    by_teeth = {}
    for component in ET.fromstring(text).iter("component"):  # noqa: S314  (fegear wrote it a line above)
        if component.get("type") == "cylindrical_gear":
            said = {one.get("id"): one.text for one in component.iter("attribute")}
            by_teeth[int(str(said["number_of_teeth"]))] = {
                key: float(str(said[key])) for key in ("normal_module", "helix_angle_reference_diameter")
            }
    for pair in again.pairs.values():
        reach = 0.0
        for gear in (pair.driver, pair.driven):
            m = by_teeth[gear.teeth]["normal_module"] * 1e-3
            beta = math.radians(by_teeth[gear.teeth]["helix_angle_reference_diameter"])
            alpha = math.atan(math.tan(math.radians(20.0)) / math.cos(beta))
            pitch = 0.5 * gear.teeth * m / math.cos(beta)
            base, pitch_of_contact = pitch * math.cos(alpha), math.pi * m * math.cos(alpha) / math.cos(beta)
            yield from near((gear.pitch_radius, gear.base_radius), (pitch, base), 1e-12)
            reach += math.sqrt((pitch + m) ** 2 - base**2) - pitch * math.sin(alpha)
        yield from near(pair.contact_ratio, reach / pitch_of_contact, 1e-11)
