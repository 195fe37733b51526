#include "mesh/deck/lsdyna/parameters.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <set>

#include "base/letter_case.h"
#include "mesh/deck/lsdyna/card_fields.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

constexpr int kMaxExpressionDepth = 64;
constexpr std::size_t kMaxExpressionLength = 1 << 20;

/// "R  tEnd" is the real parameter "tend", "rtbumper" is "tbumper".
struct TypedName {
  char type = 0;  ///< 'r', 'i', 'c'; 0: neither
  std::string name;
};

TypedName typed_name(std::string_view field) {
  field = trim(field);
  if (field.empty()) return {};
  const std::string type = lower(field.substr(0, 1));
  if (type != "r" && type != "i" && type != "c") return {};
  return {type[0], lower(trim(field.substr(1)))};
}

bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

}  // namespace

const Parameters::Value* Parameters::find(const Table& table, std::string_view key, std::uint32_t version) {
  const auto at = table.find(key);
  if (at == table.end()) return nullptr;
  const std::vector<Value>& values = at->second;
  const auto after =
      std::upper_bound(values.begin(), values.end(), version, [](std::uint32_t v, const Value& value) { return v < value.version; });
  return after == values.begin() || !std::prev(after)->defined ? nullptr : &*std::prev(after);
}

const Parameters::Value* Parameters::find_value(std::string_view name) const {
  const std::string key = lower(name);
  const Value* value = find(history_->tables[static_cast<std::size_t>(Scope::local)], key, version_);
  if (!value) value = find(history_->tables[static_cast<std::size_t>(Scope::global)], key, version_);
  return value;
}

std::optional<ParameterValue> Parameters::find(std::string_view name) const {
  const Value* value = find_value(name);
  if (!value) ++history_->undefined;
  return value && !value->text ? std::optional(value->number) : std::nullopt;
}

void Parameters::set(Scope scope, const std::string& key, Value value) {
  version_ = ++history_->latest;
  value.version = version_;
  history_->tables[static_cast<std::size_t>(scope)][key].push_back(std::move(value));
  if (scope == Scope::local) history_->local_changes.emplace_back(version_, key);
}

/// "Defined again" applies within one scope: a local parameter hides global ones and those of the files around without a warning.
void Parameters::define(const Definition& definition, const std::string& key, Value value) {
  if (key.empty()) return;
  const Value* before = find(history_->tables[static_cast<std::size_t>(definition.scope)], key, version_);
  value.depth = depth_;
  value.is_mutable = definition.is_mutable;
  if (before && (definition.scope == Scope::global || before->depth == depth_)) {
    value.is_mutable = before->is_mutable;
    const bool same = before->text == value.text && before->number.value == value.number.value;
    if (!before->is_mutable && !same) {
      const int flag = history_->duplication;
      const bool takes_new = flag == 2 || flag == 4;
      if (flag != 4 && flag != 5)
        definition.problems->push_back({definition.offset, "duplicate-parameter",
                                        "parameter " + key + " is defined again; its " + (takes_new ? "new" : "first") + " value counts"});
      if (!takes_new) return;
    }
  }
  set(definition.scope, key, std::move(value));
}

void Parameters::leave_file(const Parameters& before) {
  const auto first = std::upper_bound(history_->local_changes.begin(), history_->local_changes.end(), before.version_,
                                      [](std::uint32_t version, const auto& change) { return version < change.first; });
  std::set<std::string> keys;
  for (auto change = first; change != history_->local_changes.end(); ++change) keys.insert(change->second);
  const Table& table = history_->tables[static_cast<std::size_t>(Scope::local)];
  for (const std::string& key : keys) {
    const Value* old = find(table, key, before.version_);
    Value value = old ? *old : Value();
    value.defined = old != nullptr;
    set(Scope::local, key, std::move(value));
  }
  depth_ = before.depth_;
}

void Parameters::read(std::string_view text, const Block& block, std::vector<ParameterProblem>& problems) {
  const auto has = [&](std::string_view option) { return block.name.find(option) != std::string::npos; };
  if (has("_DUPLICATION")) {
    Lines lines(text, block.begin, block.end);
    Line line;
    CardFields card;
    if (!lines.next(line) || history_->duplication != 0) return;
    card.cut(line.text, block.columns);
    history_->duplication = static_cast<int>(std::clamp<std::int64_t>(integer(card.text(0)).value_or(1), 1, 5));
    return;
  }
  const Definition definition{has("_LOCAL") ? Scope::local : Scope::global, has("_MUTABLE"), 0, &problems};
  if (has("_EXPRESSION"))
    read_expressions(text, block, definition);
  else
    read_definitions(text, block, definition);
}

std::optional<double> Parameters::real(std::string_view field) const {
  double value = 0;
  if (parse_real(field, value)) return value;
  field = trim(field);
  const bool negative = field.size() > 1 && field[0] == '-';
  if (negative || (field.size() > 1 && field[0] == '+')) field = trim(field.substr(1));
  if (field.empty()) return std::nullopt;
  std::optional<ParameterValue> found;
  if (field.front() == '&')
    found = find(trim(field.substr(1)));
  else if (field.front() == '<' && field.back() == '>')
    found = evaluate(field.substr(1, field.size() - 2), *this);
  if (!found) return std::nullopt;
  return negative ? -found->value : found->value;
}

std::optional<std::int64_t> Parameters::integer(std::string_view field) const {
  std::int64_t value = 0;
  if (parse_integer(field, value)) return value;
  const std::optional<double> found = real(field);
  if (!found || std::abs(*found) >= 1e18) return std::nullopt;
  return static_cast<std::int64_t>(std::llround(*found));
}

std::string Parameters::put_into_text(std::string_view text) const {
  std::string out;
  while (!text.empty()) {
    std::size_t length = 1;
    if (text.front() == '&') {
      while (length < text.size() && is_name(text[length])) ++length;
      // The longest known name counts: the text behind it needs no separator.
      for (std::size_t l = length; l > 1; --l) {
        const Value* value = find_value(text.substr(1, l - 1));
        if (!value || (!value->text && !value->number.whole)) continue;
        out += value->text ? *value->text : std::to_string(static_cast<std::int64_t>(value->number.value));
        text.remove_prefix(l);
        length = 0;
        break;
      }
    }
    out += text.substr(0, length);
    text.remove_prefix(length);
  }
  return out;
}

void Parameters::define(const Definition& definition, std::string_view field, std::string_view text) {
  const TypedName typed = typed_name(field);
  if (typed.name.empty()) {
    if (!field.empty())
      definition.problems->push_back(
          {definition.offset, "bad-parameter",
           "a parameter's name begins with R, I or C for its type; " + std::string(field.substr(0, 20)) + " is left out"});
    return;
  }
  Value value;
  if (typed.type == 'c') {
    value.text = std::string(text);
  } else if (const std::optional<double> number = real(text)) {
    value.number = {typed.type == 'i' ? std::trunc(*number) : *number, typed.type == 'i' && std::abs(*number) < 1e18};
  } else {
    definition.problems->push_back(
        {definition.offset, "bad-parameter", "the value of parameter " + typed.name + " is no number; the parameter stays undefined"});
    return;
  }
  define(definition, typed.name, std::move(value));
}

void Parameters::read_definitions(std::string_view text, const Block& block, Definition definition) {
  // *PARAMETER_TYPE has one a card, and behind it what kind of id it is.
  const bool one_a_card = block.name.find("_TYPE") != std::string::npos;
  Lines lines(text, block.begin, block.end);
  Line line;
  CardFields card;
  while (lines.next(line)) {
    card.cut(line.text, block.columns);
    definition.offset = line.offset;
    for (std::size_t f = 0; f + 1 < (one_a_card ? std::min<std::size_t>(card.count(), 2) : card.count()); f += 2)
      define(definition, card.text(f), card.text(f + 1));
  }
}

void Parameters::read_expressions(std::string_view text, const Block& block, Definition definition) {
  const auto width = static_cast<std::size_t>(field_width(10, block.columns));
  Lines lines(text, block.begin, block.end);
  Line line;
  TypedName name;
  std::string expression;
  const auto finish = [&] {
    if (name.name.empty()) return;
    Value value;
    if (name.type == 'c') {
      value.text = expression;
    } else if (const std::optional<ParameterValue> number = evaluate(expression, *this)) {
      value.number = *number;
      value.number.whole = name.type == 'i' && std::abs(number->value) < 1e18;
      if (name.type == 'i') value.number.value = std::trunc(number->value);
    } else {
      definition.problems->push_back({definition.offset, "bad-parameter",
                                      "the expression of parameter " + name.name + " can't be evaluated; the parameter stays undefined"});
      return;
    }
    define(definition, name.name, std::move(value));
  };
  while (lines.next(line)) {
    if (trim(line.text).empty()) continue;
    const std::string_view head = line.text.substr(0, width);
    const std::size_t comma = head.find(',');
    const bool free = comma != std::string_view::npos;
    const std::string_view body = line.text.substr(free ? comma + 1 : head.size());
    // A line whose name is blank goes on with the expression above it.
    if (!free && trim(head).empty()) {
      if (expression.size() < kMaxExpressionLength) expression += trim(body);
      continue;
    }
    finish();
    name = typed_name(free ? head.substr(0, comma) : head);
    definition.offset = line.offset;
    expression = trim(body);
  }
  finish();
}

namespace {

/// Recursive descent. `depth` limits the stack that nested parentheses can use.
class Evaluator {
 public:
  Evaluator(std::string_view text, const Parameters& parameters) : text_(text), parameters_(parameters) {}

  std::optional<ParameterValue> run() {
    const Number value = sum();
    skip_blanks();
    if (failed_ || at_ != text_.size() || !std::isfinite(value.value)) return std::nullopt;
    return value;
  }

 private:
  using Number = ParameterValue;

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
  Number give_up() {
    failed_ = true;
    at_ = text_.size();
    return {};
  }

  Number sum() {
    Number value = product();
    while (!failed_) {
      if (take("+")) {
        const Number next = product();
        value = {value.value + next.value, value.whole && next.whole};
      } else if (take("-")) {
        const Number next = product();
        value = {value.value - next.value, value.whole && next.whole};
      } else {
        break;
      }
    }
    return value;
  }
  Number product() {
    Number value = power();
    while (!failed_) {
      if (!ahead("**") && take("*")) {
        const Number next = power();
        value = {value.value * next.value, value.whole && next.whole};
      } else if (take("/")) {
        const Number next = power();
        const bool whole = value.whole && next.whole;
        value = {whole ? std::trunc(value.value / next.value) : value.value / next.value, whole};
      } else {
        break;
      }
    }
    return value;
  }
  Number power() {
    if (++depth_ > kMaxExpressionDepth) return give_up();
    Number value = signed_atom();
    if (!failed_ && take("**")) {
      const Number exponent = power();
      value = {std::pow(value.value, exponent.value), value.whole && exponent.whole && exponent.value >= 0};
    }
    --depth_;
    return value;
  }
  Number signed_atom() {
    bool negative = false;
    for (;;) {
      if (take("-"))
        negative = !negative;
      else if (!take("+"))
        break;
    }
    Number value = atom();
    if (negative) value.value = -value.value;
    return value;
  }
  Number atom() {
    skip_blanks();
    if (take("(")) {
      const Number value = sum();
      return take(")") ? value : give_up();
    }
    take("&");
    const std::size_t begin = at_;
    if (at_ < text_.size() && (std::isdigit(static_cast<unsigned char>(text_[at_])) || text_[at_] == '.')) return number();
    while (at_ < text_.size() && is_name(text_[at_])) ++at_;
    const std::string name = lower(text_.substr(begin, at_ - begin));
    if (name.empty()) return give_up();
    if (take("(")) return call(name);
    const std::optional<Number> value = name == "pi" ? std::optional(Number{3.14159265358979323846, false}) : parameters_.find(name);
    return value ? *value : give_up();
  }
  Number number() {
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
    const std::string_view digits_text = text_.substr(begin, at_ - begin);
    Number value;
    value.whole = digits_text.find_first_not_of("0123456789") == std::string_view::npos;
    return parse_real(digits_text, value.value) ? value : give_up();
  }

  Number call(const std::string& name) {
    if (++depth_ > kMaxExpressionDepth) return give_up();
    std::vector<Number> arguments{sum()};
    while (!failed_ && take(",")) arguments.push_back(sum());
    --depth_;
    if (failed_ || !take(")")) return give_up();
    return arguments.size() == 1 ? call(name, arguments[0]) : call(name, arguments);
  }
  Number call(const std::string& name, const std::vector<Number>& arguments) {
    const bool whole = std::all_of(arguments.begin(), arguments.end(), [](const Number& n) { return n.whole; });
    const double a = arguments[0].value;
    const double b = arguments[1].value;
    if (name == "min" || name == "max") {
      double out = a;
      for (const Number& n : arguments) out = name == "min" ? std::fmin(out, n.value) : std::fmax(out, n.value);
      return {out, whole};
    }
    if (arguments.size() != 2) return give_up();
    if (name == "mod") return {std::fmod(a, b), whole};
    if (name == "sign") return {std::copysign(std::abs(a), b), whole};
    if (name == "dim") return {std::fmax(a - b, 0), whole};
    if (name == "atan2") return {std::atan2(a, b), false};
    return give_up();
  }
  Number call(const std::string& name, const Number& a) {
    struct Function {
      std::string_view name;
      double (*function)(double);
      bool whole;  ///< the result
    };
    static constexpr Function kFunctions[] = {
        {"sqrt", std::sqrt, false},   {"int", std::trunc, true},   {"aint", std::trunc, false},  {"nint", std::round, true},
        {"anint", std::round, false}, {"floor", std::floor, true}, {"ceiling", std::ceil, true}, {"ceil", std::ceil, true},
        {"sin", std::sin, false},     {"cos", std::cos, false},    {"tan", std::tan, false},     {"asin", std::asin, false},
        {"acos", std::acos, false},   {"atan", std::atan, false},  {"sinh", std::sinh, false},   {"cosh", std::cosh, false},
        {"tanh", std::tanh, false},   {"exp", std::exp, false},    {"log", std::log, false},     {"ln", std::log, false},
        {"log10", std::log10, false},
    };
    if (name == "abs") return {std::abs(a.value), a.whole};
    if (name == "float" || name == "real") return {a.value, false};
    for (const Function& f : kFunctions)
      if (name == f.name) return {f.function(a.value), f.whole};
    return give_up();
  }

  std::string_view text_;
  const Parameters& parameters_;
  std::size_t at_ = 0;
  int depth_ = 0;
  bool failed_ = false;
};

}  // namespace

std::optional<ParameterValue> evaluate(std::string_view expression, const Parameters& parameters) {
  return Evaluator(expression, parameters).run();
}

}  // namespace prismesh::mesh::deck::lsdyna
