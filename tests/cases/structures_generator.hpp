// Random chains as PDB files, and what people and programs do to them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "math/linear.hpp"

namespace catena::test {

struct Atom {
    std::string name;
    Vec3 position;  // nm
    char alternate = ' ';
    double occupancy = 1;
};

struct Residue {
    std::string name;
    int number;
    char insertion = ' ';
    bool het = false;
    std::vector<Atom> atoms;
};

/// What the file holds, and what the chain is.
struct Structure {
    std::vector<Residue> residues;
    std::vector<std::string> names;
    std::vector<Vec3> positions;
    std::string head, tail = "TER\nEND\n", line_end = "\n", box;
    char chain = 'A';
    std::string segment;
};

/// Other random inputs in every test of them: CATENA_SEED is added to all seeds.
inline unsigned seed_offset() {
    char const* const given = std::getenv("CATENA_SEED");
    return given ? static_cast<unsigned>(std::stoul(given)) : 0;
}

class Generator {
  public:
    explicit Generator(unsigned seed) : random_(seed + seed_offset()) {}

    double uniform(double least, double most) {
        return std::uniform_real_distribution<double>(least, most)(random_);
    }
    int whole(int least, int most) {
        return std::uniform_int_distribution<int>(least, most)(random_);
    }
    double normal(double deviation) {
        return std::normal_distribution<double>(0, deviation)(random_);
    }
    bool coin() { return whole(0, 1) == 1; }
    std::size_t index(std::size_t least, std::size_t end) {
        return static_cast<std::size_t>(whole(static_cast<int>(least), static_cast<int>(end) - 1));
    }
    Vec3 direction() {
        Vec3 const v{{normal(1), normal(1), normal(1)}};
        return (1 / norm(v)) * v;
    }

    /// Alpha carbons 0.38 nm apart, next neighbours 0.5 to 0.73 nm, others 0.4 nm or more; with
    /// backbone atoms every other time.
    Structure structure() {
        char const* const twenty[] = {"ALA", "ARG", "ASN", "ASP", "CYS", "GLN", "GLU",
                                      "GLY", "HIS", "ILE", "LEU", "LYS", "MET", "PHE",
                                      "PRO", "SER", "THR", "TRP", "TYR", "VAL"};
        Structure made;
        made.positions = walk(index(14, 40));
        bool const backbone = coin();
        for (std::size_t k = 0; k < made.positions.size(); ++k) {
            made.names.emplace_back(twenty[whole(0, 19)]);
            made.residues.push_back({made.names.back(),
                                     static_cast<int>(k) + 1,
                                     ' ',
                                     false,
                                     {{"CA", made.positions[k]}}});
            if (backbone) add_backbone(made, k);
        }
        return made;
    }

  private:
    std::vector<Vec3> walk(std::size_t count) {
        std::vector<Vec3> at{{{5, 5, 5}}};
        while (at.size() < count) {
            Vec3 const next = at.back() + 0.38 * direction();
            bool fits = true;
            for (std::size_t k = 0; k + 1 < at.size(); ++k) {
                double const apart = norm(next - at[k]);
                fits = fits && apart > (k + 2 == at.size() ? 0.5 : 0.4) &&
                       (k + 2 != at.size() || apart < 0.73);
            }
            if (fits)
                at.push_back(next);
            else if (++stuck_ % 500 == 0)
                at.resize(1);
        }
        return at;
    }
    /// Carbonyl and nitrogen on the line between alpha carbons, 0.133 nm apart.
    static void add_backbone(Structure& made, std::size_t k) {
        auto const toward = [&](std::size_t other) {
            Vec3 const way = made.positions[other] - made.positions[k];
            return made.positions[k] + (0.1235 / norm(way)) * way;
        };
        std::vector<Atom>& atoms = made.residues[k].atoms;
        if (k > 0) atoms.insert(atoms.begin(), {"N", toward(k - 1)});
        if (k + 1 < made.positions.size()) atoms.push_back({"C", toward(k + 1)});
        atoms.push_back({"CB", made.positions[k] + Vec3{{0.1, 0.1, 0.05}}});
    }

    std::mt19937 random_;
    int stuck_ = 0;
};

inline std::string line_of(Atom const& atom, Residue const& residue, Structure const& of,
                           int serial) {
    char line[120];
    std::snprintf(line, sizeof line,
                  "%-6s%5d  %-3s%c%3s %c%4d%c   %8.3f%8.3f%8.3f%6.2f%6.2f      %-4s%2s",
                  residue.het ? "HETATM" : "ATOM", serial % 100000, atom.name.c_str(),
                  atom.alternate, residue.name.c_str(), of.chain, residue.number, residue.insertion,
                  10 * atom.position[0], 10 * atom.position[1], 10 * atom.position[2],
                  atom.occupancy, 0.0, of.segment.c_str(), atom.name.substr(0, 1).c_str());
    return line + of.line_end;
}

inline std::string text_of(Structure const& structure) {
    std::string text = structure.head;
    int serial = 0;
    for (Residue const& residue : structure.residues)
        for (Atom const& atom : residue.atoms) text += line_of(atom, residue, structure, ++serial);
    return text + structure.tail;
}

inline Atom& alpha(Residue& residue) {
    for (Atom& atom : residue.atoms)
        if (atom.name == "CA") return atom;
    return residue.atoms.front();
}

/// open: without a note. open_somehow: with notes or without.
enum class Must { open, open_with_note, open_somehow, be_refused };

struct Damage {
    char const* name;
    Must must;
    std::function<void(Structure&, Generator&)> apply;
};

inline void shift(Residue& residue, Vec3 const& by) {
    for (Atom& atom : residue.atoms) atom.position = atom.position + by;
}

inline void renumber(Structure& s, Generator& g) {
    int const by = g.whole(-20, 800);
    for (Residue& residue : s.residues) residue.number += by;
}

inline void skip_numbers(Structure& s, Generator& g) {
    for (std::size_t k = g.index(1, s.residues.size()); k < s.residues.size(); ++k)
        s.residues[k].number += 12;
}

inline void drop_residues(Structure& s, Generator& g) {
    auto const at = static_cast<std::ptrdiff_t>(g.index(2, s.residues.size() - 9));
    s.residues.erase(s.residues.begin() + at, s.residues.begin() + at + 1);
}

inline void drop_and_renumber(Structure& s, Generator& g) {
    drop_residues(s, g);
    for (std::size_t k = 1; k < s.residues.size(); ++k)
        s.residues[k].number = s.residues[0].number + static_cast<int>(k);
}

/// The right place has the largest occupancy, or is the first of equals.
inline void alternate(Structure& s, Generator& g) {
    for (int n = g.whole(1, 4); n > 0; --n) {
        Residue& residue = s.residues[g.index(0, s.residues.size())];
        if (alpha(residue).alternate != ' ') continue;
        std::vector<Atom> atoms;
        bool const equal = g.coin(), second = !equal && g.coin();
        for (Atom const& atom : residue.atoms) {
            Atom right = atom, wrong = atom;
            right.alternate = second ? 'C' : 'B', wrong.alternate = second ? 'B' : 'D';
            right.occupancy = equal ? 0.5 : 0.6, wrong.occupancy = equal ? 0.5 : 0.4;
            wrong.position = wrong.position + 0.15 * g.direction();
            atoms.push_back(second ? wrong : right);
            atoms.push_back(second ? right : wrong);
        }
        residue.atoms = atoms;
    }
}

inline void swap_residues(Structure& s, Generator& g) {
    std::size_t const k = g.index(1, s.residues.size() - 1);
    std::swap(s.residues[k], s.residues[k + 1]);
}

/// As a file that was sorted by something else and numbered again: distances alone tell.
inline void swap_and_renumber(Structure& s, Generator& g) {
    std::size_t const k = g.index(1, s.residues.size() - 2);
    std::swap(s.residues[k], s.residues[k + 1]);
    std::swap(s.residues[k].number, s.residues[k + 1].number);
}

inline void duplicate(Structure& s, Generator& g) {
    auto const k = static_cast<std::ptrdiff_t>(g.index(0, s.residues.size()));
    Residue const copy = s.residues[static_cast<std::size_t>(k)];
    s.residues.insert(g.coin() ? s.residues.begin() + k : s.residues.end(), copy);
}

inline void add_noise(Structure& s, Generator& g, double deviation = 0.004) {
    for (std::size_t k = 0; k < s.residues.size(); ++k) {
        Vec3 const by{{g.normal(deviation), g.normal(deviation), g.normal(deviation)}};
        shift(s.residues[k], by);
        s.positions[k] = s.positions[k] + by;
    }
}

inline void rename(Structure& s, Generator& g) {
    std::pair<char const*, char const*> const names[] = {
        {"MSE", "MET"}, {"HIE", "HIS"}, {"HSP", "HIS"}, {"CYX", "CYS"}, {"ASH", "ASP"},
        {"GLH", "GLU"}, {"LYN", "LYS"}, {"HYP", "PRO"}, {"MLY", "LYS"}, {"SEC", "CYS"}};
    std::size_t const k = g.index(0, s.residues.size());
    auto const& [other, parent] = names[g.whole(0, 9)];
    s.residues[k].name = other;
    s.residues[k].het = g.coin();
    s.names[k] = parent;
}

inline void rename_to(Structure& s, Generator& g, char const* name) {
    s.residues[g.index(0, s.residues.size())].name = name;
}

inline std::string foreign_atoms(Structure const& s, Generator& g) {
    Structure others = s;
    others.residues.clear();
    auto const put = [&](char const* name, char const* atom, int number) {
        Vec3 const at{{g.uniform(0, 9), g.uniform(0, 9), g.uniform(0, 9)}};
        others.residues.push_back({name, number, ' ', true, {{atom, at}}});
    };
    for (int n = g.whole(1, 5); n > 0; --n) put("HOH", "O", 2000 + n);
    if (g.coin()) put("ZN", "ZN", 1901);
    if (g.coin()) put("GOL", "C1", 1902);
    others.head = others.tail = "";
    std::string text = text_of(others);
    if (g.coin())
        text += "HETATM 9999 CA    CA A1903      10.000  10.000  10.000  1.00  0.00          CA" +
                s.line_end;
    return text;
}

inline void add_solvent(Structure& s, Generator& g) {
    bool const ends = g.coin();
    s.tail = (ends ? "TER\n" : "") + foreign_atoms(s, g) + "END\n";
}

inline void add_chain(Structure& s, Generator& g) {
    Structure other = g.structure();
    other.head = other.tail = "";
    bool const letter = g.coin(), ends = !letter || g.coin();
    if (letter) other.chain = 'B';
    for (Residue& residue : other.residues) residue.number += 100;
    s.tail = (ends ? "TER\n" : "") + text_of(other) + "END\n";
}

inline void add_models(Structure& s, Generator& g) {
    Structure other = g.structure();
    other.head = "MODEL        2\n", other.tail = "ENDMDL\nEND\n";
    s.head += "MODEL        1\n";
    s.tail = "TER\nENDMDL\n" + text_of(other);
}

inline void insert_codes(Structure& s, Generator& g) {
    std::size_t const k = g.index(1, s.residues.size() - 3);
    for (int n = 0; n < 3; ++n) {
        s.residues[k + static_cast<std::size_t>(n)].number = s.residues[k].number;
        s.residues[k + static_cast<std::size_t>(n)].insertion =
            n == 0 ? ' ' : static_cast<char>('A' + n - 1);
    }
    for (std::size_t after = k + 3; after < s.residues.size(); ++after)
        s.residues[after].number -= 2;
}

inline void wrap(Structure& s, Generator&) {
    for (Residue& residue : s.residues)
        for (Atom& atom : residue.atoms)
            for (int i = 0; i < 3; ++i)
                atom.position[i] -= 5.2 * std::floor(atom.position[i] / 5.2);
}

inline bool is_wrapped(Structure const& s) {
    for (std::size_t k = 1; k < s.residues.size(); ++k) {
        Residue a = s.residues[k - 1], b = s.residues[k];
        if (norm(alpha(a).position - alpha(b).position) > 1) return true;
    }
    return false;
}

inline void lose_alpha_carbon(Structure& s, Generator& g) {
    for (Atom& atom : s.residues[g.index(0, s.residues.size())].atoms)
        if (atom.name == "CA") atom.name = "CX";
}

inline void reverse(Structure& s, Generator&) {
    std::reverse(s.residues.begin(), s.residues.end());
}

inline std::vector<Damage> const damages = {
    {"none", Must::open, [](Structure&, Generator&) {}},
    {"other line ends", Must::open, [](Structure& s, Generator&) { s.line_end = "\r\n"; }},
    {"byte order mark", Must::open,
     [](Structure& s, Generator&) { s.head = "\xEF\xBB\xBF" + s.head; }},
    {"numbers from elsewhere", Must::open, renumber},
    {"skipped numbers", Must::open_with_note, skip_numbers},
    {"insertion codes", Must::open, insert_codes},
    {"alternates", Must::open_with_note, alternate},
    {"noise", Must::open_somehow, [](Structure& s, Generator& g) { add_noise(s, g); }},
    {"other names", Must::open_with_note, rename},
    {"solvent", Must::open_with_note, add_solvent},
    {"models", Must::open_with_note, add_models},
    {"segments", Must::open, [](Structure& s, Generator&) { s.segment = "PROA"; }},
    {"gap", Must::be_refused, drop_residues},
    {"gap with new numbers", Must::be_refused, drop_and_renumber},
    {"swap", Must::be_refused, swap_residues},
    {"swap with new numbers", Must::be_refused, swap_and_renumber},
    {"duplicate", Must::be_refused, duplicate},
    {"phosphate", Must::be_refused, [](Structure& s, Generator& g) { rename_to(s, g, "TPO"); }},
    {"unknown residue", Must::be_refused,
     [](Structure& s, Generator& g) { rename_to(s, g, "XYZ"); }},
    {"second chain", Must::be_refused, add_chain},
    {"no alpha carbon", Must::be_refused, lose_alpha_carbon},
    {"reversed", Must::be_refused, reverse},
};

}  // namespace catena::test
