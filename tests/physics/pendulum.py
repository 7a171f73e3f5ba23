"""Small oscillations of a hanging pendulum of N beads on equal links in a plane: omega^2 = (g / l) x with x the roots of the Laguerre
polynomial L_N. The stiffness is read from accelerations: column j is what displacing bead j alone does to all of them, by central
differences of two sizes, extrapolated. Usage: pendulum.py [--beads N]"""
import sys

import numpy as np
from catena import Runs, arguments, verdict

LENGTH, GRAVITY, MASS = 0.7, 9.81, 1.3


def displaced(beads, j, shift):
    """Beads under each other, bead j `shift` beside: links keep their length."""
    x = np.zeros(beads)
    x[j] = shift
    z = -np.cumsum(np.sqrt(LENGTH**2 - np.diff(x, prepend=0) ** 2))
    return [[float(a), 0.0, float(b)] for a, b in zip(x, z)]


def stiffness(runs, beads, shift):
    """Minus the accelerations to the side per displacement: a chain for each bead and sign, all in one scene."""
    chains = [{"name": f"bead {j} {sign:+d}", "base": "fixed", "anchor": [0, 0, 0], "velocities": "zero",
               "bodies": [{"mass": MASS, "position": p, "joint": {"type": "link"}} for p in displaced(beads, j, sign * shift)]}
              for j in range(beads) for sign in (1, -1)]
    scene = {"units": "si", "chains": chains, "forces": {"gravity": [0, 0, -GRAVITY]}}
    sideways = np.array(runs.solve(f"pendulum-{shift:g}", scene)["joint_accelerations"])[:, 0].reshape(beads, 2, beads)
    return (sideways[:, 1] - sideways[:, 0]).T / (2 * shift)


def roots(beads):
    """Of L_N: the eigenvalues of its symmetric Jacobi matrix (Golub & Welsch 1969)."""
    k = np.arange(beads)
    return np.linalg.eigvalsh(np.diag(2.0 * k + 1) + np.diag(-1.0 * k[1:], 1) + np.diag(-1.0 * k[1:], -1))


options = arguments(__doc__, beads=20)
SHIFT = 1e-4 * LENGTH
with Runs(options) as runs:
    one, two = stiffness(runs, options.beads, SHIFT), stiffness(runs, options.beads, 2 * SHIFT)
matrix = (4 * one - two) / 3
expected = roots(options.beads)
found = np.sort(np.linalg.eigvals(matrix).real) * LENGTH / GRAVITY
error = np.abs(found / expected - 1)
# Eigenvalues move by at most the error of the (symmetric) matrix, whose largest entries are some N: what the extrapolation leaves is of
# fourth order in the shift, N-fold as large at the far end, and a rounding of N tensions counts one over the shift.
bound = options.beads * ((options.beads * SHIFT / LENGTH) ** 4 + options.beads * 2.2e-16 * LENGTH / SHIFT) / expected
for i in (0, 1, options.beads - 1):
    print(f"        omega_{i + 1} = {np.sqrt(found[i] * GRAVITY / LENGTH):.12f} 1/s, Laguerre {np.sqrt(expected[i] * GRAVITY / LENGTH):.12f}")
sys.exit(0 if verdict("pendulum", np.all(error <= bound),
                      f"{options.beads} squared frequencies within {error.max():.1e} of Laguerre's (worst error over bound {np.max(error / bound):.2f})") else 1)
