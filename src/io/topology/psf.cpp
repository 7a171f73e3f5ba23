// Implements topology.psf.
#include "io/topology/psf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace catena {
namespace {

/// Replaces blanks, which would end a field.
std::string field(std::string text) {
    std::replace(text.begin(), text.end(), ' ', '_');
    return text.empty() ? "UNK" : text;
}

}  // namespace

void write_psf(AtomicFile& out, Topology const& topology, SiteNames const& names) {
    out.write(
        "PSF NAMD\n\n       1 !NTITLE\n REMARKS written by Catena: masses and bonds of the sites "
        "in topology.pdb\n\n");
    out.write(fmt::format("{:8} !NATOM\n", topology.mass.size()));
    for (ResidueRun const& run : names.runs())
        for (std::int64_t k = 0; k < run.count; ++k) {
            auto const site = static_cast<std::size_t>(run.first + k);
            out.write(fmt::format("{:8} {} {}{} {} CA CA 0.000000 {:.10g} 0\n", site + 1,
                                  names.identifier(run.member), run.number + run.step * k,
                                  run.insertion == ' ' ? "" : std::string(1, run.insertion),
                                  field(residue_of(topology, site)), topology.mass[site]));
        }
    std::vector<SiteNames::Bond> const bonds = names.bonds();
    out.write(fmt::format("\n{:8} !NBOND: bonds", bonds.size()));
    for (std::size_t i = 0; i < bonds.size(); ++i)
        out.write(fmt::format("{}{:8}{:8}", i % 4 == 0 ? "\n" : "", bonds[i].first + 1,
                              bonds[i].second + 1));
    out.write("\n\n");
    for (char const* const none : {"!NTHETA: angles", "!NPHI: dihedrals", "!NIMPHI: impropers",
                                   "!NDON: donors", "!NACC: acceptors"})
        out.write(fmt::format("       0 {}\n\n", none));
}

}  // namespace catena
