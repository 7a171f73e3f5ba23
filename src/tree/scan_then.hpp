// A scan along chains and what comes after it, where one launch may do both.
#pragma once

namespace catena::dca {

/// And then action(item) for each of a space's list. All must outlive it.
template <class Scan, class Items, class Action>
struct ScanThen {
    Scan const& scan;
    Items const& items;
    Action const& action;
};
template <class Scan, class Items, class Action>
ScanThen(Scan const&, Items const&, Action const&) -> ScanThen<Scan, Items, Action>;

}  // namespace catena::dca
