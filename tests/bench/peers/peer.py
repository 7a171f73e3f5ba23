"""What peers written in Python share: the table of a chain that Catena writes (`bench peers`, the stability suite), and its questions.

The table: rows of 42 doubles. Row 0: columns, bodies, gravity (3, ground axes). Row k: body k and joint k, by which it hangs on body k-1
(body 0: the ground): mass; com (from the joint, body axes); inertia about com (xx yy zz xy xz yz); joint type; axis (body axes); rotation
(9, row by row) and translation of the joint frame in body k-1's axes; q (4: angle, or quaternion w x y z), qd (3) and torque (3; of ball
joints in body axes); torque and force on the body (at com, ground axes). Joint accelerations go back as they come, 1, 3, 3 and 2 a joint:
revolute; ball (derivative of the angular velocity's components in body axes); slide along the ground's axes; universal (about x, then y)."""
import json
import resource
import sys
import time

import numpy as np

REVOLUTE, BALL, SLIDE, UNIVERSAL = range(4)


class Body:
    def __init__(self, row):
        self.mass, self.com, moments, self.kind = row[0], row[1:4], row[4:10], int(row[10])
        self.moments = moments
        self.inertia = np.array([[moments[0], moments[3], moments[4]], [moments[3], moments[1], moments[5]], [moments[4], moments[5], moments[2]]])
        self.axis, self.rotation, self.translation = row[11:14], row[14:23].reshape(3, 3), row[23:26]
        self.dof = (1, 3, 3, 2)[self.kind]
        self.q, self.qd, self.torque = row[26:30], row[30:30 + self.dof], row[33:33 + self.dof]
        self.wrench_torque, self.wrench_force = row[36:39], row[39:42]


class Chain:
    def __init__(self, file):
        table = np.fromfile(file)
        table = table.reshape(-1, int(table[0]))
        self.gravity = table[0, 2:5]
        self.bodies = [Body(row) for row in table[1:]]


def prepare(name, version, method, build):
    """The function that evaluates, after it has done so once."""
    chain_file, accelerations_file = sys.argv[1:3]
    try:
        chain = Chain(chain_file)
        start = time.perf_counter()
        evaluate = build(chain)
        accelerations = evaluate()
        ready = time.perf_counter() - start
    except Exception as error:   # whatever stops a peer is a finding
        print(json.dumps({"stops": f"{type(error).__name__}: {' '.join(str(error).split()) or 'no memory left'}"}), flush=True)
        sys.exit(1)
    np.asarray(accelerations, dtype=float).tofile(accelerations_file)
    print(json.dumps({"name": name, "version": version, "method": method, "set_up_seconds": ready,
                      "memory_bytes": 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss}), flush=True)
    return evaluate


def serve(name, version, method, build):
    """`build(chain)` returns a function that evaluates once and returns the joint accelerations. Then lines come in until the input ends: a
    count, for which the seconds of so many evaluations go out, or `next`: the file holds another chain, everything begins anew."""
    evaluate = prepare(name, version, method, build)
    for line in sys.stdin:
        if line.strip() == "next":
            evaluate = None   # its memory goes first
            evaluate = prepare(name, version, method, build)
            continue
        count = int(line)
        start = time.perf_counter()
        for _ in range(count):
            evaluate()
        print(repr(time.perf_counter() - start), flush=True)
