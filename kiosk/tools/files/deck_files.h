// Opens and saves decks, and asks before unsaved edits or files would be lost.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "kiosk/link/model_link.h"
#include "kiosk/notices/trace.h"
#include "kiosk/panels/question.h"

namespace prismesh::kiosk::tools::files {

class DeckFiles {
 public:
  DeckFiles(link::ModelLink& link, notices::Trace trace) : link_(link), trace_(trace) {}

  /// How a deck is saved elsewhere: the document goes on as that deck, or that is a copy and the document stays as it is.
  enum class Elsewhere : std::uint8_t { becomes, copy };

  void open(const std::filesystem::path& deck) { link_.deck.open(deck); }
  /// `remark`: added to the notice about the saving.
  void save(const std::string& remark);
  void save_elsewhere(const std::filesystem::path& path, Elsewhere how, const std::string& remark);

  /// Asks whether the kiosk may end, if there are unsaved edits.
  void quit();
  /// It may.
  bool quits() const { return quits_; }

  /// The question that waits for a reply.
  const std::optional<panels::Question>& question() const { return question_; }
  void reply(panels::Reply reply);
  /// Call after the link has turned.
  void follow();

 private:
  std::string open_deck() const;
  void write(const ipc::Save& request, const std::string& remark);
  bool has_unsaved_edits() const;
  void ask_about_edits(const std::filesystem::path& deck);
  void ask_about_quitting();
  void reply_about_quitting(panels::Reply reply);
  void ask_about_writing(const ipc::Save& request, const std::string& remark, const ipc::SaveWould& would);

  link::ModelLink& link_;
  notices::Trace trace_;
  std::optional<panels::Question> question_;
  bool quitting_ = false;  ///< the question is about that
  bool quits_ = false;
  std::string about_;              ///< the deck that was open when the question was asked
  std::filesystem::path to_open_;  ///< once the unsaved edits are saved or given up
  ipc::Save to_write_;             ///< if files may be replaced
  std::string remark_;             ///< for the notice then
};

}  // namespace prismesh::kiosk::tools::files
