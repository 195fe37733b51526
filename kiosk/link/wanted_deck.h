// The deck that should be open: opens it, also on a server that has started anew, saves it and closes it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "kiosk/link/followed_document.h"

namespace prismesh::kiosk::link {

/// What happens to unsaved edits of the document that is open when another one is opened: they are in the way, are dropped, or stay in
/// their journal until that deck is opened again.
enum class Unsaved : std::uint8_t { refuse, discard, keep };

/// How a model of the store is named where a deck's path stands.
std::string stored_name(const std::string& hash);
bool is_stored_name(const std::string& path);

class WantedDeck final : public ConnectionListener {
 public:
  /// `deck`: opened as soon as there is a server, unless it has it open already.
  WantedDeck(std::optional<std::filesystem::path> deck, Connection& connection, FollowedDocument& document, DocumentNumber& number,
             LinkNotices& notices, notices::Trace trace);

  void open(const std::filesystem::path& deck, Unsaved unsaved = Unsaved::refuse);
  /// A deck that the server refused to open because of unsaved edits; each is returned once.
  std::optional<std::filesystem::path> take_refused() { return std::exchange(refused_, std::nullopt); }
  struct NotOpened {
    std::filesystem::path deck;
    std::string why;  ///< as the notice says it
  };
  /// A deck that couldn't be opened; each is returned once. A notice tells it too.
  std::optional<NotOpened> take_not_opened() { return std::exchange(not_opened_, std::nullopt); }
  /// `remark`: added to the notice about the saving. `then` gets the answer last.
  void save(const ipc::Save& request, const std::string& remark, Then then);
  /// Closes the document and drops its unsaved edits. `then` gets the answer.
  void close(Then then);

  void connected() override { ask_state(); }
  void heard(const ipc::Event& event) override;
  void lost() override;

 private:
  void ask_state();
  void took_state(const ipc::DocumentState& state);
  void took_opened(const ipc::Answer& answer, const std::filesystem::path& whole, const std::string& kept);
  void not_opened(const ipc::Failed& failed, const std::filesystem::path& whole);
  void say_not_opened(const ipc::Failed& failed, const std::filesystem::path& whole);
  void took_saved(const ipc::Saved& saved, bool becomes, const std::string& remark);

  std::optional<std::filesystem::path> deck_;
  bool opening_ = false;                          ///< the server was asked to open it and hasn't answered
  std::optional<std::filesystem::path> refused_;  ///< not opened because of unsaved edits
  std::optional<NotOpened> not_opened_;
  Connection& connection_;
  FollowedDocument& document_;
  DocumentNumber& number_;
  LinkNotices& notices_;
  notices::Trace trace_;
};

}  // namespace prismesh::kiosk::link
