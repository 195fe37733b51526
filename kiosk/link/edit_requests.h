// Sends edits to the model server, and tells what they did.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "kiosk/link/followed_document.h"

namespace prismesh::kiosk::link {

/// Whether an edit of this name changes the selection only.
bool is_selecting(std::string_view edit);

class EditRequests final : public ConnectionListener {
 public:
  EditRequests(Connection& connection, FollowedDocument& document, LinkNotices& notices);

  void send(mesh::document::Edit edit);
  /// Undoes or redoes up to a state of the history.
  void go_to(std::uint64_t generation);
  /// An edit isn't answered yet.
  bool under_way() const { return under_way_ > 0; }

  void lost() override { under_way_ = 0; }

 private:
  /// `what`: words_of_edit.
  void answered(const ipc::Answer& answer, bool selecting, const std::string& what);

  Connection& connection_;
  FollowedDocument& document_;
  LinkNotices& notices_;
  std::size_t under_way_ = 0;
};

}  // namespace prismesh::kiosk::link
