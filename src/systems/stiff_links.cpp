// Implements joinings and the judgement of soft springs.
#include "systems/stiff_links.hpp"

#include <fmt/format.h>

#include <cmath>

#include "error.hpp"

namespace catena {

namespace {

double constexpr boltzmann = 0.00831446261815324;  // kJ/mol/K
double constexpr same_length = 1e-6;               // nm; covers lengths written in decimals

/// Returns "1 link stands for" or "2 links stand for", with `kind` after the noun.
std::string links_stand_for(std::int64_t count, char const* kind = "") {
    return count == 1 ? fmt::format("1 link{} stands for", kind)
                      : fmt::format("{} links{} stand for", count, kind);
}

}  // namespace

void Joining::add_spring(double rest, double k) {
    differ = differ || (springs > 0 && std::abs(rest - length) > same_length);
    length =
        springs == 0 || rest == length ? rest : (stiffness * length + k * rest) / (stiffness + k);
    stiffness += k;
    ++springs;
}

void Joining::add_constraint(double rest) {
    length = rest;
    stiffness = std::numeric_limits<double>::infinity();
    differ = false;
}

double Joining::spread(double temperature) const {
    return std::sqrt(boltzmann * temperature / stiffness) / length;
}

bool Joining::is_like(Joining const& link, double temperature) const {
    if (std::isinf(link.stiffness)) return holds() && spread(temperature) <= StiffLinks::softest;
    return holds() && stiffness >= 0.5 * link.stiffness;
}

void StiffLinks::add(std::int64_t a, std::int64_t b, Joining const& link) {
    if (!(link.length > 0 && std::isfinite(link.length)))
        throw InputError(
            fmt::format("the bond between particles {} and {} (from 0) has length {} nm", a, b,
                        link.length),
            where_, "a rigid link needs a length above 0");
    double const spread = link.spread(temperature_);
    if (!(spread <= softest))
        throw InputError(
            fmt::format(
                "the bond between particles {} and {} (from 0) is too soft for a rigid link: with "
                "{:.6g} kJ/mol/nm2 its thermal "
                "spread sqrt(kT/k) at {:.6g} K is {:.3g} nm, {:.3g} % of its length of {:.6g} nm",
                a, b, link.stiffness, temperature_, spread * link.length, 100 * spread,
                link.length),
            where_,
            fmt::format("neighbours in Catena's chains are on links of fixed length: make the bond "
                        "a constraint or stiffer (below {:.0f} %), "
                        "or simulate the springs with OpenMM",
                        100 * softest));
    auto const count = [&](Some& some, bool worse) {
        if (some.count++ == 0 || worse) some.a = a, some.b = b, some.worst = link;
    };
    if (spread > stiff) count(soft_, spread > soft_.worst.spread(temperature_));
    if (link.differ) count(several_, false);
}

std::vector<std::string> StiffLinks::notes() const {
    std::vector<std::string> notes;
    if (soft_.count > 0)
        notes.push_back(fmt::format(
            "{} soft bonds: the thermal spread sqrt(kT/k) at {:.6g} K is up to {:.3g} % of "
            "the length (particles {} and {} from 0: {:.6g} kJ/mol/nm2, {:.6g} nm); Catena keeps "
            "no springs between "
            "neighbours.",
            links_stand_for(soft_.count, " of fixed length"), temperature_,
            100 * soft_.worst.spread(temperature_), soft_.a, soft_.b, soft_.worst.stiffness,
            soft_.worst.length));
    if (several_.count > 0)
        notes.push_back(
            fmt::format("{} several harmonic bonds of different lengths, at the length at which "
                        "these rest together "
                        "(particles {} and {} from 0: {} bonds, {:.6g} nm).",
                        links_stand_for(several_.count), several_.a, several_.b,
                        several_.worst.springs, several_.worst.length));
    return notes;
}

}  // namespace catena
