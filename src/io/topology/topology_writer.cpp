// Writers of topology.pdb (wwPDB format 3.3, https://www.wwpdb.org/documentation/file-format) and
// topology.psf. topology.cif replaces the latter if the columns of PDB are too narrow.
#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <future>
#include <iterator>
#include <optional>
#include <span>

#include "io/output.hpp"
#include "io/output_file.hpp"
#include "io/site_names.hpp"
#include "io/topology/decimals.hpp"
#include "io/topology/psf.hpp"

namespace catena {
namespace {

constexpr std::int64_t most_pdb_serials = 99999;  // largest serial number in five decimal columns
constexpr std::size_t most_in_record = 4;         // bonds in one CONECT record

/// Returns the text with all but printable ASCII replaced, which is all that these formats hold.
std::string plain(std::string_view text) {
    std::string copy(text);
    for (char& c : copy)
        if (c < ' ' || c > '~') c = '?';
    return copy;
}

/// Returns a serial number: decimal up to 99,999, then hybrid-36 (http://cci.lbl.gov/hybrid_36):
/// A0000, A0001, ..., ZZZZZ, a0000, ...
std::string serial(std::int64_t number) {
    constexpr std::int64_t letters = 26 * 36 * 36 * 36 * 36;
    if (number <= most_pdb_serials) return fmt::format(FMT_COMPILE("{:5}"), number);
    std::int64_t rest = number - most_pdb_serials - 1;
    bool const lower = rest >= letters;
    rest = rest % letters + 10 * 36 * 36 * 36 * 36;
    std::string text(5, '0');
    for (int place = 4; place >= 0; --place, rest /= 36) {
        auto const digit = static_cast<char>(rest % 36);
        text[static_cast<std::size_t>(place)] =
            static_cast<char>(digit < 10 ? '0' + digit : (lower ? 'a' : 'A') + digit - 10);
    }
    return text;
}

/// Returns a number in `width` columns with up to 3 decimals, fewer if it is large. A number whose
/// integer part is too wide becomes a blank-padded 0.000.
std::string fixed(double value, std::size_t width) {
    for (int places = 3; places >= 0; --places)
        if (Decimals const number(value, places); number.text().size() <= width)
            return std::string(width - number.text().size(), ' ').append(number.text());
    return fixed(0.0, width);
}

/// Returns the number of Angstrom per length unit of the scene: 10 for nm. With `units: si` it is
/// the power of ten that makes a typical link 1 to 10 Angstrom long. `positions`: those of the
/// first sites.
double angstrom_per_unit(Topology const& topology, std::vector<Vec3> const& positions) {
    if (!topology.si) return 10;
    std::vector<double> links;
    for (Topology::Chain const& chain : topology.chains)
        for (std::int64_t k = 1; k < chain.count && links.size() < 10000; ++k) {
            auto const site = static_cast<std::size_t>(chain.first + k);
            if (site >= positions.size()) break;
            std::size_t const inboard =
                chain.parent.empty() ? site - 1
                                     : static_cast<std::size_t>(
                                           chain.first + chain.parent[static_cast<std::size_t>(k)]);
            links.push_back(norm(positions[site] - positions[inboard]));
        }
    if (links.empty()) return 1;
    auto const middle = links.begin() + static_cast<std::ptrdiff_t>(links.size() / 2);
    std::nth_element(links.begin(), middle, links.end());
    return *middle > 0 && std::isfinite(*middle) ? std::pow(10.0, -std::floor(std::log10(*middle)))
                                                 : 1;
}

/// Writes title, remarks and box of topology.pdb. `scale`: Angstrom per length unit.
void write_remarks(AtomicFile& out, Topology const& topology, double scale) {
    std::string const title = plain(topology.title);
    for (std::size_t at = 0, part = 1; at < title.size(); at += 68, ++part)
        out.write(part == 1 ? fmt::format("TITLE     {}\n", title.substr(at, 68))
                            : fmt::format("TITLE   {:2} {}\n", part % 100, title.substr(at, 68)));
    out.write(
        "REMARK   1 WRITTEN BY CATENA: ONE SITE A BEAD OR A BODY WITHOUT BEADS (BDY, CENTRE OF "
        "MASS)\n");
    if (topology.si)
        out.write(
            fmt::format("REMARK   1 COORDINATES: 1 ANGSTROM STANDS FOR {:.0E} M\n", 1 / scale));
    if (topology.box) {
        Vec3 const edges = scale * *topology.box;
        out.write(fmt::format("CRYST1{}{}{}  90.00  90.00  90.00 P 1           1\n",
                              fixed(edges[0], 9), fixed(edges[1], 9), fixed(edges[2], 9)));
    }
}

/// Writes the bonds (CONECT), for each site that at which its own begins first. A record holds
/// four.
void write_bonds(AtomicFile& out, SiteNames const& names, std::int64_t sites) {
    std::vector<std::vector<std::int64_t>> neighbours(static_cast<std::size_t>(sites));
    for (auto const& [from, to] : names.bonds()) {
        neighbours[static_cast<std::size_t>(from)].push_back(to);
        auto& of_to = neighbours[static_cast<std::size_t>(to)];
        of_to.insert(of_to.begin(), from);
    }
    for (std::int64_t site = 0; site < sites; ++site) {
        auto const& others = neighbours[static_cast<std::size_t>(site)];
        for (std::size_t i = 0; i < others.size(); i += most_in_record) {
            std::string text;
            for (std::size_t j = i; j < std::min(others.size(), i + most_in_record); ++j)
                text += serial(others[j] + 1);
            out.write("CONECT" + serial(site + 1) + text + "\n");
        }
    }
}

/// Returns a residue number in the four columns of PDB. Numbers that need more lose their first
/// digits.
std::string four_columns(std::int64_t number) {
    return fmt::format(FMT_COMPILE("{:4}"), number < 0 ? number % 1000 : number % 10000);
}

/// Writes topology.cif up to the column names of its atoms.
void write_cif_head(AtomicFile& out, Topology const& topology, double scale) {
    std::string title = plain(topology.title);
    std::replace(title.begin(), title.end(), '"', '\'');
    out.write("data_catena\n#\n_struct.entry_id catena\n_struct.title \"" + title + "\"\n#\n");
    if (topology.box) {
        Vec3 const edges = scale * *topology.box;
        out.write(
            fmt::format("_cell.length_a {:.6g}\n_cell.length_b {:.6g}\n_cell.length_c "
                        "{:.6g}\n_cell.angle_alpha 90\n_cell.angle_beta 90\n"
                        "_cell.angle_gamma 90\n_symmetry.space_group_name_H-M \"P 1\"\n#\n",
                        edges[0], edges[1], edges[2]));
    }
    out.write("loop_\n");
    for (char const* column :
         {"group_PDB", "id", "type_symbol", "label_atom_id", "label_alt_id", "label_comp_id",
          "label_asym_id", "label_entity_id", "label_seq_id", "pdbx_PDB_ins_code", "Cartn_x",
          "Cartn_y", "Cartn_z", "occupancy", "B_iso_or_equiv", "auth_seq_id", "auth_asym_id",
          "pdbx_PDB_model_num"})
        out.write(fmt::format("_atom_site.{}\n", column));
}

}  // namespace

/// State of a TopologyWriter between its calls.
struct TopologyWriter::Files {
    /// Formatted lines of consecutive sites, for both files.
    struct Lines {
        fmt::memory_buffer pdb, cif;
    };

    Files(std::string const& folder, Topology const& of)
        : topology(of), names(of), pdb((std::filesystem::path(folder) / "topology.pdb").string()) {
        written.push_back((std::filesystem::path(folder) / "topology.pdb").string());
        for (Topology::Chain const& each : topology.chains) sites += each.count;
        if (sites <= most_pdb_serials) {
            written.push_back((std::filesystem::path(folder) / "topology.psf").string());
            psf.emplace(written[1]);
            return;
        }
        written.push_back((std::filesystem::path(folder) / "topology.cif").string());
        cif.emplace(written[1]);
    }

    /// Determines the scale from the first positions and writes the heads of the files.
    void begin(std::vector<Vec3> const& positions) {
        scale = angstrom_per_unit(topology, positions);
        write_remarks(pdb, topology, scale);
        if (cif) write_cif_head(*cif, topology, scale);
        begun = true;
    }

    /// Formats the lines of the next sites by the executor's threads, then writes both files
    /// concurrently.
    void put(std::span<Vec3 const> positions, Executor const& executor) {
        std::int64_t const count = std::ssize(positions),
                           parts = std::min<std::int64_t>(executor.threads(), count);
        lines.resize(std::max(lines.size(), static_cast<std::size_t>(parts)));
        executor.for_ranges(parts, static_cast<int>(count / std::max<std::int64_t>(parts, 1)),
                            [&](std::int64_t first, std::int64_t last) {
                                for (std::int64_t part = first; part < last; ++part)
                                    format(positions, count * part / parts,
                                           count * (part + 1) / parts,
                                           lines[static_cast<std::size_t>(part)]);
                            });
        auto const write = [&](AtomicFile& file, fmt::memory_buffer Lines::* text) {
            for (std::int64_t part = 0; part < parts; ++part) {
                fmt::memory_buffer const& of_part = lines[static_cast<std::size_t>(part)].*text;
                file.write({of_part.data(), of_part.size()});
            }
        };
        std::future<void> beside;
        if (cif) beside = std::async([&] { write(*cif, &Lines::cif); });
        write(pdb, &Lines::pdb);
        if (cif) beside.get();
        next += count;
    }

    /// Formats the lines of the sites next + [begin, end). `positions` starts at the site `next`.
    void format(std::span<Vec3 const> positions, std::int64_t begin, std::int64_t end,
                Lines& to) const {
        to.pdb.clear();
        to.cif.clear();
        std::size_t run = names.run_of(next + begin);
        for (std::int64_t site = next + begin; site < next + end; ++site) {
            if (site == names.runs()[run].first + names.runs()[run].count) ++run;
            ResidueRun const& of = names.runs()[run];
            add(site, of, scale * positions[static_cast<std::size_t>(site - next)], to);
            if (site + 1 == of.first + of.count && names.ends_member(run))
                to.pdb.append(std::string_view("TER\n"));
        }
    }

    /// Formats the lines of one site of a run. `x`: Angstrom.
    void add(std::int64_t site, ResidueRun const& run, Vec3 const& x, Lines& to) const {
        std::string const residue = residue_of(topology, static_cast<std::size_t>(site));
        std::int64_t const k = run.step * (site - run.first), number = run.number + k;
        fmt::format_to(std::back_inserter(to.pdb),
                       FMT_COMPILE("ATOM  {}  CA  {:>3} {}{}{}   {}{}{}  1.00  0.00           C\n"),
                       serial(site + 1), residue, names.letter(run.member), four_columns(number),
                       run.insertion, fixed(x[0], 8), fixed(x[1], 8), fixed(x[2], 8));
        if (!cif) return;
        std::string const& name = names.identifier(run.member);
        fmt::format_to(std::back_inserter(to.cif),
                       FMT_COMPILE("ATOM {} C CA . {} {} 1 {} {} {} {} {} 1.00 0.00 {} {} 1\n"),
                       site + 1, residue, name, run.place + k + 1,
                       run.insertion == ' ' ? '?' : run.insertion, Decimals(x[0], 3).text(),
                       Decimals(x[1], 3).text(), Decimals(x[2], 3).text(), number, name);
    }

    /// Writes the ends of the files and publishes them.
    void finish() {
        if (!begun) begin({});
        if (sites <= most_pdb_serials) write_bonds(pdb, names, sites);
        pdb.write("END\n");
        pdb.publish();
        if (psf) {
            write_psf(*psf, topology, names);
            psf->publish();
        }
        if (!cif) return;
        cif->write("#\n");
        cif->publish();
    }

    Topology const& topology;
    SiteNames names;
    AtomicFile pdb;
    std::optional<AtomicFile> cif, psf;
    std::vector<std::string> written;
    std::vector<Lines> lines;          // one entry per thread
    std::int64_t sites = 0, next = 0;  // total number; index of the next site
    double scale = 1;                  // Angstrom per length unit
    bool begun = false;
};

TopologyWriter::TopologyWriter(std::string const& folder, Topology const& topology)
    : files_(std::make_unique<Files>(folder, topology)) {}

TopologyWriter::~TopologyWriter() = default;

void TopologyWriter::put(std::vector<Vec3> const& positions, Executor const& executor) {
    if (!files_->begun) files_->begin(positions);
    files_->put(positions, executor);
}

std::vector<std::string> TopologyWriter::finish() {
    files_->finish();
    return files_->written;
}

std::vector<std::string> write_topology(std::string const& folder, Topology const& topology,
                                        Frame const& first) {
    TopologyWriter writer(folder, topology);
    writer.put(first.positions, *serial_executor());
    return writer.finish();
}

}  // namespace catena
