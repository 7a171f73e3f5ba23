"""Two hosts on one machine: two network namespaces with host names of their own, joined by a pair of virtual Ethernet cards; mpirun reaches
the second by `ip netns exec`, ranks speak TCP. Runs over both are bit for bit those of one host, gathers in one stage and in two, and a run
whose link is cut ends within 30 s and says so. Needs root. Usage: two_hosts.py"""
import os
import subprocess
import sys
import time

from cluster import ROOT, Runs, arguments, verdict

SECONDS_TO_END = 30
HOSTS = ("catena-a", "catena-b")
ADDRESSES = ("10.77.0.1", "10.77.0.2")
AGENT = """#!/bin/sh
# In the place of ssh: HOST COMMAND...
shift
exec ip netns exec {host} unshare --uts sh -c 'hostname {host}; eval "$*"' sh "$@"
"""


def ip(*words):
    subprocess.run(["ip", *words], check=True)


class TwoHosts:
    """The namespaces, and the launcher's words for runs over them."""

    def __init__(self, folder):
        self.agent = os.path.join(folder, "agent.sh")
        with open(self.agent, "w", encoding="utf-8") as file:
            file.write(AGENT.format(host=HOSTS[1]))
        os.chmod(self.agent, 0o755)

    def __enter__(self):
        for host in HOSTS:
            subprocess.run(["ip", "netns", "del", host], stderr=subprocess.DEVNULL, check=False)
            ip("netns", "add", host)
        ip("link", "add", "link-a", "netns", HOSTS[0], "type", "veth", "peer", "name", "link-b", "netns", HOSTS[1])
        for host, link, address in zip(HOSTS, ("link-a", "link-b"), ADDRESSES):
            ip("-n", host, "address", "add", address + "/24", "dev", link)
            ip("-n", host, "link", "set", link, "up")
            ip("-n", host, "link", "set", "lo", "up")
        return self

    def __exit__(self, *_):
        for host in HOSTS:
            ip("netns", "del", host)

    def cut(self):
        ip("-n", HOSTS[0], "link", "set", "link-a", "down")

    def mend(self):
        ip("-n", HOSTS[0], "link", "set", "link-a", "up")

    def launcher(self, ranks_a, ranks_b, mpirun):
        network = ADDRESSES[0] + "/24"
        settings = {"plm_rsh_agent": self.agent, "btl": "self,vader,tcp", "btl_tcp_if_include": network, "oob_tcp_if_include": network,
                    "oob_tcp_keepalive_time": "5", "oob_tcp_keepalive_intvl": "2", "oob_tcp_keepalive_probes": "3"}
        words = ["ip", "netns", "exec", HOSTS[0], "unshare", "--uts", "sh", "-c", f'hostname {HOSTS[0]}; exec "$@"', "sh", *mpirun]
        for name, value in settings.items():
            words += ["--mca", name, value]
        return words + ["--host", f"{ADDRESSES[0]}:{ranks_a},{ADDRESSES[1]}:{ranks_b}"]


def same_bits(runs, hosts, mpirun, scene, ranks_a, ranks_b, gather="auto"):
    name = f"{scene}-{ranks_a}-{ranks_b}-{gather}"
    runs.environment["CATENA_GATHER"] = gather
    runs.launcher = mpirun
    alone = name + "-alone"
    runs.complete(ranks_a + ranks_b, alone)
    runs.launcher = hosts.launcher(ranks_a, ranks_b, mpirun)
    runs.complete(ranks_a + ranks_b, name)
    difference = runs.difference(alone, name)
    return verdict(f"{scene}, {ranks_a} and {ranks_b} ranks, gathers {gather}", not difference,
                   f"{difference + ' DIFFERS' if difference else 'the bits of one host'}")


def cut_link(runs, hosts, mpirun, gather="auto"):
    runs.environment["CATENA_GATHER"] = gather
    runs.remove("cut")
    hosts.mend()
    runs.launcher = hosts.launcher(2, 2, mpirun)
    started = runs.start(4, "cut", ["--steps", "1000000"])
    runs.wait_for_steps(started, "cut")
    time.sleep(2)
    hosts.cut()
    cut = time.monotonic()
    said = started.communicate()[0]
    took = time.monotonic() - cut
    good = started.returncode not in (0, 3) and took < SECONDS_TO_END and len(said) > 0
    line = next((each.strip() for each in said.splitlines() if "lost" in each or "catena:" in each), "NO message")
    return verdict(f"link cut, gathers {gather}", good and line != "NO message", f"status {started.returncode} after {took:.1f} s: {line}")


def resumed(runs, mpirun):
    """What was cut off goes on, on one host."""
    runs.launcher = mpirun
    step = runs.step_of("cut")
    last = str(step + 50)
    runs.complete(2, "cut", ["--restart", runs.path("cut", "checkpoint.h5"), "--steps", last])
    runs.complete(1, "uncut", ["--steps", last])
    difference = runs.difference("uncut", "cut")
    return verdict("resumed", not difference, f"from step {step}: {difference + ' DIFFERS' if difference else 'the same bits'}")


def main():
    options = arguments(__doc__)
    if os.geteuid() != 0:
        print("NOT RUN: network namespaces need root")
        sys.exit(77)
    good = []
    with Runs(options, settings=["dynamics.steps=60"]) as runs, TwoHosts(runs.folder) as hosts:
        mpirun = runs.launcher
        good += [same_bits(runs, hosts, mpirun, "beads-and-bodies", *ranks) for ranks in ((1, 1), (2, 1), (3, 3))]
        good += [same_bits(runs, hosts, mpirun, "beads-and-bodies", *ranks, "two-stage") for ranks in ((2, 1), (3, 3))]
        if "OpenMM   none" not in subprocess.run([options.catena, "--version"], capture_output=True, text=True, check=True).stdout:
            runs.scene = os.path.join(ROOT, "inputs", "alpha-synuclein.yaml")
            runs.settings = ["--set", "dynamics.steps=20", "--set", "forces.openmm.platform=Reference", "--set", "output.every=5"]
            good += [same_bits(runs, hosts, mpirun, "OpenMM", 1, 1), same_bits(runs, hosts, mpirun, "OpenMM", 2, 1)]
            runs.scene, runs.settings = os.path.join(runs.folder, "scene.yaml"), []
        good += [cut_link(runs, hosts, mpirun, "two-stage"), cut_link(runs, hosts, mpirun), resumed(runs, mpirun)]
    sys.exit(0 if all(good) else 1)


main()
