// Checkpoints: as they are, whose seal has to hold before HDF5 sees them, and with a new seal, as
// only intent can make it.
#include "error.hpp"
#include "io/file_seal.hpp"
#include "io/output.hpp"
#include "io/trial.hpp"
#include "tests/fuzz/own_fault.hpp"
#include "tests/fuzz/target.hpp"

namespace {

/// Whether it is one.
bool is_read(std::string const& file) {
    try {
        catena::fuzz::require(catena::read_checkpoint(file).step >= 0);
        return true;
    } catch (catena::InputError const&) {
        return false;
    }
}

}  // namespace

void catena::fuzz::read(std::string_view bytes) {
    NamedFile const file(bytes);
    bool const whole = is_read(file.path());
    if (whole || bytes.size() < static_cast<std::size_t>(seal_size)) return;
    put_seal(file.path(), sum_pieces(file.path(), 0, 1, "it", "seal"), "it", "seal");
    own_fault() = false;
    std::string const end = trial([&] { is_read(file.path()); }, limits_for_file(file.path()));
    require(!own_fault());
    if (end.empty()) is_read(file.path());
}
