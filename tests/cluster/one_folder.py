"""Two runs started into one folder at the same time, --pairs times: one runs unharmed, the other is refused with one line. Then --runs runs
one after another, which leave nothing in the temporary folder, /dev/shm and their own but a run's files. Usage: one_folder.py [--pairs N] [--runs N]"""
import os
import sys

from cluster import Runs, arguments, verdict

SCENE = """\
chains: [{name: beads, velocities: thermal, generator: {freely_jointed: {beads: 50, length: 0.38}}}]
dynamics: {integrator: g-baoab, step: 0.002, steps: 8000, friction: 1, seed: 5}
output: {every: 5, checkpoint_every: 50, velocities: true}
"""
REFUSED = "catena: another run is writing to this folder"


def pair(runs, number):
    """What is wrong with two runs that want one folder; empty where one is unharmed."""
    name = f"both-{number}"
    started = [runs.start(1, name, ["--overwrite"]) for _ in range(2)]
    said = [each.communicate()[0] for each in started]
    ended = sorted(zip((each.returncode for each in started), said))
    difference = runs.difference("whole", name)
    runs.remove(name)
    if [status for status, _ in ended] != [0, 2]:
        return f"statuses {[status for status, _ in ended]}: {said}"
    return difference or ("" if ended[1][1].startswith(REFUSED) and ended[1][1].count("\n") == 1 else f"said {ended[1][1]}")


def temporary(runs):
    """What runs left where programs leave things: in the folder for temporary files, here their own, and in shared memory."""
    in_memory = {name for name in os.listdir("/dev/shm") if "catena" in name and not name.startswith("catena-")}  # tests' have a dash
    return in_memory | set(os.listdir(runs.environment["TMPDIR"]))


def main():
    options = arguments(__doc__, pairs=20, runs=300)
    with Runs(options, SCENE) as runs:
        runs.environment["TMPDIR"] = runs.path("temporary")
        os.mkdir(runs.environment["TMPDIR"])
        runs.complete(1, "whole")
        wrong = [found for found in (pair(runs, number) for number in range(options.pairs)) if found]
        good = [verdict("two at the same time", not wrong, f"{options.pairs} pairs, {len(wrong)} not one unharmed and one refused {wrong[:2] or ''}")]
        before, expected = temporary(runs), set(os.listdir(runs.path("whole")))
        for _ in range(options.runs):
            runs.complete(1, "again", ["--overwrite", "--steps", "5"])
        left = sorted((temporary(runs) - before) | (set(os.listdir(runs.path("again"))) - expected))
        good.append(verdict("one after another", not left, f"{options.runs} runs leave {left or 'nothing behind'}"))
    sys.exit(0 if all(good) else 1)


main()
