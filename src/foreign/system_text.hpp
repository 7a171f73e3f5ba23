// This header reads particles, box and kinds of forces off a serialised System without OpenMM.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "math/linear.hpp"

namespace catena::foreign {

/// One force in the text of a System.
struct ForceText {
    std::string kind;    // such as CustomBondForce
    std::string energy;  // its expression; empty without one
    /// Defaults of its global parameters.
    std::map<std::string, double> globals;
    /// Different stiffnesses of its harmonic bonds, kJ/mol/nm2.
    std::set<double> stiffness;
};

/// Text of a serialised System. It is not checked: damage is found by refuse_damaged().
class SystemText {
  public:
    /// Reads the file. Throws InputError if that fails.
    explicit SystemText(std::string file);

    std::string const& file() const { return file_; }
    /// Returns the number of tags between <Particles> and </Particles>.
    std::size_t particles() const;
    /// Returns the edges of the default box, nm; nothing if they cannot be found.
    std::optional<Vec3> box() const;
    /// Returns the System's forces in their order. What cannot be read is left out.
    std::vector<ForceText> forces() const;
    /// True if the System holds a force of that kind, such as CustomExternalForce.
    bool holds(std::string const& kind) const;
    /// Throws InputError with the line if the text is not well-formed XML.
    void refuse_damaged() const;

  private:
    std::string file_, text_;
};

}  // namespace catena::foreign
