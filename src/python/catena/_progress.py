"""Progress of steps in a notebook or on a terminal, with rate and time left (tqdm)."""

from __future__ import annotations

import contextlib
import threading
import warnings
from collections.abc import Callable, Iterator

#: Seconds between looks at the number of steps.
_INTERVAL = 0.2


@contextlib.contextmanager
def shown(first: int, last: int, steps: Callable[[], int]) -> Iterator[None]:
    """Shows how far ``steps()`` has come from ``first`` to ``last``, by a thread of its own. Raises ImportError without tqdm."""
    bar = _bar(last - first)
    ended = threading.Event()

    def look() -> None:
        while not ended.wait(_INTERVAL):
            bar.n = steps() - first
            bar.refresh()

    thread = threading.Thread(target=look, name="catena-progress", daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()
        bar.n = steps() - first
        bar.refresh()
        bar.close()


def _bar(total: int):  # type: ignore[no-untyped-def]
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a notebook without ipywidgets gets a bar of text
            from tqdm.auto import tqdm
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] != "tqdm":
            raise
        raise ImportError("the display of progress needs tqdm (Simulation.step): pip install tqdm, or leave progress out") from None
    return tqdm(total=total, unit=" steps", unit_scale=total >= 100000, mininterval=0)
