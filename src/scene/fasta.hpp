// Sequences of one-letter codes: FASTA files, and slips in what people write.
#pragma once

#include <string>
#include <vector>

#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Which record of a FASTA file is meant: `record` (a name or a number from 1) where it is given,
/// else the one that bears the chain's `name`, else the only one. Either may be nullptr.
struct RecordChoice {
    Node const* record = nullptr;
    Node const* name = nullptr;
};

/// The sequence of that record, its lines kept apart; a closing `*` is dropped. InputError where
/// none is meant or several are; it names the first few.
std::string read_fasta(std::string const& path, Node const& at, RecordChoice const& choice);

/// One-letter codes in capitals, without blanks. Small letters, three-letter codes and nucleotides
/// get a note. InputError, with the position, for anything but the codes of the twenty amino acids.
std::string one_letter_codes(std::string const& text, Node const& source, Scene& scene);

}  // namespace catena::scene
