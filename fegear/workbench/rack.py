"""A rack and the pinion on it, in a script."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fegear.base.errors import InputError, shown
from fegear.base.solution_cache import SolutionCache
from fegear.case.built.rack import drawn_rack, rack_inputs, relieved_parts
from fegear.case.rack import RackAndPinionPart
from fegear.case.reading import build_scene
from fegear.workbench.gear import Described, Gear
from fegear.workbench.given import cache_of, name_of, table, taken, working_folder
from fegear.workbench.quantities import Force, Length, Torque, brief
from fegear.workbench.run import run_scene
from fegear.workbench.signature import takes_keys_of

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping
    from pathlib import Path

    from fegear.geometry.rack_and_pinion import RackAndPinion
    from fegear.workbench.results import Results


@takes_keys_of(RackAndPinionPart)
class Rack(Described):
    """A rack and its pinion by the keys of ``[rack.NAME]`` of a case file; it never changes.

    Parameters
    ----------
    pinion : Gear
        An external gear, spur or helical, whose module, pressure angle, profile and material the rack has unless it
        is given its own.
    teeth : int
        Number of teeth of the rack.
    reference_height : str, quantity or float
        Of the reference line above the back.
    name : str
        In names of results.
    **keys
        All others of a case file, as there: ``backlash`` or ``distance``, ``support``, ``tip_relief``, ...; the
        signature of ``fegear.Rack`` has each, ``help(fegear.Rack)`` what it is.

    Attributes
    ----------
    known : SolutionCache
        What has been solved for it; the questions about it recall from there and keep there.

    Raises
    ------
    InputError
        If rack and pinion cannot mesh: key, value, rule, remedy.

    Examples
    --------
    >>> pinion = fegear.Gear(20, "2 mm", bore_radius="10 mm", face_width="20 mm", name="pinion")
    >>> axis = fegear.Rack(pinion, 12, "10 mm", backlash="40 um")
    >>> axis.transmission_error(force="2 kN").values["rack.te_mean"]
    """

    def __init__(self, pinion: Gear, teeth: int, reference_height: Length, *, name: str = "rack", **keys: Any) -> None:
        if not isinstance(pinion, Gear):
            raise InputError("pinion", shown(pinion), "must be a fegear.Gear", 'set pinion = fegear.Gear(20, "3 mm")')
        self.pinion, self.name = pinion, name_of(name)
        given = {"teeth": teeth, "reference_height": reference_height, **keys}
        self._keys: dict[str, Any] = taken(given, f"rack.{self.name}")
        self.known = SolutionCache()
        drawn_rack(self._scene, self.name)  # a rack, or a relief, that cannot be is refused where it is described

    def document(self, **load: Any) -> dict[str, Any]:
        """It and its pinion as the tables of a case file, with the key of its load."""
        rack = {"pinion": self.pinion.name, **self.keys, **taken(load, f"rack.{self.name}")}
        return {"gear": {self.pinion.name: self.pinion.keys}, "rack": {self.name: rack}}

    @property
    def geometry(self) -> RackAndPinion:
        """Rack and pinion of the geometry package, in SI throughout."""
        return rack_inputs(self._scene, self.name).pair

    def transmission_error(
        self,
        *,
        force: Force | None = None,
        torque: Torque | None = None,
        effects: Mapping[str, Any] | None = None,
        tolerance: float | None = None,
        progress: bool | None = None,
        cache: SolutionCache | None = None,
    ) -> Results:
        """Load sharing, travel due to the load and root stress over the stroke, both ends of the rack included.

        Parameters
        ----------
        force : force, optional
            Along the rack.
        torque : torque, optional
            On the pinion, in place of the force; one of them is required, here or among the keys of the rack.
        effects : mapping, optional
            ``{"relief": False}`` leaves out the reliefs of pinion and rack, which count where they are given.
        tolerance : float, optional
            Relative error that the meshes are chosen for.
        progress, cache
            As in `fegear.run`; by default what was solved for the same rack before is recalled.

        Returns
        -------
        Results
            Tables ``rack_transmission_error_<rack>``, ``rack_root_stress_<rack>``; values ``<rack>.te_mean``, ...
        """
        load = {key: value for key, value in (("force", force), ("torque", torque)) if value is not None}
        counts = {"relief": bool(relieved_parts(self._scene, self.name)), **table(effects, "effects")}
        document = {**self.document(**load), "effects": counts}
        return self._asked("rack-transmission-error", document, tolerance, progress, cache)

    def stiffness_table(
        self,
        *,
        tolerance: float | None = None,
        progress: bool | None = None,
        cache: SolutionCache | None = None,
    ) -> Results:
        """Compliance and root stress of the first, the middle and the last tooth of the rack under unit loads.

        Parameters
        ----------
        tolerance, progress, cache
            As in `transmission_error`.

        Returns
        -------
        Results
            Tables ``rack_stiffness_<rack>_<tooth>``.
        """
        return self._asked("rack-stiffness", self.document(), tolerance, progress, cache)

    def _asked(
        self, wanted: str, document: Mapping[str, Any], tolerance: float | None, progress: bool | None,
        cache: SolutionCache | None,
    ) -> Results:  # fmt: skip
        more = {} if tolerance is None else {"accuracy": {"tolerance": tolerance}}
        whole = {"title": f"Rack {self.name} on {self.pinion.name}", "results": [wanted], **more, **document}
        scene = build_scene(taken(whole, "case"), wanted, working_folder(), bare_si=True)
        return run_scene(scene, progress=progress, cache=cache_of(cache, self.known))

    def export(self, folder: str | os.PathLike[str], formats: str | list[str] = "dxf") -> list[Path]:
        """Write drawings of rack and pinion, as ``fegear export`` does; see `Results.export`."""
        return self.data.export(folder, formats)

    def __eq__(self, other: object) -> bool:
        """Whether two racks are described alike."""
        if not isinstance(other, Rack):
            return False
        return (self.name, self.pinion, self._keys) == (other.name, other.pinion, other._keys)

    __hash__ = None  # type: ignore[assignment]  # its keys may hold lists

    def __repr__(self) -> str:
        """As it was described."""
        rest = {key: value for key, value in self.keys.items() if key not in ("teeth", "reference_height")}
        given = [repr(self.pinion), *(brief(self.keys[key]) for key in ("teeth", "reference_height"))]
        given += [f"{key}={brief(value)}" for key, value in {"name": self.name, **rest}.items()]
        return f"Rack({', '.join(given)})"
