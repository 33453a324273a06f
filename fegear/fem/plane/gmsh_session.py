"""The only door to gmsh: what it needs, a session with an empty model, and the requests to stop that it would lose."""

from __future__ import annotations

import ctypes
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from fegear.base.errors import MissingLibraryError, lacks_memory
from fegear.base.interrupts import deaf

#: What gmsh's wheel needs from the system, for the error message.
SYSTEM_PACKAGES = "libglu1-mesa libxcursor1 libxft2 libxinerama1"

#: What a mesh depends on. Algorithm 5 is Delaunay's: the frontal one (6) leaves triangles of quality .05 at sharp
#: fillets. Sizes come from a function of the place alone.
_OPTIONS = {
    "General.Terminal": 0,
    "General.NumThreads": 1,
    "Geometry.Tolerance": 1e-8,
    "Mesh.Algorithm": 5,
    "Mesh.AlgorithmSwitchOnFailure": 1,
    "Mesh.ElementOrder": 1,
    "Mesh.MeshSizeExtendFromBoundary": 0,
    "Mesh.MeshSizeFactor": 1,
    "Mesh.MeshSizeFromCurvature": 0,
    "Mesh.MeshSizeFromPoints": 0,
    "Mesh.MeshSizeMax": 1e22,
    "Mesh.MeshSizeMin": 0,
    "Mesh.Optimize": 1,
    "Mesh.RandomFactor": 1e-9,
    "Mesh.RandomSeed": 1,
    "Mesh.RecombineAll": 0,
    "Mesh.Smoothing": 1,
}
_ONE_AT_A_TIME = threading.RLock()


def load_gmsh() -> Any:
    """Import gmsh, or say which system packages it misses.

    Raises
    ------
    MissingLibraryError
        If gmsh or one of its shared libraries is not there.
    MemoryError
        If there is too little memory to load it.
    """
    try:
        import gmsh
    except (ImportError, OSError) as problem:
        if lacks_memory(problem):
            raise MemoryError(f"gmsh cannot be loaded ({problem})") from problem
        raise MissingLibraryError(
            f"gmsh cannot be loaded ({problem}); on Debian or Ubuntu run: apt-get install {SYSTEM_PACKAGES}"
        ) from problem
    return gmsh


@contextmanager
def gmsh_session(name: str) -> Iterator[Any]:
    """Gmsh with an empty model of this name, which is gone afterwards; started and ended unless it runs already.

    Whatever was drawn or set before, the same input gives the same mesh; who had gmsh running finds its options and
    its model again. One thread at a time: gmsh has one state for all of them.
    """
    gmsh = load_gmsh()
    with _ONE_AT_A_TIME:
        own = not gmsh.isInitialized()
        if own:
            _initialize(gmsh)
        current = gmsh.model.getCurrent()
        kept = {option: gmsh.option.getNumber(option) for option in _OPTIONS}
        try:
            for option, value in _OPTIONS.items():
                gmsh.option.setNumber(option, value)
            _forget_the_last_model(gmsh)
            gmsh.model.add(name)
            try:
                yield gmsh
            finally:
                gmsh.model.remove()
        finally:
            if own:
                gmsh.finalize()
            else:
                for option, value in kept.items():
                    gmsh.option.setNumber(option, value)
                gmsh.model.setCurrent(current)


def _forget_the_last_model(gmsh: Any) -> None:
    """Draw a model of size one: gmsh takes its tolerances from the size of the model that it drew last."""
    gmsh.model.add("of size one")
    for x in (0.0, 1.0):
        gmsh.model.geo.addPoint(x, x, 0.0)
    gmsh.model.geo.synchronize()
    gmsh.model.remove()


def _initialize(gmsh: Any) -> None:
    """Start gmsh, from any thread; signals stay with whoever has them.

    gmsh.initialize gives them back to the system: a request to stop would end the process before it has cleared away
    what is unfinished, and writing to a pipe that the other side has closed would end it without a word.
    """
    names = ("SIGPIPE", "SIGTERM", "SIGHUP")
    handlers = ctypes.pythonapi
    handlers.PyOS_getsig.restype = ctypes.c_void_p
    held = {int(n): handlers.PyOS_getsig(int(n)) for n in (getattr(signal, name, None) for name in names) if n}
    with deaf(held):
        gmsh.initialize(interruptible=False)
        for number, handler in held.items():
            handlers.PyOS_setsig(number, ctypes.c_void_p(handler))


@contextmanager
def heard_below(stopped: list[BaseException]) -> Iterator[None]:
    """Keep what is raised in a function that a library calls: a request to stop, which ctypes would print and lose.

    The library reads a size of zero for it, so that what it draws from there on is worth nothing.
    """
    before = sys.unraisablehook

    def hear(said: sys.UnraisableHookArgs) -> None:
        if "ctypes callback" in (said.err_msg or "") and said.exc_value is not None:
            stopped.append(said.exc_value)
        else:
            before(said)

    sys.unraisablehook = hear
    try:
        yield
    finally:
        sys.unraisablehook = before
