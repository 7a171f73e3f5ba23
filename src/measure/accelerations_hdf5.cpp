// Implements accelerations as HDF5.
#include <array>
#include <cstdio>

#include "io/hdf5_data.hpp"
#include "io/output_file.hpp"
#include "measure/accelerations_file.hpp"

namespace catena {
namespace {

using namespace hdf5;

std::string const writing = "write the accelerations";

/// Writes the solution to `draft`; `file` is the name in messages.
void write(std::string const& draft, std::string const& file, Solution const& s) {
    File handle(check(create_anew(draft, H5P_DEFAULT, H5P_DEFAULT), file, writing));
    Place const root{handle.get(), file, writing};
    put_text(root, "format", "catena accelerations");
    put_attribute(root, "version", std::int64_t{1});
    std::vector<std::int64_t> offsets;
    for (std::size_t b = 0; b < s.acceleration_offset.size(); ++b)
        offsets.insert(offsets.end(), {s.acceleration_offset[b], s.force_offset[b]});
    std::array<hsize_t, 2> const shape{s.acceleration_offset.size(), 2};
    Dataset accelerations = put_array(root, "accelerations", s.acceleration);
    Dataset forces = put_array(root, "joint_forces", s.joint_force);
    Dataset starts = put_array(root, "offsets", H5T_NATIVE_INT64, offsets.data(), shape);
    std::vector<std::int64_t> chains;
    std::vector<double> wrenches;
    for (TipForce const& tip : s.tip_force) {
        chains.push_back(tip.chain);
        wrenches.insert(wrenches.end(), tip.wrench.data, tip.wrench.data + 6);
    }
    std::array<hsize_t, 2> const of_tips{s.tip_force.size(), 6};
    Dataset tips = put_array(root, "tip_forces", H5T_NATIVE_DOUBLE, wrenches.data(), of_tips);
    Dataset tip_chains = put_array(root, "tip_chains", chains);
    if (!s.loop_force.empty()) {
        std::vector<double> of_loops;
        for (TipForce const& loop : s.loop_force)
            of_loops.insert(of_loops.end(), loop.wrench.data, loop.wrench.data + 6);
        std::array<hsize_t, 2> const loops_shape{s.loop_force.size(), 6};
        Dataset loops =
            put_array(root, "loop_forces", H5T_NATIVE_DOUBLE, of_loops.data(), loops_shape);
        check(loops.close(), file, writing);
    }
    if (!s.crosslink_tension.empty()) {
        Dataset tensions = put_array(root, "crosslink_tensions", s.crosslink_tension);
        check(tensions.close(), file, writing);
    }
    for (Dataset* const data : {&accelerations, &forces, &starts, &tips, &tip_chains})
        check(data->close(), file, writing);
    flush_to_disk(handle, file, writing);
    check(handle.close(), file, writing);
}

}  // namespace

void require_accelerations_hdf5(std::string const&) {}

void write_accelerations_hdf5(std::string const& file, Solution const& solution) {
    Quiet const quiet;
    std::string const draft = file + ".part";
    try {
        write(draft, file, solution);
        rename_file(draft, file);
    } catch (...) {
        std::remove(draft.c_str());
        throw;
    }
}

}  // namespace catena
