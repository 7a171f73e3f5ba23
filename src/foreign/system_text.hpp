// This header reads particles, box and kinds of forces off a serialised System without OpenMM.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "math/linear.hpp"

namespace catena::foreign {

/// A bond or angle in the text of a System.
struct BondText {
    /// Length in nm and stiffness in kJ/mol/nm2 of a harmonic bond, rad and kJ/mol/rad2 of a
    /// harmonic angle, or the first two parameters of a custom bond.
    double length, stiffness;
    std::int64_t first, second;  // particles
    double third = 0;            // third parameter of a custom bond; 0 without one
};

/// One force in the text of a System.
struct ForceText {
    std::string kind;    // such as CustomBondForce
    std::string energy;  // its expression; empty without one
    /// Defaults of its global parameters.
    std::map<std::string, double> globals;
    double cutoff = 0;  // nm
    /// False if `usesPeriodic` says that it does not use the box.
    bool periodic = true;
    std::vector<BondText> bonds;  // or angles, with their first two particles
    /// Particles on which a CustomExternalForce acts.
    std::vector<std::int64_t> pulled;
    /// First three parameters of the particles of a CustomNonbondedForce; 0 for those that it does
    /// not have.
    std::vector<std::array<double, 3>> parameters;
};

/// Text of a serialised System. It is not checked: damage is found by refuse_damaged().
class SystemText {
  public:
    /// Reads the file. Throws InputError if that fails.
    explicit SystemText(std::string file);

    std::string const& file() const { return file_; }
    /// Returns the file's name without its folder, for messages.
    std::string name() const;
    /// Returns the number of tags between <Particles> and </Particles>.
    std::size_t particles() const;
    /// Returns the masses of the particles, amu. What cannot be read is left out.
    std::vector<double> masses() const;
    /// Returns the edges of the default box, nm; nothing if they cannot be found.
    std::optional<Vec3> box() const;
    /// Returns the System's forces in their order. What cannot be read is left out.
    std::vector<ForceText> const& forces() const;
    /// True if the System holds a force of that kind, such as CustomExternalForce.
    bool holds(std::string const& kind) const;
    /// Throws InputError with the line if the text is not well-formed XML.
    void refuse_damaged() const;

  private:
    std::string file_, text_;
    mutable std::optional<std::vector<ForceText>> forces_;  // read once
};

}  // namespace catena::foreign
