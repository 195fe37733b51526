#include "kiosk/link/link_notices.h"

#include "kiosk/link/notice_words.h"
#include "kiosk/link/result_words.h"

namespace prismesh::kiosk::link {

void LinkNotices::tell_edit(const std::string& what, const mesh::document::EditReport& report, std::string_view unit,
                            std::uint64_t generation) {
  ++changes_;
  const std::string words = result_words(what, report, unit);
  if (!words.empty()) {
    result_ = words;
    result_of_ = number_.value();
    result_generation_ = generation;
    ++results_;
    trace_.line("result " + words);
  } else {
    result_.clear();  // it is of an edit before
  }
  if (auto notice = notice_of_notes(report, words)) say(std::move(*notice));
}

const std::string& LinkNotices::result() const {
  static const std::string kNone;
  return result_of_ == number_.value() ? result_ : kNone;
}

}  // namespace prismesh::kiosk::link
