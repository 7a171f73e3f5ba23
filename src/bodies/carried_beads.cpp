// Implements the list of carried beads.
#include "bodies/carried_beads.hpp"

#include "keys/maps.hpp"
#include "scene/fields.hpp"
#include "structure/calvados2.hpp"

namespace catena::scene {

void CarriedList::append(Vec3 const& position, double mass, std::string const& residue) {
    beads_.position.push_back(position);
    beads_.mass.push_back(mass);
    beads_.residue.push_back(residue);
}

void CarriedList::close() {
    if (beads_.offset.empty()) beads_.offset.push_back(0);
    beads_.offset.push_back(static_cast<std::int64_t>(beads_.size()));
}

void CarriedList::add(Node const* beads, Vec3 const& origin) {
    if (beads) {
        for (Node const& item : list(*beads).items) {
            Fields const bead(item, keys::carried_bead);
            Node const* const mass = bead.find("mass");
            Node const* const residue = bead.find("residue");
            std::string const name = residue ? text(*residue) : "UNK";
            // The mass defaults to that of a known residue.
            ResidueType const* const known = find_calvados2(name);
            append(vector3(bead.need("position", "position: [0, 0, 0]")) - origin,
                   mass    ? positive(*mass)
                   : known ? known->mass
                           : 1,
                   name);
        }
    }
    close();
}

CarriedBeads CarriedList::take() { return beads_.size() > 0 ? std::move(beads_) : CarriedBeads{}; }

}  // namespace catena::scene
