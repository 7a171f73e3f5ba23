// Implements the start from a frame of another run.
#include "place/start_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "frames/chosen_frame.hpp"
#include "generate/cells.hpp"
#include "generate/conformation.hpp"
#include "generate/crosslinks.hpp"
#include "generate/start_fit.hpp"
#include "generate/superposition.hpp"
#include "keys/maps.hpp"
#include "place/chain_motion.hpp"
#include "place/frame_match.hpp"
#include "scene/fields.hpp"
#include "scene/files.hpp"

namespace catena::scene {

namespace {

/// Distance in nm between a domain and the frame's positions that is noted, and one that is
/// refused.
double constexpr noted_misfit = 0.02, largest_misfit = 0.5;
/// Relative difference of box edges that is rounding, such as that of single precision.
double constexpr same_edge = 1e-6;

/// Range of the carried beads of a unit.
std::pair<std::size_t, std::size_t> beads_of(LinkedArrays const& linked, std::size_t unit) {
    return {static_cast<std::size_t>(linked.carried.offset[unit]),
            static_cast<std::size_t>(linked.carried.offset[unit + 1])};
}

/// Beads of a chain, those of its rigid domains included, and the domains.
struct Beads {
    BeadArrays arrays;
    std::vector<Domain> rigid;
};

/// Returns the beads of a chain at the frame's positions, with the lengths of their links.
Beads beads_at(ChainSpec const& chain, std::span<Vec3 const> positions) {
    if (chain.is_beads()) {
        Beads beads{chain.beads, {}};
        beads.arrays.position.assign(positions.begin(), positions.end());
        return beads;
    }
    LinkedArrays const& linked = chain.linked;
    Beads beads;
    beads.arrays.anchor = linked.anchor;
    beads.arrays.position.assign(positions.begin(), positions.end());
    beads.arrays.mass = linked.carried.mass;
    for (std::size_t u = 0; u < linked.size(); ++u) {
        auto const [first, end] = beads_of(linked, u);
        beads.arrays.length.push_back(linked.length[u]);
        for (std::size_t b = first + 1; b < end; ++b)
            beads.arrays.length.push_back(
                norm(linked.carried.position[b] - linked.carried.position[b - 1]));
        if (end > first + 1) beads.rigid.push_back({first, end - 1});
    }
    return beads;
}

/// Shift of a chain that brings its centre into the old box, and that box into the middle of the
/// new one, along the axes that differ.
Vec3 shift_into(ChainSpec const& chain, Vec3 const& old, Vec3 const& now,
                std::array<bool, 3> const& differs) {
    std::vector<Vec3> const& at = chain.is_beads() ? chain.beads.position : chain.linked.position;
    Vec3 centre = Vec3::zero(), shift = Vec3::zero();
    for (Vec3 const& point : at)
        centre = plus_scaled(centre, 1 / static_cast<double>(at.size()), point);
    for (int i = 0; i < 3; ++i)
        if (differs[static_cast<std::size_t>(i)])
            shift[i] = 0.5 * (now[i] - old[i]) - old[i] * std::floor(centre[i] / old[i]);
    return shift;
}

/// Sets the kind of start velocities of a chain, and the velocities to zero.
void set_velocities(Draft& draft, bool warm) {
    ChainSpec& chain = draft.chain;
    Node const* const written = draft.node->find("velocities");
    bool const zero = written && written->text == "zero";
    chain.velocities = warm && !zero ? StartVelocities::thermal : StartVelocities::zero;
    for (std::vector<Vec3>* const velocities :
         {&chain.beads.velocity, &chain.linked.velocity, &chain.linked.omega})
        std::fill(velocities->begin(), velocities->end(), Vec3::zero());
}

/// Puts the chains of a scene where a frame has them.
class FrameStart {
  public:
    FrameStart(std::vector<Draft>& drafts, Scene& scene, Node const& start)
        : drafts_(drafts), scene_(scene), start_(start), fields_(start, keys::start) {
        Node const* const number = fields_.find("frame");
        bool const last = !number || (number->kind == Node::Kind::scalar && number->text == "last");
        std::optional<std::int64_t> const chosen =
            last ? std::nullopt : std::optional(whole(*number, 0));
        Node const& from = fields_.need("from", "from: run-1");
        frame_ = read_frame(resolved(text(from), scene.file), chosen);
        frame_.file = shown_path(frame_.file);
    }

    void run(bool warm) {
        refuse_frame_of_others(frame_, drafts_, scene_, start_, *fields_.find("from"));
        place();
        if (scene_.box && frame_.box) change_box();
        bool thermal = false;
        for (Draft& draft : drafts_) {
            set_velocities(draft, warm);
            thermal = thermal || draft.chain.velocities == StartVelocities::thermal;
            draft.movable = false;
        }
        scene_.note(fmt::format(
            "positions come from {}; its velocities are not used, chains start {}", frame_.text(),
            thermal
                ? fmt::format("with thermal ones drawn at {:.6g} K", scene_.dynamics.temperature)
                : "at rest"));
    }

  private:
    /// Places all chains, whole and with links of their lengths.
    void place() {
        bool const system = scene_.forces.openmm && !scene_.forces.openmm->system.empty();
        StartFit fit(scene_, *fields_.find("from"), "give a frame of this model",
                     system ? largest_soft_change : largest_link_change, largest_relaxed_change);
        std::optional<Vec3> const& box = frame_.box ? frame_.box : scene_.box;
        std::size_t site = 0;
        for (Draft& draft : drafts_) {
            std::size_t const count = draft.chain.bead_count();
            if (draft.chain.is_cross_linked()) open_crosslinks(draft);
            place(draft, std::span(frame_.position).subspan(site, count), fit, box);
            site += count;
        }
        fit.note();
        if (others_pulled_ > 0)
            scene_.note(fmt::format("cross-links move beads of {} more {} by up to {:.3g} {}",
                                    others_pulled_, others_pulled_ == 1 ? "copy" : "copies",
                                    farthest_pulled_, scene_.si ? "m" : "nm"));
        if (misfit_ > noted_misfit)
            scene_.note(
                fmt::format("rigid domains keep the scene's shape and were laid on the "
                            "frame's positions: beads are up to {:.3g} nm from there ({})",
                            misfit_, misfit_at_));
    }
    void place(Draft& draft, std::span<Vec3 const> positions, StartFit& fit,
               std::optional<Vec3> const& box) {
        ChainSpec& chain = draft.chain;
        Beads beads = beads_at(chain, positions);
        bool const link = chain.is_beads() && chain.tip == Tip::jointed;
        StartFit::Chain const at{
            chain.name,  beads.arrays, chain.base, beads.rigid, link ? &chain.tip_joint : nullptr,
            chain.parent};
        fit.make_whole(at, false, box);
        if (std::int64_t const k = coincident_bead(beads.arrays, chain.base, chain.parent); k >= 0)
            fail_at(*fields_.find("from"), "bead", k + 1,
                    fmt::format("bead {} of chain `{}` coincides with the one it hangs on", k + 1,
                                shown(chain.name)),
                    "give another frame");
        std::vector<Superposition> const laid = lay_domains(chain, beads);
        fit.fit(at);
        if (chain.is_beads()) {
            chain.beads.position = beads.arrays.position;
            if (chain.is_cross_linked()) close_crosslinks(draft);
            return;
        }
        LinkedArrays& linked = chain.linked;
        for (std::size_t u = 0; u < linked.size(); ++u) {
            Quat const& q = laid[u].rotation;
            std::size_t const first = beads_of(linked, u).first;
            linked.orientation[u] = {q.w, q.x, q.y, q.z};
            linked.position[u] =
                beads.arrays.position[first] - to_matrix(q) * linked.carried.position[first];
        }
    }
    /// Takes the lengths from cross-links without one that are links of the frame's run, too, or
    /// may be: the frame has them. Others keep the distance of the scene's positions. Throws
    /// InputError if the scene generates these.
    void open_crosslinks(Draft& draft) {
        ChainSpec& chain = draft.chain;
        auto const number = static_cast<std::size_t>(&draft - drafts_.data());
        for (std::size_t c = 0; c < draft.open_crosslinks.size(); ++c) {
            if (!draft.open_crosslinks[c]) continue;
            CrossLink& link = chain.crosslinks[c];
            if (is_linked_in_frame(number, link))
                link.length = 0;
            else if (link.length == 0)
                fail(*draft.node->find("crosslinks"),
                     fmt::format("the cross-link of beads {} and {} has no length, and `{}` is of "
                                 "a run without it",
                                 link.inboard + 1, link.outboard + 1, frame_.file),
                     fmt::format("add it, [{}, {}, LENGTH]; `relax: true` pulls the beads together",
                                 link.inboard + 1, link.outboard + 1));
        }
    }
    /// True if the run of the frame had the cross-link, or the file does not tell.
    bool is_linked_in_frame(std::size_t chain, CrossLink const& link) const {
        if (frame_.chains.empty()) return true;
        auto const& there = frame_.chains[chain].crosslinks;
        std::array<std::int64_t, 2> const ends{link.inboard, link.outboard};
        return std::find(there.begin(), there.end(), ends) != there.end();
    }
    /// Gives cross-links their lengths. Notes are those of the first copy of a chain; redundant
    /// links of an imported System have been noted.
    void close_crosslinks(Draft& draft) {
        bool const is_copy = &draft != drafts_.data() && (&draft - 1)->node == draft.node;
        std::vector<Vec3> const given = draft.chain.beads.position;
        // Without forces no overlap of beads that are pulled together does harm.
        fit_crosslinks(draft.chain, {.scene = scene_,
                                     .from = *fields_.find("from"),
                                     .far = !scene_.forces.openmm,
                                     .quiet = is_copy,
                                     .is_known = !draft.node->find("crosslinks"),
                                     .remedy = "write `relax: true`, or give a frame that fits"});
        if (is_copy) count_pulled(draft.chain, given);
    }
    /// Counts a chain of which a cross-link had noticeably another length at the positions `given`.
    void count_pulled(ChainSpec const& chain, std::vector<Vec3> const& given) {
        if (std::none_of(chain.crosslinks.begin(), chain.crosslinks.end(), [&](CrossLink const& l) {
                double const distance = norm(given[static_cast<std::size_t>(l.outboard)] -
                                             given[static_cast<std::size_t>(l.inboard)]);
                return std::abs(distance - l.length) >= noted_link_change * l.length;
            }))
            return;
        ++others_pulled_;
        for (std::size_t k = 0; k < given.size(); ++k)
            farthest_pulled_ = std::max(farthest_pulled_, norm(chain.beads.position[k] - given[k]));
    }
    /// Lays the rigid domains of a chain on their beads and moves these onto them. Returns one
    /// motion per unit; that of a single bead is no rotation.
    std::vector<Superposition> lay_domains(ChainSpec const& chain, Beads& beads) {
        LinkedArrays const& linked = chain.linked;
        std::vector<Superposition> laid(linked.size());
        for (std::size_t u = 0; u < linked.size(); ++u) {
            auto const [first, end] = beads_of(linked, u);
            if (end - first < 2) continue;
            auto const shape = std::span(linked.carried.position).subspan(first, end - first);
            laid[u] =
                superpose(shape, std::span(beads.arrays.position).subspan(first, end - first));
            if (laid[u].largest > misfit_) {
                misfit_ = laid[u].largest;
                misfit_at_ =
                    fmt::format("beads {} to {} of chain `{}`", first + 1, end, shown(chain.name));
            }
            if (misfit_ > largest_misfit)
                fail(*fields_.find("from"),
                     fmt::format("{} form a rigid domain of another shape in the frame: beads are "
                                 "up to {:.3g} nm from the scene's shape",
                                 misfit_at_, misfit_),
                     "give a frame of the same domains");
            Mat3 const r = to_matrix(laid[u].rotation);
            for (std::size_t b = first; b < end; ++b)
                beads.arrays.position[b] = laid[u].shift + r * linked.carried.position[b];
        }
        return laid;
    }

    /// Brings whole chains into the frame's box, and that box into the middle of the scene's, along
    /// the axes on which the edges differ.
    void change_box() {
        Vec3 const &old = *frame_.box, &now = *scene_.box;
        std::array<bool, 3> differs{};
        for (std::size_t i = 0; i < 3; ++i) {
            auto const axis = static_cast<int>(i);
            differs[i] = std::abs(old[axis] - now[axis]) > same_edge * now[axis];
        }
        if (!differs[0] && !differs[1] && !differs[2]) return;
        bool const free = std::all_of(drafts_.begin(), drafts_.end(),
                                      [](Draft const& draft) { return is_rotatable(draft.chain); });
        for (Draft& draft : drafts_) {
            if (!free) break;
            translate(draft.chain, shift_into(draft.chain, old, now, differs));
        }
        scene_.note(fmt::format(
            "the frame's box is {:.6g} x {:.6g} x {:.6g} nm, the scene's {:.6g} x {:.6g} x {:.6g} "
            "nm: {}",
            old[0], old[1], old[2], now[0], now[1], now[2],
            free
                ? "along the axes that differ, whole chains are in the frame's box, which is in "
                  "the middle of the scene's"
                : "chains stay where the frame has them, because some are attached to the ground"));
    }
    std::vector<Draft>& drafts_;
    Scene& scene_;
    Node const& start_;
    Fields fields_;
    ChosenFrame frame_;
    /// Largest distance of a domain's bead from the frame's position, nm, and its domain.
    double misfit_ = 0;
    std::string misfit_at_;
    /// Copies after the first whose beads cross-links pulled, and the largest way of a bead.
    std::size_t others_pulled_ = 0;
    double farthest_pulled_ = 0;
};

}  // namespace

void start_from_frame(std::vector<Draft>& drafts, Scene& scene, Node const& start, bool warm) {
    FrameStart frame(drafts, scene, start);
    forget_fits(scene);
    frame.run(warm);
}

}  // namespace catena::scene
