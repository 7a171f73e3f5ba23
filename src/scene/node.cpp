// Implements the scene tree on top of yaml-cpp's event parser.
#include "scene/node.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>
// The following two headers do not include what they use, so that they must follow yaml.h.
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "io/printable.hpp"

namespace catena::scene {

namespace {

std::string at_line(std::string const& file, int line) {
    return line > 0 ? fmt::format("{}: line {}", file, line) : file;
}

/// Memory of a subtree in bytes, to limit the copies made by aliases.
std::size_t bytes_of(Node const& node) {
    std::size_t bytes = sizeof(Node) + node.key.size() + node.text.size();
    for (Node const& item : node.items) bytes += bytes_of(item);
    return bytes;
}

/// Number of levels of a subtree.
std::size_t depth_of(Node const& node) {
    std::size_t deepest = 0;
    for (Node const& item : node.items) deepest = std::max(deepest, depth_of(item));
    return 1 + deepest;
}

/// Largest depth of nested values. yaml-cpp stops there, and every function that walks the tree
/// recurses as deep.
std::size_t constexpr deepest = 500;
/// Largest number of bytes copied for anchors and aliases. The limit grows with the file, so that
/// large files may repeat their content.
std::size_t allowed_copies(std::size_t file) {
    return std::max(std::size_t{512} << 20, 128 * file);
}

/// Builds the tree from yaml-cpp's events.
class TreeBuilder : public YAML::EventHandler {
  public:
    TreeBuilder(std::string file, bool lines, std::size_t allowed)
        : file_(std::move(file)), lines_(lines), allowed_(allowed) {}

    Node root;
    bool complete = false;

    void OnDocumentStart(YAML::Mark const&) override {}
    void OnDocumentEnd() override {}
    void OnNull(YAML::Mark const& mark, YAML::anchor_t anchor) override {
        if (expects_key()) refuse_key(mark);
        Node node;
        node.line = line(mark);
        add(std::move(node), anchor);
    }
    void OnAlias(YAML::Mark const& mark, YAML::anchor_t anchor) override {
        if (expects_key()) refuse_key(mark);
        auto const found = anchors_.find(anchor);
        if (found == anchors_.end())
            throw InputError("an alias refers to the value that contains it",
                             at_line(file_, line(mark)), "write the value out");
        if (open_.size() + depth_of(found->second) > deepest)
            throw InputError(fmt::format("values nest deeper than {} levels", deepest),
                             at_line(file_, line(mark)), "write the values out, or nest fewer");
        count_copy(found->second, line(mark));
        add(found->second, 0);
    }
    void OnScalar(YAML::Mark const& mark, std::string const& tag, YAML::anchor_t anchor,
                  std::string const& value) override {
        refuse_tag(mark, tag);
        if (expects_key()) {
            open_.back().key = value;
            open_.back().key_line = line(mark);
            open_.back().has_key = true;
            return;
        }
        Node node;
        node.kind = Node::Kind::scalar;
        node.quoted = tag == "!";
        node.line = line(mark);
        node.text = value;
        add(std::move(node), anchor);
    }
    void OnSequenceStart(YAML::Mark const& mark, std::string const& tag, YAML::anchor_t anchor,
                         YAML::EmitterStyle::value) override {
        start(mark, tag, anchor, Node::Kind::list);
    }
    void OnSequenceEnd() override { finish(); }
    void OnMapStart(YAML::Mark const& mark, std::string const& tag, YAML::anchor_t anchor,
                    YAML::EmitterStyle::value) override {
        start(mark, tag, anchor, Node::Kind::map);
    }
    void OnMapEnd() override {
        refuse_duplicates(open_.back().node);
        finish();
    }

  private:
    /// A list or map whose end has not been read yet.
    struct Open {
        Node node;
        YAML::anchor_t anchor;
        std::string key = {};
        int key_line = 0;
        bool has_key = false;
    };

    int line(YAML::Mark const& mark) const { return lines_ ? mark.line + 1 : 0; }
    bool expects_key() const {
        return !open_.empty() && open_.back().node.kind == Node::Kind::map && !open_.back().has_key;
    }
    [[noreturn]] void refuse_key(YAML::Mark const& mark) const {
        throw InputError("a key is not plain text", at_line(file_, line(mark)),
                         "write `name: value`, and close every bracket");  // yaml-cpp reads an open
                                                                           // bracket as a key
    }
    void refuse_tag(YAML::Mark const& mark, std::string const& tag) const {
        if (tag.empty() || tag == "?" || tag == "!") return;
        throw InputError(fmt::format("YAML tag `{}` is not supported", shown(tag)),
                         at_line(file_, line(mark)), "leave the tag out");
    }
    void refuse_duplicates(Node const& map) const {
        std::vector<Node const*> sorted;
        for (Node const& item : map.items) sorted.push_back(&item);
        std::stable_sort(sorted.begin(), sorted.end(),
                         [](Node const* a, Node const* b) { return a->key < b->key; });
        auto const twice =
            std::adjacent_find(sorted.begin(), sorted.end(),
                               [](Node const* a, Node const* b) { return a->key == b->key; });
        if (twice == sorted.end()) return;
        int const first = (*twice)->line, second = (*(twice + 1))->line;
        throw InputError(fmt::format("key `{}` is given twice", shown((*twice)->key)),
                         first < second ? fmt::format("{}: lines {} and {}", file_, first, second)
                                        : at_line(file_, first),
                         "keep one of them");
    }
    void start(YAML::Mark const& mark, std::string const& tag, YAML::anchor_t anchor,
               Node::Kind kind) {
        if (expects_key()) refuse_key(mark);
        refuse_tag(mark, tag);
        open_.push_back({{}, anchor});
        open_.back().node.kind = kind;
        open_.back().node.line = line(mark);
    }
    void finish() {
        Open done = std::move(open_.back());
        open_.pop_back();
        add(std::move(done.node), done.anchor);
    }
    /// Counts a copy before it is made; throws InputError beyond the limit.
    void count_copy(Node const& node, int at) {
        copied_ += bytes_of(node);
        if (copied_ > allowed_)
            throw InputError(
                fmt::format("anchors and aliases multiply the values to more than {} MB",
                            allowed_ >> 20),
                at_line(file_, at), "write the values out, or give fewer of them anchors");
    }
    /// Inserts a finished value into the innermost open list or map.
    void add(Node node, YAML::anchor_t anchor) {
        node.key.clear();
        if (anchor != 0) {
            count_copy(node, node.line);
            anchors_[anchor] = node;
        }
        if (open_.empty()) {
            root = std::move(node);
            complete = true;
            return;
        }
        Open& holder = open_.back();
        if (holder.node.kind == Node::Kind::map) {
            node.key = std::move(holder.key);
            node.line = holder.key_line;
            holder.has_key = false;
        }
        holder.node.items.push_back(std::move(node));
    }

    std::string file_;
    bool lines_;
    std::size_t allowed_, copied_ = 0;
    std::vector<Open> open_;
    std::map<YAML::anchor_t, Node> anchors_;
};

/// True if blanks at the beginning of the line, counted from 1, hold a tab.
bool begins_with_tab(std::string const& text, int line) {
    std::size_t at = 0;
    for (int i = 1; i < line && at != std::string::npos; ++i) {
        at = text.find('\n', at);
        if (at != std::string::npos) ++at;
    }
    if (line < 1 || at == std::string::npos) return false;
    std::size_t const first = text.find_first_not_of(" \t", at);
    return text.substr(at, first == std::string::npos ? first : first - at).find('\t') !=
           std::string::npos;
}

/// Throws InputError if the text is an HDF5 file.
void refuse_hdf5(std::string const& text, std::string const& file) {
    if (text.starts_with("\x89HDF"))
        throw InputError(
            "an HDF5 file, not a scene", file,
            "name a scene; catena run SCENE --restart FOLDER/checkpoint.h5 continues a "
            "run");
}

Node parse_tree(std::string const& text, std::string const& file, bool lines) {
    refuse_hdf5(text, file);
    std::istringstream stream(text);
    TreeBuilder builder(file, lines, allowed_copies(text.size()));
    try {
        YAML::Parser parser(stream);
        parser.HandleNextDocument(builder);
        TreeBuilder second(file, lines, allowed_copies(text.size()));
        if (builder.complete && parser.HandleNextDocument(second) && second.complete)
            throw InputError("holds more than one YAML document", at_line(file, second.root.line),
                             "keep one document, without `---`");
    } catch (YAML::Exception const& error) {
        int const line = error.mark.is_null() ? 0 : error.mark.line + 1;
        throw InputError("not YAML: " + shown(error.msg), at_line(file, lines ? line : 0),
                         begins_with_tab(text, line) ? "indent with blanks instead of tabs"
                                                     : "correct the syntax there or just before");
    }
    return std::move(builder.root);
}

}  // namespace

Node const* Node::find(std::string_view name) const {
    if (kind != Kind::map) return nullptr;
    for (Node const& item : items)
        if (item.key == name) return &item;
    return nullptr;
}

std::string Node::path() const {
    if (!parent) return {};
    std::string const before = parent->path();
    if (parent->kind == Kind::list)
        return fmt::format("{}[{}]", before, this - parent->items.data());
    return before.empty() ? shown(key) : before + "." + shown(key);
}

std::int64_t Node::body() const {
    for (Node const* at = this; at->parent; at = at->parent)
        if (at->parent->kind == Kind::list && at->parent->key == "bodies")
            return at - at->parent->items.data() + 1;
    return 0;
}

std::string Node::where(char const* noun, std::int64_t index) const {
    Node const* root = this;
    while (root->parent) root = root->parent;
    std::string place = root->text;
    if (parent) place += ": " + path();
    if (index == 0) index = body();
    if (index > 0) place += fmt::format(", {} {}", noun, index);
    if (parent) place += line > 0 ? fmt::format(", line {}", line) : ", set outside the file";
    return place;
}

std::unique_ptr<Node> parse_document(std::string const& text, std::string const& file) {
    auto root = std::make_unique<Node>(parse_tree(text, file, true));
    if (root->kind == Node::Kind::null)
        throw InputError("the scene is empty", file, "describe at least one chain under `chains:`");
    if (root->kind != Node::Kind::map)
        throw InputError("the scene is " + describe(*root) + ", not a map",
                         at_line(file, root->line),
                         "write keys such as `chains:` at the left margin");
    root->text = file;
    link_parents(*root);
    return root;
}

Node parse_value(std::string const& text, std::string const& origin) {
    return parse_tree(text, origin, false);
}

void link_parents(Node& node) {
    for (Node& item : node.items) {
        item.parent = &node;
        link_parents(item);
    }
}

std::string shown(std::string_view text, std::size_t longest) {
    std::string line;
    for (char const c : text.substr(0, longest))
        line += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
    return printable(line) + (text.size() > longest ? "..." : "");
}

std::string describe(Node const& node) {
    switch (node.kind) {
        case Node::Kind::null:
            return "empty";
        case Node::Kind::list:
            return "a list";
        case Node::Kind::map:
            return "a map";
        case Node::Kind::scalar:
            break;
    }
    return "`" + shown(node.text) + "`" + (node.quoted ? " in quotes" : "");
}

void fail(Node const& at, std::string const& what, std::string const& remedy) {
    throw InputError(what, at.where(), remedy);
}

void fail_at(Node const& at, char const* noun, std::int64_t body, std::string const& what,
             std::string const& remedy) {
    throw InputError(what, at.where(noun, body), remedy);
}

void fail_later(Node const& at, std::string const& feature) {
    throw not_in_this_version(fmt::format("{} ({})", feature, at.where()));
}

}  // namespace catena::scene
