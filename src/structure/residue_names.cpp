// Implements the table of residue names.
#include "structure/residue_names.hpp"

#include <cctype>
#include <span>
#include <sstream>
#include <unordered_map>

namespace catena::scene {

namespace {

using Meanings = std::unordered_map<std::string, ResidueMeaning>;

/// Names, separated by blanks, that mean `parent`.
struct Family {
    char const* parent;
    char const* names;
};

/// Residues with the charge of their parent. Protonation states and names of force fields (Amber,
/// CHARMM, GROMACS); the wwPDB's common modifications without a change of charge. Mirror images are
/// included, which one bead cannot tell apart.
Family const renamed[] = {
    {"ALA", "ALA DAL AIB ABA"},
    {"ARG", "ARG DAR ARGN AGM"},
    {"ASN", "ASN DSG MEN"},
    {"ASP", "ASP ASH ASPH ASPP BHD DAS"},
    {"CYS", "CYS CYX CYM CYS2 CYSH CYN SEC CSO CSX CME CSS CMT SMC YCM DCY"},
    {"GLN", "GLN DGN MEQ"},
    {"GLU", "GLU GLH GLUH GLUP DGL"},
    {"GLY", "GLY SAR"},
    {"HIS", "HIS HIE HID HIP HSD HSE HSP HISA HISB HISD HISE HISH HIS1 HIS2 MHS HIC DHI"},
    {"ILE", "ILE DIL"},
    {"LEU", "LEU DLE NLE"},
    {"LYS", "LYS LYN LYSH LSN MLZ MLY M3L DLY"},
    {"MET", "MET MSE FME MHO SME OMT MED"},
    {"PHE", "PHE DPN"},
    {"PRO", "PRO HYP DPR"},
    {"SER", "SER DSN"},
    {"THR", "THR DTH"},
    {"TRP", "TRP DTR"},
    {"TYR", "TYR DTY"},
    {"VAL", "VAL DVA NVA"},
};

/// Residues with another charge than their parent: phosphates, sulfates, carboxylates. Lysine,
/// arginine and glutamate that have lost their charge are included.
Family const recharged[] = {
    {"SER", "SEP S1P"},     {"THR", "TPO T1P"},
    {"TYR", "PTR Y1P TYS"}, {"HIS", "NEP H1D H2D H1E H2E"},
    {"CYS", "CSD CSP OCS"}, {"LYS", "KCX ALY PYL LLP"},
    {"ARG", "CIR"},         {"GLU", "CGU PCA"},
    {"ASP", "PHD"},
};

Family const caps[] = {{"", "ACE NME NMA NH2 NHE FOR CT3"}};
Family const waters[] = {
    {"", "HOH WAT DOD H2O OH2 TIP TIP2 TIP3 TIP4 TIP5 TP3 TP4 T3P T4P SOL SPC SPCE W"}};
Family const ions[] = {{"",
                        "LI LI+ LIT NA NA+ SOD NIO K K+ POT RB RB+ RUB CS CS+ CES MG MG2 CA CA2 "
                        "CAL SR BA BAR ZN ZN2 MN MN3 FE FE2 CO 3CO "
                        "NI 3NI CU CU1 CD CD2 HG AL AG AU PT PB F CL CL- CLA CIO BR BR- IOD YB YT3 "
                        "SM GD GD3 TB LA EU PR HO LU TL IR V CR "
                        "GA IN PD OS RE U1"}};

void add(Meanings& all, std::span<Family const> families, ResidueKind kind) {
    for (Family const& family : families) {
        std::istringstream names(family.names);
        for (std::string name; names >> name;) all[name] = {kind, family.parent};
    }
}

Meanings all_meanings() {
    Meanings all;
    add(all, ions, ResidueKind::ion);
    add(all, waters, ResidueKind::water);
    add(all, caps, ResidueKind::cap);
    add(all, recharged, ResidueKind::charged);
    add(all, renamed, ResidueKind::amino_acid);
    return all;
}

}  // namespace

ResidueMeaning meaning_of(std::string_view name) {
    static Meanings const all = all_meanings();
    std::string key;
    for (char const c : name)
        if (c != ' ') key += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if (auto const found = all.find(key); found != all.end()) return found->second;
    bool const end = key.size() == 4 && (key[0] == 'N' || key[0] == 'C');
    auto const inner = end ? all.find(key.substr(1)) : all.end();
    return inner != all.end() && inner->second.kind == ResidueKind::amino_acid ? inner->second
                                                                               : ResidueMeaning{};
}

bool is_amino_acid(std::string_view name) {
    ResidueKind const kind = meaning_of(name).kind;
    return kind == ResidueKind::amino_acid || kind == ResidueKind::charged;
}

bool is_nucleotide(std::string_view name) {
    while (!name.empty() && name.front() == ' ') name.remove_prefix(1);
    while (!name.empty() && name.back() == ' ') name.remove_suffix(1);
    bool const has_end = name.size() > 1 && (name.back() == '5' || name.back() == '3');
    if (has_end) name.remove_suffix(1);
    bool const has_kind = name.size() == 2 && (name[0] == 'D' || name[0] == 'R');
    if (has_kind) name.remove_prefix(1);
    return name.size() == 1 && std::string_view("ACGTUI").find(name[0]) != std::string_view::npos;
}

}  // namespace catena::scene
