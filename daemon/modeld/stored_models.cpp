#include "daemon/modeld/stored_models.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <system_error>
#include <variant>

#include "ipc/intake/client.h"
#include "ipc/store/reading.h"

namespace prismesh::modeld {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::minutes kPatienceToPublish{5};
constexpr std::size_t kDigitsOfHash = 8;
constexpr int kMostCopies = 1000;

Result<ipc::IntakeInfo> info_of(ipc::IntakeClient& intake) {
  const Result<ipc::IntakeAnswer> answer = intake.call(ipc::GetIntake{});
  if (!answer) return fail(answer.error());
  const auto* info = std::get_if<ipc::IntakeInfo>(&*answer);
  if (info == nullptr || info->work.empty()) return fail("prismesh-intake", "is of another version; use programs of one version");
  return *info;
}

/// A name for a folder: what people call the model, without what only a shell could love.
std::string plain(const std::string& name) {
  std::string text = fs::path(name).stem().string();
  for (char& c : text)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '_';
  return text.empty() ? "model" : text.substr(0, 60);
}

/// A folder that nobody has used yet: an earlier opening may have been edited since.
Result<fs::path> make_work_folder(const fs::path& work, const std::string& name) {
  std::error_code problem;
  fs::create_directories(work, problem);
  for (int copy = 1; copy <= kMostCopies; ++copy) {
    const fs::path folder = work / (copy == 1 ? name : name + "-" + std::to_string(copy));
    if (fs::create_directory(folder, problem)) return folder;
    if (problem) return fail(folder.string(), "can't be made: " + problem.message());
  }
  return fail(work.string(), "the model was opened " + std::to_string(kMostCopies) + " times already; remove some of its folders there");
}

}  // namespace

Result<ipc::Open> StoredModels::lay_out(const ipc::Open& request) const {
  const std::optional<ipc::store::ContentHash> hash = ipc::store::parse_content_hash(request.stored);
  if (!hash) return fail("open", "\"stored\" is no hash of a model: 64 lower-case hexadecimal digits");
  Result<ipc::IntakeClient> intake = ipc::IntakeClient::connect(intake_, "prismesh-modeld");
  if (!intake) return fail(intake.error());
  const Result<ipc::IntakeInfo> info = info_of(*intake);
  if (!info) return fail(info.error());
  const Result<ipc::store::Reader> store = ipc::store::Reader::open(info->store);
  if (!store) return fail(store.error());
  const Result<ipc::store::FoundModel> model = store->find(*hash);
  if (!model) return fail(model.error());
  const Result<fs::path> folder = make_work_folder(info->work, plain(model->record.name) + "-" + request.stored.substr(0, kDigitsOfHash));
  if (!folder) return fail(folder.error());
  if (const Result<void> done = store->lay_out(model->manifest, *folder); !done) {
    std::error_code ignored;
    fs::remove_all(*folder, ignored);
    return fail(done.error());
  }
  ipc::Open open = request;
  open.path = (*folder / model->manifest.main).string();
  open.sandboxed = true;
  return open;
}

Result<std::string> StoredModels::give_back(const fs::path& deck, const std::string& derived_from) const {
  Result<ipc::IntakeClient> intake = ipc::IntakeClient::connect(intake_, "prismesh-modeld");
  if (!intake) return fail(intake.error());
  const Result<ipc::IntakeInfo> info = info_of(*intake);
  if (!info) return fail(info.error());
  const fs::path below = deck.lexically_relative(info->work);
  if (below.empty() || *below.begin() == "..") return fail(deck.string(), "doesn't lie in " + info->work);
  const Result<ipc::IntakeAnswer> answer = intake->call(ipc::PublishWork{below.begin()->string(), derived_from}, kPatienceToPublish);
  if (!answer) return fail(answer.error());
  const auto* published = std::get_if<ipc::PublishedWork>(&*answer);
  if (published == nullptr) return fail("prismesh-intake", "answered something else");
  return published->model;
}

Result<void> StoredModels::describe(const std::string& model, const mesh::document::ModelCounts& counts) const {
  Result<ipc::IntakeClient> intake = ipc::IntakeClient::connect(intake_, "prismesh-modeld");
  if (!intake) return fail(intake.error());
  const Result<ipc::IntakeAnswer> answer =
      intake->call(ipc::DescribeModel{model, counts.nodes, counts.elements, counts.parts, counts.warn, counts.fail, {}});
  if (!answer) return fail(answer.error());
  return {};
}

}  // namespace prismesh::modeld
