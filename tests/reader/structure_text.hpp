// One structure as a PDB file and as an mmCIF file.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

namespace catena::test {

/// One atom of a structure; coordinates in angstrom.
struct AtomLine {
    std::string name, residue, chain;
    int number = 1;
    double x = 0, y = 0, z = 0;
    char alternate = ' ', insertion = ' ';
    double occupancy = 1;
    bool het = false;
    std::string element = "C";
    /// True if a TER record follows.
    bool ends_chain = false;
    int model = 1;
    double b_factor = 0;
};

/// A straight piece of a chain along x: one CA atom per residue, 3.8 angstrom apart.
inline std::vector<AtomLine> strand(std::vector<std::string> const& residues,
                                    std::string const& chain, int number, double x, double y = 0) {
    std::vector<AtomLine> atoms;
    for (std::size_t k = 0; k < residues.size(); ++k)
        atoms.push_back({"CA", residues[k], chain, number + static_cast<int>(k),
                         x + 3.8 * static_cast<double>(k), y});
    return atoms;
}

inline std::vector<AtomLine> operator+(std::vector<AtomLine> a, std::vector<AtomLine> const& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

inline std::string pdb_text(std::vector<AtomLine> const& atoms) {
    std::string text;
    int model = 1;
    bool const models = !atoms.empty() && atoms.back().model > 1;
    if (models) text += "MODEL        1\n";
    for (AtomLine const& a : atoms) {
        if (a.model != model) text += fmt::format("ENDMDL\nMODEL     {:4}\n", model = a.model);
        std::string const name = a.element.size() == 2 ? a.name : " " + a.name;
        text += fmt::format(
            "{:6}{:5} {:4}{}{:3} {:1}{:4}{}   {:8.3f}{:8.3f}{:8.3f}{:6.2f}{:6.2f}"
            "          {:>2}\n",
            a.het ? "HETATM" : "ATOM", 1, name, a.alternate, a.residue, a.chain, a.number,
            a.insertion, a.x, a.y, a.z, a.occupancy, a.b_factor, a.element);
        if (a.ends_chain) text += "TER\n";
    }
    if (models) text += "ENDMDL\n";
    return text;
}

/// The same atoms as a table of mmCIF. Labels are other letters than the authors', and a new one
/// follows each end of a chain. `sequence` holds the residues of entity 1, to which all atoms
/// belong.
inline std::string cif_text(std::vector<AtomLine> const& atoms,
                            std::vector<std::string> const& sequence = {}) {
    std::string text =
        "# a comment first\ndata_TEST\n_entry.id TEST\n_struct.title\n;A title of two lines,\n"
        "loop_ and _atom_site.id in it\n;\n";
    if (!sequence.empty())
        text +=
            "loop_\n_entity_poly_seq.entity_id\n_entity_poly_seq.num\n"
            "_entity_poly_seq.mon_id\n";
    for (std::size_t k = 0; k < sequence.size(); ++k)
        text += fmt::format("1 {} {}\n", k + 1, sequence[k]);
    text += "loop_\n";
    for (char const* const item :
         {"group_PDB", "id", "type_symbol", "label_atom_id", "label_alt_id", "label_comp_id",
          "label_asym_id", "label_entity_id", "label_seq_id", "pdbx_PDB_ins_code", "Cartn_x",
          "Cartn_y", "Cartn_z", "occupancy", "B_iso_or_equiv", "auth_seq_id", "auth_asym_id",
          "pdbx_PDB_model_num"})
        text += fmt::format("_atom_site.{}\n", item);
    char label = 'P';
    std::string chain = atoms.empty() ? "" : atoms[0].chain;
    bool ended = false;
    int model = 1;
    for (std::size_t k = 0; k < atoms.size(); ++k) {
        AtomLine const& a = atoms[k];
        if (a.model != model) {
            label = 'P';
            model = a.model;
        } else if (a.chain != chain || ended) {
            ++label;
        }
        chain = a.chain;
        ended = a.ends_chain;
        auto const or_null = [](char c, char null) { return c == ' ' ? null : c; };
        text += fmt::format(
            "{} {} {} \"{}\" {} '{}' {} 1 {} {} {:.3f} {:.3f} {:.3f} {:.2f} {:.2f} {} {} {}\n",
            a.het ? "HETATM" : "ATOM", k + 1, a.element, a.name, or_null(a.alternate, '.'),
            a.residue, label, sequence.empty() ? "." : std::to_string(a.number),
            or_null(a.insertion, '?'), a.x, a.y, a.z, a.occupancy, a.b_factor, a.number, a.chain,
            a.model);
    }
    return text;
}

}  // namespace catena::test
