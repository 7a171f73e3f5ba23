// A structure file of either format of the Protein Data Bank.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "structure/pdb_file.hpp"

namespace catena::scene {

/// A PDB or mmCIF file in memory, told apart by its content. Atoms refer to it, so it must outlive
/// them.
class StructureFile {
  public:
    /// Takes the file's bytes; a gzip file is unpacked. `path` is the name in messages. Throws
    /// InputError.
    StructureFile(std::string bytes, std::string path);

    /// The file's bytes, unpacked.
    std::string const& text() const { return text_; }
    /// Calls `take` for each atom of the model of the number `model`, else of the first model.
    PdbSummary for_each_atom(std::optional<std::int64_t> model, TakeAtom const& take) const;

  private:
    std::string text_, path_;
    std::shared_ptr<void const> tables_;  // nullptr for a PDB file
};

}  // namespace catena::scene
