"""What another processor would compute, on this one: noise of one unit in the last place where rounding enters.

Kernels of one BLAS, compilers and libraries of elementary functions differ in the last bit. `install` gives each
number that enters the mesher, each stiffness entry, compliance, load and start value at random the next larger or
smaller number or leaves it. The noise is a function of the seed and of the number's digits alone: like numbers stay
alike, symmetric matrices symmetric, mirror images mirror images, and doubled units doubled, as they do on any machine.
"""

import dataclasses
import functools
import importlib.abc
import importlib.util
import os
import sys
from pathlib import Path

import numpy as np

_DIGITS = np.uint64((1 << 52) - 1)


def noisy(values, seed):
    """Numbers moved by up to one unit in the last place; zeros, infinities and shapes stay."""
    x = np.ascontiguousarray(values, dtype=float)
    with np.errstate(over="ignore"):
        mixed = (x.view(np.uint64) & _DIGITS) + np.uint64(0x9E3779B97F4A7C15) * np.uint64(2 * seed + 1)
        for factor in (0xBF58476D1CE4E5B9, 0x94D049BB133111EB):
            mixed = (mixed ^ (mixed >> np.uint64(30))) * np.uint64(factor)
        mixed ^= mixed >> np.uint64(31)
    outward = np.copysign(np.inf, x)
    moved = np.where(mixed % np.uint64(3) == 1, np.nextafter(x, outward), x)
    moved = np.where(mixed % np.uint64(3) == 2, np.nextafter(x, 0.0), moved)
    return np.where((x == 0.0) | ~np.isfinite(x), x, moved).reshape(np.shape(values))


def _first(function, seed):
    return lambda first, *others, **named: function(noisy(first, seed), *others, **named)


def _result(function, seed):
    return lambda *given, **named: noisy(function(*given, **named), seed)


def _results(function, seed):
    def called(*given, **named):
        return tuple(noisy(one, seed) if isinstance(one, np.ndarray) and one.dtype == float else one
                     for one in function(*given, **named))  # fmt: skip

    return called


def _field(name):
    def of(function, seed):
        def called(*given, **named):
            made = function(*given, **named)
            return dataclasses.replace(made, **{name: noisy(getattr(made, name), seed)})

        return called

    return of


def _front(function, seed):
    """Of a function that writes matrices into its last argument."""

    def called(*given):
        function(*given)
        for one in given[-1]:
            one[...] = noisy(one, seed)

    return called


def _loads(place):
    def of(function, seed):
        def called(*given, **named):
            given = [noisy(one, seed) if i == place else one for i, one in enumerate(given)]
            return function(*given, **{k: noisy(v, seed) if k == "load" else v for k, v in named.items()})

        return called

    return of


#: Where noise enters: module, name in it, and what of a call is noisy.
PLACES = {
    "fegear.fem.plane.tooth_meshing": {"fill": _first},
    "fegear.fem.plane.elasticity": {"_stiffness": _result},
    "fegear.fem.solid.dissection": {"_smallest": _front},
    "fegear.contact.plane.pair_compliance": {"PairCompliance.matrices": _field("compliance")},
    "fegear.contact.wide.compliance": {"flank_compliance": _field("matrix")},
    "fegear.contact.plane.load_sharing": {"share_load": _loads(2)},
    "fegear.contact.wide.load_sharing": {"solve_contact": _loads(2)},
    "fegear.dynamics.motion.motion": {"starting_state": _results},
}


def put_noise(module, seed):
    """Put the noise into the functions of one module that has been imported."""
    for path, of in PLACES[module.__name__].items():
        *owners, name = path.split(".")
        owner = functools.reduce(getattr, owners, module)
        function = getattr(owner, name)
        called = functools.wraps(function)(of(function, seed))
        setattr(owner, name, called)


class _Finder(importlib.abc.MetaPathFinder):
    """Puts the noise into a module as soon as it has been executed, before anybody imports a name from it."""

    def __init__(self, seed):
        self.seed, self.looking = seed, False

    def find_spec(self, name, path=None, target=None):
        if name not in PLACES or self.looking:
            return None
        self.looking = True
        try:
            spec = importlib.util.find_spec(name)
        finally:
            self.looking = False
        execute = spec.loader.exec_module

        def exec_module(module):
            execute(module)
            put_noise(module, self.seed)

        spec.loader.exec_module = exec_module
        return spec


def install(seed):
    """Noise in this process, from here on, and in the processes that it starts; before fegear is imported."""
    if any(isinstance(finder, _Finder) for finder in sys.meta_path):
        return
    early = sorted(name for name in PLACES if name in sys.modules)
    if early:
        raise RuntimeError(f"{', '.join(early)} has been imported already, and others may know its functions")
    sys.meta_path.insert(0, _Finder(seed))
    here = str(Path(__file__).parent)
    others = [p for p in os.environ.get("PYTHONPATH", "").split(os.pathsep) if p and p != here]
    os.environ |= {"FEGEAR_LAST_BIT": str(seed), "PYTHONPATH": os.pathsep.join([here, *others])}
