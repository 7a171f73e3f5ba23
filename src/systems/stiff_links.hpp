// Which springs rigid links can stand for. No OpenMM here.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace catena {

/// What holds two particles of a System together: harmonic bonds that have a stiffness, and
/// constraints.
struct Joining {
    double length = std::numeric_limits<double>::quiet_NaN();  // nm, at which all of it rests; NaN:
                                                               // nothing holds them
    double stiffness = 0;  // kJ/mol/nm2, of all; infinite: a constraint
    int springs = 0;
    bool differ = false;  // the springs alone would rest at different lengths

    bool holds() const { return stiffness > 0; }
    /// Together springs rest at the mean of their lengths, weighted by stiffness. No constraint may
    /// have been added before.
    void add_spring(double rest, double k);
    /// A constraint holds exactly, so it has the last word.
    void add_constraint(double rest);
    /// sqrt(kT/k) relative to the length; temperature in K.
    double spread(double temperature) const;
};

/// Collects the links of a System's chains and judges the springs that they replace.
class StiffLinks {
  public:
    static double constexpr stiff = 0.05, softest = 0.20;  // largest spreads of bonds that become
                                                           // links: without a note, and with one

    /// Temperature in K. `where`: scene file and key, for messages.
    StiffLinks(double temperature, std::string where)
        : temperature_(temperature), where_(std::move(where)) {}
    /// The link between particles a and b (from 0). Throws InputError where no rigid link has a
    /// meaning: a spread above `softest`, a length of 0.
    void add(std::int64_t a, std::int64_t b, Joining const&);
    /// Of links that replace soft springs, and several springs of different lengths; a sentence for
    /// each kind.
    std::vector<std::string> notes() const;
    /// The largest spread of a link that stands for a soft spring; 0 of none.
    double largest_spread() const { return soft_.count > 0 ? soft_.worst.spread(temperature_) : 0; }

  private:
    struct Some {
        std::int64_t count = 0, a = 0, b = 0;  // how many, and the particles of the worst
        Joining worst;
    };
    double temperature_;
    std::string where_;
    Some soft_, several_;
};

}  // namespace catena
