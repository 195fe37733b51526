// Reads what a station answers. All of it comes over the network.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "ipc/store/record.h"

namespace prismesh::ipc::remote {

struct PairAnswer {
  std::string token;
  std::string name;
  std::vector<std::string> scopes;
  std::int64_t expires_s = 0;  ///< since 1970
};
/// Errors: another form; a token that can't stand in a header.
Result<PairAnswer> parse_pair_answer(std::string_view body);

struct ListedModel {
  store::ModelRecord record;
  bool is_damaged = false;
};
Result<ListedModel> parse_listed_model(std::string_view body);
Result<std::vector<ListedModel>> parse_model_list(std::string_view body);

/// The sentence of a refusal, {"error": sentence}; empty: there is none that can be shown.
std::string refusal_sentence(std::string_view body);

struct CatalogueEvent {
  std::string kind;  ///< published, described, removed
  std::string data;  ///< JSON in one line
};

/// Server-sent events (the form that stations write), as they come in pieces.
class EventReader {
 public:
  /// Errors: an event of more than 64 KB.
  Result<void> add(std::string_view bytes);
  /// The next whole event.
  std::optional<CatalogueEvent> next();

 private:
  std::string text_;
};

/// The hash in the data of an event; nothing: there is none.
std::optional<store::ContentHash> model_of_event(const CatalogueEvent& event);

}  // namespace prismesh::ipc::remote
