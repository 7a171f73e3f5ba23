#include "scene/carried_beads.hpp"

#include "scene/fields.hpp"

namespace catena::scene {

void CarriedList::add(Node const* beads, Vec3 const& origin) {
    if (beads_.offset.empty()) beads_.offset.push_back(0);
    if (beads) {
        for (Node const& item : list(*beads).items) {
            Fields const bead(item, {"residue", "position", "mass"});
            beads_.position.push_back(vector3(bead.need("position", "position: [0, 0, 0]")) - origin);
            Node const* const mass = bead.find("mass");
            beads_.mass.push_back(mass ? positive(*mass) : 1);
            Node const* const residue = bead.find("residue");
            beads_.residue.push_back(residue ? text(*residue) : "UNK");
        }
    }
    beads_.offset.push_back(static_cast<std::int64_t>(beads_.size()));
}

void CarriedList::add(Vec3 const& position, double mass, std::string const& residue) {
    if (beads_.offset.empty()) beads_.offset.push_back(0);
    beads_.position.push_back(position);
    beads_.mass.push_back(mass);
    beads_.residue.push_back(residue);
    beads_.offset.push_back(static_cast<std::int64_t>(beads_.size()));
}

CarriedBeads CarriedList::take() { return beads_.size() > 0 ? std::move(beads_) : CarriedBeads{}; }

}  // namespace catena::scene
