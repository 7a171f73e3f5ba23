// Implements the chains of `bench sampling --dense`: energies, contacts and densities.
#include "bench/dense_chains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "bench/generated.hpp"
#include "console/text.hpp"
#include "error.hpp"
#include "integrate/system_chains.hpp"
#include "math/concentration_units.hpp"
#include "neighbours/grid.hpp"
#include "reader/load_scene.hpp"
#include "start/start_relaxation.hpp"

namespace catena::command {
namespace {

/// Distances, nm, within which pairs of beads are counted: on the steep side of the repulsion, and
/// up to the end of the first shell of neighbours.
constexpr double steep_side = 0.5, first_shell = 0.8;
/// A box is long if its longest edge has at least this multiple of each other.
constexpr double long_multiple = 2;

/// Returns the scene in its box, relaxed if it asks for that.
Scene boxed_scene(BenchRequest const& request, Communicator const& communicator) {
    std::string const& file = request.sampling.scene;
    Scene scene = file.empty()
                      ? condensate_scene(request.sampling.copies * 140, overrides_of(request))
                      : load_scene(file, overrides_of(request));
    if (!scene.box)
        throw InputError("bench sampling --dense takes a scene with a periodic box", scene.file,
                         "add box: {periodic: [x, y, z]}, or leave out --dense");
    if (auto relaxed = relaxed_where_asked(scene, communicator, relaxation_says(request.quiet)))
        return std::move(relaxed->scene);
    return scene;
}

/// Points of a periodic box by the cell of a grid.
class SortedCells {
  public:
    SortedCells(Grid const& grid, std::vector<Vec3> const& positions)
        : grid_(grid), point_(positions.size()) {
        Cell const& count = grid.cells();
        first_.assign(static_cast<std::size_t>(count[0] * count[1] * count[2]) + 1, 0);
        std::vector<std::size_t> cell;
        for (Vec3 const& x : positions) cell.push_back(number_of(grid.cell(x)));
        for (std::size_t const c : cell) ++first_[c + 1];
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        std::vector<std::size_t> next = first_;
        for (std::size_t k = 0; k < cell.size(); ++k) point_[next[cell[k]]++] = k;
    }
    std::int64_t size() const { return std::ssize(first_) - 1; }
    std::span<std::size_t const> points(std::size_t cell) const {
        return std::span(point_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
    }
    /// Returns the cell and those around it, each once.
    std::vector<std::size_t> around(std::size_t cell) const {
        auto const c = static_cast<std::int64_t>(cell);
        std::int64_t const y = grid_.cells()[1], z = grid_.cells()[2];
        std::vector<std::size_t> near;
        near.reserve(27);
        grid_.around({c / (y * z), c / z % y, c % z},
                     [&](Cell const& each) { near.push_back(number_of(each)); });
        std::sort(near.begin(), near.end());
        near.erase(std::unique(near.begin(), near.end()), near.end());
        return near;
    }

  private:
    std::size_t number_of(Cell const& c) const {
        return static_cast<std::size_t>((c[0] * grid_.cells()[1] + c[1]) * grid_.cells()[2] + c[2]);
    }
    Grid const& grid_;
    /// First point of each cell, then their number; point indices cell by cell.
    std::vector<std::size_t> first_, point_;
};

}  // namespace

std::int64_t pairs_within(std::vector<Vec3> const& positions, double radius, Vec3 const& box,
                          Executor const& threads) {
    Grid const grid(radius, box);
    SortedCells const sorted(grid, positions);
    std::vector<std::int64_t> pairs(static_cast<std::size_t>(sorted.size()), 0);
    threads.for_ranges(sorted.size(), 1, [&](std::int64_t begin, std::int64_t end) {
        for (auto cell = static_cast<std::size_t>(begin); cell < static_cast<std::size_t>(end);
             ++cell) {
            if (sorted.points(cell).empty()) continue;
            for (std::size_t const other : sorted.around(cell))
                for (std::size_t const a : sorted.points(cell))
                    for (std::size_t const b : sorted.points(other))
                        pairs[cell] += a < b && grid.squared_distance(positions[a], positions[b]) <=
                                                    radius * radius;
        }
    });
    return std::accumulate(pairs.begin(), pairs.end(), std::int64_t{0});
}

std::optional<int> long_axis(Vec3 const& box) {
    int longest = 0;
    for (int i = 1; i < 3; ++i)
        if (box[i] > box[longest]) longest = i;
    for (int i = 0; i < 3; ++i)
        if (i != longest && box[longest] < long_multiple * box[i]) return std::nullopt;
    return longest;
}

double density_seen(std::vector<Vec3> const& positions, std::vector<double> const& mass,
                    Vec3 const& box, int axis) {
    double const edge = box[axis];
    auto const slices = static_cast<std::size_t>(std::max(1.0, std::round(edge)));
    std::vector<double> inside(slices, 0);
    for (std::size_t k = 0; k < positions.size(); ++k) {
        double const part = positions[k][axis] / edge;
        auto const slice =
            static_cast<std::size_t>((part - std::floor(part)) * static_cast<double>(slices));
        inside[std::min(slice, slices - 1)] += mass[k];
    }
    double const volume = box[0] * box[1] * box[2] / static_cast<double>(slices);
    double squares = 0, all = 0;
    for (double const each : inside) squares += each * each, all += each;
    return squares / (all * volume);
}

DenseChains::DenseChains(BenchRequest const& request, Communicator const& communicator,
                         Backend backend)
    : SampledChains(boxed_scene(request, communicator), communicator, backend),
      threads_(openmp_is_built() ? openmp_executor(choose_threads(model(), communicator))
                                 : serial_executor()) {}

std::string DenseChains::description() const {
    Vec3 const& box = *model().box;
    return fmt::format("{} ({} beads) in a periodic box of {:.4g} x {:.4g} x {:.4g} nm",
                       counted(chains(), "chain", "chains"), beads().size(), box[0], box[1],
                       box[2]);
}

std::vector<SystemValue> DenseChains::system_values(std::vector<Vec3> const& positions) {
    auto const beads_count = static_cast<double>(beads().size());
    std::vector<SystemValue> values;
    for (EnergyTerm const& term : evaluator().energies())
        values.push_back({term.name + " energy", "kJ/mol per bead", term.value / beads_count});
    Vec3 const& box = *model().box;
    for (double const radius : {steep_side, first_shell}) {
        std::int64_t pairs = pairs_within(positions, radius, box, *threads_);
        for (BeadSystem::Link const& link : beads().links)
            pairs -= norm(positions[static_cast<std::size_t>(link.outboard)] -
                          positions[static_cast<std::size_t>(link.inboard)]) <= radius;
        values.push_back({fmt::format("pairs within {} nm", radius), "per bead",
                          static_cast<double>(pairs) / beads_count});
    }
    if (std::optional<int> const axis = long_axis(box))
        values.push_back({"density seen", "mg/ml",
                          mg_per_ml * density_seen(positions, beads().mass, box, *axis)});
    return values;
}

double DenseChains::nearest(std::vector<Vec3> const& positions) const {
    for (Vec3 const& x : positions)
        if (!std::isfinite(norm(x))) return NAN;
    return INFINITY;
}

CopyDistances DenseChains::distances(double) const {
    Vec3 const& box = *model().box;
    return {.rounding = rounding_at(std::max({box[0], box[1], box[2]}))};
}

}  // namespace catena::command
