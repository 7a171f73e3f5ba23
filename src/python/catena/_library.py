"""Chooses the extension module: with OpenMM's forces where the right OpenMM is there, otherwise without."""

from __future__ import annotations

import ctypes
import importlib
import importlib.util
import os
import sys
import warnings
from types import ModuleType

from catena._built import ARCHITECTURE, OPENMM, OPENMM_FOLDER
from catena.errors import Note

#: Instructions of x86-64-v3, as /proc/cpuinfo names them.
_V3 = {"avx2", "bmi1", "bmi2", "f16c", "fma", "movbe"}


def load() -> ModuleType:
    """Loads the extension module as ``catena._core`` and returns it.

    Warns if OpenMM is there and cannot be used. Raises ImportError if the processor lacks instructions.
    """
    _require_processor()
    folder = _openmm_folder()
    reason = _why_not(folder) if folder else ""
    module = None
    if folder and not reason:
        try:
            module = importlib.import_module("catena.openmm_forces._core")
        except ImportError as error:
            reason = f"OpenMM's library does not fit this catena ({error})"
    if reason:
        warnings.warn(f"{reason}: OpenMM's forces are left out; install openmm {_series(OPENMM)} for them", Note, stacklevel=3)
    return sys.modules.setdefault("catena._core", module or importlib.import_module("catena._core"))


def _require_processor(cpuinfo: str = "/proc/cpuinfo") -> None:
    if ARCHITECTURE != "x86-64-v3":
        return
    try:
        with open(cpuinfo, encoding="utf-8") as file:
            flags = next((line for line in file if line.startswith("flags")), "")
    except OSError:
        return
    missing = sorted(_V3 - set(flags.split()))
    if flags and missing:
        raise ImportError(
            f"this processor lacks instructions that catena was compiled for ({', '.join(missing)}): compile catena on this machine, "
            "with pip install ./src/python in its repository"
        )


def _openmm_folder() -> str:
    """Returns the folder of OpenMM's library: that of the Python package, or the build's. Empty without OpenMM."""
    if not OPENMM:
        return ""
    spec = importlib.util.find_spec("openmm")
    for place in (spec.submodule_search_locations or []) if spec else []:
        version = importlib.util.spec_from_file_location("_openmm_version", os.path.join(place, "version.py"))
        if version is None or version.loader is None or not os.path.isfile(version.origin or ""):
            continue
        found = importlib.util.module_from_spec(version)
        version.loader.exec_module(found)
        return str(getattr(found, "openmm_library_path", ""))
    return OPENMM_FOLDER


def _why_not(folder: str) -> str:
    """Loads OpenMM's library. Returns why it cannot be used; empty if it can."""
    path = os.path.join(folder, "libOpenMM.so")
    try:
        library = ctypes.CDLL(path)
        library.OpenMM_Platform_getOpenMMVersion.restype = ctypes.c_char_p
        found = library.OpenMM_Platform_getOpenMMVersion().decode()
    except (OSError, AttributeError) as error:
        return f"OpenMM's library cannot be loaded ({error})"
    if _series(found) != _series(OPENMM):
        return f"catena was built with OpenMM {OPENMM}, and {found} is installed ({folder})"
    return ""


def _series(version: str) -> str:
    """Returns the part of a version whose libraries are alike, such as 8.6."""
    return ".".join(version.split(".")[:2])
