// Pair of a scan along chains and an action after it, for execution in one launch.
#pragma once

namespace catena::dca {

/// Runs `scan`, then action(item) for each of a space's `items`. All three must outlive this
/// object.
template <class Scan, class Items, class Action>
struct ScanThen {
    Scan const& scan;
    Items const& items;
    Action const& action;
};
template <class Scan, class Items, class Action>
ScanThen(Scan const&, Items const&, Action const&) -> ScanThen<Scan, Items, Action>;

}  // namespace catena::dca
