// Implements the reader of structures: the chosen chains, their gaps and their rigid domains.
#include "reader/structure_entry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "reader/gaps.hpp"
#include "reader/missing_residues.hpp"
#include "scene/files.hpp"
#include "scene/unique_names.hpp"
#include "structure/member_names.hpp"

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

/// Longest text on the order of a complex's beads.
std::size_t constexpr longest_order = 300;

/// Chains that share a rigid body, as one part.
class Complex {
  public:
    Complex(std::vector<StructurePart> const& parts, Assembly const& one,
            ResidueNumbers const& numbers)
        : parts_(parts), one_(one), numbers_(numbers) {}

    StructurePart part() const {
        StructurePart made = parts_[one_.chains[0]];
        made.name.clear();
        made.from.sites.clear();
        made.from.chains[0].sequence = {};
        made.rigid = one_.rigid;
        made.cut_front = made.cut_back = false;
        for (std::size_t const c : one_.chains) {
            made.name += (made.name.empty() ? "" : "+") + parts_[c].name;
            std::string const& own = parts_[c].from.chains[0].name;
            made.members.push_back(own.empty() ? parts_[c].name : shown(own));
        }
        for (std::size_t const residue : one_.residues) add(residue, made);
        made.names = names();
        made.order = order();
        made.from.chains[0].first = 0;
        made.from.chains[0].last = made.from.sites.size();
        return made;
    }

  private:
    void add(std::size_t residue, StructurePart& made) const {
        std::size_t const chain = numbers_.chain_of(residue);
        auto const [begin, end] = numbers_.range_of(chain);
        if (residue == begin && !parts_[chain].cut_front)
            made.ends.push_back({made.from.sites.size(), true});
        if (residue + 1 == end && !parts_[chain].cut_back)
            made.ends.push_back({made.from.sites.size(), false});
        made.from.sites.push_back(parts_[chain].from.sites[residue - begin]);
    }

    /// Chain identifiers and residue numbers in the order of the beads.
    Members names() const {
        MemberNames collected;
        std::vector<std::size_t> piece(parts_.size());
        for (std::size_t const c : one_.chains)
            piece[c] = collected.announce(parts_[c].from.chains[0], parts_[c].from.sites.size());
        for (std::size_t const residue : one_.residues) {
            std::size_t const c = numbers_.chain_of(residue), k = residue - numbers_.range_of(c)[0];
            collected.add(piece[c], k, parts_[c].from.sites[k]);
        }
        return collected.take();
    }

    /// Residues of one chain that follow each other in either direction.
    std::string run(std::size_t first, std::size_t last) const {
        std::string const chain = shown(parts_[numbers_.chain_of(first)].from.chains[0].name);
        return fmt::format("{}{}{}{}", chain, chain.empty() ? "" : " ", numbers_.label(first),
                           first == last  ? ""
                           : last < first ? " down to " + numbers_.label(last)
                                          : " to " + numbers_.label(last));
    }
    std::string order() const {
        std::string text;
        std::vector<std::size_t> const& all = one_.residues;
        for (std::size_t begin = 0, end = 1; begin < all.size(); begin = end++) {
            std::size_t const step = end < all.size() ? all[end] - all[begin] : 0;
            bool const runs = step == 1 || step + 1 == 0;
            while (runs && end < all.size() && all[end] - all[end - 1] == step &&
                   numbers_.chain_of(all[end]) == numbers_.chain_of(all[begin]))
                ++end;
            text += (text.empty() ? "" : ", ") + run(all[begin], all[end - 1]);
        }
        return shown(text, longest_order);
    }

    std::vector<StructurePart> const& parts_;
    Assembly const& one_;
    ResidueNumbers const& numbers_;
};

/// Notes the chains of a complex and the order of its beads.
void note_complex(StructurePart const& part, Scene& scene) {
    std::set<std::string> const names(part.members.begin(), part.members.end());
    scene.note(fmt::format(
        "{} {} share a rigid body and are simulated as one chain, `{}`, whose {} beads have the "
        "order of residues {}",
        names.size() == 1 ? "pieces of chain" : "chains", fmt::join(names, " and "),
        shown(part.name), part.from.sites.size(), part.order));
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
        read_parts();
        read_rigid();
        for (StructurePart& part : parts_)
            if (part.members.empty())
                part.names = members_of(part.from);
            else
                note_complex(part, request_.scene);
        if (parts_.size() > 1) refuse_keys_of_one_chain();
        return std::move(parts_);
    }

    /// The prediction behind `rigid`, if there is one.
    std::shared_ptr<Prediction const> prediction() {
        Node const* const rigid = request_.fields.find("rigid");
        if (!rigid || rigid->kind != Node::Kind::map || !rigid->find("pae")) return nullptr;
        read_parts();
        return read_rigid_bodies(*rigid, rigid_source()).prediction;
    }

  private:
    /// Reads the chosen chains, without their rigid bodies.
    void read_parts() {
        for (std::string const& note : all_.notes) request_.scene.note(note);
        refuse_several(all_, keys_, file_);
        std::int64_t const particle = request_.particle;
        for (std::size_t c = 0; c < all_.chains.size(); ++c) {
            request_.particle = particle + static_cast<std::int64_t>(all_.chains[c].first);
            read_chain(c);
        }
        request_.particle = particle;
    }
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

    /// Residues by the file's numbers, or by bead numbers if the file has none.
    RigidSource rigid_source() const {
        RigidSource source{{}, request_.name(), request_.scene.file};
        ResidueNumbers& numbers = source.numbers;
        bool all_numbered = true;
        for (StructurePart const& part : parts_) {
            numbers.begins.push_back(numbers.residues);
            for (PdbSite const& site : part.from.sites) {
                ++numbers.residues;
                all_numbered = all_numbered && site.number;
                numbers.labels.push_back(site.label);
                numbers.chains.push_back({part.from.chains[0].name, part.from.chains[0].label});
                source.b_factors.push_back(site.b_factor);
                source.grown.push_back(site.grown);
            }
        }
        if (!all_numbered) numbers.labels = {}, numbers.chains = {};
        if (all_numbered) numbers.other_chains = all_.other_chains;
        return source;
    }
    /// Gives each part its rigid bodies. Parts that share a body become one.
    void read_rigid() {
        Node const* const rigid = request_.fields.find("rigid");
        if (!rigid) return;
        RigidSource const source = rigid_source();
        RigidBodies const bodies = read_rigid_bodies(*rigid, source);
        for (std::string const& note : bodies.notes) request_.scene.note(note);
        std::vector<StructurePart> made;
        for (Assembly const& one : assemble(bodies.sets, source.numbers))
            made.push_back(one.chains.size() == 1 ? alone_with(one)
                                                  : Complex(parts_, one, source.numbers).part());
        bool const together = made.size() == 1 && parts_.size() > 1;
        parts_ = std::move(made);
        if (together && (request_.fields.find("name") || all_.chains.size() == 1))
            parts_[0].name = request_.name();
        for (StructurePart const& part : parts_) check_complex(part, *rigid);
        if (source.numbers.labels.empty())
            note_no_numbers();
        else if (rigid->kind == Node::Kind::list)
            note_numbering(source.numbers, bodies.sets);
    }
    /// The part of one chain with its rigid bodies.
    StructurePart alone_with(Assembly const& one) {
        StructurePart part = std::move(parts_[one.chains[0]]);
        part.rigid = one.rigid;
        return part;
    }
    /// Throws InputError for keys that a complex cannot have; notes its beads.
    void check_complex(StructurePart const& part, Node const& rigid) const {
        if (part.members.empty()) return;
        if (request_.system)
            fail(rigid,
                 fmt::format("chains {} share a rigid body, and the beads of a System follow "
                             "another order",
                             fmt::join(part.members, " and ")),
                 "give each chain bodies of its own, or the forces by `builder`");
        for (char const* const key : {"base", "tip", "anchor"})
            if (Node const* const here = request_.fields.find(key))
                fail(*here, fmt::format("key `{}` for chains that share a rigid body", key),
                     "leave it out");
    }
    /// Notes which beads `rigid` means if the file's numbers differ from those of the beads.
    /// Domains that name their chain are plain enough.
    void note_numbering(ResidueNumbers const& known, std::vector<RigidSet> const& sets) const {
        bool plain = true;
        std::string list;
        for (RigidSet const& set : sets)
            for (Domain const& range : set.ranges) {
                plain = plain && range.name.find(" of chain ") != std::string::npos;
                list += fmt::format("{}{} are beads {} to {}", list.empty() ? "" : ", ", range.name,
                                    range.first + 1, range.last + 1);
            }
        if (plain || known.count_from_one()) return;
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

std::shared_ptr<Prediction const> read_prediction(ChainRequest& request, Node const& file) {
    return StructureReader(request, file).prediction();
}

}  // namespace catena::scene
