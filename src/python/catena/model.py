"""Scenes: files, texts, dicts, and models that are built chain by chain."""

from __future__ import annotations

import copy
import os
import re
import warnings
from collections.abc import Mapping
from typing import Any, Union

from catena import _core
from catena.errors import InputError, Note
from catena.text import scene_text, value_text

Scene = Union["Model", Mapping[str, Any], str, os.PathLike[str]]


class Model:
    """A scene in memory. It is read and checked when it is first used.

    ``Model("scene.yaml")`` and ``Model(path)`` read a file. ``Model({...})`` takes the keys of a scene as a dict; its
    numbers may be quantities of openmm.unit or pint.
    ``Model(units="si")`` begins an empty scene for ``add``. A string with line breaks is the text of a scene file.
    Keys, defaults and units are those of scene files.

    Models can be copied and pickled. A copy has its own scene and changes.
    """

    def __init__(self, scene: Scene | None = None, *, units: str | None = None) -> None:
        changes = list(scene._changes) if isinstance(scene, Model) else []
        if isinstance(scene, Model):
            scene = scene._scene
        if units is not None and scene is not None:
            raise InputError("both a scene and units are given (units): set the key `units` in the scene")
        if scene is None:
            scene = {"units": units or "md"}
        if not isinstance(scene, (Mapping, str, os.PathLike)):
            raise InputError(f"a {type(scene).__name__} is not a scene (scene): give a path, a text, a dict or a Model")
        self._scene: Mapping[str, Any] | str | os.PathLike[str] = (
            copy.deepcopy(dict(scene)) if isinstance(scene, Mapping) else scene
        )
        self._changes: list[tuple[str, str]] = changes
        self._read: _core.Model | None = None
        if not isinstance(scene, Mapping):
            self._core()  # a file that cannot be read is reported at once

    def __repr__(self) -> str:
        changes = f", {_number(len(self._changes), 'change')}" if self._changes else ""
        return f"<catena.Model: {self._origin()}{changes}>"

    def __getstate__(self) -> dict[str, Any]:
        return {"_scene": copy.deepcopy(self._scene), "_changes": list(self._changes), "_read": None}

    def add(self, name: str | None = None, **keys: Any) -> Model:
        """Adds a chain with the keys of an entry of ``chains``, such as ``bodies``, ``beads`` or ``sequence``.

        Returns the model, so that calls can be chained. Raises InputError if the scene is a file or a text.
        """
        if not isinstance(self._scene, dict):
            raise InputError("chains cannot be added to a file or text (Model.add): begin with a dict or Model(units=...)")
        if name is not None and not isinstance(name, str):
            raise InputError(f"the name {name!r} is not a string (Model.add): give other keys by name, as in bodies=[...]")
        if name is not None:
            keys = {"name": name, **keys}
        chains = self._scene.setdefault("chains", [])
        if not isinstance(chains, list):
            raise InputError("the chains of the scene are not a list (chains): give a list of dicts")
        chains.append(copy.deepcopy(keys))
        self._read = None
        return self

    def set(self, key: str, value: Any) -> Model:
        """Sets a key of the scene, such as ``set("dynamics.step", 0.01)`` or ``set("chains[0].count", 10)``.

        The value is a number, a string, a list or a dict; None removes the key. A quantity of openmm.unit or pint is
        converted to the unit of the key. Returns the model, so that calls can
        be chained. A wrong key is reported when the model is used.
        """
        if not isinstance(key, str):
            raise InputError(f"the key {key!r} is not a string (Model.set): give a key such as 'dynamics.step'")
        self._changes.append((key, value_text(value, key, self._is_si())))
        self._read = None
        return self

    @property
    def n_bodies(self) -> int:
        """Number of bodies and beads. Raises InputError if the scene is wrong."""
        return self._core().bodies

    @property
    def notes(self) -> list[str]:
        """One sentence each on what the reader assumed, changed or left out. Raises InputError if the scene is wrong."""
        return self._core().notes

    @property
    def text(self) -> str:
        """Text of the scene in the format of scene files, without the changes by ``set``."""
        if isinstance(self._scene, Mapping):
            return scene_text(self._scene, self._is_si())
        if _is_text(self._scene):
            return str(self._scene)
        with open(self._scene, encoding="utf-8") as file:
            return file.read()

    def _is_si(self) -> bool:
        """True if the scene's units are SI, by its changes or else by itself."""
        for key, value in reversed(self._changes):
            if key == "units":
                return value.strip('"') == "si"
        if isinstance(self._scene, Mapping):
            return self._scene.get("units") == "si"
        return re.search(r"^units:\s*[\"']?si\b", self.text, re.MULTILINE) is not None

    def _origin(self) -> str:
        """Returns in words where the scene comes from."""
        if isinstance(self._scene, Mapping):
            chains = self._scene.get("chains")
            return "dict with " + _number(len(chains) if isinstance(chains, (list, tuple)) else 0, "chain")
        return "text" if _is_text(self._scene) else f"file {os.fspath(self._scene)!r}"

    def _core(self) -> _core.Model:
        """Returns the model in C++ with all changes. It is made once."""
        if self._read is None:
            if isinstance(self._scene, Mapping) or _is_text(self._scene):
                read = _core.Model.from_text(self.text)
            else:
                read = _core.Model.from_file(os.fspath(self._scene))
            for key, value in self._changes:
                try:
                    read.set(key, value)
                except InputError as error:
                    raise InputError(str(error).replace("(--set ", "(Model.set: ")) from None
            self._read = read
        return self._read


def load(scene: Scene) -> Model:
    """Returns the model of a scene: a path, the text of a scene file, a dict with its keys, or a model to copy.

    Relative paths in a file start from its folder, those in texts and dicts from the working folder.
    Raises InputError if a file cannot be read. The scene itself is checked when the model is used.
    """
    return Model(model_of(scene))


def check(scene: Scene) -> list[str]:
    """Checks a scene and returns its notes: what the reader assumed, changed or left out, and steps near a limit.

    Raises InputError with the program's message if the scene is wrong, if beads coincide, or if the time step is too
    long for the scene's springs. With OpenMM's forces it computes those of the start, and refuses overlaps.
    """
    return model_of(scene)._core().check()


def model_of(scene: Scene) -> Model:
    """Returns a model as it is, or the model of a path, text or dict. Raises InputError for None."""
    if scene is None:
        raise InputError("None is not a scene (scene): give a path, a text, a dict or a Model")
    return scene if isinstance(scene, Model) else Model(scene)


def say(notes: list[str], stack: int = 3) -> None:
    """Issues a warning for each note, at the line that called the package."""
    for note in notes:
        warnings.warn(note, Note, stacklevel=stack)


def _is_text(scene: Any) -> bool:
    return isinstance(scene, str) and "\n" in scene


def _number(n: int, noun: str) -> str:
    return f"{n} {noun}" if n == 1 else f"{n} {noun}s"
