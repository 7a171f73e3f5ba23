"""The program is killed before its n-th write into its folder, n = 0, stride, 2 stride, ... to the last: in the middle of frames, flushes and
checkpoints. What is resumed is bit for bit the uninterrupted run. Usage: killed_at_write.py [--stride N] [--preload LIBRARY]"""
import os
import signal
import sys

from cluster import Runs, arguments, verdict

SCENE = """\
chains: [{name: beads, velocities: thermal, generator: {freely_jointed: {beads: 50, length: 0.38}}}]
dynamics: {integrator: g-baoab, step: 0.002, steps: 120, friction: 1, seed: 5}
output: {every: 1, checkpoint_every: 5, velocities: true}
"""
LIBRARY = "tests/cluster/libcatena_kill_at_write.so"


def main():
    options = arguments(__doc__, stride=37, preload="")
    library = options.preload or os.path.join(os.path.dirname(options.catena), LIBRARY)
    kills, bad = 0, []
    with Runs(options, SCENE) as runs:
        runs.complete(1, "whole")
        plain = runs.environment
        for write in range(0, 10**9, options.stride):
            runs.remove("killed")
            runs.environment = {**plain, "LD_PRELOAD": library, "CATENA_KILL_AT_WRITE": str(write), "CATENA_KILL_FOLDER": "/killed/"}
            said, status = runs.run(1, "killed")
            runs.environment = plain
            if status == 0:
                break
            if status != -signal.SIGKILL:
                sys.exit(f"FAILED: status {status} at write {write}: {said}")
            kills += 1
            runs.resume(1, "killed")
            difference = runs.difference("whole", "killed")
            if difference:
                bad.append(f"write {write}: {difference}")
    good = verdict("killed at a write", kills > 0 and not bad, f"{kills} kills, {len(bad)} resumed runs differ {bad[:3] or ''}")
    sys.exit(0 if good else 1)


main()
