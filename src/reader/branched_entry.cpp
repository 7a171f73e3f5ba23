// Implements the reader of the generators of branched chains.
#include "reader/branched_entry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "generate/conformation.hpp"
#include "keys/maps.hpp"
#include "reader/models.hpp"

namespace catena::scene {

namespace {

/// Largest number of beads; numbers of bodies must be exact.
double constexpr most_beads = 1e15;

std::int64_t whole_or(Fields const& fields, char const* key, std::int64_t least,
                      std::int64_t otherwise) {
    Node const* const node = fields.find(key);
    return node ? whole(*node, least) : otherwise;
}

BranchedShape read_shape(Fields const& fields, std::string_view kind) {
    if (kind == "star")
        return Star{whole(fields.need("arms", "arms: 4"), 1),
                    whole(fields.need("arm_length", "arm_length: 20"), 1)};
    if (kind == "brush")
        return Brush{whole(fields.need("backbone", "backbone: 100"), 1),
                     whole(fields.need("side_length", "side_length: 10"), 1),
                     whole_or(fields, "every", 1, 1)};
    if (kind == "dendrimer")
        return Dendrimer{whole(fields.need("generations", "generations: 4"), 1),
                         whole_or(fields, "functionality", 3, 3), whole_or(fields, "spacer", 0, 0)};
    return RandomTree{whole(fields.need("beads", "beads: 100"), 1),
                      whole_or(fields, "max_children", 1, 2)};
}

KeyMap const& keys_of(std::string_view kind) {
    return kind == "star"        ? keys::star
           : kind == "brush"     ? keys::brush
           : kind == "dendrimer" ? keys::dendrimer
                                 : keys::random_tree;
}

}  // namespace

bool makes_branches(std::string_view generator) {
    return generator == "star" || generator == "brush" || generator == "dendrimer" ||
           generator == "random_tree";
}

BranchedEntry::BranchedEntry(ChainRequest& request, Node const& entry) : request_(request) {
    Fields const fields(entry, keys_of(entry.key));
    shape_ = read_shape(fields, entry.key);
    double const beads = beads_of(shape_);
    if (!(beads <= most_beads))
        fail(entry, fmt::format("the {} has {:.3g} beads", entry.key, beads), "make it smaller");
    walk_.beads = static_cast<std::int64_t>(beads);
    walk_.base = request.base;
    request.allow(fmt::format("generator `{}`", entry.key).c_str(),
                  {"positions", "links", "anchor", "model"});
    read_beads(fields, request);
    walk_.anchor = request.anchor();
}

void BranchedEntry::read_beads(Fields const& fields, ChainRequest& request) {
    Node const* const residue = fields.find("residue");
    if (residue) residue_ = text(*residue);
    request.protein_ends = {false, false};
    if (Node const* const model = request.fields.find("model")) {
        if (request.scene.si)
            fail(*model, "a residue table in SI units",
                 "write `units: md`: its parameters are in nm, amu and kJ/mol");
        ResidueTable const& table = table_of(request);
        if (!residue && table.types().size() == 1) residue_ = table.types().front().name;
        ResidueType const* const type = table.find(std::string_view(residue_));
        if (!type)
            fail(residue ? *residue : *model,
                 fmt::format("residue `{}` is not in {}", shown(residue_), table.name()),
                 "give the beads a `residue` of that table");
        hand_to_forces(request, {type});
        walk_.mass = type->mass, walk_.length = type->bond;
        excluded_ = std::min(type->sigma, widest_exclusion * type->bond);
    }
    if (Node const* const mass = fields.find("mass")) walk_.mass = read_distribution(*mass);
    Node const* const length = fields.find("length");
    if (length || !request.fields.find("model"))
        walk_.length = read_distribution(fields.need("length", "length: 1.0"));
    given_excluded_ = fields.find("excluded");
    if (given_excluded_) excluded_ = non_negative(*given_excluded_);
}

void BranchedEntry::make(ChainSpec& chain, std::uint64_t seed) const {
    Walk walk = walk_;
    walk.seed = seed;
    std::vector<std::int64_t> inboard = inboard_beads(shape_, seed);
    Node const* const positions = request_.fields.find("positions");
    Overlaps left;
    chain.beads = drawn_sizes(walk);
    std::vector<double> const& length = chain.beads.length;
    std::size_t const links = length.size() - (request_.base == Base::fixed ? 0 : 1);
    double const mean = links == 0 ? 0
                                   : std::accumulate(length.begin(), length.end(), 0.0) /
                                         static_cast<double>(links);
    double const excluded = excluded_.value_or(mean);
    if (!positions && links > 1) refuse_beyond_reach(length, excluded);
    if (!positions)
        left = grow_tree(chain.beads, {walk.base, walk.anchor, walk.seed}, inboard, excluded);
    chain.beads.residue.assign(chain.beads.size(), residue_);
    chain.parent = as_parents(std::move(inboard));
    if (positions)
        request_.place(chain.beads, request_.positions_from(*positions, chain.size()), *positions,
                       chain.parent);
    note(left, excluded);
}

void BranchedEntry::refuse_beyond_reach(std::vector<double> const& length, double excluded) const {
    double const reach = 2 * *std::max_element(length.begin(), length.end());
    if (!given_excluded_ || excluded <= reach) return;
    fail(*given_excluded_,
         fmt::format("beads {:.4g} apart, but two links reach {:.4g} only", excluded, reach),
         "give less than the length of two links");
}

void BranchedEntry::note(Overlaps const& left, double excluded) const {
    if (left.count == 0) return;
    char const* const unit = request_.scene.si ? "m" : "nm";
    request_.scene.note(fmt::format(
        "chain `{}` starts with {} overlaps of beads closer than {:.4g} {}, the nearest {:.3g} {} "
        "apart: give a smaller `excluded`, let fewer links end on one bead (12 fit where "
        "`excluded` "
        "is their length), or write `relax: true`",
        shown(request_.name()), left.count, excluded, unit, left.nearest, unit));
}

}  // namespace catena::scene
