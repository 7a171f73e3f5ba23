// Writer of one rank, by serial HDF5.
#include "io/writers.hpp"

namespace catena::hdf5 {
namespace {

class OneWriter final : public Writers {
  public:
    bool are_several() const override { return false; }
    bool is_first() const override { return true; }
    void prepare(Properties const&, std::string const&, std::string const&) const override {}
    void watch(File const&, std::string const&, std::string const&) override {}
    hid_t transfer() const override { return H5P_DEFAULT; }
    std::int64_t sum(std::int64_t value) const override { return value; }
    void make_room(File const& handle, hsize_t more, std::string const& file,
                   std::string const& doing) override {
        hdf5::make_room(handle, more, file, doing);
    }
    void flush_to_disk(File const& handle, std::string const& file,
                       std::string const& doing) const override {
        hdf5::flush_to_disk(handle, file, doing);
    }
    bool leave_as_flushed(File const& handle) const override {
        hdf5::leave_as_flushed(handle);
        return true;
    }
};

}  // namespace

std::unique_ptr<Writers> one_writer() { return std::make_unique<OneWriter>(); }

}  // namespace catena::hdf5
