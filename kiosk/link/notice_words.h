// What the link tells the user, in words. Pure functions.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "base/error.h"
#include "ipc/model/messages.h"
#include "kiosk/notices/deck_warnings.h"
#include "kiosk/notices/notice.h"

namespace prismesh::kiosk::link {

/// Whether it failed because a client asked it to stop.
bool was_stopped(const ipc::Failed& failed);

// The document that they are about is added when they are said.

notices::Notice notice_of_error(const Error& error);
/// Something was asked for while there is no server.
notices::Notice notice_of_missing_server();
/// `if_stopped`: what is the case if it was stopped: "nothing was saved".
notices::Notice notice_of_failure(const ipc::Failed& failed, const std::string& if_stopped);
notices::Notice notice_of_failed_opening(const ipc::Failed& failed, const std::filesystem::path& deck);
/// The unsaved edits of the deck that was open before stay in its journal.
notices::Notice notice_of_kept_edits(const std::string& deck);
/// `remark`: added to it; may be empty.
notices::Notice notice_of_saving(const ipc::Saved& saved, const std::string& remark);
notices::Notice notice_of_ended_drag(const ipc::DragEnded& ended);
/// What the journal has brought back; nothing where the deck is as it was saved.
std::optional<notices::Notice> notice_of_recovery(const ipc::DocumentState& state);
/// The worst of them, which come first; the list has all. Nothing if there are none.
std::optional<notices::Notice> notice_of_warnings(std::span<const notices::ToldWarning> warnings);
/// What an edit has to say beside its figures, below its `result` (result_words); nothing where there is nothing.
std::optional<notices::Notice> notice_of_notes(const mesh::document::EditReport& report, const std::string& result);

// What the server is doing.

std::string words_of_opening(const std::string& deck);
/// `can_stop`: this client has asked for something that can be stopped.
std::string words_of_progress(const ipc::ProgressMade& progress, bool can_stop);

}  // namespace prismesh::kiosk::link
