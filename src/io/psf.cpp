// Implements topology.psf.
#include "io/psf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace catena {
namespace {

using Bond = std::pair<std::int64_t, std::int64_t>;

/// Bonds between neighbours along chains and between the ends of rings. Sites are numbered from 1.
std::vector<Bond> bonds_of(Topology const& topology) {
    std::vector<Bond> bonds;
    for (Topology::Chain const& chain : topology.chains) {
        for (std::int64_t k = 1; k < chain.count; ++k)
            bonds.emplace_back(chain.first + k, chain.first + k + 1);
        if (chain.ring && chain.count > 2)
            bonds.emplace_back(chain.first + chain.count, chain.first + 1);
    }
    return bonds;
}

/// Replaces blanks, which would end a field.
std::string field(std::string text) {
    std::replace(text.begin(), text.end(), ' ', '_');
    return text.empty() ? "UNK" : text;
}

}  // namespace

void write_psf(AtomicFile& out, Topology const& topology) {
    out.write(
        "PSF NAMD\n\n       1 !NTITLE\n REMARKS written by Catena: masses and bonds of the sites "
        "in topology.pdb\n\n");
    out.write(fmt::format("{:8} !NATOM\n", topology.mass.size()));
    for (std::size_t c = 0; c < topology.chains.size(); ++c) {
        Topology::Chain const& chain = topology.chains[c];
        for (std::int64_t k = 0; k < chain.count; ++k) {
            auto const site = static_cast<std::size_t>(chain.first + k);
            out.write(fmt::format("{:8} {} {} {} CA CA 0.000000 {:.10g} 0\n", site + 1,
                                  chain_name(c), k + 1, field(residue_of(topology, site)),
                                  topology.mass[site]));
        }
    }
    std::vector<Bond> const bonds = bonds_of(topology);
    out.write(fmt::format("\n{:8} !NBOND: bonds", bonds.size()));
    for (std::size_t i = 0; i < bonds.size(); ++i)
        out.write(
            fmt::format("{}{:8}{:8}", i % 4 == 0 ? "\n" : "", bonds[i].first, bonds[i].second));
    out.write("\n\n");
    for (char const* const none : {"!NTHETA: angles", "!NPHI: dihedrals", "!NIMPHI: impropers",
                                   "!NDON: donors", "!NACC: acceptors"})
        out.write(fmt::format("       0 {}\n\n", none));
}

}  // namespace catena
