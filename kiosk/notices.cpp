#include "kiosk/notices.h"

#include <utility>

namespace prismesh::kiosk {

using panels::Notice;

void Notices::say(Notice::Kind kind, std::string text) {
  Notice notice{kind, std::move(text)};
  trace_.line(trace_of(notice));
  take(std::move(notice));
}

void Notices::take(Notice notice) {
  while (!waiting_.empty() && waiting_.back().kind == Notice::Kind::information) waiting_.pop_back();
  waiting_.push_back(std::move(notice));
}

std::string trace_of(const Notice& notice) {
  const char* const kind = notice.kind == Notice::Kind::error ? "error" : notice.kind == Notice::Kind::warning ? "warning" : "information";
  return std::string("notice ") + kind + " " + notice.text;
}

}  // namespace prismesh::kiosk
