// Implements the gathering of atoms into residues.
#include "structure/structure_residues.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace catena::scene {

namespace {

/// Separates water and ions from other residues, because their numbers often restart at 1.
int realm(PdbAtom const& atom) {
    ResidueKind const kind = meaning_of(atom.residue).kind;
    return kind == ResidueKind::water ? 1 << 20 : kind == ResidueKind::ion ? 2 << 20 : 0;
}

}  // namespace

std::string label_of(PdbAtom const& atom) {
    auto const number = residue_number(atom.number);
    std::string label = number && *number < 10000
                            ? std::to_string(*number)
                            : shown(atom.number);  // larger numbers stay as written
    if (atom.insertion != ' ') label += shown(std::string_view(&atom.insertion, 1));
    return label;
}

std::string name_of(StructureResidue const& residue) {
    PdbAtom const& atom = residue.front();
    std::string text = shown(atom.residue);
    if (!atom.number.empty()) text += " " + label_of(atom);
    if (!chain_of(atom).empty()) text += " of chain " + shown(chain_of(atom));
    return text;
}

std::string place_of(PdbAtom const& atom) {
    return fmt::format(fmt::runtime(atom.row ? "row {} of _atom_site" : "line {}"), atom.line);
}

void ResidueGathering::add(PdbAtom const& atom) {
    if (!residues.empty() && continues(atom)) return residues.back().atoms.push_back(atom);
    auto const number = residue_number(atom.number);
    if (number) {
        if (!residues.empty() && !atom.same_chain(residues.back().front())) lap_ = 0;
        if (last_ == 9999 && *number <= 1)
            ++lap_;  // writers without a fifth digit restart at 0 or 1
        auto const key = std::tuple(atom.part, atom.chain, atom.segment, lap_ + realm(atom),
                                    *number, atom.insertion);
        auto const [known, fresh] = known_.try_emplace(key, residues.size());
        if (!fresh) return add_to(residues[known->second], atom);
        last_ = *number;
    }
    residues.push_back({{atom}, meaning_of(atom.residue)});
}

/// True if the atom belongs to the residue that was read last.
bool ResidueGathering::continues(PdbAtom const& atom) const {
    StructureResidue const& residue = residues.back();
    PdbAtom const& first = residue.front();
    if (!atom.same_chain(first) || atom.number != first.number || atom.insertion != first.insertion)
        return false;
    if (atom.residue != first.residue) return atom.alternate != ' ' && first.alternate != ' ';
    if (residue_number(atom.number)) return true;
    return std::none_of(residue.atoms.begin(), residue.atoms.end(), [&](PdbAtom const& other) {
        return other.name == atom.name && other.alternate == atom.alternate;
    });
}

void ResidueGathering::add_to(StructureResidue& residue, PdbAtom const& atom) {
    if (atom.residue != residue.front().residue &&
        (atom.alternate == ' ' || residue.front().alternate == ' '))
        fail(at_,
             fmt::format("residue {} of `{}` comes again as {} ({})", name_of(residue),
                         shown_path(path_), shown(atom.residue), place_of(atom)),
             "give each residue its own number or insertion code");
    residue.atoms.push_back(atom);
}

}  // namespace catena::scene
