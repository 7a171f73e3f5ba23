// Distribution of chains to teams of threads (team_tree.hpp).
#include "dca/team_tree.hpp"

#include <algorithm>
#include <bit>

namespace catena::dca {

TeamPlan plan_teams(std::vector<Piece> const& pieces, std::int64_t runs) {
    auto const runs_of = [](Piece const& piece) {
        return (piece.count + longest_run - 1) / longest_run;
    };
    // Index of the first piece of every team, followed by the number of pieces.
    std::vector<std::size_t> first{0};
    std::int64_t in_team = 0, most = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        std::int64_t const own = runs_of(pieces[i]);
        if (in_team > 0 && in_team + own > runs) {
            first.push_back(i);
            in_team = 0;
        }
        in_team += own;
        most = std::max(most, in_team);
    }
    if (!pieces.empty()) first.push_back(pieces.size());

    TeamPlan plan;
    // Threads per team: enough for the team with most runs, rounded up to whole warps.
    plan.threads = static_cast<int>((most * parts_of_run + 31) / 32 * 32);
    plan.place.resize((first.size() - 1) * static_cast<std::size_t>(plan.threads));
    for (std::size_t team = 0; team + 1 < first.size(); ++team) {
        std::size_t thread = team * static_cast<std::size_t>(plan.threads);
        std::int32_t levels = 0;
        for (std::size_t i = first[team]; i < first[team + 1]; ++i) {
            Piece const& piece = pieces[i];
            auto const of_chain = static_cast<std::int32_t>(runs_of(piece));
            levels = std::max<std::int32_t>(
                levels, std::bit_width(static_cast<std::uint32_t>(of_chain - 1)));
            for (std::int32_t run = 0; run < of_chain; ++run) {
                std::int64_t const begin = run * longest_run,
                                   bodies = std::min(longest_run, piece.count - begin);
                auto const parts =
                    static_cast<std::int32_t>((bodies + part_length - 1) / part_length);
                for (std::int32_t part = 0; part < parts_of_run; ++part, ++thread) {
                    auto const left = static_cast<std::int32_t>(bodies) - part * part_length;
                    if (left > 0)
                        plan.place[thread] = {piece.local + begin + part * part_length,
                                              std::min(left, part_length),
                                              parts,
                                              run,
                                              of_chain,
                                              static_cast<std::int32_t>(i)};
                }
            }
        }
        plan.levels.push_back(levels);
    }
    return plan;
}

}  // namespace catena::dca
