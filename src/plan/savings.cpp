// Implements the measurement of computations that a scene does not need.
#include "plan/savings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cuda/device/gpu.hpp"
#include "mpi/first_rank.hpp"
#include "plan/describe.hpp"
#include "plan/phases.hpp"

namespace catena::command {
namespace {

using plan::Family;

/// Largest number of bodies that is timed: long enough to fill caches, short enough to wait for.
constexpr std::int64_t largest_measured = 4096;

/// Returns the axes in which the system's bodies are computed.
Axes axes_of(ChainSystem const& system) {
    bool const joint =
        std::any_of(system.groups().begin(), system.groups().end(), [](auto const& group) {
            return !group->beads && !group->linked && group->axes == Axes::joint;
        });
    return joint ? Axes::joint : Axes::world;
}

/// Returns a sample chain on which nothing acts but gravity.
Scene bare(Family const& family, std::int64_t bodies) {
    Scene scene = plan::sample(family, bodies);
    scene.chains[0].bodies.torque.clear();
    scene.chains[0].bodies.wrench.clear();
    return scene;
}
/// Returns the additional seconds of `with` over `without`, least of several on one core. The two
/// are timed in turns, so that a disturbance affects both.
double seconds_more(Scene const& without, Axes axes_without, Scene const& with, Axes axes_with) {
    auto const alone = serial_communicator();
    Scene const scenes[] = {plan::arranged(without, {}), plan::arranged(with, {})};
    ChainSystem one(scenes[0], axes_without, *alone), other(scenes[1], axes_with, *alone);
    double least = HUGE_VAL, more = HUGE_VAL;
    for (int round = 0; round < 8; ++round) {
        least = std::min(least, plan::measure_phases(one, {3, 20, 0.01})[plan::evaluation]);
        more = std::min(more, plan::measure_phases(other, {3, 20, 0.01})[plan::evaluation]);
    }
    return std::max(0.0, more - least);
}

/// Returns the seconds of rotating the inboard one of two segments into the axes of the other at
/// every merge, with six directions per handle.
double seconds_of_turning(std::int64_t merges) {
    Mat3 const rotation = to_matrix(normalized(Quat{1, 2, 3, 4}));
    using Block = Matrix<double, 6, 6>;
    Block both = Block::zero();
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) both(i, j) = both(3 + i, 3 + j) = rotation(i, j);
    double least = HUGE_VAL;
    for (int round = 0; round < 8; ++round) {
        Block z22 = Block::identity(), z12 = Block::identity();
        double const start = seconds_now();
        for (std::int64_t i = 0; i < merges; ++i) {
            z22 = transposed_times(both, z22 * both);
            z12 = z12 * both;
        }
        double const spent = seconds_now() - start;
        // The comparisons keep the compiler from removing the products.
        if (z22(0, 0) == z22(0, 0) && z12(0, 0) == z12(0, 0)) least = std::min(least, spent);
    }
    return least;
}

/// Returns a function that measures the additional seconds of a change to the chains of a family.
template <class Change>
std::function<double(std::int64_t)> change_of(Family const& family, Change const& change) {
    return [family, change](std::int64_t bodies) {
        Scene const without = bare(family, bodies);
        Scene with = without;
        change(with, static_cast<std::size_t>(bodies));
        return seconds_more(without, family.axes, with, family.axes);
    };
}
/// Returns a function that measures the kinematics of bodies along a chain on spherical joints.
std::function<double(std::int64_t)> following(Family const& family) {
    return [family](std::int64_t bodies) {
        Family const joints{scene::RandomJoint::spherical, false, Axes::joint, Handles::projected};
        return seconds_more(bare(family, bodies), family.axes, bare(joints, bodies), joints.axes);
    };
}

/// Collects the computations that are left out.
class List {
  public:
    explicit List(Scene const& scene) : scene_(scene) {}
    void add(std::string const& text, std::size_t share = 0,
             std::function<double(std::int64_t)> const& takes = {}) {
        lines_.push_back({text, share, takes});
    }
    /// Adds what chains of beads do without.
    void add_beads(Family const& family, std::size_t share) {
        add("kinematics of beads: their positions are the coordinates");
        add("rotations and inertias of beads: a bead is a point, both its handles are the bead "
            "itself",
            share, following(family));
    }
    /// Adds what chains of rigid bodies do without.
    void add_bodies(ChainGroup const& group, Family const& family, std::size_t share) {
        if (group.axes == Axes::joint) {
            if (!group.has_closures() && !group.carried.in_scene &&
                !some_acts([](auto term) { return term.uses_positions; })) {
                add("positions and linear velocities of bodies: nothing in the scene depends on "
                    "them; computed for output and energies only",
                    share, change_of(family, [](Scene& scene, std::size_t n) {
                        terms::for_each([&](auto term) {
                            if (term.uses_positions) decltype(term)::put(scene, n);
                        });
                    }));
                if (!some_acts([](auto term) { return term.uses_orientations; }))
                    add("orientations of all bodies but the first of each chain: nothing in the "
                        "scene acts along ground axes; computed for output only");
            }
            if (group.revolute && group.partition.trees.front().run_length > 1)
                add("velocity terms and body accelerations of chains on revolute joints: a step "
                    "solves once, and the solver maps rates to rates",
                    share);
            add("rotations at merges: both sides of a joint share its axes", share,
                seconds_of_turning);
        } else {
            add("kinematics along the chain: orientations and positions are the coordinates", share,
                family.linked ? nullptr : following(family));
            add("rotations at merges: all handles are in ground axes", share, seconds_of_turning);
        }
        if (family.handles == Handles::projected && group.directions < 6)
            add(fmt::format(
                    "{} of 6 directions per handle: the joints' forces along them are known",
                    6 - group.directions),
                share, change_of(family, [](Scene& scene, std::size_t) {
                    scene.solver.handles = Handles::full;
                }));
        add_loads(family, share);
    }
    std::vector<Savings> const& lines() const { return lines_; }

  private:
    /// Adds loads that the scene does not have.
    void add_loads(Family const& family, std::size_t share) {
        auto const on_all = [&](auto const& change) {
            return family.linked ? std::function<double(std::int64_t)>()
                                 : change_of(family, change);
        };
        terms::for_each([&](auto term) {
            using Term = decltype(term);
            if constexpr (Term::saving != nullptr)
                if (!terms::acts_in<Term>(scene_))
                    add(std::string(Term::saving) + ": there are none", share, on_all(&Term::put));
        });
    }
    /// True if a term with the property acts.
    template <class Property>
    bool some_acts(Property const& property) const {
        return terms::any_of(
            [&](auto term) { return property(term) && terms::acts_in<decltype(term)>(scene_); });
    }
    Scene const& scene_;
    std::vector<Savings> lines_;
};

/// Returns the index of the share that describes a group.
std::size_t share_of(std::vector<plan::Share> const& shares, ChainGroup const& group) {
    auto const same = [&](plan::Share const& share) {
        bool const links = share.family.joint == scene::RandomJoint::link;
        return links == (group.beads || group.linked) && share.family.linked == group.linked;
    };
    return static_cast<std::size_t>(std::find_if(shares.begin(), shares.end(), same) -
                                    shares.begin());
}

/// Returns the seconds of an evaluation of a bare sample chain.
double seconds_without(Family const& family, std::int64_t bodies) {
    auto const alone = serial_communicator();
    Scene const scene = plan::arranged(bare(family, bodies), {});
    ChainSystem system(scene, family.axes, *alone);
    return plan::measure_phases(system, {5, 200, 0.1})[plan::evaluation];
}

}  // namespace

std::vector<Savings> left_out(Scene const& scene, ChainSystem const& system) {
    List list(scene);
    bool const full_handles = carries_all(scene.solver.handles);
    std::vector<plan::Share> const shares =
        plan::shares_of(scene, axes_of(system), system.communicator().size());
    bool has_beads = false;  // listed already; branched chains are a group of their own
    for (auto const& group : system.groups()) {
        std::size_t const share = share_of(shares, *group);
        if (!group->beads)
            list.add_bodies(*group, shares[share].family, share);
        else if (!std::exchange(has_beads, true))
            list.add_beads(shares[share].family, share);
    }
    if (full_handles)
        list.add(fmt::format("projection on the restricted directions: handles are {}",
                             name_of(scene.solver.handles)));
    if (!scene.forces.openmm) list.add("OpenMM: forces.openmm is not in the scene");
    if (system.backend() != Backend::openmp && !(uses_gpu(system.backend()) && openmp_is_built()))
        list.add("threads: this backend uses one per rank");
    if (system.communicator().size() == 1) list.add("messages: there is one rank");
    if (!uses_gpu(system.backend()))
        list.add("GPU: " + (cuda::why_not().empty()
                                ? "this backend does not use " + cuda::device_name()
                                : cuda::why_not()));
    return list.lines();
}

void add_savings(Text& text, Json& json, Scene const& scene, ChainSystem const& system) {
    std::vector<Savings> const lines = left_out(scene, system);
    std::vector<plan::Share> const shares =
        plan::shares_of(scene, axes_of(system), system.communicator().size());
    on_first_rank(system.communicator(), [&] {
        text.note(
            "measured: one evaluation of chains like the scene's, with it and without, on one "
            "core, scaled to the scene's bodies");
        Table table({"", "saves", "of an evaluation"}, {0});
        json["savings"] = Json::array();
        for (Savings const& each : lines) {
            if (!each.takes) {
                table.add({each.text, "-", "-"});
                continue;
            }
            plan::Share const& share = shares[each.share];
            std::int64_t const bodies = std::min(share.bodies, largest_measured);
            double const saved = each.takes(bodies),
                         of_evaluation = saved / seconds_without(share.family, bodies);
            // A measured time cannot be negative.
            if (!(saved > 0)) {
                table.add({each.text, "not resolved", "-"});
                json["savings"].push_back(
                    {{"left_out", each.text}, {"seconds", nullptr}, {"of_an_evaluation", nullptr}});
                continue;
            }
            double const of_scene =
                saved * static_cast<double>(share.bodies) / static_cast<double>(bodies);
            table.add(
                {each.text, duration_text(of_scene), fmt::format("{:.0f} %", 100 * of_evaluation)});
            json["savings"].push_back({{"left_out", each.text},
                                       {"seconds", of_scene},
                                       {"of_an_evaluation", of_evaluation}});
        }
        text.add(table);
    });
}

}  // namespace catena::command
