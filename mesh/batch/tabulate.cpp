#include "mesh/batch/tabulate.h"

#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <set>

#include <nlohmann/json.hpp>

#include "mesh/batch/columns.h"
#include "mesh/batch/read_many.h"
#include "mesh/batch/records.h"

namespace prismesh::mesh::batch {

namespace {

/// As the plan names a file: two may have the same name in different folders.
std::string as_named(const std::filesystem::path& file, const Study& study) {
  const std::filesystem::path relative = file.lexically_relative(study.plan_file.parent_path());
  return (relative.empty() || *relative.begin() == ".." ? file : relative).generic_string();
}

/// What became of one variant. Errors: those of Variants::key.
Result<Row> row_of(const Study& study, const Variants& variants, const Store& store, std::size_t number) {
  const Variant variant = variants.at(number);
  Result<std::string> key = variants.key(variant);
  if (!key) return fail(key.error());
  Row row;
  row.number = number + 1;
  row.key = std::move(*key);
  row.deck = as_named(study.decks[variant.deck].path, study);
  row.script = as_named(study.scripts[variant.script].file, study);
  row.values = variant.values;
  if (store.has(row.key)) {
    Result<VariantResult> result = store.result_of(row.key);
    if (result) {
      row.state = result->outcome == Outcome::done ? RowState::done : RowState::refused;
      row.reason = result->reason;
      row.result = std::move(*result);
    } else {
      row.state = RowState::failed;
      row.reason = result.error().text() + "; the next start works it again";
    }
  } else if (const std::optional<Failure> failure = store.failure_of(row.key)) {
    row.state = RowState::failed;
    row.reason = failure->reason;
  }
  return row;
}

}  // namespace

Result<Table> tabulate(const Study& study, const Store& store) {
  const Variants variants(study);
  Table table;
  table.name = study.plan.name;
  table.plan_file = study.plan_file.filename().string();
  for (const Parameter& parameter : study.plan.parameters) table.parameters.push_back(parameter.name);
  table.rows.resize(variants.count());
  std::map<std::size_t, Error> errors;  // by number: the first one is told, whoever meets it first
  std::mutex locked;
  read_many(variants.count(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t number = begin; number < end; ++number) {
      Result<Row> row = row_of(study, variants, store, number);
      if (row) {
        table.rows[number] = std::move(*row);
        continue;
      }
      const std::lock_guard lock(locked);
      errors.emplace(number, std::move(row.error()));
    }
  });
  if (!errors.empty()) return fail(std::move(errors.begin()->second));
  std::set<std::string> units;
  for (const Row& row : table.rows)
    if (row.result) units.insert(row.result->length_unit);
  // Lengths of decks in several units aren't told as if they were of one.
  if (units.size() == 1) table.length_unit = *units.begin();
  return table;
}

namespace {

/// A field of CSV (RFC 4180). A text that a spreadsheet would take for a formula gets an apostrophe before it.
std::string csv_field(std::string text, bool is_text) {
  if (is_text && !text.empty() && std::string_view("=+-@\t\r").find(text[0]) != std::string_view::npos) text.insert(0, 1, '\'');
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

std::string table_csv(const Table& table) {
  std::string out = "variant,state,deck,script";
  for (const std::string& parameter : table.parameters) out += "," + parameter;
  for (const Column& column : columns())
    out += "," + std::string(column.name) + (column.before != nullptr ? "," + std::string(column.name) + "_before" : "");
  out += ",reason,file\r\n";
  for (const Row& row : table.rows) {
    out += std::to_string(row.number) + "," + std::string(name(row.state)) + "," + csv_field(row.deck, true) + "," +
           csv_field(row.script, true);
    for (const ParameterValue& value : row.values) out += "," + csv_field(words(value), std::holds_alternative<std::string>(value));
    const auto add = [&](const std::optional<double>& figure) { out += "," + (figure ? words(*figure) : std::string()); };
    for (const Column& column : columns()) {
      add(figure_of(column, row));
      if (column.before != nullptr) add(figure_before(column, row));
    }
    out += "," + csv_field(row.reason, true) + "," + csv_field(written_file(row), true) + "\r\n";
  }
  return out;
}

std::string table_json(const Table& table) {
  using Ordered = nlohmann::ordered_json;
  const auto text_of = [](const Ordered& json) { return json.dump(1, ' ', false, Ordered::error_handler_t::replace); };
  const Ordered head{{"study", table.name},
                     {"plan", table.plan_file},
                     {"length_unit", table.length_unit.empty() ? Ordered(nullptr) : Ordered(table.length_unit)},
                     {"variants", table.rows.size()},
                     {"done", table.count(RowState::done)},
                     {"refused", table.count(RowState::refused)},
                     {"failed", table.count(RowState::failed)},
                     {"missing", table.count(RowState::missing)}};
  std::string out = text_of(head);
  out.resize(out.size() - 2);  // without the brace, on a line of its own
  out += ",\n \"rows\": [";
  // row by row: as one object a large study takes several times the memory of its text
  for (const Row& row : table.rows) {
    Ordered values = Ordered::object();
    for (std::size_t p = 0; p < row.values.size(); ++p)
      std::visit([&](const auto& value) { values[table.parameters[p]] = value; }, row.values[p]);
    Ordered entry{
        {"variant", row.number}, {"state", name(row.state)}, {"deck", row.deck}, {"script", row.script}, {"values", std::move(values)}};
    const auto add = [&](const std::string& field, const std::optional<double>& figure) {
      entry[field] = figure ? Ordered(*figure) : Ordered(nullptr);
    };
    for (const Column& column : columns()) {
      add(std::string(column.name), figure_of(column, row));
      if (column.before != nullptr) add(std::string(column.name) + "_before", figure_before(column, row));
    }
    entry["reason"] = row.reason.empty() ? Ordered(nullptr) : Ordered(row.reason);
    entry["length_unit"] = row.result ? Ordered(row.result->length_unit) : Ordered(nullptr);
    const std::string file = written_file(row);
    entry["file"] = file.empty() ? Ordered(nullptr) : Ordered(file);
    entry["notes"] = row.result ? Ordered(row.result->notes) : Ordered::array();
    entry["key"] = row.key;
    out += &row == table.rows.data() ? "\n  " : ",\n  ";
    for (const char c : text_of(entry)) {
      out += c;
      if (c == '\n') out += "  ";
    }
  }
  return out + (table.rows.empty() ? "]\n}\n" : "\n ]\n}\n");
}

}  // namespace prismesh::mesh::batch
