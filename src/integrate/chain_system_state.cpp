// State, results and energies of a ChainSystem: collection, exchange between ranks and restoring.
#include "integrate/chain_system.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "chain/gather.hpp"
#include "error.hpp"
#include "mpi/collectives.hpp"
#include "mpi/first_rank.hpp"
#include "terms/force_terms.hpp"

namespace catena {
namespace {

/// Returns the components of all vectors, one vector after the other.
std::vector<double> flat(std::vector<Vec3> const& values) {
    std::vector<double> out;
    out.reserve(3 * values.size());
    for (Vec3 const& v : values) out.insert(out.end(), v.data, v.data + 3);
    return out;
}
/// Inverse of flat().
std::vector<Vec3> triples(std::vector<double> const& values) {
    std::vector<Vec3> out(values.size() / 3);
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = {{values[3 * i], values[3 * i + 1], values[3 * i + 2]}};
    return out;
}

/// Stores a quantity of pieces' first bodies as one entry per body; zeros elsewhere.
std::vector<double> at_starts(ChainGroup const& group, Field<3> const& of_piece) {
    std::vector<Vec3> of_body(static_cast<std::size_t>(group.size), Vec3::zero());
    for (std::size_t p = 0; p < group.pieces.size(); ++p)
        if (group.pieces[p].starts)
            of_body[static_cast<std::size_t>(group.pieces[p].local)] =
                of_piece[static_cast<std::int64_t>(p)];
    return flat(of_body);
}
/// Inverse of at_starts().
Field<3> of_starts(ChainGroup const& group, std::vector<Vec3> const& of_body) {
    Field<3> of_piece(std::ssize(group.pieces));
    for (std::size_t p = 0; p < group.pieces.size(); ++p)
        of_piece.set(static_cast<std::int64_t>(p),
                     of_body[static_cast<std::size_t>(group.pieces[p].local)]);
    return of_piece;
}

}  // namespace

std::size_t ChainSystem::index_of(ChainGroup const& group) const {
    auto const found = std::find_if(groups_.begin(), groups_.end(),
                                    [&](auto const& g) { return g.get() == &group; });
    return static_cast<std::size_t>(found - groups_.begin());
}

/// Each row belongs to a body. It holds position and velocity; orientation and angular velocity if
/// bodies can rotate; then joint force, joint coordinates and joint rates if asked for.
ChainSystem::OwnBodies ChainSystem::own_bodies(bool joint_forces, bool joint_states,
                                               std::vector<std::vector<double>> rows) {
    bool const turning = std::any_of(groups_.begin(), groups_.end(),
                                     [](auto const& group) { return !group->beads; });
    OwnBodies own{{turning, joint_forces, joint_states}, std::move(rows)};
    int const width = own.columns.width();
    own.rows.resize(groups_.size());
    std::vector<BodyResults> const found = joint_forces ? results() : std::vector<BodyResults>();
    std::size_t result = 0;
    auto const add = [&](ChainGroup const& group, auto const& row,
                         JointState const* joints = nullptr) {
        std::vector<double>& of_group = own.rows[index_of(group)];
        of_group.resize(static_cast<std::size_t>(group.size * width));
        executor_->for_each(group.size, [&](std::int64_t k) {
            double* to = of_group.data() + k * width;
            auto const put = [&to](double const* numbers, int count) {
                to = std::copy_n(numbers, count, to);
            };
            row(k, put);
            if (joint_forces) put(found[result].joint_force[static_cast<std::size_t>(k)].data, 6);
            if (!joint_states || joints == nullptr) return;
            put(Vector<double, 4>(joints->q[k]).data, 4);
            put(Vec3(joints->qd[k]).data, 3);
        });
        ++result;
    };
    for (auto const& group : absolute_) {
        ObservedMotion const observed = group->observed();
        add(group->group(), [&](std::int64_t k, auto const& put) {
            static constexpr double at_rest[] = {1, 0, 0, 0, 0, 0, 0};
            put(observed.position.load(k).data, 3);
            put(observed.velocity.load(k).data, 3);
            if (!turning) return;
            if (group->group().beads) return put(at_rest, 7);
            put(observed.orientation.load(k).data, 4);
            put(observed.omega.load(k).data, 3);
        });
    }
    for (auto const& dynamics : joint_) {
        ChainGroup const& group = dynamics->group();
        BodyMotion const motion = dynamics->motion();
        std::optional<JointState> joints;
        if (joint_states) joints = dynamics->state();
        auto const row = [&](std::int64_t k, auto const& put) {
            Vector<double, 4> const q = motion.orientation[k];
            Mat3 const rotation = to_matrix(Quat{q[0], q[1], q[2], q[3]});
            Vec3 const omega = motion.omega[k], x = motion.origin[k] - rotation * group.r1[k];
            Vec3 const v = rotation * (motion.velocity[k] - cross(omega, group.r1[k]));
            put(x.data, 3);
            put(v.data, 3);
            put(q.data, 4);
            put(omega.data, 3);
        };
        add(group, row, joints ? &*joints : nullptr);
    }
    return own;
}

namespace {

/// Converts rows of own_bodies() into motions; the first row is body `first` of the scene.
ChainSystem::Bodies bodies_of(ChainSystem::BodyColumns const& columns, std::int64_t first,
                              std::span<double const> values, Executor const& executor) {
    ChainSystem::Bodies bodies;
    bodies.first = first;
    ChainSystem::Snapshot& motion = bodies.motion;
    std::size_t const count = values.size() / static_cast<std::size_t>(columns.width());
    motion.position.resize(count);
    motion.velocity.resize(count);
    motion.orientation.resize(count, Quat::identity());
    motion.omega.resize(count, Vec3::zero());
    if (columns.joint_forces) bodies.joint_force.resize(count);
    if (columns.joint_states) {
        bodies.joint_position.resize(count);
        bodies.joint_rate.resize(count);
    }
    executor.for_each(static_cast<std::int64_t>(count), [&](std::int64_t body) {
        auto const k = static_cast<std::size_t>(body);
        double const* row = values.data() + body * columns.width();
        auto const next = [&] { return *row++; };
        auto const three = [&] { return Vec3{{next(), next(), next()}}; };
        motion.position[k] = three();
        motion.velocity[k] = three();
        if (columns.turning) {
            motion.orientation[k] = Quat{next(), next(), next(), next()};
            motion.omega[k] = three();
        }
        if (columns.joint_forces)
            bodies.joint_force[k] = {{next(), next(), next(), next(), next(), next()}};
        if (!columns.joint_states) return;
        bodies.joint_position[k] = {next(), next(), next(), next()};
        bodies.joint_rate[k] = three();
    });
    return bodies;
}

}  // namespace

void ChainSystem::pass_bodies(OwnBodies const& own,
                              std::function<void(Bodies const&)> const& take) const {
    SceneWindows(communicator_, groups_)
        .pass(own.columns.width(), own.rows,
              [&](std::int64_t first, std::span<double const> values) {
                  take(bodies_of(own.columns, first, values, *executor_));
              });
}

void ChainSystem::pass_bodies(AllBodies const& all,
                              std::function<void(Bodies const&)> const& take) const {
    auto const width = static_cast<std::size_t>(all.columns.width());
    std::size_t const length = std::max<std::size_t>(
                          SceneWindows::usual_bytes / (width * sizeof(double)), 1),
                      bodies = all.rows.size() / width;
    for (std::size_t first = 0; first < bodies; first += length) {
        std::size_t const count = std::min(length, bodies - first);
        take(bodies_of(all.columns, static_cast<std::int64_t>(first),
                       std::span(all.rows).subspan(first * width, count * width), *executor_));
    }
}

ChainSystem::AllBodies ChainSystem::gather_bodies(OwnBodies const& own,
                                                  std::vector<double> rows) const {
    int const width = own.columns.width();
    if (communicator_.rank() == 0) rows.resize(static_cast<std::size_t>(scene_.bodies() * width));
    SceneWindows(communicator_, groups_).gather(width, own.rows, rows);
    return {own.columns, std::move(rows)};
}

void ChainSystem::pass_own_bodies(
    OwnBodies const& own, std::function<void(std::vector<Bodies> const&)> const& take) const {
    SceneWindows(communicator_, groups_)
        .pass_own(own.columns.width(), own.rows, [&](std::vector<SceneWindows::Own> const& round) {
            std::vector<Bodies> bodies(round.size());
            executor_->for_each_of_many_or_few(std::ssize(round), [&](std::int64_t i,
                                                                      Executor const& within) {
                auto const& [first, values] = round[static_cast<std::size_t>(i)];
                bodies[static_cast<std::size_t>(i)] = bodies_of(own.columns, first, values, within);
            });
            take(bodies);
        });
}

ChainSystem::Snapshot ChainSystem::snapshot() {
    Snapshot all;
    auto const append = [](auto& to, auto const& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    pass_bodies(false, [&](Bodies const& bodies) {
        append(all.position, bodies.motion.position);
        append(all.velocity, bodies.motion.velocity);
        append(all.omega, bodies.motion.omega);
        append(all.orientation, bodies.motion.orientation);
    });
    return all;
}

bool ChainSystem::is_free_of_potentials() const {
    return !terms::has_potential(scene_) &&
           std::all_of(groups_.begin(), groups_.end(),
                       [](auto const& group) { return group->beads; });
}

std::vector<EnergyTerm> ChainSystem::potential_energy() {
    std::vector<terms::EnergyColumn> const columns = terms::energy_columns(scene_);
    auto const width = static_cast<int>(columns.size());
    std::vector<std::vector<double>> own(groups_.size());
    auto const add = [&](ChainGroup const& group, PotentialEnergy const& e) {
        std::vector<double>& rows = own[index_of(group)];
        rows.reserve(static_cast<std::size_t>(group.size * width));
        for (auto k = std::size_t{0}; k < static_cast<std::size_t>(group.size); ++k)
            for (terms::EnergyColumn const& column : columns) rows.push_back(e[column.place][k]);
    };
    std::vector<EnergyTerm> terms;
    for (terms::EnergyColumn const& column : columns) terms.push_back({column.name, 0.0});
    if (is_free_of_potentials()) {
        for (auto const& group : absolute_) group->settle_forces();
    } else {
        for (auto const& group : absolute_) add(group->group(), group->potential());
        for (auto const& group : joint_) add(group->group(), group->potential());
        SceneWindows(communicator_, groups_)
            .pass(width, own, [&](std::int64_t, std::span<double const> values) {
                for (std::size_t i = 0; i < values.size(); ++i)
                    terms[i % static_cast<std::size_t>(width)].value += values[i];
            });
    }
    if (openmm_)
        for (EnergyTerm const& term : openmm_->energies()) terms.push_back(term);
    return terms;
}

std::vector<BodyResults> ChainSystem::results() const {
    std::vector<BodyResults> all;
    for (auto const& group : absolute_) all.push_back(group->results());
    for (auto const& group : joint_) all.push_back(group->results());
    return all;
}

std::vector<Vector<double, 6>> ChainSystem::joint_forces(
    std::vector<BodyResults> const& results) const {
    std::vector<double> all(
        communicator_.rank() == 0 ? static_cast<std::size_t>(6 * scene_.bodies()) : 0);
    auto const add = [&](ChainGroup const& group, BodyResults const& r) {
        std::vector<double> own;
        for (Vector<double, 6> const& w : r.joint_force) own.insert(own.end(), w.data, w.data + 6);
        gather_to_scene(communicator_, group, 6, own, all);
    };
    for (std::size_t i = 0; i < absolute_.size(); ++i) add(absolute_[i]->group(), results[i]);
    for (std::size_t i = 0; i < joint_.size(); ++i)
        add(joint_[i]->group(), results[absolute_.size() + i]);
    std::vector<Vector<double, 6>> forces(all.size() / 6);
    for (std::size_t i = 0; i < all.size(); ++i) forces[i / 6][static_cast<int>(i % 6)] = all[i];
    return forces;
}

std::vector<Vec3> ChainSystem::bead_forces() const {
    if (!openmm_) return {};
    std::vector<std::int64_t> const& first = bead_system_.first_of_rank;
    std::vector<std::int64_t> counts;
    for (int rank = 0; rank < communicator_.size(); ++rank)
        counts.push_back(first[rank + 1] - first[rank]);
    std::vector<Vec3> own;
    Field<3> again;
    if (on_device()) {
        // Each Context computes its forces anew into the array whose sums the chains may not have
        // read: potential() lets them.
        for (auto const& group : absolute_) group->potential();
        again = Field<3>(openmm_force_.size());
        openmm_->forces_again(again.view());
    }
    Field<3> const& force = on_device() ? again : openmm_force_;
    for (std::int64_t k = 0; k < force.size(); ++k) own.push_back(force[k]);
    std::vector<Vec3> all = catena::gathered(communicator_, own, counts);
    if (bead_system_.by_rank.empty()) return all;
    std::vector<Vec3> ordered(all.size());
    for (std::size_t i = 0; i < all.size(); ++i)
        ordered[static_cast<std::size_t>(bead_system_.by_rank[i])] = all[i];
    return ordered;
}

std::vector<TipForce> ChainSystem::tip_forces(std::vector<BodyResults> const& results) const {
    std::vector<TipForce> own;
    for (BodyResults const& r : results)
        own.insert(own.end(), r.tip_force.begin(), r.tip_force.end());
    std::vector<TipForce> all = gathered_blocks(communicator_, own).values;
    std::sort(all.begin(), all.end(),
              [](TipForce const& a, TipForce const& b) { return a.chain < b.chain; });
    return all;
}

ChainSystem::Accelerations ChainSystem::accelerations() {
    std::size_t const n = communicator_.rank() == 0 ? static_cast<std::size_t>(scene_.bodies()) : 0;
    std::vector<double> joint(3 * n), body(3 * n), base(3 * n), alpha(3 * n);
    auto const add = [&](ChainGroup const& group, BodyResults const& r) {
        gather_to_scene(communicator_, group, 3, flat(r.acceleration), body);
        if (!group.beads) gather_to_scene(communicator_, group, 3, flat(r.alpha), alpha);
    };
    std::vector<BodyResults> const found = results();
    for (std::size_t i = 0; i < absolute_.size(); ++i) {
        add(absolute_[i]->group(), found[i]);
        gather_to_scene(communicator_, absolute_[i]->group(), 3, flat(found[i].acceleration),
                        joint);
    }
    for (std::size_t i = 0; i < joint_.size(); ++i) {
        ChainGroup const& group = joint_[i]->group();
        add(group, found[absolute_.size() + i]);
        JointRates const rates = joint_[i]->rates();
        gather_to_scene(communicator_, group, 3,
                        to_array<3>("", rates.qdd.view(), *executor_).values, joint);
        gather_to_scene(communicator_, group, 3, at_starts(group, rates.base_acceleration), base);
    }
    Accelerations all{triples(joint), triples(body),       bead_forces(),    triples(alpha),
                      triples(base),  joint_forces(found), tip_forces(found)};
    // Cross-linked chains are one group, on one rank.
    for (BodyResults const& r : found)
        all.crosslink_tension.insert(all.crosslink_tension.end(), r.crosslink_tension.begin(),
                                     r.crosslink_tension.end());
    return all;
}

void ChainSystem::require_arrays(std::map<std::string, std::vector<double>> const& arrays,
                                 std::map<std::string, int> const& widths) const {
    on_first_rank(communicator_, [&] {
        for (auto const& [name, width] : widths)
            if (auto const found = arrays.find(name);
                found == arrays.end() ||
                found->second.size() != static_cast<std::size_t>(scene_.bodies() * width))
                throw InputError("the checkpoint lacks the array " + name + " for this scene",
                                 "--restart", "use a checkpoint of this scene and integrator");
    });
}

std::vector<std::vector<double>> ChainSystem::own_part(
    std::map<std::string, std::vector<double>> const& arrays, std::string const& name,
    int width) const {
    std::span<double const> const whole =
        communicator_.rank() == 0 ? std::span(arrays.at(name)) : std::span<double const>();
    return SceneWindows(communicator_, groups_).hand_out(width, whole);
}

void ChainSystem::add_part(ChainGroup const& group, std::vector<double> own, int width,
                           std::string const& name, OwnState& state) const {
    OwnArray& array = state[name];
    array.width = width;
    array.of_group.resize(groups_.size());
    array.of_group[index_of(group)] = std::move(own);
    for (std::size_t g = 0; g < groups_.size(); ++g)
        array.of_group[g].resize(static_cast<std::size_t>(groups_[g]->size * width));
}

ChainSystem::OwnState ChainSystem::own_state() const {
    OwnState own;
    for (auto const& group : absolute_)
        for (StateArray& a : group->state())
            add_part(group->group(), std::move(a.values), a.width, a.name, own);
    for (auto const& dynamics : joint_) {
        ChainGroup const& group = dynamics->group();
        JointState const s = dynamics->state();
        add_part(group, to_array<4>("", s.q.view(), *executor_).values, 4, "q", own);
        add_part(group, to_array<3>("", s.qd.view(), *executor_).values, 3, "qd", own);
        add_part(group, at_starts(group, s.base_position), 3, "base_position", own);
        add_part(group, at_starts(group, s.base_velocity), 3, "base_velocity", own);
    }
    return own;
}

void ChainSystem::add_rates(ChainGroup const& group, JointRates const& rates, OwnState& own) const {
    add_part(group, to_array<3>("", rates.qdd.view(), *executor_).values, 3, "qdd", own);
    add_part(group, at_starts(group, rates.base_acceleration), 3, "base_acceleration", own);
}

void ChainSystem::pass_array(OwnArray const& array,
                             std::function<void(ArrayPart const&)> const& take) const {
    SceneWindows(communicator_, groups_)
        .pass(array.width, array.of_group, [&](std::int64_t first, std::span<double const> values) {
            take({first * array.width, values});
        });
}

void ChainSystem::pass_own_array(
    OwnArray const& array, std::function<void(std::vector<ArrayPart> const&)> const& take) const {
    SceneWindows(communicator_, groups_)
        .pass_own(array.width, array.of_group, [&](std::vector<SceneWindows::Own> const& round) {
            std::vector<ArrayPart> parts;
            for (SceneWindows::Own const& run : round)
                parts.push_back({run.first * array.width, run.values});
            take(parts);
        });
}

std::map<std::string, std::vector<double>> ChainSystem::gathered(OwnState const& own) const {
    std::map<std::string, std::vector<double>> arrays;
    for (auto const& [name, array] : own) {
        std::vector<double>& whole = arrays[name];
        pass_array(array, [&](ArrayPart const& part) {
            whole.insert(whole.end(), part.values.begin(), part.values.end());
        });
    }
    return arrays;
}

std::vector<JointRates> ChainSystem::own_rates(
    std::map<std::string, std::vector<double>> const& arrays) const {
    require_arrays(arrays, {{"qdd", 3}, {"base_acceleration", 3}});
    auto qdd = own_part(arrays, "qdd", 3),
         base_acceleration = own_part(arrays, "base_acceleration", 3);
    std::vector<JointRates> all;
    for (auto const& dynamics : joint_) {
        ChainGroup const& group = dynamics->group();
        JointRates rates{Field<3>(group.size),
                         of_starts(group, triples(base_acceleration[index_of(group)]))};
        from_array<3>({"qdd", 3, std::move(qdd[index_of(group)])}, rates.qdd.view(), *executor_);
        all.push_back(std::move(rates));
    }
    return all;
}

/// Arrays are distributed and freed one by one, because a rank may have little memory left besides
/// the whole checkpoint.
void ChainSystem::set_state(std::map<std::string, std::vector<double>> const& arrays) {
    std::map<std::string, int> absolute_widths;
    std::vector<std::vector<StateArray>> absolute;
    for (auto const& group : absolute_) {
        absolute.push_back(group->state());
        for (StateArray& a : absolute.back()) {
            absolute_widths[a.name] = a.width;
            a.values = {};
        }
    }
    std::map<std::string, int> widths = absolute_widths;
    if (!joint_.empty())
        widths.insert({{"q", 4}, {"qd", 3}, {"base_position", 3}, {"base_velocity", 3}});
    require_arrays(arrays, widths);

    for (auto const& [name, width] : absolute_widths) {
        auto own = own_part(arrays, name, width);
        for (std::size_t g = 0; g < absolute_.size(); ++g)
            for (StateArray& a : absolute[g])
                if (a.name == name) a.values = std::move(own[index_of(absolute_[g]->group())]);
    }
    for (std::size_t g = 0; g < absolute_.size(); ++g)
        absolute_[g]->set_state(std::exchange(absolute[g], {}));

    std::vector<JointState> joint;
    for (auto const& dynamics : joint_) joint.emplace_back(dynamics->group());
    auto const set = [&](std::string const& name, int width, auto const& put) {
        if (joint.empty()) return;
        auto own = own_part(arrays, name, width);
        for (std::size_t g = 0; g < joint.size(); ++g) {
            ChainGroup const& group = joint_[g]->group();
            put(joint[g], group, std::move(own[index_of(group)]));
        }
    };
    using Own = std::vector<double>;
    set("q", 4, [this](JointState& s, ChainGroup const&, Own own) {
        from_array<4>({"q", 4, std::move(own)}, s.q.view(), *executor_);
    });
    set("qd", 3, [this](JointState& s, ChainGroup const&, Own own) {
        from_array<3>({"qd", 3, std::move(own)}, s.qd.view(), *executor_);
    });
    set("base_position", 3, [](JointState& s, ChainGroup const& group, Own const& own) {
        s.base_position = of_starts(group, triples(own));
    });
    set("base_velocity", 3, [](JointState& s, ChainGroup const& group, Own const& own) {
        s.base_velocity = of_starts(group, triples(own));
    });
    for (std::size_t g = 0; g < joint.size(); ++g) joint_[g]->set_state(joint[g]);
}

}  // namespace catena
