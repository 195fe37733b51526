#include "daemon/intake/api/model_answers.h"

#include <algorithm>

#include "base/base64.h"
#include "base/json/write.h"
#include "daemon/intake/api/refusal.h"
#include "daemon/intake/api/thumbnail.h"
#include "daemon/intake/http/fields.h"
#include "ipc/store/record_definition.h"

namespace prismesh::intake {

namespace {

using ipc::store::ContentHash;
using ipc::store::FoundModel;
using ipc::store::SetFile;

constexpr std::uint64_t kMaxListed = 1000;
constexpr const char* kNeverChanges = "private, max-age=31536000, immutable";

std::string tag_of(const ContentHash& hash) { return "\"" + hash.hex() + "\""; }

json::Json entry_json(const CatalogueEntry& entry) {
  json::Json object = json::to_json(entry.record);
  object["damaged"] = entry.damaged;
  return object;
}

std::string header_text(const HttpRequest& request, std::string_view name) { return std::string(request.header(name).value_or("")); }

}  // namespace

Result<CatalogueQuery> parse_catalogue_query(const std::map<std::string, std::string, std::less<>>& query) {
  CatalogueQuery parsed;
  for (const auto& [key, value] : query) {
    if (key == "name") {
      parsed.words = value;
    } else if (key == "derived_from") {
      parsed.derived_from = ipc::store::parse_content_hash(value);
      if (!parsed.derived_from) return fail("query", "derived_from must be a model's hash");
    } else if (key == "skip" || key == "count") {
      const std::optional<std::uint64_t> number = parse_size(value);
      if (!number || (key == "count" && *number > kMaxListed)) return fail("query", key + " must be a number (count at most 1000)");
      (key == "skip" ? parsed.skip : parsed.count) = *number;
    } else {
      return fail("query", "'" + key + "' is none of name, derived_from, skip, count");
    }
  }
  return parsed;
}

Result<Publication> parse_publication(const HttpRequest& request) {
  Publication publication;
  if (const auto name = request.header("prismesh-name")) {
    const auto bytes = base64_decode(*name);
    if (!bytes) return fail("Prismesh-Name", "must be base64");
    publication.name.assign(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  }
  if (const auto from = request.header("prismesh-derived-from")) {
    publication.derived_from = ipc::store::parse_content_hash(*from);
    if (!publication.derived_from) return fail("Prismesh-Derived-From", "must be a model's hash");
  }
  return publication;
}

std::string model_json(const CatalogueEntry& entry) { return json::to_line(entry_json(entry)); }

std::string models_json(const std::vector<CatalogueEntry>& entries) {
  json::Json list = json::Json::array();
  for (const CatalogueEntry& entry : entries) list.push_back(entry_json(entry));
  json::Json object = json::Json::object();
  object["models"] = std::move(list);
  return json::to_line(object) + "\n";
}

std::string found_model_json(const FoundModel& found) {
  json::Json object = json::to_json(found.record);
  object["main"] = found.manifest.main;
  object["set"] = json::Json::array();
  for (const SetFile& file : found.manifest.files) {
    json::Json each = json::Json::object();
    each["path"] = file.path;
    each["bytes"] = file.bytes;
    each["sha256"] = file.hash.hex();
    object["set"].push_back(std::move(each));
  }
  return json::to_line(object);
}

HttpResponse manifest_response(const FoundModel& found) {
  return {200,
          {{"Content-Type", "application/x-prismesh-set"}, {"ETag", tag_of(found.record.model)}, {"Cache-Control", kNeverChanges}},
          ipc::store::encode_manifest(found.manifest),
          std::nullopt,
          nullptr};
}

HttpResponse thumbnail_response(const Store& store, const FoundModel& found) {
  if (!found.record.thumbnail) return error_response(404, "there is no picture of this model");
  Outcome<std::string> picture = store.picture(*found.record.thumbnail);
  if (!picture) return refusal_response(picture.error());
  if (!is_thumbnail(*picture)) return error_response(410, "the picture of this model is none; describe the model again");
  return {200,
          {{"Content-Type", "image/png"}, {"ETag", tag_of(*found.record.thumbnail)}, {"Cache-Control", "private, no-cache"}},
          std::move(*picture),
          std::nullopt,
          nullptr};
}

FileConditions file_conditions(const HttpRequest& request) {
  return {header_text(request, "range"), header_text(request, "if-range"), header_text(request, "if-none-match")};
}

HttpResponse file_response(const Store& store, const FoundModel& found, const ContentHash& hash, const FileConditions& conditions) {
  const auto file =
      std::find_if(found.manifest.files.begin(), found.manifest.files.end(), [&](const SetFile& each) { return each.hash == hash; });
  if (file == found.manifest.files.end()) return error_response(404, "the model has no such file");
  HttpResponse response{200,
                        {{"Content-Type", "application/octet-stream"},
                         {"Content-Disposition", "attachment"},
                         {"ETag", tag_of(hash)},
                         {"Accept-Ranges", "bytes"},
                         {"Cache-Control", kNeverChanges}},
                        std::string(),
                        std::nullopt,
                        nullptr};
  if (!conditions.if_none_match.empty() && lists_tag(conditions.if_none_match, tag_of(hash))) {
    response.status = 304;
    return response;
  }
  Outcome<ipc::Descriptor> opened = store.open_file(*file);
  if (!opened) return refusal_response(opened.error());
  FileBody body{std::move(*opened), 0, file->bytes, file->bytes, hash};
  // A date in If-Range fits nothing here.
  if (!conditions.range.empty() && (conditions.if_range.empty() || conditions.if_range == tag_of(hash))) {
    const tl::expected<ByteRange, RangeFault> range = parse_range(conditions.range, file->bytes);
    if (!range && range.error() == RangeFault::unsatisfiable) {
      HttpResponse refused = error_response(416, "the file ends before that");
      refused.headers.emplace_back("Content-Range", "bytes */" + std::to_string(file->bytes));
      return refused;
    }
    if (range) {
      body.begin = range->begin;
      body.bytes = range->bytes;
      response.status = 206;
      response.headers.emplace_back("Content-Range", "bytes " + std::to_string(range->begin) + "-" +
                                                         std::to_string(range->begin + range->bytes - 1) + "/" +
                                                         std::to_string(file->bytes));
    }
  }
  response.body = std::move(body);
  return response;
}

HttpResponse metrics_response(const StoreFigures& store, const Figures& figures, std::size_t followers) {
  std::string text;
  const auto add = [&](const char* name, const char* type, const char* help, auto value) {
    const std::string full = std::string("prismesh_intake_") + name;
    text += "# HELP " + full + " " + help + "\n# TYPE " + full + " " + type + "\n" + full + " " + std::to_string(value) + "\n";
  };
  add("requests_total", "counter", "Requests that were read.", figures.requests.load());
  add("refused_total", "counter", "Answers with a status of 400 or more.", figures.refused.load());
  add("received_bytes_total", "counter", "Bytes of uploads.", figures.received_bytes.load());
  add("sent_bytes_total", "counter", "Bytes of files.", figures.sent_bytes.load());
  add("published_total", "counter", "Models that were published.", figures.published.load());
  add("rot_total", "counter", "Files that scrubbing found damaged.", figures.rot.load());
  add("connections", "gauge", "Connections now.", figures.connections.load());
  add("followers", "gauge", "Clients that follow events.", followers);
  add("models", "gauge", "Models in the store.", store.models);
  add("uploads", "gauge", "Uploads under way.", store.uploads);
  add("damaged_files", "gauge", "Files known to be damaged.", store.damaged);
  add("free_bytes", "gauge", "Room for uploads on the disk, the reserve aside.", store.free_bytes);
  return {200, {{"Content-Type", "text/plain; version=0.0.4"}, {"Cache-Control", "no-store"}}, std::move(text), std::nullopt, nullptr};
}

}  // namespace prismesh::intake
