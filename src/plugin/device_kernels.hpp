// Kernels of DeviceConstraints, in OpenMM's language for all GPU platforms. OpenMM compiles them.
#pragma once

namespace catena::plugin {

/// Source of the kernels. The chains' beads stand one after the other: bead k has the link to bead
/// k - 1 if lengths[k] > 0. A thread eliminates RUN links, a group of WIDTH threads a block of
/// runs, one group the blocks. The merges are those of src/dca, for one direction per link.
inline constexpr char const* device_kernels = R"(
#ifdef USE_MIXED_PRECISION
#define CORRECTION_ARGUMENT , GLOBAL real4* RESTRICT posqCorrection
#define CORRECTION , posqCorrection
#else
#define CORRECTION_ARGUMENT
#define CORRECTION
#endif

/* Beads with forces at their two ends: motions are (a, -b; b, -c) forces + (p, q); r is asked of the inboard link. */
typedef struct {
    mixed a, b, c, p, q, r;
} Segment;

DEVICE mixed dot3(mixed4 u, mixed4 v) {
    return u.x*v.x + u.y*v.y + u.z*v.z;
}

DEVICE mixed4 positionAt(int at, GLOBAL const real4* RESTRICT posq CORRECTION_ARGUMENT) {
    real4 x = posq[at];
#ifdef USE_MIXED_PRECISION
    real4 rest = posqCorrection[at];
    return make_mixed4(x.x+(mixed) rest.x, x.y+(mixed) rest.y, x.z+(mixed) rest.z, 0);
#else
    return make_mixed4(x.x, x.y, x.z, 0);
#endif
}

/* The velocity after a kick of duration dt. */
DEVICE mixed4 kickedAt(int at, mixed dt, int padded, GLOBAL const mixed4* RESTRICT velm, GLOBAL const mm_long* RESTRICT force) {
    mixed4 v = velm[at];
    mixed scale = dt*v.w/(mixed) 0x100000000;
    return make_mixed4(v.x+scale*force[at], v.y+scale*force[at+padded], v.z+scale*force[at+2*padded], v.w);
}

/* The larger number; NaN if one is. */
DEVICE mixed worse(mixed x, mixed y) {
    return x != x || x >= y ? x : y;
}

/* Joins two segments. joint: inboard factor, outboard factor and constant of the force at their link. */
DEVICE Segment joined(Segment in, Segment out, int k, GLOBAL mixed4* RESTRICT joint) {
    mixed w = out.a+in.c;
    mixed inverse = w > 0 ? 1/w : (mixed) 0;
    mixed g = in.b*inverse, h = out.b*inverse, t = out.r+in.q-out.p;
    joint[k] = make_mixed4(g, h, t*inverse, 0);
    Segment s;
    s.a = in.a-in.b*g;
    s.b = in.b*h;
    s.c = out.c-out.b*h;
    s.p = in.p-g*t;
    s.q = out.q+h*t;
    s.r = in.r;
    return s;
}

DEVICE mixed forceAt(mixed4 joint, mixed inboard, mixed outboard) {
    return joint.z+joint.x*inboard+joint.y*outboard;
}

/* Unit directions of the links. */
KERNEL void findDirections(int beads, GLOBAL const int* RESTRICT place, GLOBAL const mixed* RESTRICT lengths, GLOBAL mixed4* RESTRICT direction,
        GLOBAL real4* RESTRICT posq CORRECTION_ARGUMENT) {
    for (int k = GLOBAL_ID; k <= beads; k += GLOBAL_SIZE) {
        mixed4 u = make_mixed4(0, 0, 0, 0);
        if (k < beads && lengths[k] > 0) {
            mixed4 d = positionAt(place[k], posq CORRECTION)-positionAt(place[k-1], posq CORRECTION);
            mixed scale = 1/sqrt(dot3(d, d));
            u = make_mixed4(scale*d.x, scale*d.y, scale*d.z, 0);
        }
        direction[k] = u;
    }
}

/* Inward pass within blocks. projecting: of the velocities after a kick, else of the length errors. */
KERNEL void assembleBlocks(int beads, int blocks, int projecting, mixed dt, int padded, GLOBAL const int* RESTRICT place, GLOBAL const mixed* RESTRICT lengths,
        GLOBAL const mixed4* RESTRICT direction, GLOBAL const mixed4* RESTRICT velm, GLOBAL const mm_long* RESTRICT force, GLOBAL mixed4* RESTRICT joint,
        GLOBAL Segment* RESTRICT segments, GLOBAL mixed* RESTRICT errors, GLOBAL real4* RESTRICT posq CORRECTION_ARGUMENT) {
    LOCAL Segment part[WIDTH];
    LOCAL mixed worst[WIDTH];
    for (int block = GROUP_ID; block < blocks; block += NUM_GROUPS) {
        int begin = (block*WIDTH+LOCAL_ID)*RUN;
        mixed error = 0;
        Segment s;
        s.a = s.b = s.c = s.p = s.q = s.r = 0;
        for (int k = begin; k < begin+RUN && k < beads; k++) {
            mixed4 u = direction[k], next = direction[k+1];
            mixed inverseMass = velm[place[k]].w;
            Segment bead;
            bead.a = inverseMass*dot3(u, u);
            bead.b = inverseMass*dot3(u, next);
            bead.c = inverseMass*dot3(next, next);
            bead.p = bead.q = bead.r = 0;
            if (lengths[k] > 0) {
                if (projecting)
                    bead.r = -dot3(u, kickedAt(place[k], dt, padded, velm, force)-kickedAt(place[k-1], dt, padded, velm, force));
                else {
                    mixed4 d = positionAt(place[k], posq CORRECTION)-positionAt(place[k-1], posq CORRECTION);
                    bead.r = lengths[k]-sqrt(dot3(d, d));
                    error = worse(error, fabs(bead.r)/lengths[k]);
                }
            }
            if (k == begin)
                s = bead;
            else
                s = joined(s, bead, k, joint);
        }
        part[LOCAL_ID] = s;
        worst[LOCAL_ID] = error;
        SYNC_THREADS;
        for (int stride = 1; stride < WIDTH; stride *= 2) {
            if ((LOCAL_ID&(2*stride-1)) == 0) {
                if (begin+stride*RUN < beads)
                    part[LOCAL_ID] = joined(part[LOCAL_ID], part[LOCAL_ID+stride], begin+stride*RUN, joint);
                worst[LOCAL_ID] = worse(worst[LOCAL_ID], worst[LOCAL_ID+stride]);
            }
            SYNC_THREADS;
        }
        if (LOCAL_ID == 0) {
            segments[block] = part[0];
            errors[block] = worst[0];
        }
        SYNC_THREADS;
    }
}

/* Both passes over the blocks, by one group. history: largest error before each sweep. */
KERNEL void solveBlocks(int blocks, int sweep, GLOBAL mixed4* RESTRICT joint, GLOBAL const Segment* RESTRICT segments, GLOBAL const mixed* RESTRICT errors,
        GLOBAL mixed* RESTRICT blockForce, GLOBAL mixed* RESTRICT history) {
    LOCAL Segment part[WIDTH];
    LOCAL mixed worst[WIDTH];
    LOCAL mixed f[WIDTH+1];
    if (GROUP_ID > 0)
        return;
    int each = (blocks+WIDTH-1)/WIDTH, begin = LOCAL_ID*each;
    mixed error = 0;
    Segment s;
    s.a = s.b = s.c = s.p = s.q = s.r = 0;
    for (int b = begin; b < begin+each && b < blocks; b++) {
        error = worse(error, errors[b]);
        if (b == begin)
            s = segments[b];
        else
            s = joined(s, segments[b], b*WIDTH*RUN, joint);
    }
    part[LOCAL_ID] = s;
    worst[LOCAL_ID] = error;
    SYNC_THREADS;
    for (int stride = 1; stride < WIDTH; stride *= 2) {
        if ((LOCAL_ID&(2*stride-1)) == 0) {
            if (begin+stride*each < blocks)
                part[LOCAL_ID] = joined(part[LOCAL_ID], part[LOCAL_ID+stride], (begin+stride*each)*WIDTH*RUN, joint);
            worst[LOCAL_ID] = worse(worst[LOCAL_ID], worst[LOCAL_ID+stride]);
        }
        SYNC_THREADS;
    }
    if (LOCAL_ID == 0) {
        f[0] = 0;
        f[WIDTH] = 0;
        if (sweep >= 0)
            history[sweep] = worse(worst[0], history[sweep]);
    }
    SYNC_THREADS;
    for (int stride = WIDTH/2; stride > 0; stride /= 2) {
        if ((LOCAL_ID&(2*stride-1)) == 0) {
            int b = begin+stride*each;
            f[LOCAL_ID+stride] = b < blocks ? forceAt(joint[b*WIDTH*RUN], f[LOCAL_ID], f[LOCAL_ID+2*stride]) : (mixed) 0;
        }
        SYNC_THREADS;
    }
    mixed outboard = f[LOCAL_ID+1];
    for (int b = min(begin+each, blocks)-1; b > begin; b--) {
        outboard = forceAt(joint[b*WIDTH*RUN], f[LOCAL_ID], outboard);
        blockForce[b] = outboard;
    }
    if (begin < blocks)
        blockForce[begin] = f[LOCAL_ID];
    if (LOCAL_ID == 0)
        blockForce[blocks] = 0;
}

/* Moves a bead by the forces at its links: velocities if projecting, else positions, with velocities as their means over dt. */
DEVICE void moveBead(int at, int projecting, mixed dt, mixed4 u, mixed inboard, mixed4 next, mixed outboard, GLOBAL mixed4* RESTRICT velm,
        GLOBAL real4* RESTRICT posq CORRECTION_ARGUMENT) {
    mixed4 v = velm[at];
    mixed4 d = make_mixed4(v.w*(u.x*inboard-next.x*outboard), v.w*(u.y*inboard-next.y*outboard), v.w*(u.z*inboard-next.z*outboard), 0);
    mixed scale = projecting ? (mixed) 1 : 1/dt;
    velm[at] = make_mixed4(v.x+scale*d.x, v.y+scale*d.y, v.z+scale*d.z, v.w);
    if (projecting)
        return;
    mixed4 x = positionAt(at, posq CORRECTION)+d;
    real4 rounded = make_real4((real) x.x, (real) x.y, (real) x.z, posq[at].w);
    posq[at] = rounded;
#ifdef USE_MIXED_PRECISION
    posqCorrection[at] = make_real4((real) (x.x-rounded.x), (real) (x.y-rounded.y), (real) (x.z-rounded.z), 0);
#endif
}

/* Outward pass within blocks, and the motion of the beads. */
KERNEL void moveBeads(int beads, int blocks, int projecting, mixed dt, GLOBAL const int* RESTRICT place, GLOBAL const mixed4* RESTRICT direction,
        GLOBAL const mixed4* RESTRICT joint, GLOBAL const mixed* RESTRICT blockForce, GLOBAL mixed4* RESTRICT velm,
        GLOBAL real4* RESTRICT posq CORRECTION_ARGUMENT) {
    LOCAL mixed f[WIDTH+1];
    for (int block = GROUP_ID; block < blocks; block += NUM_GROUPS) {
        int begin = (block*WIDTH+LOCAL_ID)*RUN;
        if (LOCAL_ID == 0) {
            f[0] = blockForce[block];
            f[WIDTH] = blockForce[block+1];
        }
        SYNC_THREADS;
        for (int stride = WIDTH/2; stride > 0; stride /= 2) {
            if ((LOCAL_ID&(2*stride-1)) == 0) {
                int k = begin+stride*RUN;
                f[LOCAL_ID+stride] = k < beads ? forceAt(joint[k], f[LOCAL_ID], f[LOCAL_ID+2*stride]) : (mixed) 0;
            }
            SYNC_THREADS;
        }
        mixed inboard = f[LOCAL_ID], outboard = f[LOCAL_ID+1];
        for (int k = min(begin+RUN, beads)-1; k >= begin; k--) {
            mixed here = k > begin ? forceAt(joint[k], inboard, outboard) : inboard;
            moveBead(place[k], projecting, dt, direction[k], here, direction[k+1], outboard, velm, posq CORRECTION);
            outboard = here;
        }
        SYNC_THREADS;
    }
}
)";

}  // namespace catena::plugin
