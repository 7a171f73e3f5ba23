// Check of the text of a serialised System before OpenMM's reader, which does not check it. This
// header does not need OpenMM.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace catena {

/// Types and version named in the text of a serialised object.
struct XmlOutline {
    /// Name of the root element: System, Force, ...
    std::string root;
    /// Attributes `type` and `openmmVersion` of the root element.
    std::string type, version;
    /// All attributes of the root element.
    std::map<std::string, std::string> attributes;
    /// Types of the elements in its <Forces>, in order.
    std::vector<std::string> forces;
};

/// Reads the whole text. Throws InputError with the line if it is not well-formed XML: tags that do
/// not match, open comments, a second root, attributes without quotes, ... Also refused is what
/// OpenMM would ignore silently. Examples are text between elements, an element given twice in the
/// System or in a force, a number with letters in it, and NaN outside a table. Elements may be
/// nested at most 64 deep. `file` is the name in messages; `where` is the scene file and key.
XmlOutline scan_system_xml(std::string_view text, std::string const& file,
                           std::string const& where);

}  // namespace catena
