// Implements the reading of serialised Systems. The text is checked before and the result after
// OpenMM's own reader, which accepts damaged files silently.
#include <cxxabi.h>
#include <fmt/format.h>
#include <openmm/serialization/XmlSerializer.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <new>
#include <sstream>
#include <typeinfo>

#include "error.hpp"
#include "io/memory_limit.hpp"
#include "scene/node.hpp"
#include "systems/model.hpp"
#include "systems/plugins.hpp"
#include "systems/xml_scan.hpp"

namespace catena {

namespace {

/// Memory per character of the text. OpenMM's reader takes 4.6 bytes per byte (14.7 MB of
/// particles, bonds and exclusions), and there are two copies of the text.
double constexpr bytes_a_character = 8;

/// Reads a file; throws InputError before it if the memory does not suffice.
std::string read_text(std::string const& file, std::string const& where) {
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    std::streamoff const size = in ? static_cast<std::streamoff>(in.tellg()) : -1;
    if (size < 0)
        throw InputError(fmt::format("cannot open {}", scene::shown_path(file)), where,
                         "name a serialised System that can be read");
    double const needed = bytes_a_character * static_cast<double>(size);
    auto const present = static_cast<double>(memory_limit());
    if (needed > present)
        throw InputError(
            fmt::format(
                "reading {} needs about {:.3g} GB of memory, and only {:.3g} GB are available",
                scene::shown_path(file), needed * 1e-9, present * 1e-9),
            where, "use a machine with more memory");
    std::string text(static_cast<std::size_t>(size), '\0');
    in.seekg(0);
    in.read(text.data(), size);
    text.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
    return text;
}

/// Describes the first difference between the forces in the file and in the System that OpenMM
/// read; empty if there is none.
std::string difference(std::vector<std::string> const& written, OpenMM::System const& read) {
    if (std::ssize(written) != read.getNumForces())
        return fmt::format("{} forces where the file has {}", read.getNumForces(), written.size());
    for (int i = 0; i < read.getNumForces(); ++i)
        if (std::string const& type = written[static_cast<std::size_t>(i)];
            kind_of(read.getForce(i)) != type)
            return fmt::format("a {} where the file has a {}", kind_of(read.getForce(i)),
                               scene::shown(type));
    return "";
}

}  // namespace

std::string kind_of(OpenMM::Force const& force) {
    int status = 0;
    char* const demangled = abi::__cxa_demangle(typeid(force).name(), nullptr, nullptr, &status);
    std::string const name = status == 0 ? demangled : typeid(force).name();
    std::free(demangled);
    auto const colon = name.rfind(':');
    return colon == std::string::npos ? name : name.substr(colon + 1);
}

std::unique_ptr<OpenMM::System> read_openmm_system(std::string const& file,
                                                   std::string const& where) {
    load_openmm_plugins();
    std::string const name = scene::shown_path(file), xml = read_text(file, where);
    char const* const remedy = "write it with OpenMM's XmlSerializer.serialize(system)";
    if (xml.find("<System") == std::string::npos)
        throw InputError(fmt::format("{} is not a serialised System", name), where, remedy);
    XmlOutline const outline = scan_system_xml(xml, name, where);
    if (outline.type != "System")
        throw InputError(fmt::format("{} is not a serialised System", name), where, remedy);
    std::unique_ptr<OpenMM::System> system;
    try {
        std::istringstream in(xml);
        system.reset(OpenMM::XmlSerializer::deserialize<OpenMM::System>(in));
    } catch (std::bad_alloc const&) {
        throw;
    } catch (std::exception const& e) {
        throw InputError(fmt::format("OpenMM {} cannot read {}, written by OpenMM {}: {}",
                                     OpenMM::Platform::getOpenMMVersion(), name,
                                     outline.version.empty() ? "of an unknown version"
                                                             : scene::shown(outline.version),
                                     scene::shown(e.what(), 300)),
                         where,
                         "build Catena with that OpenMM or a later one, or write the System with "
                         "an earlier one");
    }
    if (std::string const lost = difference(outline.forces, *system); !lost.empty())
        throw InputError(fmt::format("OpenMM reads {} from {}", lost, name), where, remedy);
    return system;
}

}  // namespace catena
