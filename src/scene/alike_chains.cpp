// Implements runs of alike chains and their words.
#include "scene/alike_chains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "scene/freedom.hpp"

namespace catena::scene {
namespace {

constexpr std::size_t most_named = 6;  // runs of alike chains that a sentence names

bool joins_the_same(CrossLink const& a, CrossLink const& b) {
    return a.inboard == b.inboard && a.outboard == b.outboard;
}

bool closes_the_same(LoopClosure const& a, LoopClosure const& b) {
    return a.inboard == b.inboard && a.outboard == b.outboard && a.joint.type == b.joint.type;
}

bool alike(ChainSpec const& a, ChainSpec const& b) {
    return a.size() == b.size() && a.parent == b.parent && a.base == b.base &&
           std::equal(a.crosslinks.begin(), a.crosslinks.end(), b.crosslinks.begin(),
                      b.crosslinks.end(), joins_the_same) &&
           std::equal(a.loops.begin(), a.loops.end(), b.loops.begin(), b.loops.end(),
                      closes_the_same) &&
           std::string_view(contents_of(a)) == contents_of(b) && a.tip == b.tip &&
           (a.tip == Tip::free || tip_name(a) == tip_name(b)) && handle_kind(a) == handle_kind(b);
}

/// "beads" or "bead", as the number asks for.
std::string contents_text(ChainSpec const& chain) {
    if (chain.size() > 1) return contents_of(chain);
    return chain.is_beads() ? "bead" : "body";
}

std::string text_of(Scene const& scene, AlikeChains const& run) {
    ChainSpec const& first = scene.chains[run.first];
    std::string text =
        fmt::format("{} {}{} of {} {}", run.count, first.is_branched() ? "branched " : "",
                    run.count == 1 ? "chain" : "chains", first.size(), contents_text(first));
    if (first.is_ring()) text += " in a ring";
    if (first.is_cross_linked())
        text += fmt::format(" with {} cross-link{}{}", first.crosslinks.size(),
                            first.crosslinks.size() == 1 ? "" : "s", run.count == 1 ? "" : " each");
    if (first.has_loops())
        text += fmt::format(" with {} loop{}{}", first.loops.size(),
                            first.loops.size() == 1 ? "" : "s", run.count == 1 ? "" : " each");
    std::string const name = scene.name_in_file(run.first);
    return text + (run.count == 1 ? fmt::format(" ({})", name)
                                  : fmt::format(" ({} to {})", name,
                                                scene.name_in_file(run.first + run.count - 1)));
}

}  // namespace

char const* contents_of(ChainSpec const& chain) {
    if (chain.is_beads()) return "beads";
    if (!chain.is_linked()) return "bodies";
    std::size_t beads = 0;
    for (std::size_t k = 0; k < chain.linked.size(); ++k) beads += chain.linked.is_bead(k) ? 1 : 0;
    return beads == 0 ? "bodies" : "bodies and beads";
}

std::string tip_name(ChainSpec const& chain) {
    if (chain.tip == Tip::free) return "free";
    return std::string(chain.is_ring() ? "ring, " : "") + catena::name_of(chain.tip_joint.type);
}

std::vector<AlikeChains> alike_chains(Scene const& scene) {
    std::vector<AlikeChains> runs;
    for (std::size_t i = 0; i < scene.chains_a_replica(); ++i) {
        if (!runs.empty() && alike(scene.chains[runs.back().first], scene.chains[i]))
            ++runs.back().count;
        else
            runs.push_back({i, 1});
    }
    return runs;
}

std::string chains_text(Scene const& scene) {
    std::vector<AlikeChains> const runs = alike_chains(scene);
    std::string text;
    for (std::size_t i = 0; i < runs.size() && i < most_named; ++i)
        text += (i == 0 ? "" : "; ") + text_of(scene, runs[i]);
    if (runs.size() > most_named)
        text += fmt::format("; {} other chains", scene.chains_a_replica() - runs[most_named].first);
    if (scene.replicas > 1) text += fmt::format("; {} replicas", scene.replicas);
    return text;
}

}  // namespace catena::scene
