// Implements the reader of structures: the chosen chains, their gaps and their rigid domains.
#include "reader/structure_entry.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reader/gaps.hpp"
#include "reader/missing_residues.hpp"
#include "scene/files.hpp"
#include "scene/unique_names.hpp"

namespace catena::scene {

namespace {

/// Keys `chain`, `conformer`, `gaps` and `sites` of the entry.
struct StructureKeys {
    StructureChoice choice;
    /// True if the entry may yield several chains.
    bool several = false;
    GapRule gaps = GapRule::refuse;
};

/// Reads `chain`: one name, a list of names, or `all`.
void read_chain_names(Node const& chain, StructureKeys& keys) {
    if (chain.kind == Node::Kind::list) {
        if (chain.items.empty())
            fail(chain, "the list of chains is empty", "name a chain, such as `chain: A`");
        for (Node const& name : chain.items) keys.choice.chains.push_back(text(name));
        keys.several = true;
    } else if (text(chain) == "all") {
        keys.several = true;
    } else {
        keys.choice.chains.push_back(text(chain));
    }
}

StructureKeys read_keys(Fields const& fields) {
    StructureKeys keys;
    if (Node const* const chain = fields.find("chain")) read_chain_names(*chain, keys);
    if (Node const* const model = fields.find("conformer"))
        keys.choice.model = whole(*model, 0, 1000000000);
    if (Node const* const gaps = fields.find("gaps"))
        keys.gaps = choice<GapRule>(
            *gaps,
            {{"refuse", GapRule::refuse}, {"split", GapRule::split}, {"model", GapRule::model}});
    if (Node const* const sites = fields.find("sites"))
        keys.choice.mass_centres = choice<bool>(*sites, {{"ca", false}, {"com", true}});
    return keys;
}

/// The sites of one chain as a structure of their own.
PdbSites alone(PdbSites const& all, PdbSiteChain const& chain) {
    auto const begin = all.sites.begin();
    PdbSites one{all.file,
                 {begin + static_cast<std::ptrdiff_t>(chain.first),
                  begin + static_cast<std::ptrdiff_t>(chain.last)}};
    one.cell = all.cell;
    one.chains = {chain};
    return one;
}

/// Throws InputError with the names and residues of the first chains.
void refuse_several(PdbSites const& all, StructureKeys const& keys, Node const& at) {
    if (keys.several || all.chains.size() < 2) return;
    std::string list;
    for (std::size_t c = 0; c < std::min<std::size_t>(all.chains.size(), 4); ++c) {
        PdbSiteChain const& chain = all.chains[c];
        std::string const first = all.sites[chain.first].label,
                          last = all.sites[chain.last - 1].label;
        list += fmt::format(
            "{}{} ({})", c == 0 ? "" : ", ", chain.name.empty() ? "no name" : chain.name,
            chain.last - chain.first == 1 ? "residue " + first
                                          : fmt::format("residues {} to {}", first, last));
    }
    std::string const name = all.chains[0].name.empty() ? "A" : all.chains[0].name;
    fail(
        at,
        keys.choice.chains.empty()
            ? fmt::format("`{}` holds {} chains: {}{}", all.file, all.chains.size(), list,
                          all.chains.size() > 4 ? ", ..." : "")
            : fmt::format("{} chains of `{}` are named {}: {}{}", all.chains.size(), all.file,
                          shown(keys.choice.chains[0]), list, all.chains.size() > 4 ? ", ..." : ""),
        keys.choice.chains.empty()
            ? fmt::format("choose one, such as `chain: {}`, or write `chain: all`", name)
            : "give each chain a letter of its own, or write `chain: all`");
}

/// Notes residues of the sequence that have no position and are not modelled.
void note_unresolved(PdbSites const& from, Scene& scene) {
    std::int64_t const listed = from.chains[0].sequence.residues;
    if (listed <= std::ssize(from.sites)) return;
    scene.note(
        fmt::format("`{}`: the chain's sequence has {} residues, but only {} have positions and "
                    "become beads",
                    from.file, listed, from.sites.size()));
}

/// Cuts a chain at its gaps and appends the pieces to `parts`.
void split(PdbSites const& from, std::vector<std::size_t> const& gaps, StructurePart const& like,
           std::vector<StructurePart>& parts) {
    std::size_t begin = 0;
    for (std::size_t g = 0; g <= gaps.size(); ++g) {
        std::size_t const end = g < gaps.size() ? gaps[g] : from.sites.size();
        PdbSiteChain piece = from.chains[0];
        piece.first = begin;
        piece.last = end;
        StructurePart part = like;
        part.name = gaps.empty() ? like.name : fmt::format("{}-{}", like.name, g + 1);
        part.from = alone(from, piece);
        part.cut_front = g > 0;
        part.cut_back = g < gaps.size();
        parts.push_back(std::move(part));
        begin = end;
    }
}

void note_split(PdbSites const& from, std::vector<std::size_t> const& gaps, Scene& scene) {
    if (gaps.empty()) return;
    PdbSite const &a = from.sites[gaps[0] - 1], &b = from.sites[gaps[0]];
    scene.note(
        fmt::format("`{}`: the chain is split at {} gap{} (first: residues {} {} and {} {}, "
                    "{:.3f} nm apart), whose ends bear no charges of termini",
                    from.file, gaps.size(), gaps.size() == 1 ? "" : "s", a.residue, a.label,
                    b.residue, b.label, norm(b.alpha - a.alpha)));
}

/// Reads all chains of the file into parts.
class StructureReader {
  public:
    StructureReader(ChainRequest& request, Node const& file)
        : request_(request),
          file_(file),
          keys_(read_keys(request.fields)),
          all_(read_pdb(resolved(text(file), request.scene.file), file, keys_.choice)) {}

    std::vector<StructurePart> read() {
        for (std::string const& note : all_.notes) request_.scene.note(note);
        refuse_several(all_, keys_, file_);
        std::int64_t const particle = request_.particle;
        for (std::size_t c = 0; c < all_.chains.size(); ++c) {
            request_.particle = particle + static_cast<std::int64_t>(all_.chains[c].first);
            read_chain(c);
        }
        request_.particle = particle;
        if (parts_.size() > 1) refuse_keys_of_one_chain();
        read_rigid();
        return std::move(parts_);
    }

  private:
    void read_chain(std::size_t c) {
        PdbSites from = alone(all_, all_.chains[c]);
        StructurePart part;
        part.name = chain_name(c);
        part.mass_centres = keys_.choice.mass_centres;
        std::vector<std::size_t> gaps = find_gaps(from, request_, file_, keys_.gaps);
        if (keys_.gaps == GapRule::model) {
            model_gaps(from, gaps, all_.positions(), request_, file_);
            gaps.clear();
        }
        note_unresolved(from, request_.scene);
        note_split(from, gaps, request_.scene);
        split(from, gaps, part, parts_);
    }
    /// Name of a chain: that of the entry, with the chain's own name if there are several.
    std::string chain_name(std::size_t c) {
        if (all_.chains.size() == 1) return request_.name();
        std::string const own =
            all_.chains[c].name.empty() ? std::to_string(c + 1) : all_.chains[c].name;
        return names_.make(request_.fields.find("name") ? request_.name() + "-" + own : own);
    }
    void refuse_keys_of_one_chain() const {
        for (char const* const key : {"count", "concentration", "base", "tip", "anchor"})
            if (Node const* const here = request_.fields.find(key))
                fail(*here,
                     fmt::format("key `{}` for {} chains of one structure", key, parts_.size()),
                     "leave it out, or give each chain its own entry with `chain`");
    }

    ResidueNumbers numbers() const {
        ResidueNumbers numbers;
        bool all_numbered = true;
        for (StructurePart const& part : parts_)
            for (PdbSite const& site : part.from.sites) {
                ++numbers.residues;
                all_numbered = all_numbered && site.number;
                numbers.labels.push_back(site.label);
                numbers.chains.push_back({part.from.chains[0].name, part.from.chains[0].label});
            }
        if (!all_numbered) numbers.labels = {}, numbers.chains = {};
        return numbers;
    }
    /// Reads `rigid` by the file's residue numbers, or by bead numbers if the file has none, and
    /// gives each part its domains.
    void read_rigid() {
        Node const* const rigid = request_.fields.find("rigid");
        if (!rigid) return;
        ResidueNumbers const known = numbers();
        std::vector<Domain> const domains = read_domains(*rigid, known);
        std::size_t begin = 0, taken = 0;
        for (StructurePart& part : parts_) {
            std::size_t const end = begin + part.from.sites.size();
            for (; taken < domains.size() && domains[taken].first < end; ++taken) {
                if (domains[taken].last >= end)
                    fail(*rigid, domains[taken].name + " do not lie in one chain",
                         "end the domain where its chain ends");
                part.rigid.push_back(domains[taken]);
                part.rigid.back().first -= begin;
                part.rigid.back().last -= begin;
            }
            begin = end;
        }
        if (known.labels.empty())
            note_no_numbers();
        else
            note_numbering(known, domains);
    }
    /// Notes which beads `rigid` means if the file's numbers differ from those of the beads.
    /// Domains that name their chain are plain enough.
    void note_numbering(ResidueNumbers const& known, std::vector<Domain> const& domains) const {
        bool const plain = std::all_of(domains.begin(), domains.end(), [](Domain const& domain) {
            return domain.name.find(" of chain ") != std::string::npos;
        });
        bool from_one = true;
        for (std::size_t k = 0; k < known.labels.size(); ++k)
            from_one = from_one && known.labels[k] == std::to_string(k + 1);
        if (plain || from_one) return;
        std::string list;
        for (Domain const& domain : domains)
            list += fmt::format("{}{} are beads {} to {}", list.empty() ? "" : ", ", domain.name,
                                domain.first + 1, domain.last + 1);
        request_.scene.note(
            fmt::format("`rigid` means the residue numbers of `{}`: {}", all_.file, list));
    }
    void note_no_numbers() const {
        auto const bare = std::find_if(all_.sites.begin(), all_.sites.end(),
                                       [](PdbSite const& site) { return !site.number; });
        request_.scene.note(fmt::format(
            "`rigid` means beads, numbered from 1: `{}` has no residue number that can be "
            "read for bead {}, {}{}",
            all_.file, bare - all_.sites.begin() + 1, shown(bare->residue),
            bare->label.empty() ? "" : " `" + bare->label + "`"));
    }

    ChainRequest& request_;
    Node const& file_;
    StructureKeys keys_;
    PdbSites all_;
    std::vector<StructurePart> parts_;
    UniqueNames names_;
};

}  // namespace

std::vector<StructurePart> read_structure(ChainRequest& request, Node const& file) {
    return StructureReader(request, file).read();
}

}  // namespace catena::scene
