// Implements concentrations. One amu in a cubic nanometre is 1.66 mg/ml, one chain there 1.66
// mol/l.
#include "place/concentration.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <string_view>

#include "math/concentration_units.hpp"
#include "scene/fields.hpp"

namespace catena::scene {

namespace {

double constexpr noted_miss = 0.02;  // relative
double constexpr per_nm = 1e4;       // steps of derived edges, whose decimals print as they are
double constexpr most_copies = 1e9;

/// A unit's factor to mg/ml or mmol/l.
struct Unit {
    std::string_view name;
    double factor;
    bool molar;
};
constexpr Unit units[] = {{"mg/ml", 1, false},    {"mg/mL", 1, false},  {"g/l", 1, false},
                          {"g/L", 1, false},      {"mol/l", 1e3, true}, {"mmol/l", 1, true},
                          {"umol/l", 1e-3, true}, {"M", 1e3, true},     {"mM", 1, true},
                          {"uM", 1e-3, true}};

[[noreturn]] void refuse_unit(Node const& node) {
    fail(node, describe(node) + " is not a concentration",
         "give a number and one of the units mg/ml, g/l, mol/l, mmol/l, umol/l, such as `5 mg/ml`");
}

/// Number of chains of a mass that have the concentration in a volume.
double chains_in(Concentration const& wanted, double mass, double volume) {
    return wanted.molar ? wanted.value * volume / mmol_per_l
                        : wanted.value * volume / (mg_per_ml * mass);
}

double total_mass(std::vector<Draft> const& drafts) {
    return std::accumulate(drafts.begin(), drafts.end(), 0.0, [](double sum, Draft const& draft) {
        return sum + mass_of(draft.chain);
    });
}

}  // namespace

Concentration read_concentration(Node const& node) {
    if (node.kind != Node::Kind::scalar) refuse_unit(node);
    std::string const written = text(node);
    std::size_t const end = written.find_first_not_of("+-.0123456789eE");
    std::size_t const unit = end == std::string::npos ? end : written.find_first_not_of(' ', end);
    double value = 0;
    if (unit == std::string::npos ||
        parse_number(written.substr(0, end), value) != NumberFault::none)
        refuse_unit(node);
    for (Unit const& known : units)
        if (known.name == written.substr(unit)) {
            if (!(value > 0))
                fail(node, describe(node) + " is not above 0", "give a positive concentration");
            return {value * known.factor, known.molar};
        }
    refuse_unit(node);
}

double mass_of(ChainSpec const& chain) {
    std::vector<double> const& masses = chain.is_beads()    ? chain.beads.mass
                                        : chain.is_linked() ? chain.linked.mass
                                                            : chain.bodies.mass;
    return std::accumulate(masses.begin(), masses.end(), 0.0);
}

std::int64_t copies_for(Node const& concentration, ChainSpec const& chain, Region const& region,
                        Scene& scene) {
    Concentration const wanted = read_concentration(concentration);
    double const mass = mass_of(chain), volume = region.volume(),
                 exact = chains_in(wanted, mass, volume), copies = std::round(exact);
    if (copies < 1)
        fail(concentration,
             fmt::format("{} in {} of {:.6g} nm^3 is {:.2g} chains of {:.6g} amu, one chain is "
                         "{:.3g} mg/ml or {:.3g} mmol/l",
                         describe(concentration), region.name(), volume, exact, mass,
                         mg_per_ml_of(mass, volume), mmol_per_l_of(1, volume)),
             fmt::format("give a volume of {:.4g} nm^3 or more, or `count: 1`", volume / exact));
    if (copies > most_copies)
        fail(
            concentration,
            fmt::format("{} in {} is {:.3g} chains", describe(concentration), region.name(), exact),
            "give a smaller concentration or box");
    if (std::abs(copies / exact - 1) > noted_miss)
        scene.note(fmt::format(
            "{} in {} is {:.4g} chains: {:.0f} of them are {:.4g} mg/ml or {:.4g} mmol/l",
            describe(concentration), region.name(), exact, copies,
            mg_per_ml_of(copies * mass, volume), mmol_per_l_of(copies, volume)));
    return static_cast<std::int64_t>(copies);
}

Vec3 cube_for(Concentration const& concentration, std::vector<Draft> const& drafts) {
    auto const count = static_cast<double>(drafts.size());
    double const one_nm = chains_in(concentration, total_mass(drafts) / count, 1);
    double const edge = std::round(per_nm * std::cbrt(count / one_nm)) / per_nm;
    return {{edge, edge, edge}};
}

double mg_per_ml_of(double mass, double volume) { return mg_per_ml * mass / volume; }

double mmol_per_l_of(double chains, double volume) { return mmol_per_l * chains / volume; }

}  // namespace catena::scene
