#include "tests/force/pair_sum.hpp"

#include <cmath>
#include <set>
#include <utility>

#include "structure/calvados2.hpp"

namespace catena::testing {

namespace {

/// OpenMM's: 1 - 6 x^5 + 15 x^4 - 10 x^3 over the last `width` before the cutoff.
double switched(double r, double cutoff, double width) {
    if (r >= cutoff) return 0;
    if (r <= cutoff - width) return 1;
    double const x = (r - cutoff + width) / width;
    return 1 - x * x * x * (10 - x * (15 - 6 * x));
}

double lennard_jones(double r, double sigma) {
    return 4 * 0.8368 * (std::pow(sigma / r, 12) - std::pow(sigma / r, 6));
}

double distance(Vec3 const& a, Vec3 const& b, std::optional<Vec3> const& box) {
    Vec3 d = a - b;
    if (box)
        for (int i = 0; i < 3; ++i) d[i] -= (*box)[i] * std::round(d[i] / (*box)[i]);
    return norm(d);
}

}  // namespace

PairEnergies pair_sum(BeadSystem const& beads, OpenMmSpec const& spec,
                      std::vector<Vec3> const& positions) {
    std::vector<double> charge;
    for (std::size_t c = 0; c + 1 < beads.chain_offset.size(); ++c) {
        std::int64_t const n = beads.chain_offset[c + 1] - beads.chain_offset[c];
        for (std::int64_t k = 0; k < n; ++k) {
            std::string const& name = beads.residue[beads.chain_offset[c] + k];
            double q = name == "ARG" || name == "LYS" ? 1 : name == "ASP" || name == "GLU" ? -1 : 0;
            if (name == "HIS" && spec.ph) q = 1 / (1 + std::pow(10.0, *spec.ph - 6));
            charge.push_back(q + (k == 0) - (k == n - 1));
        }
    }
    std::set<std::pair<std::int64_t, std::int64_t>> linked;
    for (auto const& link : beads.links) linked.insert({link.inboard, link.outboard});
    auto const y = calvados2::yukawa(spec.temperature, spec.ionic_strength);
    PairEnergies sum;
    for (std::int64_t i = 0; i < beads.size(); ++i)
        for (std::int64_t j = i + 1; j < beads.size(); ++j) {
            if (linked.count({i, j}) > 0) continue;
            double const r = distance(positions[i], positions[j], beads.box);
            auto const &a = *find_calvados2(std::string_view(beads.residue[i])),
                       &b = *find_calvados2(std::string_view(beads.residue[j]));
            double const s = (a.sigma + b.sigma) / 2, l = (a.lambda + b.lambda) / 2,
                         edge = lennard_jones(2, s);
            double const contact = r < std::pow(2, 1.0 / 6) * s
                                       ? lennard_jones(r, s) - l * edge + 0.8368 * (1 - l)
                                       : l * (lennard_jones(r, s) - edge);
            sum.ashbaugh_hatch += switched(r, 2, spec.switch_width) * contact;
            sum.yukawa += switched(r, 4, spec.switch_width) * charge[i] * charge[j] * y.prefactor *
                          (std::exp(-y.kappa * r) / r - std::exp(-4 * y.kappa) / 4);
        }
    return sum;
}

}  // namespace catena::testing
