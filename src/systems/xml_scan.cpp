// Implements the check of a System's text by a small XML scanner without copies of the text.
// OpenMM's own reader ignores many faults silently. The scanner therefore reports them
// first, with the line.
#include "systems/xml_scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <set>
#include <utility>

#include "error.hpp"
#include "scene/node.hpp"

namespace catena {

namespace {

using std::string_view;

/// Largest depth of elements. OpenMM writes ten levels, and a few more for each force within a
/// CustomCVForce.
std::size_t constexpr deepest = 64;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool is_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '.' ||
           c == ':';
}

/// True if the whole text is a number as OpenMM writes it.
bool is_number(string_view text) {
    std::string const copy(text);
    char* end = nullptr;
    std::strtod(copy.c_str(), &end);
    return !copy.empty() && !is_blank(copy[0]) && *end == '\0' && end == copy.c_str() + copy.size();
}

/// True for NaN as any C++ or Python program writes it, and with a sign: nan, NaN, nan(1).
bool is_nan(string_view text) {
    return is_number(text) && std::isnan(std::strtod(std::string(text).c_str(), nullptr));
}

/// True if the text begins with a sign, point or digit of a number.
bool begins_as_number(string_view text) {
    if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
    if (text.starts_with('.')) text.remove_prefix(1);
    return !text.empty() && std::isdigit(static_cast<unsigned char>(text[0])) != 0;
}

template <std::size_t N>
bool is_one_of(string_view name, std::array<string_view, N> const& names) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// Attributes that hold words.
constexpr std::array<string_view, 12> words{"name",
                                            "type",
                                            "types",
                                            "energy",
                                            "expression",
                                            "formula",
                                            "function",
                                            "openmmVersion",
                                            "typeName",
                                            "computationVariable",
                                            "computationExpression",
                                            "kineticEnergyExpression"};
/// Elements whose other attributes are all numbers.
constexpr std::array<string_view, 11> records{"A",         "B",         "C",         "Bond",
                                              "Angle",     "Torsion",   "Particle",  "Value",
                                              "Exclusion", "Exception", "Constraint"};

/// Scanner of the text with a stack of open elements.
class Scanner {
  public:
    Scanner(string_view text, std::string const& file, std::string const& where)
        : text_(text), file_(file), where_(where) {}

    /// Checks the whole text and returns its outline.
    XmlOutline scan() {
        if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
        while (at_ < text_.size()) {
            if (text_[at_] == '<')
                markup();
            else
                between();
        }
        if (!open_.empty())
            fail(open_.back().at,
                 fmt::format("<{}> is not closed: the file is cut short or a line was lost",
                             shown(open_.back().name)));
        if (!rooted_) fail(0, "it has no element");
        return std::move(outline_);
    }

  private:
    /// An element whose end tag has not been read.
    struct Element {
        string_view name;
        std::size_t at;  // position of its tag in the text
        bool has_type = false;
        /// Names of its children; recorded for the System and for forces.
        std::set<string_view> has = {};
    };
    using Attributes = std::vector<std::pair<string_view, string_view>>;

    static std::string shown(string_view text) { return scene::shown(text); }

    /// Number of line feeds between two positions.
    std::ptrdiff_t lines(std::size_t from, std::size_t to) const {
        string_view const part = text_.substr(from, to - from);
        return std::count(part.begin(), part.end(), '\n');
    }

    /// Kind of the object for messages: the root element, as far as it is read.
    std::string kind() const {
        static constexpr std::array<string_view, 4> kinds{"System", "State", "Integrator", "Force"};
        return is_one_of(outline_.root, kinds) ? outline_.root : "file";
    }

    /// Throws InputError with the line of position `at`.
    [[noreturn]] void fail(std::size_t at, std::string const& what) const {
        throw InputError(
            fmt::format("{} is not well-formed: {} (line {})", file_, what, 1 + lines(0, at)),
            where_, fmt::format("write the {} again with OpenMM's XmlSerializer", kind()));
    }

    /// Skips blanks between elements; throws InputError for other characters.
    void between() {
        for (; at_ < text_.size() && text_[at_] != '<'; ++at_)
            if (!is_blank(text_[at_]))
                fail(at_,
                     fmt::format("`{}` stands between elements", shown(text_.substr(at_, 20))));
    }

    /// Reads a comment, declaration or tag.
    void markup() {
        string_view const rest = text_.substr(at_);
        if (rest.starts_with("<!--")) return skip({"<!--", "-->", "<", "a comment"});
        if (rest.starts_with("<?")) return skip({"<?", "?>", "<>", "a declaration"});
        if (rest.starts_with("<!"))
            fail(at_, "a document type or section, which OpenMM does not write");
        if (rest.starts_with("</")) return end_tag();
        start_tag();
    }

    /// A part of the text that has no element, and what may not stand in it.
    struct Skipped {
        string_view opening, closing, forbidden;
        char const* name;
    };
    /// Skips a comment or declaration; throws InputError if it does not end. OpenMM's reader ends a
    /// declaration at its first `>` and counts `<` in a comment. With these in it, that reader
    /// would find other elements than this one, or read beyond the end of the text.
    void skip(Skipped const& part) {
        std::size_t const begin = at_ + part.opening.size(), end = text_.find(part.closing, begin);
        if (end == string_view::npos) fail(at_, fmt::format("{} that is not closed", part.name));
        std::size_t const odd = text_.find_first_of(part.forbidden, begin);
        if (odd < end) fail(odd, fmt::format("{} that holds `{}`", part.name, text_[odd]));
        at_ = end + part.closing.size();
    }

    /// Reads a name of a tag or attribute.
    string_view name() {
        std::size_t const begin = at_;
        while (at_ < text_.size() && is_name(text_[at_])) ++at_;
        if (at_ == begin || std::isalpha(static_cast<unsigned char>(text_[begin])) == 0)
            fail(begin, "a tag or attribute without a name");
        return text_.substr(begin, at_ - begin);
    }
    /// Skips blanks; returns true if there were any.
    bool blanks() {
        std::size_t const begin = at_;
        while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
        return at_ > begin;
    }
    /// Skips the token if the text continues with it; returns true if so.
    bool take(string_view token) {
        if (!text_.substr(at_).starts_with(token)) return false;
        at_ += token.size();
        return true;
    }

    /// Reads an end tag and closes the innermost element, which must have that name.
    void end_tag() {
        std::size_t const begin = at_;
        at_ += 2;
        string_view const closed = name();
        blanks();
        if (!take(">")) fail(begin, fmt::format("</{}> has no `>`", shown(closed)));
        if (open_.empty()) fail(begin, fmt::format("</{}> closes nothing", shown(closed)));
        if (open_.back().name != closed)
            fail(begin, fmt::format("</{}> closes <{}>", shown(closed), shown(open_.back().name)));
        open_.pop_back();
    }

    /// Reads a start tag or an empty element with its attributes and opens it.
    void start_tag() {
        std::size_t const begin = at_++;
        if (open_.empty() && rooted_)
            fail(begin, fmt::format("a second element beside the {}", kind()));
        if (open_.size() == deepest)
            fail(begin, fmt::format("elements lie more than {} deep in each other", deepest));
        Element element{name(), begin};
        Attributes attributes;
        while (blanks() && at_ < text_.size() && text_[at_] != '>' && text_[at_] != '/')
            attributes.push_back(attribute());
        refuse_twice(begin, attributes);
        bool const empty = take("/");
        if (!take(">")) fail(begin, fmt::format("<{}> has no `>`", shown(element.name)));
        check_numbers(element, attributes);
        element.has_type = !value_of(attributes, "type").empty();
        enter(element, attributes);
        rooted_ = true;
        if (!empty) open_.push_back(std::move(element));
    }

    /// Throws InputError for an attribute given twice. Sorting keeps the cost low, because an
    /// element may have as many attributes as the file has room for.
    void refuse_twice(std::size_t at, Attributes const& attributes) const {
        std::vector<string_view> keys;
        for (auto const& [key, value] : attributes) keys.push_back(key);
        std::sort(keys.begin(), keys.end());
        auto const twice = std::adjacent_find(keys.begin(), keys.end());
        if (twice != keys.end())
            fail(at, fmt::format("attribute {} is given twice", shown(*twice)));
    }

    /// Reads one attribute with its quoted value.
    std::pair<string_view, string_view> attribute() {
        std::size_t const begin = at_;
        string_view const key = name();
        blanks();
        if (!take("=")) fail(begin, fmt::format("attribute {} has no value", shown(key)));
        blanks();
        char const quote = at_ < text_.size() ? text_[at_] : ' ';
        if (quote != '"' && quote != '\'')
            fail(begin, fmt::format("the value of {} has no quotes", shown(key)));
        std::size_t const from = ++at_, to = text_.find(quote, from);
        string_view const value = text_.substr(from, to == string_view::npos ? to : to - from);
        if (to == string_view::npos || value.find('<') != string_view::npos)
            fail(begin, fmt::format("the value of {} has no closing quote", shown(key)));
        for (char const c : value)
            if (static_cast<unsigned char>(c) < ' ' && !is_blank(c))
                fail(begin, fmt::format("a control character in the value of {}", shown(key)));
        at_ = to + 1;
        return {key, value};
    }

    /// Throws InputError for numbers with other characters in them, of which OpenMM would use the
    /// part before the first letter, or 0. NaN is refused too, except as an entry of a table, which
    /// may be one that no beads use.
    void check_numbers(Element const& element, Attributes const& attributes) const {
        bool const all = is_one_of(element.name, records), entry = element.name == "Value";
        for (auto const& [key, value] : attributes) {
            if (is_one_of(key, words)) continue;
            bool const wrong = (all || begins_as_number(value)) && !is_number(value);
            if (wrong || (!entry && is_nan(value)))
                fail(element.at, fmt::format("`{}` of {} is no number", shown(value), shown(key)));
        }
    }

    /// Value of an attribute; empty if the attribute is absent.
    static string_view value_of(Attributes const& attributes, string_view key) {
        for (auto const& [other, value] : attributes)
            if (other == key) return value;
        return {};
    }

    /// Records an element in the outline and checks its place in the parent.
    void enter(Element const& element, Attributes const& attributes) {
        if (open_.empty()) {
            outline_.root = element.name;
            outline_.type = value_of(attributes, "type");
            outline_.version = value_of(attributes, "openmmVersion");
            for (auto const& [key, value] : attributes) outline_.attributes.emplace(key, value);
            return;
        }
        Element& parent = open_.back();
        bool const in_forces = open_.size() == 2 && parent.name == "Forces";
        if (in_forces) outline_.forces.emplace_back(value_of(attributes, "type"));
        if (parent.name == "Force" && parent.has_type &&
            element.name == "Force")  // the forces of an ATMForce are in <Force> without a type
            fail(parent.at,
                 fmt::format("a <Force> is not closed before the next begins ({} lines below)",
                             lines(parent.at, element.at)));
        // A CompoundIntegrator holds Integrators, and a NoseHooverIntegrator several thermostats.
        bool const once =
            parent.name == "Force" || (open_.size() == 1 && parent.name != "Integrator");
        if (!once) return;
        if (!parent.has.insert(element.name).second)
            fail(element.at, fmt::format("<{}> is there twice in <{}>", shown(element.name),
                                         shown(parent.name)));
    }

    string_view text_;
    std::string const& file_;
    std::string const& where_;
    /// Position in the text.
    std::size_t at_ = 0;
    bool rooted_ = false;
    /// Open elements, the outermost first.
    std::vector<Element> open_;
    XmlOutline outline_;
};

}  // namespace

XmlOutline scan_system_xml(std::string_view text, std::string const& file,
                           std::string const& where) {
    return Scanner(text, file, where).scan();
}

}  // namespace catena
