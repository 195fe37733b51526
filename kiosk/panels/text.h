// Formats numbers, names and paths for panels.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace prismesh::kiosk::panels {

/// "26 048": groups of three, divided by a no-break space.
std::string grouped(std::uint64_t number);

/// The name of a metric as words: "min angle quad".
std::string metric_words(const std::string& name);

/// A length with four significant digits at most and its unit: "12.4 mm", "-0.052 mm".
std::string length_text(double length, std::string_view unit);

/// Valid UTF-8 from any bytes: what isn't becomes \xNN, control characters too.
std::string printable(std::string_view bytes);
/// The same for a text of several lines: line feeds stay.
std::string printable_lines(std::string_view bytes);

/// The text with its middle replaced by an ellipsis so that `width(text)` <= `available`; whole characters are dropped. `width`
/// grows with the text.
std::string elide_middle(const std::string& text, double available, const std::function<double(std::string_view)>& width);

/// The text with line feeds in place of spaces wherever a line would be wider than `available`. Words stay whole, numbers and names among
/// them, however wide they are.
std::string break_at_spaces(std::string_view text, double available, const std::function<double(std::string_view)>& width);

/// The completions of a path that is being typed: the entries of its folder that begin with its last piece, folders with a closing
/// '/', ascending; hidden entries only when the piece begins with '.'. At most `limit`.
std::vector<std::string> completions(const std::string& typed, std::size_t limit);

/// The longest beginning that all completions share.
std::string common_beginning(const std::vector<std::string>& texts);

}  // namespace prismesh::kiosk::panels
