#include "kiosk/link/server_progress.h"

#include <variant>

#include "kiosk/link/notice_words.h"

namespace prismesh::kiosk::link {

void ServerProgress::answered() {
  if (--asked_ == 0) clear();
}

void ServerProgress::begin_opening(const std::string& deck) {
  words_ = words_of_opening(deck);
  fraction_ = 0;
}

void ServerProgress::heard(const ipc::Event& event) {
  if (std::holds_alternative<ipc::GenerationPublished>(event) || std::holds_alternative<ipc::DocumentOpened>(event)) clear();
  const auto* progress = std::get_if<ipc::ProgressMade>(&event);
  if (progress == nullptr) return;
  // The name of the deck that is being opened stays.
  const bool over = progress->fraction >= 1, named = progress->what == "open" && words_.starts_with("Opening ");
  if (over || !named) words_ = over ? std::string() : words_of_progress(*progress, works_for_us());
  fraction_ = progress->fraction;
}

void ServerProgress::lost() {
  clear();
  asked_ = 0;
}

}  // namespace prismesh::kiosk::link
