// Text for a terminal: headings, named values and tables.
#pragma once

#include <string>
#include <vector>

namespace catena::command {

/// A table whose columns are as wide as their widest cell. The columns listed in `left` are flush
/// left, all others flush right.
class Table {
  public:
    explicit Table(std::vector<std::string> header, std::vector<std::size_t> left = {0})
        : rows_{std::move(header)}, left_(std::move(left)) {}
    /// Adds a row; it has at most as many cells as the header.
    void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
    /// Returns the table as lines of text.
    std::string text(std::string const& indent = "  ") const;
    /// Returns the table as HTML for a page (page/html.hpp).
    std::string html() const;

  private:
    bool is_left(std::size_t column) const;
    std::vector<std::vector<std::string>> rows_;
    std::vector<std::size_t> left_;
};

/// Collects lines of text.
class Text {
  public:
    void heading(std::string const& line) { text_ += line + "\n"; }
    /// Adds "  name        value". An empty name continues the previous value.
    void entry(std::string const& name, std::string const& value);
    /// Adds "  - line".
    void note(std::string const& line) { text_ += "  - " + line + "\n"; }
    void add(Table const& table) { text_ += table.text(); }
    std::string const& str() const { return text_; }

  private:
    std::string text_;
};

/// Returns for example "1.23 ms" or "45.6 us".
std::string duration_text(double seconds);
/// Returns for example "1.5 GB".
std::string bytes_text(double bytes);
/// Returns for example "1 body" or "2 bodies".
std::string counted(long long n, std::string const& one, std::string const& many);

}  // namespace catena::command
