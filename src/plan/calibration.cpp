// Implements the calibration: curves by name, and their JSON form.
#include "plan/calibration.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>

namespace catena::plan {
namespace {

using nlohmann::json;

template <std::size_t N>
/// Converts curves to JSON: name to a list of [bodies, [seconds, ...]].
json json_of(std::map<std::string, Curve<N>> const& curves) {
    json all = json::object();
    for (auto const& [name, curve] : curves)
        for (auto const& [bodies, seconds] : curve.points()) all[name].push_back({bodies, seconds});
    return all;
}

template <std::size_t N>
/// Adds the curves of a JSON object to `to`. Throws std::runtime_error for impossible times.
void read_curves(json const& from, std::map<std::string, Curve<N>>& to) {
    for (auto const& [name, points] : from.items())
        for (json const& point : points) {
            auto const bodies = point.at(0).get<std::int64_t>();
            auto const seconds = point.at(1).get<std::array<double, N>>();
            bool good = bodies > 0 && point.at(1).size() == N;
            // A NaN fails both comparisons.
            for (double const s : seconds) good = good && s >= 0 && s < 1e6;
            if (!good) throw std::runtime_error("no times of " + name);
            to[name].add(bodies, seconds);
        }
}

template <std::size_t N>
/// Returns the number of points of all curves.
std::size_t count(std::map<std::string, Curve<N>> const& curves) {
    std::size_t sum = 0;
    for (auto const& [name, curve] : curves) sum += curve.points().size();
    return sum;
}

/// Returns the key of a curve in the calibration, e.g. "link | openmp, 8 threads".
std::string name_of(Family const& family, Arrangement const& arrangement) {
    return family.name() + " | " + arrangement.name();
}

}  // namespace

PhaseCurve& Calibration::of(Family const& family, Arrangement const& arrangement) {
    return phases_[name_of(family, arrangement)];
}

DriftCurve& Calibration::of_drifts(Family const& family, Arrangement const& arrangement) {
    return drifts_[name_of(family, arrangement)];
}

LevelCurve& Calibration::of(Family const& family, Place place, int threads) {
    return levels_[family.name() + " | " +
                   (place == Place::gpu ? "GPU" : "host, " + std::to_string(threads))];
}

std::size_t Calibration::points() const { return count(phases_) + count(drifts_) + count(levels_); }

json Calibration::json() const {
    return {
        {"phases", json_of(phases_)}, {"drifts", json_of(drifts_)}, {"levels", json_of(levels_)}};
}

void Calibration::read(nlohmann::json const& from) {
    read_curves(from.at("phases"), phases_);
    read_curves(from.at("drifts"), drifts_);
    read_curves(from.at("levels"), levels_);
}

}  // namespace catena::plan
