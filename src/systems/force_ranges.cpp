// Implements the search for acting particles by symbolic simplification of energies (Lepton). With
// the parameters of one partner inserted, the energy of a particle that does not act simplifies to
// 0.
#include "systems/force_ranges.hpp"

#include <lepton/ExpressionTreeNode.h>
#include <lepton/Operation.h>
#include <lepton/ParsedExpression.h>
#include <lepton/Parser.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>

#include "systems/subset.hpp"

namespace catena {
namespace {

using Parameters = std::vector<double>;

/// True if the expression is the constant 0.
bool is_zero(Lepton::ParsedExpression const& energy) {
    auto const* constant =
        dynamic_cast<Lepton::Operation::Constant const*>(&energy.getRootNode().getOperation());
    return constant != nullptr && constant->getValue() == 0;
}

/// Decides from its parameters whether a particle acts. Particles of a force that is not understood
/// always act.
class Acting {
  public:
    /// Parses the force's energy. Tabulated functions and computed values are not understood.
    explicit Acting(OpenMM::CustomNonbondedForce const& force)
        : understood_(force.getNumTabulatedFunctions() == 0 && computed_values_of(force) == 0) {
        if (understood_) energy_ = Lepton::Parser::parse(force.getEnergyFunction());
        for (int i = 0; i < force.getNumPerParticleParameters(); ++i)
            name_.push_back(force.getPerParticleParameterName(i));
    }
    /// True if a particle with these parameters acts. Results are stored per set of parameters,
    /// because most particles share them.
    bool operator()(Parameters const& of_particle) {
        // Lepton does not terminate for parameters that are not finite.
        bool const finite = std::all_of(of_particle.begin(), of_particle.end(),
                                        [](double v) { return std::isfinite(v); });
        if (!understood_ || !finite || known_.size() > most_kinds) return true;
        auto const [found, is_new] = known_.try_emplace(of_particle, true);
        if (is_new)
            found->second = !(is_zero(energy_.optimize(as("1", of_particle))) &&
                              is_zero(energy_.optimize(as("2", of_particle))));
        return found->second;
    }

  private:
    /// Largest number of parameter sets to examine; each takes about 10 us.
    static std::size_t constexpr most_kinds = 4096;

    /// Values of the particle's parameters as particle "1" or "2" of a pair.
    std::map<std::string, double> as(char const* side, Parameters const& of_particle) const {
        std::map<std::string, double> values;
        for (std::size_t i = 0; i < name_.size(); ++i) values[name_[i] + side] = of_particle[i];
        return values;
    }

    /// True if the energy can be simplified.
    bool understood_;
    Lepton::ParsedExpression energy_;
    std::vector<std::string> name_;
    /// Results so far.
    std::map<Parameters, bool> known_;
};

/// Acting particles by the energy expression.
std::vector<char> acts_in(OpenMM::CustomNonbondedForce const& force) {
    Acting acting(force);
    std::vector<char> acts;
    Parameters of_particle;
    for (int p = 0; p < force.getNumParticles(); ++p) {
        force.getParticleParameters(p, of_particle);
        acts.push_back(acting(of_particle) ? 1 : 0);
    }
    return acts;
}

/// Acting particles by charge and epsilon.
std::vector<char> acts_in(OpenMM::NonbondedForce const& force) {
    std::vector<char> acts;
    double charge, sigma, epsilon;
    for (int p = 0; p < force.getNumParticles(); ++p) {
        force.getParticleParameters(p, charge, sigma, epsilon);
        acts.push_back(
            charge != 0 || epsilon != 0 || force.getNumParticleParameterOffsets() > 0 ? 1 : 0);
    }
    return acts;
}

/// True if every marked particle of `some` is marked in `others`.
bool are_among(std::vector<char> const& some, std::vector<char> const& others) {
    return std::equal(some.begin(), some.end(), others.begin(),
                      [](char one, char other) { return one <= other; });
}

}  // namespace

std::vector<char> acting_particles(OpenMM::Force const& force) {
    if (auto const* pairs = dynamic_cast<OpenMM::CustomNonbondedForce const*>(&force))
        return acts_in(*pairs);
    if (auto const* pairs = dynamic_cast<OpenMM::NonbondedForce const*>(&force))
        return acts_in(*pairs);
    return {};
}

std::vector<PairRange> pair_ranges(OpenMM::System const& system,
                                   std::vector<std::int64_t> const& bead_of_particle) {
    std::map<double, std::vector<char>, std::greater<>> acts_to;  // per particle, by cutoff
    for (int i = 0; i < system.getNumForces(); ++i) {
        std::vector<char> const acts = acting_particles(system.getForce(i));
        if (acts.empty()) continue;
        if (acts.size() != bead_of_particle.size())
            throw OpenMM::OpenMMException(
                system.getForce(i).getName() +
                " must have exactly as many particles as the System it belongs to");
        std::vector<char>& here =
            acts_to.try_emplace(reach_of(system.getForce(i)), acts.size(), char{0}).first->second;
        for (std::size_t p = 0; p < acts.size(); ++p) here[p] = std::max(here[p], acts[p]);
    }
    std::vector<PairRange> ranges;
    for (auto const& [reach, acts] : acts_to) {
        PairRange range{reach, std::vector<char>(acts.size())};
        for (std::size_t p = 0; p < acts.size(); ++p)
            range.acts[static_cast<std::size_t>(bead_of_particle[p])] = acts[p];
        bool const none = std::find(acts.begin(), acts.end(), 1) == acts.end();
        if (!none && std::none_of(ranges.begin(), ranges.end(), [&](PairRange const& longer) {
                return are_among(range.acts, longer.acts);
            }))
            ranges.push_back(std::move(range));
    }
    for (PairRange& range : ranges)
        if (std::find(range.acts.begin(), range.acts.end(), 0) == range.acts.end())
            range.acts.clear();
    return ranges;
}

}  // namespace catena
