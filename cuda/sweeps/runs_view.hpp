// A tree's runs as a GPU's threads ask for them: its memory is far, and most of them are known
// without it.
#pragma once

#include <vector>

#include "tree/tree.hpp"

namespace catena::cuda {

/// Run i of a rank's first chain, if it is not its last one.
CATENA_HD dca::Run inner_run(std::int64_t i) {
    return {i * dca::longest_run, dca::longest_run, i, (i + 1) * dca::longest_run};
}

/// The first `inner` are as inner_run() says, and not looked up.
struct RunsView {
    dca::Run const* list = nullptr;
    std::int64_t count = 0, inner = 0;
    explicit CATENA_HD operator bool() const { return list != nullptr; }
    CATENA_HD dca::Run operator[](std::int64_t i) const {
        return i < inner ? inner_run(i) : list[i];
    }
};

/// Of these runs, which `list` has somewhere.
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
