// Collects the loads of local bodies from the scene.
#include "dynamics/body_loads.hpp"

#include <algorithm>

namespace catena {
namespace {

/// Maker that force terms are asked to fill their arrays with (ForceTerm::collect()).
struct BodyLoadsMaker {
    ChainGroup const& group;
    Scene const& scene;

    /// True if the term acts on a chain of the group, on any rank.
    template <class Term>
    bool any() const {
        return std::any_of(group.chains.begin(), group.chains.end(), [&](GroupChain const& chain) {
            return Term::count(scene, scene.chains[static_cast<std::size_t>(chain.in_scene)]) > 0;
        });
    }
    bool any_with(auto const& property) const {
        return terms::any_of([&](auto term) { return property(term) && any<decltype(term)>(); });
    }
    bool has_joint_loads() const {
        return any_with([](auto term) { return term.acts_along_joints; });
    }
    bool has_constant_wrenches() const {
        return any_with([](auto term) { return term.has_constant_wrench; });
    }
    terms::ConstantWrench constant_wrench(ChainSpec const& chain, std::size_t k) const {
        return terms::constant_wrench(chain, k);
    }
    /// Makes a field of get(chain, k) for every local body.
    template <int D, class Get>
    Field<D> field(Get const& get) const {
        Field<D> made(group.size);
        for (dca::Piece const& piece : group.pieces) {
            ChainSpec const& chain =
                scene.chains[static_cast<std::size_t>(group.chains[piece.chain].in_scene)];
            for (std::int64_t i = 0; i < piece.count; ++i)
                made.set(piece.local + i, get(chain, static_cast<std::size_t>(piece.body + i)));
        }
        return made;
    }
};

}  // namespace

BodyLoads make_body_loads(ChainGroup const& group, Scene const& scene) {
    BodyLoads loads;
    BodyLoadsMaker const maker{group, scene};
    loads.joint_loads = maker.has_joint_loads();
    terms::for_each([&](auto term) {
        using Term = decltype(term);
        Term::collect(maker, static_cast<LoadsOfTerm<Term, Field>&>(loads));
    });
    return loads;
}

}  // namespace catena
