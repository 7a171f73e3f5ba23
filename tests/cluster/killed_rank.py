"""A rank, or all of a run, is killed at a random moment: the run ends within 10 s and says so, the checkpoint is whole, and what is resumed
from it is bit for bit the uninterrupted run. Usage: killed_rank.py [--times N] [--steps N] [--seed S] [--ranks 1,2,3,4, one of which each kill
draws] [--all 0.3, the share of kills of every rank and the launcher] [--openmm 1: beads in OpenMM, on Reference] [--folder F, for the runs]"""
import collections
import os
import random
import signal
import sys
import time

from cluster import SCENE, Runs, arguments, ranks_of, verdict, wait_for

SECONDS_TO_END = 10
OPENMM_SCENE = """\
title: beads in OpenMM, to be disturbed
chains:
  - {name: beads, count: 6, sequence: MDVFMKGLSKAKEGVVAAAEKTKQGVAEAA, model: calvados2, conformation: self_avoiding}
box: {periodic: [15, 15, 15]}
forces: {openmm: {builder: calvados2, temperature: 300, ionic_strength: 0.15, platform: Reference}}
dynamics: {integrator: g-baoab, step: 0.01, steps: 200, temperature: 300, friction: 0.1, seed: 1}
output: {every: 3, checkpoint_every: 5, velocities: true}
"""
Kill = collections.namedtuple("Kill", "status seconds said ranks whole_job")


def kill(runs, name, ranks, seconds, draw, whole_job):
    """What became of the run; None where it was faster."""
    started = runs.start(ranks, name)
    pids = lambda: ranks_of(started.pid, runs.program) if ranks > 1 else [started.pid]
    wait_for(lambda: len(pids()) == ranks or started.poll() is not None, 60, "the ranks' start")
    time.sleep(draw.uniform(0, seconds))
    victims = pids()
    if len(victims) < ranks or started.poll() is not None:
        started.communicate()
        return None
    for victim in [*victims, started.pid] if whole_job else [victims[draw.randrange(ranks)]]:
        try:
            os.kill(victim, signal.SIGKILL)
        except ProcessLookupError:
            pass  # ended with the one before
    killed = time.monotonic()
    said = started.communicate()[0]
    if started.returncode == 0:
        return None  # it had come to its end
    return Kill(started.returncode, time.monotonic() - killed, said, ranks, whole_job or ranks == 1)


def is_as_promised(done):
    """The launcher names the rank that was killed; where it is killed itself nobody is left to say so."""
    if done.whole_job:
        return done.status == -signal.SIGKILL and done.seconds < SECONDS_TO_END
    return done.status not in (0, 3) and done.seconds < SECONDS_TO_END and "Killed" in done.said


def check(runs, number, seconds, draw, options):
    ranks = draw.choice(list(seconds))
    whole_job, resumed_on = draw.random() < options.all, ranks if options.openmm else draw.choice([1, *seconds])
    name = f"killed-{number}"
    done = None
    while done is None:
        done = kill(runs, name, ranks, seconds[ranks], draw, whole_job)
        if done is None:
            runs.remove(name)
    checkpoint = runs.step_of(name)
    runs.resume(resumed_on, name)
    difference = runs.difference(whole(ranks, options), name)
    runs.remove(name)
    message = "a message" if "Killed" in done.said else "no message"
    return verdict(f"kill {number}", is_as_promised(done) and not difference,
                   f"{'all' if done.whole_job else 'one'} of {ranks}: status {done.status} after {done.seconds:.1f} s, {message}; resumed on "
                   f"{resumed_on} from step {checkpoint}: {difference + ' DIFFERS' if difference else 'the same bits'}")


def whole(ranks, options):
    """Name of the uninterrupted run; OpenMM's sums over pieces of the beads are those of so many ranks."""
    return f"whole-{ranks if options.openmm else 1}"


def uninterrupted(runs, ranks, options):
    """Seconds that a run takes; the runs to compare with are there afterwards."""
    start = time.monotonic()
    runs.complete(ranks, f"whole-{ranks}")
    seconds = time.monotonic() - start
    difference = runs.difference(whole(ranks, options), f"whole-{ranks}")
    return seconds, verdict(f"uninterrupted on {ranks}", not difference, f"{difference or 'as it should be'}; {seconds:.1f} s")


def main():
    options = arguments(__doc__, times=5, steps=1000, seed=1, ranks="3", all=0.0, openmm=0, folder="")
    draw = random.Random(options.seed)
    with Runs(options, OPENMM_SCENE if options.openmm else SCENE, [f"dynamics.steps={options.steps}"], options.folder) as runs:
        counts = sorted({int(word) for word in options.ranks.split(",")})
        if not options.openmm and 1 not in counts:
            runs.complete(1, "whole-1")
        found = {ranks: uninterrupted(runs, ranks, options) for ranks in counts}
        seconds = {ranks: took for ranks, (took, _) in found.items()}
        good = [verdict_ for _, verdict_ in found.values()]
        kills = [check(runs, number + 1, seconds, draw, options) for number in range(options.times)]
    print(f"{len(kills)} kills, {kills.count(False)} not as promised")
    sys.exit(0 if all(good + kills) else 1)


main()
