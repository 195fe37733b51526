#include "python/document.h"

#include <utility>
#include <vector>

#include <pybind11/stl.h>
#include <nlohmann/json.hpp>

#include "base/clock.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/edit_json.h"
#include "mesh/document/open.h"
#include "mesh/document/prepare.h"
#include "mesh/document/save.h"
#include "mesh/report/check_figures.h"
#include "mesh/report/json.h"
#include "mesh/report/printable.h"
#include "mesh/select/expression.h"
#include "python/errors.h"
#include "python/json_values.h"
#include "python/long_work.h"

namespace prismesh::python {

namespace {

namespace py = pybind11;
namespace document = mesh::document;

/// Frees what a document no longer needs without the GIL: old states may be large.
void free_unlocked(std::optional<document::Document>& old) {
  const py::gil_scoped_release released;
  old.reset();
}

/// The edit's name with fields, an object, or an object and fields.
document::Edit edit_of(const py::object& edit, const py::kwargs& fields) {
  py::dict object;
  if (py::isinstance<py::str>(edit))
    object["edit"] = edit;
  else if (py::isinstance<py::dict>(edit))
    object = py::dict(edit.attr("copy")());
  else
    throw py::type_error("an edit is its name with fields, or a dict with the field \"edit\"");
  for (const auto& [key, value] : fields) {
    if (object.contains(key)) raise(Error{{}, 0, "the edit has the field \"" + std::string(py::str(key)) + "\" twice"});
    object[key] = value;
  }
  return value_or_raise(document::edit_from_json(to_json(object)));
}

/// A number, "part" or "deck".
document::TargetSize target_size_of(py::handle value) {
  if (!py::isinstance<py::str>(value)) return py::cast<double>(value);
  return value_or_raise(document::parse_target_size(py::cast<std::string>(value)));
}

/// For all parts, or a dict that says it for expressions of parts.
void add_rules(const py::object& given, const auto& rule_of, std::vector<document::JudgingRule>& rules) {
  if (given.is_none()) return;
  if (!py::isinstance<py::dict>(given)) {
    rules.push_back(rule_of(given));
    return;
  }
  for (const auto& [parts, value] : py::reinterpret_borrow<py::dict>(given)) {
    document::JudgingRule rule = rule_of(value);
    if (!parts.is_none()) rule.on = py::cast<std::string>(parts);
    rules.push_back(std::move(rule));
  }
}

std::unique_ptr<ScriptedDocument> open(const py::object& path, const std::optional<std::string>& length_unit, const py::object& target_size,
                                       const py::object& criteria, py::object progress) {
  const std::filesystem::path deck = path_bytes(path);
  document::OpenOptions options;
  if (length_unit) {
    options.length_unit = length_unit_from(*length_unit);
    if (!options.length_unit) raise(Error{{}, 0, "the length unit must be mm, m or in, not \"" + *length_unit + "\""});
  }
  const auto size_rule = [](py::handle value) {
    document::JudgingRule rule;
    rule.target_size = target_size_of(value);
    return rule;
  };
  const auto criteria_rule = [](py::handle value) {
    document::JudgingRule rule;
    rule.criteria = path_bytes(value);
    return rule;
  };
  add_rules(target_size, size_rule, options.rules);
  add_rules(criteria, criteria_rule, options.rules);
  LongWork work(std::move(progress));
  Result<document::Document> opened = work.run([&](const Progress& shown) {
    options.progress = shown;
    return document::open(deck, options);
  });
  work.raise_what_stopped_it();
  if (!opened && opened.error().file.empty()) opened.error().file = deck.string();
  return std::make_unique<ScriptedDocument>(value_or_raise(std::move(opened)));
}

py::dict save_report(const mesh::deck::SaveReport& saved) {
  py::dict report;
  report["lines_changed"] = saved.lines_changed;
  report["nodes_written"] = saved.nodes_written;
  report["nodes_added"] = saved.nodes_added;
  report["nodes_removed"] = saved.nodes_removed;
  report["shells_changed"] = saved.shells_changed;
  report["shells_added"] = saved.shells_added;
  report["shells_removed"] = saved.shells_removed;
  py::list files, notes;
  for (const std::filesystem::path& file : saved.files_written) files.append(path_text(file.string()));
  for (const std::string& note : saved.notes) notes.append(mesh::report::printable(note));
  report["files_written"] = files;
  report["notes"] = notes;
  return report;
}

}  // namespace

const document::Document& ScriptedDocument::opened() const {
  if (!document_) raise(Error{{}, 0, "the document is closed; open the deck again"});
  return *document_;
}

void ScriptedDocument::close() {
  if (busy_) raise(Error{document_->path.string(), 0, "the document is being edited and can't be closed"});
  std::optional<document::Document> old = std::move(document_);
  document_.reset();
  free_unlocked(old);
}

py::object ScriptedDocument::edit(const py::object& edit, py::object progress, const py::kwargs& fields) {
  opened();
  const document::Edit wanted = edit_of(edit, fields);
  if (busy_)
    raise(Error{document_->path.string(), 0,
                "the document is being edited already, by another thread or by the edit that this progress function belongs to"});
  LongWork work(std::move(progress));
  const auto not_busy = [this](void*) { busy_ = false; };
  busy_ = true;
  const std::unique_ptr<void, decltype(not_busy)> busy(this, not_busy);
  Result<document::Prepared> prepared = work.run([&](const Progress& shown) {
    MonotonicClock clock;
    return document::prepare(*document_, wanted, shown, &clock);
  });
  if (!prepared) {
    work.raise_what_stopped_it();
    raise(prepared.error());
  }
  const document::EditReport report = prepared->report;
  document::commit(*document_, std::move(*prepared));
  work.raise_what_stopped_it();  // a repair that keeps what it had reached
  return to_python(mesh::report::edit_object(report));
}

py::object ScriptedDocument::check(const std::optional<std::string>& select, bool chordal) const {
  const document::Document held = opened();
  const auto figures = [&]() -> Result<nlohmann::ordered_json> {
    const py::gil_scoped_release released;
    const document::Generation& current = held.current();
    mesh::ShellSet shells;
    if (select) {
      Result<mesh::select::Chosen> chosen =
          mesh::select::evaluate(current.model, *select, mesh::select::EntityKind::element, current.relations->names);
      if (!chosen) return fail(std::move(chosen.error()));
      shells = std::move(chosen->shells);
    }
    return mesh::report::check_object(held, mesh::report::check_figures(held, select ? &shells : nullptr, chordal));
  }();
  if (!figures) raise(figures.error());
  return to_python(*figures);
}

py::object ScriptedDocument::save(const py::object& path, py::object progress) const {
  const document::Document held = opened();
  const std::filesystem::path target = path_bytes(path);
  LongWork work(std::move(progress));
  Result<mesh::deck::SaveReport> saved = work.run([&](const Progress& shown) { return document::save(held, target, shown); });
  work.raise_what_stopped_it();
  if (!saved && saved.error().file.empty()) saved.error().file = target.string();
  return save_report(value_or_raise(std::move(saved)));
}

State ScriptedDocument::state() const { return {opened().generations[document_->cursor]}; }

void define_document(py::module_& module) {
  py::class_<ScriptedDocument>(module, "Document")
      .def("edit", &ScriptedDocument::edit, py::arg("edit"), py::pos_only(), py::kw_only(), py::arg("progress") = py::none())
      .def(
          "select",
          [](ScriptedDocument& self, const py::str& expr, const py::str& kind, const py::str& mode) {
            py::kwargs fields;
            fields["expr"] = expr;
            fields["kind"] = kind;
            fields["mode"] = mode;
            return self.edit(py::str("select"), py::none(), fields);
          },
          py::arg("expr"), py::arg("kind") = "node", py::arg("mode") = "set")
      .def("check", &ScriptedDocument::check, py::arg("select") = py::none(), py::kw_only(), py::arg("chordal") = false)
      .def("info", [](const ScriptedDocument& self) { return to_python(mesh::report::info_object(self.opened())); })
      .def("save", &ScriptedDocument::save, py::arg("path"), py::kw_only(), py::arg("progress") = py::none())
      .def("close", &ScriptedDocument::close)
      .def("__enter__", [](py::object self) { return self; })
      .def("__exit__", [](ScriptedDocument& self, const py::args&) { self.close(); })
      .def_property_readonly("closed", &ScriptedDocument::is_closed)
      .def_property_readonly("path", [](const ScriptedDocument& self) { return path_text(self.opened().path.string()); })
      .def_property_readonly("can_undo", [](const ScriptedDocument& self) { return self.opened().can_undo(); })
      .def_property_readonly("can_redo", [](const ScriptedDocument& self) { return self.opened().can_redo(); })
      .def_property_readonly("state", &ScriptedDocument::state);
  module.def("open", &open, py::arg("path"), py::kw_only(), py::arg("length_unit") = py::none(), py::arg("target_size") = py::none(),
             py::arg("criteria") = py::none(), py::arg("progress") = py::none());
}

}  // namespace prismesh::python
