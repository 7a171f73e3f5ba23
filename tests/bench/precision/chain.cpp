#include "tests/bench/precision/chain.hpp"

#include "error.hpp"

namespace catena::precision {
namespace {

template <int N>
void append(std::vector<double>& list, Vector<double, N> const& v) {
    list.insert(list.end(), v.data, v.data + N);
}
void append_axes(std::vector<double>& list, Vector<double, 6> const& kept) {
    Mat3 const axes = axes_of(kept);
    list.insert(list.end(), std::begin(axes.data), std::end(axes.data));
}
template <int D>
Vector<double, D> at(ConstView<D> const& view, std::int64_t k) {
    return view.origin ? view.load(k) : Vector<double, D>::zero();
}

/// Places of Loads' numbers and of Solution's (bodies.hpp) are told by how many come before.
bool in_double(Array which) { return which == body || which == given || which == solution; }

}  // namespace

std::optional<Joint> joint_of(ChainGroup const& group) {
    bool const one = group.partition.chains() == 1 && !group.has_tips() && group.drives.empty() &&
                     group.carried_beads() == 0;
    for (std::int64_t k = 1; k < group.size; ++k)
        if (!one || group.restricted(k) != group.directions) return std::nullopt;
    if (!one || group.linked || group.moving_meeting()) return std::nullopt;
    if (group.beads) return group.directions == 1 ? std::optional(Joint::link) : std::nullopt;
    return group.directions == 3   ? std::optional(Joint::spherical)
           : group.directions == 5 ? std::optional(Joint::revolute)
                                   : std::nullopt;
}

bool fits(ChainGroup const& group, int lanes) {
    std::int64_t const runs = group.size / (bodies_of_run * lanes);
    return runs > 0 && (runs & (runs - 1)) == 0 && runs * bodies_of_run * lanes == group.size;
}

ChainInArrays::ChainInArrays(ChainGroup const& group, Kernels const& kernels)
    : group_(group), kernels_(kernels) {
    work_.rows = group.size / kernels.lanes;
    work_.restricted_at_base = group.restricted(0);
    std::int64_t const runs = work_.rows / bodies_of_run;
    for (int a = 0; a < arrays; ++a) {
        bool const of_nodes = a == matrix || a == bias, of_stretches = a == top || a == top_offset;
        std::int64_t const records = of_nodes       ? 2 * runs
                                     : of_stretches ? kernels.lanes
                                     : a == force   ? runs + 1
                                                    : work_.rows + 1;
        memory_.emplace_back(
            records * kernels.record_bytes[a] / static_cast<std::int64_t>(sizeof(double)) + 1);
        work_.of[a] = memory_.back().data();
    }
}

int ChainInArrays::numbers(Array which) const {
    int const bytes = in_double(which) ? static_cast<int>(sizeof(double)) : kernels_.real_bytes;
    return kernels_.record_bytes[which] / (bytes * kernels_.lanes);
}

template <class Number>
void ChainInArrays::put(Array which, std::int64_t row, std::int64_t lane, double const* values) {
    int const count = numbers(which), lanes = kernels_.lanes;
    Number* const record = static_cast<Number*>(work_.of[which]) + row * count * lanes + lane;
    for (int i = 0; i < count; ++i) record[i * lanes] = static_cast<Number>(values[i]);
}

void ChainInArrays::put(Array which, std::int64_t k, std::vector<double> const& values) {
    auto const number = [&](std::int64_t row, std::int64_t lane) {
        if (in_double(which) || kernels_.real_bytes == sizeof(double))
            put<double>(which, row, lane, values.data());
        else
            put<float>(which, row, lane, values.data());
    };
    std::int64_t const row = k % work_.rows, lane = k / work_.rows;
    if (lane < kernels_.lanes) number(row, lane);
    if (row == 0 && lane > 0)
        number(work_.rows, lane - 1);  // behind the last body of the stretch before
}

void ChainInArrays::take(ConfigurationView const& c) {
    for (std::int64_t k = 0; k < group_.size; ++k) {
        double const mass = group_.mass.view().at(k, 0),
                     inverse_mass = group_.inverse_mass.view().at(k, 0);
        std::vector<double> reduced, whole;
        if (group_.beads) {
            append(reduced, c.direction.load(k));
            whole = reduced;
            reduced.push_back(inverse_mass);
            whole.push_back(mass);
        } else {
            reduced.push_back(inverse_mass);
            whole.push_back(mass);
            append(reduced, group_.inverse_inertia[k]);
            append(whole, group_.inertia[k]);
            for (std::vector<double>* list : {&reduced, &whole}) {
                append(*list, group_.r1[k]);
                append(*list, group_.r2[k]);
                append(*list, c.rotation.load(k));
                append_axes(*list, group_.axes1[k]);
                append_axes(*list, group_.axes2[k]);
            }
        }
        put(state, k, reduced);
        put(body, k, whole);
    }
    put(state, group_.size, std::vector<double>(static_cast<std::size_t>(numbers(state)), 0.0));
    put(body, group_.size, std::vector<double>(static_cast<std::size_t>(numbers(body)), 0.0));
}

void ChainInArrays::take(LoadsView const& l) {
    for (std::int64_t k = 0; k < group_.size; ++k) {
        std::vector<double> values;
        if (!group_.beads) append(values, at(l.torque, k));
        append(values, at(l.force, k));
        for (int i = 0; i < group_.directions; ++i)
            values.push_back(l.bias ? l.bias.at(k, i) : 0.0);
        if (!group_.beads) append(values, at(l.omega, k));
        put(loads, k, values);
        put(given, k, values);
    }
}

Vector<double, 6> ChainInArrays::get(std::int64_t k, int first, int count) const {
    std::int64_t const row = k % work_.rows, lane = k / work_.rows;
    double const* const record = static_cast<double const*>(work_.of[solution]) +
                                 row * numbers(solution) * kernels_.lanes + lane;
    auto v = Vector<double, 6>::zero();
    for (int i = 0; i < count; ++i) v[i] = record[(first + i) * kernels_.lanes];
    return v;
}

void ChainInArrays::give(AccelerationsView const& out) const {
    int const linear = group_.beads ? 0 : 3;
    for (std::int64_t k = 0; k < group_.size; ++k) {
        auto const x = get(k, 0, linear + 3), f = get(k, linear + 3, group_.directions);
        if (out.alpha.origin && !group_.beads) out.alpha.store(k, Vec3{{x[0], x[1], x[2]}});
        if (out.acceleration.origin)
            out.acceleration.store(k, Vec3{{x[linear], x[linear + 1], x[linear + 2]}});
        for (int i = 0; out.joint_force && i < group_.directions; ++i)
            out.joint_force.at(k, i) = f[i];
    }
    for (int i = 0; out.joint_force && i < group_.directions; ++i)
        out.joint_force.at(group_.size, i) = 0;
}

void ChainInArrays::evaluate(int refinements) const {
    assemble();
    solve();
    for (int i = 0; i < refinements; ++i) {
        find_defect();
        correct();
    }
}

double ChainInArrays::bytes(std::initializer_list<Array> once,
                            std::initializer_list<Array> twice) const {
    double sum = 0;
    for (Array const a : once) sum += kernels_.record_bytes[a];
    for (Array const a : twice) sum += 2 * kernels_.record_bytes[a];
    return sum / kernels_.lanes;
}
/// The matrix sweep reads states and writes joints; the bias sweep reads both up and down, loads
/// too, and offsets on the way back.
double ChainInArrays::bytes_of_evaluation() const {
    return bytes({state, joint, solution}, {state, joint, loads, offset});
}
double ChainInArrays::bytes_of_refinement() const {
    return bytes({body, given, solution, defect}, {state, joint, defect, offset, solution});
}

void StudiedSolver::assemble_matrices(ConfigurationView const& c) {
    if (!begun_) return usual_->assemble_matrices(c);
    chain_.take(c);
    if (!chain_.assemble())
        throw ComputationError("the matrix of a joint is not positive definite");
}

void StudiedSolver::solve(LoadsView const& loads_now, AccelerationsView const& out) {
    if (!begun_) return usual_->solve(loads_now, out);
    chain_.take(loads_now);
    chain_.solve();
    for (int i = 0; i < steps_; ++i) {
        chain_.find_defect();
        chain_.correct();
    }
    chain_.give(out);
}

}  // namespace catena::precision
