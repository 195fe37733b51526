// Opening and saving decks, with the questions that go before anything of the user's would be lost or replaced.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "kiosk/model_link.h"
#include "kiosk/tools/question.h"
#include "kiosk/trace.h"

namespace prismesh::kiosk {

class DeckFiles {
 public:
  DeckFiles(ModelLink& link, Trace trace) : link_(link), trace_(trace) {}

  /// How a deck is saved elsewhere: the document goes on as that deck, or that is a copy and the document stays as it is.
  enum class Elsewhere : std::uint8_t { becomes, copy };

  void open(const std::filesystem::path& deck) { link_.open(deck); }
  /// `remark`: said together with what was saved.
  void save(const std::string& remark);
  void save_elsewhere(const std::filesystem::path& path, Elsewhere how, const std::string& remark);

  /// Waits for a reply.
  const std::optional<tools::Question>& question() const { return question_; }
  /// The reply that a key gives; nothing if it gives none.
  std::optional<tools::Reply> reply_of(display::Key key) const;
  void reply(tools::Reply reply);
  /// After the link has turned.
  void follow();

 private:
  std::string open_deck() const;
  void write(const ipc::Save& request, const std::string& remark);
  void ask_about_edits(const std::filesystem::path& deck);
  void ask_about_writing(const ipc::Save& request, const std::string& remark, const ipc::SaveWould& would);

  ModelLink& link_;
  Trace trace_;
  std::optional<tools::Question> question_;
  std::string about_;              ///< the deck that was open when the question was asked
  std::filesystem::path to_open_;  ///< once the unsaved edits are saved or given up
  ipc::Save to_write_;             ///< if files may be replaced
  std::string remark_;             ///< to be said then
};

}  // namespace prismesh::kiosk
