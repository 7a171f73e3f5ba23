// Springs that rigid links can replace. This header does not need OpenMM.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace catena {

/// The stiff harmonic bonds and constraints between two particles of a System.
struct Joining {
    /// Common rest length, nm; NaN if nothing joins the particles.
    double length = std::numeric_limits<double>::quiet_NaN();
    /// Sum of all stiffnesses, kJ/mol/nm2; infinite for a constraint.
    double stiffness = 0;
    /// Number of harmonic bonds.
    int springs = 0;
    /// True if the springs alone have different rest lengths.
    bool differ = false;

    /// True if anything joins the particles.
    bool holds() const { return stiffness > 0; }
    /// Adds a spring. Parallel springs rest at the mean of their lengths, weighted by stiffness.
    /// Precondition: no constraint has been added.
    void add_spring(double rest, double k);
    /// Adds a constraint, which fixes the length exactly and overrides all springs.
    void add_constraint(double rest);
    /// Thermal spread sqrt(kT/k) relative to the length; temperature in K.
    double spread(double temperature) const;
    /// True if this joins its particles at least half as stiffly as `link` does. If that is a
    /// constraint, this must be stiff enough for a link.
    bool is_like(Joining const& link, double temperature) const;
};

/// Collects the links of a System's chains and judges the springs that they replace.
class StiffLinks {
  public:
    /// Largest relative thermal spreads of bonds that become links: without a note, and with one.
    static double constexpr stiff = 0.05, softest = 0.20;

    /// Temperature in K. `where` is the scene file and key in messages.
    StiffLinks(double temperature, std::string where)
        : temperature_(temperature), where_(std::move(where)) {}
    /// Adds the link between particles a and b (from 0). Throws InputError if a rigid link is
    /// meaningless: a spread above `softest`, or a length of 0.
    void add(std::int64_t a, std::int64_t b, Joining const&);
    /// Sentences on links that replace soft springs, and on links that replace several springs of
    /// different lengths.
    std::vector<std::string> notes() const;
    /// Largest relative spread of a link that replaces a soft spring; 0 if there is none.
    double largest_spread() const { return soft_.count > 0 ? soft_.worst.spread(temperature_) : 0; }

  private:
    /// Links of one kind of note.
    struct Some {
        std::int64_t count = 0, a = 0, b = 0;  // number of links, and the particles of the worst
        Joining worst;
    };
    double temperature_;
    std::string where_;
    Some soft_, several_;
};

}  // namespace catena
