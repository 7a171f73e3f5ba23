// Serialised Systems: reading, and refusing what Catena cannot drive.
#include <cxxabi.h>
#include <fmt/format.h>
#include <openmm/serialization/XmlSerializer.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string_view>
#include <typeinfo>

#include "error.hpp"
#include "force/openmm_model.hpp"
#include "force/openmm_platform.hpp"

namespace catena {

namespace {

/// The value of an attribute of the root element, "" where it has none.
std::string root_attribute(std::string const& xml, std::string const& name) {
    auto const open = xml.find("<System ");
    if (open == std::string::npos) return "";
    std::string const element = xml.substr(open, xml.find('>', open) - open);
    auto const at = element.find(' ' + name + "=\"");
    if (at == std::string::npos) return "";
    auto const from = at + name.size() + 3;
    return element.substr(from, element.find('"', from) - from);
}

/// OpenMM's reader runs past the end of a text that lacks its last element.
bool is_complete(std::string const& xml) {
    std::string_view text = xml;
    auto const end = text.find_last_not_of(" \t\r\n");
    return end != std::string_view::npos && text.substr(0, end + 1).ends_with("</System>");
}

std::string one_line(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

std::string read_text(std::string const& file, std::string const& where) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw InputError(fmt::format("cannot open {}", file), where, "name a serialised System that can be read");
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
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

std::unique_ptr<OpenMM::System> read_openmm_system(std::string const& file, std::string const& where) {
    load_openmm_plugins();
    std::string const xml = read_text(file, where);
    if (root_attribute(xml, "type") != "System")
        throw InputError(fmt::format("{} is no serialised System", file), where, "write it with OpenMM's XmlSerializer.serialize(system)");
    if (!is_complete(xml)) throw InputError(fmt::format("{} is cut short", file), where, "write the System again");
    try {
        std::istringstream in(xml);
        return std::unique_ptr<OpenMM::System>(OpenMM::XmlSerializer::deserialize<OpenMM::System>(in));
    } catch (std::exception const& e) {
        std::string const by = root_attribute(xml, "openmmVersion");
        throw InputError(fmt::format("OpenMM {} cannot read {}, written by OpenMM {}: {}", OpenMM::Platform::getOpenMMVersion(), file,
                                     by.empty() ? "of an unknown version" : by, one_line(e.what())),
                         where, "build Catena with that OpenMM or a later one, or write the System with an earlier one");
    }
}

void refuse_movers(OpenMM::System const& system, std::string const& where) {
    for (int p = 0; p < system.getNumParticles(); ++p) {
        if (system.isVirtualSite(p))
            throw InputError(fmt::format("particle {} (from 0) is a virtual site", p), where,
                             "leave virtual sites out: every particle is a bead with a mass");
        if (!(system.getParticleMass(p) > 0))
            throw InputError(fmt::format("particle {} (from 0) has no mass", p), where, "give it one: every particle is a bead that moves");
    }
    for (int i = 0; i < system.getNumForces(); ++i) {
        std::string const kind = kind_of(system.getForce(i));
        bool const barostat = kind.find("Barostat") != std::string::npos;
        if (!barostat && kind != "CMMotionRemover" && kind != "AndersenThermostat") continue;
        throw InputError(fmt::format("the System holds a {}", kind), where,
                         barostat ? "remove it: Catena runs at constant volume"
                                  : "remove it: Catena's own integrators move the beads (dynamics.integrator)");
    }
}

}  // namespace catena
