"""One of three ranks may write no further than some bytes into a file, and the others may: what it cannot write ends all of them with one line
and without delay, and what is resumed is bit for bit the uninterrupted run. Usage: rank_without_room.py"""
import sys
import time

from cluster import Runs, arguments, verdict

RANKS = 3
SECONDS_TO_END = 60
BYTES = 300 * 1024  # the first chunks of the trajectory's second half are beyond
# Python ignores the signal that goes with the limit, and so does what it becomes.
LIMITED = f"""\
import os, resource, sys
if os.environ["OMPI_COMM_WORLD_RANK"] == sys.argv[1]:
    resource.setrlimit(resource.RLIMIT_FSIZE, ({BYTES}, {BYTES}))
os.execv(sys.argv[2], sys.argv[2:])
"""


class LimitedRuns(Runs):
    rank = None

    def words(self, ranks, name, more=()):
        words = super().words(ranks, name, more)
        if self.rank is None:
            return words
        at = words.index(self.program)
        return words[:at] + [sys.executable, "-c", LIMITED, str(self.rank)] + words[at:]


def check(runs, rank):
    name = f"limited-{rank}"
    runs.rank = rank
    start = time.monotonic()
    said, status = runs.run(RANKS, name)
    took = time.monotonic() - start
    runs.rank = None
    lines = [line for line in said.splitlines() if line.startswith("catena: ")]
    runs.resume(RANKS, name)
    difference = runs.difference("whole", name)
    good = status == 1 and len(lines) == 1 and "cannot write the trajectory" in lines[0] and took < SECONDS_TO_END and not difference
    return verdict(f"rank {rank}", good, f"status {status} after {took:.1f} s, {lines[0] if lines else 'NO message: ' + said}; resumed: "
                   f"{difference + ' DIFFERS' if difference else 'the same bits'}")


def main():
    options = arguments(__doc__, steps=300, ranks="0,1,2")
    with LimitedRuns(options, settings=[f"dynamics.steps={options.steps}"]) as runs:
        runs.complete(1, "whole")
        good = [check(runs, int(rank)) for rank in options.ranks.split(",")]
    sys.exit(0 if all(good) else 1)


main()
