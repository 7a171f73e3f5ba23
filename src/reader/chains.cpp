// Implements the reader of chain entries. An entry names one source of its bodies: a sequence, a
// FASTA or PDB file, a list or file of bodies, or a generator. Each copy is made from that source,
// joined to its tip, and given the kind of its start velocities. Places of movable chains follow
// later (placement.hpp).
#include "reader/chains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "bodies/bodies.hpp"
#include "bodies/crosslinks.hpp"
#include "bodies/hdf5_bodies.hpp"
#include "bodies/loops.hpp"
#include "generate/conformation.hpp"
#include "generate/crosslinks.hpp"
#include "generate/start_fit.hpp"
#include "io/memory_limit.hpp"
#include "io/printable.hpp"
#include "keys/maps.hpp"
#include "place/concentration.hpp"
#include "reader/chain_request.hpp"
#include "reader/generator_entry.hpp"
#include "reader/linked.hpp"
#include "reader/models.hpp"
#include "reader/sections.hpp"
#include "reader/sequences.hpp"
#include "reader/structure_entry.hpp"
#include "reader/system_links.hpp"
#include "reader/tip.hpp"
#include "scene/fields.hpp"
#include "scene/files.hpp"
#include "scene/freedom.hpp"
#include "structure/residue_names.hpp"
#include "terms/force_terms.hpp"

namespace catena::scene {

namespace {

/// The entry with all keys that a chain may have.
Fields chain_fields(Node const& entry) { return Fields(entry, keys::chain); }

/// Returns the single key that defines the bodies of the chain. Throws InputError for none or
/// several.
Node const& source_of(Fields const& fields) {
    Node const* source = nullptr;
    for (char const* const key : {"sequence", "fasta", "pdb", "bodies", "generator"}) {
        Node const* const here = fields.find(key);
        if (here && source)
            fail(*here, fmt::format("the chain has both `{}` and `{}`", source->key, key),
                 "keep one of them");
        if (here) source = here;
    }
    if (!source)
        fail(fields.node(), "the chain does not define its bodies",
             "add one of `sequence`, `fasta`, `pdb`, `bodies`, `generator`");
    return *source;
}

/// Base of the chain as written, or the default of its source.
Base base_of(Fields const& fields, Node const& source) {
    if (Node const* const base = fields.find("base"))
        return choice<Base>(*base, {{"free", Base::free}, {"fixed", Base::fixed}});
    return stands_fixed(source) ? Base::fixed : Base::free;
}

/// Throws InputError unless all axes of a chain with `planar` joints are parallel.
void refuse_unparallel(ChainSpec const& chain, Node const& source, Node const& planar) {
    if (chain.is_branched())
        fail(planar, "not in this version: planar joints of a branched chain",
             "write `type: revolute`");
    std::size_t odd = 0;
    if (axes_are_parallel(chain, odd)) return;
    bool const body = odd < chain.bodies.size() && source.kind == Node::Kind::list;
    fail(
        body ? source.items[odd] : planar,
        fmt::format(
            "the chain has planar joints, but the {} joint {} is not parallel to the previous ones",
            name_of(odd < chain.bodies.size() ? chain.bodies.joint[odd] : chain.tip_joint.type),
            odd < chain.bodies.size() ? std::to_string(odd + 1) : "of the tip"),
        "correct `axis` or `rotation`, or write `type: revolute`");
}

/// Looks the residues of beads up in the table that the chain's `model` names, and hands the table
/// to the forces. Throws InputError for a residue that is not in it.
void look_up(ChainRequest& request, Node const& model, std::vector<std::string> const& names) {
    if (request.scene.si)
        fail(model, "a residue table in SI units",
             "write `units: md`: its parameters are in nm, amu and kJ/mol");
    ResidueTable const& table = table_of(request);
    Residues residues;
    for (std::string const& name : names) {
        residues.push_back(table.find(std::string_view(name)));
        if (residues.back() == nullptr)
            fail_at(request.node, "bead", std::ssize(residues),
                    fmt::format("residue `{}` is not in {}", shown(name), table.name()),
                    "give each bead a `residue` of that table");
    }
    hand_to_forces(request, residues);
    request.protein_ends = {is_amino_acid(names.front()), is_amino_acid(names.back())};
}

/// Reads beads written one by one into a chain. Links have the written lengths, or those of the
/// positions if no length is written or with `links: as_given`. Returns true if velocities are
/// written.
bool explicit_beads(ChainRequest& request, Node const& source, ChainSpec& to) {
    request.allow("beads written one by one", {"links", "anchor", "model"});
    ExplicitBeads made = read_beads(source, request.base);
    BeadArrays& beads = to.beads = std::move(made.beads);
    if (Node const* const model = request.fields.find("model"))
        look_up(request, *model, beads.residue);
    std::vector<std::int64_t> const& parent = to.parent = std::move(made.parent);
    beads.anchor = request.anchor();
    std::vector<double> const written = beads.length;
    std::ptrdiff_t const first = request.base == Base::fixed ? 0 : 1;
    auto const is_open = [](double length) { return std::isnan(length); };
    bool const as_given =
        request.links_as_given() || std::any_of(written.begin() + first, written.end(), is_open);
    StartFit fit(request.scene, source, "give positions that fit the links, or leave `length` out");
    StartFit::Chain const chain{request.name(), beads, request.base, {}, nullptr, parent};
    fit.make_whole(chain, as_given);
    request.refuse_coincident(beads, source, parent);
    take_lengths(beads, request.base, parent);
    bool any = false;
    for (std::size_t k = 0; k < written.size() && !request.links_as_given(); ++k)
        if (!is_open(written[k])) beads.length[k] = written[k], any = true;
    if (any) fit.fit(chain);
    fit.note();
    return made.velocities;
}

/// Notes the links of rigid bodies that the sides of the box cut, and those that may be cut.
void note_cut_links(ChainRequest const& request, ExplicitLinked const& made) {
    if (made.doubtful > 0)
        request.scene.note(fmt::format(
            "chain `{}`: the link to body {} is {:.4g} long, more than half an edge of the "
            "periodic box, and is not changed: if a side of the box cuts it, give its `length`",
            shown(request.name()), made.doubtful, made.doubtful_length));
    if (made.cut_links == 0) return;
    request.scene.note(
        fmt::format("{} of chain `{}` {} cut by the sides of the periodic box, the first that of "
                    "body {}: made whole by nearest images",
                    made.cut_links == 1 ? "1 link" : fmt::format("{} links", made.cut_links),
                    shown(request.name()), made.cut_links == 1 ? "is" : "are", made.first_cut));
}

/// Notes the residues that cross-links join, if they have other numbers in the structure file.
void note_residues(std::vector<CrossLink> const& links, ChainRequest const& request) {
    if (request.part == nullptr) return;
    std::vector<PdbSite> const& sites = request.part->from.sites;
    std::string joined;
    bool differ = false;
    for (CrossLink const& link : links) {
        auto const inboard = static_cast<std::size_t>(link.inboard),
                   outboard = static_cast<std::size_t>(link.outboard);
        if (std::max(inboard, outboard) >= sites.size()) return;
        PdbSite const &first = sites[inboard], &last = sites[outboard];
        differ |= (!first.label.empty() && first.label != std::to_string(inboard + 1)) ||
                  (!last.label.empty() && last.label != std::to_string(outboard + 1));
        joined += fmt::format("{}{} {} to {} {}", joined.empty() ? "" : ", ", first.residue,
                              first.label, last.residue, last.label);
    }
    if (differ)
        request.scene.note(fmt::format(
            "`crosslinks` count the beads of chain `{}` from 1, not by the residue numbers of "
            "`{}`: they join {}",
            shown(request.name()), request.part->from.file, joined));
}

/// Notes a protein whose first and last residues are joined but have the charges and masses of
/// termini.
void note_joined_ends(ChainSpec const& chain, ChainRequest const& request) {
    if (request.residues.empty() || request.system || request.fields.find("charge_termini") ||
        !chain.is_beads() || chain.is_branched())
        return;
    auto const last = static_cast<std::int64_t>(chain.size()) - 1;
    bool const joined =
        chain.is_ring() ||
        std::any_of(chain.crosslinks.begin(), chain.crosslinks.end(), [&](CrossLink const& link) {
            return link.inboard == 0 && link.outboard == last;
        });
    calvados2::ChargedTermini const ends = request.termini();
    if (!joined || !(ends.n || ends.c)) return;
    request.scene.note(
        fmt::format("chain `{}` is closed, and its ends have the charges and masses of termini: "
                    "write `charge_termini: none` for a cyclic peptide, or `both` to keep them",
                    shown(request.name())));
}

/// True if a file gives the positions of the beads.
bool is_given(ChainRequest const& request, Node const& source) {
    Node const* const conformation = request.fields.find("conformation");
    return request.fields.find("positions") || source.key == "pdb" ||
           (conformation && conformation->kind == Node::Kind::map);
}
/// True if Catena makes the positions of the beads.
bool is_generated(ChainRequest const& request, Node const& source) {
    return source.key != "bodies" && !is_given(request, source);
}

/// Throws InputError for a ring of a sequence whose start is generated: its ends are anywhere.
void refuse_ring_of_generated(ChainSpec const& chain, ReadTip const& tip,
                              ChainRequest const& request, Node const& source) {
    bool const sequence = source.key == "sequence" || source.key == "fasta";
    if (!sequence || !is_generated(request, source) || !tip.joint.ring || chain.is_branched())
        return;
    fail(*request.node.find("tip"), "a ring of a sequence whose start is generated",
         fmt::format("leave `tip` out and write `crosslinks: [[1, {}, {:.2g}]]`, which pulls the "
                     "ends together, or give positions",
                     chain.size(), chain.beads.length.back()));
}

/// Gives a cross-link without a length that of the System, if that joins its beads.
void take_length(CrossLink& link, ChainRequest const& request) {
    if (link.length > 0 || !request.system || request.links_as_given()) return;
    double const length =
        request.system->length(request.particle + link.inboard, request.particle + link.outboard);
    if (length > 0) link.length = length;
}

/// Gives cross-links without a length the distance of the written positions. Those of generated
/// ones, which the frame of `start` replaces, stay without.
void take_written_lengths(ChainSpec& chain, bool generated) {
    for (CrossLink& link : chain.crosslinks)
        if (link.length == 0 && !generated)
            link.length = norm(chain.beads.position[static_cast<std::size_t>(link.outboard)] -
                               chain.beads.position[static_cast<std::size_t>(link.inboard)]);
    chain.redundant_links = redundant_links(chain);
}

/// Adds the entry's cross-links. Where the System joins two beads its length counts, unless the
/// entry gives one or has `links: as_given`. A frame that replaces the positions is fitted to them
/// later. Returns Draft::open_crosslinks.
std::vector<bool> cross_link(ChainSpec& chain, ChainRequest const& request, Node const& source,
                             bool quiet) {
    Node const* const node = request.fields.find("crosslinks");
    if (!node) return {};
    bool const generated = is_generated(request, source);
    chain.crosslinks = read_crosslinks(*node, chain);
    if (chain.name.empty()) chain.name = request.name();
    for (CrossLink& link : chain.crosslinks) {
        take_length(link, request);
        if (link.length == 0 && generated && !request.from_frame)
            fail(*node,
                 fmt::format("the cross-link of beads {} and {} has no length, and the start is "
                             "generated",
                             link.inboard + 1, link.outboard + 1),
                 fmt::format("add it, [{}, {}, LENGTH]", link.inboard + 1, link.outboard + 1));
    }
    note_residues(chain.crosslinks, request);
    std::vector<bool> open;
    for (CrossLink const& link : chain.crosslinks) open.push_back(link.length == 0);
    if (request.from_frame)
        take_written_lengths(chain, generated);
    else
        fit_crosslinks(chain, {request.scene, *node, generated, quiet});
    return open;
}

/// Facts that a source of bodies tells of them: true if it has their velocities, and its first
/// planar joint, or nullptr.
struct FromSource {
    bool velocities = true;
    Node const* planar = nullptr;
};

/// Makes the beads of a sequence or of a structure's chain. Rigid domains become bodies; the other
/// beads stay points.
void residues_of_sequence(ChainRequest& request, std::int64_t copy, ChainSpec& chain) {
    chain.beads = read_sequence(request, copy);
    if (request.part != nullptr) chain.members = request.part->names;
    if (request.rigid.empty()) return;
    chain.linked = with_domains(chain.beads, request.rigid, *request.fields.find("rigid"));
    chain.beads = {};
}

/// Reads the bodies that the entry lists, or those of the file that it names.
FromSource written_bodies(ChainRequest& request, Node const& source, ChainSpec& chain) {
    if (source.kind == Node::Kind::map) {
        request.allow("rigid bodies", {});
        Node const& file = Fields(source, keys::hdf5).need("hdf5", "hdf5: chain.h5");
        ChainSpec made = read_hdf5_bodies(resolved(text(file), request.scene.file), request.base);
        chain.bodies = std::move(made.bodies);
        chain.parent = std::move(made.parent);
        chain.term_numbers = std::move(made.term_numbers);
        return {};
    }
    BodyList const kind = kind_of_list(source);
    if (kind == BodyList::beads) return {explicit_beads(request, source, chain)};
    if (kind == BodyList::linked) {
        request.allow("bodies on links", {"anchor"});
        ExplicitLinked made =
            read_linked(source, request.base, request.anchor(), request.scene.box);
        note_cut_links(request, made);
        chain.linked = std::move(made.linked);
        return {made.velocities};
    }
    request.allow("rigid bodies", {});
    ExplicitBodies made = read_bodies(source, request.base);
    chain.bodies = std::move(made.bodies);
    chain.parent = std::move(made.parent);
    return {true, made.planar};
}

/// Number of the System's particle that follows those of the drafts.
std::int64_t next_particle(std::vector<Draft> const& drafts) {
    return drafts.empty() ? 0
                          : drafts.back().particle +
                                static_cast<std::int64_t>(drafts.back().chain.bead_count());
}

/// Throws InputError unless the number of copies can follow from the concentration `at`.
void check_concentration(Node const& at, ChainRequest const& request) {
    read_concentration(at);
    if (request.fields.find("count"))
        fail(at, "the chain has both `count` and `concentration`", "keep one of them");
    if (request.scene.si) fail(at, "a concentration in SI units", "write `units: md`, or `count`");
    if (request.system)
        fail(at, "a concentration beside a System, which has a number of chains of its own",
             "give `count`");
    if (!request.scene.box)
        fail(at, "a concentration without a periodic box whose edges are given",
             "add `box: {periodic: [30, 30, 30]}`, or give `count`");
}

/// Tells the forces the charged ends of a chain that differ from those of the whole scene. They are
/// known as soon as the first copy is made.
void say_ends(ChainRequest const& request, std::string const& name) {
    OpenMmSpec* const openmm =
        request.scene.forces.openmm ? &*request.scene.forces.openmm : nullptr;
    bool const differ = request.fields.find("charge_termini") || request.is_cut() ||
                        request.protein_ends != calvados2::ChargedTermini{};
    if (!openmm || openmm->builder.empty()) return;
    bool const complex = request.part != nullptr && !request.part->members.empty();
    if (differ || complex)
        openmm->map.push_back({name, as_numbers(complex ? calvados2::ChargedTermini{false, false}
                                                        : request.termini())});
    for (calvados2::InnerTerminus const& end : request.inner_termini())
        openmm->map.push_back({name, as_map_entry(end)});
}

/// Reads one entry and makes its copies.
class ChainReader {
  public:
    /// Reads what all copies share: base, tip, count and generator.
    ChainReader(Node const& entry, std::size_t index, Scene& scene, ChainContext const& context)
        : request_{chain_fields(entry), entry, index, scene},
          source_(source_of(request_.fields)),
          warm_(context.warm) {
        request_.base = base_of(request_.fields, source_);
        request_.system = context.system;
        request_.from_frame = context.from_frame;
        tip_ = read_tip(request_.fields);
        if (Node const* const count = request_.fields.find("count")) count_ = whole(*count, 1);
        concentration_ = request_.fields.find("concentration");
        if (concentration_) check_concentration(*concentration_, request_);
        if (source_.key == "generator") generator_.emplace(request_, source_);
    }

    /// Makes all chains of the entry and appends them: the copies, or the chains of a structure.
    void append_to(std::vector<Draft>& drafts) {
        std::string const name = request_.name();
        if (printable(name) != name)
            fail(*request_.fields.find("name"),
                 "the name has control characters or bytes that are not UTF-8",
                 "give printable UTF-8");
        if (source_.key != "pdb") return append_copies(name, drafts);
        check_residue_keys(request_);
        request_.particle = particle_of(count_ == 1 ? name : name + "-1", next_particle(drafts));
        std::vector<StructurePart> const parts = read_structure(request_, source_);
        if (Node const* const crosslinks = request_.fields.find("crosslinks");
            crosslinks && parts.size() > 1)
            fail(*crosslinks, fmt::format("cross-links of {} chains of a structure", parts.size()),
                 "name one of them by `chain`, in an entry of its own");
        for (StructurePart const& part : parts) {
            request_.part = &part;
            append_copies(part.name, drafts);
        }
    }

  private:
    /// Makes all copies and appends them. Copies that do not differ are copied from the first, not
    /// read again.
    void append_copies(std::string const& name, std::vector<Draft>& drafts) {
        // The memory of generated chains is checked before they are made, that of others after the
        // first copy.
        double const before = drafts.empty() ? 0 : drafts.back().bytes;
        if (generator_) with_copies(before, generator_->size(), generator_->is_beads());
        std::int64_t const next = next_particle(drafts);
        if (concentration_) {
            prepare(name, next);
            Region const region = region_of(request_.node, request_.scene.box);
            count_ = copies_for(*concentration_, make(0), region, request_.scene);
        }
        prepare(count_ == 1 ? name : name + "-1", next);
        std::int64_t const first_particle = request_.particle;
        ChainSpec first = make(0);
        say_ends(request_, count_ == 1 ? name : name + "-1");
        auto const beads = static_cast<std::int64_t>(first.bead_count());
        double const bytes =
            with_copies(before, static_cast<std::int64_t>(first.size()), first.is_beads());
        bool const free_to_move = movable(first);
        Regrowth const shape = regrown(first);
        std::size_t const wanted = drafts.size() + static_cast<std::size_t>(count_);
        // The capacity grows by a factor, so that many entries do not copy the drafts each time.
        if (wanted > drafts.capacity()) drafts.reserve(std::max(wanted, 2 * drafts.capacity()));
        std::size_t const at = drafts.size();
        first.name = count_ == 1 ? name : name + "-1";
        drafts.push_back({std::move(first), &request_.node, free_to_move, shape, first_particle});
        if (is_rna(request_)) drafts.back().excluded = excluded_of_nucleotides;
        drafts.back().open_crosslinks = open_crosslinks_;
        for (std::int64_t copy = 1; copy < count_; ++copy) {
            std::string const copy_name = fmt::format("{}-{}", name, copy + 1);
            prepare(copy_name, next + copy * beads);
            say_ends(request_, copy_name);
            bool const differs =
                is_random() ||
                (request_.system && !request_.system->alike(first_particle, request_.particle,
                                                            beads, drafts[at].chain.parent));
            drafts.push_back({differs ? make(copy) : drafts[at].chain, &request_.node, free_to_move,
                              shape, request_.particle});
            drafts.back().excluded = drafts[at].excluded;
            drafts.back().open_crosslinks = open_crosslinks_;
            drafts.back().chain.name = copy_name;
        }
        drafts.back().bytes = bytes;
    }

    /// The System's first particle of the chain of that name; `next` without a System.
    std::int64_t particle_of(std::string const& name, std::int64_t next) const {
        return request_.system ? request_.system->first_particle(name, next) : next;
    }
    /// Sets the next chain's first particle in the System.
    void prepare(std::string const& name, std::int64_t next) {
        request_.particle = particle_of(name, next);
    }

    /// Makes one copy with its tip and the kind of its start velocities.
    ChainSpec make(std::int64_t copy) {
        ChainSpec chain;
        chain.base = request_.base;
        auto [velocities, planar] = read_source(copy, chain);
        if (planar == nullptr) planar = tip_.planar;
        if (source_.key == "bodies" && source_.kind == Node::Kind::list)
            terms::read_bodies(source_, request_.scene.forces, chain);
        // No bead of a branched chain is known to be the end of a protein.
        if (chain.is_branched()) request_.protein_ends = {false, false};
        refuse_ring_of_generated(chain, tip_, request_, source_);
        join_tip(chain, tip_, request_);
        if (Node const* const loops = request_.fields.find("loops"))
            close_loops(chain, *loops, request_.scene);
        open_crosslinks_ = cross_link(chain, request_, source_, copy > 0);
        note_joined_ends(chain, request_);
        if (planar) refuse_unparallel(chain, source_, *planar);
        set_velocities(chain, velocities);
        note_lost_rates(chain, request_);
        return chain;
    }
    /// Reads or generates the bodies of one copy.
    FromSource read_source(std::int64_t copy, ChainSpec& chain) {
        if (generator_) {
            generator_->make(chain, copy);
            return {generator_->gives_velocities()};
        }
        if (source_.key == "bodies") return written_bodies(request_, source_, chain);
        if (source_.key != "pdb" && is_rna(request_))
            read_nucleotides(request_, copy, chain);
        else
            residues_of_sequence(request_, copy, chain);
        return {false};
    }

    /// Sets the kind of start velocities and clears the given ones if they are not used. `given` is
    /// true if the source has velocities.
    void set_velocities(ChainSpec& chain, bool given) const {
        chain.velocities = given   ? StartVelocities::given
                           : warm_ ? StartVelocities::thermal
                                   : StartVelocities::zero;
        if (Node const* const velocities = request_.fields.find("velocities"))
            chain.velocities = choice<StartVelocities>(
                *velocities,
                {{"thermal", StartVelocities::thermal}, {"zero", StartVelocities::zero}});
        if (chain.velocities == StartVelocities::given) return;
        std::fill(chain.beads.velocity.begin(), chain.beads.velocity.end(), Vec3::zero());
        std::fill(chain.bodies.qd.begin(), chain.bodies.qd.end(), Vec3::zero());
        chain.bodies.free_base.velocity = Vec3::zero();
        std::fill(chain.linked.velocity.begin(), chain.linked.velocity.end(), Vec3::zero());
        std::fill(chain.linked.omega.begin(), chain.linked.omega.end(), Vec3::zero());
    }

    /// True if copies differ from each other.
    bool is_random() const {
        Node const* const conformation = request_.fields.find("conformation");
        return (generator_ && generator_->is_random()) ||
               (conformation && conformation->text == "self_avoiding");
    }
    /// True if the scene gives no place for the chain: several copies, or a free chain without
    /// positions.
    bool movable(ChainSpec const& chain) const {
        if (count_ > 1) return true;
        return is_free(chain) && source_.key != "bodies" && !is_given(request_, source_);
    }
    /// True for a chain of beads that nothing attaches to the ground.
    bool is_free(ChainSpec const& chain) const {
        return chain.is_beads() && chain.base == Base::free && tip_.kind == Tip::free;
    }
    /// Permission to regrow the chain, see Regrowth.
    Regrowth regrown(ChainSpec const& chain) const {
        if (!is_free(chain) || chain.is_cross_linked() ||
            (source_.key != "sequence" && source_.key != "fasta"))
            return Regrowth::no;
        Node const* const conformation = request_.fields.find("conformation");
        bool const any_shape = conformation ? conformation->text == "self_avoiding"
                                            : count_ > 1 && !is_given(request_, source_);
        return any_shape ? Regrowth::yes : Regrowth::if_asked;
    }
    /// Estimates the memory, bytes, of all chains up to this entry's. Throws InputError before
    /// chains are made that cannot fit.
    double with_copies(double before, std::int64_t size, bool beads) const {
        double const bytes =
            before + ((beads ? 150.0 : 700.0) * static_cast<double>(size) + 3000.0) *
                         static_cast<double>(count_);
        auto const present = static_cast<double>(memory_limit());
        if (bytes > present)
            fail(request_.node,
                 fmt::format("the chain{} about {:.3g} GB of memory, and only {}",
                             before > 0 ? "s up to this one need" : " needs", bytes * 1e-9,
                             available_memory()),
                 "make fewer bodies or copies");
        return bytes;
    }

    /// Entry with its context; its members change from copy to copy.
    ChainRequest request_;
    Node const& source_;
    /// True if chains without velocities start thermal.
    bool warm_;
    /// Tip of all copies.
    ReadTip tip_;
    /// Draft::open_crosslinks of the copy made last.
    std::vector<bool> open_crosslinks_;
    /// Number of copies.
    std::int64_t count_ = 1;
    /// The concentration that decides the number of copies, or nullptr.
    Node const* concentration_ = nullptr;
    /// Generator of the chain, if any. It refers to request_; a reader therefore must not be moved.
    std::optional<GeneratorEntry> generator_;
};

}  // namespace

void read_chain(Node const& entry, std::size_t index, Scene& scene, ChainContext const& context,
                std::vector<Draft>& drafts) {
    ChainReader(entry, index, scene, context).append_to(drafts);
}

}  // namespace catena::scene
