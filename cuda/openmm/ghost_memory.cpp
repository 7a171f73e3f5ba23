// Implements the copies between messages, inboxes and OpenMM's arrays.
#include "cuda/openmm/ghost_memory.hpp"

namespace catena::cuda {

void ShownMessages::list(std::vector<Vec3> const& x, cudaStream_t stream) {
    ShownTable const table = shown_table(lists().sent, x.size());
    upload(first_.of(table.first.size()), table.first.data(), table.first.size(), stream);
    upload(place_.of(table.place.size()), table.place.data(), table.place.size(), stream);
    if (lists().farthest) upload(from_.of(3 * x.size()), x.front().data, 3 * x.size(), stream);
    check(cudaStreamSynchronize(stream), "receive lists");
    shown_.first = (*first_).data();
    shown_.place = (*place_).data();
    shown_.shown = show_.of(3 * lists().sent.size()).data();
    shown_.listed = lists().farthest ? (*from_).data() : nullptr;
    double const farthest = lists().farthest.value_or(0);
    shown_.farthest_squared = farthest * farthest;
    shown_.far = lists().farthest ? far_ : nullptr;
    shown_.trouble = trouble_;
}

void ShownMessages::gather(std::span<DeviceBeads* const> beads, Event& written) const {
    std::int64_t next = 0;
    for (DeviceBeads* group : beads) {
        group->show(shown_.from(next));
        written.record(stream_of(*group));
        written.hold(stream_of(*beads.back()));
        next += group->count();
    }
}

void ShownMessages::to_host(cudaStream_t stream) const {
    if (std::span<Vec3> const to = out(); !to.empty())
        check(cudaMemcpyAsync(to.data(), shown_.shown, to.size_bytes(), cudaMemcpyDeviceToHost,
                              stream),
              "show its beads");
}

void ArrivedGhosts::look_into(GhostInboxes const& inboxes, cudaStream_t stream) {
    std::span<Vec3> const to = in();
    if (to.empty()) return;
    check(cudaMemcpyAsync(to.data(), inboxes.arrived<double>(), to.size_bytes(),
                          cudaMemcpyDeviceToHost, stream),
          "receive ghosts");
    check(cudaStreamSynchronize(stream), "receive ghosts");
}

void ArrivedGhosts::place(std::vector<DeviceBead> const& beads, DeviceParticles const& particles,
                          cudaStream_t stream) {
    std::size_t const all = beads.size(), ghosts = all - lists().idle.size();
    upload(bead_.of(all), beads.data(), all, stream);
    arrived_.of(3 * all);
    if (all > ghosts) {
        check(cudaMemcpyAsync((*arrived_).data() + 3 * ghosts, lists().aside.data(),
                              (all - ghosts) * sizeof(Vec3), cudaMemcpyHostToDevice, stream),
              "receive lists");
        cuda::put(static_cast<std::int64_t>(all - ghosts), from(ghosts, particles), stream);
    }
    check(cudaStreamSynchronize(stream), "receive lists");
}

void ArrivedGhosts::put(GhostInboxes const* inboxes, DeviceParticles const& particles,
                        cudaStream_t stream) const {
    std::span<Vec3> const ghosts = in();
    if (ghosts.empty()) return;
    ArrivedBeads arrived = from(0, particles);
    if (inboxes)
        arrived.position = inboxes->arrived<double>();
    else
        check(cudaMemcpyAsync((*arrived_).data(), ghosts.data(), ghosts.size_bytes(),
                              cudaMemcpyHostToDevice, stream),
              "receive ghosts");
    cuda::put(static_cast<std::int64_t>(ghosts.size()), arrived, stream);
}

ArrivedBeads ArrivedGhosts::from(std::size_t first, DeviceParticles const& particles) const {
    ArrivedBeads arrived{particles, (*arrived_).data() + 3 * first};
    arrived.particles.bead = (*bead_).data() + first;
    // reported by the ranks that own them
    arrived.particles.trouble = trouble_;
    arrived.particles.far = nullptr;  // checked by these ranks, too
    return arrived;
}

}  // namespace catena::cuda
