// Forces on bodies other than the joints' constraints, as the scene specifies them: the arrays of
// all force terms (src/terms). Frames: W ground axes, B body axes.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "chain/chain_group.hpp"
#include "dca/lane_access.hpp"
#include "terms/force_terms.hpp"

namespace catena {

/// Arrays of one term; a type of its own for each term.
template <class Term, template <int> class F>
struct LoadsOfTerm : Term::template Arrays<F> {};

/// Arrays of all terms. F is the kind of their fields: on the host, in a Space, or views.
template <template <int> class F, class Terms>
struct LoadsOfTerms;
template <template <int> class F, class... Terms>
struct LoadsOfTerms<F, TypeList<Terms...>> : LoadsOfTerm<Terms, F>... {
    /// True if a term acts along the coordinates of joints.
    bool joint_loads = false;

    /// True if a term acts on the group and has the property.
    template <class Property>
    bool any(Property const& property) const {
        return ((property(Terms{}) && Terms::acts_in(*this)) || ...);
    }
    /// Converts all arrays: convert() makes a field of another one.
    template <template <int> class G, class Convert>
    LoadsOfTerms<G, TypeList<Terms...>> converted(Convert const& convert) const {
        return {LoadsOfTerm<Terms, G>{Terms::template converted<typename Terms::template Arrays<G>>(
                    *this, convert)}...,
                joint_loads};
    }
};

/// Loads of a group's bodies. Fields are empty if no body has such a load.
struct BodyLoads : LoadsOfTerms<Field, terms::ForceTerms> {
    /// True if a term depends on positions and velocities, or on orientations.
    bool use_positions() const {
        return any([](auto term) { return term.uses_positions; });
    }
    bool use_orientations() const {
        return any([](auto term) { return term.uses_orientations; });
    }
    /// True if a term acts on bodies, besides joints and gravity.
    bool act_on_bodies() const {
        return any([](auto term) { return term.exerts_forces; });
    }
};
/// Loads of the group's local bodies.
BodyLoads make_body_loads(ChainGroup const&, Scene const&);

/// Plain pointers to the fields of BodyLoads, for loops over bodies.
using BodyLoadsView = LoadsOfTerms<ConstView, terms::ForceTerms>;
/// BodyLoads copied to a Space. The host's BodyLoads must outlive it.
template <class Space>
class BodyLoadsIn {
    template <int D>
    using Fixed = typename Space::template Fixed<D>;

  public:
    explicit BodyLoadsIn(BodyLoads const& host) : loads_(host.converted<Fixed>(Copy{})) {}
    BodyLoadsView view() const { return loads_.template converted<ConstView>(See{}); }

  private:
    struct Copy {
        template <int D>
        Fixed<D> operator()(Field<D> const& field) const {
            return Fixed<D>(field);
        }
    };
    struct See {
        template <class FieldInSpace>
        auto operator()(FieldInSpace const& field) const {
            return field.view();
        }
    };
    LoadsOfTerms<Fixed, terms::ForceTerms> loads_;
};

/// Potential energy of the bodies of a group on this rank, kJ/mol, by term
/// (terms::place_of_energy()). Entries of a term that does not act are 0.
using PotentialEnergy = std::array<std::vector<double>, terms::number_of_energies>;

/// A joint as force terms see it (ForceTerm::add_along()), of one body or of several side by side.
template <class Place>
struct LoadedJoint {
    static constexpr bool is_one = dca::is_one_body<Place>;
    BodyLoadsView const& given;
    Place k;
    JointType type;
    Vector<dca::RealAt<Place>, 4> q;
    Vector<dca::RealAt<Place>, 3> qd;

    template <int D>
    CATENA_HD auto load(ConstView<D> const& field) const {
        return dca::read(field, k);
    }
    /// Sum of the terms' loads along the joint's coordinates.
    CATENA_HD Vector<dca::RealAt<Place>, 3> along() const { return sum(terms::ForceTerms{}); }

  private:
    template <class... Terms>
    CATENA_HD Vector<dca::RealAt<Place>, 3> sum(TypeList<Terms...>) const {
        Vector<dca::RealAt<Place>, 3> along = terms::JointTorque::along(*this);
        (Terms::add_along(*this, along), ...);
        return along;
    }
};

/// A revolute joint as force terms see it: its only coordinate, an angle about an axis.
struct LoadedAxis {
    BodyLoadsView const& given;
    std::int64_t k;
    ConstView<4> angle;
    ConstView<3> rate;

    CATENA_HD double at(ConstView<3> const& field) const { return field.at(k, 0); }
    CATENA_HD double at(ConstView<4> const& field) const { return field.at(k, 0); }
    CATENA_HD double q() const { return angle.at(k, 0); }
    CATENA_HD double qd() const { return rate.at(k, 0); }
    /// Sum of the terms' torques about the axis.
    CATENA_HD double along() const { return sum(terms::ForceTerms{}); }

  private:
    template <class... Terms>
    CATENA_HD double sum(TypeList<Terms...>) const {
        double along = at(given.torque);
        (Terms::add_about_axis(*this, along), ...);
        return along;
    }
};

/// Potential energy of bodies in the terms that have one. entry(k) returns the body.
template <class Entry>
PotentialEnergy potential_of(BodyLoads const& given, std::int64_t size, Entry const& entry) {
    PotentialEnergy energy;
    for (std::vector<double>& each : energy) each.assign(static_cast<std::size_t>(size), 0.0);
    for (std::int64_t k = 0; k < size; ++k) {
        terms::PlacedBody const body = entry(k);
        terms::for_each([&](auto term) {
            using Term = decltype(term);
            if constexpr (Term::energy != nullptr)
                energy[terms::place_of_energy<Term>()][static_cast<std::size_t>(k)] =
                    Term::energy_of(given, body);
        });
    }
    return energy;
}

/// Radius of gyration of a body: sqrt(tr J / (2 m)).
inline double radius_of_gyration(Sym3 const& inertia, double mass) {
    return std::sqrt(0.5 * (inertia.data[0] + inertia.data[2] + inertia.data[5]) / mass);
}

}  // namespace catena
