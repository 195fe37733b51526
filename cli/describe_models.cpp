#include "cli/describe_models.h"

#include <fstream>
#include <iterator>
#include <ostream>
#include <span>
#include <variant>
#include <vector>

#include "base/base64.h"
#include "base/counted.h"
#include "cli/draw_picture.h"
#include "cli/open_deck.h"
#include "cli/remote_json.h"
#include "cli/report_text.h"
#include "cli/temporary_folder.h"
#include "ipc/store/reading.h"
#include "mesh/document/model_counts.h"

namespace prismesh::cli {

namespace {

using ipc::store::ModelRecord;

constexpr std::size_t kMostDescribed = 10'000;
constexpr std::size_t kDigitsOfHashMin = 6;

bool is_meant(const ModelRecord& record, const std::string& model) {
  if (model.empty()) return !record.figures || !record.thumbnail;
  return record.name == model || (model.size() >= kDigitsOfHashMin && record.model.hex().starts_with(model));
}

/// A small picture for one eye, in base64. Errors: there is none.
Result<std::string> picture_of(const mesh::document::Document& document, const std::filesystem::path& folder, const Context& context) {
  const std::filesystem::path file = folder / "picture.png";
  const Result<int> drawn = draw_picture(document, file, {"--size", "320x240", "--profile", "mono-left"}, -1, context);
  if (!drawn) return fail(drawn.error());
  std::ifstream in(file, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  if (*drawn != kDone || bytes.empty()) return fail(file.string(), "wasn't drawn");
  return base64_encode(std::as_bytes(std::span(bytes)));
}

Result<ipc::DescribeModel> describe_one(const ipc::store::Reader& store, const ModelRecord& record, const Common& common,
                                        const Context& context) {
  const Result<ipc::store::FoundModel> found = store.find(record.model);
  if (!found) return fail(found.error());
  const Result<TemporaryFolder> folder = TemporaryFolder::make();
  if (!folder) return fail(folder.error());
  const std::filesystem::path deck = folder->path() / "deck";
  std::error_code problem;
  if (!std::filesystem::create_directory(deck, problem)) return fail(deck.string(), "can't be made: " + problem.message());
  if (const Result<void> laid_out = store.lay_out(found->manifest, deck); !laid_out) return fail(laid_out.error());
  const Result<mesh::document::Document> document = open_sandboxed(deck / found->manifest.main, common, context);
  if (!document) return fail(document.error());
  const mesh::document::ModelCounts counts = mesh::document::count_model(*document);
  ipc::DescribeModel told{record.model.hex(), counts.nodes, counts.elements, counts.parts, counts.warn, counts.fail, {}};
  Result<std::string> picture = picture_of(*document, folder->path(), context);
  if (picture)
    told.thumbnail = std::move(*picture);
  else
    say(context, Error{record.name, 0, "is described without a picture: " + picture.error().text()});
  return told;
}

}  // namespace

int describe_models(ipc::IntakeClient& intake, const std::string& model, const Common& common, const Context& context) {
  const auto refuse = [&](const Error& error) {
    say(context, error);
    return kFailed;
  };
  const Result<ipc::IntakeAnswer> answer = intake.call(ipc::GetIntake{});
  if (!answer) return refuse(answer.error());
  const auto* info = std::get_if<ipc::IntakeInfo>(&*answer);
  if (info == nullptr) return refuse(Error{"prismesh-intake", 0, "its answer isn't one to what was asked"});
  const Result<ipc::store::Reader> store = ipc::store::Reader::open(info->store);
  if (!store) return refuse(store.error());
  const Result<std::vector<ModelRecord>> records = store->records(kMostDescribed);
  if (!records) return refuse(records.error());
  int status = kDone;
  std::size_t met = 0;
  for (const ModelRecord& record : *records) {
    if (!is_meant(record, model)) continue;
    if (context.stop()) return refuse(Error{"", 0, "stopped"});
    ++met;
    const Result<ipc::DescribeModel> told = describe_one(*store, record, common, context);
    Result<void> done;
    if (!told)
      done = fail(told.error());
    else if (const Result<ipc::IntakeAnswer> taken = intake.call(*told); !taken)
      done = fail(taken.error());
    if (!done) {
      say(context, Error{record.name, 0, "isn't described: " + done.error().text()});
      status = kFailed;
    } else if (common.json) {
      context.out << described_json(*told) << '\n';
    } else {
      context.out << printable(record.name) << ": " << counted(told->nodes, "node") << ", " << counted(told->elements, "element") << ", "
                  << counted(told->parts, "part") << "; " << told->warn << " warn, " << told->fail << " fail\n";
    }
  }
  if (met == 0 && !model.empty()) return refuse(Error{model, 0, "there is no such model in the store"});
  if (met == 0 && !common.json) context.out << "all models are described\n";
  return status;
}

}  // namespace prismesh::cli
