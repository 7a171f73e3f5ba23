// Text for a terminal: headings, named values, tables.
#pragma once

#include <string>
#include <vector>

namespace catena::command {

/// Columns as wide as their widest cell; the first is flush left, the others flush right unless
/// `left` says otherwise.
class Table {
  public:
    explicit Table(std::vector<std::string> header, std::vector<std::size_t> left = {0})
        : rows_{std::move(header)}, left_(std::move(left)) {}
    void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
    std::string text(std::string const& indent = "  ") const;
    /// The same for a page (page/html.hpp).
    std::string html() const;

  private:
    bool is_left(std::size_t column) const;
    std::vector<std::vector<std::string>> rows_;
    std::vector<std::size_t> left_;
};

class Text {
  public:
    void heading(std::string const& line) { text_ += line + "\n"; }
    /// "  name        value"; an empty name goes on with the value before.
    void entry(std::string const& name, std::string const& value);
    void note(std::string const& line) { text_ += "  - " + line + "\n"; }
    void add(Table const& table) { text_ += table.text(); }
    std::string const& str() const { return text_; }

  private:
    std::string text_;
};

/// "1.23 ms", "45.6 us"
std::string duration_text(double seconds);
/// "1.5 GB"
std::string bytes_text(double bytes);
/// "1 body", "2 bodies"
std::string counted(long long n, std::string const& one, std::string const& many);

}  // namespace catena::command
