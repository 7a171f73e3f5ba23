#!/usr/bin/env python3
"""jobs/slurm-array.sh without Slurm, with an mpirun that prints its words: tasks of a folder of scenes go through the scenes, then through
the seeds; those of one scene have a seed each; a folder without scenes and a task 0 are refused.

Exit status 0: all as it should be; 1: not."""
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def submit(folder, task, *words):
    """What the script does as this task of an array."""
    program = os.path.join(folder, "mpirun")
    environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "CATENA_ROOT": ROOT, "CATENA_PROGRAM": program,
                   "SLURM_SUBMIT_DIR": folder, "SLURM_ARRAY_TASK_ID": str(task), "SLURM_CPUS_PER_TASK": "1"}
    return subprocess.run(["bash", os.path.join(ROOT, "jobs", "slurm-array.sh"), *words], env=environment, capture_output=True, text=True, check=False)


def faults(folder):
    wanted = {1: ("one.yaml", "results/one-1", 1), 2: ("two.yaml", "results/two-1", 1), 3: ("one.yaml", "results/one-2", 2)}
    for task, (scene, output, seed) in wanted.items():
        done = submit(folder, task, "scenes", "results", "--steps", "5")
        if f"run scenes/{scene} --output {output} " not in done.stdout or f"dynamics.seed={seed} --steps 5" not in done.stdout:
            yield f"task {task}: {done.stdout}{done.stderr}"
    done = submit(folder, 4, os.path.join("scenes", "two.yaml"), "each")
    if "run scenes/two.yaml --output each-4 " not in done.stdout or "dynamics.seed=4" not in done.stdout:
        yield f"one scene: {done.stdout}{done.stderr}"
    for task, words, message in ((1, ("empty", "results"), "no scenes in this folder (empty)"), (0, ("scenes", "results"), "counted from 1 (task 0)")):
        done = submit(folder, task, *words)
        if done.returncode == 0 or message not in done.stderr:
            yield f"{words} of task {task} is not refused: {done.stdout}{done.stderr}"


with tempfile.TemporaryDirectory() as parent:
    for name in ("scenes", "empty"):
        os.mkdir(os.path.join(parent, name))
    for name in ("one.yaml", "two.yaml"):
        with open(os.path.join(parent, "scenes", name), "w", encoding="utf-8"):
            pass
    with open(os.path.join(parent, "mpirun"), "w", encoding="utf-8") as file:
        file.write('#!/bin/sh\necho "$@"\n')
    os.chmod(os.path.join(parent, "mpirun"), 0o755)
    found = list(faults(parent))
print("\n".join(found) if found else "passed")
sys.exit(1 if found else 0)
