#include "mesh/select/parse.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <limits>
#include <string>
#include <system_error>
#include <utility>

#include "base/letter_case.h"
#include "base/nearest_name.h"

namespace prismesh::mesh::select {

namespace {

struct ClassName {
  std::string_view name;
  ItemClass item_class;
};
constexpr std::array<ClassName, 23> kClassNames{{{"node", ItemClass::node},
                                                 {"part", ItemClass::part},
                                                 {"shell", ItemClass::shell},
                                                 {"element", ItemClass::shell},
                                                 {"quad", ItemClass::quad},
                                                 {"tri", ItemClass::tri},
                                                 {"beam", ItemClass::beam},
                                                 {"solid", ItemClass::solid},
                                                 {"tshell", ItemClass::tshell},
                                                 {"discrete", ItemClass::discrete},
                                                 {"mass", ItemClass::mass},
                                                 {"sph", ItemClass::sph},
                                                 {"set", ItemClass::set},
                                                 {"node_set", ItemClass::node_set},
                                                 {"shell_set", ItemClass::shell_set},
                                                 {"beam_set", ItemClass::beam_set},
                                                 {"solid_set", ItemClass::solid_set},
                                                 {"tshell_set", ItemClass::tshell_set},
                                                 {"discrete_set", ItemClass::discrete_set},
                                                 {"part_set", ItemClass::part_set},
                                                 {"segment_set", ItemClass::segment_set},
                                                 {"element_set", ItemClass::element_set},
                                                 {"file", ItemClass::file}}};
constexpr std::string_view kAll = "all";
constexpr std::string_view kId = "id";
constexpr std::int64_t kMaxId = std::numeric_limits<std::int64_t>::max();

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

/// A character for a message.
std::string shown(char c) {
  if (std::isprint(static_cast<unsigned char>(c)) != 0) return std::string("'") + c + "'";
  constexpr std::string_view kDigits = "0123456789abcdef";
  const auto byte = static_cast<unsigned char>(c);
  return std::string("the byte \\x") + kDigits[byte >> 4] + kDigits[byte & 15];
}

/// Whether a character ends a name without quotes.
bool ends_name(char c) {
  return is_space(c) || c == ',' || c == '&' || c == '|' || c == '!' || c == '~' || c == '(' || c == ')' || c == '"' || c == '\'';
}

class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  Result<Parsed> run() {
    skip_spaces();
    if (at_end()) return fail("expression", 1, "the expression is empty: write ids such as 1-100,205 or all");
    if (const auto read = read_list(false); !read) return fail(read.error());
    if (at(')')) return error("this ) closes no (");
    if (!at_end()) return error("unexpected " + shown(text_[at_]) + ": items are separated by commas");
    return std::move(parsed_);
  }

 private:
  using Action = Step::Action;

  bool at_end() const { return at_ >= text_.size(); }
  bool at(char c) const { return !at_end() && text_[at_] == c; }
  void skip_spaces() {
    while (!at_end() && is_space(text_[at_])) ++at_;
  }
  tl::unexpected<Error> error_at(std::size_t place, std::string message) const {
    return fail("expression", static_cast<long>(place + 1), std::move(message));
  }
  tl::unexpected<Error> error(std::string message) const { return error_at(at_, std::move(message)); }

  /// Skips `c` and the spaces around it.
  bool take(char c) {
    skip_spaces();
    if (!at(c)) return false;
    ++at_;
    skip_spaces();
    return true;
  }

  void step(Action action, std::size_t item = 0) { parsed_.steps.push_back({action, static_cast<std::uint32_t>(item)}); }

  Result<void> count_operator(std::size_t place) {
    if (++operators_ <= kMaxOperators) return {};
    return error_at(place, "there are more than " + std::to_string(kMaxOperators) + " of & | ~ ( in the expression");
  }

  /// Items divided by commas: each is added to the set of those before it, or removed from it. In parentheses a list that begins with a
  /// removal starts from everything.
  Result<void> read_list(bool nested) {
    for (bool first = true;; first = false) {
      skip_spaces();
      const bool removes = take('!');
      if (first) step(nested && removes ? Action::everything : Action::nothing);
      const std::size_t before = parsed_.steps.size();
      if (const auto read = read_union(); !read) return read;
      if (parsed_.steps.size() == before + 1 && parsed_.steps.back().action == Action::push)
        parsed_.steps.back().action = removes ? Action::take_item : Action::add_item;
      else
        step(removes ? Action::take : Action::add);
      if (!take(',')) return {};
    }
  }

  Result<void> read_union() {
    if (const auto read = read_intersection(); !read) return read;
    for (;;) {
      skip_spaces();
      const std::size_t place = at_;
      if (!take('|')) return {};
      if (const auto counted = count_operator(place); !counted) return counted;
      if (const auto read = read_intersection(); !read) return read;
      step(Action::add);
    }
  }

  Result<void> read_intersection() {
    if (const auto read = read_factor(false); !read) return read;
    for (;;) {
      skip_spaces();
      const std::size_t place = at_;
      if (!take('&')) return {};
      if (const auto counted = count_operator(place); !counted) return counted;
      if (const auto read = read_factor(true); !read) return read;
      step(Action::meet);
    }
  }

  /// `~` is the complement anywhere; `!` only behind an operator: at the beginning of an item it removes the whole item.
  Result<void> read_factor(bool behind_operator) {
    bool complement = false;
    for (skip_spaces(); at('~') || (behind_operator && at('!')); skip_spaces()) {
      if (const auto counted = count_operator(at_); !counted) return counted;
      complement = !complement;
      ++at_;
    }
    const auto read = at('(') ? read_parentheses() : read_item();
    if (!read) return read;
    if (complement) step(Action::complement);
    return {};
  }

  Result<void> read_parentheses() {
    const std::size_t open = at_;
    if (const auto counted = count_operator(open); !counted) return counted;
    if (++depth_ > kMaxParenthesisDepth) return error("parentheses go deeper than " + std::to_string(kMaxParenthesisDepth));
    ++at_;
    if (const auto read = read_list(true); !read) return read;
    if (at_end()) return error("the expression ends where a ) is expected: the ( at column " + std::to_string(open + 1) + " is open");
    if (!at(')')) return error("unexpected " + shown(text_[at_]) + " within parentheses: items are separated by commas");
    ++at_;
    --depth_;
    return {};
  }

  Result<void> read_item() {
    Item item;
    const std::size_t begin = at_;
    item.column = begin + 1;
    const bool has_word = !at_end() && is_letter(text_[at_]);
    if (const Result<void> read = has_word ? read_word(item) : read_ids(item); !read) return read;
    std::size_t end = at_;
    while (end > begin && is_space(text_[end - 1])) --end;
    item.text = text_.substr(begin, end - begin);
    step(Action::push, parsed_.items.size());
    parsed_.items.push_back(std::move(item));
    return {};
  }

  /// `all`, a comparison, or a class with a colon and then `all`, a comparison or a name.
  Result<void> read_word(Item& item) {
    const std::size_t begin = at_;
    const std::string word = take_word();
    if (word == kAll) {
      item.by = Item::By::all;
      return {};
    }
    if (word == kId) return read_comparison(item);
    const auto known = std::find_if(kClassNames.begin(), kClassNames.end(), [&](const ClassName& c) { return c.name == word; });
    if (known == kClassNames.end()) return unknown_word(begin, word);
    item.item_class = known->item_class;
    const bool has_name = is_set(item.item_class) || item.item_class == ItemClass::file || item.item_class == ItemClass::part;
    if (!take(':')) {
      if (item.item_class == ItemClass::file) return error("a colon and a name must follow \"file\", as in file:bumper.k");
      return error("a colon and an id must follow \"" + word + "\", as in " + word + ":3");
    }
    if (has_name && (at('"') || at('\''))) return read_quoted(item);
    if (item.item_class == ItemClass::file) return read_name(item);
    if (at_end() || !is_letter(text_[at_])) return read_ids(item);
    const std::size_t second = at_;
    const std::string after = take_word();
    if (after == kId) {
      std::size_t next = at_;
      while (next < text_.size() && is_space(text_[next])) ++next;
      if (next < text_.size() && (text_[next] == '<' || text_[next] == '>' || text_[next] == '=' || text_[next] == '!'))
        return read_comparison(item);
    }
    if (is_set(item.item_class)) {
      at_ = second;
      return read_name(item);
    }
    if (after != kAll) return error_at(second, "an id or all must follow \"" + word + ":\", not \"" + after.substr(0, 40) + "\"");
    item.by = Item::By::all;
    return {};
  }

  Result<void> read_quoted(Item& item) {
    const std::size_t begin = at_;
    const std::size_t end = text_.find(text_[at_], at_ + 1);
    if (end == std::string_view::npos) return error_at(begin, "the name that begins here has no closing " + shown(text_[begin]));
    item.by = Item::By::name;
    item.name = text_.substr(begin + 1, end - begin - 1);
    at_ = end + 1;
    if (item.name.empty()) return error_at(begin, "there is no name between the quotes");
    return {};
  }

  Result<void> read_name(Item& item) {
    const std::size_t begin = at_;
    while (!at_end() && !ends_name(text_[at_])) ++at_;
    item.by = Item::By::name;
    item.name = text_.substr(begin, at_ - begin);
    if (item.name.empty()) return error(at_end() ? "the expression ends where a name is expected" : "a name is expected here");
    return {};
  }

  std::string take_word() {
    const std::size_t begin = at_;
    while (!at_end() && is_letter(text_[at_])) ++at_;
    return lower(text_.substr(begin, at_ - begin));
  }

  Result<void> unknown_word(std::size_t place, const std::string& word) const {
    std::array<std::string_view, kClassNames.size() + 2> known;
    std::transform(kClassNames.begin(), kClassNames.end(), known.begin(), [](const ClassName& c) { return c.name; });
    known[kClassNames.size()] = kAll;
    known[kClassNames.size() + 1] = kId;
    return error_at(place, "unknown word \"" + word.substr(0, 40) + "\"; did you mean \"" + std::string(nearest_name(word, known)) + "\"?");
  }

  /// "> 5000" and the like, after `id`.
  Result<void> read_comparison(Item& item) {
    skip_spaces();
    const std::size_t place = at_;
    const std::string_view rest = text_.substr(at_);
    std::string_view sign;
    for (const std::string_view known : {"<=", ">=", "!=", "==", "<", ">", "="})
      if (sign.empty() && rest.substr(0, known.size()) == known) sign = known;
    if (sign.empty()) return error("a comparison must follow \"id\", as in id>5000");
    at_ += sign.size();
    skip_spaces();
    std::int64_t id = 0;
    if (auto read = read_number(id, "an id"); !read) return read;
    item.by = Item::By::comparison;
    item.first = std::numeric_limits<std::int64_t>::min();
    item.last = kMaxId;
    if (sign == "<=") item.last = id;
    if (sign == "<") item.last = id - 1;
    if (sign == ">=") item.first = id;
    if (sign == ">" && id == kMaxId) return error_at(place, "no id is greater than " + std::to_string(id));
    if (sign == ">") item.first = id + 1;
    if (sign == "=" || sign == "==") item.first = item.last = id;
    if (sign == "!=") {
      item.by = Item::By::other_ids;
      item.first = item.last = id;
    }
    return {};
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
    if (at_end()) return error("the expression ends where " + std::string(what) + " is expected");
    if (!is_digit(text_[at_])) return error("unexpected " + shown(text_[at_]) + " where " + std::string(what) + " is expected");
    const std::size_t begin = at_;
    while (!at_end() && is_digit(text_[at_])) ++at_;
    const auto read = std::from_chars(text_.data() + begin, text_.data() + at_, out);
    if (read.ec == std::errc::result_out_of_range) return error_at(begin, "the number is too large: ids end at 9223372036854775807");
    return {};
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int depth_ = 0;
  int operators_ = 0;
  Parsed parsed_;
};

}  // namespace

std::string_view name(ItemClass item_class) {
  if (item_class == ItemClass::other) return "other element";
  for (const ClassName& known : kClassNames)
    if (known.item_class == item_class) return known.name;
  return "in hand";
}

Result<Parsed> parse(std::string_view expression) { return Parser(expression).run(); }

}  // namespace prismesh::mesh::select
