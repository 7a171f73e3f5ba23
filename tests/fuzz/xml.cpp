// The text of a System, before OpenMM sees it.
#include "systems/xml_scan.hpp"
#include "tests/fuzz/plain_xml.hpp"
#include "tests/fuzz/target.hpp"

void catena::fuzz::read(std::string_view bytes) {
    XmlOutline const outline = scan_system_xml(bytes, "system.xml", "scene.yaml: forces.system");
    require(outline.forces == plain_forces(bytes));
}
