#include "scene/residue_names.hpp"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <unordered_map>

namespace catena::scene {

namespace {

using Meanings = std::unordered_map<std::string, ResidueMeaning>;

struct Family {
    char const* parent;
    std::initializer_list<char const*> names;
};

/// Protonation states and force fields' names (Amber, CHARMM, GROMACS), the wwPDB's common modifications without a change of charge, and
/// mirror images, which one bead cannot tell apart.
std::initializer_list<Family> const renamed = {
    {"ALA", {"DAL", "AIB", "ABA"}},
    {"ARG", {"DAR", "ARGN", "AGM"}},
    {"ASN", {"DSG", "MEN"}},
    {"ASP", {"ASH", "ASPH", "ASPP", "DAS"}},
    {"CYS", {"CYX", "CYM", "CYS2", "CYSH", "CYN", "SEC", "CSO", "CSX", "CME", "CSS", "CMT", "SMC", "YCM", "DCY"}},
    {"GLN", {"DGN", "MEQ"}},
    {"GLU", {"GLH", "GLUH", "GLUP", "DGL"}},
    {"GLY", {"SAR", "GLZ"}},
    {"HIS", {"HIE", "HID", "HIP", "HSD", "HSE", "HSP", "HISA", "HISB", "HISD", "HISE", "HISH", "HIS1", "HIS2", "MHS", "HIC", "DHI"}},
    {"ILE", {"DIL"}},
    {"LEU", {"DLE", "NLE"}},
    {"LYS", {"LYN", "LYSH", "LSN", "MLZ", "MLY", "M3L", "DLY"}},
    {"MET", {"MSE", "FME", "MHO", "SME", "OMT", "MED"}},
    {"PHE", {"DPN"}},
    {"PRO", {"HYP", "DPR"}},
    {"SER", {"DSN"}},
    {"THR", {"DTH"}},
    {"TRP", {"DTR"}},
    {"TYR", {"DTY"}},
    {"VAL", {"DVA", "NVA"}},
};

/// Phosphates, sulfates, carboxylates, and lysine, arginine and glutamate that have lost their charge.
std::initializer_list<Family> const recharged = {
    {"SER", {"SEP", "S1P", "SP1", "SP2"}},
    {"THR", {"TPO", "T1P", "THP"}},
    {"TYR", {"PTR", "Y1P", "TYS", "TP1"}},
    {"HIS", {"NEP", "HIP1", "HIP2"}},
    {"CYS", {"CSD", "CSP", "OCS"}},
    {"LYS", {"KCX", "ALY", "PYL", "LLP", "CRQ"}},
    {"ARG", {"CIR"}},
    {"GLU", {"CGU", "PCA", "PCE"}},
    {"ASP", {"PHD", "BHD"}},
};

char const* const twenty[] = {"ALA", "ARG", "ASN", "ASP", "CYS", "GLN", "GLU", "GLY", "HIS", "ILE",
                              "LEU", "LYS", "MET", "PHE", "PRO", "SER", "THR", "TRP", "TYR", "VAL"};
char const* const caps[] = {"ACE", "NME", "NMA", "NH2", "NHE", "FOR", "ACT1", "CT3"};
char const* const waters[] = {"HOH", "WAT", "DOD", "H2O", "OH2", "TIP",  "TIP2", "TIP3", "TIP4", "TIP5",
                              "TP3", "TP4", "T3P", "T4P", "SOL", "SPCE", "SPC",  "SPE",  "HH0",  "W"};
char const* const ions[] = {"LI",  "LI+", "LIT", "NA",  "NA+", "SOD", "NIO", "K",   "K+",  "POT", "RB",  "RB+", "RUB", "CS", "CS+",
                            "CES", "MG",  "MG2", "CA",  "CA2", "CAL", "SR",  "BA",  "BAR", "ZN",  "ZN2", "MN",  "MN3", "FE", "FE2",
                            "CO",  "3CO", "NI",  "3NI", "CU",  "CU1", "CD",  "CD2", "HG",  "AL",  "AG",  "AU",  "PT",  "PB", "F",
                            "CL",  "CL-", "CLA", "CIO", "BR",  "BR-", "IOD", "YB",  "YT3", "SM",  "GD",  "GD3", "TB",  "LA", "EU",
                            "PR",  "HO",  "LU",  "TL",  "IR",  "V",   "CR",  "GA",  "IN",  "PD",  "OS",  "RE",  "U1"};

void add(Meanings& all, std::initializer_list<Family> const& families, ResidueKind kind) {
    for (Family const& family : families)
        for (char const* const name : family.names) all[name] = {kind, family.parent};
}

template <std::size_t N>
void add(Meanings& all, char const* const (&names)[N], ResidueKind kind) {
    for (char const* const name : names) all[name] = {kind, kind == ResidueKind::amino_acid ? name : ""};
}

Meanings all_meanings() {
    Meanings all;
    add(all, ions, ResidueKind::ion);
    add(all, waters, ResidueKind::water);
    add(all, caps, ResidueKind::cap);
    add(all, recharged, ResidueKind::charged);
    add(all, renamed, ResidueKind::amino_acid);
    add(all, twenty, ResidueKind::amino_acid);
    return all;
}

}  // namespace

ResidueMeaning meaning_of(std::string_view name) {
    static Meanings const all = all_meanings();
    std::string key;
    for (char const c : name)
        if (c != ' ') key += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    auto const found = all.find(key);
    return found == all.end() ? ResidueMeaning{} : found->second;
}

}  // namespace catena::scene
