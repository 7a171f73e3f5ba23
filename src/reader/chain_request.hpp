// The part of an entry in `chains:` that is common to all kinds of chains.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bodies/domains.hpp"
#include "scene/branches.hpp"
#include "scene/fields.hpp"
#include "scene/node.hpp"
#include "scene/scene.hpp"
#include "structure/calvados2.hpp"

namespace catena::scene {

/// The scene's System, see system_links.hpp.
class WrittenSystem;
/// A chain of a structure, see structure_entry.hpp.
struct StructurePart;

/// One entry of `chains` with its context; the readers of each kind of chain share it.
struct ChainRequest {
    /// The entry as a map of known keys.
    Fields fields;
    /// The entry as a node, for messages.
    Node const& node;
    std::size_t index;  // index in `chains`, from 0
    Scene& scene;       // all sections except the chains; readers add notes
    Base base = Base::free;
    /// Rigid domains of a chain of residues, ascending.
    std::vector<Domain> rigid = {};
    /// Three-letter names of a chain of residues.
    std::vector<std::string> residues = {};
    /// Residue table of a chain of residues, which its first copy sets.
    std::shared_ptr<ResidueTable const> table = {};
    /// Ends that are amino acids. Others have no charge of a terminus unless the chain asks for it.
    calvados2::ChargedTermini protein_ends = {};
    /// System that the scene names together with written chains, or nullptr.
    WrittenSystem const* system = nullptr;
    /// Number of the chain's first bead in that System.
    std::int64_t particle = 0;
    /// Chain of the entry's structure that is read now, or nullptr.
    StructurePart const* part = nullptr;
    /// True if `start` replaces the positions by those of a frame.
    bool from_frame = false;

    /// Throws InputError for keys without meaning for this kind of chain: those of `record, model,
    /// positions, links, anchor, conformation, rigid, charge_termini, chain, conformer, gaps,
    /// sites` that are not in `keys`. Refuses an anchor without a fixed base, too.
    void allow(char const* kind, Names keys) const;
    /// Ground point of a fixed base; the origin by default.
    Vec3 anchor() const;
    /// True if the chain was cut at a gap.
    bool is_cut() const;
    /// Name as written, or "chain-N" with the entry's number N from 1.
    std::string name() const;
    /// True for `links: as_given`: links take their lengths from the positions.
    bool links_as_given() const;
    /// Value of the chain's `charge_termini`, by default that of the whole scene for the ends that
    /// are amino acids. Ends that were cut at a gap are no termini.
    calvados2::ChargedTermini termini() const;
    /// Charged termini of a complex, by bead; empty for other chains. Each end of a member counts
    /// by its own residue, and `residues` must be known.
    std::vector<calvados2::InnerTerminus> inner_termini() const;
    /// Sets the lengths of links, entry k that to bead k, and moves the beads accordingly. Where
    /// the System joins the two beads its length counts, unless the chain has `links: as_given`.
    void set_lengths(BeadArrays& beads, std::vector<double> lengths) const;
    /// Seed of one copy of this chain; each chain and copy has its own stream of the scene's seed.
    std::uint64_t seed(std::int64_t copy) const;

    /// Reads positions, nm, from the table or structure that `file` names. Throws InputError unless
    /// there is one position per bead.
    std::vector<Vec3> positions_from(Node const& file, std::size_t beads) const;
    /// Places the beads at `positions`, read from `from`, whole across the periodic box. Then fits
    /// positions to lengths or, with `links: as_given`, lengths to positions (StartFit). Rigid
    /// domains keep their shape, and with `sites: com` the links at their ends keep their lengths.
    void place(BeadArrays& beads, std::vector<Vec3> const& positions, Node const& from,
               Parents parents = {}) const;
    /// Throws InputError if two neighbours coincide.
    void refuse_coincident(BeadArrays const& beads, Node const& from, Parents parents = {}) const;
    /// Returns the positions of the sites of a structure. Notes residues that differ from the
    /// chain's.
    std::vector<Vec3> from_structure(std::string const& path, Node const& file) const;
};

}  // namespace catena::scene
