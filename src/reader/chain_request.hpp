// What every kind of chain asks of its entry in `chains:`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bodies/domains.hpp"
#include "scene/calvados2.hpp"
#include "scene/fields.hpp"
#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

class WrittenSystem;

struct ChainRequest {
    Fields fields;
    Node const& node;
    std::size_t index;  // in `chains`, from 0
    Scene& scene;       // everything but the chains; readers add notes
    Base base = Base::free;
    std::vector<Domain> rigid = {};          // ascending; of a chain of residues
    std::vector<std::string> residues = {};  // three-letter names, of a chain of residues
    WrittenSystem const* system = nullptr;   // that the scene names beside its chains
    std::int64_t particle = 0;               // of the first bead in it

    /// Refuses those of `record, model, positions, links, anchor, conformation, rigid` that are not
    /// in `keys`: they mean nothing for this kind of chain.
    void allow(char const* kind, Names keys) const;
    /// Origin where none is given.
    Vec3 anchor() const;
    /// As written, else by its number.
    std::string name() const;
    bool links_as_given() const;
    /// The chain's `charge_termini`, else what the scene says of all.
    calvados2::ChargedTermini termini() const;
    /// Gives links the lengths of the System that the scene names, where it joins the two beads,
    /// and moves the beads to these.
    void set_lengths(BeadArrays& beads) const;
    /// The scene's seed, told apart by chain and copy.
    std::uint64_t seed(std::int64_t copy) const;

    /// Positions from the table or PDB file that `file` names: one a bead.
    std::vector<Vec3> positions_from(Node const& file, std::size_t beads) const;
    /// Puts the beads at `positions`, which `from` gave, whole across the periodic box, and fits
    /// positions to lengths or, with `links: as_given`, lengths to positions (StartFit). Rigid
    /// domains keep their shape.
    void place(BeadArrays& beads, std::vector<Vec3> const& positions, Node const& from) const;
    /// InputError when two neighbours coincide.
    void refuse_coincident(BeadArrays const& beads, Node const& from) const;
    /// Positions of the sites of a PDB file; a note where its residues are not the chain's.
    std::vector<Vec3> from_structure(std::string const& path, Node const& file) const;
};

}  // namespace catena::scene
