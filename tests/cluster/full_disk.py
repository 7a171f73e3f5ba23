"""The file system fills up in mid-run: one line says so, all ranks end in good order, the last checkpoint is whole, and with more room what is
resumed from it is bit for bit the uninterrupted run. Needs root: it mounts small disks. Usage: full_disk.py"""
import ctypes
import os
import sys

from cluster import Runs, arguments, verdict

RANKS = 3
KILOBYTES = (300, 1500, 700, 1000)  # the smallest has no room for a checkpoint
LIBC = ctypes.CDLL(None, use_errno=True)
MS_REMOUNT = 32


class Disk:
    """A file system of its own at `folder`."""

    def __init__(self, folder, kilobytes):
        self.folder = folder
        os.makedirs(folder)
        self.mount(0, kilobytes)

    def mount(self, flags, kilobytes):
        if LIBC.mount(b"catena", self.folder.encode(), b"tmpfs", flags, b"size=%dk" % kilobytes) != 0:
            raise OSError(ctypes.get_errno(), "mount")

    def grow(self, kilobytes):
        self.mount(MS_REMOUNT, kilobytes)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        LIBC.umount2(self.folder.encode(), 2)


def check(runs, kilobytes):
    name = f"full-{kilobytes}"
    with Disk(runs.path(name), kilobytes) as disk:
        said, status = runs.run(RANKS, name + "/run")
        lines = [line for line in said.splitlines() if line.startswith("catena: ")]
        message = len(lines) == 1 and lines[0].count("No space left on device") == 1 and "MPI_ABORT" not in said
        step = runs.step_of(name + "/run")
        disk.grow(100 * 1024)
        runs.resume(RANKS, name + "/run")
        difference = runs.difference("whole", name + "/run")
    good = status == 1 and message and not difference
    return verdict(f"{kilobytes} kB", good, f"status {status}, {lines[0] if lines else 'NO message: ' + said}; resumed from step {step}: "
                   f"{difference + ' DIFFERS' if difference else 'the same bits'}")


def main():
    options = arguments(__doc__, steps=400, sizes=len(KILOBYTES))
    with Runs(options, settings=[f"dynamics.steps={options.steps}"]) as runs:
        try:
            with Disk(runs.path("probe"), 100):
                pass
        except OSError as error:
            print(f"NOT RUN: mounting a small disk needs root ({error})")
            sys.exit(77)
        runs.complete(1, "whole")
        good = [check(runs, kilobytes) for kilobytes in KILOBYTES[:options.sizes]]
    sys.exit(0 if all(good) else 1)


main()
