"""What the package does under mpirun: each rank computes by itself, and says so."""

from __future__ import annotations

import warnings

from catena import _core
from catena.errors import Note

_said = False


def note_ranks(stack: int = 3) -> None:
    """Warns once, on rank 0 of several, that each rank computes whole scenes by itself."""
    global _said
    if _said:
        return
    _said = True
    rank, size, evidence = _core.launched()
    if rank == 0 and size > 1:
        warnings.warn(
            f"{size} processes were started ({evidence}), and this package divides no scene among them: each computes every scene that it is "
            "given; use `mpirun catena run` for one scene on several ranks",
            Note,
            stacklevel=stack,
        )
