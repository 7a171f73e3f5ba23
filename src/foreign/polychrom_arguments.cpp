// Implements the settings of a polychrom run: the attributes of initArgs_N.h5, which are the
// arguments of its class Simulation (polychrom/simulation.py). Steps are given in femtoseconds.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "error.hpp"
#include "foreign/known_tools.hpp"
#include "io/hdf5_handle.hpp"
#include "io/trial.hpp"
#include "scene/node.hpp"

namespace catena::foreign {

namespace {

constexpr double femtosecond = 1e-3;  // ps

/// Arguments of the class Simulation that decide the dynamics.
struct Arguments {
    std::map<std::string, double> numbers;
    std::string integrator;  // in lower case; empty if it cannot be read
    /// True if the integrator chooses its steps.
    bool varies() const { return integrator.starts_with("variable"); }
};

/// Reads a scalar attribute. Throws std::runtime_error if it is there and is no number.
void read_number(hdf5::File const& file, std::string const& name, Arguments& found) {
    if (H5Aexists(file.get(), name.c_str()) <= 0) return;
    hdf5::Attribute const attribute(H5Aopen(file.get(), name.c_str(), H5P_DEFAULT));
    hdf5::Space const space(H5Aget_space(attribute.get()));
    double value = 0;
    if (!space || H5Sget_simple_extent_npoints(space.get()) != 1 ||
        H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &value) < 0)
        throw std::runtime_error(name + " is no number");
    found.numbers[name] = value;
}

/// Reads the attribute `integrator`, a text of variable length as h5py writes it.
std::string read_integrator(hdf5::File const& file) {
    if (H5Aexists(file.get(), "integrator") <= 0) return "";
    hdf5::Attribute const attribute(H5Aopen(file.get(), "integrator", H5P_DEFAULT));
    hdf5::Type const type(H5Aget_type(attribute.get()));
    hdf5::Space const space(H5Aget_space(attribute.get()));
    if (!type || !space || H5Tis_variable_str(type.get()) <= 0 ||
        H5Sget_simple_extent_npoints(space.get()) != 1)
        return "";
    char* text = nullptr;
    if (H5Aread(attribute.get(), type.get(), static_cast<void*>(&text)) < 0 || text == nullptr)
        return "";
    std::string lower = text;
    H5Dvlen_reclaim(type.get(), space.get(), H5P_DEFAULT, static_cast<void*>(&text));
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return lower;
}

/// Reads the file. Throws std::runtime_error if it is no HDF5 file.
Arguments read_arguments(std::string const& name) {
    hdf5::Quiet const quiet;
    hdf5::File const file(H5Fopen(name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
    if (!file) throw std::runtime_error("no HDF5 file can be opened");
    Arguments found;
    for (char const* const key : {"temperature", "collision_rate", "timestep"})
        read_number(file, key, found);
    found.integrator = read_integrator(file);
    return found;
}

/// Reads the file, first in a copy of this process: HDF5 breaks on damaged texts.
Arguments arguments_of(std::string const& file) {
    auto const refuse = [&](std::string const& why) {
        throw InputError("polychrom's arguments cannot be read: " + why, scene::shown_path(file),
                         "copy the file again, or move it out of the folder to set the dynamics "
                         "yourself");
    };
    std::string const end = trial([&] { read_arguments(file); }, limits_for_file(file));
    if (!end.empty()) refuse("HDF5 breaks on it: " + end);
    Arguments found;
    try {
        found = read_arguments(file);
    } catch (std::exception const& error) {
        refuse(error.what());
    }
    for (auto const& [key, value] : found.numbers) {
        // Without friction or at 0 K, polychrom runs; a variable integrator ignores the step.
        bool const may_be_zero = key != "timestep" || found.varies();
        if (!(value >= 0 && std::isfinite(value)) || (value == 0 && !may_be_zero))
            refuse(fmt::format("{} is {:.6g}", key, value));
    }
    return found;
}

}  // namespace

Settings polychrom_settings(Files const& files) {
    Arguments const found = arguments_of(files.init_args);
    std::string const name =
        scene::shown_path(std::filesystem::path(files.init_args).filename().string());
    Settings settings;
    auto const take = [&](char const* key, double& value, double unit) {
        auto const at = found.numbers.find(key);
        if (at != found.numbers.end()) value = at->second * unit;
        return at != found.numbers.end();
    };
    bool const warm = take("temperature", settings.temperature, 1),
               damped = take("collision_rate", settings.friction, 1),
               timed = !found.varies() && take("timestep", settings.step, femtosecond);
    auto const place = [&](char const* key) {
        return scene::shown_path(files.init_args) + ": " + key;
    };
    settings.origins = {{"dynamics.temperature", place("temperature")},
                        {"dynamics.friction", place("collision_rate")},
                        {"dynamics.step", place("timestep")}};
    settings.notes.push_back(settings_note(
        name, found.integrator.empty() ? "unknown integrator" : scene::shown(found.integrator),
        settings, {warm, damped, timed}));
    if (std::string const more = integrator_note(found.integrator, settings); !more.empty())
        settings.notes.push_back(more);
    return settings;
}

}  // namespace catena::foreign
