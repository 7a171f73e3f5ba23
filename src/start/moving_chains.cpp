// Implements the motion of chains of beads and domains on links.
#include "start/moving_chains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "generate/crosslinks.hpp"

namespace catena {

MovingChain::MovingChain(ChainSpec& chain, std::size_t first_bead)
    : chain_(chain), first_(first_bead), parents_(scene::unit_parents(chain.parent, chain.base)) {
    stand_.at = chain.is_beads() ? chain.beads.position : chain.linked.position;
    for (auto const& q : chain.linked.orientation)
        stand_.rotation.push_back({q[0], q[1], q[2], q[3]});
    weight_.assign(units(), 1), squares_.assign(units(), 0), widest_.assign(units(), 0);
    for (std::size_t u = 0; u < units() && !chain.is_beads(); ++u) {
        weight_[u] = static_cast<double>(begin_of(u + 1) - begin_of(u));
        for (std::size_t b = begin_of(u); b < begin_of(u + 1) && !chain.linked.is_bead(u); ++b) {
            double const arm = norm(chain.linked.carried.position[b]);
            squares_[u] += arm * arm, widest_[u] = std::max(widest_[u], arm);
        }
    }
}

std::size_t MovingChain::begin_of(std::size_t unit) const {
    return static_cast<std::size_t>(chain_.linked.carried.offset[unit]);
}

UnitMotion MovingChain::acceleration(std::size_t unit, std::vector<Vec3> const& forces) const {
    if (chain_.is_beads()) return {forces[first_ + unit], Vec3::zero()};
    if (weight_[unit] == 0) return {};
    Mat3 const r = to_matrix(stand_.rotation[unit]);
    Vec3 force = Vec3::zero(), torque = Vec3::zero();
    for (std::size_t b = begin_of(unit); b < begin_of(unit + 1); ++b) {
        force = force + forces[first_ + b];
        torque = torque + cross(r * chain_.linked.carried.position[b], forces[first_ + b]);
    }
    return {(1 / weight_[unit]) * force,
            squares_[unit] > 0 ? (1 / squares_[unit]) * torque : Vec3::zero()};
}

double MovingChain::product(std::size_t unit, UnitMotion const& x, UnitMotion const& y) const {
    return weight_[unit] * dot(x.shift, y.shift) + squares_[unit] * dot(x.rotation, y.rotation);
}

double MovingChain::size(std::size_t unit, UnitMotion const& motion) const {
    return std::max(norm(motion.shift), norm(motion.rotation) * widest_[unit]);
}

bool MovingChain::move(std::span<UnitMotion> by) {
    Stand before = stand_;
    for (std::size_t u = 0; u < units(); ++u) {
        // Shifts and rotations are applied first; the projection then moves units without rotating
        // them.
        stand_.at[u] = stand_.at[u] + by[u].shift;
        if (dot(by[u].rotation, by[u].rotation) > 0)
            stand_.rotation[u] =
                normalized(from_rotation_vector(by[u].rotation) * stand_.rotation[u]);
    }
    if (!close()) {
        stand_ = std::move(before);
        return false;
    }
    for (std::size_t u = 0; u < units(); ++u) by[u].shift = stand_.at[u] - before.at[u];
    return true;
}

void MovingChain::put_beads(std::vector<Vec3>& positions) const {
    for (std::size_t u = 0; u < units(); ++u) {
        if (chain_.is_beads()) {
            positions[first_ + u] = stand_.at[u];
            continue;
        }
        Mat3 const r = to_matrix(stand_.rotation[u]);
        for (std::size_t b = begin_of(u); b < begin_of(u + 1); ++b)
            positions[first_ + b] = stand_.at[u] + r * chain_.linked.carried.position[b];
    }
}

void MovingChain::write() {
    (chain_.is_beads() ? chain_.beads.position : chain_.linked.position) = stand_.at;
    for (std::size_t u = 0; u < stand_.rotation.size(); ++u) {
        Quat const& q = stand_.rotation[u];
        chain_.linked.orientation[u] = {q.w, q.x, q.y, q.z};
    }
}

std::vector<std::span<std::byte>> MovingChain::bytes() {
    return {std::as_writable_bytes(std::span(stand_.at)),
            std::as_writable_bytes(std::span(stand_.rotation))};
}

bool MovingChain::close() {
    if (chain_.is_cross_linked()) return scene::project_links(chain_, stand_.at);
    std::vector<Vec3> at, inboard, outboard;
    std::vector<double> length, mobility;
    bool const beads = chain_.is_beads(), fixed = chain_.base == Base::fixed;
    auto const add = [&](Vec3 const& p, double l, double m, Vec3 const& in, Vec3 const& out) {
        at.push_back(p), length.push_back(l), mobility.push_back(m), inboard.push_back(in),
            outboard.push_back(out);
    };
    Vec3 const none = Vec3::zero();
    if (fixed) add(beads ? chain_.beads.anchor : chain_.linked.anchor, 0, 0, none, none);
    for (std::size_t u = 0; u < units(); ++u) {
        if (beads) {
            add(stand_.at[u], chain_.beads.length[u], 1, none, none);
            continue;
        }
        LinkedArrays const& linked = chain_.linked;
        Mat3 const r = to_matrix(stand_.rotation[u]);
        add(stand_.at[u], linked.length[u], 1 / std::max(1.0, weight_[u]), r * linked.inboard[u],
            r * linked.outboard[u]);
    }
    TipJoint const& tip = chain_.tip_joint;
    bool const jointed = chain_.tip == Tip::jointed;
    if (jointed && !tip.ring) add(*tip.anchor, tip.length, 0, none, none);
    bool const closed = links_.project(
        {at, length, mobility, inboard, outboard, jointed && tip.ring ? tip.length : 0, parents_});
    std::copy_n(at.begin() + (fixed ? 1 : 0), units(), stand_.at.begin());
    return closed;
}

std::vector<MovingChain> moving_chains(Scene& scene) {
    std::vector<MovingChain> moving;
    std::size_t bead = 0;
    for (ChainSpec& chain : scene.chains) {
        if (chain.bead_count() == 0) continue;  // no forces act on it
        if (!chain.is_beads() && !chain.is_linked())
            throw InputError(fmt::format("`relax` moves beads and rigid domains on links, but "
                                         "chain `{}` has other joints",
                                         chain.name),
                             scene.file + ": relax",
                             "leave `relax` out, or give that chain a start without overlaps");
        moving.emplace_back(chain, bead);
        bead += chain.bead_count();
    }
    return moving;
}

}  // namespace catena
