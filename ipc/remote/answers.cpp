#include "ipc/remote/answers.h"

#include <algorithm>

#include "base/json/nesting.h"
#include "ipc/store/record_definition.h"
#include "ipc/store/utf8.h"

namespace prismesh::ipc::remote {

namespace {

constexpr std::size_t kMaxEvent = std::size_t{64} << 10;
constexpr std::size_t kMaxSentence = 1000;

struct ModelList {
  std::vector<ListedModel> models;
};
struct RefusalBody {
  std::string error;
};
struct EventData {
  store::ContentHash model;
};

}  // namespace

}  // namespace prismesh::ipc::remote

namespace prismesh::json {

PRISMESH_JSON_OBJECT(ipc::remote::PairAnswer, f.required("token", m.token), f.required("name", m.name), f.required("scopes", m.scopes),
                     f.required("expires_s", m.expires_s));

/// A record with one field more.
template <>
struct Definition<ipc::remote::ListedModel> {
  static void fields(auto& m, auto& f) {
    Definition<ipc::store::ModelRecord>::fields(m.record, f);
    f("damaged", m.is_damaged);
  }
};
PRISMESH_JSON_OBJECT(ipc::remote::ModelList, f.required("models", m.models));
PRISMESH_JSON_OBJECT(ipc::remote::RefusalBody, f.required("error", m.error));
PRISMESH_JSON_OBJECT(ipc::remote::EventData, f.required("model", m.model));

}  // namespace prismesh::json

namespace prismesh::ipc::remote {

namespace {

constexpr int kMaxAnswerDepth = 8;

template <class T>
Result<T> parse_answer(std::string_view body) {
  T value;
  if (json::is_nested_deeper(body, kMaxAnswerDepth)) return fail("", "the station's answer is nested too deeply");
  const json::Json read = json::Json::parse(body, nullptr, false);
  if (read.is_discarded()) return fail("", "the station's answer isn't JSON; is it a prismesh-intake?");
  if (const json::Problem problem = json::read(read, value, json::Author::program)) return fail("", "the station's answer " + *problem);
  return value;
}

/// What is shown to people, and stands in files and lines of JSON.
bool is_sound(const ListedModel& model) { return store::is_plain_utf8(model.record.name) && store::is_plain_utf8(model.record.who); }

}  // namespace

Result<PairAnswer> parse_pair_answer(std::string_view body) {
  Result<PairAnswer> answer = parse_answer<PairAnswer>(body);
  if (!answer) return answer;
  const auto is_sign = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_'; };
  if (answer->token.empty() || answer->token.size() > 200 || !std::all_of(answer->token.begin(), answer->token.end(), is_sign))
    return fail("", "the station's answer has no token");
  if (!store::is_plain_utf8(answer->name)) return fail("", "the station's answer has a name that can't be shown");
  return answer;
}

Result<ListedModel> parse_listed_model(std::string_view body) {
  Result<ListedModel> model = parse_answer<ListedModel>(body);
  if (model && !is_sound(*model)) return fail("", "the station's answer has a name that can't be shown");
  return model;
}

Result<std::vector<ListedModel>> parse_model_list(std::string_view body) {
  Result<ModelList> list = parse_answer<ModelList>(body);
  if (!list) return fail(list.error());
  if (!std::all_of(list->models.begin(), list->models.end(), is_sound))
    return fail("", "the station's answer has a name that can't be shown");
  return std::move(list->models);
}

std::string refusal_sentence(std::string_view body) {
  const Result<RefusalBody> refusal = parse_answer<RefusalBody>(body);
  if (!refusal || refusal->error.size() > kMaxSentence || !store::is_plain_utf8(refusal->error)) return "";
  return refusal->error;
}

Result<void> EventReader::add(std::string_view bytes) {
  text_ += bytes;
  const std::size_t last = text_.rfind("\n\n");
  if (text_.size() - (last == std::string::npos ? 0 : last) > kMaxEvent) return fail("", "the station's event is too long");
  return {};
}

std::optional<CatalogueEvent> EventReader::next() {
  for (std::size_t end = text_.find("\n\n"); end != std::string::npos; end = text_.find("\n\n")) {
    CatalogueEvent event;
    const std::string block = text_.substr(0, end + 1);
    text_.erase(0, end + 2);
    for (std::size_t at = 0; at < block.size();) {
      const std::size_t line_end = block.find('\n', at);
      const std::string_view line(block.data() + at, line_end - at);
      if (line.starts_with("event: ")) event.kind = line.substr(7);
      if (line.starts_with("data: ")) event.data = line.substr(6);
      at = line_end + 1;
    }
    // Comments keep the line alive.
    if (!event.kind.empty()) return event;
  }
  return std::nullopt;
}

std::optional<store::ContentHash> model_of_event(const CatalogueEvent& event) {
  const Result<EventData> data = parse_answer<EventData>(event.data);
  return data ? std::optional(data->model) : std::nullopt;
}

}  // namespace prismesh::ipc::remote
