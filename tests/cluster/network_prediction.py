"""What `catena plan --network` predicts of a step's messages on 2 and 4 ranks, from what `catena bench network` measured on these, beside the
time that the same messages take. What else runs on the cores disturbs both: the nearest of a few attempts counts.
Usage: network_prediction.py [--factor F] [--attempts N]"""
import json
import subprocess
import sys

from cluster import Runs, arguments, verdict


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
    grows = all(first["seconds"] < second["seconds"] for first, second in zip(rows, rows[1:]))
    return verdict(f"{ranks} ranks", factor_of(plan) <= factor and grows and rows[-1]["ranks"] == 4096,
                   f"predicted {1e6 * predicted:.0f} us a step, measured {1e6 * measured:.0f} us; on 4,096 ranks {1e6 * rows[-1]['seconds']:.0f} us "
                   f"(attempt {len(plans)})")


def main():
    options = arguments(__doc__, factor=2.0, attempts=8)
    with Runs(options) as runs:
        good = [check(runs, ranks, options.factor, options.attempts) for ranks in (2, 4)]
    sys.exit(0 if all(good) else 1)


main()
