// DCD trajectories: their head, the first frame and the last one.
#include "frames/dcd_file.hpp"

#include <cmath>

#include "tests/fuzz/target.hpp"

namespace {

void read_frame(catena::DcdFile const& file, std::size_t frame) {
    catena::Snapshot const found = file.read(frame);
    catena::fuzz::require(found.position.size() == file.sites());
    for (catena::Vec3 const& x : found.position)
        for (double const coordinate : x.data) catena::fuzz::require(std::isfinite(coordinate));
    if (!found.box) return;
    for (double const edge : found.box->data)
        catena::fuzz::require(edge > 0 && std::isfinite(edge));
}

}  // namespace

void catena::fuzz::read(std::string_view bytes) {
    MemoryFile const memory(bytes);
    DcdFile const file(memory.path());
    require(file.sites() > 0 && file.sites() < bytes.size());
    require(file.frames() > 0 && file.frames() < bytes.size());
    read_frame(file, 0);
    read_frame(file, file.frames() - 1);
}
