// This header reads particles, box and kinds of forces off a serialised System without OpenMM.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "math/linear.hpp"

namespace catena::foreign {

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
    /// True if the System holds a force of that kind, such as CustomExternalForce.
    bool holds(std::string const& kind) const;
    /// Throws InputError with the line if the text is not well-formed XML.
    void refuse_damaged() const;

  private:
    std::string file_, text_;
};

}  // namespace catena::foreign
