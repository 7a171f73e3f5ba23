// One-letter sequences: FASTA files, and detection of common mistakes in written sequences.
#pragma once

#include <string>
#include <vector>

#include "scene/node.hpp"
#include "scene/scene.hpp"
#include "structure/residue_table.hpp"

namespace catena::scene {

/// Selects a record of a FASTA file. `record` (a name or a number from 1) takes precedence, then
/// the record with the chain's `name`, then the only record. Either pointer may be nullptr.
struct RecordChoice {
    Node const* record = nullptr;
    Node const* name = nullptr;
};

/// Returns the sequence of the selected record with its line breaks; a closing `*` is dropped.
/// Throws InputError if no record or several records match; the message names the first few.
std::string read_fasta(std::string const& path, Node const& at, RecordChoice const& choice);

/// Returns one-letter codes of the table, without blanks. A lower-case letter that is no code of
/// the table is read as a capital. Such letters, three-letter codes and nucleotides get a note.
/// Throws InputError with the position for any letter that is no code of the table.
std::string one_letter_codes(std::string const& text, Node const& source, ResidueTable const& table,
                             Scene& scene);

}  // namespace catena::scene
