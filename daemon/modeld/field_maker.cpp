#include "daemon/modeld/field_maker.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "mesh/deck/open.h"
#include "mesh/document/field.h"
#include "mesh/document/field_wish.h"
#include "mesh/document/make_field.h"

namespace prismesh::modeld {

namespace {

using mesh::document::Document;
using mesh::document::Generation;

Result<const Generation*> generation_of(const Document& document, std::uint64_t number) {
  for (const auto& generation : document.generations)
    if (generation->number == number) return generation.get();
  return fail("field", "the history has no state " + std::to_string(number) + " any more");
}

std::string words_of(const Generation& generation) {
  if (generation.made_by == "open") return "the deck as it was opened";
  return "state " + std::to_string(generation.number) + " (" + generation.made_by + ")";
}

std::string entity(const mesh::Model& model, const mesh::document::Field& field, std::uint32_t at) {
  return field.on_nodes ? "node:" + std::to_string(model.node_ids[at]) : "shell:" + std::to_string(model.shell_ids[at]);
}

}  // namespace

bool FieldMaker::OtherDeck::is_current() const {
  return whole && std::all_of(files.begin(), files.end(), [](const auto& file) {
           const Result<FileIdentity> now = identify_file(file.first);
           return now && *now == file.second;
         });
}

Result<FieldMaker::ComparedModel> FieldMaker::compared_model(const Document& document, const Generation& of, const ipc::GetField& request,
                                                             const Progress& progress) {
  if (request.against_generation) {
    const Result<const Generation*> other = generation_of(document, *request.against_generation);
    if (!other) return fail(other.error());
    return ComparedModel{&(*other)->model, words_of(**other)};
  }
  if (request.against == "opened") return ComparedModel{&document.opened->model, "the deck as it was opened"};
  if (request.against == "surface")
    return ComparedModel{of.surface ? of.surface.get() : &document.opened->model, "the surface as last shaped"};
  const std::filesystem::path path(request.against);
  if (!path.is_absolute())
    return fail("field", "\"against\" is \"opened\", \"surface\" or a deck's absolute path, not \"" + request.against + "\"");
  if (!other_ || other_->path != path || !other_->is_current()) {
    other_.reset();
    Result<mesh::deck::OpenedDeck> opened = mesh::deck::open(path, progress);
    if (!opened && opened.error().file.empty()) opened.error().file = path.string();
    if (!opened) return fail(std::move(opened.error()));
    other_ = OtherDeck{path, {}, opened->deck->missing_files.empty(), std::move(opened->model)};
    for (const mesh::deck::SourceFile& file : opened->deck->files) other_->files.emplace_back(file.path, file.bytes.identity());
  }
  return ComparedModel{&other_->model, path.filename().string()};
}

Result<FieldMaker::MadeField> FieldMaker::make(const Document& document, const ipc::GetField& request, const Progress& progress) {
  Result<mesh::document::FieldWish> wish = mesh::document::field_wish(request.field);
  if (!wish) return fail(wish.error());
  wish->from = request.from;
  wish->to = request.to;
  const Generation* of = &document.current();
  if (request.generation) {
    const Result<const Generation*> found = generation_of(document, *request.generation);
    if (!found) return fail(found.error());
    of = *found;
  }
  ComparedModel other;
  if (needs_other(*wish)) {
    Result<ComparedModel> found = compared_model(document, *of, request, progress);
    if (!found) return fail(found.error());
    other = std::move(*found);
  }
  const Result<mesh::document::Field> field = make_field(*wish, *of, document, other.model, progress);
  if (!field) return fail(field.error());
  Result<ipc::Descriptor> values = ipc::seal_field(of->number, field->on_nodes, field->values);
  if (!values) return fail(values.error());
  const mesh::document::FieldFigures& figures = field->figures;
  ipc::FieldMade answer;
  answer.field = next_++;
  answer.title = field->title;
  answer.unit = field->unit;
  answer.of = words_of(*of);
  answer.against = other.description;
  if (wish->of == mesh::document::FieldWish::Of::gap) {
    answer.of = wish->from + " of " + answer.of;
    answer.against = wish->to;
  }
  answer.generation = of->number;
  answer.on_nodes = field->on_nodes;
  answer.measured = figures.measured;
  answer.min = figures.min;
  answer.mean = figures.mean;
  answer.max = figures.max;
  answer.min_at = entity(of->model, *field, figures.min_at);
  answer.max_at = entity(of->model, *field, figures.max_at);
  answer.clear = field->limits.clear;
  answer.full = field->limits.full;
  answer.new_nodes = field->new_nodes;
  // In a distance between two expressions only the entities of the first have values.
  if (wish->of != mesh::document::FieldWish::Of::gap) answer.shells_without = shells_without_value(of->model, *field);
  return MadeField{std::move(answer), std::move(*values)};
}

}  // namespace prismesh::modeld
