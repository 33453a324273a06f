"""Runs cases, each in a process of its own that has loaded the program and its libraries when it begins.

A case of a second takes as long again to start: Python, numpy, scipy and matplotlib. Here one process loads them once
and is copied for each case, where the system can copy processes; elsewhere each case starts by itself.
"""

from __future__ import annotations

import multiprocessing
import os
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from multiprocessing.connection import Connection

_HERE = str(Path(__file__).resolve().parent)
#: What nearly every case loads. Where matplotlib is there, a case draws its pictures itself.
_LOADED = [
    "fegear.cli",
    "fegear.case.reading",
    "fegear.contact.wide.loaded",
    "fegear.fem.plane.solution",
    "fegear.output.dataset",
    "fegear.output.draw_png",
    "fegear.output.report",
    "fegear.results.catalogue",
    "matplotlib.pyplot",
    "scipy.interpolate",
    "scipy.optimize",
    "scipy.sparse.linalg",
]


def _context() -> multiprocessing.context.BaseContext:
    copies = "forkserver" in multiprocessing.get_all_start_methods()
    context = multiprocessing.get_context("forkserver" if copies else "spawn")
    if copies:
        # Before numpy is loaded, as the program itself does it: one thread for each process.
        for library in ("OMP", "OPENBLAS", "MKL"):
            os.environ.setdefault(f"{library}_NUM_THREADS", "1")
        context.set_forkserver_preload(_LOADED)
    return context


_CONTEXT = _context()


def run_case(case: Path, out: Path) -> str:
    """``fegear run CASE --out OUT``; what it complained of if it failed, or nothing."""
    if _HERE not in sys.path:  # where the new process finds this file; mkdocs forgets it when its hooks are loaded
        sys.path.append(_HERE)
    answer, end = _CONTEXT.Pipe(duplex=False)
    with answer, tempfile.NamedTemporaryFile() as said:
        process = _CONTEXT.Process(target=_run, args=(["run", str(case), "--out", str(out)], said.name, end))
        process.start()
        end.close()
        try:  # not its `exitcode`, which goes to whoever asks first of several threads
            code = answer.recv()
        except EOFError:
            code = "no word"
        process.join()
        words = Path(said.name).read_text("utf-8", "replace").strip()
    return (words or f"ends with {code}") if code else ""


def _run(arguments: list[str], said: str, end: Connection) -> None:
    """Be the program, its words in a file; its exit code goes to `end`."""
    file = os.open(said, os.O_WRONLY)
    for stream in (1, 2):
        os.dup2(file, stream)
    sys.argv = ["fegear", *arguments]
    from fegear.cli import main

    code: object = 1
    try:
        main()
        code = 0
    except SystemExit as request:
        code = request.code or 0
        raise
    finally:
        end.send(code)
