#include "mesh/deck/lsdyna/parameters.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <set>

#include "mesh/deck/lsdyna/card.h"
#include "mesh/deck/lsdyna/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

constexpr int kDeepestExpression = 64;

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

/// The name behind the type letter: "R  tEnd" -> "tend", "rtbumper" -> "tbumper". Empty for text parameters.
std::string parameter_name(std::string_view field) {
  field = trim(field);
  if (field.empty()) return {};
  const char type = field.front();
  if (type != 'R' && type != 'r' && type != 'I' && type != 'i') return {};
  return lower(trim(field.substr(1)));
}

}  // namespace

std::optional<double> Parameters::find(const Table& table, std::string_view key, std::uint32_t version) {
  const auto at = table.find(key);
  if (at == table.end()) return std::nullopt;
  const std::vector<Value>& values = at->second;
  const auto after =
      std::upper_bound(values.begin(), values.end(), version, [](std::uint32_t v, const Value& value) { return v < value.version; });
  return after == values.begin() ? std::nullopt : std::prev(after)->value;
}

std::optional<double> Parameters::find(std::string_view name) const {
  const std::string key = lower(name);
  const std::optional<double> local = find(history_->tables[static_cast<std::size_t>(Scope::local)], key, version_);
  return local ? local : find(history_->tables[static_cast<std::size_t>(Scope::global)], key, version_);
}

void Parameters::define(Scope scope, const std::string& key, std::optional<double> value) {
  version_ = ++history_->latest;
  history_->tables[static_cast<std::size_t>(scope)][key].push_back({version_, value});
  if (scope == Scope::local) history_->local_changes.emplace_back(version_, key);
}

void Parameters::leave_file(const Parameters& before) {
  const auto first = std::upper_bound(history_->local_changes.begin(), history_->local_changes.end(), before.version_,
                                      [](std::uint32_t version, const auto& change) { return version < change.first; });
  std::set<std::string> keys;
  for (auto change = first; change != history_->local_changes.end(); ++change) keys.insert(change->second);
  const Table& table = history_->tables[static_cast<std::size_t>(Scope::local)];
  for (const std::string& key : keys) define(Scope::local, key, find(table, key, before.version_));
}

void Parameters::read(std::string_view text, const Block& block) {
  const Scope scope = block.name.find("_LOCAL") != std::string::npos ? Scope::local : Scope::global;
  if (block.name.find("_EXPRESSION") != std::string::npos)
    read_expressions(text, block, scope);
  else
    read_definitions(text, block, scope);
}

std::optional<double> Parameters::real(std::string_view field) const {
  double value = 0;
  if (parse_real(field, value)) return value;
  field = trim(field);
  const bool negative = field.size() > 1 && field[0] == '-';
  if (negative || (field.size() > 1 && field[0] == '+')) field = trim(field.substr(1));
  if (field.empty() || field.front() != '&') return std::nullopt;
  const std::optional<double> found = find(trim(field.substr(1)));
  return found && negative ? std::optional(-*found) : found;
}

std::optional<std::int64_t> Parameters::integer(std::string_view field) const {
  std::int64_t value = 0;
  if (parse_integer(field, value)) return value;
  const std::optional<double> found = real(field);
  if (!found || std::abs(*found) >= 1e18) return std::nullopt;
  return static_cast<std::int64_t>(std::llround(*found));
}

void Parameters::read_definitions(std::string_view text, const Block& block, Scope scope) {
  Lines lines(text, block.begin, block.end);
  Line line;
  Card card;
  while (lines.next(line)) {
    card.cut(line.text, block.columns);
    for (std::size_t f = 0; f + 1 < card.count(); f += 2) {
      const std::string name = parameter_name(card.text(f));
      if (name.empty()) continue;
      if (const std::optional<double> value = card.real(f + 1, *this)) define(scope, name, value);
    }
  }
}

void Parameters::read_expressions(std::string_view text, const Block& block, Scope scope) {
  const auto width = static_cast<std::size_t>(field_width(10, block.columns));
  Lines lines(text, block.begin, block.end);
  Line line;
  std::string name;
  std::string expression;
  const auto finish = [&] {
    if (name.empty()) return;
    if (const std::optional<double> value = evaluate(expression, *this)) define(scope, name, value);
  };
  while (lines.next(line)) {
    if (trim(line.text).empty()) continue;
    const std::string_view head = line.text.substr(0, width);
    const std::size_t comma = head.find(',');
    const bool free = comma != std::string_view::npos;
    const std::string_view body = line.text.substr(free ? comma + 1 : head.size());
    // A line whose name is blank goes on with the expression above it.
    if (!free && trim(head).empty()) {
      expression += trim(body);
      continue;
    }
    finish();
    name = parameter_name(free ? head.substr(0, comma) : head);
    expression = trim(body);
  }
  finish();
}

namespace {

/// Recursive descent; `depth` bounds what hostile parentheses can do to the stack.
class Evaluator {
 public:
  Evaluator(std::string_view text, const Parameters& parameters) : text_(text), parameters_(parameters) {}

  std::optional<double> run() {
    const double value = sum();
    skip_blanks();
    if (failed_ || at_ != text_.size() || !std::isfinite(value)) return std::nullopt;
    return value;
  }

 private:
  void skip_blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }
  bool take(std::string_view symbol) {
    skip_blanks();
    if (text_.substr(at_, symbol.size()) != symbol) return false;
    at_ += symbol.size();
    return true;
  }
  bool ahead(std::string_view symbol) {
    skip_blanks();
    return text_.substr(at_, symbol.size()) == symbol;
  }
  double give_up() {
    failed_ = true;
    at_ = text_.size();
    return 0;
  }

  double sum() {
    double value = product();
    while (!failed_) {
      if (take("+"))
        value += product();
      else if (take("-"))
        value -= product();
      else
        break;
    }
    return value;
  }
  double product() {
    double value = signed_power();
    while (!failed_) {
      if (!ahead("**") && take("*"))
        value *= signed_power();
      else if (take("/"))
        value /= signed_power();
      else
        break;
    }
    return value;
  }
  double signed_power() {
    if (++depth_ > kDeepestExpression) return give_up();
    double value = 0;
    if (take("-"))
      value = -signed_power();
    else if (take("+"))
      value = signed_power();
    else
      value = power();
    --depth_;
    return value;
  }
  double power() {
    const double base = atom();
    return !failed_ && take("**") ? std::pow(base, signed_power()) : base;
  }
  double atom() {
    skip_blanks();
    if (take("(")) {
      const double value = sum();
      return take(")") ? value : give_up();
    }
    take("&");
    const std::size_t begin = at_;
    if (at_ < text_.size() && (std::isdigit(static_cast<unsigned char>(text_[at_])) || text_[at_] == '.')) return number();
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_')) ++at_;
    const std::string name = lower(text_.substr(begin, at_ - begin));
    if (name.empty()) return give_up();
    if (take("(")) return call(name);
    const std::optional<double> value = parameters_.find(name);
    return value ? *value : name == "pi" ? 3.14159265358979323846 : give_up();
  }
  double number() {
    const std::size_t begin = at_;
    const auto digits = [&] {
      while (at_ < text_.size() && (std::isdigit(static_cast<unsigned char>(text_[at_])) || text_[at_] == '.')) ++at_;
    };
    digits();
    if (at_ < text_.size() && std::string_view("eEdD").find(text_[at_]) != std::string_view::npos) {
      ++at_;
      if (at_ < text_.size() && (text_[at_] == '+' || text_[at_] == '-')) ++at_;
      digits();
    }
    double value = 0;
    return parse_real(text_.substr(begin, at_ - begin), value) ? value : give_up();
  }
  double call(const std::string& name) {
    if (++depth_ > kDeepestExpression) return give_up();
    const double a = sum();
    const bool two = take(",");
    const double b = two ? sum() : 0;
    --depth_;
    if (failed_ || !take(")")) return give_up();
    if (two)
      return name == "min"     ? std::fmin(a, b)
             : name == "max"   ? std::fmax(a, b)
             : name == "mod"   ? std::fmod(a, b)
             : name == "sign"  ? std::copysign(a, b)
             : name == "atan2" ? std::atan2(a, b)
                               : give_up();
    if (name == "abs") return std::abs(a);
    if (name == "sqrt") return std::sqrt(a);
    if (name == "int") return std::trunc(a);
    if (name == "nint") return std::round(a);
    if (name == "sin") return std::sin(a);
    if (name == "cos") return std::cos(a);
    if (name == "tan") return std::tan(a);
    if (name == "asin") return std::asin(a);
    if (name == "acos") return std::acos(a);
    if (name == "atan") return std::atan(a);
    if (name == "exp") return std::exp(a);
    if (name == "log") return std::log(a);
    if (name == "log10") return std::log10(a);
    return give_up();
  }

  std::string_view text_;
  const Parameters& parameters_;
  std::size_t at_ = 0;
  int depth_ = 0;
  bool failed_ = false;
};

}  // namespace

std::optional<double> evaluate(std::string_view expression, const Parameters& parameters) {
  return Evaluator(expression, parameters).run();
}

}  // namespace prismesh::mesh::deck::lsdyna
