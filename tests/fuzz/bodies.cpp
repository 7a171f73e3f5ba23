// Chains of rigid bodies in HDF5 files.
#include "bodies/hdf5_bodies.hpp"
#include "error.hpp"
#include "tests/fuzz/own_fault.hpp"
#include "tests/fuzz/target.hpp"

/// For messages.
char const* catena::name_of(JointType) { return "-"; }

void catena::fuzz::read(std::string_view bytes) {
    own_fault() = false;
    NamedFile const file(bytes);
    try {
        BodyArrays const bodies =
            scene::read_hdf5_bodies(file.path(), bytes.size() % 2 == 0 ? Base::fixed : Base::free)
                .bodies;
        require(!bodies.mass.empty() && bodies.inertia.size() == bodies.mass.size() &&
                bodies.joint.size() == bodies.mass.size());
    } catch (InputError const&) {
        require(!own_fault());
        throw;
    }
}
