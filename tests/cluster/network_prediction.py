"""What `catena plan --network` predicts on 2 and 4 ranks, from what `catena bench network` measured on these and what it measures itself:
of a step's messages, beside the time that the same messages take; of a whole step of a long chain on 2 ranks, beside the pace of the run.
What else runs on the cores disturbs all of it: the nearest of a few attempts counts.
Usage: network_prediction.py [--factor F] [--step-factor F] [--attempts N]"""
import json
import math
import subprocess
import sys

from cluster import Runs, arguments, verdict

# Long enough for computing to be nearly all of a step. Joints close in as many sweeps as are predicted.
LINKS = """\
title: links, whose steps are predicted
chains: [{name: links, velocities: thermal, generator: {freely_jointed: {beads: 200000, length: 0.38, mass: 100}}}]
dynamics: {integrator: rattle, step: 0.005, steps: 100, temperature: 300, seed: 5}
output: {every: 1000}
"""


def called(runs, ranks, *words):
    done = subprocess.run([*runs.launcher, "-n", str(ranks), runs.program, *words], capture_output=True, text=True, env=runs.environment,
                          check=False)
    if done.returncode != 0:
        sys.exit(f"FAILED: {' '.join(words)}: status {done.returncode}: {done.stderr}")
    return done.stdout


def attempt(runs, ranks):
    network = runs.path(f"network-{ranks}.json")
    called(runs, ranks, "bench", "network", "--quiet", "--json", network)
    return json.loads(called(runs, ranks, "plan", runs.scene, "--ranks", "4096", "--network", network, "--json", "-"))["network"]


def factor_of(plan):
    ratio = plan["measured"]["predicted"] / plan["measured"]["seconds"]
    return max(ratio, 1 / ratio)


def check(runs, ranks, factor, attempts):
    plans = []
    while len(plans) < attempts and all(factor_of(plan) > factor for plan in plans):
        plans.append(attempt(runs, ranks))
    plan = min(plans, key=factor_of)
    measured, predicted = plan["measured"]["seconds"], plan["measured"]["predicted"]
    rows = plan["predicted"]
    grows = all(first["message_seconds"] < second["message_seconds"] for first, second in zip(rows, rows[1:]))
    return verdict(f"{ranks} ranks", factor_of(plan) <= factor and grows and rows[-1]["ranks"] == 4096 and adds_up(rows),
                   f"predicted {1e6 * predicted:.0f} us a step, measured {1e6 * measured:.0f} us; on 4,096 ranks {1e6 * rows[-1]['message_seconds']:.0f} us "
                   f"(attempt {len(plans)})")


def adds_up(rows):
    """Computing and messages are a step, and speed-ups are those against the first row, of one rank."""
    return rows[0]["ranks"] == 1 and rows[0]["speed_up"] == 1 and all(
        math.isclose(row["step_seconds"], row["computing_seconds"] + row["message_seconds"]) and
        math.isclose(row["speed_up"], rows[0]["step_seconds"] / row["step_seconds"]) for row in rows)


def attempt_step(runs, ranks, number):
    """The predicted and the measured time of a step, and whether it has the sweeps that were predicted."""
    runs.environment["XDG_CACHE_HOME"] = runs.path(f"cache-{number}")  # measured now, in what else goes on now
    network, name = runs.path("network.json"), f"run-{number}"
    called(runs, ranks, "bench", "network", "--quiet", "--json", network)
    plan = json.loads(called(runs, ranks, "plan", runs.scene, "--ranks", str(ranks), "--network", network, "--json", "-"))["network"]
    runs.complete(ranks, name)
    with open(runs.path(name, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    return {"row": plan["predicted"][-1], "measured": 1 / summary["speed"]["steps_per_second_of_second_half"],
            "good": adds_up(plan["predicted"]) and summary["solver"]["sweeps_a_drift"] == plan["sweeps"]}


def check_step(runs, ranks, factor, attempts):
    def off(tried):
        ratio = tried["row"]["step_seconds"] / tried["measured"]
        return max(ratio, 1 / ratio)

    found = []
    while len(found) < attempts and all(off(tried) > factor for tried in found):
        found.append(attempt_step(runs, ranks, len(found)))
    best = min(found, key=off)
    row = best["row"]
    return verdict(f"a step on {ranks} ranks", off(best) <= factor and best["good"],
                   f"predicted {1e3 * row['step_seconds']:.2f} ms, {1e3 * row['computing_seconds']:.2f} of it computing by {row['arrangement']}, "
                   f"measured {1e3 * best['measured']:.2f} ms (attempt {len(found)})")


def main():
    options = arguments(__doc__, factor=2.0, step_factor=2.5, attempts=8)
    with Runs(options) as runs:
        good = [check(runs, ranks, options.factor, options.attempts) for ranks in (2, 4)]
    with Runs(options, LINKS) as runs:
        good.append(check_step(runs, 2, options.step_factor, options.attempts))
    sys.exit(0 if all(good) else 1)


main()
