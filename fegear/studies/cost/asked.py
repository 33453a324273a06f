"""What a case asks of a cost study, and of which gear, pair and mesh."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.case.built.pair_checks import check_wide_pair
from fegear.case.built.solid_influence import flank_pairs
from fegear.case.built.train import motion_spec
from fegear.case.reading import Scene
from fegear.case.train import TrainPart
from fegear.results.catalogue import STAGES
from fegear.results.gear.load_positions import contact_half_width, load_radii
from fegear.results.pair.loaded_teeth import plane_pairs
from fegear.studies.cost.quantities import OF_FLANKS, OF_GEAR, Quantity

#: Quantities that each wanted result stands for.
_OF_RESULT = {name: entry.quantities for entry in STAGES.entries if entry.quantities for name in entry.results}
#: Results that report a pair over its face, and those of plane gears, which a study of such a pair says nothing of.
_OVER_FACE = frozenset({"load-distribution", "transmission-error", "load-sharing"})
_OF_PLANE_GEARS = frozenset({"stiffness", "root-stress", "crosscheck"})
#: What is studied where the results stand for nothing that can be: the first that the case can be asked.
_INSTEAD = (("te-peak-to-peak", "tooth-force"), OF_FLANKS, ("c_0", "root-stress"))
#: Line load where the case names none [N/m].
_USUAL_LINE_LOAD = 100e3


@dataclass(frozen=True)
class Asked:
    """What a case asks of a cost study, and where.

    Parameters
    ----------
    scene : Scene
    quantities : tuple of Quantity
    gear, pair, mesh : str
        Subjects; empty where no quantity needs one. The mesh is that of the train, empty without dynamics.
    radii, half_width : ndarray, shape (P,)
        Load positions of the gear's quantities and the contact's half-width there [m].
    line_load : float
        [N/m], for closed forms whose contact is not linear in it.
    over_face : bool
        Whether the pair is loaded over its face: then there is nothing of gears, meshes and closed forms.
    notes : tuple of str
        What is studied in place of what the results stand for, and why.
    """

    scene: Scene
    quantities: tuple[Quantity, ...]
    gear: str
    pair: str
    mesh: str
    radii: Array
    half_width: Array
    line_load: float
    over_face: bool = False
    notes: tuple[str, ...] = ()

    @property
    def pairs(self) -> tuple[str, ...]:
        """Pairs whose compliances are needed."""
        if not self.pair:
            return ()
        train = self.scene.case.train
        if not self.mesh or train is None:
            return (self.pair,)
        return tuple(dict.fromkeys([self.pair, *(train.loaded_pair_of(mesh) for mesh in train.mesh)]))

    @property
    def tabled(self) -> bool:
        """Whether the pair's compliances are read from a file: then nothing is more accurate than they are."""
        return any(self.scene.case.pair[name].compliance.source == "table" for name in self.pairs)

    def solves(self, quantity: Quantity) -> bool:
        """Whether finite elements and formulas have a say in a quantity."""
        return quantity.of_gear or not self.tabled

    def gears_for(self, quantity: Quantity) -> tuple[str, ...]:
        """Gears whose solution a quantity needs."""
        if quantity.of_gear:
            return (self.gear,)
        if self.tabled:
            return ()
        dynamic = self.mesh and quantity.name in ("tooth-force", "dynamic-factor")
        parts = [self.scene.case.pair[name] for name in (self.pairs if dynamic else (self.pair,))]
        return tuple(dict.fromkeys(name for part in parts for name in (part.driver, part.driven)))

    @property
    def gears(self) -> tuple[str, ...]:
        """Gears that any quantity needs."""
        return tuple(dict.fromkeys(name for q in self.quantities for name in self.gears_for(q)))

    @property
    def usual_half_width(self) -> float:
        """Half-width of the true contact in the middle of the flank [modules]; NaN if no quantity has one."""
        if self.half_width.size:
            return float(np.median(self.half_width)) / self.scene.gears[self.gear].module
        if not self.pair:
            return math.nan
        from fegear.formulas.hertz import line_contact, relative_curvature

        pair = self.scene.pairs[self.pair]
        curvature = relative_curvature(*(pair.flank_curvature_radius(0.0, m) for m in ("driver", "driven")))
        modulus = 1.0 / (1.0 / pair.driver.plane_modulus + 1.0 / pair.driven.plane_modulus)
        return float(line_contact(self.line_load, curvature, modulus).half_width) / pair.driver.module


def _names(scene: Scene) -> list[str]:
    given = scene.case.cost.quantities
    if given is not None:
        return list(dict.fromkeys(given))
    found = [name for result in scene.case.results for name in _OF_RESULT.get(result, ())]
    if not found:
        raise InputError(
            "results", ", ".join(f'"{r}"' for r in scene.case.results), "contain nothing with selectable accuracy",
            "request one of " + ", ".join(f'"{r}"' for r in (*_OF_RESULT, "load-distribution"))
            + ', or set quantities = ["c_0"] under [cost]',
        )  # fmt: skip
    order = (*OF_GEAR, "te-peak-to-peak", "tooth-force", "dynamic-factor")
    return sorted(set(found), key=order.index)


def _pair(scene: Scene, names: list[str]) -> str:
    if not set(names) - set(OF_GEAR):
        return ""
    loaded = [name for name in plane_pairs(scene) if scene.case.pair[name].normal_load(scene.pairs[name]) is not None]
    chosen = scene.case.cost.pair or next((p for p in (scene.case.stiffness.pair, *loaded) if p in loaded), None)
    if chosen is None or chosen not in loaded:
        raise InputError(
            "cost.pair", f'"{chosen}"' if chosen else "(not given)", "must be a loaded spur pair",
            "specify one with load or torque, or remove the quantities of pairs",
        )  # fmt: skip
    if scene.case.pair[chosen].compliance.source != "table" and scene.case.effects.hertz == "none":
        raise InputError(
            "effects.hertz", '"none"', "leaves the contact width equal to the mesh pressure patch: no convergence",
            'set hertz = "load-dependent" under [effects], or remove the quantities of pairs',
        )  # fmt: skip
    return chosen


def _gear(scene: Scene, names: list[str], pair: str) -> str:
    if not set(names) & set(OF_GEAR):
        return ""
    first = scene.case.pair[pair].driver if pair else next(iter({**scene.spur_gears, **scene.gears}), "")
    chosen = scene.case.cost.gear or scene.case.stiffness.gear or first
    if not chosen:
        raise InputError("gear", "(none)", "a gear is required for these quantities", "specify one")
    return chosen


def _mesh(scene: Scene, pair: str, names: list[str]) -> str:
    """Mesh of the train whose dynamics are studied; empty where the case describes none."""
    train, speed = scene.case.train, scene.case.dynamics
    if not pair or train is None or not speed.speed_values.size:
        mesh = ""
    else:
        mesh = next((m for m, part in train.mesh.items() if part.like is None and train.pair_of(m) == pair), "")
    if "dynamic-factor" in names and not (mesh and motion_spec(scene).in_time):
        raise InputError(
            "cost.quantities", '"dynamic-factor"', "requires a train, speeds, and an effect in the time domain",
            "specify them and set effects.contact_loss = true, or remove the quantity",
        )  # fmt: skip
    if mesh and train is not None and _over_the_face(scene, train, names):
        return ""
    return mesh if mesh and ("dynamic-factor" in names or not math.isnan(speed.one_speed)) else ""


def _over_the_face(scene: Scene, train: TrainPart, names: list[str]) -> bool:
    """Whether the train has teeth that are loaded over their face, whose cost is not studied here.

    Raises
    ------
    InputError
        If the dynamics of such a train are asked for.
    """
    wide = [name for name in map(train.loaded_pair_of, train.mesh) if name in scene.wide_pairs]
    moving = sorted({"tooth-force", "dynamic-factor"} & set(names))
    if wide and moving:
        raise InputError(
            "cost.quantities", f'"{moving[0]}"', f"requires plane (2D) teeth in the entire train; pair {wide[0]} is "
                                                 "3D", "remove the quantity",
        )  # fmt: skip
    return bool(wide)


def _flank_pair(scene: Scene) -> str:
    """The pair whose load over the face is studied; empty for a study in the plane.

    That is studied where the quantities are such pairs' own, where ``cost.pair`` is one, or where the case asks for
    results over the face and for nothing that a study in the plane could answer.
    """
    part, wanted = scene.case.cost, set(scene.case.results)
    pairs = [name for name in flank_pairs(scene) if "load-distribution" in wanted or name in scene.wide_pairs]
    given = set(part.quantities or ())
    if part.pair in scene.plane_pairs or not pairs:
        chosen = part.pair if part.pair in pairs else ""
    else:
        chosen = part.pair or pairs[0]
    loaded = [p for p in scene.plane_pairs if scene.case.pair[p].normal_load(scene.pairs[p]) is not None]
    if given:
        plane = bool(given - set(OF_FLANKS)) or (given == {"te-peak-to-peak"} and bool(loaded) and part.pair != chosen)
    else:
        plane = not wanted & _OVER_FACE or bool(wanted & _OF_PLANE_GEARS) or (
            part.pair not in scene.wide_pairs and bool(loaded) and any(_OF_RESULT.get(result) for result in wanted)
        )  # fmt: skip
    return "" if plane or not chosen else chosen


def _asked_of_flanks(scene: Scene, pair: str) -> Asked:
    """What is to be studied of a pair that is loaded over its face."""
    check_wide_pair(scene, pair)
    if scene.case.effects.hertz == "none":
        raise InputError(
            "effects.hertz", '"none"', "leaves the contact width equal to the mesh resolution",
            'set hertz = "load-dependent" under [effects]',
        )  # fmt: skip
    known = {
        "te-mean": Quantity("te-mean", pair, "um", f"mean loaded transmission error of pair {pair}"),
        "te-peak-to-peak": Quantity(
            "te-peak-to-peak",
            pair,
            "um",
            f"peak-to-peak transmission error of pair {pair} over its mesh positions",
        ),
        "face-load-factor": Quantity("face-load-factor", pair, "", f"K_Hbeta, face load factor of pair {pair}"),
    }
    names = scene.case.cost.quantities or OF_FLANKS
    none = np.empty(0)
    return Asked(scene, tuple(known[name] for name in dict.fromkeys(names)), "", pair, "", none, none, math.nan, True)


def asked(scene: Scene) -> Asked:
    """Read from a case what is to be studied.

    Without a word of ``[cost]`` on quantities, pair or gear it is what the results stand for; where that cannot be
    studied, the nearest that can: the same at rest, a pair over its face, the teeth of a gear (`Asked.notes`).

    Raises
    ------
    InputError
        If what ``[cost]`` names lacks its gear, pair, load or train; of a case without gears.
    """
    part = scene.case.cost
    try:
        return _asked(scene)
    except InputError as error:
        if part.quantities is not None or part.pair is not None or part.gear is not None:
            raise
        refusal = error
    wanted = [name for result in scene.case.results for name in _OF_RESULT.get(result, ())]
    still = [[n for n in wanted if n != "dynamic-factor"], [n for n in wanted if n in OF_GEAR]]
    for names in (*filter(None, still), *_INSTEAD):
        for taken in (scene, _with_generated_meshes(scene)):
            cost = part.model_copy(update={"quantities": list(names)})
            try:
                found = _asked(replace(taken, case=taken.case.model_copy(update={"cost": cost})))
            except InputError:
                continue
            return replace(found, notes=_notes(found, refusal, scene))
    raise refusal


def _with_generated_meshes(scene: Scene) -> Scene:
    """The same case, its gears without meshes of their own."""
    gears = {name: part.model_copy(update={"tooth_mesh": None}) for name, part in scene.case.gear.items()}
    return replace(scene, case=scene.case.model_copy(update={"gear": gears}))


def _notes(found: Asked, refusal: InputError, scene: Scene) -> tuple[str, ...]:
    """What is studied in place of what the results stand for, and why."""
    of = " and ".join(f"{kind} {name}" for kind, name in (("gear", found.gear), ("pair", found.pair)) if name)
    names = ", ".join(quantity.name for quantity in found.quantities)
    why = f"{refusal.key} = {refusal.value}: {refusal.rule}"
    notes = [f"Studied instead of the requested results: {names} of {of} ({why})."]
    if found.gear and scene.gears[found.gear].helix_angle:
        notes.append(f"Gear {found.gear} is helical: transverse section studied in 2D.")
    own = [name for name in found.gears if scene.case.gear[name].tooth_mesh is not None]
    if own:
        notes.append(f"Gear {', '.join(own)}: generated meshes used instead of tooth_mesh.")
    return tuple(notes)


def _asked(scene: Scene) -> Asked:
    over_face = _flank_pair(scene)
    if over_face:
        return _asked_of_flanks(scene, over_face)
    names = _names(scene)
    alone = sorted(set(names) & (set(OF_FLANKS) - {"te-peak-to-peak"}))
    if alone:
        raise InputError(
            "cost.quantities", f'"{alone[0]}"', "applies to a 3D pair and "
                                                "cannot be combined with "
                                                "quantities of plane (2D) "
                                                "teeth", 'set results = ["load-distribution"] and remove the others',
        )  # fmt: skip
    pair = _pair(scene, names)
    gear = _gear(scene, names, pair)
    mesh = _mesh(scene, pair, names)
    for name in (gear, *((scene.case.pair[pair].driver, scene.case.pair[pair].driven) if pair else ())):
        own = scene.case.gear[name].tooth_mesh if name else None
        if own is not None:
            raise InputError(
                f"gear.{name}.tooth_mesh", f'"{own}"', "fixes the mesh, but the study varies the mesh density",
                "remove it, for example in a second case",
            )  # fmt: skip
    none = np.empty(0)
    radii = load_radii(scene, gear) if gear else none
    width = contact_half_width(scene, gear, radii) if gear else none
    line_load = scene.case.stiffness.load
    if line_load is None and pair:
        p = scene.pairs[pair]
        line_load = (scene.case.pair[pair].normal_load(p) or 0.0) / p.face_width
    quantities = tuple(_quantity(name, gear, pair, mesh, scene) for name in names)
    return Asked(scene, quantities, gear, pair, mesh, radii, width, line_load or _USUAL_LINE_LOAD)


def _quantity(name: str, gear: str, pair: str, mesh: str, scene: Scene) -> Quantity:
    speed = scene.case.dynamics.one_speed * 30.0 / math.pi
    force = (
        Quantity(name, mesh, "N", f"maximum force on one tooth pair of mesh {mesh} at {speed:.6g} rpm")
        if mesh and not math.isnan(speed)
        else Quantity(name, pair, "N", f"maximum static load on one tooth pair of {pair}")
    )
    known = {
        "c_0": Quantity(name, gear, "um.mm/N", f"self-compliance of gear {gear} at its load positions"),
        "c_1": Quantity(name, gear, "um.mm/N", f"deflection of the next tooth of gear {gear}"),
        "root-stress": Quantity(
            name, gear, "MPa.mm/N", f"maximum root stress (tension side) of gear {gear} per line load"
        ),
        "te-peak-to-peak": Quantity(name, pair, "um", f"peak-to-peak loaded transmission error of pair {pair}"),
        "tooth-force": force,
        "dynamic-factor": Quantity(name, mesh, "", f"maximum tooth force / mean mesh force, mesh {mesh}"),
    }
    return known[name]
