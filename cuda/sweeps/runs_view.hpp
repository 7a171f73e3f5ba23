// List of a tree's runs for GPU threads. Most runs follow a pattern and need no access to memory,
// whose latency is high.
#pragma once

#include <vector>

#include "tree/tree.hpp"

namespace catena::cuda {

/// Returns run i of a rank's first chain, if it is not the last run of that chain.
CATENA_HD dca::Run inner_run(std::int64_t i) {
    return {i * dca::longest_run, dca::longest_run, i, (i + 1) * dca::longest_run};
}

/// View of a list of runs. The first `inner` runs equal inner_run() and are not read from memory.
struct RunsView {
    dca::Run const* list = nullptr;
    std::int64_t count = 0, inner = 0;
    explicit CATENA_HD operator bool() const { return list != nullptr; }
    CATENA_HD dca::Run operator[](std::int64_t i) const {
        return i < inner ? inner_run(i) : list[i];
    }
};

/// Returns the view of `runs`; `list` is the address of a copy of them.
inline RunsView view_of(std::vector<dca::Run> const& runs, dca::Run const* list) {
    auto const is_inner = [](dca::Run const& run, dca::Run const& i) {
        return run.body == i.body && run.count == i.count && run.slot == i.slot &&
               run.next == i.next;
    };
    RunsView view{list, std::ssize(runs)};
    while (view.inner < view.count &&
           is_inner(runs[static_cast<std::size_t>(view.inner)], inner_run(view.inner)))
        ++view.inner;
    return view;
}

}  // namespace catena::cuda
