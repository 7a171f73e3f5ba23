// Random starts of bead chains as tables, and what programs and people do to them.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "math/linear.hpp"
#include "tests/cases/structures_generator.hpp"

namespace catena::test {

double constexpr model_link = 0.38;  // nm

/// Plain minimum image, of nothing but this test.
inline Vec3 nearest_image(Vec3 way, double edge) {
    for (int i = 0; i < 3; ++i) {
        while (way[i] > 0.5 * edge) way[i] -= edge;
        while (way[i] < -0.5 * edge) way[i] += edge;
    }
    return way;
}

/// Chains in a cubic box, as they are meant; then tables with damage.
struct Start {
    double edge = 12;
    std::vector<std::vector<Vec3>> chains;
    std::vector<std::string> lines = {};  // of chain 1, where its table is damaged as text
    bool units_of_angstrom = false;
};

inline std::string table_of(Start const& start, std::size_t chain) {
    std::string text;
    if (chain == 0 && !start.lines.empty()) {
        for (std::string const& line : start.lines) text += line + "\n";
        return text;
    }
    double const unit = start.units_of_angstrom ? 10 : 1;
    char line[120];
    for (Vec3 const& x : start.chains[chain]) {
        std::snprintf(line, sizeof line, "%.6f,%.6f,%.6f\n", unit * x[0], unit * x[1], unit * x[2]);
        text += line;
    }
    return text;
}

inline std::vector<std::string> lines_of(Start const& start) {
    std::vector<std::string> lines;
    std::string const text = table_of(start, 0);
    for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1)
        lines.push_back(text.substr(at, text.find('\n', at) - at));
    return lines;
}

/// Beads of all chains that no link joins: their smallest distance by nearest images.
inline double nearest_of(Start const& start) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < start.chains.size(); ++c)
        for (std::size_t k = 0; k < start.chains[c].size(); ++k)
            for (std::size_t d = c; d < start.chains.size(); ++d)
                for (std::size_t l = d == c ? k + 2 : 0; l < start.chains[d].size(); ++l)
                    nearest = std::min(
                        nearest,
                        norm(nearest_image(start.chains[c][k] - start.chains[d][l], start.edge)));
    return nearest;
}

class StartGenerator : public Generator {
  public:
    using Generator::Generator;

    /// 2 or 3 chains of different sizes that are apart from each other: random walks, straight or
    /// bent at each link, or as a run with springs in the links' place leaves them.
    Start start() {
        Start made;
        int const kind = whole(0, 3);
        std::size_t const chains = index(2, 4);
        for (std::size_t c = 0; c < chains; ++c) {
            std::size_t const beads = index(8, 12) + 4 * c;
            Vec3 const corner{{3 + 0.1 * uniform(0, 1), 3 + 2.5 * static_cast<double>(c), 4}};
            made.chains.push_back(kind == 0   ? straight(beads, corner)
                                  : kind == 1 ? zigzag(beads, corner)
                                              : walk(beads, corner));
            if (kind == 3) loosen(made.chains.back());
        }
        return made;
    }

  private:
    static std::vector<Vec3> straight(std::size_t beads, Vec3 const& corner) {
        std::vector<Vec3> at;
        for (std::size_t k = 0; k < beads; ++k)
            at.push_back(corner + Vec3{{model_link * static_cast<double>(k), 0, 0}});
        return at;
    }
    static std::vector<Vec3> zigzag(std::size_t beads, Vec3 const& corner) {
        double const step = model_link / std::sqrt(2.0);
        std::vector<Vec3> at;
        for (std::size_t k = 0; k < beads; ++k)
            at.push_back(corner + Vec3{{step * static_cast<double>(k),
                                        step * static_cast<double>(k % 2), 0}});
        return at;
    }
    /// Turned by up to 60 degrees at each bead, within 1 nm of a line, so that chains keep apart. A
    /// walk that has come to a dead end begins again.
    std::vector<Vec3> walk(std::size_t beads, Vec3 const& corner) {
        int constexpr patience = 10000;
        Vec3 const ahead{{1, 0, 0}};
        std::vector<Vec3> at{corner};
        Vec3 along = ahead;
        for (int tries = 0; at.size() < beads; ++tries) {
            if (tries == patience) at = {corner}, along = ahead, tries = 0;
            Vec3 const next = along + 0.8 * direction();
            Vec3 const step = (model_link / norm(next)) * next;
            Vec3 const there = at.back() + step;
            if (step[0] < 0.5 * model_link || std::abs(there[1] - corner[1]) > 0.9 ||
                std::abs(there[2] - corner[2]) > 0.9)
                continue;
            at.push_back(there);
            along = (1 / model_link) * step;
            tries = 0;
        }
        return at;
    }
    /// Links as long as springs of 8033 kJ/mol/nm2 are at 293 K.
    void loosen(std::vector<Vec3>& chain) {
        std::vector<Vec3> const straight_links = chain;
        for (std::size_t k = 1; k < chain.size(); ++k) {
            double const part = 1 + normal(0.0174) / model_link;
            chain[k] = chain[k - 1] + part * (straight_links[k] - straight_links[k - 1]);
        }
    }
};

/// What must become of a start. open: as it is, with a note or without. relaxed: opens, and its
/// forces are absurd until they are relaxed.
enum class Becomes { open, open_with_note, refused, absurd };

struct StartDamage {
    char const* name;
    Becomes must;
    std::function<void(Start&, StartGenerator&)> apply;
};

inline void wrap_start(Start& s, StartGenerator& g) {
    Vec3 const by{{g.uniform(0, s.edge), g.uniform(0, s.edge), g.uniform(0, s.edge)}};
    for (auto& chain : s.chains)
        for (Vec3& x : chain)
            for (int i = 0; i < 3; ++i) x[i] += by[i], x[i] -= s.edge * std::floor(x[i] / s.edge);
}

inline void move_chains_by_edges(Start& s, StartGenerator& g) {
    for (auto& chain : s.chains) {
        Vec3 by;
        for (int i = 0; i < 3; ++i) by[i] = s.edge * g.whole(-3, 3);
        for (Vec3& x : chain) x = x + by;
    }
}

/// The last chain as a whole, so that one of its beads comes to stand near a bead of the first one.
inline void overlap_chains(Start& s, StartGenerator& g) {
    auto& last = s.chains.back();
    Vec3 const to = s.chains[0][g.index(0, s.chains[0].size())] + g.uniform(0, 0.2) * g.direction();
    Vec3 const by = to - last[g.index(0, last.size())];
    for (Vec3& x : last) x = x + by;
}

/// Folds chain 1 onto itself: from one bead on it goes back where it came from.
inline void fold_chain(Start& s, StartGenerator& g) {
    auto& chain = s.chains[0];
    std::size_t const turn = g.index(2, chain.size() - 3);
    Vec3 const aside{{0, 0, 0.05}};
    std::vector<Vec3> const given = chain;
    for (std::size_t k = turn + 1; k < chain.size(); ++k) {
        std::size_t const back = 2 * turn >= k ? 2 * turn - k : 0;
        chain[k] = 2 * turn >= k ? given[back] + aside
                                 : chain[k - 1] + (given[k - turn] - given[k - turn - 1]);
    }
    double const length = norm(chain[turn + 1] - chain[turn]);  // as long as it was
    for (std::size_t k = turn + 1; k < chain.size(); ++k)
        chain[k] = chain[k] + (model_link / length - 1) * (given[turn - 1] + aside - given[turn]);
}

/// From one bead on everything moves along the link before it.
inline void change_link(Start& s, StartGenerator& g, double least, double most) {
    auto& chain = s.chains[g.index(0, s.chains.size())];
    std::size_t const k = g.index(1, chain.size());
    Vec3 const link = chain[k] - chain[k - 1];
    double const to = model_link * g.uniform(least, most) / norm(link);
    for (std::size_t l = k; l < chain.size(); ++l) chain[l] = chain[l] + (to - 1) * link;
}

inline void add_noise_to(Start& s, StartGenerator& g, double deviation) {
    for (auto& chain : s.chains)
        for (Vec3& x : chain)
            x = x + Vec3{{g.normal(deviation), g.normal(deviation), g.normal(deviation)}};
}

inline void damage_line(Start& s, StartGenerator& g, char const* cell) {
    s.lines = lines_of(s);
    std::string& line = s.lines[g.index(0, s.lines.size())];
    line = cell + line.substr(line.find(','));
}

inline void lose_line(Start& s, StartGenerator& g) {
    s.lines = lines_of(s);
    s.lines.erase(s.lines.begin() + static_cast<std::ptrdiff_t>(g.index(0, s.lines.size())));
}

inline void repeat_line(Start& s, StartGenerator& g) {
    s.lines = lines_of(s);
    std::size_t const k = g.index(0, s.lines.size());
    s.lines.insert(s.lines.begin() + static_cast<std::ptrdiff_t>(g.index(0, s.lines.size())),
                   s.lines[k]);
}

inline void stand_on(Start& s, StartGenerator& g) {
    auto& chain = s.chains[0];
    std::size_t const k = g.index(1, chain.size());
    chain[k] = chain[k - 1];
}

inline void swap_beads(Start& s, StartGenerator& g) {
    auto& chain = s.chains[0];
    std::size_t const k = g.index(0, chain.size() - 4);
    std::swap(chain[k], chain[k + g.index(3, 4)]);
}

/// Chain 1 gets the frame of another number of beads.
inline void swap_chains(Start& s, StartGenerator&) { std::swap(s.chains[0], s.chains[1]); }

inline std::vector<StartDamage> const start_damages = {
    {"none", Becomes::open, [](Start&, StartGenerator&) {}},
    {"moved by edges", Becomes::open, move_chains_by_edges},
    {"wrapped", Becomes::open, wrap_start},
    {"little noise", Becomes::open, [](Start& s, StartGenerator& g) { add_noise_to(s, g, 0.001); }},
    {"longer link", Becomes::open_with_note,
     [](Start& s, StartGenerator& g) { change_link(s, g, 1.06, 1.28); }},
    {"shorter link", Becomes::open_with_note,
     [](Start& s, StartGenerator& g) { change_link(s, g, 0.72, 0.94); }},
    {"stretched link", Becomes::refused,
     [](Start& s, StartGenerator& g) { change_link(s, g, 1.32, 4); }},
    {"compressed link", Becomes::refused,
     [](Start& s, StartGenerator& g) { change_link(s, g, 0.02, 0.68); }},
    {"overlap", Becomes::absurd, overlap_chains},
    {"fold", Becomes::absurd, fold_chain},
    {"not a number", Becomes::refused,
     [](Start& s, StartGenerator& g) { damage_line(s, g, "nan"); }},
    {"infinite", Becomes::refused, [](Start& s, StartGenerator& g) { damage_line(s, g, "-inf"); }},
    {"a word", Becomes::refused, [](Start& s, StartGenerator& g) { damage_line(s, g, "1.0.3"); }},
    {"a bead too few", Becomes::refused, lose_line},
    {"a bead twice", Becomes::refused, repeat_line},
    {"a bead on the one before", Becomes::refused, stand_on},
    {"swapped beads", Becomes::refused, swap_beads},
    {"another chain's frame", Becomes::refused, swap_chains},
    {"angstrom", Becomes::refused, [](Start& s, StartGenerator&) { s.units_of_angstrom = true; }},
};

}  // namespace catena::test
