"""What commands cost on many short chains: processor seconds (median of some runs) and the largest memory of check, plan and run --steps 2
on 1e3 to 1e6 chains of 3 beads, and their growth from one size to the next. Exit status 1: a command grew more than 12-fold for ten times
the chains. Usage: load.py [--catena PROGRAM] [--sizes 1e3,1e4,1e5,1e6] [--repeats N] [--most 12]"""
import argparse
import os
import statistics
import subprocess
import sys
import tempfile

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", ".."))
SCENE = """\
chains: [{{name: trimer, count: {chains}, generator: {{freely_jointed: {{beads: 3, length: 0.38}}}}}}]
dynamics: {{integrator: g-baoab, step: 0.01, steps: 2, temperature: 300, friction: 1, seed: 1}}
"""
COMMANDS = {"check": [], "plan": [], "run": ["--steps", "2", "--quiet", "--overwrite", "--output", "o"]}
SMALL = 0.2  # seconds: below, starting up hides the growth


def execute(words, folder):
    """Processor seconds and megabytes of a command that has to succeed."""
    with open(os.path.join(folder, "said"), "w+b") as said:
        child = subprocess.Popen(words, cwd=folder, stdout=said, stderr=subprocess.STDOUT)
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        if child.returncode != 0:
            sys.exit(f"FAILED: {' '.join(words)}: status {child.returncode}: {said.read(2000).decode(errors='replace')}")
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1000


def measure(options, command, chains, folder):
    with open(os.path.join(folder, "scene.yaml"), "w", encoding="ascii") as scene:
        scene.write(SCENE.format(chains=chains))
    ran = [execute([options.catena, command, "scene.yaml", *COMMANDS[command]], folder) for _ in range(options.repeats)]
    return statistics.median(seconds for seconds, _ in ran), max(megabytes for _, megabytes in ran)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--catena", default=os.path.join(ROOT, "build", "release", "catena"))
    parser.add_argument("--sizes", default="1e3,1e4,1e5,1e6")
    parser.add_argument("--commands", default=",".join(COMMANDS))
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--most", type=float, default=12, help="times for ten times the chains")
    options = parser.parse_args()
    good = True
    with tempfile.TemporaryDirectory(prefix="catena-load-") as folder:
        for command in options.commands.split(","):
            before = None
            for chains in (int(float(size)) for size in options.sizes.split(",")):
                seconds, megabytes = measure(options, command, chains, folder)
                growth = seconds / max(before[1], SMALL) if before else 0
                bad = before is not None and growth > options.most ** (len(str(chains)) - len(str(before[0])))
                print(f"{command:6} {chains:8d} chains {seconds:8.2f} s {megabytes:7.0f} MB" + (f"  {growth:5.1f}-fold" if before else "")
                      + ("  TOO MUCH" if bad else ""), flush=True)
                good, before = good and not bad, (chains, seconds)
    sys.exit(0 if good else 1)


main()
