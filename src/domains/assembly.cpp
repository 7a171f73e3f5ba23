// Implements the assembly of serial chains. Each range of a body has a port at either side where
// more of its chain follows. Bodies and the strands between their ports form a graph; a serial
// chain is a path through it.
#include "domains/assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

namespace catena::scene {

namespace {

/// A range of residues that belongs to a body.
struct Range {
    std::size_t first, last, set;
};

/// Side of a range at which its chain continues.
struct Port {
    std::size_t chain = 0;
    /// Index of the range among those of its chain.
    std::size_t range = 0;
    /// True for the side of the last residue.
    bool back = false;
    bool operator==(Port const&) const = default;
};

/// Residues between a port and the next body or the end of the chain, in the order away from the
/// port.
struct Strand {
    std::vector<std::size_t> residues;
    /// Port of the next body; nothing at the end of the chain.
    std::optional<Port> next;
};

/// The first end of a path.
struct Start {
    /// 0 for an N-terminus, 1 for a side of a body without a port, 2 for a C-terminus; then the
    /// residue.
    std::pair<int, std::size_t> rank;
    std::size_t set;
    std::optional<Port> tail;
    bool operator<(Start const& other) const { return rank < other.rank; }
};

class Assembler {
  public:
    Assembler(std::vector<RigidSet> const& sets, ResidueNumbers const& numbers)
        : sets_(sets), numbers_(numbers), ranges_(numbers.number_of_chains()) {
        for (std::size_t s = 0; s < sets.size(); ++s)
            for (Domain const& each : sets[s].ranges)
                ranges_[numbers.chain_of(each.first)].push_back({each.first, each.last, s});
        for (auto& of_chain : ranges_)
            std::sort(of_chain.begin(), of_chain.end(),
                      [](Range const& a, Range const& b) { return a.first < b.first; });
        find_ports();
    }

    std::vector<Assembly> all() {
        refuse_loops();
        refuse_branches();
        std::vector<Assembly> made;
        for (std::vector<std::size_t> const& group : groups()) made.push_back(path_of(group));
        return made;
    }

  private:
    void find_ports() {
        ports_.resize(sets_.size());
        for (std::size_t c = 0; c < ranges_.size(); ++c) {
            auto const [begin, end] = numbers_.range_of(c);
            for (std::size_t r = 0; r < ranges_[c].size(); ++r) {
                Range const& range = ranges_[c][r];
                if (range.first > begin) ports_[range.set].push_back({c, r, false});
                if (range.last + 1 < end) ports_[range.set].push_back({c, r, true});
            }
        }
    }

    Range const& range_of(Port const& port) const { return ranges_[port.chain][port.range]; }
    /// The residue of the body at the port.
    std::size_t residue_at(Port const& port) const {
        return port.back ? range_of(port).last : range_of(port).first;
    }

    Strand strand(Port const& from) const {
        auto const [begin, end] = numbers_.range_of(from.chain);
        std::vector<Range> const& of_chain = ranges_[from.chain];
        Strand strand;
        if (from.back) {
            bool const more = from.range + 1 < of_chain.size();
            std::size_t const stop = more ? of_chain[from.range + 1].first : end;
            for (std::size_t k = range_of(from).last + 1; k < stop; ++k)
                strand.residues.push_back(k);
            if (more) strand.next = {from.chain, from.range + 1, false};
        } else {
            std::size_t const stop = from.range > 0 ? of_chain[from.range - 1].last + 1 : begin;
            for (std::size_t k = range_of(from).first; k-- > stop;) strand.residues.push_back(k);
            if (from.range > 0) strand.next = {from.chain, from.range - 1, true};
        }
        return strand;
    }

    std::string name_of(Strand const& strand) const {
        auto const [low, high] =
            std::minmax_element(strand.residues.begin(), strand.residues.end());
        return numbers_.span(*low, *high);
    }

    /// Throws InputError for flexible residues between two ranges of one body.
    void refuse_loops() const {
        for (std::vector<Range> const& of_chain : ranges_)
            for (std::size_t r = 1; r < of_chain.size(); ++r) {
                Range const &a = of_chain[r - 1], &b = of_chain[r];
                if (a.set != b.set) continue;
                auto const range = [&](std::size_t first, std::size_t last) {
                    return fmt::format(
                        "\"{}{}-{}\"",
                        numbers_.several_names() ? numbers_.chains[first][0] + ":" : "",
                        numbers_.label(first), numbers_.label(last));
                };
                fail(*sets_[a.set].at,
                     fmt::format("{} would be a flexible loop between two parts of one rigid body, "
                                 "which a serial chain cannot hold",
                                 numbers_.span(a.last + 1, b.first - 1)),
                     fmt::format("write {} to make the loop rigid, too (with `domains` or `pae`: "
                                 "`longest_loop: {}`), or make two bodies of the parts: rigid: "
                                 "[{}, {}]",
                                 range(a.first, b.last), b.first - a.last - 1,
                                 range(a.first, a.last), range(b.first, b.last)));
            }
    }

    /// Throws InputError for bodies with more than two ports, and for two that share a residue.
    void refuse_branches() const {
        for (std::size_t s = 0; s < sets_.size(); ++s) {
            std::vector<Port> const& ports = ports_[s];
            bool const same = ports.size() == 2 && residue_at(ports[0]) == residue_at(ports[1]);
            if (ports.size() <= 2 && !same) continue;
            if (same)
                fail(*sets_[s].at,
                     fmt::format("both flexible ends of the rigid body of {} leave from {}",
                                 sets_[s].name(),
                                 numbers_.span(residue_at(ports[0]), residue_at(ports[0]))),
                     "include a residue next to it");
            std::string list;
            for (Port const& port : ports) {
                Strand const one = strand(port);
                list += (list.empty() ? "" : ", ") +
                        (one.residues.empty() ? "the body behind " + numbers_.span(residue_at(port),
                                                                                   residue_at(port))
                                              : name_of(one));
            }
            fail(*sets_[s].at,
                 fmt::format("{} flexible parts would hang on the rigid body of {}, and a serial "
                             "chain has two: {}",
                             ports.size(), sets_[s].name(), list),
                 "include flexible ends in the body's ranges until two are left, or give each "
                 "chain bodies of its own");
        }
    }

    /// Groups of chains that share bodies, each ascending.
    std::vector<std::vector<std::size_t>> groups() const {
        std::vector<std::size_t> root(ranges_.size());
        std::iota(root.begin(), root.end(), std::size_t{0});
        auto const find = [&](std::size_t c) {
            while (root[c] != c) c = root[c];
            return c;
        };
        for (RigidSet const& set : sets_)
            for (Domain const& range : set.ranges) {
                std::size_t const a = find(numbers_.chain_of(set.ranges[0].first)),
                                  b = find(numbers_.chain_of(range.first));
                root[std::max(a, b)] = std::min(a, b);
            }
        std::vector<std::vector<std::size_t>> groups;
        std::vector<std::size_t> place(ranges_.size());
        for (std::size_t c = 0; c < ranges_.size(); ++c) {
            if (find(c) == c) {
                place[c] = groups.size();
                groups.emplace_back();
            }
            groups[place[find(c)]].push_back(c);
        }
        return groups;
    }

    /// The path's first end; nothing if all bodies have two ports that lead to bodies.
    std::optional<Start> start_of(std::vector<std::size_t> const& chains) const {
        std::optional<Start> best;
        auto const offer = [&](Start const& start) {
            if (!best || start < *best) best = start;
        };
        for (std::size_t const c : chains)
            for (Range const& range : ranges_[c]) {
                std::vector<Port> const& ports = ports_[range.set];
                for (Port const& port : ports)
                    if (!strand(port).next)
                        offer({{port.back ? 2 : 0, residue_at(port)}, range.set, port});
                if (ports.size() < 2) offer({{1, sets_[range.set].ranges[0].first}, range.set, {}});
            }
        return best;
    }

    Assembly path_of(std::vector<std::size_t> const& chains) const {
        Assembly made;
        made.chains = chains;
        if (chains.size() == 1 && ranges_[chains[0]].empty()) {
            auto const [begin, end] = numbers_.range_of(chains[0]);
            made.residues.resize(end - begin);
            std::iota(made.residues.begin(), made.residues.end(), begin);
            return made;
        }
        std::optional<Start> const start = start_of(chains);
        std::size_t all = 0;
        for (std::size_t const c : chains) all += numbers_.range_of(c)[1] - numbers_.range_of(c)[0];
        if (start) walk(*start, made);
        // A path that misses residues left a circle of bodies behind.
        if (made.residues.size() != all) refuse_circle(chains);
        return made;
    }

    void walk(Start const& start, Assembly& made) const {
        if (start.tail) {
            std::vector<std::size_t> const tail = strand(*start.tail).residues;
            made.residues.insert(made.residues.end(), tail.rbegin(), tail.rend());
        }
        std::optional<Port> in = start.tail;
        for (std::size_t set = start.set;;) {
            std::optional<Port> out;
            for (Port const& port : ports_[set])
                if (!in || port != *in) out = port;
            add_body(set, in, out, made);
            if (!out) return;
            Strand const next = strand(*out);
            made.residues.insert(made.residues.end(), next.residues.begin(), next.residues.end());
            if (!next.next) return;
            in = next.next;
            set = range_of(*in).set;
        }
    }

    /// Appends a body's residues: first the one of the inboard link, last that of the outboard one.
    void add_body(std::size_t set, std::optional<Port> const& in, std::optional<Port> const& out,
                  Assembly& made) const {
        std::vector<std::size_t> inside;
        for (Domain const& range : sets_[set].ranges)
            for (std::size_t k = range.first; k <= range.last; ++k) inside.push_back(k);
        auto const move = [&](std::size_t residue, bool to_front) {
            auto const at = std::find(inside.begin(), inside.end(), residue);
            to_front ? std::rotate(inside.begin(), at, at + 1)
                     : std::rotate(at, at + 1, inside.end());
        };
        if (in) move(residue_at(*in), true);
        if (out) move(residue_at(*out), false);
        made.rigid.push_back(
            {made.residues.size(), made.residues.size() + inside.size() - 1, sets_[set].name()});
        made.residues.insert(made.residues.end(), inside.begin(), inside.end());
    }

    [[noreturn]] void refuse_circle(std::vector<std::size_t> const& chains) const {
        for (std::size_t const c : chains)
            for (Range const& range : ranges_[c])
                if (sets_[range.set].ranges.size() > 1)
                    fail(
                        *sets_[range.set].at,
                        fmt::format("two paths along the chains join the rigid body of {} with "
                                    "others: a closed loop, which a serial chain cannot hold",
                                    sets_[range.set].name()),
                        "give each chain bodies of its own, or join the bodies of the loop in one");
        throw std::logic_error("a path of bodies misses residues");
    }

    std::vector<RigidSet> const& sets_;
    ResidueNumbers const& numbers_;
    /// Ranges of each chain, ascending.
    std::vector<std::vector<Range>> ranges_;
    /// Ports of each body.
    std::vector<std::vector<Port>> ports_;
};

}  // namespace

std::string RigidSet::name() const {
    std::string text;
    for (Domain const& range : ranges) text += (text.empty() ? "" : " and ") + range.name;
    return text;
}

std::vector<Assembly> assemble(std::vector<RigidSet> const& sets, ResidueNumbers const& numbers) {
    return Assembler(sets, numbers).all();
}

}  // namespace catena::scene
