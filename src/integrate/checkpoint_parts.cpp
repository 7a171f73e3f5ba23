// Arrays of a checkpoint: collection on a rank, exchange between ranks and restoring.
#include "integrate/checkpoint_parts.hpp"

#include <utility>

#include "error.hpp"
#include "integrate/flat_arrays.hpp"
#include "mpi/first_rank.hpp"

namespace catena {

void CheckpointParts::require(Arrays const& arrays,
                              std::map<std::string, int> const& widths) const {
    on_first_rank(system_.communicator(), [&] {
        for (auto const& [name, width] : widths)
            if (auto const found = arrays.find(name);
                found == arrays.end() ||
                found->second.size() != static_cast<std::size_t>(system_.scene().bodies() * width))
                throw InputError("the checkpoint lacks the array " + name + " for this scene",
                                 "--restart", "use a checkpoint of this scene and integrator");
    });
}

std::vector<std::vector<double>> CheckpointParts::own_part(Arrays const& arrays,
                                                           std::string const& name,
                                                           int width) const {
    std::span<double const> const whole =
        system_.communicator().rank() == 0 ? std::span(arrays.at(name)) : std::span<double const>();
    return windows().hand_out(width, whole);
}

void CheckpointParts::add(ChainGroup const& group, std::vector<double> own, int width,
                          std::string const& name, OwnState& state) const {
    OwnArray& array = state[name];
    array.width = width;
    array.of_group.resize(system_.groups().size());
    array.of_group[system_.index_of(group)] = std::move(own);
    for (std::size_t g = 0; g < system_.groups().size(); ++g)
        array.of_group[g].resize(static_cast<std::size_t>(system_.groups()[g]->size * width));
}

OwnState CheckpointParts::own_state() const {
    OwnState own;
    for (AbsoluteDynamics* const group : system_.absolute())
        for (StateArray& a : group->state())
            add(group->group(), std::move(a.values), a.width, a.name, own);
    for (JointDynamics* const dynamics : system_.joint()) {
        ChainGroup const& group = dynamics->group();
        JointState const s = dynamics->state();
        add(group, to_array<4>("", s.q.view(), system_.executor()).values, 4, "q", own);
        add(group, to_array<3>("", s.qd.view(), system_.executor()).values, 3, "qd", own);
        add(group, at_starts(group, s.base_position), 3, "base_position", own);
        add(group, at_starts(group, s.base_velocity), 3, "base_velocity", own);
    }
    return own;
}

void CheckpointParts::add_rates(ChainGroup const& group, JointRates const& rates,
                                OwnState& own) const {
    add(group, to_array<3>("", rates.qdd.view(), system_.executor()).values, 3, "qdd", own);
    add(group, at_starts(group, rates.base_acceleration), 3, "base_acceleration", own);
}

void CheckpointParts::pass(OwnArray const& array,
                           std::function<void(ArrayPart const&)> const& take) const {
    windows().pass(array.width, array.of_group,
                   [&](std::int64_t first, std::span<double const> values) {
                       take({first * array.width, values});
                   });
}

void CheckpointParts::pass_own(
    OwnArray const& array, std::function<void(std::vector<ArrayPart> const&)> const& take) const {
    windows().pass_own(array.width, array.of_group,
                       [&](std::vector<SceneWindows::Own> const& round) {
                           std::vector<ArrayPart> parts;
                           for (SceneWindows::Own const& run : round)
                               parts.push_back({run.first * array.width, run.values});
                           take(parts);
                       });
}

CheckpointParts::Arrays CheckpointParts::gathered(OwnState const& own) const {
    Arrays arrays;
    for (auto const& [name, array] : own) {
        std::vector<double>& whole = arrays[name];
        pass(array, [&](ArrayPart const& part) {
            whole.insert(whole.end(), part.values.begin(), part.values.end());
        });
    }
    return arrays;
}

std::vector<JointRates> CheckpointParts::own_rates(Arrays const& arrays) const {
    require(arrays, {{"qdd", 3}, {"base_acceleration", 3}});
    auto qdd = own_part(arrays, "qdd", 3),
         base_acceleration = own_part(arrays, "base_acceleration", 3);
    std::vector<JointRates> all;
    for (JointDynamics* const dynamics : system_.joint()) {
        ChainGroup const& group = dynamics->group();
        JointRates rates{Field<3>(group.size),
                         of_starts(group, triples(base_acceleration[system_.index_of(group)]))};
        from_array<3>({"qdd", 3, std::move(qdd[system_.index_of(group)])}, rates.qdd.view(),
                      system_.executor());
        all.push_back(std::move(rates));
    }
    return all;
}

void CheckpointParts::set_absolute(Arrays const& arrays, std::map<std::string, int> const& widths,
                                   std::vector<std::vector<StateArray>> states) const {
    std::vector<AbsoluteDynamics*> const groups = system_.absolute();
    for (auto const& [name, width] : widths) {
        auto own = own_part(arrays, name, width);
        for (std::size_t g = 0; g < groups.size(); ++g)
            for (StateArray& a : states[g])
                if (a.name == name) a.values = std::move(own[system_.index_of(groups[g]->group())]);
    }
    for (std::size_t g = 0; g < groups.size(); ++g)
        groups[g]->set_state(std::exchange(states[g], {}));
}

void CheckpointParts::set_joint(Arrays const& arrays) const {
    std::vector<JointDynamics*> const groups = system_.joint();
    if (groups.empty()) return;
    std::vector<JointState> states;
    for (JointDynamics* const dynamics : groups) states.emplace_back(dynamics->group());
    auto const set = [&](std::string const& name, int width, auto const& put) {
        auto own = own_part(arrays, name, width);
        for (std::size_t g = 0; g < groups.size(); ++g) {
            ChainGroup const& group = groups[g]->group();
            put(states[g], group, std::move(own[system_.index_of(group)]));
        }
    };
    using Own = std::vector<double>;
    set("q", 4, [this](JointState& s, ChainGroup const&, Own own) {
        from_array<4>({"q", 4, std::move(own)}, s.q.view(), system_.executor());
    });
    set("qd", 3, [this](JointState& s, ChainGroup const&, Own own) {
        from_array<3>({"qd", 3, std::move(own)}, s.qd.view(), system_.executor());
    });
    set("base_position", 3, [](JointState& s, ChainGroup const& group, Own const& own) {
        s.base_position = of_starts(group, triples(own));
    });
    set("base_velocity", 3, [](JointState& s, ChainGroup const& group, Own const& own) {
        s.base_velocity = of_starts(group, triples(own));
    });
    for (std::size_t g = 0; g < groups.size(); ++g) groups[g]->set_state(states[g]);
}

/// Arrays are distributed and freed one by one, because a rank may have little memory left besides
/// the whole checkpoint.
void CheckpointParts::set_state(Arrays const& arrays) const {
    std::map<std::string, int> of_absolute;
    std::vector<std::vector<StateArray>> absolute;
    for (AbsoluteDynamics* const group : system_.absolute()) {
        absolute.push_back(group->state());
        for (StateArray& a : absolute.back()) {
            of_absolute[a.name] = a.width;
            a.values = {};
        }
    }
    std::map<std::string, int> widths = of_absolute;
    if (!system_.joint().empty())
        widths.insert({{"q", 4}, {"qd", 3}, {"base_position", 3}, {"base_velocity", 3}});
    require(arrays, widths);
    set_absolute(arrays, of_absolute, std::move(absolute));
    set_joint(arrays);
}

}  // namespace catena
