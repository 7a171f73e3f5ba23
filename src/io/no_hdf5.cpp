// Replaces the HDF5 files in a build without HDF5. Topology, tables, texts and reports are still
// written.
#include "error.hpp"
#include "io/output.hpp"

namespace catena {
namespace {

InputError without(std::string const& use) {
    return built_without("HDF5", use, "install HDF5 (libhdf5-dev) and build again");
}

}  // namespace

std::unique_ptr<TrajectoryWriter> make_trajectory(std::string const& file, Topology const&, bool,
                                                  bool, std::optional<Continuation> const&) {
    throw without("trajectory " + file);
}

TrajectoryOfRanks make_trajectory(Communicator const&, std::string const& file, Topology const&,
                                  bool, bool, std::optional<Continuation> const&) {
    throw without("trajectory " + file);
}

struct CheckpointWriter::Draft {};
CheckpointWriter::CheckpointWriter(Communicator const&, std::string const& file, Checkpoint const&,
                                   std::map<std::string, std::int64_t> const&) {
    throw without("checkpoint " + file);
}
CheckpointWriter::~CheckpointWriter() = default;
ParallelIoMode const& CheckpointWriter::way() const {
    static ParallelIoMode const none;
    return none;
}
void CheckpointWriter::put(std::string const&, std::span<ArrayPart const>) {}
void CheckpointWriter::finish() {}

void write_checkpoint(std::string const& file, Checkpoint const&) {
    throw without("checkpoint " + file);
}

Checkpoint read_checkpoint(std::string const& file) { throw without("checkpoint " + file); }

void start_hdf5() {}

std::string hdf5_version() { return "none"; }

}  // namespace catena
