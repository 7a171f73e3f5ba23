"""SIGTERM, SIGINT, SIGUSR1, SIGHUP or SIGXCPU on one rank, on all, or on the launcher: the run ends after a whole step with status 3 and one line; what is
resumed from its checkpoint, stopped again and resumed, is bit for bit the uninterrupted run. Usage: stopped_run.py [--steps N] [--cases M, the first]
[--only TEXT, those whose name has it]"""
import os
import signal
import sys
import time

from cluster import Runs, arguments, ranks_of, verdict

STOPPED = 3


def stop(runs, ranks, name, send, more=()):
    """Starts or resumes and stops; status and what was said."""
    started = runs.start(ranks, name, more)
    runs.wait_for_steps(started, name)
    time.sleep(0.02)
    send(started.pid, ranks_of(started.pid, runs.program) if ranks > 1 else [started.pid])
    said = started.communicate()[0]
    return started.returncode, said


def to_launcher(number):
    return lambda launcher, _: os.kill(launcher, number)


def to_rank(number, rank):
    return lambda _, ranks: os.kill(ranks[rank], number)


def to_all(number):
    return lambda _, ranks: [os.kill(rank, number) for rank in ranks]


# Of SIGTERM and SIGINT Open MPI's launcher makes a status of its own, and lets the ranks run for some seconds first.
CASES = {"SIGTERM to every rank": (3, to_all(signal.SIGTERM), (STOPPED,)),
         "SIGUSR1 to mpirun": (3, to_launcher(signal.SIGUSR1), (STOPPED,)),
         "SIGUSR1 to the last rank": (3, to_rank(signal.SIGUSR1, -1), (STOPPED,)),
         "SIGINT to mpirun": (2, to_launcher(signal.SIGINT), (1, STOPPED)),
         "SIGTERM to mpirun": (2, to_launcher(signal.SIGTERM), (1, STOPPED)),
         "SIGINT to a single rank": (1, to_rank(signal.SIGINT, 0), (STOPPED,)),
         "SIGTERM to a rank": (3, to_rank(signal.SIGTERM, 1), (STOPPED,)),
         "SIGHUP to a rank": (3, to_rank(signal.SIGHUP, 1), (STOPPED,)),
         "SIGXCPU to a rank": (3, to_rank(signal.SIGXCPU, 1), (STOPPED,)),
         "SIGXCPU to every rank": (2, to_all(signal.SIGXCPU), (STOPPED,)),
         "SIGHUP to mpirun": (2, to_launcher(signal.SIGHUP), (1, STOPPED)),
         "SIGXCPU to mpirun": (2, to_launcher(signal.SIGXCPU), (1, STOPPED))}


def check(runs, case):
    ranks, send, expected = CASES[case]
    name = case.replace(" ", "-")
    good, told = True, []
    for part in range(2):
        restart = ["--restart", runs.path(name, "checkpoint.h5")] if part else []
        status, said = stop(runs, ranks, name, send, restart)
        lines = [line for line in said.splitlines() if line.startswith("catena: ")]
        good = good and status in expected and len(lines) == 1 and lines[0].startswith("catena: stopped by SIG")
        told.append(f"status {status} at step {runs.step_of(name)}" + ("" if len(lines) == 1 else f" with {len(lines)} lines: {said}"))
    runs.resume(1, name)
    difference = runs.difference("whole", name)
    runs.remove(name)
    return verdict(case, good and not difference, f"{', '.join(told)}; resumed: {difference + ' DIFFERS' if difference else 'the same bits'}")


def main():
    options = arguments(__doc__, steps=20000, cases=len(CASES), only="")
    with Runs(options, settings=[f"dynamics.steps={options.steps}", "output.every=101", "output.checkpoint_every=1000"]) as runs:
        runs.complete(1, "whole")
        good = [check(runs, case) for case in list(CASES)[:options.cases] if options.only in case]
    sys.exit(0 if all(good) else 1)


main()
