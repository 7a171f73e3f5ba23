"""64 ranks on a few cores end in the bits of one, and the messages of their steps are those that the partition predicts: in summary.json,
counted by every rank's communicator, and in `plan`; the same where gathers go in two stages, over ranks that are dealt to hosts of seven.
Usage: many_ranks.py [--ranks P]"""
import json
import subprocess
import sys

from cluster import Runs, arguments, verdict

BEADS = "{name: beads, velocities: thermal, generator: {freely_jointed: {beads: 3000, length: 0.38}}}"
SHORT = "{name: short, velocities: thermal, generator: {freely_jointed: {beads: 40, length: 0.38}}}"
LINKED = "{name: linked, velocities: thermal, generator: {random: {bodies: 1100, joint: link, rigid: 0.5, seed: 8}}}"
BODIES = "{name: bodies, base: free, velocities: thermal, generator: {random: {bodies: 1100, joint: spherical, seed: 1}}}"
MIXED = "{name: mixed, base: fixed, generator: {random: {bodies: 1100, joint: mixed, seed: 2}}}"
TIP = "{name: tip, base: fixed, tip: {joint: {type: spherical}}, generator: {random: {bodies: 1030, joint: revolute, seed: 4}}}"
SCENES = {"g-baoab": ([BEADS, SHORT, LINKED, BODIES], "step: 0.002, friction: 1, temperature: 300"),
          "rattle": ([BEADS, LINKED, BODIES], "step: 0.002, temperature: 300"),
          "rk4": ([MIXED, TIP], "step: 0.0005"),
          "velocity-verlet": ([MIXED], "step: 0.0005")}


def scene(integrator):
    chains, dynamics = SCENES[integrator]
    return (f"chains: [{', '.join(chains)}]\ndynamics: {{integrator: {integrator}, {dynamics}, steps: 3, seed: 5}}\n"
            "output: {every: 3, velocities: true}\n")


def planned(runs, ranks, sweeps):
    """What `plan` says of a step with so many sweeps."""
    words = [*runs.launcher, "-n", str(ranks), runs.program, "plan", runs.scene, "--backend", "segments", "--json", "-"]
    done = subprocess.run(words, capture_output=True, text=True, env=runs.environment, check=True)
    messages = json.loads(done.stdout)["messages"]
    return {key: messages["fixed"][key] + sweeps * messages["each_sweep"][key] for key in messages["fixed"]}


def check(runs, options, integrator, gather):
    name = "many-" + gather
    runs.environment["CATENA_GATHER"] = gather
    runs.complete(options.ranks, name)
    difference = runs.difference("one", name)
    with open(runs.path(name, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    messages = summary["parallel"]["messages_a_step"]
    plan = planned(runs, options.ranks, summary["solver"].get("sweeps_a_drift", summary["solver"].get("corrections_of_tips", 0)))
    counted = messages["counted"]
    good = not difference and messages["ranks_that_differ"] == 0 and counted == messages["predicted"] == plan and counted["gathers"] > 0
    good = good and (counted["leader_gathers"] == (0 if gather == "one-stage" else counted["gathers"]))
    return verdict(f"{integrator} on {options.ranks} ranks, {gather}", good,
                   f"{difference + ' DIFFERS' if difference else 'the bits of one'}; a step {counted['gathers']:.0f} gathers of "
                   f"{counted['gathered_bytes']:.0f} bytes, {counted['leader_gathers']:.0f} of {counted['leader_bytes']:.0f} between hosts, "
                   f"{counted['exchanges']:.0f} exchanges; {messages['ranks_that_differ']} ranks differ "
                   f"from the prediction" + ("" if counted == plan else f"; plan says {plan}"))


def checks(options, integrator):
    with Runs(options, scene(integrator), ["solver.backend=segments"]) as runs:
        runs.complete(1, "one")
        return [check(runs, options, integrator, gather) for gather in ("one-stage", "two-stage:7")]


def main():
    options = arguments(__doc__, ranks=64, scenes=len(SCENES))
    good = [each for integrator in list(SCENES)[:options.scenes] for each in checks(options, integrator)]
    sys.exit(0 if all(good) else 1)


main()
