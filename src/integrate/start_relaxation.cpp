#include "integrate/start_relaxation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "error.hpp"
#include "integrate/bead_system.hpp"
#include "integrate/lone_forces.hpp"
#include "mpi/first_rank.hpp"
#include "scene/link_projection.hpp"

namespace catena {
namespace {

std::int64_t constexpr most_steps = 3000;
int constexpr window = 100;            // steps in which the energy must fall ...
double constexpr least_fall = 0.02;    // ... by this part of the thermal energy
double constexpr cap = 0.02;           // nm: the furthest that a bead goes in a step
double constexpr first_way = 0.005;    // nm
double constexpr shortest_way = 1e-7;  // nm
double constexpr full_force = 400;     // kT/nm: a bead that feels more goes as far as any

/// Where the units of one chain of beads and domains stand.
struct Stand {
    std::vector<Vec3> at;
    std::vector<Quat> turn;  // of linked chains
};

/// One chain of beads, or of beads and domains on links.
class MovingChain {
  public:
    MovingChain(ChainSpec& chain, std::size_t first_bead) : chain_(chain), first_(first_bead) {
        stand_.at = chain.is_beads() ? chain.beads.position : chain.linked.position;
        for (auto const& q : chain.linked.orientation) stand_.turn.push_back({q[0], q[1], q[2], q[3]});
    }

    /// Forces on beads are of the whole scene. `full`: the force from which on a unit goes `way`. Whether the links could be closed.
    bool move(std::vector<Vec3> const& forces, double way, double full) {
        for (std::size_t u = 0; u < stand_.at.size(); ++u)
            chain_.is_beads() ? push_bead(u, forces[first_ + u], way, full) : push_body(u, forces, way, full);
        return close();
    }
    void put_beads(std::vector<Vec3>& positions) const {
        for (std::size_t u = 0; u < stand_.at.size(); ++u) {
            if (chain_.is_beads()) {
                positions[first_ + u] = stand_.at[u];
                continue;
            }
            Mat3 const r = to_matrix(stand_.turn[u]);
            for (std::size_t b = begin_of(u); b < begin_of(u + 1); ++b)
                positions[first_ + b] = stand_.at[u] + r * chain_.linked.carried.position[b];
        }
    }
    Stand const& stand() const { return stand_; }
    void return_to(Stand const& stand) { stand_ = stand; }
    void write() {
        (chain_.is_beads() ? chain_.beads.position : chain_.linked.position) = stand_.at;
        for (std::size_t u = 0; u < stand_.turn.size(); ++u) {
            Quat const& q = stand_.turn[u];
            chain_.linked.orientation[u] = {q.w, q.x, q.y, q.z};
        }
    }
    /// Where units stand, as numbers for other ranks.
    std::vector<std::span<std::byte>> bytes() {
        return {std::as_writable_bytes(std::span(stand_.at)), std::as_writable_bytes(std::span(stand_.turn))};
    }

  private:
    std::size_t begin_of(std::size_t unit) const { return static_cast<std::size_t>(chain_.linked.carried.offset[unit]); }

    void push_bead(std::size_t u, Vec3 const& force, double way, double full) {
        stand_.at[u] = plus_scaled(stand_.at[u], way / std::max(norm(force), full), force);
    }

    /// A body goes by the mean force on its beads and turns by their torque over the sum of their squared distances from its centre.
    void push_body(std::size_t u, std::vector<Vec3> const& forces, double way, double full) {
        Mat3 const r = to_matrix(stand_.turn[u]);
        Vec3 force = Vec3::zero(), torque = Vec3::zero();
        double squares = 0, widest = 0;
        std::size_t const begin = begin_of(u), end = begin_of(u + 1);
        for (std::size_t b = begin; b < end; ++b) {
            Vec3 const arm = r * chain_.linked.carried.position[b];
            force = force + forces[first_ + b];
            torque = torque + cross(arm, forces[first_ + b]);
            squares += dot(arm, arm), widest = std::max(widest, norm(arm));
        }
        if (begin == end) return;
        push_bead(u, (1 / static_cast<double>(end - begin)) * force, way, full);
        if (!(squares > 0) || chain_.linked.is_bead(u)) return;
        Vec3 const turn = (1 / squares) * torque;
        double const size = norm(turn) * widest;
        if (size == 0) return;
        stand_.turn[u] = normalized(from_rotation_vector((way / std::max(size, full)) * turn) * stand_.turn[u]);
    }

    bool close() {
        std::vector<Vec3> at, inboard, outboard;
        std::vector<double> length, mobility;
        bool const beads = chain_.is_beads(), fixed = chain_.base == Base::fixed;
        auto const add = [&](Vec3 const& p, double l, double m, Vec3 const& in, Vec3 const& out) {
            at.push_back(p), length.push_back(l), mobility.push_back(m), inboard.push_back(in), outboard.push_back(out);
        };
        Vec3 const none = Vec3::zero();
        if (fixed) add(beads ? chain_.beads.anchor : chain_.linked.anchor, 0, 0, none, none);
        for (std::size_t u = 0; u < stand_.at.size(); ++u) {
            if (beads) {
                add(stand_.at[u], chain_.beads.length[u], 1, none, none);
                continue;
            }
            LinkedArrays const& linked = chain_.linked;
            Mat3 const r = to_matrix(stand_.turn[u]);
            double const weight = std::max(1.0, static_cast<double>(begin_of(u + 1) - begin_of(u)));
            add(stand_.at[u], linked.length[u], 1 / weight, r * linked.inboard[u], r * linked.outboard[u]);
        }
        TipJoint const& tip = chain_.tip_joint;
        bool const jointed = chain_.tip == Tip::jointed;
        if (jointed && !tip.ring) add(*tip.anchor, tip.length, 0, none, none);
        bool const closed =
            scene::LinkProjection().project({at, length, mobility, inboard, outboard, jointed && tip.ring ? tip.length : 0});
        std::copy_n(at.begin() + (fixed ? 1 : 0), stand_.at.size(), stand_.at.begin());
        return closed;
    }

    ChainSpec& chain_;
    std::size_t first_;  // bead in the scene
    Stand stand_;
};

std::vector<MovingChain> moving_chains(Scene& scene) {
    std::vector<MovingChain> moving;
    std::size_t bead = 0;
    for (ChainSpec& chain : scene.chains) {
        if (chain.bead_count() == 0) continue;  // it feels nothing
        if (chain.is_beads() || chain.is_linked()) {
            moving.emplace_back(chain, bead);
        } else {
            throw InputError(fmt::format("`relax` moves beads and rigid domains on links, chain `{}` has other joints", chain.name),
                             scene.file + ": relax", "leave `relax` out, or give that chain a start without overlaps");
        }
        bead += chain.bead_count();
    }
    return moving;
}

/// Steps down the forces, shorter after one that does not lower the energy, which is taken back.
class Descent {
  public:
    Descent(Scene const& scene, std::vector<MovingChain>& chains, LoneForces& forces)
        : scene_(scene),
          chains_(chains),
          forces_(forces),
          at_(bead_positions_of(scene)),
          full_(full_force * scene.boltzmann() * scene.forces.openmm->temperature),
          now_(forces_.at(at_)) {}

    StartForces look() const { return start_forces_of(scene_, forces_.beads(), at_, now_.forces, now_.energy); }
    std::vector<Vec3> const& at() const { return at_; }

    /// How many steps it took.
    std::int64_t run() {
        double const fall = least_fall * look().thermal;
        double before = now_.energy;
        std::int64_t step = 0;
        while (step < most_steps && way_ > shortest_way) {
            descend();
            if (++step % window != 0) continue;
            if (before - now_.energy < fall) break;
            before = now_.energy;
        }
        return step;
    }

  private:
    void descend() {
        std::vector<Stand> back;
        for (MovingChain const& chain : chains_) back.push_back(chain.stand());
        std::vector<Vec3> at = at_;
        bool closed = true;
        for (MovingChain& chain : chains_) closed = chain.move(now_.forces, way_, full_) && closed;
        for (MovingChain const& chain : chains_) chain.put_beads(at);
        if (closed) {
            LoneForces::Evaluation next = forces_.at(at);
            if (next.energy <= now_.energy) {
                way_ = std::min(1.2 * way_, cap);
                at_ = std::move(at), now_ = std::move(next);
                return;
            }
        }
        for (std::size_t c = 0; c < chains_.size(); ++c) chains_[c].return_to(back[c]);
        way_ *= 0.3;
    }

    Scene const& scene_;
    std::vector<MovingChain>& chains_;
    LoneForces& forces_;
    std::vector<Vec3> at_;
    double full_, way_ = first_way;
    LoneForces::Evaluation now_;
};

double furthest(std::vector<Vec3> const& a, std::vector<Vec3> const& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, norm(a[i] - b[i]));
    return most;
}

StartRelaxation relax_alone(Scene const& scene, std::vector<MovingChain>& chains) {
    LoneForces forces(scene);
    Descent descent(scene, chains, forces);
    StartRelaxation found;
    found.from = descent.look();
    std::vector<Vec3> const given = descent.at();
    found.steps = descent.run();
    found.to = descent.look();
    found.moved = furthest(given, descent.at());
    refuse_absurd(scene, found.to, true);
    return found;
}

}  // namespace

std::string StartRelaxation::text() const {
    return fmt::format("{} steps, beads moved by up to {:.3g} nm: from {} to {}", steps, moved, from.text(), to.text());
}

RelaxedScene relax_start(Scene const& scene, Communicator const& communicator) {
    if (!scene.forces.openmm)
        throw InputError("`relax` needs forces between beads, the scene has no forces.openmm", scene.file + ": relax",
                         "leave it out, or add `forces: {openmm: ...}`");
    RelaxedScene made{scene, {}};
    std::vector<MovingChain> chains = moving_chains(made.scene);
    on_first_rank(communicator, [&] { made.relaxation = relax_alone(scene, chains); });
    for (MovingChain& chain : chains) {
        for (std::span<std::byte> const part : chain.bytes()) communicator.broadcast(part);
        chain.write();
    }
    return made;
}

std::optional<RelaxedScene> relaxed_where_asked(Scene const& scene, Communicator const& communicator) {
    return scene.relax ? std::optional(relax_start(scene, communicator)) : std::nullopt;
}

}  // namespace catena
