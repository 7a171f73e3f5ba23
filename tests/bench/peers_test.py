"""`catena bench peers`: those that are here agree with Catena on short chains, and what a peer does wrong is said: of a module in MuJoCo's
place that dies, and of one whose answers are zero. Status 77 where no peer is here. Usage: peers_test.py --catena PROGRAM"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

MODULE = """
import os
import numpy as np
__version__ = "false"
class mjtDisableBit: mjDSBL_CONTACT = mjDSBL_CONSTRAINT = mjDSBL_ACTUATION = mjDSBL_SENSOR = 0
class mjtJoint: mjJNT_HINGE = mjJNT_SLIDE = mjJNT_BALL = 0
class Body:
    joints = 0
    def add_body(self, **_): return Body()
    def add_joint(self, **_): Body.joints += 1
class MjSpec:
    worldbody = Body()
    class option: pass
    def compile(self): return self
class MjData:
    def __init__(self, _):
        self.qpos, self.qvel, self.qfrc_applied, self.qacc = (np.zeros(Body.joints) for _ in range(4))
        self.xfrc_applied = np.zeros((Body.joints + 1, 6))
def mju_mat2Quat(q, r): pass
def mj_forward(model, data): {answer}
"""


def bench(catena, joints, sizes, module=None):
    with tempfile.TemporaryDirectory() as folder:
        environment = dict(os.environ)
        if module:
            environment["PYTHONPATH"] = folder
            with open(os.path.join(folder, "mujoco.py"), "w") as file:
                file.write(module)
        done = subprocess.run([catena, "bench", "peers", "--joints", joints, "--sizes", sizes, "--repeat", "3", "--backend", "segments", "--json", "-"],
                              env=environment, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"catena bench peers ended with status {done.returncode}: {done.stderr}")
    return json.loads(done.stdout)


def rows(found, key):
    return [r for r in found["results"] if key in r]


def check(good, text):
    print(f"{'passed' if good else 'FAILED'}  {text}")
    return good


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--catena", required=True)
catena = parser.parse_args().catena

found = bench(catena, "link,spherical,revolute,planar", "1,2,5")
for peer in found["peers"]:
    if "not_run" in peer:
        print(f"NOT RUN: {peer['name']}: {peer['not_run']}")
good = check(all(r["valid"] for r in rows(found, "backend")), f"{len(rows(found, 'backend'))} rows of Catena's are VALID")
for name in dict.fromkeys(r["peer"] for r in rows(found, "peer")):
    own = [r for r in rows(found, "peer") if r["peer"] == name]
    good &= check(all(r["valid"] for r in own), f"{name} agrees on {len(own)} chains to {max(r['forward_error'] for r in own):.1e}")

dying = bench(catena, "revolute", "2,5", MODULE.format(answer="os.kill(os.getpid(), 11)"))
if any(p["name"] == "mujoco" and "not_run" in p for p in dying["peers"]):
    print("NOT RUN: modules in MuJoCo's place: no Python here has numpy")
else:
    why = [s["why"] for s in dying["stops"] if s["peer"] == "mujoco"]
    good &= check(len(why) == 1 and why[0].startswith("ended by signal 11"), f"a peer that dies is said to stop, once: {why}")
    false = [r for r in rows(bench(catena, "revolute", "2", MODULE.format(answer="pass")), "peer") if r["peer"] == "mujoco"]
    good &= check(len(false) == 1 and not false[0]["valid"], "a peer whose answers are zero is INVALID")
sys.exit(1 if not good else 77 if not rows(found, "peer") else 0)
