"""The command line without a process of its own, which takes a second to start."""

import contextlib
import io
import sys
from types import SimpleNamespace

import pytest

from fegear.cli import main
from fegear.engine.executor import Executor


def compute_points_here(patch: pytest.MonkeyPatch) -> None:
    """Let the points of a sweep be computed in this process: one of their own takes a second to start, too."""
    made = Executor.__init__  # in place of the class a module imported meanwhile would keep what stands for it
    patch.setattr(Executor, "__init__", lambda own, *asked, **more: made(own, *asked, **(more | {"here": True})))


def fegear(*arguments: object, cwd, points_here: bool = False, **environment: object) -> SimpleNamespace:
    """Run a command in a folder; returns what `subprocess.run` would: returncode, stdout, stderr."""
    said, complained, code = io.StringIO(), io.StringIO(), 0
    with pytest.MonkeyPatch.context() as patch, contextlib.chdir(cwd):
        if points_here:
            compute_points_here(patch)
        threads = {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL")}  # what `main` sets: put back
        for name, value in (threads | environment).items():
            patch.setenv(name, str(value))
        patch.setattr(sys, "argv", ["fegear", *map(str, arguments)])
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(complained):
            try:
                main()
            except SystemExit as end:
                code = end.code or 0
    return SimpleNamespace(returncode=code, stdout=said.getvalue(), stderr=complained.getvalue())
