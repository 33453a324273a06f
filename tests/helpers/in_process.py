"""The command line without a process of its own, which takes a second to start."""

import contextlib
import io
import sys
from types import SimpleNamespace

import pytest

from fegear.cli import main


def fegear(*arguments: object, cwd, **environment: object) -> SimpleNamespace:
    """Run a command in a folder; returns what `subprocess.run` would: returncode, stdout, stderr."""
    said, complained, code = io.StringIO(), io.StringIO(), 0
    with pytest.MonkeyPatch.context() as patch, contextlib.chdir(cwd):
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
