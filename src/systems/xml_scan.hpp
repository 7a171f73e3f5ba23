// A look at the text of a serialised System before OpenMM's reader, which trusts it, does. No
// OpenMM here.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace catena {

/// What the text of a System says of itself.
struct XmlOutline {
    std::string type, version;        // of the root element: `type` and `openmmVersion`
    std::vector<std::string> forces;  // types of the elements in its <Forces>, in order
};

/// Reads the whole text. Throws InputError with the line where it is not well-formed XML (tags that
/// do not match, open comments, a second root, attributes without quotes, ...), and for what OpenMM
/// would pass over in silence: text between elements, an element given twice in the System or in a
/// force, a number with letters in it. Elements nest at most 64 deep. `file`: for messages;
/// `where`: scene file and key.
XmlOutline scan_system_xml(std::string_view text, std::string const& file,
                           std::string const& where);

}  // namespace catena
