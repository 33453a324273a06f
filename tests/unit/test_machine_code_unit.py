"""What numba keeps on disk may fail in any way: it costs time, never a run, and never a number."""

from __future__ import annotations

import importlib
import inspect
import itertools
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from fegear.contact.machine_code import machine_code
from fegear.dynamics.motion import kernel
from fegear.dynamics.motion.motion import propagate, static_state
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.packed_model import pack
from fegear.dynamics.motion.prepare import prepare
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.train import Body, Mesh, Shaft, Torque, Train

_number = itertools.count()


@pytest.fixture
def made(tmp_path, monkeypatch):
    """A module with a function to compile; numba keeps its code beside it."""
    name = f"made_for_machine_code_{next(_number)}"
    (tmp_path / "package").mkdir()
    (tmp_path / "package" / f"{name}.py").write_text("def twice(x):\n    return 2.0 * x\n")
    monkeypatch.syspath_prepend(str(tmp_path / "package"))
    monkeypatch.setattr("sys.dont_write_bytecode", True)
    return importlib.import_module(name)


def hits(made) -> int:
    """Call the function as a new process would; returns how many of its two signatures came from the disk."""
    fast = machine_code(made.twice)
    assert fast(3.5) == 7.0
    assert fast(4) == 8.0
    return sum(fast.stats.cache_hits.values())


def test_damaged_foreign_and_exchanged_files_are_not_taken(made, tmp_path):
    assert hits(made) == 0
    assert hits(made) == 2
    folder = tmp_path / "package" / "__pycache__"
    whole = {path: path.read_bytes() for path in sorted(folder.iterdir())}
    first, second, index = whole
    assert [path.suffix for path in whole] == [".nbc", ".nbc", ".nbi"]
    code = bytearray(whole[first])
    code[len(code) // 2] ^= 1
    damages = [
        {path: data[: len(data) // 2] for path, data in whole.items()},
        dict.fromkeys(whole, b"cos\nsystem\n(S'exit 1'\ntR."),  # a pickle that would end the process
        {first: bytes(code)},
        {first: whole[second], second: whole[first]},  # what two processes that save at once may leave
        {index: b""},
    ]
    for damage in damages:
        for path, data in (whole | damage).items():
            path.write_bytes(data)
        assert hits(made) < 2
    assert hits(made) == 2, "and they have been made good"
    first.unlink()
    first.mkdir()
    assert hits(made) == 1


def test_no_place_to_keep_it_costs_time_only(made, tmp_path, monkeypatch):
    """A package that cannot be written to, below a home that cannot either."""
    blocker = tmp_path / "blocker"
    blocker.write_text("")
    (tmp_path / "package" / "__pycache__").write_text("a file where the folder should be")
    monkeypatch.setattr("numba.misc.appdirs.AppDirs.user_cache_dir", property(lambda self: str(blocker / "x")))
    fast = machine_code(made.twice)
    assert fast(3.5) == 7.0
    assert not any(tmp_path.rglob("*.nb?"))


def test_a_folder_that_vanishes_costs_time_only(made, tmp_path):
    fast = machine_code(made.twice)
    shutil.rmtree(tmp_path / "package")
    (tmp_path / "package").write_text("")
    assert fast(1.5) == 3.0


@pytest.mark.dear
def test_machine_code_of_functions_in_several_files_is_made_anew_when_one_of_them_changes(tmp_path):
    """Numba alone takes a caller's old code where a function that it calls has changed in another file."""
    (tmp_path / "helper.py").write_text("def part(x):\n    return 2.0 * x\n")
    (tmp_path / "caller.py").write_text("from helper import part\ndef whole(x):\n    return 1.0 + part(x)\n")
    program = (
        "import sys, caller, helper; from pathlib import Path; sys.dont_write_bytecode = True;"
        "from fegear.dynamics.motion.kernel import source_digest;"
        "from fegear.contact.machine_code import machine_code;"
        "digest = source_digest(Path(caller.__file__).parent); caller.part = machine_code(helper.part, digest);"
        "fast = machine_code(caller.whole, digest); print(fast(3.0), sum(fast.stats.cache_hits.values()))"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), *filter(None, sys.path)])}

    def run():
        return subprocess.run([sys.executable, "-B", "-c", program], env=environment, capture_output=True, text=True,
                              check=True).stdout.split()  # fmt: skip

    assert run() == ["7.0", "0"]
    assert run() == ["7.0", "1"]
    (tmp_path / "helper.py").write_text("def part(x):\n    return 3.0 * x\n")
    assert run() == ["10.0", "0"]


def test_every_function_of_the_kernel_is_compiled_with_the_others():
    folder = Path(kernel.__file__).parent
    named = {Path(module.__file__).name for module in kernel.COMPILED}
    assert {path.name for path in folder.glob("*.py")} == named | {"__init__.py", "arrays.py"}
    functions = inspect.getmembers(kernel.arrays, inspect.isfunction)
    assert not [name for name, one in functions if one.__module__ == kernel.arrays.__name__]


def test_who_has_to_wait_reads_why_and_only_once(made, caplog):
    """The first motion of a fresh clone took 28 silent seconds."""
    slow = "Compiling: half a minute, once."
    assert machine_code(made.twice, long=slow)(3.5) == 7.0
    assert [one.message for one in caplog.records] == [slow]
    assert machine_code(made.twice, long=slow)(3.5) == 7.0
    assert len(caplog.records) == 1


def test_what_the_set_up_compiles_serves_every_train():
    """A train with a shaft, backlash and more bodies than the set-up's has no signature of its own."""
    prepare()
    before = len(kernel.compiled().signatures)
    constant = MeshExcitation.from_mesh(Periodic.constant(2e8), Periodic.constant(0.0))
    train = Train(
        (Body("1", 2e-3), Body("2", 2e-3), Body("3", 4e-3)),
        shafts=(Shaft("s", "2", "3", 2e4),),
        meshes=(Mesh("g", "1", "2", 0.05, 0.05, 30, 30, 2e8, 100.0, 1e-4),),
        torques=(Torque("1", 25.0), Torque("3", 25.0)),
    )
    packed = pack(MotionModel(train, (constant,), 100.0))
    propagate(packed, *static_state(packed), 1e-3, tangents=True, record=100)
    assert len(kernel.compiled().signatures) == before == 1


@pytest.mark.dear
def test_a_ctrl_c_on_the_way_is_raised_and_does_not_end_the_process():
    """It was raised as numba made a named tuple of what it hands back, and nobody looked: a segmentation fault."""
    constant = MeshExcitation.from_mesh(Periodic.constant(2e8), Periodic.constant(0.0))
    train = Train(
        (Body("1", 2e-3), Body("2", 2e-3)), meshes=(Mesh("g", "1", "2", 0.05, 0.05, 30, 30, 2e8, 100.0, 1e-4),),
        torques=(Torque("1", 25.0), Torque("2", 25.0)),
    )  # fmt: skip
    packed = pack(MotionModel(train, (constant,), 100.0))
    propagate(packed, *static_state(packed), 1e-3)

    def stop(_number, _frame):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGVTALRM, stop)
    try:
        for _ in range(5):
            signal.setitimer(signal.ITIMER_VIRTUAL, 0.02)
            with pytest.raises(KeyboardInterrupt):
                propagate(packed, *static_state(packed), 3e2, longest=0.01)  # more than ten times as long
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
        signal.signal(signal.SIGVTALRM, before)
