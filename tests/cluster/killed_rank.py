"""One of three ranks is killed at a random moment: the run ends within 10 s and says so, the checkpoint is whole, and what is resumed from
it is bit for bit the undisturbed run. Usage: killed_rank.py [--times N] [--steps N] [--seed S]"""
import os
import random
import signal
import sys
import time

from cluster import Runs, arguments, ranks_of, verdict, wait_for

RANKS = 3
SECONDS_TO_END = 10


def kill_one(runs, name, seconds, draw):
    """Status, seconds from the kill to the end, and what was said; None where the run was faster."""
    started = runs.start(RANKS, name)
    wait_for(lambda: len(ranks_of(started.pid, runs.program)) == RANKS or started.poll() is not None, 60, "the ranks' start")
    time.sleep(draw.uniform(0, seconds))
    ranks = ranks_of(started.pid, runs.program)
    if len(ranks) < RANKS:
        started.communicate()
        return None
    os.kill(ranks[draw.randrange(RANKS)], signal.SIGKILL)
    killed = time.monotonic()
    said = started.communicate()[0]
    return started.returncode, time.monotonic() - killed, said


def check(runs, number, seconds, draw):
    name = f"killed-{number}"
    done = None
    while done is None:
        done = kill_one(runs, name, seconds, draw)
        if done is None:
            runs.remove(name)
    status, took, said = done
    checkpoint = runs.step_of(name)
    runs.resume(draw.choice([1, RANKS]), name)
    difference = runs.difference("whole", name)
    runs.remove(name)
    good = status not in (0, 3) and took < SECONDS_TO_END and "Killed" in said and not difference
    return verdict(f"kill {number}", good, f"status {status} after {took:.1f} s, {'a' if 'Killed' in said else 'NO'} message; resumed from step "
                   f"{checkpoint}: {difference + ' DIFFERS' if difference else 'the same bits'}")


def main():
    options = arguments(__doc__, times=5, steps=1000, seed=1)
    draw = random.Random(options.seed)
    with Runs(options, settings=[f"dynamics.steps={options.steps}"]) as runs:
        runs.complete(1, "whole")
        start = time.monotonic()
        runs.complete(RANKS, "timed")
        seconds = time.monotonic() - start
        good = [verdict("undisturbed", not runs.difference("whole", "timed"), f"1 rank and {RANKS} agree; {seconds:.1f} s")]
        good += [check(runs, number + 1, seconds, draw) for number in range(options.times)]
    sys.exit(0 if all(good) else 1)


main()
