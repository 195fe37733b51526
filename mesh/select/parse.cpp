#include "mesh/select/parse.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <string>
#include <system_error>
#include <utility>

#include "base/nearest_name.h"

namespace prismesh::mesh::select {

namespace {

struct ClassName {
  std::string_view name;
  ItemClass item_class;
};
constexpr std::array<ClassName, 10> kClassNames{{{"node", ItemClass::node},
                                                 {"part", ItemClass::part},
                                                 {"shell", ItemClass::shell},
                                                 {"element", ItemClass::shell},
                                                 {"beam", ItemClass::beam},
                                                 {"solid", ItemClass::solid},
                                                 {"tshell", ItemClass::tshell},
                                                 {"discrete", ItemClass::discrete},
                                                 {"mass", ItemClass::mass},
                                                 {"sph", ItemClass::sph}}};
constexpr std::string_view kAll = "all";

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

std::string lower(std::string_view word) {
  std::string out(word);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

/// A character as it can be shown in a message.
std::string shown(char c) {
  if (std::isprint(static_cast<unsigned char>(c)) != 0) return std::string("'") + c + "'";
  constexpr std::string_view kDigits = "0123456789abcdef";
  const auto byte = static_cast<unsigned char>(c);
  return std::string("the byte \\x") + kDigits[byte >> 4] + kDigits[byte & 15];
}

class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  Result<std::vector<Item>> run() {
    std::vector<Item> items;
    skip_spaces();
    if (at_end()) return fail("expression", 1, "the expression is empty: write ids such as 1-100,205 or all");
    while (true) {
      Result<Item> item = read_item();
      if (!item) return fail(std::move(item.error()));
      items.push_back(*item);
      skip_spaces();
      if (at_end()) return items;
      if (text_[at_] != ',') return error("unexpected " + shown(text_[at_]) + ": items are separated by commas");
      ++at_;
    }
  }

 private:
  bool at_end() const { return at_ >= text_.size(); }
  bool at(char c) const { return !at_end() && text_[at_] == c; }
  void skip_spaces() {
    while (!at_end() && is_space(text_[at_])) ++at_;
  }
  tl::unexpected<Error> error_at(std::size_t place, std::string message) const {
    return fail("expression", static_cast<long>(place + 1), std::move(message));
  }
  tl::unexpected<Error> error(std::string message) const { return error_at(at_, std::move(message)); }

  /// Takes `c` and the spaces around it.
  bool take(char c) {
    skip_spaces();
    if (!at(c)) return false;
    ++at_;
    skip_spaces();
    return true;
  }

  Result<Item> read_item() {
    Item item;
    skip_spaces();
    item.remove = take('!');
    const std::size_t begin = at_;
    item.column = begin + 1;
    if (!at_end() && is_letter(text_[at_])) {
      const auto word = read_word(item);
      if (!word) return fail(word.error());
    }
    if (!item.all) {
      const auto ids = read_ids(item);
      if (!ids) return fail(ids.error());
    }
    std::size_t end = at_;
    while (end > begin && is_space(text_[end - 1])) --end;
    item.text = text_.substr(begin, end - begin);
    return item;
  }

  /// `all`, or a class and its colon, which `all` may follow.
  Result<void> read_word(Item& item) {
    const std::size_t begin = at_;
    const std::string word = take_word();
    if (word == kAll) {
      item.all = true;
      return {};
    }
    const auto known = std::find_if(kClassNames.begin(), kClassNames.end(), [&](const ClassName& c) { return c.name == word; });
    if (known == kClassNames.end()) return unknown_word(begin, word);
    item.item_class = known->item_class;
    if (!take(':')) return error("a colon and an id must follow \"" + word + "\", as in " + word + ":3");
    if (at_end() || !is_letter(text_[at_])) return {};
    const std::size_t second = at_;
    const std::string after = take_word();
    if (after != kAll) return error_at(second, "an id or all must follow \"" + word + ":\", not \"" + after + "\"");
    item.all = true;
    return {};
  }

  std::string take_word() {
    const std::size_t begin = at_;
    while (!at_end() && is_letter(text_[at_])) ++at_;
    return lower(text_.substr(begin, at_ - begin));
  }

  Result<void> unknown_word(std::size_t place, const std::string& word) const {
    std::array<std::string_view, kClassNames.size() + 1> known;
    std::transform(kClassNames.begin(), kClassNames.end(), known.begin(), [](const ClassName& c) { return c.name; });
    known.back() = kAll;
    return error_at(place, "unknown word \"" + word.substr(0, 40) + "\"; did you mean \"" + std::string(nearest_name(word, known)) + "\"?");
  }

  Result<void> read_ids(Item& item) {
    const std::size_t begin = at_;
    if (auto read = read_number(item.first, "an id"); !read) return read;
    item.last = item.first;
    if (take('-')) {
      if (auto read = read_number(item.last, "the range's last id"); !read) return read;
      if (item.last < item.first)
        return error_at(begin, "the range runs backwards: write " + std::to_string(item.last) + "-" + std::to_string(item.first));
      if (!take(':')) return {};
      const std::size_t place = at_;
      if (auto read = read_number(item.step, "the range's step"); !read) return read;
      if (item.step == 0) return error_at(place, "a range's step must be at least 1");
    } else if (at(':')) {
      return error("a step needs a range, as in 1-1000:10");
    }
    return {};
  }

  Result<void> read_number(std::int64_t& out, std::string_view what) {
    if (at_end()) return error("the expression ends where " + std::string(what) + " should stand");
    if (!is_digit(text_[at_])) return error("unexpected " + shown(text_[at_]) + " where " + std::string(what) + " should stand");
    const std::size_t begin = at_;
    while (!at_end() && is_digit(text_[at_])) ++at_;
    const auto read = std::from_chars(text_.data() + begin, text_.data() + at_, out);
    if (read.ec == std::errc::result_out_of_range) return error_at(begin, "the number is too large: ids end at 9223372036854775807");
    return {};
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

std::string_view name(ItemClass item_class) {
  for (const ClassName& known : kClassNames)
    if (known.item_class == item_class) return known.name;
  return "in hand";
}

Result<std::vector<Item>> parse(std::string_view expression) { return Parser(expression).run(); }

}  // namespace prismesh::mesh::select
