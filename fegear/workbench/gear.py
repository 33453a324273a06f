"""A gear as a drawing describes it, in a script."""

from __future__ import annotations

import copy
import os
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.gear import GearPart
from fegear.case.reading import Scene, build_scene
from fegear.geometry import gear as geometry
from fegear.workbench.given import name_of, table, taken, working_folder
from fegear.workbench.quantities import Length, brief
from fegear.workbench.results import Results
from fegear.workbench.run import run_scene
from fegear.workbench.signature import takes_keys_of

#: Bodies of a single tooth, of which it has one.
_BODIES = ("crack", "missing", "broken_at", "tip_diameter", "hole", "keyway")


class Described:
    """A part of a case by its keys, with what has been solved for it; it never changes."""

    name: str
    known: SolutionCache
    _keys: dict[str, Any]

    @property
    def keys(self) -> dict[str, Any]:
        """What it was described by; a copy, for it never changes."""
        return copy.deepcopy(self._keys)

    def __getstate__(self) -> dict[str, Any]:
        """What travels to another process: all but what has been solved."""
        return {name: value for name, value in self.__dict__.items() if name != "known"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Come from another process, with nothing solved."""
        self.__dict__.update(state, known=SolutionCache())

    @cached_property
    def _scene(self) -> Scene:
        document = {"results": ["geometry"], **self.document()}
        return build_scene(document, self.name, working_folder(), bare_si=True)

    def document(self) -> dict[str, Any]:
        """It as the tables of a case file."""
        raise NotImplementedError

    @cached_property
    def data(self) -> Results:
        """What a drawing of it carries: diameters, span; of a pair also contact ratio and centre distance."""
        return run_scene(self._scene, progress=False)


@takes_keys_of(GearPart)
class Gear(Described):
    """A gear by the keys of ``[gear.NAME]`` of a case file; it never changes.

    Quantities are texts with their unit (``"3 mm"``), quantities of pint, or numbers in SI.

    Parameters
    ----------
    teeth : int
    module : str, quantity or float, optional
        Or give ``diametral_pitch``, or ``normal_module`` with ``helix_angle``.
    name : str
        In names of results.
    **keys
        All others of a case file, as there: ``pressure_angle``, ``profile_shift``, ``rack``, ``bore_radius``,
        ``face_width``, ``relief``, ...; the signature of ``fegear.Gear`` has each, ``help(fegear.Gear)`` what it is.

    Attributes
    ----------
    known : SolutionCache
        What has been solved for it; the questions about it recall from there and keep there.

    Raises
    ------
    InputError
        If there is no such gear: key, value, rule, remedy.

    Examples
    --------
    >>> pinion = fegear.Gear(23, "3 mm", profile_shift=0.3, bore_radius="15 mm", face_width="10 mm", name="pinion")
    """

    def __init__(self, teeth: int, module: Length | None = None, *, name: str = "a", **keys: Any) -> None:
        self.name = name_of(name)
        given = {"teeth": teeth, **({} if module is None else {"module": module}), **keys}
        self._keys: dict[str, Any] = taken(given, f"gear.{self.name}")
        self.known = SolutionCache()
        self._scene  # noqa: B018  (a gear that cannot be is refused where it is described)

    @classmethod
    def of(cls, name: str, keys: Mapping[str, Any]) -> Gear:
        """A gear from its name and its keys, ``teeth`` among them."""
        given: dict[str, Any] = {**table(keys, "keys"), "name": name}
        if "teeth" not in given:
            raise InputError("teeth", "(not given)", "is required", "for example teeth=20")
        return cls(**given)

    def changed(self, **keys: Any) -> Gear:
        """A gear with other keys; None takes one away."""
        name = keys.pop("name", self.name)
        return Gear.of(name, {key: value for key, value in {**self.keys, **keys}.items() if value is not None})

    def with_crack(self, tooth: int = 0, **crack: Any) -> Gear:
        """A gear with one more cracked tooth.

        Parameters
        ----------
        tooth : int
            Its number in meshing order; a tooth with a crack already gets the new one instead, its pits stay.
        **crack
            Keys of ``[[gear.NAME.odd_tooth]] crack`` of a case file: ``depth`` or ``depth_ratio``, ``angle``,
            ``tangent_angle`` or another start, ``fillet``.

        Raises
        ------
        InputError
            If the gear can have no such crack: key, value, rule, remedy.

        Examples
        --------
        >>> cracked = pinion.with_crack(tooth=0, depth="0.5 mm", angle="70 deg")
        """
        return self._with_odd_tooth(tooth, crack=crack)

    def with_hole(self, tooth: int = 0, **hole: Any) -> Gear:
        """A gear with one more round hole in its body, below a tooth, through the full face width (plane pairs).

        Parameters
        ----------
        tooth : int
            Number of the tooth in meshing order; a tooth with another body already has the hole instead.
        **hole
            Keys of ``[[gear.NAME.odd_tooth]] hole`` of a case file: ``diameter``, ``position_radius`` and ``angle``
            about the gear axis from the tooth centre line, positive towards the loaded flank.

        Raises
        ------
        InputError
            If the gear can have no such hole: key, value, rule, remedy.

        Examples
        --------
        >>> weakened = pinion.with_hole(tooth=0, diameter="2.5 mm", position_radius="19.5 mm")
        """
        return self._with_odd_tooth(tooth, hole=hole)

    def with_keyway(self, tooth: int = 0, **keyway: Any) -> Gear:
        """A gear with a keyway in its bore, below a tooth, through the full face width (plane pairs).

        Parameters
        ----------
        tooth : int
            Number of the tooth in meshing order; a tooth with another body already has the keyway instead.
        **keyway
            Keys of ``[[gear.NAME.odd_tooth]] keyway`` of a case file: ``width``, ``depth`` (by default those of
            DIN 6885-1 for the bore) and ``angle``.

        Raises
        ------
        InputError
            If the gear can have no such keyway: key, value, rule, remedy.

        Examples
        --------
        >>> keyed = pinion.with_keyway(tooth=0)
        """
        return self._with_odd_tooth(tooth, keyway=keyway)

    def with_pit(self, tooth: int = 0, **pit: Any) -> Gear:
        """A gear with one more pit (or spall) on the loaded flank of a tooth.

        Parameters
        ----------
        tooth : int
            Number of the tooth in meshing order; a tooth that has pits already gets one more, a cracked one is
            cracked and pitted.
        **pit
            Keys of ``[[gear.NAME.odd_tooth]] pits`` of a case file: ``diameter`` or ``radius`` (from, to),
            ``face_share``, ``depth``, and for 3D pairs ``face_position``.

        Raises
        ------
        InputError
            If the gear can have no such pit: key, value, rule, remedy.

        Examples
        --------
        >>> pitted = pinion.with_pit(tooth=0, diameter=["59 mm", "61 mm"], face_share=0.4)
        """
        pits = [one for tooth_keys in self._odd_teeth if tooth_keys.get("tooth", 0) == tooth
                for one in tooth_keys.get("pits", [])]  # fmt: skip
        return self._with_odd_tooth(tooth, pits=[*pits, pit])

    @property
    def _odd_teeth(self) -> list[dict[str, Any]]:
        """The teeth that differ already, a table each."""
        given = self.keys.get("odd_tooth", [])
        return [given] if isinstance(given, dict) else list(given)

    def _with_odd_tooth(self, tooth: int, **what: Any) -> Gear:
        """A gear of which one tooth differs in this way, too; another body replaces its body, not its flank."""
        apart = _BODIES if what.keys() & set(_BODIES) else ("missing",)
        had = {key: value for one in self._odd_teeth if one.get("tooth", 0) == tooth
               for key, value in one.items() if key not in apart}  # fmt: skip
        others = [one for one in self._odd_teeth if one.get("tooth", 0) != tooth]
        return self.changed(odd_tooth=[*others, {**had, "tooth": tooth, **what}])

    def document(self) -> dict[str, Any]:
        """It as the tables of a case file."""
        return {"gear": {self.name: self.keys}}

    @property
    def is_spur(self) -> bool:
        """Whether its teeth are straight."""
        return self.name in self._scene.spur_gears

    @property
    def geometry(self) -> geometry.Gear:
        """The gear of the geometry package, spur or helical, in SI throughout."""
        return self._scene.gears[self.name]

    def export(self, folder: str | os.PathLike[str], formats: str | list[str] = "dxf") -> list[Path]:
        """Write drawings and meshes, as ``fegear export`` does; see `Results.export`.

        Relief that ends with the path of contact is drawn by `Pair.export`.
        """
        return self.data.export(folder, formats)

    def __eq__(self, other: object) -> bool:
        """Whether two gears are described alike."""
        return isinstance(other, Gear) and (self.name, self._keys) == (other.name, other._keys)

    __hash__ = None  # type: ignore[assignment]  # its keys may hold lists

    def __repr__(self) -> str:
        """As it was described."""
        rest = {key: value for key, value in self.keys.items() if key not in ("teeth", "module")}
        given = [brief(self.keys[key]) for key in ("teeth", "module") if key in self.keys]
        given += [f"{key}={brief(value)}" for key, value in {"name": self.name, **rest}.items()]
        return f"Gear({', '.join(given)})"

    def _repr_html_(self) -> str:
        """Show the drawing and its data in a notebook."""
        from fegear.workbench.drawn_gears import gear_html

        return gear_html(self.name, self.geometry, self.data)
