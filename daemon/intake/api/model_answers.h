// What is asked about models, and the answers.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "daemon/intake/api/figures.h"
#include "daemon/intake/http/request.h"
#include "daemon/intake/store/store.h"

namespace prismesh::intake {

/// Reads name, derived_from, skip and count. Errors: another key, a value that is none.
Result<CatalogueQuery> parse_catalogue_query(const std::map<std::string, std::string, std::less<>>& query);
/// Reads Prismesh-Name (base64 of UTF-8) and Prismesh-Derived-From (a model's hash); both may be missing.
Result<Publication> parse_publication(const HttpRequest& request);

std::string model_json(const CatalogueEntry& entry);
std::string models_json(const std::vector<CatalogueEntry>& entries);
/// With its files.
std::string found_model_json(const ipc::store::FoundModel& found);
HttpResponse manifest_response(const ipc::store::FoundModel& found);
HttpResponse thumbnail_response(const Store& store, const ipc::store::FoundModel& found);

struct FileConditions {
  std::string range;          ///< Range
  std::string if_range;       ///< If-Range
  std::string if_none_match;  ///< If-None-Match
};
FileConditions file_conditions(const HttpRequest& request);
/// The file of a model with that content, or the part of it that is asked for.
HttpResponse file_response(const Store& store, const ipc::store::FoundModel& found, const ipc::store::ContentHash& file,
                           const FileConditions& conditions);

/// In Prometheus' text format.
HttpResponse metrics_response(const StoreFigures& store, const Figures& figures, std::size_t followers);

}  // namespace prismesh::intake
