#include "kiosk/notices/notices.h"

#include <algorithm>
#include <utility>

namespace prismesh::kiosk::notices {

void Notices::say(Notice::Kind kind, std::string text) {
  Notice notice{kind, std::move(text), document_};
  trace_.line(trace_of(notice));
  take(std::move(notice));
}

void Notices::take(Notice notice) {
  if (notice.document != 0 && notice.document < document_) return;
  while (!waiting_.empty() && waiting_.back().kind == Notice::Kind::information) waiting_.pop_back();
  const auto place = std::find_if(waiting_.begin(), waiting_.end(), [&](const Notice& each) { return each.kind < notice.kind; });
  waiting_.insert(place, std::move(notice));
}

void Notices::follow(std::uint64_t document_number) {
  document_ = document_number;
  std::erase_if(waiting_, [&](const Notice& each) { return each.document != 0 && each.document < document_; });
}

void Notices::read_warnings() {
  std::erase_if(waiting_, [](const Notice& each) { return each.lists_warnings; });
}

std::string trace_of(const Notice& notice) {
  const char* const kind = notice.kind == Notice::Kind::error ? "error" : notice.kind == Notice::Kind::warning ? "warning" : "information";
  return std::string("notice ") + kind + " " + notice.text;
}

}  // namespace prismesh::kiosk::notices
