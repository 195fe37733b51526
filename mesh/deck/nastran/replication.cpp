#include "mesh/deck/nastran/replication.h"

#include <algorithm>
#include <charconv>

#include "mesh/deck/nastran/elements.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::nastran {
namespace {

/// "(0.5)" and "0.5" are the same.
std::string_view without_parentheses(std::string_view text) {
  text = trim(text);
  if (!text.empty() && text.front() == '(') text.remove_prefix(1);
  if (!text.empty() && text.back() == ')') text.remove_suffix(1);
  return trim(text);
}

std::string raised(const std::string& text, const std::string& by) {
  std::int64_t whole = 0, whole_by = 0;
  if (text.find('.') == std::string::npos && by.find('.') == std::string::npos && parse_integer(text, whole) && parse_integer(by, whole_by))
    return std::to_string(whole + whole_by);
  double value = 0, value_by = 0;
  if (!parse_real(text, value) || !parse_real(by, value_by)) return text;
  char buffer[40];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value + value_by).ptr;
  std::string out(buffer, end);
  if (out.find_first_of(".e") == std::string::npos) out += '.';
  return out;
}

}  // namespace

bool takes_fields(const Card& card) {
  for (std::size_t f = 0; f < card.size(); ++f) {
    const std::string_view text = card.text(f);
    if (text == "=" || text == "==" || text.starts_with("*(")) return card.name() == "GRID" || element_form(card.name());
  }
  return false;
}

void Replication::set_template(const Card& card) {
  name_ = card.name();
  layout_ = card.layout();
  fields_.assign(card.size(), {});
  for (std::size_t f = 0; f < card.size(); ++f) fields_[f].text = card.text(f);
  has_template_ = true;
  raised_ = false;
}

std::size_t Replication::read(const Card& card) {
  const std::string_view name = card.name();
  if (name != "=" && name != "==") {
    std::int64_t count = 0;
    if (!raised_ || !parse_integer(without_parentheses(name.substr(1)), count) || count < 1) return 0;
    return static_cast<std::size_t>(std::min<std::int64_t>(count, kMaxCopies + 1));
  }
  std::vector<Field> next(std::max(card.size(), fields_.size()));
  bool rest = name == "==";
  for (std::size_t f = 0; f < next.size(); ++f) {
    const std::string_view text = card.text(f);
    const std::string old = f < fields_.size() ? fields_[f].text : std::string();
    if (f % 8 == 0 && f > 0 && f >= card.size()) break;  // a further line is there only if the copy has one
    if (text == "==") rest = true;
    if (rest || text == "=")
      next[f].text = old;
    else if (!text.empty() && text[0] == '*')
      next[f] = {old, std::string(without_parentheses(text.substr(1)))};
    else if (!text.empty() && (text[0] == '%' || text[0] == '='))
      return 0;
    else
      next[f].text = text;
    if (f % 8 == 7 && name != "==") rest = false;
  }
  fields_ = std::move(next);
  raised_ = true;
  return 1;
}

void Replication::make(Card& copy) {
  std::vector<std::string> texts;
  for (Field& field : fields_) {
    if (!field.raise.empty()) field.text = raised(field.text, field.raise);
    texts.push_back(field.text);
  }
  copy.assign(name_, texts, layout_);
}

bool Replication::fill(Card& card) const {
  if (!has_template_ || card.name() != name_) return false;
  std::vector<std::string> texts;
  bool rest = false;
  for (std::size_t f = 0; f < std::max(card.size(), fields_.size()); ++f) {
    if (f % 8 == 0) rest = false;
    if (f % 8 == 0 && f > 0 && f >= card.size()) break;  // a further line is there only if the card has one
    const std::string_view text = card.text(f);
    const std::string old = f < fields_.size() ? fields_[f].text : std::string();
    rest |= text == "==";
    if (rest || text == "=")
      texts.push_back(old);
    else if (text.starts_with("*("))
      texts.push_back(raised(old, std::string(without_parentheses(text.substr(1)))));
    else if (text.starts_with('='))
      return false;
    else
      texts.emplace_back(text);
  }
  card.assign(name_, texts, card.layout());
  return true;
}

Card card_at(std::string_view text, std::size_t offset) {
  CardLines lines;
  lines.read(text, offset);
  Card card;
  card.cut(lines);
  return card;
}

bool is_replicated(std::string_view text, std::size_t offset) {
  if (text[offset] == '=') return true;
  CardLines lines;
  lines.read(text, offset);
  if (lines.next < text.size() && text[lines.next] == '=') return true;
  if (takes_fields(card_at(text, offset))) return true;
  std::size_t next = lines.next;
  while (next < text.size() && kind_of(line_at(text, next).text) == LineKind::comment) next = line_at(text, next).next;
  return next < text.size() && starts_card(line_at(text, next).text) && takes_fields(card_at(text, next));
}

}  // namespace prismesh::mesh::deck::nastran
