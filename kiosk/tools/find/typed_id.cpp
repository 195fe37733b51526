#include "kiosk/tools/find/typed_id.h"

#include <array>
#include <charconv>
#include <string>
#include <utility>

#include "base/letter_case.h"

namespace prismesh::kiosk::tools::find {

std::optional<TypedId> typed_id(std::string_view text) {
  std::string word;
  std::size_t at = 0;
  for (; at < text.size() && (text[at] < '0' || text[at] > '9'); ++at) {
    const char c = text[at];
    if (c == ' ' || c == ':' || c == '#' || c == '=') continue;
    word += lower(c);
  }
  using Kind = TypedId::Kind;
  constexpr std::array<std::pair<std::string_view, Kind>, 10> kKinds{{{"", Kind::any},
                                                                      {"id", Kind::any},
                                                                      {"n", Kind::node},
                                                                      {"node", Kind::node},
                                                                      {"s", Kind::shell},
                                                                      {"e", Kind::shell},
                                                                      {"shell", Kind::shell},
                                                                      {"element", Kind::shell},
                                                                      {"p", Kind::part},
                                                                      {"part", Kind::part}}};
  for (const auto& [name, kind] : kKinds) {
    if (word != name) continue;
    TypedId found{kind, 0};
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), found.id);
    const bool all =
        error == std::errc() && text.substr(static_cast<std::size_t>(end - text.data())).find_first_not_of(' ') == std::string_view::npos;
    return all ? std::optional(found) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace prismesh::kiosk::tools::find
