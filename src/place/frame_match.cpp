// Implements the comparison of a frame with a scene's chains.
#include "place/frame_match.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "io/printable.hpp"
#include "scene/branches.hpp"
#include "scene/fields.hpp"

namespace catena::scene {

namespace {

/// Largest distance in nm between a bead and the end of its body's link that is rounding.
double constexpr same_place = 1e-6;

/// Residue names of the points known to OpenMM.
std::vector<std::string> const& residues_of(ChainSpec const& chain) {
    return chain.is_beads() ? chain.beads.residue : chain.carried().residue;
}

/// True if every body of a chain carries beads and is linked at its first and last one.
bool is_linked_at_beads(LinkedArrays const& linked) {
    for (std::size_t u = 0; u < linked.size(); ++u) {
        auto const first = static_cast<std::size_t>(linked.carried.offset[u]),
                   end = static_cast<std::size_t>(linked.carried.offset[u + 1]);
        if (first == end) return false;
        std::vector<Vec3> const& at = linked.carried.position;
        if (norm(linked.inboard[u] - at[first]) > same_place ||
            norm(linked.outboard[u] - at[end - 1]) > same_place)
            return false;
    }
    return true;
}

/// Throws InputError for a chain whose start beads do not determine.
void refuse_other_kind(ChainSpec const& chain, Node const& start) {
    if (chain.is_beads()) return;
    if (!chain.is_linked())
        fail(start,
             fmt::format("chain `{}` has joints, and a frame gives positions of beads only",
                         shown(chain.name)),
             "continue that run instead: `catena run --restart CHECKPOINT`");
    if (!is_linked_at_beads(chain.linked))
        fail(start,
             fmt::format("bodies of chain `{}` are not linked at beads that they carry",
                         shown(chain.name)),
             "continue that run instead: `catena run --restart CHECKPOINT`");
    if (chain.tip == Tip::jointed)
        fail(start,
             fmt::format("chain `{}` has rigid domains and a tip that is not free",
                         shown(chain.name)),
             "continue that run instead: `catena run --restart CHECKPOINT`");
}

/// True if the lists hold the same cross-links, in any order.
using CrossLinkEnds = std::vector<std::array<std::int64_t, 2>>;
bool are_the_same(CrossLinkEnds a, CrossLinkEnds b) {
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    return a == b;
}

/// Throws InputError if the frame's chain `number`, `other`, has another structure.
void refuse_other_chain(Topology::Chain const& other, ChainSpec const& chain, std::size_t number,
                        std::string const& file, Node const& from) {
    if (other.count != static_cast<std::int64_t>(chain.bead_count()))
        fail(from,
             fmt::format("chain {}, `{}`, has {} beads in `{}`, the scene's `{}` has {}", number,
                         shown(printable(other.name)), other.count, file, shown(chain.name),
                         chain.bead_count()),
             "give a trajectory of the same chains in the same order");
    if (other.parent != chain.parent)
        fail(from,
             fmt::format("chain {}, `{}`, branches otherwise in `{}` than in the scene", number,
                         shown(chain.name), file),
             "give a trajectory of the same chains");
}

/// Notes how many chains have other cross-links in the frame, and the first of them.
void note_other_crosslinks(ChosenFrame const& frame, std::vector<Draft> const& drafts,
                           Scene& scene) {
    std::size_t others = 0, first = 0;
    for (std::size_t c = drafts.size(); c-- > 0;)
        if (!are_the_same(frame.chains[c].crosslinks, ends_of_crosslinks(drafts[c].chain)))
            ++others, first = c;
    if (others > 0)
        scene.note(fmt::format(
            "{} of {} chains {} other cross-links in `{}` than in the scene, whose count: the "
            "first, `{}`, has {} there and {} here",
            others, drafts.size(), others == 1 ? "has" : "have", frame.file,
            shown(drafts[first].chain.name), frame.chains[first].crosslinks.size(),
            drafts[first].chain.crosslinks.size()));
}

/// Notes how many chains the frame names otherwise, and the first of them.
void note_other_names(ChosenFrame const& frame, std::vector<Draft> const& drafts, Scene& scene) {
    std::size_t renamed = 0;
    std::string first;
    for (std::size_t c = 0; c < drafts.size(); ++c) {
        std::string const &other = frame.chains[c].name, &own = drafts[c].chain.name;
        if (other != own && renamed++ == 0)
            first = fmt::format("`{}` for the scene's `{}`", shown(printable(other)), shown(own));
    }
    if (renamed > 0)
        scene.note(
            fmt::format("`{}` names {} of {} chains otherwise, the first {}: their order "
                        "counts",
                        frame.file, renamed, drafts.size(), first));
}

/// Compares the chains one by one, if the frame tells them apart.
void compare_chains(ChosenFrame const& frame, std::vector<Draft> const& drafts, Scene& scene,
                    Node const& from) {
    if (frame.chains.empty()) return;
    if (frame.chains.size() != drafts.size())
        fail(from,
             fmt::format("`{}` has {} chains, the scene has {}", frame.file, frame.chains.size(),
                         drafts.size()),
             "give a trajectory of the same chains");
    for (std::size_t c = 0; c < drafts.size(); ++c)
        refuse_other_chain(frame.chains[c], drafts[c].chain, c + 1, frame.file, from);
    note_other_names(frame, drafts, scene);
    note_other_crosslinks(frame, drafts, scene);
}

/// Throws InputError for a bead whose residue has another name in the frame.
void compare_residues(ChosenFrame const& frame, std::vector<Draft> const& drafts,
                      Node const& from) {
    if (frame.residue.empty()) return;
    std::size_t site = 0;
    for (Draft const& draft : drafts)
        for (std::size_t k = 0; k < draft.chain.bead_count(); ++k, ++site) {
            std::string other = frame.residue[site].substr(0, 3);
            other.erase(std::remove(other.begin(), other.end(), ' '), other.end());
            // A topology file holds three characters of a name.
            std::string own = residues_of(draft.chain)[k].substr(0, 3);
            own.erase(std::remove(own.begin(), own.end(), ' '), own.end());
            if (other == own || other == "UNK" || own == "UNK") continue;
            fail(from,
                 fmt::format("bead {} of chain `{}` is {} in the scene and {} in `{}`", k + 1,
                             shown(draft.chain.name), own, shown(printable(other)), frame.file),
                 "give a trajectory of the same chains in the same order");
        }
}

}  // namespace

void refuse_frame_of_others(ChosenFrame const& frame, std::vector<Draft> const& drafts,
                            Scene& scene, Node const& start, Node const& from) {
    if (frame.si != scene.si)
        fail(from,
             fmt::format("`{}` is in {}, the scene is not", frame.file,
                         frame.si ? "SI units" : "nm and ps"),
             "give a trajectory in the scene's units");
    std::size_t sites = 0;
    for (Draft const& draft : drafts) {
        refuse_other_kind(draft.chain, start);
        sites += draft.chain.bead_count();
    }
    compare_chains(frame, drafts, scene, from);
    if (sites != frame.position.size())
        fail(from,
             fmt::format("`{}` has {} beads, the scene has {}", frame.file, frame.position.size(),
                         sites),
             "give a trajectory of the same chains");
    compare_residues(frame, drafts, from);
}

}  // namespace catena::scene
