"""Transmission errors over time: the rotation is found from the period of the mesh."""

import math

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.built.angle_of_time import mesh_turning
from fegear.case.built.encoders import encoders_of
from fegear.case.reading import build_scene

RPM = math.pi / 30.0
Z = 23


def trace(speed=61.3, seconds=12.0, rate=1000.0, noise=1e-7, wander=0.0):
    """Mesh harmonics beside runouts of both gears and noise."""
    time = np.arange(0.0, seconds, 1.0 / rate)
    turned = speed * RPM * time + wander * np.sin(2.0 * math.pi * time / seconds)
    mesh = Z * turned
    error = (
        2e-6 * np.cos(mesh)
        + 0.7e-6 * np.cos(2.0 * mesh + 0.4)
        + 8e-6 * np.cos(turned)
        + 5e-6 * np.cos(turned * Z / 37.0)
    )
    return time, error + np.random.default_rng(2).normal(0.0, noise, time.size)


@pytest.mark.parametrize(("stated", "seconds"), [(60.0, 12.0), (63.0, 12.0), (61.3, 0.5), (59.0, 40.0)])
def test_the_speed_is_that_of_the_mesh(stated, seconds):
    found = mesh_turning(*trace(seconds=seconds), stated * RPM, Z)
    assert found.found
    off = abs(found.speed / (61.3 * RPM) - 1.0) * seconds * 61.3 / 60.0 * Z  # tooth pitches over the trace
    assert off < 0.02


def test_noise_has_no_period_and_a_speed_that_is_not_constant_shows():
    noise = np.random.default_rng(3).normal(0.0, 1e-6, 12000)
    assert not mesh_turning(np.arange(12000) * 1e-3, noise, 60.0 * RPM, Z).found
    steady = mesh_turning(*trace(), 60.0 * RPM, Z).wander * Z
    assert mesh_turning(*trace(wander=0.3 / Z), 60.0 * RPM, Z).wander * Z > max(0.13, 2.0 * steady)


def read(folder, columns, heads="time [s],te [um]", **more):
    rows = "".join(",".join(f"{one:.9g}" for one in row) + "\n" for row in zip(*columns, strict=True))
    (folder / "t.csv").write_text(f"{heads}\n{rows}")
    gear = {"module": "2 mm", "face_width": "10 mm"}
    speed = {"speed": more.pop("of_pair")} if "of_pair" in more else {}
    document = {
        "results": ["measured-transmission-error"],
        "gear": {"a": {"teeth": Z, **gear}, "b": {"teeth": 37, **gear}},
        "pair": {"p": {"driver": "a", "driven": "b", "torque": "16 N*m", **speed}},
        "encoders": {"rig": {"traces": [{"file": "t.csv"}], "fit": ["offset", "scale", "shift"], **more}},
    }
    return encoders_of(build_scene(document, "case", folder), "rig").traces[0]


@pytest.mark.parametrize(
    "more",
    [{"speed": "60 rpm"}, {"of_pair": "60 rpm"}, {"shaft": "driven", "speed": "37.3 rpm"},
     {"shaft": "driven", "of_pair": "60 rpm"}],
)  # fmt: skip
def test_a_file_over_time_is_read_at_the_speed_of_its_shaft(more, tmp_path):
    time, error = trace()
    found = read(tmp_path, (time, 1e6 * error), **more)
    ratio = Z / 37.0 if "shaft" in more else 1.0
    assert found.angle[-1] == pytest.approx(61.3 * RPM * ratio * time[-1], rel=1e-4)
    assert found.te == pytest.approx(error, abs=1e-12)
    assert "rotation from the time at " in found.reading
    assert "the period of the mesh (stated: " in found.reading


def test_refusals(tmp_path):
    time, error = trace(seconds=1.0)
    for columns, more, rule in (
        ((time, 1e6 * error), {}, 'rig.speed = (not given): is required: "t.csv" has the time in column time'),
        ((time[::-1], error), {"speed": "60 rpm"}, "must have ascending times in column time; sort the lines"),
        ((time, error), {"speed": "60 rpm", "time_column": "te"}, "is the column of the transmission error"),
    ):
        with pytest.raises(InputError) as refused:
            read(tmp_path, columns, **more)
        assert rule in str(refused.value)
