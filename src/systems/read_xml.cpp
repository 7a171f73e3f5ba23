// Implements the reading of serialised Systems, forces and States. The text is checked before and
// the result after OpenMM's own reader, which accepts damaged files silently.
#include <cxxabi.h>
#include <fmt/format.h>
#include <openmm/serialization/XmlSerializer.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <new>
#include <sstream>
#include <string_view>
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

/// Reads a file that should hold an object of that kind. Throws InputError before it if the memory
/// does not suffice.
std::string read_text(std::string const& file, std::string const& where, char const* kind) {
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    std::streamoff const size = in ? static_cast<std::streamoff>(in.tellg()) : -1;
    if (size < 0)
        throw InputError(fmt::format("cannot open {}", scene::shown_path(file)), where,
                         fmt::format("name a serialised {} that can be read", kind));
    double const needed = bytes_a_character * static_cast<double>(size);
    auto const present = static_cast<double>(memory_limit());
    if (needed > present)
        throw InputError(fmt::format("reading {} needs about {:.3g} GB of memory, and only {}",
                                     scene::shown_path(file), needed * 1e-9, available_memory()),
                         where, "use a machine with more memory, or raise that limit");
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

/// Kind of object that a file should hold.
struct Wanted {
    /// Name of its root element.
    char const* root;
    char const* remedy;
    /// Scene file and key in messages.
    std::string const& where;
};

/// Throws the InputError for a file that holds something else.
[[noreturn]] void refuse_other(std::string const& name, Wanted const& wanted) {
    throw InputError(fmt::format("{} is not a serialised {}", name, wanted.root), wanted.where,
                     wanted.remedy);
}

/// True for the types of forces, thermostats and barostats.
bool is_force(std::string const& type) {
    return type.ends_with("Force") || type.ends_with("Thermostat") || type.ends_with("Barostat") ||
           type == "CMMotionRemover";
}

/// Checks the text and returns its outline. Throws InputError for another root element.
XmlOutline outline_of(std::string const& xml, std::string const& name, Wanted const& wanted) {
    load_openmm_plugins();
    if (xml.find(fmt::format("<{}", wanted.root)) == std::string::npos) refuse_other(name, wanted);
    XmlOutline outline = scan_system_xml(xml, name, wanted.where);
    // OpenMM makes what `type` says, whatever the reader expects.
    bool const fits = std::string_view(wanted.root) == "Force" ? is_force(outline.type)
                                                               : outline.type == wanted.root;
    if (outline.root != wanted.root || !fits) refuse_other(name, wanted);
    return outline;
}

/// Makes the object by OpenMM's reader, whose exceptions become InputErrors that name both
/// versions.
template <class Object>
std::unique_ptr<Object> deserialized(std::string const& xml, XmlOutline const& outline,
                                     std::string const& name, Wanted const& wanted) {
    try {
        std::istringstream in(xml);
        return std::unique_ptr<Object>(OpenMM::XmlSerializer::deserialize<Object>(in));
    } catch (std::bad_alloc const&) {
        throw;
    } catch (std::exception const& e) {
        throw InputError(
            fmt::format(
                "OpenMM {} cannot read {}, written by OpenMM {}: {}",
                OpenMM::Platform::getOpenMMVersion(), name,
                outline.version.empty() ? "of an unknown version" : scene::shown(outline.version),
                scene::shown(e.what(), 300)),
            wanted.where,
            "build Catena with that OpenMM or a later one, or write it with an earlier "
            "one");
    }
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
    std::string const name = scene::shown_path(file), xml = read_text(file, where, "System");
    Wanted const wanted{"System", "write it with OpenMM's XmlSerializer.serialize(system)", where};
    XmlOutline const outline = outline_of(xml, name, wanted);
    std::unique_ptr<OpenMM::System> system =
        deserialized<OpenMM::System>(xml, outline, name, wanted);
    if (std::string const lost = difference(outline.forces, *system); !lost.empty())
        throw InputError(fmt::format("OpenMM reads {} from {}", lost, name), where, wanted.remedy);
    return system;
}

std::unique_ptr<OpenMM::Force> read_openmm_force(std::string const& file,
                                                 std::string const& where) {
    std::string const name = scene::shown_path(file), xml = read_text(file, where, "Force");
    Wanted const wanted{"Force", "write it with OpenMM's XmlSerializer.serialize(force)", where};
    XmlOutline const outline = outline_of(xml, name, wanted);
    std::unique_ptr<OpenMM::Force> force = deserialized<OpenMM::Force>(xml, outline, name, wanted);
    return force;
}

OpenMmState read_openmm_state(std::string const& file, std::string const& where) {
    std::string const name = scene::shown_path(file), xml = read_text(file, where, "State");
    Wanted const wanted{"State", "write it with OpenMM's XmlSerializer.serialize(state)", where};
    XmlOutline const outline = outline_of(xml, name, wanted);
    auto const state = deserialized<OpenMM::State>(xml, outline, name, wanted);
    if ((state->getDataTypes() & OpenMM::State::Positions) == 0)
        throw InputError(fmt::format("{} holds no positions", name), where,
                         "write it after getState(getPositions=True)");
    OpenMmState found;
    for (OpenMM::Vec3 const& x : state->getPositions())
        found.positions.push_back({{x[0], x[1], x[2]}});
    OpenMM::Vec3 a, b, c;
    state->getPeriodicBoxVectors(a, b, c);
    found.box = {{a[0], b[1], c[2]}};
    found.has_velocities = (state->getDataTypes() & OpenMM::State::Velocities) != 0;
    return found;
}

}  // namespace catena
